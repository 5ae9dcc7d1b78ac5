//! What is integrated.

/// A system `M du/dt + A(t) u = b(t)` with a mass matrix M; rows without mass are algebraic.
pub trait Semidiscrete {
    /// What can go wrong in a solve.
    type Error: std::error::Error;

    /// Changes values at the start, or just after data have jumped, so that they fulfil the algebraic rows. Without
    /// effect unless a system needs it: one whose algebraic rows get no part in the others by M.
    ///
    /// # Errors
    /// Those of the linear solver, and of evaluating the data at `t`.
    fn make_consistent(&mut self, _t: f64, _u: &mut [f64]) -> Result<(), Self::Error> {
        Ok(())
    }

    /// `M^-1 (b(t) - A(t) u)`; zero in algebraic rows.
    ///
    /// # Errors
    /// Those of evaluating the data at `t`.
    fn slope(&mut self, t: f64, u: &[f64], out: &mut [f64]) -> Result<(), Self::Error>;

    /// Solves `M (u - v) / c + A(t) u = b(t)`, algebraic rows `A(t) u = b(t)`. `u` holds a guess when called.
    ///
    /// # Errors
    /// Those of the linear solver, and of evaluating the data at `t`.
    fn solve(&mut self, t: f64, c: f64, v: &[f64], u: &mut [f64]) -> Result<(), Self::Error>;

    /// Replaces e by the solution x of `M (x - e) / c + A(t) x = 0`, algebraic rows `A(t) x = 0`: takes from an error
    /// estimate what the method itself would damp.
    ///
    /// # Errors
    /// Those of the linear solver.
    fn damp(&mut self, t: f64, c: f64, e: &mut [f64]) -> Result<(), Self::Error>;

    /// The same for values that fulfil the algebraic rows, which count for the others then: `M (x - e) / c + A(t) x = 0`. No different where M
    /// is diagonal.
    ///
    /// # Errors
    /// Those of the linear solver.
    fn decay(&mut self, t: f64, c: f64, e: &mut [f64]) -> Result<(), Self::Error> {
        self.damp(t, c, e)
    }

    /// Which of the unknowns have no du/dt: prescribed values, and what follows from others.
    fn algebraic(&self, unknowns: usize) -> Vec<bool> {
        vec![false; unknowns]
    }

    /// How often M or A has changed so far.
    fn changes(&self) -> usize {
        0
    }

    /// Whether to look for what grows by itself: no need where the rows themselves say that nothing does, as those of an M-matrix
    /// do, and no use where the equation wants some to.
    fn may_grow(&self) -> bool {
        true
    }

    /// The norm in which errors are measured, best one that does not depend on the number of unknowns: the root of a
    /// mean square weighted by volumes.
    fn norm(&self, e: &[f64]) -> f64;
}
