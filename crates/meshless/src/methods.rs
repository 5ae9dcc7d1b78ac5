//! The methods, for people to choose from.

/// A method that a scene can name.
#[derive(Debug, Clone, Copy)]
pub struct MethodInfo {
    /// Name in `[method] name`.
    pub name: &'static str,
    /// Observed order of u in L2 where something jumps at an interface, and where nothing does.
    pub order: &'static str,
    /// Dimensions.
    pub dimensions: &'static str,
    /// What it is for, and what it cannot do.
    pub limits: &'static str,
    /// What it knows of that others do not: effects by their names in plans.
    pub effects: &'static [&'static str],
}

/// Balances and fits of high order: everything.
const ALL: &[&str] = &["capacity", "advection", "reaction", "contact resistance", "partition"];
/// Rows that say nothing of interfaces.
const IN_REGIONS: &[&str] = &["capacity", "advection", "reaction"];
/// Rows of pure diffusion.
const DIFFUSION: &[&str] = &["capacity"];

/// All methods that can be used today.
pub const METHODS: &[MethodInfo] = &[
    MethodInfo {
        name: "gfdm-classical",
        order: "1 / 2",
        dimensions: "1, 2, 3",
        limits: "stencils at every node; the diffusivity is smeared over an interface: wrong for stiff inclusions, no \
                 prescribed jumps; best where nothing jumps",
        effects: IN_REGIONS,
    },
    MethodInfo {
        name: "gfdm-positive",
        order: "none / 2",
        dimensions: "1, 2, 3",
        limits: "balances only where a stencil is not diagonally dominant: maximum principle, but no conservation; \
                 for comparison",
        effects: ALL,
    },
    MethodInfo {
        name: "gfdm-hybrid",
        order: "1 / 2",
        dimensions: "1, 2, 3",
        limits: "balances near interfaces, stencils elsewhere: maximum principle, any contrast, jumps of u and of the \
                 flux; what `sharp` falls back on",
        effects: ALL,
    },
    MethodInfo {
        name: "gfdm-conservative",
        order: "1 / 1-2",
        dimensions: "1, 2, 3",
        limits: "balances over the Voronoi cell of every node: conservative, maximum principle, any contrast; second \
                 order only on regular clouds",
        effects: ALL,
    },
    MethodInfo {
        name: "particle-difference",
        order: "2 / 2",
        dimensions: "1, 2, 3",
        limits: "stencils that the interface condition is built into, no further unknowns: second order up to the \
                 interface, jumps of u and of the flux; no maximum principle, not conservative",
        effects: DIFFUSION,
    },
    MethodInfo {
        name: "particle-difference-extended",
        order: "1-2 / 2",
        dimensions: "1, 2, 3",
        limits: "the jump of the slope is an unknown at points of the interfaces: the former particle difference method, \
                 to be compared with; no slits",
        effects: DIFFUSION,
    },
    MethodInfo {
        name: "immersed-interface",
        order: "2-3 / 2",
        dimensions: "1, 2, 3",
        limits: "DC-PSE operators that see one region each; values beyond an interface are continued under its \
                 conditions: second order and more up to the interface, jumps of u and of the flux; three regions must \
                 not meet; no maximum principle, not conservative",
        effects: DIFFUSION,
    },
    MethodInfo {
        name: "sharp",
        order: "2-16 / 2-16",
        dimensions: "1, 2, 3",
        limits: "one polynomial for each region of a stencil, the equation and the interface conditions built in: the \
                 order of the polynomials (`order`, even) at any contrast, in time as well; no maximum principle, not \
                 conservative",
        effects: ALL,
    },
    MethodInfo {
        name: "surface-reaction",
        order: "1 / 2",
        dimensions: "1, 2, 3",
        limits: "DC-PSE operators that see all regions, interfaces smeared over a width, jumps of the flux as sources: \
                 regions may meet anyhow; first order where the diffusivity jumps; no jumps of u; for comparison",
        effects: DIFFUSION,
    },
    MethodInfo {
        name: "free-space",
        order: "- / 2-20",
        dimensions: "1, 2, 3",
        limits: "one constant diffusivity in all of space, a source that vanishes outside of a box: convolution by FFT \
                 with a Green's function of any even order (`order`, `sigma`, `kernel`), the best one for the source if \
                 none is given; steady scenes only",
        effects: &[],
    },
];
