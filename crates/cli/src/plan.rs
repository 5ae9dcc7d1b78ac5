//! `meshless plan`.

use meshless::plan::{Effect, Plan};
use meshless::scene::MethodName;
use serde::Serialize;

use crate::Failure;
use crate::args::PlanArgs;

/// A plan as JSON.
#[derive(Serialize)]
struct PlanJson<'a> {
    title: &'a str,
    dimension: usize,
    effects: Vec<&'static str>,
    method: &'static str,
    why: &'a str,
    fallback: Option<&'static str>,
    refine_gaps_to: Option<f64>,
    solver: String,
    /// In free space: what is transformed, and what is transformed back.
    #[serde(skip_serializing_if = "Option::is_none")]
    transforms: Option<TransformsJson>,
    estimate: Option<String>,
    stages: Vec<&'static str>,
    skipped: Vec<SkippedJson>,
    predicted: PredictedJson,
}

#[derive(Serialize)]
struct TransformsJson {
    forward: Vec<String>,
    back: Vec<String>,
}

#[derive(Serialize)]
struct SkippedJson {
    what: &'static str,
    why: &'static str,
}

#[derive(Serialize)]
struct PredictedJson {
    unknowns: f64,
    seconds: f64,
    estimate_seconds: f64,
    memory_mb: f64,
    /// In time.
    #[serde(skip_serializing_if = "Option::is_none")]
    steps: Option<f64>,
}

pub(crate) fn run(args: &PlanArgs) -> Result<(), Failure> {
    let scene = args.instead.read(&args.scene)?;
    let plan = Plan::new(&scene)?;
    if !args.json {
        say!("{}\n{plan}", scene.title);
        return Ok(());
    }
    let json = PlanJson {
        title: &scene.title,
        dimension: plan.dimension,
        effects: plan.effects.iter().map(Effect::name).collect(),
        method: plan.method.name.as_str(),
        why: &plan.method.why,
        fallback: plan.fallback.map(MethodName::as_str),
        refine_gaps_to: plan.refine_gaps_to,
        solver: plan.solver_name(),
        transforms: plan.transforms().map(|[forward, back]| TransformsJson { forward, back }),
        estimate: plan.estimate_name(),
        stages: plan.stages.iter().map(|s| s.name()).collect(),
        skipped: plan.skipped.iter().map(|s| SkippedJson { what: s.what, why: s.why }).collect(),
        predicted: PredictedJson {
            unknowns: plan.predicted.unknowns,
            seconds: plan.predicted.seconds,
            estimate_seconds: plan.predicted.estimate_seconds,
            memory_mb: plan.predicted.memory_mb,
            steps: plan.predicted.steps.map(|time| time.steps.round()),
        },
    };
    say!("{}", serde_json::to_string(&json).map_err(|e| Failure::failed(e.to_string()))?);
    Ok(())
}
