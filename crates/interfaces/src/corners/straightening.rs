//! Circles that meet in a vertex, made straight.
//!
//! `w = z / (1 - c z)`, z from the vertex as a complex number, leaves the vertex and all angles as they are and takes every circle
//! through it to another one. The ray that leaves at an angle a with curvature k becomes straight where `Im(c exp(i a)) = -k / 2`: one
//! c does for two circles, or for a circle and a line. A map that keeps angles keeps the equation `div(eta grad u) = 0` and the
//! conditions on u and its flux, so the functions of straight sectors in w are those of curved ones in z; fluxes through a length
//! there are `|dz/dw|` times those here.

use meshless_geometry::Ray;
use nalgebra::{Complex, Matrix2, Vector2};

/// What rays may bend after they are made straight, over the largest curvature: rounding.
const BEND: f64 = 1e-9;

/// The largest c, over the largest curvature: circles that meet at a smaller angle than the inverse touch.
const STEEPEST: f64 = 1e4;

/// Part of the distance of the point that goes to infinity within which distances change by less than twice.
const NEAR: f64 = 0.4;

/// The map round a vertex; the identity where all rays are straight.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Straightening {
    c: Complex<f64>,
}

impl Straightening {
    /// The map that makes all rays straight, where one does.
    pub(super) fn of<'a>(rays: impl Iterator<Item = &'a Ray> + Clone) -> Option<Self> {
        let largest = rays.clone().fold(0.0_f64, |m, ray| m.max(ray.curvature.abs()));
        if largest == 0.0 {
            return Some(Self::default());
        }
        // Least squares for (Re c, Im c): rows (sin a, cos a), right sides -k / 2.
        let (mut matrix, mut right) = (Matrix2::zeros(), Vector2::zeros());
        for ray in rays.clone() {
            let (sin, cos) = ray.angle.sin_cos();
            let row = Vector2::new(sin, cos);
            matrix += row * row.transpose();
            right -= 0.5 * ray.curvature * row;
        }
        let solution = matrix.lu().solve(&right)?;
        let map = Self { c: Complex::new(solution[0], solution[1]) };
        let bends = |ray: &Ray| {
            let turned = map.c * Complex::cis(ray.angle);
            (turned.im + 0.5 * ray.curvature).abs() > BEND * largest
        };
        // Circles that touch cannot be made straight.
        let is_mild = map.c.norm() <= STEEPEST * largest;
        (is_mild && !rays.clone().any(bends)).then_some(map)
    }

    /// Whether it leaves all as it is.
    pub(super) fn is_identity(&self) -> bool {
        self.c == Complex::ZERO
    }

    /// How far from the vertex the map is a mild one.
    pub(super) fn reach(&self) -> f64 {
        NEAR / self.c.norm()
    }

    /// Where a point goes, from the vertex.
    pub(super) fn straight(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        if self.is_identity() {
            return [x, y];
        }
        let z = Complex::new(x, y);
        let w = z / (1.0 - self.c * z);
        [w.re, w.im]
    }

    /// The point at a distance along what has become straight, at an angle: back where it came from. A line through the vertex stays on
    /// itself to the last digit.
    pub(super) fn back(&self, direction: [f64; 2], distance: f64) -> [f64; 2] {
        if self.is_identity() {
            return direction.map(|d| distance * d);
        }
        let unit = Complex::new(direction[0], direction[1]);
        let [along, _] = self.at_distance(unit, distance);
        if along.im.abs() <= f64::EPSILON * along.re.abs() {
            return direction.map(|d| along.re * d);
        }
        let z = unit * along;
        [z.re, z.im]
    }

    /// `dz/dw` times the direction a quarter turn to the left, at a distance from the vertex in a direction: across a ray, as long as a
    /// length there is over that of its image.
    pub(super) fn across(&self, direction: [f64; 2], distance: f64) -> [f64; 2] {
        let [x, y] = direction;
        if self.is_identity() {
            return [-y, x];
        }
        let [_, slope] = self.at_distance(Complex::new(x, y), distance);
        let across = slope * Complex::new(-y, x);
        [across.re, across.im]
    }

    /// How far the image goes of what leaves the vertex in a direction, up to a distance.
    pub(super) fn extent(&self, direction: [f64; 2], distance: f64) -> f64 {
        if self.is_identity() {
            return distance;
        }
        // The chord of an arc of curvature k turns away from its start by the angle with the sine k / 2 times its length.
        let unit = Complex::new(direction[0], direction[1]);
        let sin = -(self.c * unit).im * distance;
        let z = distance * unit * Complex::new((1.0 - sin * sin).max(0.0).sqrt(), sin);
        (z / (1.0 - self.c * z)).norm()
    }

    /// Point and derivative of the map back, both over the direction.
    fn at_distance(&self, unit: Complex<f64>, distance: f64) -> [Complex<f64>; 2] {
        let below = 1.0 + self.c * unit * distance;
        [distance / below, (below * below).inv()]
    }

    /// The gradient at a point z of what has this gradient in w.
    pub(crate) fn gradient(&self, [x, y]: [f64; 2], [gx, gy]: [f64; 2]) -> [f64; 2] {
        if self.is_identity() {
            return [gx, gy];
        }
        let below = 1.0 - self.c * Complex::new(x, y);
        let slope = (below * below).inv().conj() * Complex::new(gx, gy);
        [slope.re, slope.im]
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    fn ray(angle: f64, curvature: f64) -> Ray {
        Ray { angle, face: None, curvature }
    }

    /// A point of the circle, or line, along a ray.
    fn on(ray: &Ray, s: f64) -> [f64; 2] {
        let k = ray.curvature;
        let along = if k == 0.0 { [s, 0.0] } else { [(k * s).sin() / k, (1.0 - (k * s).cos()) / k] };
        let (sin, cos) = ray.angle.sin_cos();
        [along[0] * cos - along[1] * sin, along[0] * sin + along[1] * cos]
    }

    #[test]
    fn circles_and_lines_become_straight() {
        // A disc at a wall; a lens; two circles that cross.
        let scenes = [
            vec![ray(0.0, 0.0), ray(1.1, -2.0), ray(PI, 0.0)],
            vec![ray(0.4, 1.5), ray(1.3, -0.7)],
            vec![ray(0.4, 1.5), ray(1.3, -0.7), ray(0.4 + PI, -1.5), ray(1.3 + PI, 0.7)],
        ];
        for rays in scenes {
            let map = Straightening::of(rays.iter()).expect("one map does");
            for ray in &rays {
                for s in [0.01, 0.1, 0.3] {
                    let z = on(ray, s);
                    let w = map.straight(z);
                    let turn = (w[1].atan2(w[0]) - ray.angle).rem_euclid(2.0 * PI);
                    assert!(turn.min(2.0 * PI - turn) < 1e-12, "{ray:?} {s}: {turn}");
                    let (sin, cos) = ray.angle.sin_cos();
                    let back = map.back([cos, sin], w[0].hypot(w[1]));
                    assert!((back[0] - z[0]).hypot(back[1] - z[1]) < 1e-12);
                }
            }
        }
        assert!(Straightening::of([ray(0.0, 0.0), ray(1.0, 1.0), ray(2.0, 1.0)].iter()).is_none());
        assert!(Straightening::of([ray(0.0, 0.0), ray(PI, 1.0)].iter()).is_none());
        assert!(Straightening::of([ray(0.0, 0.0), ray(1.0, 0.0)].iter()).expect("straight").is_identity());
    }

    #[test]
    fn gradients_are_those_of_the_mapped_function() {
        let map = Straightening::of([ray(0.4, 1.5), ray(1.3, -0.7)].iter()).expect("one map does");
        let value = |z: [f64; 2]| {
            let w = map.straight(z);
            w[0] * w[0] + 3.0 * w[1]
        };
        let (z, step) = ([0.11, 0.23], 1e-6);
        let w = map.straight(z);
        let gradient = map.gradient(z, [2.0 * w[0], 3.0]);
        for k in 0..2 {
            let moved = |by: f64| std::array::from_fn(|j| if j == k { z[j] + by } else { z[j] });
            let difference = (value(moved(step)) - value(moved(-step))) / (2.0 * step);
            assert!((gradient[k] - difference).abs() < 1e-7, "{gradient:?}");
        }
        // Lengths along a ray, and across it.
        let (sin, cos) = 0.4_f64.sin_cos();
        let r = map.extent([cos, sin], 0.2);
        let [near, here, far] = [-step, 0.0, step].map(|t| map.back([cos, sin], r + t));
        assert!((here[0].hypot(here[1]) - 0.2).abs() < 1e-12);
        let along = [far[0] - near[0], far[1] - near[1]].map(|d| d / (2.0 * step));
        let across = map.across([cos, sin], r);
        assert!((across[0] + along[1]).abs() + (across[1] - along[0]).abs() < 1e-7);
    }
}
