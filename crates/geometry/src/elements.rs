//! Surfaces of shapes in small pieces, for integrals over them.

mod march;

use std::f64::consts::TAU;

use crate::aabb::Aabb;
use crate::shape::{Ball, Cylinder, Shape};
use crate::surface::TriangleSurface;
use crate::vector::{axis_vector, axpy, dot, norm, normalized, scale, sub};
pub(crate) use march::chords;

/// Pieces round a circle at least, whatever its size.
const ROUND: f64 = 64.0;

/// A piece of a surface: where a smooth function on it is as large as on average, to second order in its size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Element<const D: usize> {
    /// Its middle, on the surface.
    pub at: [f64; D],
    /// The unit normal there, out of the shape that the surface is of.
    pub normal: [f64; D],
    /// Length or area; 1 for a point on the line.
    pub area: f64,
}

impl<const D: usize> Shape<D> {
    /// The surfaces of the primitives that the shape is made of, as far as they are within `bounds` or near, in pieces of about this
    /// size: also what lies within other parts of the shape. Areas are exact for planes, polygons and triangles, of fourth
    /// order in the size for curved surfaces.
    pub fn elements(&self, bounds: &Aabb<D>, size: f64) -> Vec<Element<D>> {
        self.leaves().into_iter().flat_map(|(leaf, _)| small_pieces(leaf, bounds, size)).collect()
    }
}

/// The surface of one primitive in pieces of about a size.
pub(crate) fn small_pieces<const D: usize>(shape: &Shape<D>, bounds: &Aabb<D>, size: f64) -> Vec<Element<D>> {
    match shape {
        Shape::Box(b) => (0..2 * D).flat_map(|k| side_elements(b, k / 2, k % 2 == 1, size)).collect(),
        Shape::Ball(ball) => of_ball(ball, size),
        Shape::Cylinder(cylinder) => of_cylinder(cylinder, bounds, size),
        Shape::Polygon(polygon) => {
            let vertices = polygon.vertices();
            let turn = polygon.area().signum();
            let next = vertices.iter().cycle().skip(1);
            vertices.iter().zip(next).flat_map(|(a, b)| of_edge(a, b, turn, size)).collect()
        }
        Shape::Surface(surface) => of_triangles(surface, size),
        Shape::HalfSpace(h) => {
            let foot = axpy(&bounds.center(), h.offset() - dot(h.normal(), &bounds.center()), h.normal());
            let reach = 0.5 * bounds.diameter();
            patch(&foot, h.normal(), &tangents(h.normal()).map(|t| (t, -reach, reach)), size)
        }
        _ => march::elements(shape, bounds, size),
    }
}

/// One side of a box: the lower or upper one across an axis, in pieces of about a size.
pub fn side_elements<const D: usize>(b: &Aabb<D>, axis: usize, upper: bool, size: f64) -> Vec<Element<D>> {
    let mut foot = b.center();
    foot[axis] = if upper { b.max[axis] } else { b.min[axis] };
    let normal = axis_vector(axis, if upper { 1.0 } else { -1.0 });
    let others: Vec<usize> = (0..D).filter(|&k| k != axis).collect();
    let spans = std::array::from_fn(|k| match others.get(k) {
        Some(&other) => (axis_vector(other, 1.0), b.min[other] - foot[other], b.max[other] - foot[other]),
        None => ([0.0; D], 0.0, 0.0),
    });
    patch(&foot, &normal, &spans, size)
}

/// A flat piece spanned by up to two directions, each from where to where.
fn patch<const D: usize>(
    foot: &[f64; D],
    normal: &[f64; D],
    spans: &[([f64; D], f64, f64); 2],
    size: f64,
) -> Vec<Element<D>> {
    let steps = |k: usize| -> Vec<(f64, f64)> {
        let (_, from, to) = spans[k];
        if k + 1 >= D { vec![(0.0, 1.0)] } else { middles(from, to, size) }
    };
    let (first, second) = (steps(0), steps(1));
    let pairs = first.iter().flat_map(|a| second.iter().map(move |b| (a, b)));
    pairs
        .map(|(&(s, ds), &(t, dt))| {
            let at = axpy(&axpy(foot, s, &spans[0].0), t, &spans[1].0);
            Element { at, normal: *normal, area: ds * dt }
        })
        .collect()
}

/// The middles of pieces of about a size, and their length.
fn middles(from: f64, to: f64, size: f64) -> Vec<(f64, f64)> {
    let n = ((to - from) / size).ceil().max(1.0);
    let step = (to - from) / n;
    (0..n as usize).map(|k| (from + (k as f64 + 0.5) * step, step)).collect()
}

/// Unit vectors across a direction; zero beyond what there are.
pub(crate) fn tangents<const D: usize>(n: &[f64; D]) -> [[f64; D]; 2] {
    let mut found = [[0.0; D]; 2];
    let mut axes: Vec<usize> = (0..D).collect();
    axes.sort_by(|&a, &b| n[a].abs().total_cmp(&n[b].abs()));
    for k in 0..(D - 1).min(2) {
        let mut t = axis_vector(axes[k], 1.0);
        t = axpy(&t, -dot(&t, n), n);
        if k == 1 {
            t = axpy(&t, -dot(&t, &found[0]), &found[0]);
        }
        found[k] = normalized(&t).unwrap_or([0.0; D]);
    }
    found
}

fn of_edge<const D: usize>(a: &[f64; 2], b: &[f64; 2], turn: f64, size: f64) -> Vec<Element<D>> {
    let along = [b[0] - a[0], b[1] - a[1]];
    let length = norm(&along);
    let out = [turn * along[1] / length, -turn * along[0] / length];
    let plane = |v: [f64; 2]| std::array::from_fn(|k| v.get(k).copied().unwrap_or(0.0));
    let pieces = middles(0.0, 1.0, size / length).into_iter();
    pieces
        .map(|(t, dt)| Element { at: plane(axpy(a, t, &along)), normal: plane(out), area: dt * length })
        .collect()
}

fn of_ball<const D: usize>(ball: &Ball<D>, size: f64) -> Vec<Element<D>> {
    let (r, c) = (ball.radius(), ball.center());
    let on = |normal: [f64; D], area: f64| Element { at: axpy(c, r, &normal), normal, area };
    let vector = |v: [f64; 3]| std::array::from_fn(|k| v[k]);
    let angles = middles(0.0, TAU, (size / r).min(TAU / ROUND));
    match D {
        1 => [-1.0, 1.0].map(|sign| on(vector([sign, 0.0, 0.0]), 1.0)).to_vec(),
        2 => angles.iter().map(|&(a, da)| on(vector([a.cos(), a.sin(), 0.0]), r * da)).collect(),
        _ => {
            // Areas between parallels are as their heights; Gauss points in height would gain nothing where regions meet.
            let polar = middles(0.0, 0.5 * TAU, (size / r).min(TAU / ROUND));
            let bands = polar.iter().map(|&(a, da)| (a, (a - 0.5 * da).cos() - (a + 0.5 * da).cos()));
            bands
                .flat_map(|(a, height)| {
                    angles.iter().map(move |&(b, db)| {
                        let normal = [a.sin() * b.cos(), a.sin() * b.sin(), a.cos()];
                        on(vector(normal), r * r * height * db)
                    })
                })
                .collect()
        }
    }
}

fn of_cylinder<const D: usize>(cylinder: &Cylinder<D>, bounds: &Aabb<D>, size: f64) -> Vec<Element<D>> {
    let (r, axis) = (cylinder.radius(), cylinder.axis());
    let to_center = dot(&sub(&bounds.center(), cylinder.center()), axis);
    let reach = 0.5 * bounds.diameter();
    let (from, to) = match cylinder.half_length() {
        Some(half) => (-half, half),
        None => (to_center - reach, to_center + reach),
    };
    let [e, f] = tangents(axis);
    let angles = middles(0.0, TAU, (size / r).min(TAU / ROUND));
    let around = |a: f64| axpy(&scale(a.cos(), &e), a.sin(), &f);
    let mut found = Vec::new();
    for &(a, da) in &angles {
        let normal = around(a);
        let side = middles(from, to, size).into_iter();
        found.extend(side.map(|(t, dt)| Element {
            at: axpy(&axpy(cylinder.center(), t, axis), r, &normal),
            normal,
            area: r * da * dt,
        }));
        if let Some(half) = cylinder.half_length() {
            for (s, ds) in middles(0.0, r, size) {
                found.extend([-1.0, 1.0].map(|sign| Element {
                    at: axpy(&axpy(cylinder.center(), sign * half, axis), s, &normal),
                    normal: scale(sign, axis),
                    area: s * da * ds,
                }));
            }
        }
    }
    found
}

fn of_triangles<const D: usize>(surface: &TriangleSurface, size: f64) -> Vec<Element<D>> {
    let space = |v: [f64; 3]| std::array::from_fn(|k| v.get(k).copied().unwrap_or(0.0));
    let mut found = Vec::new();
    for triangle in surface.triangles() {
        let corners = triangle.map(|k| surface.vertices()[k as usize]);
        let [u, v] = [1, 2].map(|k| sub(&corners[k], &corners[0]));
        let cross = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
        let Some(normal) = normalized(&cross) else { continue };
        let longest = norm(&u).max(norm(&v)).max(norm(&sub(&u, &v)));
        let n = (longest / size).ceil().max(1.0);
        let area = 0.5 * norm(&cross) / (n * n);
        for i in 0..n as usize {
            for j in 0..n as usize - i {
                // The piece at this corner, and the one across its long side.
                let thirds: &[f64] =
                    if i + j + 1 < n as usize { &[1.0 / 3.0, 2.0 / 3.0] } else { &[1.0 / 3.0] };
                found.extend(thirds.iter().map(|third| {
                    let at = axpy(&axpy(&corners[0], (i as f64 + third) / n, &u), (j as f64 + third) / n, &v);
                    Element { at: space(at), normal: space(normal), area }
                }));
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;
    use std::sync::Arc;

    fn area<const D: usize>(shape: &Shape<D>, size: f64) -> f64 {
        let bounds = Aabb::new([-1.0; D], [1.0; D]).expect("a box");
        shape.elements(&bounds, size).iter().map(|e| e.area).sum()
    }

    /// The integral of `x . n` is D times the volume.
    fn volume<const D: usize>(shape: &Shape<D>, size: f64) -> f64 {
        let bounds = Aabb::new([-1.0; D], [1.0; D]).expect("a box");
        shape.elements(&bounds, size).iter().map(|e| e.area * dot(&e.at, &e.normal)).sum::<f64>() / D as f64
    }

    #[test]
    fn flat_surfaces_are_exact() {
        let square = Shape::cuboid([-0.3, 0.1], [0.5, 0.7]).expect("a box");
        assert!((area(&square, 0.07) - 2.8).abs() < 1e-12 && (volume(&square, 0.07) - 0.48).abs() < 1e-12);
        let cube = Shape::cuboid([-0.3, 0.1, 0.0], [0.5, 0.7, 0.4]).expect("a box");
        assert!((area(&cube, 0.07) - 2.08).abs() < 1e-12 && (volume(&cube, 0.07) - 0.192).abs() < 1e-12);
        for turn in [[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]], [[0.0, 0.0], [0.0, 1.0], [1.0, 0.0]]] {
            let triangle = Shape::polygon(turn.to_vec()).expect("a polygon");
            assert!((volume(&triangle, 0.3) - 0.5).abs() < 1e-12);
        }
        let half = Shape::half_space([0.0, 0.2, 0.0], [0.0, 1.0, 0.0]).expect("a half-space");
        let bounds = Aabb::new([-1.0; 3], [1.0; 3]).expect("a box");
        let within = half.elements(&bounds, 0.05).into_iter().filter(|e| bounds.contains(&e.at, 0.0));
        assert!((within.map(|e| e.area).sum::<f64>() - 4.0).abs() < 0.2);
        assert_eq!(area(&Shape::cuboid([-0.5], [0.5]).expect("an interval"), 0.1), 2.0);
    }

    #[test]
    fn curved_surfaces_have_their_areas_and_volumes() {
        let disc = Shape::ball([0.1, 0.2], 0.5).expect("a disc");
        assert!((area(&disc, 0.1) - PI).abs() < 1e-12 && (volume(&disc, 0.1) - 0.25 * PI).abs() < 1e-12);
        let ball = Shape::ball([0.1, 0.2, 0.0], 0.5).expect("a ball");
        assert!((area(&ball, 0.1) - PI).abs() < 1e-9 && (volume(&ball, 0.1) - PI / 6.0).abs() < 1e-3);
        let tube = Shape::cylinder([0.0; 3], [1.0, 1.0, 0.0], 0.3, Some(0.8)).expect("a cylinder");
        let exact = 2.0 * PI * 0.3 * 0.8 + 2.0 * PI * 0.09;
        assert!(
            (area(&tube, 0.1) - exact).abs() < 1e-9 && (volume(&tube, 0.1) - PI * 0.09 * 0.8).abs() < 1e-9
        );
    }

    #[test]
    fn level_sets_are_of_fourth_order() {
        let disc = |x: &[f64; 2]| x[0] * x[0] + x[1] * x[1] - 0.49;
        let disc = Shape::<2>::level_set(Arc::new(disc));
        let errors = [0.1, 0.05].map(|size| (area(&disc, size) / (1.4 * PI) - 1.0).abs());
        assert!(errors[0] < 1e-4 && errors[1] < errors[0] / 8.0, "{errors:?}");
        let ball = |x: &[f64; 3]| x[0] * x[0] + x[1] * x[1] + x[2] * x[2] - 0.49;
        let ball = Shape::<3>::level_set(Arc::new(ball));
        let errors = [0.1, 0.05].map(|size| (area(&ball, size) / (1.96 * PI) - 1.0).abs());
        assert!(errors[0] < 1e-3 && errors[1] < errors[0] / 6.0, "{errors:?}");
        assert!((volume(&ball, 0.05) / (0.343 * 4.0 / 3.0 * PI) - 1.0).abs() < 1e-3);
    }
}
