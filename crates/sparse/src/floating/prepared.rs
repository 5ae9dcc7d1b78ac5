//! A bordered system prepared for any number of right-hand sides.

use super::bordered::{Bordered, BorderedSolution};
use super::coupled::Coupled;
use super::direct::Direct;
use super::eliminated::Eliminated;
use super::joined::{self, PinnedRows};
use super::nodal::{self, Nodal};
use crate::difference::DifferenceMatrix;
use crate::error::MatrixError;
use crate::multigrid::HierarchyInfo;
use crate::precond::PreconditionerKind;
use crate::solver::{AUTO_DIRECT_MAX, Prepared, SolveError, SolverKind, SolverParams};
use std::sync::{Arc, OnceLock};

/// A [`Bordered`] system with what is computed once for all right-hand sides.
///
/// The direct method factorises all equations together. With multigrid, GMRES runs on all of them: one solve for a right-hand side,
/// whatever the number of extra unknowns. Where these are the constants of a [`Split`](crate::Split), with or without
/// the incompatibility of a pure Neumann problem, the levels are made in nodal values; else the Schur complement of rough responses is part of the preconditioner.
/// The other methods solve with `A'` once for each extra unknown and once for the right-hand side, and refine the whole.
///
/// Where multigrid stagnates, elimination by BiCGStab(2) with ILU(0) steps in, and for that, up to
/// [`SolverParams::direct_max`] unknowns, the direct method. What has stepped in stays in charge.
#[derive(Debug)]
pub struct PreparedBordered {
    system: Bordered,
    params: SolverParams,
    coupled: Option<(Prepared, Coupled)>,
    /// Multigrid in nodal values, instead of `coupled`.
    nodal: Option<Nodal>,
    /// Made when they are needed.
    eliminated: OnceLock<Eliminated>,
    direct: OnceLock<Direct>,
}

impl PreparedBordered {
    /// Factors, or sets up the preconditioner, and solves for the response to every extra unknown.
    ///
    /// # Errors
    /// See [`Bordered::solve`].
    pub fn new(system: Bordered, params: &SolverParams) -> Result<Self, SolveError> {
        let is_small = system.n() <= AUTO_DIRECT_MAX;
        let kind = match params.kind {
            SolverKind::Auto if is_small => SolverKind::Direct,
            SolverKind::Auto => SolverKind::Multigrid,
            kind => kind,
        };
        let params = SolverParams { kind, ..*params };
        let (eliminated, direct) = (OnceLock::new(), OnceLock::new());
        let mut new = Self { system, params, coupled: None, nodal: None, eliminated, direct };
        match kind {
            _ if new.system.extra() == 0 => {
                new.eliminated()?;
            }
            // What the factors of the whole cannot tell apart, elimination may, and knows which unknown is open.
            SolverKind::Direct => match Direct::new(&new.system) {
                Err(SolveError::Singular { .. } | SolveError::EmptyRow { .. }) => {
                    new.eliminated()?;
                }
                direct => new.direct = OnceLock::from(direct?),
            },
            SolverKind::Multigrid if nodal::split(&new.system).is_some() => {
                match Nodal::new(&new.system, &params) {
                    Ok(nodal) => new.nodal = Some(nodal),
                    // A coarsest level that cannot be factorised, or whose entries overflow.
                    Err(SolveError::Singular { .. } | SolveError::Matrix(_)) => new.step_in()?,
                    Err(error) => return Err(error),
                }
            }
            SolverKind::Multigrid => {
                new.coupled = coupled(&new.system, &params)?;
                if new.coupled.is_none() {
                    new.step_in()?;
                }
            }
            _ => {
                new.eliminated()?;
            }
        }
        Ok(new)
    }

    /// Products that the responses to the extra unknowns have taken so far.
    #[must_use]
    pub fn products(&self) -> usize {
        self.coupled.as_ref().map_or(0, |c| c.1.products) + self.eliminated.get().map_or(0, |e| e.products)
    }

    /// The levels, where the preconditioner is multigrid.
    #[must_use]
    pub fn hierarchy(&self) -> Option<&HierarchyInfo> {
        match &self.coupled {
            Some((prepared, _)) => prepared.hierarchy(),
            None => match &self.nodal {
                Some(nodal) => Some(nodal.hierarchy()),
                None => self.eliminated.get().and_then(Eliminated::hierarchy),
            },
        }
    }

    /// Solves for another right-hand side.
    ///
    /// # Errors
    /// See [`Bordered::solve`]; [`MatrixError::Length`] where `rhs` does not have one element for each equation.
    pub fn solve(&self, rhs: &[f64]) -> Result<BorderedSolution, SolveError> {
        let system = &self.system;
        MatrixError::check_length("right-hand side", rhs.len(), system.n())?;
        MatrixError::check_finite("right-hand side", rhs)?;
        if let Some(direct) = self.direct.get() {
            return direct.solve(system, rhs);
        }
        if let (Some((prepared, coupled)), None) = (&self.coupled, self.eliminated.get())
            && let Some(levels) = prepared.levels()
            && let Ok((values, extra, info)) = coupled.solve(system, &levels, rhs, &self.params)
        {
            return Ok(BorderedSolution { values, extra, info });
        }
        if let (Some(nodal), Some(split), None) = (&self.nodal, nodal::split(system), self.eliminated.get())
            && let Ok((values, extra, info)) = nodal.solve(system, split, rhs, &self.params)
        {
            return Ok(BorderedSolution { values, extra, info });
        }
        match self.eliminated().and_then(|eliminated| eliminated.solve(system, rhs)) {
            Err(error) if self.may_factorise(&error) => self.factorised(error)?.solve(system, rhs),
            solved => solved,
        }
    }

    /// What takes over from multigrid.
    fn step_in(&self) -> Result<(), SolveError> {
        match self.eliminated() {
            Err(error) if self.may_factorise(&error) => self.factorised(error).map(|_| ()),
            eliminated => eliminated.map(|_| ()),
        }
    }

    fn eliminated(&self) -> Result<&Eliminated, SolveError> {
        if let Some(eliminated) = self.eliminated.get() {
            return Ok(eliminated);
        }
        let params = match self.params.kind {
            SolverKind::Multigrid if self.system.extra() > 0 => SolverParams {
                kind: SolverKind::BiCgStab { l: 2 },
                preconditioner: PreconditionerKind::Ilu0,
                ..self.params
            },
            _ => self.params,
        };
        let new = Eliminated::new(&self.system, &params)?;
        Ok(self.eliminated.get_or_init(|| new))
    }

    /// Whether the direct method steps in for what ended so.
    fn may_factorise(&self, error: &SolveError) -> bool {
        let stagnated = matches!(
            error,
            SolveError::NoConvergence { .. } | SolveError::BreakDown { .. } | SolveError::Undetermined { .. }
        );
        let (kind, extra) = (self.params.kind, self.system.extra());
        stagnated && extra > 0 && kind == SolverKind::Multigrid && self.system.n() <= self.params.direct_max
    }

    /// The factors, or the error that they were to mend.
    fn factorised(&self, error: SolveError) -> Result<&Direct, SolveError> {
        let Ok(new) = Direct::new(&self.system) else { return Err(error) };
        Ok(self.direct.get_or_init(|| new))
    }
}

/// `None` where multigrid does not find the responses.
fn coupled(system: &Bordered, params: &SolverParams) -> Result<Option<(Prepared, Coupled)>, SolveError> {
    let matrix = joined::matrix(system, PinnedRows::Identity, |j| system.inverse_scale(j));
    let rows = Arc::new(DifferenceMatrix::from_csr(&matrix)?);
    let prepared = Prepared::multigrid(rows, Some(system.factors()), params)?;
    let coupled = prepared.levels().and_then(|levels| Coupled::new(system, &levels).ok());
    Ok(coupled.map(|coupled| (prepared, coupled)))
}
