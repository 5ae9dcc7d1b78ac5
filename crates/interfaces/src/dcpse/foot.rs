//! The point of an interface or of the boundary at which conditions are imposed, and what they are there.

use meshless_geometry::Projection;

use crate::{Field, InterfaceLaw, Material, Problem};

/// Step of central differences for fields that know no gradient, relative to the spacing.
const GRADIENT_STEP: f64 = 1e-3;

/// The place at which an interface condition is imposed.
pub(super) struct Foot<const D: usize> {
    pub(super) point: [f64; D],
    /// Unit normal from the first region to the second.
    pub(super) normal: [f64; D],
    /// Unit length of the local coordinates.
    pub(super) spacing: f64,
}

/// The equation of one region at a point, in local coordinates: `lap P + drift . grad P = rhs`.
pub(super) struct LocalEquation<const D: usize> {
    pub(super) eta: f64,
    pub(super) drift: [f64; D],
    pub(super) rhs: f64,
}

/// The jump conditions between two regions at a foot, in local coordinates.
pub(super) struct LocalJump<const D: usize> {
    pub(super) value: f64,
    pub(super) gradient: [f64; D],
    pub(super) flux: f64,
    /// How fast the value jumps ever more, in the unit of the equations weighted by their diffusivities.
    pub(super) rate: f64,
}

/// The foot of node `q` on the interface between regions `own` and one other that its support shows.
///
/// The region of the node comes first; where that has no interface with `own` near (a third region lies between),
/// the nearest interface of `own` with any region of the support.
pub(super) fn foot<const D: usize>(problem: &Problem<'_, D>, q: usize, own: u16) -> Option<(Foot<D>, u16)> {
    let x = &problem.cloud.points()[q];
    let reach = 1.5 * problem.supports.radius[q];
    let project = |other: u16| {
        problem.regions.project_within(problem.domain, own, other, x, reach).ok().map(|p| (p, other))
    };
    let found = project(problem.labels[q]).or_else(|| {
        let mut others: Vec<u16> =
            problem.supports.lists.of(q).iter().map(|&j| problem.labels[j as usize]).collect();
        others.sort_unstable();
        others.dedup();
        let near = |a: &(Projection<D>, u16), b: &(Projection<D>, u16)| {
            a.0.distance.abs().total_cmp(&b.0.distance.abs())
        };
        others.into_iter().filter(|&other| other != own).filter_map(project).min_by(near)
    });
    let spacing = problem.cloud.spacing()[q];
    found.map(|(p, other)| (Foot { point: p.point, normal: p.normal, spacing }, other))
}

/// The equation of a region at a point.
pub(super) fn equation<const D: usize>(
    material: &Material<D>,
    x: &[f64; D],
    spacing: f64,
) -> LocalEquation<D> {
    let eta = material.diffusivity.at(x);
    let drift = gradient(&material.diffusivity, x, spacing).map(|g| g * spacing / eta);
    let source = material.source.as_ref().map_or(0.0, |f| f.at(x));
    LocalEquation { eta, drift, rhs: -source * spacing * spacing / eta }
}

/// The jump from region `from` to region `to` at a foot; fluxes are in units of `scale` over the spacing.
pub(super) fn jump<const D: usize>(
    problem: &Problem<'_, D>,
    foot: &Foot<D>,
    [from, to]: [u16; 2],
    scale: f64,
) -> LocalJump<D> {
    let (x, h) = (&foot.point, foot.spacing);
    let mut local = LocalJump { value: 0.0, gradient: [0.0; D], flux: 0.0, rate: 0.0 };
    if let Some((InterfaceLaw { value: Some(rate), .. }, sign)) = problem.law_rate_between(from, to) {
        local.rate = sign * rate.at(x) * h * h / scale;
    }
    let Some((jump, sign)) = problem.law_between(from, to) else { return local };
    if let Some(value) = &jump.value {
        local.value = sign * value.at(x);
        local.gradient = gradient(value, x, h).map(|g| sign * g * h);
    }
    // Both the difference and the normal change sign with the direction: the jump of the flux does not.
    local.flux = jump.flux.as_ref().map_or(0.0, |flux| flux.at(x)) * h / scale;
    local
}

pub(super) fn gradient<const D: usize>(field: &Field<D>, x: &[f64; D], spacing: f64) -> [f64; D] {
    let Field::Function(function) = field else { return [0.0; D] };
    function.gradient(x).unwrap_or_else(|| {
        let step = GRADIENT_STEP * spacing;
        std::array::from_fn(|k| {
            let at = |t: f64| {
                let mut y = *x;
                y[k] += t;
                field.at(&y)
            };
            (at(step) - at(-step)) / (2.0 * step)
        })
    })
}

/// Unit vectors that complete a unit vector to an orthogonal frame: `D - 1` of them.
pub(super) fn tangents<const D: usize>(normal: &[f64; D]) -> impl Iterator<Item = [f64; D]> {
    let mut frame = vec![*normal];
    // The axes in the order in which the normal has least of them, made orthogonal to what is there.
    let mut axes: Vec<usize> = (0..D).collect();
    axes.sort_by(|&a, &b| normal[a].abs().total_cmp(&normal[b].abs()));
    for axis in axes.into_iter().take(D - 1) {
        let mut t: [f64; D] = std::array::from_fn(|k| if k == axis { 1.0 } else { 0.0 });
        for other in &frame {
            let share: f64 = (0..D).map(|k| t[k] * other[k]).sum();
            t.iter_mut().zip(other).for_each(|(t, o)| *t -= share * o);
        }
        let length = t.iter().map(|x| x * x).sum::<f64>().sqrt();
        frame.push(t.map(|x| x / length));
    }
    frame.into_iter().skip(1)
}
