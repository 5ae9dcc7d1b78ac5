//! Where an integration stands.

use crate::Past;

/// Everything that the next step depends on: a run that goes on from it takes the same steps, bit for bit.
/// (What grows may be told some steps earlier or later.)
#[derive(Debug, Clone, PartialEq)]
pub struct State {
    /// Time.
    pub t: f64,
    /// Step size to try next.
    pub step: f64,
    /// Solution.
    pub u: Vec<f64>,
    /// `du/dt`; zero in algebraic rows.
    pub slope: Vec<f64>,
    /// Largest norm of the solution met so far.
    pub scale: f64,
    /// Steps taken.
    pub steps: usize,
    /// Steps that were tried and rejected.
    pub rejected: usize,
    /// What growth is told by.
    pub past: Past,
}
