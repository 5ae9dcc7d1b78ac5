//! Whether the nodes resolve what lies between two interfaces.

use meshless_interfaces::{Problem, thin_layers};

use crate::Error;
use crate::plan::{MethodParams, Plan};
use crate::report::ThinLayerReport;
use crate::scene::Scene;

/// The layer that is too thin for the nodes: what fits across interfaces resolve least, or what the nodes of another method
/// do not see at all.
pub(crate) fn thin_layer<const D: usize>(
    scene: &Scene,
    plan: &Plan,
    problem: &Problem<'_, D>,
) -> Result<Option<ThinLayerReport>, Error> {
    let fitted = matches!(plan.method.params, MethodParams::Sharp(_));
    let layer = if fitted { thin_layers::thinnest(problem) } else { thin_layers::unseen(problem)? };
    Ok(layer.map(|layer| ThinLayerReport {
        region: scene.regions[layer.region as usize].name.clone(),
        at: layer.at.to_vec(),
        thickness: layer.thickness,
        resolving_spacing: thin_layers::resolving_spacing(&layer),
        seen: fitted,
    }))
}
