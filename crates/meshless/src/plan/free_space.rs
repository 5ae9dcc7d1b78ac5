//! Plans of scenes in free space.

use meshless_sparse::SolverParams;

use super::effects::{Effect, Survey};
use super::{AccuracyPlan, MethodParams, MethodPlan, Plan, Predicted, Skipped, Stage};
use crate::scene::{MethodName, Scene};
use crate::{Error, MAX_NODES};

/// Microseconds a point of the mesh, one solve with its gradient on one core.
const MICROSECONDS: f64 = 0.5;

/// Bytes a point: half-spectra and results of phi and its gradient, and the kernel.
const BYTES: [f64; 3] = [150.0, 150.0, 200.0];

pub(super) fn plan(scene: &Scene, survey: Survey) -> Result<Plan, Error> {
    if !matches!(scene.method.name, MethodName::FreeSpace | MethodName::Auto) {
        let message = format!("the method \"{}\" is for bounded domains", scene.method.name.as_str());
        return Err(scene.domain.place.error(message, "the method in free space is \"free-space\"").into());
    }
    if scene.output.fluxes {
        let message = "free space has no boundaries and no interfaces that a flux could go through";
        return Err(scene
            .domain
            .place
            .error(message, "remove `output.fluxes`, or give a bounded domain")
            .into());
    }
    let points: f64 = crate::build::mesh_cells(scene)?.iter().map(|&n| n as f64).product();
    if points > MAX_NODES as f64 {
        let message = format!("the spacing gives {points:.2e} points, and at most {MAX_NODES} are allowed");
        return Err(scene.error_at(&scene.points.spacing, message, "take a larger spacing").into());
    }
    let uneven = scene.regions.iter().find(|r| r.diffusivity.expr.as_constant().is_none_or(|eta| eta <= 0.0));
    let differs = scene
        .regions
        .iter()
        .find(|r| r.diffusivity.expr.as_constant() != scene.regions[0].diffusivity.expr.as_constant());
    if let Some(region) = uneven.or(differs) {
        let help = "give all regions the same positive number, or give a bounded domain";
        let message = "in free space the diffusivity is one constant";
        return Err(scene.error_at(&region.diffusivity, message, help).into());
    }
    let (stages, skipped) = stages(scene, &survey);
    let name = MethodName::FreeSpace;
    Ok(Plan {
        dimension: scene.dimension,
        method: MethodPlan {
            name,
            why: "the domain is free space: convolution with a Green's function".to_owned(),
            support: 0.0,
            params: MethodParams::new(name, scene, &survey),
        },
        fallback: None,
        refine_gaps_to: None,
        adapts: false,
        adapts_to_data: false,
        // Nothing fixes a constant because nothing is needed to: u decays, or grows as it must.
        effects: survey.effects.into_iter().filter(|e| !matches!(e, Effect::PureNeumann)).collect(),
        solver: SolverParams::default(),
        accuracy: AccuracyPlan::new(scene),
        stages,
        skipped,
        predicted: Predicted {
            unknowns: points,
            seconds: 1e-6 * MICROSECONDS * points,
            estimate_seconds: 0.0,
            steps: None,
            memory_mb: 10.0 + 1e-6 * BYTES[scene.dimension - 1] * points,
        },
    })
}

fn stages(scene: &Scene, survey: &Survey) -> (Vec<Stage>, Vec<Skipped>) {
    let (mut stages, mut skipped) = (Vec::new(), Vec::new());
    let mut decide = |runs: bool, stage: Stage, why: &'static str| {
        if runs {
            stages.push(stage);
        } else {
            skipped.push(Skipped { what: stage.name(), why });
        }
    };
    const NO_SYSTEM: &str = "a convolution has no linear system";
    let exact = scene.regions.iter().all(|r| r.exact.is_some());
    let particles = scene.free_space.as_ref().is_some_and(|s| s.particles.is_some());
    decide(true, Stage::Points, "");
    decide(scene.regions.len() > 1, Stage::Regions, "there is one region");
    let source = particles || survey.has(|e| matches!(e, Effect::Source));
    decide(source, Stage::Source, "the scene has no source");
    for stage in [Stage::Neighbors, Stage::LaplacianStencils, Stage::Cells, Stage::Assembly] {
        decide(false, stage, NO_SYSTEM);
    }
    decide(true, Stage::Solve, "");
    decide(false, Stage::TimeSteps, "the scene is steady");
    let turns = survey.has(|e| matches!(e, Effect::Vorticity));
    decide(turns, Stage::Velocity, "the scene has no vorticity");
    let potential = exact || source || !turns;
    let fields = exact || scene.output.vtu || scene.output.csv;
    let why = if potential {
        "neither exact solution nor field output asks for it"
    } else {
        "the scene has no source"
    };
    decide(potential && fields, Stage::Gradient, why);
    decide(exact, Stage::Errors, "the scene has no exact solution");
    decide(!scene.probes.is_empty(), Stage::Probes, "the scene has no probes");
    decide(true, Stage::Estimate, "");
    decide(scene.output.vtu, Stage::Vtu, "not asked for");
    decide(scene.output.csv, Stage::Csv, "not asked for");
    decide(scene.output.plot, Stage::Plot, "not asked for");
    skipped.push(Skipped { what: "interface", why: "the diffusivity is one constant" });
    skipped.push(Skipped { what: "boundary", why: "the domain is free space" });
    (stages, skipped)
}
