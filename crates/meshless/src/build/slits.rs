//! Slits of a scene.

use meshless_geometry::{Domain, Slit};
use meshless_interfaces::{SlitCondition, SlitInterface};

use super::fields::field;
use crate::Error;
use crate::scene::{ConditionSpec, Scene, SlitConditionSpec, SlitSpec};

/// Distance from the boundary, relative to the size of the domain, up to which the end of a slit is on it.
const ON_BOUNDARY: f64 = 1e-9;

/// Radius about a tip within which its singular functions are used, unless the scene gives one, over the length of the
/// segment that ends there: beyond the segment the functions would jump where the slit does not run.
const ENRICHMENT: f64 = 0.5;

/// The slits, in the order of the scene.
pub(crate) fn slits<const D: usize>(
    scene: &Scene,
    domain: &Domain<D>,
) -> Result<Vec<SlitInterface<D>>, Error> {
    scene.slits.iter().map(|spec| slit(spec, domain)).collect()
}

fn slit<const D: usize>(spec: &SlitSpec, domain: &Domain<D>) -> Result<SlitInterface<D>, Error> {
    let vertices: Vec<[f64; D]> =
        spec.polyline.iter().map(|v| std::array::from_fn(|k| v.get(k).copied().unwrap_or(0.0))).collect();
    let tolerance = ON_BOUNDARY * domain.bounds().diameter();
    if let Some(outside) = vertices.iter().find(|v| !domain.contains(v, tolerance)) {
        let message = format!("the slit leaves the domain at {outside:?}");
        return Err(spec.place.error(message, "end it on the boundary or inside").into());
    }
    let inside = |v: Option<&[f64; D]>| v.is_some_and(|v| domain.level(v) < -tolerance);
    let tips = [inside(vertices.first()), inside(vertices.last())];
    let slit = Slit::new(vertices, tips).map_err(|e| spec.place.error(e.to_string(), ""))?;
    let ends = (0..2).filter(|&end| tips[end]).map(|end| slit.end_segment(end));
    let enrichment = spec.enrichment.unwrap_or_else(|| ENRICHMENT * ends.reduce(f64::min).unwrap_or(0.0));
    let condition = match &spec.condition {
        SlitConditionSpec::Jump { jump, flux_jump } => SlitCondition::Jump {
            value: jump.as_ref().map(|f| field(&f.expr)),
            flux: flux_jump.as_ref().map(|f| field(&f.expr)),
        },
        SlitConditionSpec::OnEachSide(condition) => match condition {
            ConditionSpec::Dirichlet(f) => SlitCondition::Dirichlet(field(&f.expr)),
            // The reader gives no others.
            ConditionSpec::Flux(f) | ConditionSpec::Neumann(f) => SlitCondition::Flux(field(&f.expr)),
            ConditionSpec::Robin { a, b, g } => {
                SlitCondition::Robin { a: field(&a.expr), b: field(&b.expr), g: field(&g.expr) }
            }
        },
    };
    Ok(SlitInterface { slit, condition, enrichment })
}
