//! The parts of a scene.

use std::sync::{Arc, OnceLock};

use meshless_geometry::{SurfaceParams, TriangleSurface};

use super::expression::ExprField;
use super::options::MethodOptions;
use super::points_file::PointsFileSpec;
use super::source::Place;

/// Faces of a box, two an axis.
pub(super) const BOX_FACES: [&str; 6] = ["left", "right", "bottom", "top", "back", "front"];
/// The one face of any other domain.
pub(super) const OUTER_FACE: &str = "outer";
/// What stands for every face in a boundary condition.
pub(super) const ALL_FACES: &str = "all";

/// The domain, before holes are cut out of it.
#[derive(Debug, Clone)]
pub struct DomainSpec {
    /// Its shape. A box has the faces `left right bottom top back front`, anything else has `outer`.
    pub shape: ShapeSpec,
    /// A box that holds the shape; given for shapes that do not end by themselves.
    pub bounds: Option<BoundsSpec>,
    /// The table in the file.
    pub place: Place,
}

impl DomainSpec {
    /// Names of the outer faces.
    pub fn faces(&self, dimension: usize) -> &'static [&'static str] {
        match self.shape {
            ShapeSpec::Box(_) => &BOX_FACES[..2 * dimension],
            _ => &[OUTER_FACE],
        }
    }
}

/// Opposite corners of an axis-aligned box; `min < max` along every axis.
#[derive(Debug, Clone, PartialEq)]
pub struct BoundsSpec {
    /// Lower corner.
    pub min: Vec<f64>,
    /// Upper corner.
    pub max: Vec<f64>,
}

/// A shape; every vector has as many finite components as the scene has dimensions.
#[derive(Debug, Clone)]
pub enum ShapeSpec {
    /// An axis-aligned box.
    Box(BoundsSpec),
    /// An interval, a disc or a ball.
    Sphere {
        /// Centre.
        center: Vec<f64>,
        /// Radius, positive.
        radius: f64,
    },
    /// A circular cylinder; 3-D only.
    Cylinder {
        /// A point on the axis; the middle, if the cylinder has a length.
        point: Vec<f64>,
        /// Direction of the axis, of any length but zero.
        axis: Vec<f64>,
        /// Radius, positive.
        radius: f64,
        /// Length, positive; infinite if absent.
        length: Option<f64>,
    },
    /// A closed polygon of at least three vertices; 2-D only.
    Polygon(Vec<[f64; 2]>),
    /// The inside of a surface of triangles; 3-D only.
    Surface(SurfaceSpec),
    /// Everything behind a plane.
    HalfSpace {
        /// A point of the plane.
        point: Vec<f64>,
        /// Its outward normal, of any length but zero.
        normal: Vec<f64>,
    },
    /// Where an expression is negative.
    LevelSet(ExprField),
    /// Points of any of the shapes, of which there are at least two.
    Union(Vec<ShapeSpec>),
    /// Points of all of the shapes, of which there are at least two.
    Intersection(Vec<ShapeSpec>),
    /// Points of the first shape that are in none of the others, of which there is at least one.
    Difference(Vec<ShapeSpec>),
}

/// A surface of triangles in a file, which is read when it is first needed.
#[derive(Debug, Clone)]
pub struct SurfaceSpec {
    /// Path of the STL file, relative to the scene.
    pub file: String,
    /// How it is read.
    pub params: SurfaceParams,
    /// The value in the scene.
    pub place: Place,
    /// The surface, once it has been read; shared by copies of the scene.
    pub(crate) loaded: Arc<OnceLock<Arc<TriangleSurface>>>,
}

impl SurfaceSpec {
    /// A file that is read as it is.
    pub(super) fn new(file: String, place: Place) -> Self {
        Self { file, params: SurfaceParams::default(), place, loaded: Arc::default() }
    }
}

impl ShapeSpec {
    /// Whether the shape is known to end by itself; of a level set, nothing is known.
    pub fn is_bounded(&self) -> bool {
        match self {
            Self::Box(_) | Self::Sphere { .. } | Self::Polygon(_) | Self::Surface(_) => true,
            Self::Cylinder { length, .. } => length.is_some(),
            Self::HalfSpace { .. } | Self::LevelSet(_) => false,
            Self::Union(parts) => parts.iter().all(Self::is_bounded),
            Self::Intersection(parts) => parts.iter().any(Self::is_bounded),
            Self::Difference(parts) => parts.first().is_some_and(Self::is_bounded),
        }
    }
}

/// How nodes are placed.
#[derive(Debug, Clone)]
pub struct PointsSpec {
    /// Distance of neighbouring nodes; positive where it is constant. 1 for points from a file that leave it open.
    pub spacing: ExprField,
    /// How regular the cloud is; irregular, if the scene does not say.
    pub layout: LayoutName,
    /// Seed of the random numbers; 1, if the scene does not say.
    pub seed: u64,
    /// The file that the points come from, if they are not generated.
    pub file: Option<PointsFileSpec>,
    /// How far gaps and layers are refined, if they are.
    pub gaps: Option<GapSpec>,
    /// What spacings corners get at which the solution is singular, if they get any of their own.
    pub corners: Option<CornerSpec>,
    /// What else the cloud adapts to, where it adapts to corners.
    pub(crate) adapted: Adapted,
    /// The table in the file.
    pub place: Place,
}

/// What spacings gaps and layers between interfaces get.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GapSpec {
    /// The smallest one, positive.
    pub least: f64,
    /// So many go on the way through a layer.
    pub across: f64,
}

/// What spacings corners get at which the solution is singular.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CornerSpec {
    /// So many go on the way to what is next to a corner.
    pub across: f64,
}

/// What a cloud adapts to beside corners.
#[derive(Debug, Clone)]
pub(crate) struct Adapted {
    /// What the spacings that the data ask for are multiplied by, as the scene's own spacing is.
    pub(crate) times: f64,
    /// The smallest spacing in gaps, over the size of the domain, where the scene gives none.
    pub(crate) least_gap: f64,
    /// Spacings that a solution asks for.
    pub(crate) wanted: Arc<Vec<Wanted>>,
    /// What these are multiplied by.
    pub(crate) wanted_times: f64,
    /// What the data ask for, once that is known; shared by copies of the scene.
    pub(crate) features: Arc<OnceLock<Features>>,
}

impl Default for Adapted {
    fn default() -> Self {
        let (wanted, features) = (Arc::default(), Arc::default());
        Self { times: 1.0, least_gap: LEAST_GAP, wanted, wanted_times: 1.0, features }
    }
}

/// The smallest spacing in gaps, over the size of the domain, of clouds that adapt.
const LEAST_GAP: f64 = 1e-6;

/// A spacing that is asked for at a place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Wanted {
    /// Where; coordinates beyond the dimension are zero.
    pub(crate) at: [f64; 3],
    /// The spacing.
    pub(crate) spacing: f64,
    /// How far round it the spacing does not grow yet.
    pub(crate) within: f64,
}

/// What the data of a scene ask for, for a method of an order and a tolerance.
#[derive(Debug, Clone)]
pub(crate) struct Features {
    pub(crate) order: usize,
    pub(crate) tolerance: Option<f64>,
    pub(crate) wanted: Vec<Wanted>,
}

/// How regular a cloud is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LayoutName {
    /// `grid`
    Grid,
    /// `jittered`
    Jittered,
    /// `scattered`
    Scattered,
    /// `irregular`
    Irregular,
}

/// A hole: its surface is a face of the domain with the hole's name.
#[derive(Debug, Clone)]
pub struct HoleSpec {
    /// Name of the hole and of its face.
    pub name: String,
    /// What is cut out.
    pub shape: ShapeSpec,
    /// The table in the file.
    pub place: Place,
}

/// A material and where it is.
#[derive(Debug, Clone)]
pub struct RegionSpec {
    /// Name, used in the report.
    pub name: String,
    /// What points from a file call it, if not by its name.
    pub label: Option<String>,
    /// Where it is; `None` for the background, and for all where points from a file tell.
    pub geometry: Option<ShapeSpec>,
    /// The coefficient eta; positive where it is constant.
    pub diffusivity: ExprField,
    /// The source f; none is zero.
    pub source: Option<ExprField>,
    /// The factor of du/dt, positive where it is constant; none is 1. Steady scenes do not use it.
    pub capacity: Option<ExprField>,
    /// The velocity that carries u along, an expression for each axis; none where it is zero.
    pub velocity: Vec<ExprField>,
    /// The factor of u in the equation; none is zero.
    pub reaction: Option<ExprField>,
    /// The exact solution, where it is known.
    pub exact: Option<ExprField>,
    /// In free space, the curl of the velocity: one expression in 2-D, three in 3-D, none where it is zero.
    pub vorticity: Vec<ExprField>,
    /// The table in the file.
    pub place: Place,
}

/// What holds across the interface of two regions besides that eta jumps: `u_B / K_B - u_A / K_A = jump + resistance q_A` with
/// `q = eta du/dn`, and `q_B - q_A = flux_jump`.
#[derive(Debug, Clone)]
pub struct InterfaceSpec {
    /// Indices of two different regions A and B, as the scene names them; the normal points from A to B.
    pub between: [usize; 2],
    /// The resistance to a flux through the interface, not negative where it is constant; none is zero.
    pub resistance: Option<ExprField>,
    /// The partition coefficients `K_A` and `K_B`, positive, and the value in the file; none is 1 and 1.
    pub partition: Option<([f64; 2], Place)>,
    /// `u_B / K_B - u_A / K_A` where nothing flows; none is zero.
    pub jump: Option<ExprField>,
    /// `(eta du/dn)_B - (eta du/dn)_A`; none is zero.
    pub flux_jump: Option<ExprField>,
    /// The same at points of the interface, linear in between, in place of an expression.
    pub flux_jump_at: Option<PointValues>,
    /// How fast `jump` and `flux_jump` change, where they do, in the scene as it is at one time.
    pub(crate) rates: [Option<ExprField>; 2],
    /// u on the interface, in place of all of these.
    pub dirichlet: Option<ExprField>,
    /// The table in the file.
    pub place: Place,
}

/// Values at points of a closed curve (2-D) or of a triangulated surface (3-D).
#[derive(Debug, Clone, PartialEq)]
pub struct PointValues {
    /// The points.
    pub points: Vec<Vec<f64>>,
    /// A value each.
    pub values: Vec<f64>,
    /// Triangles by the indices of their points; empty in 2-D, where the points are joined in their order.
    pub triangles: Vec<[u32; 3]>,
}

/// An interface that ends inside the domain.
#[derive(Debug, Clone)]
pub struct SlitSpec {
    /// Name.
    pub name: String,
    /// Its vertices, at least two.
    pub polyline: Vec<[f64; 2]>,
    /// What holds on it.
    pub condition: SlitConditionSpec,
    /// Radius about its tips within which singular functions are used, not negative; none leaves it to the length.
    pub enrichment: Option<f64>,
    /// The table in the file.
    pub place: Place,
}

/// What holds on a slit.
#[derive(Debug, Clone)]
pub enum SlitConditionSpec {
    /// What jumps, from the right of the slit to its left; at least one of the two is given.
    Jump {
        /// `u_left - u_right`; none is zero.
        jump: Option<ExprField>,
        /// `(eta du/dn)_left - (eta du/dn)_right` with n to the left; none is zero.
        flux_jump: Option<ExprField>,
    },
    /// The same condition on each side, with n into the slit; never one on du/dn.
    OnEachSide(ConditionSpec),
}

/// A boundary condition for a part of the boundary.
///
/// Entries are tried in the order of the file, and the first one whose face and `where` match a boundary point is
/// its condition; `face = "all"` at the end catches the rest. A point that no entry matches is an error.
#[derive(Debug, Clone)]
pub struct BoundarySpec {
    /// A face of the domain, the name of a hole, or `all`.
    pub face: String,
    /// The entry matches where this is not zero; everywhere on the face, if absent.
    pub where_: Option<ExprField>,
    /// The condition.
    pub condition: ConditionSpec,
    /// The table in the file.
    pub place: Place,
}

/// A boundary condition; n is the outward normal.
#[derive(Debug, Clone)]
#[expect(clippy::large_enum_variant, reason = "a scene has a handful of conditions")]
pub enum ConditionSpec {
    /// u is given.
    Dirichlet(ExprField),
    /// du/dn is given.
    Neumann(ExprField),
    /// eta du/dn is given.
    Flux(ExprField),
    /// `a u + b eta du/dn = g`
    Robin {
        /// Coefficient of u.
        a: ExprField,
        /// Coefficient of the flux; not the constant 0.
        b: ExprField,
        /// Right-hand side.
        g: ExprField,
    },
}

/// What the scene overrides of the plan's choices.
#[derive(Debug, Clone, Default)]
pub struct MethodSpec {
    /// The method; `auto` leaves it to the plan.
    pub name: MethodName,
    /// Order of the stencils.
    pub order: Option<usize>,
    /// The linear solver; `auto` leaves it to the plan.
    pub solver: SolverName,
    /// Further options, each `None` unless the method has it and the scene gives it.
    pub options: MethodOptions,
}

/// Discretisations that are built. More names are recognised by the reader, which answers that they are not yet.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum MethodName {
    /// `auto`
    #[default]
    Auto,
    /// `gfdm-classical`
    GfdmClassical,
    /// `gfdm-conservative`
    GfdmConservative,
    /// `gfdm-positive`
    GfdmPositive,
    /// `gfdm-hybrid`
    GfdmHybrid,
    /// `particle-difference`
    ParticleDifference,
    /// `particle-difference-extended`
    ParticleDifferenceExtended,
    /// `immersed-interface`
    ImmersedInterface,
    /// `sharp`
    Sharp,
    /// `surface-reaction`
    SurfaceReaction,
    /// `free-space`: in free space, and nowhere else
    FreeSpace,
}

/// Linear solvers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum SolverName {
    /// `auto`
    #[default]
    Auto,
    /// `direct`
    Direct,
    /// `bicgstab`
    BiCgStab,
    /// `gmres`
    Gmres,
    /// `multigrid`
    Multigrid,
}

/// What to write besides the report; nothing, if the scene does not say.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct OutputSpec {
    /// Fields for ParaView.
    pub vtu: bool,
    /// A picture of the solution.
    pub plot: bool,
    /// The fields as comma-separated numbers.
    pub csv: bool,
    /// Fluxes through boundaries and interfaces, in the report.
    pub fluxes: bool,
    /// An estimate of the error; by default there is one.
    pub estimate: bool,
}

impl Default for OutputSpec {
    fn default() -> Self {
        Self { vtu: false, plot: false, csv: false, fluxes: false, estimate: true }
    }
}
