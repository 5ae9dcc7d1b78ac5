//! Expressions of a scene as fields, and their values at nodes.

use std::sync::Arc;

use meshless_expr::Expr;
use meshless_interfaces::{Field, InterfaceLaw, Material, ScalarField, SurfaceField};

use crate::Error;
use crate::execute::Exact;
use crate::scene::{ExprField, PointValues, RegionSpec, Scene};

/// An expression with its derivatives, which are formed once.
struct ExprScalar<const D: usize> {
    value: Expr,
    partials: [Expr; D],
}

impl<const D: usize> ScalarField<D> for ExprScalar<D> {
    fn eval(&self, points: &[[f64; D]], out: &mut [f64]) {
        self.value.eval_points(points, &[], out);
    }

    fn gradient(&self, point: &[f64; D]) -> Option<[f64; D]> {
        Some(std::array::from_fn(|k| self.partials[k].eval(point)))
    }
}

/// An expression as a field; a constant expression is a constant field.
pub(crate) fn field<const D: usize>(expr: &Expr) -> Field<D> {
    match expr.as_constant() {
        Some(value) => Field::Constant(value),
        None => {
            let partials = std::array::from_fn(|k| expr.derivative(k));
            Field::Function(Arc::new(ExprScalar { value: expr.clone(), partials }))
        }
    }
}

/// The data of all regions.
pub(crate) fn materials<const D: usize>(scene: &Scene) -> Vec<Material<D>> {
    scene
        .regions
        .iter()
        .map(|r| Material {
            source: r.source.as_ref().map(|s| field(&s.expr)),
            capacity: r.capacity.as_ref().map(|c| field(&c.expr)),
            velocity: velocity(r),
            reaction: nonzero(&r.reaction),
            ..Material::new(field(&r.diffusivity.expr))
        })
        .collect()
}

/// The velocity of a region, where it is not zero everywhere.
fn velocity<const D: usize>(region: &RegionSpec) -> Option<[Field<D>; D]> {
    let moves = region.velocity.iter().any(|component| component.expr.as_constant() != Some(0.0));
    moves.then(|| std::array::from_fn(|axis| field(&region.velocity[axis].expr)))
}

/// Values at points, linear in between.
fn at_points<const D: usize>(given: &PointValues) -> Option<Field<D>> {
    let points = given.points.iter().map(|p| std::array::from_fn(|k| p[k])).collect();
    let field = match given.triangles.is_empty() {
        true => SurfaceField::polygon(points, given.values.clone()),
        false => {
            let triangles = given.triangles.iter().map(|t| t.to_vec()).collect();
            SurfaceField::new(points, given.values.clone(), triangles)
        }
    };
    // The reader has checked numbers, lengths and indices.
    field.ok().map(|field| Field::Function(Arc::new(field)))
}

/// The laws of the interfaces at which something jumps.
pub(crate) fn laws<const D: usize>(scene: &Scene) -> Vec<InterfaceLaw<D>> {
    scene
        .interfaces
        .iter()
        .map(|i| InterfaceLaw {
            value: nonzero(&i.jump),
            flux: i.flux_jump_at.as_ref().map_or_else(|| nonzero(&i.flux_jump), at_points),
            prescribed: i.dirichlet.as_ref().map(|f| field(&f.expr)),
            resistance: nonzero(&i.resistance),
            partition: i.partition.as_ref().map_or([1.0; 2], |(partition, _)| *partition),
            ..InterfaceLaw::new(i.between.map(|r| r as u16))
        })
        .filter(|j| j.value.is_some() || j.flux.is_some() || j.prescribed.is_some() || j.is_imperfect())
        .collect()
}

/// How fast they change, in a scene as it is at one time.
pub(crate) fn law_rates<const D: usize>(scene: &Scene) -> Vec<InterfaceLaw<D>> {
    scene
        .interfaces
        .iter()
        .map(|i| InterfaceLaw {
            value: nonzero(&i.rates[0]),
            flux: nonzero(&i.rates[1]),
            ..InterfaceLaw::new(i.between.map(|r| r as u16))
        })
        .filter(|j| j.value.is_some() || j.flux.is_some())
        .collect()
}

fn nonzero<const D: usize>(f: &Option<ExprField>) -> Option<Field<D>> {
    f.as_ref().filter(|f| f.expr.as_constant() != Some(0.0)).map(|f| field(&f.expr))
}

/// The diffusivity at every node, positive and finite.
pub(crate) fn nodal_diffusivity<const D: usize>(
    scene: &Scene,
    materials: &[Material<D>],
    points: &[[f64; D]],
    labels: &[u16],
) -> Result<Vec<f64>, Error> {
    let mut eta = vec![0.0; points.len()];
    for (region, material) in materials.iter().enumerate() {
        scatter(&material.diffusivity, region, points, labels, &mut eta);
    }
    for (i, &value) in eta.iter().enumerate() {
        if !(value > 0.0 && value.is_finite()) {
            let spec = &scene.regions[labels[i] as usize].diffusivity;
            let message =
                format!("the diffusivity is {value} at {:?}; it must be positive and finite", points[i]);
            return Err(scene
                .error_at(spec, message, "change the expression, or the region it is for")
                .into());
        }
    }
    Ok(eta)
}

/// The coefficients of the equation beside the diffusivity are numbers at every node, and capacities positive.
pub(crate) fn check_coefficients<const D: usize>(
    scene: &Scene,
    materials: &[Material<D>],
    points: &[[f64; D]],
    labels: &[u16],
) -> Result<(), Error> {
    for ((region, material), spec) in materials.iter().enumerate().zip(&scene.regions) {
        let capacity = material.capacity.iter().zip(&spec.capacity);
        let others = material.velocity.iter().flatten().zip(&spec.velocity);
        let all = capacity.chain(others).chain(material.reaction.iter().zip(&spec.reaction));
        for (k, (field, given)) in all.enumerate().filter(|(_, (field, _))| field.as_constant().is_none()) {
            let of_region = points.iter().zip(labels).filter(|(_, label)| **label as usize == region);
            for (x, value) in of_region.map(|(x, _)| (x, field.at(x))) {
                if !value.is_finite() {
                    return Err(not_finite(scene, given, value, x));
                }
                if k == 0 && spec.capacity.is_some() && value <= 0.0 {
                    let message = format!("the capacity is {value} at {x:?}; it must be positive");
                    let help = "it is what a unit of volume stores for a unit of u (rho c of a material)";
                    return Err(scene.error_at(given, message, help).into());
                }
            }
        }
    }
    Ok(())
}

/// The source at every node, finite; zero in regions that have none.
pub(crate) fn nodal_source<const D: usize>(
    scene: &Scene,
    materials: &[Material<D>],
    points: &[[f64; D]],
    labels: &[u16],
) -> Result<Vec<f64>, Error> {
    let mut source = vec![0.0; points.len()];
    for (region, material) in materials.iter().enumerate() {
        if let Some(field) = &material.source {
            scatter(field, region, points, labels, &mut source);
        }
    }
    for (i, &value) in source.iter().enumerate() {
        if let (false, Some(spec)) = (value.is_finite(), &scene.regions[labels[i] as usize].source) {
            return Err(not_finite(scene, spec, value, &points[i]));
        }
    }
    Ok(source)
}

/// A component of the vorticity at every node.
pub(crate) fn nodal_vorticity<const D: usize>(
    scene: &Scene,
    component: usize,
    points: &[[f64; D]],
    labels: &[u16],
) -> Result<Vec<f64>, Error> {
    let mut values = vec![0.0; points.len()];
    for (region, spec) in scene.regions.iter().enumerate() {
        if let Some(spec) = spec.vorticity.get(component) {
            scatter(&field(&spec.expr), region, points, labels, &mut values);
        }
    }
    for (i, value) in values.iter().enumerate() {
        let spec = scene.regions[labels[i] as usize].vorticity.get(component);
        if let (false, Some(spec)) = (value.is_finite(), spec) {
            return Err(not_finite(scene, spec, *value, &points[i]));
        }
    }
    Ok(values)
}

/// The exact solution and its gradient at every node.
pub(crate) fn exact<const D: usize>(
    scene: &Scene,
    points: &[[f64; D]],
    labels: &[u16],
) -> Result<Exact<D>, Error> {
    let mut exact = Exact { values: vec![0.0; points.len()], gradients: vec![[0.0; D]; points.len()] };
    for (region, spec) in scene.regions.iter().enumerate() {
        let Some(spec) = &spec.exact else { continue };
        scatter(&field(&spec.expr), region, points, labels, &mut exact.values);
        let mut component = vec![0.0; points.len()];
        for axis in 0..D {
            scatter(&field(&spec.expr.derivative(axis)), region, points, labels, &mut component);
            for (i, gradient) in exact.gradients.iter_mut().enumerate() {
                if labels[i] as usize == region {
                    gradient[axis] = component[i];
                }
            }
        }
    }
    for i in 0..points.len() {
        let all = std::iter::once(exact.values[i]).chain(exact.gradients[i]);
        if let (Some(value), Some(spec)) =
            (all.into_iter().find(|v| !v.is_finite()), &scene.regions[labels[i] as usize].exact)
        {
            return Err(not_finite(scene, spec, value, &points[i]));
        }
    }
    Ok(exact)
}

/// An expression gave something that is not a number where it was needed.
pub(crate) fn not_finite<const D: usize>(scene: &Scene, spec: &ExprField, value: f64, x: &[f64; D]) -> Error {
    let message = format!("the expression gives {value} at {x:?}");
    scene
        .error_at(
            spec,
            message,
            "an expression must be finite wherever it is evaluated; `if(c, a, b)` guards a singular point",
        )
        .into()
}

/// Evaluates a field at the nodes of one region.
fn scatter<const D: usize>(
    field: &Field<D>,
    region: usize,
    points: &[[f64; D]],
    labels: &[u16],
    out: &mut [f64],
) {
    let nodes: Vec<usize> = (0..points.len()).filter(|&i| labels[i] as usize == region).collect();
    if let Some(value) = field.as_constant() {
        nodes.iter().for_each(|&i| out[i] = value);
        return;
    }
    let own: Vec<[f64; D]> = nodes.iter().map(|&i| points[i]).collect();
    let mut values = vec![0.0; own.len()];
    field.eval(&own, &mut values);
    nodes.iter().zip(values).for_each(|(&i, value)| out[i] = value);
}
