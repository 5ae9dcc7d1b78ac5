//! A bordered system factorised as one sparse matrix.

use super::bordered::{Bordered, BorderedSolution};
use super::joined::{self, Equations, PinnedRows};
use crate::solver::{Factors, Scaled, SolveError};
use std::sync::OnceLock;

/// Componentwise backward error above which the rows are scaled otherwise: refinement leaves some 1e-16 where pivots are good.
const SOUND: f64 = 1e-12;

/// The factors of all equations together. Elimination of the extra unknowns beforehand would need the matrix of the nodes to
/// be well conditioned on its own.
#[derive(Debug)]
pub(super) struct Direct {
    /// Of rows scaled by their entries as they act on `w`.
    factors: (Scaled, Factors),
    /// Of rows scaled by their entries as they act on `s w`, made when it is needed: the pivots that stencils need which tie a
    /// stiff region to the outside as strongly as it is tied in itself.
    others: OnceLock<Option<(Scaled, Factors)>>,
}

fn factorised(system: &Bordered, scaled: bool) -> Result<(Scaled, Factors), SolveError> {
    let column = |j: usize| if scaled { system.inverse_scale(j) } else { 1.0 };
    Factors::lu(&joined::matrix(system, PinnedRows::Equations, column))
}

fn solve_by(
    (rows, factors): &(Scaled, Factors),
    system: &Bordered,
    rhs: &[f64],
    scaled: bool,
) -> Result<BorderedSolution, SolveError> {
    let equations = Equations { system, factors: rows.factors(), scaled };
    let (mut values, info) = factors.solve_refined(&equations, &rows.rhs(rhs))?;
    let extra = joined::take_extra(system, &mut values);
    if scaled {
        system.unscale(&mut values);
    }
    Ok(BorderedSolution { values, extra, info })
}

impl Direct {
    /// # Errors
    /// [`SolveError::Singular`], [`SolveError::OutOfMemory`].
    pub(super) fn new(system: &Bordered) -> Result<Self, SolveError> {
        Ok(Self { factors: factorised(system, false)?, others: OnceLock::new() })
    }

    /// Solves and refines with residuals formed by differences, until the componentwise backward error stagnates.
    ///
    /// # Errors
    /// [`SolveError::Singular`] where the solution overflows.
    pub(super) fn solve(&self, system: &Bordered, rhs: &[f64]) -> Result<BorderedSolution, SolveError> {
        let solution = solve_by(&self.factors, system, rhs, false)?;
        if solution.info.backward_error <= SOUND {
            return Ok(solution);
        }
        let Some(others) = self.others.get_or_init(|| factorised(system, true).ok()) else {
            return Ok(solution);
        };
        // Rows that tie large `w` to small ones are rounded by the difference form itself, so that backward errors tell little.
        if others.1.condition() >= self.factors.1.condition() {
            return Ok(solution);
        }
        solve_by(others, system, rhs, true)
    }
}
