//! Surfaces of shapes as smooth patches with maps onto them, for quadrature of high order.
//!
//! Whoever integrates divides a patch where something begins on it, and puts the points of a Gauss rule on what is smooth.

use std::f64::consts::{PI, TAU};

use crate::aabb::Aabb;
use crate::elements::{Element, chords, small_pieces, tangents};
use crate::shape::{Ball, Cylinder, Shape};
use crate::vector::{axis_vector, axpy, dot, norm, normalized, scale, sub};

/// Newton steps of a point onto a curve at most.
const STEPS: usize = 30;

/// Parts of a full turn: a rule of six points follows a sixth of it to round-off.
const ROUND: usize = 6;

/// A step, over the chord's length, after which a point is on the curve.
const ARRIVED: f64 = 1e-14;

/// A smooth piece of a surface: the image of a point (on the line), of the unit interval, or of the unit square.
#[derive(Clone, Debug)]
pub struct Patch<'a, const D: usize> {
    map: Map<'a, D>,
    /// About how long it is along each of its parameters; 0 for parameters that it does not have.
    pub extent: [f64; 2],
    /// Whether its ends along each parameter are edges of the surface: not where a circle closes, or a chord meets the next one.
    pub ends: [bool; 2],
    /// Into how many parts it must be divided along each parameter at least, for a rule of six points to follow its bend.
    pub parts: [usize; 2],
}

#[derive(Clone, Debug)]
enum Map<'a, const D: usize> {
    /// A piece that is not divided.
    Small(Element<D>),
    /// Flat: a corner and the directions along its parameters, across each other.
    Flat { corner: [f64; D], along: [[f64; D]; 2], normal: [f64; D] },
    /// A circle, or a sphere by its polar angle and its longitude.
    Round(&'a Ball<D>),
    /// The side of a cylinder between two heights, by height and angle.
    Side { cylinder: &'a Cylinder<D>, from: f64, to: f64 },
    /// An end of a cylinder, by radius and angle.
    Cap { cylinder: &'a Cylinder<D>, sign: f64 },
    /// The part of a curve of a level set over a chord of it.
    Chord { shape: &'a Shape<D>, from: [f64; D], to: [f64; D] },
}

impl<const D: usize> Patch<'_, D> {
    fn small(element: Element<D>) -> Self {
        Patch { map: Map::Small(element), extent: [0.0; 2], ends: [false; 2], parts: [1; 2] }
    }

    /// Whether it is one point with the weight of a piece.
    pub fn is_small(&self) -> bool {
        matches!(self.map, Map::Small(_))
    }

    /// Whether it is the part of a curve over one chord of many.
    pub fn is_chord(&self) -> bool {
        matches!(self.map, Map::Chord { .. })
    }

    /// The point at parameters in [0, 1]; its area is the one for a unit of the parameters.
    pub fn at(&self, [s, t]: [f64; 2]) -> Element<D> {
        match &self.map {
            Map::Small(element) => *element,
            Map::Flat { corner, along, normal } => {
                let at = axpy(&axpy(corner, s, &along[0]), t, &along[1]);
                let size = |k: usize| if k + 1 < D { norm(&along[k]) } else { 1.0 };
                Element { at, normal: *normal, area: size(0) * size(1) }
            }
            Map::Round(ball) => {
                let r = ball.radius();
                let (normal, area) = if D == 2 {
                    ([(TAU * s).cos(), (TAU * s).sin(), 0.0], TAU * r)
                } else {
                    let (polar, round) = (PI * s, TAU * t);
                    let across = polar.sin();
                    ([across * round.cos(), across * round.sin(), polar.cos()], PI * TAU * r * r * across)
                };
                let normal = std::array::from_fn(|k| normal[k]);
                Element { at: axpy(ball.center(), r, &normal), normal, area }
            }
            Map::Side { cylinder, from, to } => {
                let (r, normal) = (cylinder.radius(), around(cylinder, t));
                let at = axpy(&axpy(cylinder.center(), from + s * (to - from), cylinder.axis()), r, &normal);
                Element { at, normal, area: TAU * r * (to - from) }
            }
            Map::Cap { cylinder, sign } => {
                let half = cylinder.half_length().unwrap_or_default();
                let r = s * cylinder.radius();
                let foot = axpy(cylinder.center(), sign * half, cylinder.axis());
                let at = axpy(&foot, r, &around(cylinder, t));
                let area = TAU * r * cylinder.radius();
                Element { at, normal: scale(*sign, cylinder.axis()), area }
            }
            Map::Chord { shape, from, to } => over_chord(shape, from, to, s),
        }
    }
}

/// Out of a cylinder's axis in a direction.
fn around<const D: usize>(cylinder: &Cylinder<D>, t: f64) -> [f64; D] {
    let [e, f] = tangents(cylinder.axis());
    axpy(&scale((TAU * t).cos(), &e), (TAU * t).sin(), &f)
}

/// The point of a curve straight above that of a chord. Its length element is that of the chord over the cosine of their angle.
fn over_chord<const D: usize>(shape: &Shape<D>, from: &[f64; D], to: &[f64; D], s: f64) -> Element<D> {
    let along = sub(to, from);
    let length = norm(&along);
    let mut up = [0.0; D];
    if D == 2 && length > 0.0 {
        (up[0], up[1]) = (-along[1] / length, along[0] / length);
    }
    let foot = axpy(from, s, &along);
    let mut at = foot;
    for _ in 0..STEPS {
        let step = -shape.level(&at) / dot(&shape.gradient(&at), &up);
        // Farther than a chord is long the curve is not this one.
        if !step.is_finite() || norm(&sub(&axpy(&at, step, &up), &foot)) > length {
            at = shape.project(&foot, length).map_or(foot, |p| p.point);
            break;
        }
        at = axpy(&at, step, &up);
        if step.abs() <= ARRIVED * length {
            break;
        }
    }
    let normal = normalized(&shape.gradient(&at)).unwrap_or(up);
    let cosine = dot(&normal, &up).abs();
    Element { at, normal, area: if cosine > 0.0 { length / cosine } else { length } }
}

impl<const D: usize> Shape<D> {
    /// The surfaces of the primitives that the shape is made of, as far as they are within `bounds` or near: also what lies within
    /// other parts of the shape. Curves of level sets are cut into chords of about `size`; in space they, and surfaces of triangles, are
    /// [`Shape::elements`] of that size.
    pub fn patches(&self, bounds: &Aabb<D>, size: f64) -> Vec<Patch<'_, D>> {
        self.leaves().into_iter().flat_map(|(leaf, _)| of_primitive(leaf, bounds, size)).collect()
    }
}

fn of_primitive<'a, const D: usize>(shape: &'a Shape<D>, bounds: &Aabb<D>, size: f64) -> Vec<Patch<'a, D>> {
    let elements = || shape.elements(bounds, size).into_iter().map(Patch::small).collect();
    match shape {
        _ if D == 1 => elements(),
        Shape::Box(b) => (0..2 * D).map(|k| side_patch(b, k / 2, k % 2 == 1)).collect(),
        Shape::Ball(ball) => {
            let r = ball.radius();
            let extent = if D == 2 { [TAU * r, 0.0] } else { [PI * r, TAU * r] };
            let parts = if D == 2 { [ROUND, 1] } else { [ROUND / 2, ROUND] };
            vec![Patch { map: Map::Round(ball), extent, ends: [false; 2], parts }]
        }
        Shape::Cylinder(cylinder) => of_cylinder(cylinder, bounds),
        Shape::Polygon(polygon) => {
            let vertices = polygon.vertices();
            let turn = polygon.area().signum();
            let next = vertices.iter().cycle().skip(1);
            vertices.iter().zip(next).map(|(a, b)| of_edge(a, b, turn)).collect()
        }
        Shape::HalfSpace(h) => {
            let foot = axpy(&bounds.center(), h.offset() - dot(h.normal(), &bounds.center()), h.normal());
            let reach = bounds.diameter();
            let along: [[f64; D]; 2] = tangents(h.normal()).map(|t| scale(reach, &t));
            let corner = axpy(&axpy(&foot, -0.5, &along[0]), -0.5, &along[1]);
            let extent = [reach, if D == 3 { reach } else { 0.0 }];
            vec![Patch {
                map: Map::Flat { corner, along, normal: *h.normal() },
                extent,
                ends: [true; 2],
                parts: [1; 2],
            }]
        }
        _ if D == 2 && !matches!(shape, Shape::Surface(_)) => chords(shape, bounds, size)
            .into_iter()
            .map(|[from, to]| Patch {
                extent: [norm(&sub(&to, &from)), 0.0],
                map: Map::Chord { shape, from, to },
                ends: [false; 2],
                parts: [1; 2],
            })
            .collect(),
        _ => small_pieces(shape, bounds, size).into_iter().map(Patch::small).collect(),
    }
}

/// One side of a box: the lower or upper one across an axis.
pub fn side_patch<const D: usize>(b: &Aabb<D>, axis: usize, upper: bool) -> Patch<'static, D> {
    let mut corner = b.min;
    corner[axis] = if upper { b.max[axis] } else { b.min[axis] };
    let normal = axis_vector(axis, if upper { 1.0 } else { -1.0 });
    if D == 1 {
        return Patch::small(Element { at: corner, normal, area: 1.0 });
    }
    let others: Vec<usize> = (0..D).filter(|&k| k != axis).collect();
    let length = |k: usize| others.get(k).map_or(0.0, |&other| b.max[other] - b.min[other]);
    let along = [0, 1].map(|k| others.get(k).map_or([0.0; D], |&other| axis_vector(other, length(k))));
    Patch {
        map: Map::Flat { corner, along, normal },
        extent: [length(0), length(1)],
        ends: [true; 2],
        parts: [1; 2],
    }
}

fn of_edge<const D: usize>(a: &[f64; 2], b: &[f64; 2], turn: f64) -> Patch<'static, D> {
    let along = [b[0] - a[0], b[1] - a[1]];
    let length = norm(&along);
    let out = [turn * along[1] / length, -turn * along[0] / length];
    let plane = |v: [f64; 2]| std::array::from_fn(|k| v.get(k).copied().unwrap_or(0.0));
    let map = Map::Flat { corner: plane(*a), along: [plane(along), [0.0; D]], normal: plane(out) };
    Patch { map, extent: [length, 0.0], ends: [true; 2], parts: [1; 2] }
}

fn of_cylinder<'a, const D: usize>(cylinder: &'a Cylinder<D>, bounds: &Aabb<D>) -> Vec<Patch<'a, D>> {
    let to_center = dot(&sub(&bounds.center(), cylinder.center()), cylinder.axis());
    let reach = 0.5 * bounds.diameter();
    let (from, to) = match cylinder.half_length() {
        Some(half) => (-half, half),
        None => (to_center - reach, to_center + reach),
    };
    let r = cylinder.radius();
    let side = Patch {
        map: Map::Side { cylinder, from, to },
        extent: [to - from, TAU * r],
        ends: [true, false],
        parts: [1, ROUND],
    };
    let caps: &[f64] = if cylinder.half_length().is_some() { &[-1.0, 1.0] } else { &[] };
    let caps = caps.iter().map(|&sign| Patch {
        map: Map::Cap { cylinder, sign },
        extent: [r, TAU * r],
        ends: [false; 2],
        parts: [1, ROUND],
    });
    std::iter::once(side).chain(caps).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;

    /// Abscissae and weights of Gauss on [0, 1], six points.
    const GAUSS: [(f64, f64); 6] = [
        (0.033_765_242_898_423_99, 0.085_662_246_189_585_17),
        (0.169_395_306_766_867_74, 0.180_380_786_524_069_3),
        (0.380_690_406_958_401_55, 0.233_956_967_286_345_52),
        (0.619_309_593_041_598_5, 0.233_956_967_286_345_52),
        (0.830_604_693_233_132_3, 0.180_380_786_524_069_3),
        (0.966_234_757_101_576, 0.085_662_246_189_585_17),
    ];

    /// Area, and volume by the integral of `x . n`.
    fn measures<const D: usize>(shape: &Shape<D>, size: f64) -> [f64; 2] {
        let bounds = Aabb::new([-1.0; D], [1.0; D]).expect("a box");
        let mut sums = [0.0; 2];
        let mut add = |e: Element<D>, w: f64| {
            sums[0] += w * e.area;
            sums[1] += w * e.area * dot(&e.at, &e.normal) / D as f64;
        };
        for patch in shape.patches(&bounds, size) {
            let [n, m] = [0, 1].map(|k| (patch.extent[k] / 0.3).ceil().max(patch.parts[k] as f64) as usize);
            let points = |n: usize| -> Vec<(f64, f64)> {
                let panel = |k: usize| GAUSS.map(|(x, w)| ((k as f64 + x) / n as f64, w / n as f64));
                (0..n).flat_map(panel).collect()
            };
            let second = if D == 3 { points(m) } else { vec![(0.0, 1.0)] };
            if patch.is_small() {
                add(patch.at([0.0; 2]), 1.0);
                continue;
            }
            for (s, ws) in points(n) {
                second.iter().for_each(|&(t, wt)| add(patch.at([s, t]), ws * wt));
            }
        }
        sums
    }

    fn are<const D: usize>(shape: &Shape<D>, exact: [f64; 2], bound: f64) {
        let found = measures(shape, 0.1);
        for (found, exact) in found.into_iter().zip(exact) {
            assert!((found / exact - 1.0).abs() < bound, "{shape:?}: {found} is not {exact}");
        }
    }

    #[test]
    fn areas_and_volumes_are_exact() {
        are(&Shape::cuboid([-0.3, 0.1], [0.5, 0.7]).expect("a box"), [2.8, 0.48], 1e-13);
        are(&Shape::cuboid([-0.3, 0.1, 0.0], [0.5, 0.7, 0.4]).expect("a box"), [2.08, 0.192], 1e-13);
        for turn in [[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]], [[0.0, 0.0], [0.0, 1.0], [1.0, 0.0]]] {
            let triangle = Shape::polygon(turn.to_vec()).expect("a polygon");
            are(&triangle, [2.0 + 2.0_f64.sqrt(), 0.5], 1e-13);
        }
        are(&Shape::ball([0.1, 0.2], 0.5).expect("a disc"), [PI, 0.25 * PI], 1e-13);
        are(&Shape::ball([0.1, 0.2, 0.0], 0.5).expect("a ball"), [PI, PI / 6.0], 1e-12);
        let tube = Shape::cylinder([0.0; 3], [1.0, 1.0, 0.0], 0.3, Some(0.8)).expect("a cylinder");
        are(&tube, [TAU * 0.3 * 0.8 + TAU * 0.09, PI * 0.09 * 0.8], 1e-13);
        are(&Shape::cuboid([-0.5], [0.5]).expect("an interval"), [2.0, 1.0], 1e-15);
    }

    #[test]
    fn curves_of_level_sets_are_exact_and_their_surfaces_of_fourth_order() {
        let disc = |x: &[f64; 2]| x[0] * x[0] + x[1] * x[1] - 0.49;
        are(&Shape::<2>::level_set(Arc::new(disc)), [1.4 * PI, 0.49 * PI], 1e-12);
        let ellipse = |x: &[f64; 2]| (x[0] / 0.8).powi(2) + (x[1] / 0.4).powi(2) - 1.0;
        // Length by an elliptic integral of the second kind.
        are(&Shape::<2>::level_set(Arc::new(ellipse)), [3.875_379_288_219_07, 0.32 * PI], 1e-9);
        let ball = |x: &[f64; 3]| x[0] * x[0] + x[1] * x[1] + x[2] * x[2] - 0.49;
        are(&Shape::<3>::level_set(Arc::new(ball)), [1.96 * PI, 0.343 * 4.0 / 3.0 * PI], 5e-3);
    }
}
