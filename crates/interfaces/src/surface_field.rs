//! Data given at points of an interface, linear in between.

use crate::{MethodError, ScalarField};

/// Values at points of a curve (2-D) or a surface (3-D), interpolated linearly along its segments or triangles; elsewhere
/// the value at the nearest point of them (Yoon and Song 2021, after (57)).
#[derive(Debug, Clone, PartialEq)]
pub struct SurfaceField<const D: usize> {
    points: Vec<[f64; D]>,
    values: Vec<f64>,
    simplices: Vec<Vec<u32>>,
}

impl<const D: usize> SurfaceField<D> {
    /// From points, a value each, and the segments or triangles between them, by the indices of their points.
    ///
    /// # Errors
    /// [`MethodError::InvalidProblem`] for numbers that are not finite, lengths that do not agree, no simplices, and
    /// indices out of range.
    pub fn new(
        points: Vec<[f64; D]>,
        values: Vec<f64>,
        simplices: Vec<Vec<u32>>,
    ) -> Result<Self, MethodError> {
        let invalid = |what: String| Err(MethodError::InvalidProblem { what });
        if points.len() != values.len() {
            return invalid(format!("{} values at {} points of an interface", values.len(), points.len()));
        }
        if let Some(k) =
            (0..points.len()).find(|&k| !points[k].iter().chain([&values[k]]).all(|c| c.is_finite()))
        {
            return invalid(format!("point {k} of an interface or its value is not finite"));
        }
        if simplices.is_empty() {
            return invalid("an interface by points needs segments or triangles between them".to_owned());
        }
        let bad = |s: &Vec<u32>| s.is_empty() || s.len() > D || s.iter().any(|&p| p as usize >= points.len());
        if let Some(k) = simplices.iter().position(bad) {
            return invalid(format!("segment or triangle {k} of an interface does not join points of it"));
        }
        Ok(Self { points, values, simplices })
    }

    /// A closed polygon through the points.
    ///
    /// # Errors
    /// As [`SurfaceField::new`].
    pub fn polygon(points: Vec<[f64; D]>, values: Vec<f64>) -> Result<Self, MethodError> {
        let n = points.len() as u32;
        Self::new(points, values, (0..n).map(|k| vec![k, (k + 1) % n]).collect())
    }

    /// The value at the nearest point.
    pub fn at(&self, x: &[f64; D]) -> f64 {
        let found = self.simplices.iter().map(|simplex| self.nearest(simplex, x));
        found.fold((f64::INFINITY, f64::NAN), |best, next| if next.0 < best.0 { next } else { best }).1
    }

    /// Squared distance from a simplex, and the value at its nearest point.
    fn nearest(&self, simplex: &[u32], x: &[f64; D]) -> (f64, f64) {
        let origin = &self.points[simplex[0] as usize];
        let from: [f64; D] = std::array::from_fn(|k| x[k] - origin[k]);
        let dot = |a: &[f64; D], b: &[f64; D]| (0..D).map(|k| a[k] * b[k]).sum::<f64>();
        let edge = |p: u32| -> [f64; D] { std::array::from_fn(|k| self.points[p as usize][k] - origin[k]) };
        let inner = match simplex {
            [_] => Some(vec![1.0]),
            [_, b] => {
                let e = edge(*b);
                let t = dot(&from, &e) / dot(&e, &e);
                Some(vec![1.0 - t, t])
            }
            [_, b, c] => {
                let (e, f) = (edge(*b), edge(*c));
                let (ee, ef, ff) = (dot(&e, &e), dot(&e, &f), dot(&f, &f));
                let (xe, xf) = (dot(&from, &e), dot(&from, &f));
                let determinant = ee * ff - ef * ef;
                let (s, t) = ((ff * xe - ef * xf) / determinant, (ee * xf - ef * xe) / determinant);
                Some(vec![1.0 - s - t, s, t])
            }
            _ => None,
        };
        // Not a number for a simplex without extent, whose faces say the same.
        if let Some(shares) = inner.filter(|shares| shares.iter().all(|&s| s >= 0.0)) {
            let of =
                |f: &dyn Fn(u32) -> f64| simplex.iter().zip(&shares).map(|(&p, s)| s * f(p)).sum::<f64>();
            let squared = (0..D).map(|k| (x[k] - of(&|p| self.points[p as usize][k])).powi(2)).sum();
            return (squared, of(&|p| self.values[p as usize]));
        }
        let faces = (0..simplex.len()).map(|left_out| {
            let face: Vec<u32> = (0..simplex.len()).filter(|k| *k != left_out).map(|k| simplex[k]).collect();
            self.nearest(&face, x)
        });
        faces.fold((f64::INFINITY, f64::NAN), |best, next| if next.0 < best.0 { next } else { best })
    }
}

impl<const D: usize> ScalarField<D> for SurfaceField<D> {
    fn eval(&self, points: &[[f64; D]], out: &mut [f64]) {
        out.iter_mut().zip(points).for_each(|(value, x)| *value = self.at(x));
    }
}

#[cfg(test)]
mod tests {
    use super::SurfaceField;

    #[test]
    fn linear_data_are_linear_along_segments_and_triangles() {
        let square = vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let field = SurfaceField::polygon(square, vec![0.0, 1.0, 3.0, 2.0]).unwrap();
        assert_eq!(field.at(&[0.25, -0.1]), 0.25);
        assert_eq!(field.at(&[1.2, 0.5]), 2.0);
        assert_eq!(field.at(&[-0.1, 0.5]), 1.0);
        assert_eq!(field.at(&[1.3, 1.4]), 3.0);
        let corners = vec![[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let field = SurfaceField::new(corners, vec![1.0, 2.0, 3.0], vec![vec![0, 1, 2]]).unwrap();
        assert!((field.at(&[1.0, 1.0, 1.0]) - 2.0).abs() < 1e-15);
        assert_eq!(field.at(&[3.0, -1.0, -1.0]), 1.0);
        // Beyond the edge between the last two.
        assert!((field.at(&[-0.5, 0.6, 0.4]) - 2.4).abs() < 1e-15);
    }

    #[test]
    fn what_is_no_surface_is_refused() {
        let points = vec![[0.0, 0.0], [1.0, 0.0]];
        let new = |values: Vec<f64>, simplices| SurfaceField::new(points.clone(), values, simplices).is_err();
        assert!(new(vec![1.0], vec![vec![0, 1]]));
        assert!(new(vec![1.0, f64::NAN], vec![vec![0, 1]]));
        assert!(new(vec![1.0, 2.0], vec![]));
        assert!(new(vec![1.0, 2.0], vec![vec![0, 2]]));
    }
}
