//! A system that is factored once and solved for many right-hand sides.

use std::sync::Arc;

use meshless_sparse::{DifferenceMatrix, Prepared, PreparedBordered, Reduced, SolveInfo, Split};

use super::{SplitValues, SystemParams, floating, given};
use crate::method::SplitRows;
use crate::{MethodError, Problem};

/// Marks a node whose value is prescribed.
const KNOWN: u32 = u32::MAX;

/// The rows of a discretisation, prescribed values eliminated and constants of floating regions split off, with factors
/// or a preconditioner.
#[derive(Debug)]
pub struct PreparedSystem {
    /// Entries of rows that prescribed values stand beside: unknown of the row, node of the value, entry.
    carried: Vec<(u32, u32, f64)>,
    /// Unknown of every node, or [`KNOWN`].
    unknown_of: Vec<u32>,
    solver: Solver,
}

#[derive(Debug)]
enum Solver {
    Plain(Box<Prepared>),
    Split(Box<PreparedBordered>, Split),
    /// Rows over `w` and `C` already, with the split of all nodes.
    Given(Box<PreparedBordered>, Split),
}

/// The rows of the unknowns, prescribed values eliminated.
fn reduce(rows: &DifferenceMatrix, known: &[bool]) -> Result<Reduced, MethodError> {
    let zeros: Vec<Option<f64>> = known.iter().map(|&k| k.then_some(0.0)).collect();
    Ok(rows.eliminate(&zeros, &vec![0.0; rows.n()])?)
}

/// Unknown of every node, or [`KNOWN`].
fn unknowns(reduced: &Reduced, nodes: usize) -> Vec<u32> {
    let mut unknown_of = vec![KNOWN; nodes];
    (0..).zip(&reduced.map).for_each(|(k, &node)| unknown_of[node as usize] = k);
    unknown_of
}

/// What elimination has to carry to the right-hand side.
fn carried(rows: &DifferenceMatrix, unknown_of: &[u32]) -> Vec<(u32, u32, f64)> {
    let mut carried = Vec::new();
    for (i, &unknown) in unknown_of.iter().enumerate().filter(|(_, k)| **k != KNOWN) {
        let (columns, values) = rows.row(i);
        let known = columns.iter().zip(values).filter(|(j, _)| unknown_of[**j as usize] == KNOWN);
        carried.extend(known.map(|(&j, &a)| (unknown, j, a)));
    }
    carried
}

impl PreparedSystem {
    /// Prepares rows in which values are prescribed at the nodes that are `known`.
    ///
    /// # Errors
    /// Those of the solver.
    pub fn new<const D: usize>(
        problem: &Problem<'_, D>,
        rows: &DifferenceMatrix,
        known: &[bool],
        params: &SystemParams,
    ) -> Result<Self, MethodError> {
        let reduced = reduce(rows, known)?;
        let split = match params.split_floating {
            true => floating::split(problem, &reduced.matrix, &reduced.map)?.map(|floating| floating.split),
            false => None,
        };
        Self::of(rows, reduced, split, params)
    }

    /// The same for rows of a method that splits off constants itself; something fixes them all.
    ///
    /// # Errors
    /// Those of the solver.
    pub fn with_constants(
        rows: &DifferenceMatrix,
        constants: &SplitRows,
        known: &[bool],
        params: &SystemParams,
    ) -> Result<Self, MethodError> {
        let reduced = reduce(rows, known)?;
        let unknown_of = unknowns(&reduced, rows.n());
        let bordered = given::anchored(reduced, constants, rows.n())?;
        let prepared = PreparedBordered::new(bordered, &params.solver)?;
        let solver = Solver::Given(Box::new(prepared), constants.split.clone());
        Ok(Self { carried: carried(rows, &unknown_of), unknown_of, solver })
    }

    /// Prepares other rows of the same pattern, as those of another time step: what floats and what is prescribed stay, and
    /// the graph of regions is not looked at again. The rest does not depend on what was prepared before.
    ///
    /// # Errors
    /// Those of the solver, and a matrix of another size.
    pub fn renewed(
        self,
        rows: &DifferenceMatrix,
        constants: Option<&SplitRows>,
        params: &SystemParams,
    ) -> Result<Self, MethodError> {
        let known: Vec<bool> = self.unknown_of.iter().map(|&k| k == KNOWN).collect();
        if let Some(constants) = constants {
            return Self::with_constants(rows, constants, &known, params);
        }
        let reduced = reduce(rows, &known)?;
        let split = match self.solver {
            Solver::Plain(_) | Solver::Given(..) => None,
            Solver::Split(_, split) => Some(split),
        };
        Self::of(rows, reduced, split, params)
    }

    fn of(
        rows: &DifferenceMatrix,
        reduced: Reduced,
        split: Option<Split>,
        params: &SystemParams,
    ) -> Result<Self, MethodError> {
        let unknown_of = unknowns(&reduced, rows.n());
        let Reduced { matrix, rhs, .. } = reduced;
        let solver = match split {
            Some(split) => {
                let bordered = split.apply(&matrix, &rhs)?;
                // Rows of large systems are not kept twice while they are prepared.
                drop(matrix);
                Solver::Split(Box::new(PreparedBordered::new(bordered, &params.solver)?), split)
            }
            None => Solver::Plain(Box::new(Prepared::of_rows(Arc::new(matrix), &params.solver)?)),
        };
        Ok(Self { carried: carried(rows, &unknown_of), unknown_of, solver })
    }

    /// Constants of floating regions that are solved for beside the nodes.
    pub fn floating_constants(&self) -> usize {
        match &self.solver {
            Solver::Plain(_) => 0,
            Solver::Split(_, split) | Solver::Given(_, split) => split.extra(),
        }
    }

    /// The value of every node for a right-hand side; at the known nodes, that is the prescribed value.
    ///
    /// # Errors
    /// Those of the solver.
    pub fn solve(&self, rhs: &[f64]) -> Result<(Vec<f64>, SolveInfo), MethodError> {
        self.solve_split(rhs).map(|(u, _, info)| (u, info))
    }

    /// The same with `w` and `C`, where the rows act on these.
    ///
    /// # Errors
    /// Those of the solver.
    pub fn solve_split(
        &self,
        rhs: &[f64],
    ) -> Result<(Vec<f64>, Option<SplitValues>, SolveInfo), MethodError> {
        let own = rhs.iter().zip(&self.unknown_of).filter(|(_, k)| **k != KNOWN);
        let mut reduced: Vec<f64> = own.map(|(&b, _)| b).collect();
        for &(row, node, a) in &self.carried {
            reduced[row as usize] -= a * rhs[node as usize];
        }
        let (solution, info) = match &self.solver {
            Solver::Plain(prepared) => prepared.solve(&reduced)?,
            Solver::Split(prepared, split) => {
                let solved = prepared.solve(&reduced)?;
                (split.recover(&solved.values, &solved.extra)?, solved.info)
            }
            Solver::Given(prepared, split) => {
                let solved = prepared.solve(&reduced)?;
                let values = self.expand(&solved.values, rhs);
                let u = split.recover(&values, &solved.extra)?;
                return Ok((u, Some(SplitValues { values, constants: solved.extra }), solved.info));
            }
        };
        Ok((self.expand(&solution, rhs), None, info))
    }

    /// Values of the unknowns, and those that are prescribed.
    fn expand(&self, solution: &[f64], rhs: &[f64]) -> Vec<f64> {
        let value = |(&k, &b): (&u32, &f64)| if k == KNOWN { b } else { solution[k as usize] };
        self.unknown_of.iter().zip(rhs).map(value).collect()
    }
}
