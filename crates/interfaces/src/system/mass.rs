//! The mass of rows in time: `M du/dt + A u = b`.

use meshless_sparse::DifferenceMatrix;

use crate::method::SplitRows;
use crate::{Discretization, MethodError, Problem, RowKind};

/// Off-diagonal entries of the wrong sign below this part of a row are rounding.
const ROUNDING: f64 = 1e-12;

/// M of a discretisation.
#[derive(Debug, Clone)]
pub enum Mass {
    /// The capacity of every row, its volume where none is given; zero for those that are algebraic equations.
    Diagonal(Vec<f64>),
    /// Rows over the values of the nodes.
    Rows(Box<MassRows>),
}

/// M that is not diagonal.
#[derive(Debug, Clone)]
pub struct MassRows {
    pub(super) nodal: DifferenceMatrix,
    /// Rows without du/dt, those of prescribed values aside.
    pub(super) algebraic: Vec<bool>,
    /// The same rows over `w`, and their columns of the constants, for methods that split these off.
    pub(super) split: Option<(DifferenceMatrix, Columns)>,
}

/// Entries of each column: row, value.
pub(super) type Columns = Vec<Vec<(u32, f64)>>;

impl Mass {
    /// The mass of all rows.
    ///
    /// # Errors
    /// Numbers that are not finite.
    pub fn of<const D: usize>(
        problem: &Problem<'_, D>,
        discretization: &Discretization,
    ) -> Result<Self, MethodError> {
        let Some(nodal) = &discretization.mass else {
            let capacity = |i: usize| match &discretization.capacities {
                Some(capacities) => capacities[i],
                None => discretization.volumes[i] * problem.capacity(i),
            };
            let mass = |(i, kind): (usize, &RowKind)| match kind {
                RowKind::Dirichlet | RowKind::StrongBoundary => 0.0,
                _ => capacity(i),
            };
            let mut all: Vec<f64> = discretization.kinds.iter().enumerate().map(mass).collect();
            // Further unknowns follow from the nodes.
            all.resize(discretization.rows.n(), 0.0);
            return Ok(Self::Diagonal(all));
        };
        let split = match &discretization.constants {
            Some(SplitRows { split, .. }) => {
                let rows = split.apply(nodal, &vec![0.0; nodal.n()])?;
                Some((rows.matrix().clone(), rows.columns().to_vec()))
            }
            None => None,
        };
        let none = |i: usize| nodal.row_sum(i) == 0.0 && nodal.row(i).1.iter().all(|&m| m == 0.0);
        let kinds = discretization.kinds.iter().enumerate();
        let algebraic = kinds.map(|(i, &kind)| kind != RowKind::Dirichlet && none(i)).collect();
        Ok(Self::Rows(Box::new(MassRows { nodal: nodal.clone(), algebraic, split })))
    }

    /// `M v`.
    pub fn times(&self, v: &[f64]) -> Vec<f64> {
        match self {
            Self::Diagonal(mass) => mass.iter().zip(v).map(|(m, v)| m * v).collect(),
            Self::Rows(rows) => {
                let mut out = vec![0.0; v.len()];
                rows.nodal.mul_vec(v, &mut out);
                out
            }
        }
    }

    /// A rate that nothing without data grows faster than in the maximum norm: what the off-diagonal entries of a row are more than the
    /// diagonal one, over its mass. `None` where that says nothing: M is not diagonal, or a row without du/dt is not dominated by
    /// its diagonal.
    pub fn growth_bound(&self, discretization: &Discretization) -> Option<f64> {
        let (Self::Diagonal(mass), rows, None) = (self, &discretization.rows, &discretization.constants)
        else {
            return None;
        };
        let mut bound = 0.0_f64;
        for (i, &mass) in mass.iter().enumerate() {
            let off = rows.row(i).1;
            let excess = off.iter().map(|a| a.abs() + a).sum::<f64>() - rows.row_sum(i);
            if mass > 0.0 {
                bound = bound.max(excess / mass);
            } else if excess > ROUNDING * off.iter().map(|a| a.abs()).sum::<f64>() {
                return None;
            }
        }
        Some(bound)
    }

    /// `M / c + A` in difference form, with the columns of the constants where the rows have any: a mass goes to the sums of
    /// rows, no diagonal is formed.
    ///
    /// # Errors
    /// Numbers that are not finite.
    pub fn shifted(
        &self,
        discretization: &Discretization,
        c: f64,
    ) -> Result<(DifferenceMatrix, Option<SplitRows>), MethodError> {
        let rows = &discretization.rows;
        let add = |i: usize, out: &mut meshless_sparse::RowBuilder| {
            let (columns, values) = rows.row(i);
            columns.iter().zip(values).for_each(|(&j, &a)| out.push(j as usize, a));
            out.add_to_row_sum(rows.row_sum(i));
        };
        let of_mass = match self {
            Self::Diagonal(mass) => {
                let shifted = DifferenceMatrix::from_rows(rows.n(), |i, out| {
                    add(i, out);
                    out.add_to_row_sum(mass[i] / c);
                })?;
                return Ok((shifted, discretization.constants.clone()));
            }
            Self::Rows(of_mass) => of_mass,
        };
        let mass = of_mass.split.as_ref().map_or(&of_mass.nodal, |split| &split.0);
        let shifted = DifferenceMatrix::from_rows(rows.n(), |i, out| {
            add(i, out);
            let (columns, values) = mass.row(i);
            columns.iter().zip(values).for_each(|(&j, &m)| out.push(j as usize, m / c));
            out.add_to_row_sum(mass.row_sum(i) / c);
        })?;
        let constants = match (&discretization.constants, &of_mass.split) {
            (Some(constants), Some((_, of_mass))) => {
                let mut constants = constants.clone();
                for (column, mass) in constants.columns.iter_mut().zip(of_mass) {
                    column.extend(mass.iter().map(|&(row, m)| (row, m / c)));
                }
                Some(constants)
            }
            _ => None,
        };
        Ok((shifted, constants))
    }
}

/// `b - A u` for nodal values, further unknowns included.
///
/// # Errors
/// Lengths that do not match.
pub fn residual(discretization: &Discretization, u: &[f64]) -> Result<Vec<f64>, MethodError> {
    let mut out = vec![0.0; u.len()];
    let Some(SplitRows { split, columns, offsets }) = &discretization.constants else {
        discretization.rows.residual(u, &discretization.rhs, &mut out);
        return Ok(out);
    };
    let beside: Vec<f64> = u.iter().zip(offsets).map(|(u, offset)| u - offset).collect();
    let (w, constants) = split.unknowns_of(&beside)?;
    discretization.rows.residual(&w, &discretization.rhs, &mut out);
    for (column, c) in columns.iter().zip(&constants) {
        column.iter().for_each(|&(row, value)| out[row as usize] -= value * c);
    }
    Ok(out)
}
