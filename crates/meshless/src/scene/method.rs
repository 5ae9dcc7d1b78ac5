//! `[method]`: names, and which options belong to which method.

use meshless_expr::nearest_name;

use super::error::SceneError;
use super::free_space;
use super::options::{
    ConservationName, GhostsName, InterfacesName, KernelName, MethodOptions, ReactionName, SigmaName,
    WedgeName, WeightName,
};
use super::reader::{Table, Value};
use super::spec::{MethodName, MethodSpec, SolverName};

/// Lowest and highest polynomial degree of stencils.
const ORDERS: [u64; 2] = [2, 8];

/// The same for the sharp method, whose orders are even.
const SHARP_ORDERS: [u64; 2] = [2, 16];

/// Most smoothing cycles; the diffusivity is flat long before.
const MAX_SMOOTHING: u64 = 100;

/// Largest width over which an interface is smeared, in spacings.
const MAX_WIDTH: f64 = 10.0;

/// Methods by name.
const METHODS: [(&str, MethodName); 11] = [
    ("auto", MethodName::Auto),
    ("gfdm-classical", MethodName::GfdmClassical),
    ("gfdm-conservative", MethodName::GfdmConservative),
    ("gfdm-positive", MethodName::GfdmPositive),
    ("gfdm-hybrid", MethodName::GfdmHybrid),
    ("particle-difference", MethodName::ParticleDifference),
    ("particle-difference-extended", MethodName::ParticleDifferenceExtended),
    ("immersed-interface", MethodName::ImmersedInterface),
    ("sharp", MethodName::Sharp),
    ("surface-reaction", MethodName::SurfaceReaction),
    ("free-space", MethodName::FreeSpace),
];

/// Solvers by name.
const SOLVERS: [(&str, SolverName); 5] = [
    ("auto", SolverName::Auto),
    ("direct", SolverName::Direct),
    ("bicgstab", SolverName::BiCgStab),
    ("gmres", SolverName::Gmres),
    ("multigrid", SolverName::Multigrid),
];

/// Weights by name.
const WEIGHTS: [(&str, WeightName); 2] =
    [("quartic", WeightName::Quartic), ("exponential", WeightName::Exponential)];

/// Wedges by name.
const WEDGES: [(&str, WedgeName); 3] =
    [("quadratic", WedgeName::Quadratic), ("plane", WedgeName::Plane), ("varying", WedgeName::Varying)];

/// Ghosts by name.
const GHOSTS: [(&str, GhostsName); 5] = [
    ("constrained", GhostsName::Constrained),
    ("linear", GhostsName::Linear),
    ("trilinear", GhostsName::Trilinear),
    ("quadratic", GhostsName::Quadratic),
    ("cubic", GhostsName::Cubic),
];

/// Smoothings of indicators by name.
const KERNELS: [(&str, KernelName); 3] = [
    ("convolution", KernelName::Convolution),
    ("diffusion", KernelName::Diffusion),
    ("distance", KernelName::Distance),
];

/// Diffusivities across an interface by name.
const SIGMAS: [(&str, SigmaName); 3] =
    [("harmonic", SigmaName::Harmonic), ("arithmetic", SigmaName::Arithmetic), ("sharp", SigmaName::Sharp)];

/// Nodes with balances by name.
const CONSERVATIONS: [(&str, ConservationName); 3] = [
    ("none", ConservationName::None),
    ("crossing", ConservationName::Crossing),
    ("all", ConservationName::All),
];

/// Sources at interfaces by name.
const REACTIONS: [(&str, ReactionName); 2] =
    [("operator", ReactionName::Operator), ("smoothed", ReactionName::Smoothed)];

/// Where interfaces are from, by name.
const INTERFACES: [(&str, InterfacesName); 2] =
    [("shapes", InterfacesName::Shapes), ("labels", InterfacesName::Labels)];

/// Methods with stencils in strong form.
const STRONG: &[MethodName] = &[MethodName::GfdmClassical, MethodName::GfdmPositive, MethodName::GfdmHybrid];
/// Methods that choose their conservative nodes.
const SELECTING: &[MethodName] = &[MethodName::GfdmPositive, MethodName::GfdmHybrid];
/// Methods that a scene can name.
const NAMED: &[MethodName] = &[
    MethodName::GfdmClassical,
    MethodName::GfdmConservative,
    MethodName::GfdmPositive,
    MethodName::GfdmHybrid,
];
/// All methods; the plan's choice has a support, too.
const EVERY: &[MethodName] = &[
    MethodName::Auto,
    MethodName::GfdmClassical,
    MethodName::GfdmConservative,
    MethodName::GfdmPositive,
    MethodName::GfdmHybrid,
    MethodName::ParticleDifference,
    MethodName::ParticleDifferenceExtended,
    MethodName::ImmersedInterface,
    MethodName::Sharp,
    MethodName::SurfaceReaction,
];
/// Methods whose stencils know interfaces.
const PARTICLE: &[MethodName] = &[MethodName::ParticleDifference];
/// Methods that continue values over interfaces by a wedge.
const WEDGED: &[MethodName] = &[MethodName::ParticleDifference, MethodName::ParticleDifferenceExtended];
/// Methods that continue fields beyond interfaces.
const IMMERSED: &[MethodName] = &[MethodName::ImmersedInterface];
/// Methods whose fits know interfaces.
const SHARP: &[MethodName] = &[MethodName::Sharp];
/// Methods that smear interfaces.
const REACTION: &[MethodName] = &[MethodName::SurfaceReaction];

/// Methods with a kernel and its radius, which are other ones in free space.
const KERNEL: &[MethodName] = &[MethodName::SurfaceReaction, MethodName::FreeSpace];

/// Options and the methods that have them.
const OPTIONS: [(&str, &[MethodName]); 18] = [
    ("smoothing", STRONG),
    ("log_scaling", STRONG),
    ("correction", STRONG),
    ("conservative_neumann", NAMED),
    ("support", EVERY),
    ("selection_tolerance", SELECTING),
    ("select_by_region", SELECTING),
    ("weight", WEDGED),
    ("wedge", WEDGED),
    ("flux_weights", PARTICLE),
    ("visibility", PARTICLE),
    ("ghosts", IMMERSED),
    ("conservation", SHARP),
    ("kernel", KERNEL),
    ("sigma", KERNEL),
    ("reaction", REACTION),
    ("width", REACTION),
    ("interfaces", EVERY),
];

pub(super) fn method(root: &Table<'_>) -> Result<MethodSpec, SceneError> {
    let Some(value) = root.get("method") else { return Ok(free_space::default_method(root)) };
    let table = value.table()?;
    let keys: Vec<&str> =
        ["name", "order", "solver"].into_iter().chain(OPTIONS.map(|(key, _)| key)).collect();
    table.allow(&keys)?;
    let open = free_space::is_open(root);
    let auto = if open { MethodName::FreeSpace } else { MethodName::Auto };
    let name = match table.get("name") {
        Some(value) => free_space::checked(method_name(&value)?, open, &value)?,
        None => auto,
    };
    Ok(MethodSpec {
        name,
        order: table.get("order").map(|value| order(&value, name)).transpose()?,
        solver: table.get("solver").map_or(Ok(SolverName::Auto), |value| solver_name(&value))?,
        options: options(&table, name)?,
    })
}

fn order(value: &Value<'_>, method: MethodName) -> Result<usize, SceneError> {
    if method == MethodName::FreeSpace {
        return free_space::order(value);
    }
    if method != MethodName::Sharp {
        let order = value.integer(ORDERS[0], ORDERS[1]).map_err(|error| {
            let sharps = value.integer(ORDERS[1], SHARP_ORDERS[1]).is_ok();
            let help = "name = \"sharp\" has even orders up to 16, and up to 8 in 3-D";
            if sharps { value.error(error.message, help) } else { error }
        })?;
        return Ok(order as usize);
    }
    let order = value.integer(SHARP_ORDERS[0], SHARP_ORDERS[1])? as usize;
    if order.is_multiple_of(2) {
        return Ok(order);
    }
    let message = format!("expected an even order, found {order}");
    Err(value.error(message, "the orders of the method \"sharp\" are 2, 4, 6, 8, … 16, and up to 8 in 3-D"))
}

fn method_name(value: &Value<'_>) -> Result<MethodName, SceneError> {
    MethodName::parse(value.text()?).map_err(|error| {
        let help = error.help();
        value.error(error.to_string(), help)
    })
}

fn solver_name(value: &Value<'_>) -> Result<SolverName, SceneError> {
    value.one_of(&SOLVERS)
}

fn options(table: &Table<'_>, method: MethodName) -> Result<MethodOptions, SceneError> {
    for (key, methods) in OPTIONS {
        if let Some(value) = table.get(key) {
            check_owner(&value, key, methods, method)?;
        }
    }
    // In free space these are read with the rest of it.
    let of_reaction = |key: &str| table.get(key).filter(|_| method == MethodName::SurfaceReaction);
    let flag = |key: &str| table.get(key).map(|value| value.boolean()).transpose();
    let smoothing = table.get("smoothing").map(|value| value.integer(0, MAX_SMOOTHING)).transpose()?;
    Ok(MethodOptions {
        smoothing: smoothing.map(|cycles| cycles as usize),
        log_scaling: flag("log_scaling")?,
        correction: flag("correction")?,
        conservative_neumann: flag("conservative_neumann")?,
        support: table.get("support").map(|value| support(&value)).transpose()?,
        selection_tolerance: table.get("selection_tolerance").map(|value| tolerance(&value)).transpose()?,
        select_by_region: flag("select_by_region")?,
        weight: table.get("weight").map(|value| value.one_of(&WEIGHTS)).transpose()?,
        flux_weights: flag("flux_weights")?,
        visibility: flag("visibility")?,
        ghosts: table.get("ghosts").map(|value| value.one_of(&GHOSTS)).transpose()?,
        conservation: table.get("conservation").map(|value| value.one_of(&CONSERVATIONS)).transpose()?,
        kernel: of_reaction("kernel").map(|value| value.one_of(&KERNELS)).transpose()?,
        sigma: of_reaction("sigma").map(|value| value.one_of(&SIGMAS)).transpose()?,
        reaction: table.get("reaction").map(|value| value.one_of(&REACTIONS)).transpose()?,
        width: table.get("width").map(|value| width(&value)).transpose()?,
        interfaces: table.get("interfaces").map(|value| value.one_of(&INTERFACES)).transpose()?,
        wedge: table.get("wedge").map(|value| value.one_of(&WEDGES)).transpose()?,
    })
}

/// An option belongs to certain methods and is refused by the others.
fn check_owner(
    value: &Value<'_>,
    key: &str,
    owners: &[MethodName],
    method: MethodName,
) -> Result<(), SceneError> {
    if owners.contains(&method) {
        return Ok(());
    }
    if owners.is_empty() {
        return Err(value.not_supported(&format!("the method with the option `{key}`"), "remove the key"));
    }
    let message = format!("the method \"{}\" has no option `{key}`", method.as_str());
    let owners: Vec<String> = owners.iter().map(|owner| format!("\"{}\"", owner.as_str())).collect();
    Err(value.error(message, format!("the option belongs to name = {}", owners.join(", "))))
}

fn support(value: &Value<'_>) -> Result<f64, SceneError> {
    match value.number()? {
        radius if radius > 1.0 => Ok(radius),
        radius => {
            let help = "the radius is in units of the spacing";
            Err(value.error(format!("expected a number above 1, found {radius}"), help))
        }
    }
}

fn width(value: &Value<'_>) -> Result<f64, SceneError> {
    match value.number()? {
        width if width > 0.0 && width <= MAX_WIDTH => Ok(width),
        width => {
            let help = format!("the width is in units of the spacing, at most {MAX_WIDTH}");
            Err(value.error(format!("expected a positive number, found {width}"), help))
        }
    }
}

fn tolerance(value: &Value<'_>) -> Result<f64, SceneError> {
    match value.number()? {
        tolerance if tolerance >= 0.0 => Ok(tolerance),
        tolerance => Err(value.error(format!("expected a number not below 0, found {tolerance}"), "")),
    }
}

/// Why a text is not the name of a method.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum MethodNameError {
    /// There is no such method.
    #[error("unknown method \"{}\"", .0.escape_debug())]
    Unknown(String),
}

impl MethodNameError {
    /// The names that can be used, the nearest one first.
    pub fn help(&self) -> String {
        let known = METHODS.map(|(name, _)| name);
        let all = known.join(", ");
        match self {
            Self::Unknown(name) => match nearest_name(name, known) {
                Some(near) => format!("did you mean \"{near}\"? The methods are {all}"),
                None => format!("the methods are {all}"),
            },
        }
    }
}

impl MethodName {
    /// The method of a name as a scene has it.
    ///
    /// # Errors
    ///
    /// If there is no such method, or not yet.
    pub fn parse(name: &str) -> Result<Self, MethodNameError> {
        match METHODS.iter().find(|(known, _)| *known == name) {
            Some((_, method)) => Ok(*method),
            None => Err(MethodNameError::Unknown(name.to_owned())),
        }
    }

    /// The name as a scene has it.
    pub fn as_str(self) -> &'static str {
        METHODS.iter().find(|(_, method)| *method == self).map_or("", |(name, _)| name)
    }
}

impl SolverName {
    /// The name as a scene has it.
    pub fn as_str(self) -> &'static str {
        SOLVERS.iter().find(|(_, solver)| *solver == self).map_or("", |(name, _)| name)
    }
}
