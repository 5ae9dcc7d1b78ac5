//! What is done where the nodes do not resolve what the method of a plan needs resolved, or its equations are not solved.

use meshless_interfaces::MethodError;

use super::effects::Survey;
use super::{MethodParams, MethodPlan, Plan, choose};
use crate::Error;
use crate::scene::{MethodName, Scene};

/// What a plan falls back on: the conservative method, where the choice of fits across interfaces was the plan's own. A
/// scene that names its method gets that or an error.
pub(super) fn of(scene: &Scene, method: &MethodPlan) -> Option<MethodName> {
    let ours = scene.method.name == MethodName::Auto;
    (ours && matches!(method.params, MethodParams::Sharp(_))).then_some(MethodName::GfdmHybrid)
}

impl Plan {
    /// The plan to go on with after `error`, where this one has something to fall back on for it.
    pub fn after(&self, error: &MethodError, scene: &Scene) -> Result<Option<Self>, Error> {
        let (
            Some(name),
            MethodError::Unresolved { .. } | MethodError::ThinLayer { .. } | MethodError::Solve(_),
        ) = (self.fallback, error)
        else {
            return Ok(None);
        };
        let survey = Survey::of(scene)?;
        // An order that was asked for is that of the fits; balances have their own.
        let mut scene = scene.clone();
        scene.method.order = None;
        let what = match error {
            MethodError::ThinLayer { region, position, thickness, spacing } => format!(
                "the region {region} is {thickness:.2e} thin near {position:?}, which a spacing of {spacing:.2e} there \
                 resolves (`refine_gaps_to` in [points])"
            ),
            error => error.to_string(),
        };
        let why = format!("in place of \"{}\": {what}", self.method.name.as_str());
        let method = choose::described(name, why, &scene, &survey);
        let solver = choose::solver(&scene, &survey, name, self.predicted.unknowns);
        let (mut stages, skipped) = choose::stages(&scene, &survey, &method);
        // What was taken out of a plan stays out.
        stages.retain(|stage| !stage.is_derived() || self.runs(*stage));
        Ok(Some(Self { method, solver, stages, skipped, fallback: None, ..self.clone() }))
    }
}
