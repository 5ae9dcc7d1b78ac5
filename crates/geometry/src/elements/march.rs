//! Surfaces of level sets: where they cut the simplices of a grid, put onto the surface.

use super::Element;
use crate::aabb::Aabb;
use crate::shape::Shape;
use crate::vector::{axpy, norm, normalized, scale, sub};

/// Points of the grid at most.
const MOST: f64 = 2e7;

/// A corner of a simplex and the level there.
type Corner<const D: usize> = ([f64; D], f64);

/// What of the surface is within the box.
pub(super) fn elements<const D: usize>(shape: &Shape<D>, bounds: &Aabb<D>, size: f64) -> Vec<Element<D>> {
    let mut found = Vec::new();
    let size = least_size(bounds, size);
    for_each_simplex(shape, bounds, size, &mut |simplex| cut(shape, simplex, size, &mut found));
    found
}

/// Chords of what of a curve is within the box, with their ends on it.
pub(crate) fn chords<const D: usize>(shape: &Shape<D>, bounds: &Aabb<D>, size: f64) -> Vec<[[f64; D]; 2]> {
    let mut found = Vec::new();
    let size = least_size(bounds, size);
    for_each_simplex(shape, bounds, size, &mut |simplex| {
        if let [a, b] = crossings(shape, simplex, size)[..] {
            found.push([a, b]);
        }
    });
    found
}

/// The size of the cells of a grid that is not too large.
fn least_size<const D: usize>(bounds: &Aabb<D>, size: f64) -> f64 {
    size.max((bounds.measure() / MOST).powf(1.0 / D as f64))
}

/// The simplices of a grid that the surface may pass.
fn for_each_simplex<const D: usize>(
    shape: &Shape<D>,
    bounds: &Aabb<D>,
    size: f64,
    act: &mut dyn FnMut(&[Corner<D>]),
) {
    let lengths = bounds.lengths();
    let cells: [usize; D] = std::array::from_fn(|k| (lengths[k] / size).ceil().max(1.0) as usize);
    let at = |place: &[usize; D]| -> [f64; D] {
        std::array::from_fn(|k| bounds.min[k] + lengths[k] * place[k] as f64 / cells[k] as f64)
    };
    let points = cells.map(|n| n + 1);
    let levels: Vec<f64> = places(points).map(|place| shape.level(&at(&place))).collect();
    let level = |place: &[usize; D]| levels[(0..D).rev().fold(0, |index, k| index * points[k] + place[k])];
    let orders = permutations::<D>();
    for place in places(cells) {
        let corners =
            (0..1 << D).map(|bits: usize| level(&std::array::from_fn(|k| place[k] + (bits >> k & 1))) > 0.0);
        if corners.clone().all(|out| out) || corners.clone().all(|out| !out) {
            continue;
        }
        for order in &orders {
            // From the lowest corner along the axes in this order to the highest.
            let mut path = place;
            let mut simplex = vec![(at(&path), level(&path))];
            for &axis in order {
                path[axis] += 1;
                simplex.push((at(&path), level(&path)));
            }
            act(&simplex);
        }
    }
}

/// All places of a grid, the first axis fastest.
fn places<const D: usize>(n: [usize; D]) -> impl Iterator<Item = [usize; D]> {
    (0..n.iter().product()).map(move |mut index: usize| {
        std::array::from_fn(|k| {
            let place = index % n[k];
            index /= n[k];
            place
        })
    })
}

fn permutations<const D: usize>() -> Vec<Vec<usize>> {
    (0..D).fold(vec![Vec::new()], |all, _| {
        let longer = |p: &Vec<usize>| {
            (0..D).filter(|k| !p.contains(k)).map(|k| [p.as_slice(), &[k]].concat()).collect()
        };
        all.iter().flat_map(|p| -> Vec<Vec<usize>> { longer(p) }).collect()
    })
}

/// Where the surface crosses the edges of a simplex.
fn crossings<const D: usize>(shape: &Shape<D>, simplex: &[Corner<D>], size: f64) -> Vec<[f64; D]> {
    let (inside, outside): (Vec<_>, Vec<_>) = simplex.iter().partition(|corner| corner.1 <= 0.0);
    let crossing = |a: &Corner<D>, b: &Corner<D>| {
        let t = a.1 / (a.1 - b.1);
        onto(shape, &axpy(&a.0, if t.is_finite() { t } else { 0.5 }, &sub(&b.0, &a.0)), size)
    };
    inside.iter().flat_map(|a| outside.iter().map(move |b| crossing(a, b))).collect()
}

/// The nearest point of the surface.
fn onto<const D: usize>(shape: &Shape<D>, x: &[f64; D], size: f64) -> [f64; D] {
    shape.project(x, size).map_or(*x, |p| p.point)
}

/// The part of the surface in a simplex.
fn cut<const D: usize>(shape: &Shape<D>, simplex: &[Corner<D>], size: f64, found: &mut Vec<Element<D>>) {
    let crossings = crossings(shape, simplex, size);
    let onto = |x: &[f64; D]| onto(shape, x, size);
    let mut keep = |at: [f64; D], area: f64| {
        if let (true, Some(normal)) = (area > 0.0, normalized(&shape.gradient(&at))) {
            found.push(Element { at, normal, area });
        }
    };
    match (D, crossings.as_slice()) {
        (1, [x]) => keep(*x, 1.0),
        (2, [a, b]) => {
            let chord = norm(&sub(b, a));
            let flat = scale(0.5, &axpy(a, 1.0, b));
            let middle = onto(&flat);
            let height = norm(&sub(&middle, &flat));
            // The length of a flat arc of this height.
            keep(middle, if chord > 0.0 { chord + 8.0 / 3.0 * height * height / chord } else { 0.0 });
        }
        (3, [a, b, c]) => keep_triangle([a, b, c], &onto, &mut keep),
        // Crossings of the edges 00, 01, 10, 11 of two corners inside and two outside.
        (3, [a, b, c, d]) => {
            keep_triangle([a, b, c], &onto, &mut keep);
            keep_triangle([b, d, c], &onto, &mut keep);
        }
        _ => {}
    }
}

/// A triangle with its corners on the surface: its area from those of four with their corners there, and of itself.
fn keep_triangle<const D: usize>(
    [a, b, c]: [&[f64; D]; 3],
    onto: &dyn Fn(&[f64; D]) -> [f64; D],
    keep: &mut dyn FnMut([f64; D], f64),
) {
    let middle = |a: &[f64; D], b: &[f64; D]| onto(&scale(0.5, &axpy(a, 1.0, b)));
    let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
    let fine = area(a, &ab, &ca) + area(&ab, b, &bc) + area(&ca, &bc, c) + area(&ab, &bc, &ca);
    let center = onto(&scale(1.0 / 3.0, &axpy(&axpy(a, 1.0, b), 1.0, c)));
    keep(center, (4.0 * fine - area(a, b, c)) / 3.0);
}

fn area<const D: usize>(a: &[f64; D], b: &[f64; D], c: &[f64; D]) -> f64 {
    let (u, v) = (sub(b, a), sub(c, a));
    let dot = |x: &[f64; D], y: &[f64; D]| (0..D).map(|k| x[k] * y[k]).sum::<f64>();
    0.5 * (dot(&u, &u) * dot(&v, &v) - dot(&u, &v).powi(2)).max(0.0).sqrt()
}
