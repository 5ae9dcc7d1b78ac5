//! The singular functions of a tip.

use meshless_geometry::{Slit, SlitPoint};

/// Distance from a tip, relative to the interaction radius, within which the singular functions have no gradient that
/// is worth the name.
const AT_THE_TIP: f64 = 1e-9;

/// How far a point of the slit is moved off it to tell its sides apart, in units of the slit's own tolerance.
const OFF_THE_SLIT: f64 = 4.0;

/// A tip of a slit of a problem.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Tip {
    /// The slit.
    pub(super) slit: usize,
    /// Its first (0) or last (1) vertex.
    pub(super) end: usize,
}

/// One of the two functions.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Singular {
    /// `sqrt(r) sin(theta/2)`: antisymmetric, with no flux at the slit.
    Sine,
    /// `sqrt(r) cos(theta/2)`: symmetric, vanishes at the slit.
    Cosine,
}

impl Singular {
    pub(super) const BOTH: [Self; 2] = [Self::Sine, Self::Cosine];

    /// Its value.
    pub(super) fn at<const D: usize>(self, slit: &Slit<D>, end: usize, x: &[f64; D]) -> f64 {
        let [r, theta] = slit.polar(end, x);
        r.sqrt() * self.angular(theta)
    }

    fn angular(self, theta: f64) -> f64 {
        match self {
            Self::Sine => (0.5 * theta).sin(),
            Self::Cosine => (0.5 * theta).cos(),
        }
    }

    /// Its gradient; zero at the tip itself. Its Laplacian vanishes everywhere.
    pub(super) fn gradient<const D: usize>(
        self,
        slit: &Slit<D>,
        end: usize,
        x: &[f64; D],
        radius: f64,
    ) -> [f64; D] {
        let [r, theta] = slit.polar(end, x);
        if r <= AT_THE_TIP * radius {
            return [0.0; D];
        }
        let half = 0.5 / r.sqrt();
        let (half_sin, half_cos) = f64::sin_cos(0.5 * theta);
        let (ahead, beside) = match self {
            Self::Sine => (-half * half_sin, half * half_cos),
            Self::Cosine => (half * half_cos, half * half_sin),
        };
        let (tip, sign) = (slit.end(end), outwards(end));
        std::array::from_fn(|k| sign * (ahead * tip.tangent[k] + beside * tip.normal[k]))
    }

    /// Along the slit at the distance `s` from the tip: the jump of the value, left less right, with its first two
    /// derivatives along the slit, and that of the normal derivative with its derivative.
    pub(super) fn jump<const D: usize>(self, slit: &Slit<D>, end: usize, at: &SlitPoint<D>) -> [f64; 5] {
        let sign = outwards(end);
        let s = if end == 0 { at.along } else { slit.length() - at.along };
        match self {
            // s falls along the slit where the tip is its last vertex.
            Self::Sine => [2.0 * sign * s.sqrt(), -1.0 / s.sqrt(), -0.5 * sign * s.powf(-1.5), 0.0, 0.0],
            Self::Cosine => [0.0, 0.0, 0.0, 1.0 / s.sqrt(), 0.5 * sign * s.powf(-1.5)],
        }
    }
}

/// 1 where the tip is left in the direction of the slit, -1 where against it.
fn outwards(end: usize) -> f64 {
    if end == 0 { -1.0 } else { 1.0 }
}

/// A point of the slit as it is seen from one of its sides, 1 for the left and -1 for the right.
pub(super) fn on_side<const D: usize>(slit: &Slit<D>, at: &SlitPoint<D>, side: f64) -> [f64; D] {
    let off = side * OFF_THE_SLIT * slit.tolerance();
    std::array::from_fn(|k| at.point[k] + off * at.normal[k])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against differences across the slit and along it, at both ends.
    #[test]
    fn jumps_are_those_of_the_functions() {
        let slit = Slit::new(vec![[0.0, 0.0], [0.6, 0.8]], [true, true]).unwrap();
        let step = 1e-4;
        for end in [0, 1] {
            for function in Singular::BOTH {
                let sides = |along: f64| {
                    let at = slit.at(along).unwrap();
                    [1.0, -1.0].map(|side| on_side(&slit, &at, side))
                };
                let value = |along: f64| {
                    let [left, right] = sides(along);
                    function.at(&slit, end, &left) - function.at(&slit, end, &right)
                };
                let at = slit.at(0.4).unwrap();
                let slope = |along: f64| {
                    let [left, right] = sides(along).map(|x| function.gradient(&slit, end, &x, 1.0));
                    (0..2).map(|k| (left[k] - right[k]) * at.normal[k]).sum::<f64>()
                };
                let (before, middle, after) = (value(0.4 - step), value(0.4), value(0.4 + step));
                let expected = [
                    middle,
                    (after - before) / (2.0 * step),
                    (after - 2.0 * middle + before) / (step * step),
                    slope(0.4),
                    (slope(0.4 + step) - slope(0.4 - step)) / (2.0 * step),
                ];
                let found = function.jump(&slit, end, &at);
                for (found, expected) in found.iter().zip(expected) {
                    assert!((found - expected).abs() < 1e-6, "{end}, {function:?}: {found} {expected}");
                }
            }
        }
    }

    #[test]
    fn gradients_are_those_of_the_functions() {
        let slit = Slit::new(vec![[0.0, 0.0], [0.6, 0.8]], [true, true]).unwrap();
        let step = 1e-6;
        for x in [[0.7, 0.9], [0.1, 0.5], [-0.3, -0.1], [0.5, 0.2]] {
            for (end, function) in [0, 1].into_iter().flat_map(|e| Singular::BOTH.map(|f| (e, f))) {
                let gradient = function.gradient(&slit, end, &x, 1.0);
                for k in 0..2 {
                    let (mut before, mut after) = (x, x);
                    before[k] -= step;
                    after[k] += step;
                    let quotient =
                        (function.at(&slit, end, &after) - function.at(&slit, end, &before)) / (2.0 * step);
                    assert!((gradient[k] - quotient).abs() < 1e-7, "{x:?}, {end}, {function:?}");
                }
            }
        }
    }
}
