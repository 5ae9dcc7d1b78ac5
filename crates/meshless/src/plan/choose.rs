//! Decisions: method, solver, stages.

use meshless_interfaces::gfdm::Selection;
use meshless_interfaces::sharp::Sharp;
use meshless_sparse::{
    Candidate, MultigridParams, PreconditionerKind, Restriction, SmootherKind, SolverKind, SolverParams,
};

use super::effects::{Effect, Survey};
use super::{AccuracyPlan, MethodParams, MethodPlan, Skipped, Stage, knows, method};
use crate::Error;
use crate::scene::{InterfacesName, MethodName, Scene, SolverName};

/// Interaction radius in units of the spacing, by dimension: about 6, 27 and 45 neighbours. Not a distance that
/// occurs in a lattice, where round-off would decide who is a neighbour.
const SUPPORT: [f64; 3] = [3.1, 2.9, 2.2];

/// Unknowns up to which the direct solver is faster than multigrid, by dimension; see `docs/multigrid.md`.
const DIRECT_LIMIT: [f64; 3] = [f64::INFINITY, 30_000.0, 1_500.0];

/// The same where multigrid does not serve. In the plane it is memory that ends it, about 4 GB.
const DIRECT_LIMIT_WITHOUT_MULTIGRID: [f64; 3] = [f64::INFINITY, 250_000.0, 1_500.0];

/// Unknowns up to which factors step in where nothing else solves a system: by memory, and in space by minutes, too.
const DIRECT_MAX: [usize; 3] = [usize::MAX, 250_000, 20_000];

/// Relative true residual at which the Krylov solver stops.
const TOLERANCE: f64 = 1e-11;

/// Contrast above which a region may be stiff enough for its constant to be split off.
pub(super) const FLOATING_CONTRAST: f64 = 10.0;

/// Péclet number of a cell up to which fits and stencils resolve what a velocity makes.
pub(super) const RESOLVED: f64 = 2.0;

pub(super) fn method_plan(scene: &Scene, survey: &Survey) -> Result<MethodPlan, Error> {
    let slits = survey.has(|e| matches!(e, Effect::Slits));
    let named = scene.method.name;
    if let (Some(slit), false) = (scene.slits.first(), knows_slits(named)) {
        let message = format!("the method \"{}\" does not know slits", named.as_str());
        return Err(slit
            .place
            .error(message, "use \"particle-difference\", or leave the choice to the plan")
            .into());
    }
    let prescribed = scene.interfaces.iter().find(|i| i.dirichlet.is_some());
    if let (Some(interface), false) =
        (prescribed, matches!(named, MethodName::Auto | MethodName::ParticleDifferenceExtended))
    {
        let message = format!("the method \"{}\" cannot prescribe u on an interface", named.as_str());
        let help = "use \"particle-difference-extended\", or leave the choice to the plan";
        return Err(interface.place.error(message, help).into());
    }
    if let (true, Some(interface)) = (slits || scene.time.is_some(), prescribed) {
        let message = "u can be prescribed on an interface in steady scenes without slits only";
        return Err(interface.place.error(message, "prescribe jumps instead").into());
    }
    if scene.is_labelled() && scene.method.options.interfaces == Some(InterfacesName::Shapes) {
        let message = "the regions have no shapes: points from a file tell where they are";
        return Err(scene.points.place.error(message, "remove `method.interfaces`").into());
    }
    let accuracy = AccuracyPlan::new(scene).filter(|_| !slits);
    let mut order = scene.method.order;
    let (name, why) = match (named, accuracy) {
        (MethodName::Auto, _) if slits => {
            (MethodName::ParticleDifference, "a slit: stencils that do not see through it".to_owned())
        }
        (MethodName::Auto, _) if prescribed.is_some() => {
            let why = "u is prescribed on an interface: the jump of the slope is an unknown".to_owned();
            (MethodName::ParticleDifferenceExtended, why)
        }
        (MethodName::Auto, Some(goal)) => {
            let choice = goal.choose(scene, survey)?;
            order = choice.order;
            (choice.name, choice.why)
        }
        (MethodName::Auto, None) if survey.has_interface() => {
            let (name, why) = at_interfaces(scene, survey);
            (name, why.to_owned())
        }
        (MethodName::Auto, None) if survey.has_corners(scene) && offered(scene) => (
            MethodName::Sharp,
            "the solution is singular at corners: functions of their own there".to_owned(),
        ),
        (MethodName::Auto, None)
            if survey.has(|e| matches!(e, Effect::Advection { peclet } if *peclet > RESOLVED)) =>
        {
            (
                MethodName::GfdmConservative,
                "the velocity carries more than a cell conducts: upwind balances".to_owned(),
            )
        }
        (MethodName::Auto, None) => {
            (MethodName::GfdmClassical, "nothing jumps: stencils everywhere".to_owned())
        }
        (name, _) => {
            order = order.or_else(|| accuracy?.order(name, scene.dimension));
            (name, "asked for by the scene".to_owned())
        }
    };
    let scene = &scene.with_order(order);
    method::check(name, scene)?;
    knows::check(name, scene, survey)?;
    knows::check_partition(scene, survey)?;
    Ok(described(name, why, scene, survey))
}

/// What a scene takes where something jumps at an interface and no tolerance is given: fits of high order, unless the
/// interfaces are known roughly only, u changes with time, or fits would lose heat.
fn at_interfaces(scene: &Scene, survey: &Survey) -> (MethodName, &'static str) {
    let labels = scene.is_labelled() || scene.method.options.interfaces == Some(InterfacesName::Labels);
    if labels {
        (MethodName::GfdmHybrid, "interfaces are known to a share of the spacing only: balances there")
    } else if let Some(why) = survey.needs_balances(scene) {
        (MethodName::GfdmConservative, why)
    } else if survey.has(|e| matches!(e, Effect::Advection { peclet } if *peclet > RESOLVED)) {
        (MethodName::GfdmConservative, "the velocity carries more than a cell conducts: upwind balances")
    } else if scene.time.is_some() && !scene.output.fluxes || !offered(scene) {
        (MethodName::GfdmHybrid, "something jumps at an interface: balances there, stencils elsewhere")
    } else {
        (MethodName::Sharp, "something jumps at an interface: one polynomial on each side, joined there")
    }
}

/// Whether the sharp method has the order that the scene asks for, if it does.
fn offered(scene: &Scene) -> bool {
    scene.method.order.is_none_or(|order| Sharp::offers(order, scene.dimension))
}

/// A method with its parameters as the scene asks for them.
pub(super) fn described(name: MethodName, why: String, scene: &Scene, survey: &Survey) -> MethodPlan {
    let params = MethodParams::new(name, scene, survey);
    let dimension = scene.dimension;
    let wanted = params.support(dimension).unwrap_or(SUPPORT[dimension - 1]);
    let support = scene.method.options.support.unwrap_or(wanted);
    MethodPlan { name, why, support, params }
}

/// Methods that a scene with slits can name.
fn knows_slits(name: MethodName) -> bool {
    matches!(name, MethodName::Auto | MethodName::ParticleDifference)
}

/// Matrices that multigrid does not get along with: equations of jumps at interface points, and one-sided stencils at slits, have
/// no diagonal to smooth with.
fn outpaces_multigrid(name: MethodName, survey: &Survey) -> bool {
    name == MethodName::ParticleDifferenceExtended || survey.has(|e| matches!(e, Effect::Slits))
}

/// Other entries of a row, in diagonals, from which its unknown stays on every level; rows with ghosts, which are longer, have
/// more of them. See `docs/multigrid.md`.
const KEEP: f64 = 1.4;
const KEEP_WITH_GHOSTS: f64 = 2.0;

/// Bonds of rows with ghosts in space, some seventy, that are strong from this part of the largest on: by that of other rows half of them
/// would be, and aggregates of 50 nodes. See `docs/multigrid.md`.
const STRONG_WITH_GHOSTS_IN_SPACE: f64 = 0.5;

/// Rows of the sharp method have large entries of either sign, and those that cross an interface are not conservative: an
/// incomplete factorisation smooths them better, and their columns need a restriction of their own; see `docs/sharp.md`.
/// Stencils that cross interfaces without balances have such rows there only, which coarse levels must leave as they are.
fn multigrid(method: MethodName, dimension: usize, survey: &Survey) -> MultigridParams {
    let chosen = MultigridParams::default();
    if survey.has(|e| matches!(e, Effect::Advection { peclet } if *peclet > RESOLVED)) {
        // Rows that look upstream: an incomplete factorisation in the order of the stream, and restrictions of their own.
        return MultigridParams {
            smoother: SmootherKind::Ilu0,
            restriction: Restriction::Own,
            candidate: Candidate::Constant,
            ..chosen
        };
    }
    let jumps = survey.contrast > FLOATING_CONTRAST;
    match method {
        MethodName::GfdmClassical | MethodName::GfdmPositive if jumps => {
            MultigridParams { keep: KEEP, ..chosen }
        }
        MethodName::ImmersedInterface => MultigridParams {
            keep: if jumps { KEEP_WITH_GHOSTS } else { chosen.keep },
            threshold: if dimension == 3 { STRONG_WITH_GHOSTS_IN_SPACE } else { chosen.threshold },
            ..chosen
        },
        MethodName::Sharp => MultigridParams {
            smoother: SmootherKind::Ilu0,
            restriction: Restriction::Own,
            candidate: Candidate::Constant,
            ..chosen
        },
        _ => chosen,
    }
}

pub(super) fn solver(scene: &Scene, survey: &Survey, method: MethodName, unknowns: f64) -> SolverParams {
    let outpaced = outpaces_multigrid(method, survey);
    let limits = if outpaced { DIRECT_LIMIT_WITHOUT_MULTIGRID } else { DIRECT_LIMIT };
    let direct = unknowns <= limits[scene.dimension - 1];
    let kind = match scene.method.solver {
        SolverName::Direct => SolverKind::Direct,
        SolverName::BiCgStab => SolverKind::BiCgStab { l: 2 },
        SolverName::Gmres => SolverKind::Gmres { restart: 60 },
        SolverName::Auto if direct => SolverKind::Direct,
        SolverName::Auto if outpaced => SolverKind::BiCgStab { l: 2 },
        SolverName::Auto | SolverName::Multigrid => SolverKind::Multigrid,
    };
    SolverParams {
        kind,
        preconditioner: match kind {
            SolverKind::Multigrid => {
                PreconditionerKind::Multigrid(multigrid(method, scene.dimension, survey))
            }
            _ => PreconditionerKind::Ilu0,
        },
        tolerance: TOLERANCE,
        direct_max: DIRECT_MAX[scene.dimension - 1],
        ..SolverParams::default()
    }
}

/// Whether a method knows the fluxes through a surface: by gradients that are good up to it (fits to nodal values of first order at an
/// interface give fluxes there that are off by up to 40 %), or by balances over cells. Where interfaces are known from labels only, gradients
/// up to them are worthless.
fn carries_fluxes(scene: &Scene, survey: &Survey, method: &MethodPlan) -> bool {
    let slits = survey.has(|e| matches!(e, Effect::Slits));
    let labels = scene.is_labelled() || scene.method.options.interfaces == Some(InterfacesName::Labels);
    match &method.params {
        MethodParams::Gfdm(gfdm) if gfdm.selection == Selection::All => true,
        MethodParams::Gfdm(gfdm) if labels && gfdm.selection != Selection::None => true,
        MethodParams::Sharp(_) => !labels,
        _ => !survey.has_interface() && !slits,
    }
}

pub(super) fn stages(scene: &Scene, survey: &Survey, method: &MethodPlan) -> (Vec<Stage>, Vec<Skipped>) {
    let mut stages = Vec::new();
    let mut skipped = Vec::new();
    let mut decide = |runs: bool, stage: Stage, why: &'static str| {
        if runs {
            stages.push(stage);
        } else {
            skipped.push(Skipped { what: stage.name(), why });
        }
    };
    let exact = scene.regions.iter().all(|r| r.exact.is_some());
    let steps = method.params.steps(survey);
    let variable = !survey.uniform;
    decide(true, Stage::Points, "");
    decide(true, Stage::Neighbors, "");
    decide(scene.regions.len() > 1, Stage::Regions, "there is one region");
    // Not listed among what is skipped: hardly a scene asks for it.
    if scene.is_labelled() || scene.method.options.interfaces == Some(InterfacesName::Labels) {
        decide(scene.regions.len() > 1, Stage::PhaseField, "there is one region");
    }
    decide(variable, Stage::Diffusivity, "the diffusivity is one constant");
    decide(survey.has(|e| matches!(e, Effect::Source)), Stage::Source, "the scene has no source");
    decide(
        steps.stencils && !variable,
        Stage::LaplacianStencils,
        if steps.stencils { "the diffusivity varies" } else { steps.no_stencils },
    );
    decide(
        steps.stencils && variable,
        Stage::DiffusionStencils,
        if steps.stencils { "the diffusivity is one constant" } else { steps.no_stencils },
    );
    if let Some(constrained) = steps.constrained {
        decide(constrained, Stage::ConstrainedStencils, "nothing jumps anywhere");
    }
    let functions = matches!(method.params, MethodParams::Sharp(_)) && survey.has_corner_functions(scene);
    let none = match survey.has(|e| matches!(e, Effect::Corners { .. })) {
        true => "they serve straight corners and edges of steady scenes, with the method \"sharp\"",
        false => "no corner is known at which the solution is singular",
    };
    decide(functions, Stage::CornerFunctions, none);
    decide(steps.selection, Stage::NodeSelection, "the method does not mix rows");
    decide(steps.may_need_cells, Stage::Cells, "no row is conservative");
    decide(true, Stage::Assembly, "");
    let may_float =
        survey.contrast > FLOATING_CONTRAST || survey.has(|e| matches!(e, Effect::ContactResistance));
    decide(
        may_float,
        Stage::FloatingConstants,
        "no region is much stiffer than its neighbours, or behind a film",
    );
    decide(true, Stage::Solve, "");
    decide(scene.time.is_some(), Stage::TimeSteps, "the scene is steady");
    let fields = exact || scene.output.vtu || scene.output.csv;
    decide(fields, Stage::Gradient, "neither exact solution nor field output asks for it");
    decide(exact, Stage::Errors, "the scene has no exact solution");
    decide(!scene.probes.is_empty(), Stage::Probes, "the scene has no probes");
    if scene.output.fluxes {
        decide(
            carries_fluxes(scene, survey, method),
            Stage::Fluxes,
            "the method has no gradients up to interfaces",
        );
    }
    decide(true, Stage::Balance, "");
    decide(scene.output.estimate, Stage::Estimate, "the scene asks for none");
    decide(scene.accuracy.is_some(), Stage::Refinement, "no error to reach is given");
    decide(scene.output.vtu, Stage::Diagnosis, "no field output asks for it");
    decide(scene.output.vtu, Stage::Vtu, "not asked for");
    decide(scene.output.csv, Stage::Csv, "not asked for");
    decide(scene.output.plot, Stage::Plot, "not asked for");
    let mut absent = |present: bool, what: &'static str, why: &'static str| {
        if !present {
            skipped.push(Skipped { what, why });
        }
    };
    absent(survey.has_interface(), "interface", "nothing jumps anywhere");
    absent(survey.has(|e| matches!(e, Effect::ValueJump)), "value jump", "none is given");
    absent(survey.has(|e| matches!(e, Effect::FluxJump)), "flux jump", "none is given");
    let contact = |e: &Effect| matches!(e, Effect::ContactResistance | Effect::Partition);
    absent(!survey.has_interface() || survey.has(contact), "contact", "regions are perfectly joined");
    absent(survey.has(|e| matches!(e, Effect::Advection { .. })), "advection", "nothing moves");
    absent(survey.has(|e| matches!(e, Effect::Reaction)), "reaction", "no region has one");
    let capacity = scene.time.is_none() && scene.regions.iter().any(|r| r.capacity.is_some());
    absent(!capacity, "capacity", "the scene is steady");
    absent(false, "free space", "the domain is bounded");
    (stages, skipped)
}
