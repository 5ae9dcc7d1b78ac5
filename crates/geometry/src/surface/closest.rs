//! The point of a triangle nearest to a point, and which part of the triangle it is on.

use crate::vector::{axpy, dot, sub};

/// A part of a triangle. Edge k runs from corner k to the next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Part {
    Face,
    Edge(u8),
    Corner(u8),
}

/// The nearest point of the triangle `a`, `b`, `c`, its weights (barycentric coordinates) and its part.
///
/// After Ericson, *Real-Time Collision Detection* (2005), section 5.1.5: the Voronoi regions of corners and edges in turn.
/// A triangle without an area is never taken for a face.
pub(super) fn closest(x: &[f64; 3], corners: [&[f64; 3]; 3]) -> ([f64; 3], [f64; 3], Part) {
    let [a, b, c] = corners;
    let (ab, ac) = (sub(b, a), sub(c, a));
    let ap = sub(x, a);
    let (d1, d2) = (dot(&ab, &ap), dot(&ac, &ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return (*a, [1.0, 0.0, 0.0], Part::Corner(0));
    }
    let bp = sub(x, b);
    let (d3, d4) = (dot(&ab, &bp), dot(&ac, &bp));
    if d3 >= 0.0 && d4 <= d3 {
        return (*b, [0.0, 1.0, 0.0], Part::Corner(1));
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        let t = d1 / (d1 - d3);
        return (axpy(a, t, &ab), [1.0 - t, t, 0.0], Part::Edge(0));
    }
    let cp = sub(x, c);
    let (d5, d6) = (dot(&ab, &cp), dot(&ac, &cp));
    if d6 >= 0.0 && d5 <= d6 {
        return (*c, [0.0, 0.0, 1.0], Part::Corner(2));
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        let t = d2 / (d2 - d6);
        return (axpy(a, t, &ac), [1.0 - t, 0.0, t], Part::Edge(2));
    }
    let va = d3 * d6 - d5 * d4;
    let (along, back) = (d4 - d3, d5 - d6);
    if va <= 0.0 && along >= 0.0 && back >= 0.0 {
        let t = along / (along + back).max(f64::MIN_POSITIVE);
        return (axpy(b, t, &sub(c, b)), [0.0, 1.0 - t, t], Part::Edge(1));
    }
    let sum = va + vb + vc;
    let (v, w) = (vb / sum, vc / sum);
    (axpy(&axpy(a, v, &ab), w, &ac), [1.0 - v - w, v, w], Part::Face)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vector::distance;
    use proptest::prelude::*;

    #[test]
    fn every_part_has_its_region() {
        let (a, b, c) = ([0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]);
        for (x, expected, part) in [
            ([-1.0, -1.0, 1.0], a, Part::Corner(0)),
            ([3.0, -1.0, 1.0], b, Part::Corner(1)),
            ([-1.0, 3.0, 1.0], c, Part::Corner(2)),
            ([1.0, -1.0, 1.0], [1.0, 0.0, 0.0], Part::Edge(0)),
            ([2.0, 2.0, 1.0], [1.0, 1.0, 0.0], Part::Edge(1)),
            ([-1.0, 1.0, 1.0], [0.0, 1.0, 0.0], Part::Edge(2)),
            ([0.5, 0.5, 1.0], [0.5, 0.5, 0.0], Part::Face),
        ] {
            let (point, weights, found) = closest(&x, [&a, &b, &c]);
            assert_eq!((point, found), (expected, part), "{x:?}");
            assert!((weights.iter().sum::<f64>() - 1.0).abs() < 1e-15);
        }
    }

    proptest! {
        #[test]
        fn no_point_of_the_triangle_is_nearer(
            t in prop::array::uniform3(prop::array::uniform3(-1.0..1.0_f64)),
            x in prop::array::uniform3(-2.0..2.0_f64),
            samples in prop::collection::vec((0.0..1.0_f64, 0.0..1.0_f64), 20),
        ) {
            let (point, weights, _) = closest(&x, [&t[0], &t[1], &t[2]]);
            let combined: [f64; 3] =
                std::array::from_fn(|k| (0..3).map(|i| weights[i] * t[i][k]).sum());
            prop_assert!(distance(&point, &combined) < 1e-12);
            for (r, s) in samples {
                let (r, s) = if r + s > 1.0 { (1.0 - r, 1.0 - s) } else { (r, s) };
                let y = axpy(&axpy(&t[0], r, &sub(&t[1], &t[0])), s, &sub(&t[2], &t[0]));
                prop_assert!(distance(&x, &point) <= distance(&x, &y) + 1e-12);
            }
        }
    }
}
