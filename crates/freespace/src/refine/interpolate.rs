//! Values of a coarse mesh at the points of a finer one.

/// How the solution of a coarser mesh is brought to a finer one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Superposition {
    /// By a shift in Fourier space: exact for what the coarse mesh holds, and one transform of the whole of it for each
    /// point that a cell of it is divided into.
    Shift,
    /// By M6* (van Rees et al. 2011): six points in each direction, exact for polynomials of degree 4.
    M6Star,
    /// By the polynomial through this even number of points in each direction, from 2 to 16.
    Lagrange(usize),
}

impl Superposition {
    /// Points on each side that are needed; none for the shift.
    pub(super) fn half_width(self) -> usize {
        match self {
            Self::Shift => 0,
            Self::M6Star => 3,
            Self::Lagrange(points) => points / 2,
        }
    }

    /// Weights of the points from `1 - half_width` to `half_width` for a value at `t` in [0, 1).
    fn weights(self, t: f64) -> Vec<f64> {
        let half = self.half_width() as i64;
        let places = (1 - half..=half).map(|i| i as f64);
        match self {
            Self::Shift => Vec::new(),
            Self::M6Star => places.map(|p| m6_star(t - p)).collect(),
            Self::Lagrange(_) => {
                let nodes: Vec<f64> = places.collect();
                let weight = |i: usize| {
                    let others = nodes.iter().enumerate().filter(|(j, _)| *j != i);
                    others.map(|(_, other)| (t - other) / (nodes[i] - other)).product()
                };
                (0..nodes.len()).map(weight).collect()
            }
        }
    }
}

/// The interpolation kernel M6* of van Rees et al. (2011): second derivatives are continuous, degree 4 is reproduced.
pub fn m6_star(x: f64) -> f64 {
    let x = x.abs();
    if x < 1.0 {
        -(x - 1.0) * (12.0 + x * (12.0 + x * (-3.0 + x * (-38.0 + x * 25.0)))) / 12.0
    } else if x < 2.0 {
        (x - 1.0) * (x - 2.0) * (-48.0 + x * (153.0 + x * (-114.0 + x * 25.0))) / 24.0
    } else if x < 3.0 {
        -(x - 2.0) * (x - 3.0).powi(3) * (5.0 * x - 8.0) / 24.0
    } else {
        0.0
    }
}

/// The kernel M4' of Monaghan (1985): four points, degree 2 is reproduced.
pub fn m4_prime(x: f64) -> f64 {
    let x = x.abs();
    if x < 1.0 {
        1.0 + x * x * (1.5 * x - 2.5)
    } else if x < 2.0 {
        0.5 * (2.0 - x).powi(2) * (1.0 - x)
    } else {
        0.0
    }
}

/// Interpolates from an array of `from` points to one of `to` points, direction by direction. The point `i` of the result
/// lies at `(i + first) / ratio + offset` in units of the coarse spacing, from the first point of the coarse array.
pub(super) fn interpolate<const D: usize>(
    values: &[f64],
    from: [usize; D],
    to: [usize; D],
    place: impl Fn(usize, usize) -> f64,
    how: Superposition,
) -> Vec<f64> {
    let mut shape = from;
    let mut current = values.to_vec();
    for axis in 0..D {
        let stride: usize = shape[..axis].iter().product();
        let (old, new) = (shape[axis], to[axis]);
        let mut next = vec![0.0; current.len() / old * new];
        let rows: Vec<(usize, Vec<f64>)> = (0..new)
            .map(|i| {
                let at = place(axis, i);
                let cell = at.floor();
                (cell as usize + 1 - how.half_width(), how.weights(at - cell))
            })
            .collect();
        for (block, out) in current.chunks_exact(old * stride).zip(next.chunks_exact_mut(new * stride)) {
            for (row, (first, weights)) in out.chunks_exact_mut(stride).zip(&rows) {
                for (k, weight) in weights.iter().enumerate() {
                    let source = &block[(first + k) * stride..][..stride];
                    row.iter_mut().zip(source).for_each(|(o, s)| *o += weight * s);
                }
            }
        }
        shape[axis] = new;
        current = next;
    }
    current
}

#[cfg(test)]
mod tests {
    use super::{Superposition, interpolate, m4_prime, m6_star};

    #[test]
    fn kernels_reproduce_their_degree_and_no_more() {
        for (kernel, degree) in [(m4_prime as fn(f64) -> f64, 2), (m6_star, 4)] {
            for t in [0.0, 0.2, 0.5, 0.9] {
                let sum = |power: i32| -> f64 {
                    (-4..=5).map(|i| kernel(t - f64::from(i)) * (t - f64::from(i)).powi(power)).sum()
                };
                assert!((sum(0) - 1.0).abs() < 1e-14);
                assert!((1..=degree).all(|power| sum(power).abs() < 1e-13), "{degree} {t}");
            }
            let fifth: f64 =
                (-4..=5).map(|i| kernel(0.3 - f64::from(i)) * (0.3 - f64::from(i)).powi(degree + 1)).sum();
            assert!(fifth.abs() > 1e-3);
        }
    }

    #[test]
    fn polynomials_are_interpolated_exactly() {
        let f = |x: f64, y: f64| x.powi(4) - 2.0 * x * y.powi(3) + y.powi(4);
        let coarse: Vec<f64> = (0..120).map(|i| f(f64::from(i % 12), f64::from(i / 12))).collect();
        for how in [Superposition::M6Star, Superposition::Lagrange(6), Superposition::Lagrange(8)] {
            let place = |_: usize, i: usize| 4.25 + i as f64 / 2.0;
            let fine = interpolate(&coarse, [12, 10], [5, 3], place, how);
            for (index, value) in fine.iter().enumerate() {
                let (x, y) = (place(0, index % 5), place(1, index / 5));
                assert!((value - f(x, y)).abs() < 1e-10 * f(12.0, 10.0).abs(), "{how:?} {index}");
            }
        }
    }
}
