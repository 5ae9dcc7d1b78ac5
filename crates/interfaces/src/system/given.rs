//! Systems of methods that split off the constants of stiff regions themselves.
//!
//! What they give is the system of [`Split::apply`](meshless_sparse::Split::apply), and is solved like it.

use meshless_sparse::{Bordered, Reduced};

use super::{SplitValues, SystemParams, SystemSolution};
use crate::method::SplitRows;
use crate::{Discretization, MethodError, Problem};

/// Eliminates the prescribed values, solves for `w` and `C`, and gives back nodal values.
pub(super) fn solve<const D: usize>(
    problem: &Problem<'_, D>,
    discretization: &Discretization,
    constants: &SplitRows,
    params: &SystemParams,
) -> Result<SystemSolution, MethodError> {
    let up_to_constant = !problem.is_anchored();
    let (system, reduced) = bordered(problem, discretization, constants)?;
    let solved = system.solve(&params.solver)?;
    if up_to_constant {
        super::check_balance(discretization, solved.extra[constants.split.extra()])?;
    }
    let w = reduced.expand(&solved.values, &prescribed(problem, constants))?;
    let mut u = constants.split.recover(&w, &solved.extra)?;
    u.iter_mut().zip(&constants.offsets).for_each(|(u, offset)| *u += offset);
    if up_to_constant {
        super::center(&mut u, &discretization.volumes);
    }
    let floating_constants = constants.split.extra();
    let split = Some(SplitValues { values: w, constants: solved.extra[..floating_constants].to_vec() });
    Ok(SystemSolution {
        u,
        extra: Vec::new(),
        info: solved.info,
        floating_constants,
        up_to_constant,
        split,
        rates: None,
        interface_flows: Vec::new(),
    })
}

/// The prescribed values in the unknowns of the rows: none of their nodes has a constant that is solved for.
fn prescribed<const D: usize>(problem: &Problem<'_, D>, constants: &SplitRows) -> Vec<Option<f64>> {
    let own = |(i, value): (usize, Option<f64>)| {
        value.map(|value| (value - constants.offsets[i]) / constants.split.scale(i))
    };
    problem.dirichlet().into_iter().enumerate().map(own).collect()
}

/// The bordered system, and what elimination has left of the rows.
pub(super) fn bordered<const D: usize>(
    problem: &Problem<'_, D>,
    discretization: &Discretization,
    constants: &SplitRows,
) -> Result<(Bordered, Reduced), MethodError> {
    let known = prescribed(problem, constants);
    let reduced = discretization.rows.eliminate(&known, &discretization.rhs)?;
    let system = match problem.is_anchored() {
        true => anchored(reduced.clone(), constants, known.len())?,
        false => adrift(&reduced, discretization, constants)?,
    };
    Ok((system, reduced))
}

/// The equations of the unknowns with the constants as extra ones, where something fixes them all; `nodes` is the number of all
/// nodes.
pub(super) fn anchored(
    reduced: Reduced,
    constants: &SplitRows,
    nodes: usize,
) -> Result<Bordered, MethodError> {
    let mut unknown_of = vec![None; nodes];
    (0..).zip(&reduced.map).for_each(|(k, &node)| unknown_of[node as usize] = Some(k));
    let column = |column: &Vec<(u32, f64)>| {
        column.iter().filter_map(|&(row, value)| Some((unknown_of[row as usize]?, value))).collect()
    };
    let columns = constants.columns.iter().map(column).collect();
    let split = constants.split.restricted(&reduced.map)?;
    let pinned = split.pinned().to_vec();
    Ok(Bordered::new(reduced.matrix, columns, pinned, reduced.rhs)?.with_split(split)?)
}

/// The same where nothing fixes the whole, so that all nodes are unknowns: one outside of the floating regions is pinned, and a
/// further extra unknown takes up what is not balanced.
fn adrift(
    reduced: &Reduced,
    discretization: &Discretization,
    constants: &SplitRows,
) -> Result<Bordered, MethodError> {
    let (split, n) = (&constants.split, reduced.map.len());
    let levels = split.recover(&vec![0.0; n], &vec![1.0; split.extra()])?;
    let free = (0..n).cycle().skip(n / 2).take(n).find(|&i| levels[i] == 0.0);
    let (mut columns, mut pinned) = (constants.columns.clone(), split.pinned().to_vec());
    pinned.push(free.unwrap_or(n / 2) as u32);
    columns.push((0..).zip(&discretization.volumes).map(|(row, &volume)| (row, volume)).collect());
    let system = Bordered::new(reduced.matrix.clone(), columns, pinned, reduced.rhs.clone())?;
    Ok(match free {
        Some(_) => system.with_split(split.clone())?,
        None => system.with_scales((0..n).map(|i| split.scale(i)).collect())?,
    })
}
