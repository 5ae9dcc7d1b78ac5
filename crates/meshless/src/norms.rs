//! Relative error norms over nodes.

/// Sums from which the norms of an error are formed.
#[derive(Debug, Clone, Copy, Default)]
pub struct ErrorNorms {
    error_squared: f64,
    exact_squared: f64,
    error_max: f64,
    exact_max: f64,
}

impl ErrorNorms {
    /// Adds a node with its measure, its error and its exact value (or their Euclidean norms, for vectors).
    pub fn add(&mut self, measure: f64, error: f64, exact: f64) {
        self.error_squared += measure * error * error;
        self.exact_squared += measure * exact * exact;
        self.error_max = self.error_max.max(error.abs());
        self.exact_max = self.exact_max.max(exact.abs());
    }

    /// `sqrt(sum v u^2)`
    pub fn exact_size(&self) -> f64 {
        self.exact_squared.sqrt()
    }

    /// `sqrt(sum v e^2 / sum v u^2)`; absolute where the exact solution vanishes.
    pub fn l2(&self) -> f64 {
        if self.exact_squared > 0.0 {
            (self.error_squared / self.exact_squared).sqrt()
        } else {
            self.error_squared.sqrt()
        }
    }

    /// `max |e| / max |u|`; absolute where the exact solution vanishes.
    pub fn linf(&self) -> f64 {
        if self.exact_max > 0.0 { self.error_max / self.exact_max } else { self.error_max }
    }
}

#[cfg(test)]
mod tests {
    use super::ErrorNorms;

    #[test]
    fn norms_are_relative_and_weighted() {
        let mut norms = ErrorNorms::default();
        norms.add(1.0, 0.3, 3.0);
        norms.add(3.0, -0.1, 1.0);
        assert!((norms.l2() - (0.12_f64 / 12.0).sqrt()).abs() < 1e-15);
        assert!((norms.linf() - 0.1).abs() < 1e-15);
    }

    #[test]
    fn a_vanishing_solution_leaves_absolute_norms() {
        let mut norms = ErrorNorms::default();
        norms.add(4.0, 0.5, 0.0);
        assert_eq!((norms.l2(), norms.linf()), (1.0, 0.5));
    }
}
