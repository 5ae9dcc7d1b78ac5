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
    let w = reduced.expand(&solved.values, &problem.dirichlet())?;
    let mut u = constants.split.recover(&w, &solved.extra)?;
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
    })
}

/// The bordered system, and what elimination has left of the rows.
pub(super) fn bordered<const D: usize>(
    problem: &Problem<'_, D>,
    discretization: &Discretization,
    constants: &SplitRows,
) -> Result<(Bordered, Reduced), MethodError> {
    let known = problem.dirichlet();
    let reduced = discretization.rows.eliminate(&known, &discretization.rhs)?;
    let mut unknown_of = vec![None; known.len()];
    (0..).zip(&reduced.map).for_each(|(k, &node)| unknown_of[node as usize] = Some(k));
    let of = |node: u32| unknown_of[node as usize];
    let columns = constants
        .columns
        .iter()
        .map(|column| column.iter().filter_map(|&(row, value)| of(row).map(|k: u32| (k, value))).collect());
    let mut columns: Vec<Vec<(u32, f64)>> = columns.collect();
    let mut pinned: Vec<u32> = constants.split.pinned().iter().filter_map(|&node| of(node)).collect();
    if !problem.is_anchored() {
        // One node outside of the floating regions is pinned, and an extra unknown takes up what is not balanced.
        let ones = vec![1.0; constants.split.extra()];
        let levels = constants.split.recover(&vec![0.0; known.len()], &ones)?;
        let free =
            (0..known.len()).cycle().skip(known.len() / 2).take(known.len()).find(|&i| levels[i] == 0.0);
        pinned.push(free.unwrap_or(known.len() / 2) as u32);
        columns.push((0..).zip(&discretization.volumes).map(|(row, &volume)| (row, volume)).collect());
    }
    let scales = reduced.map.iter().map(|&node| constants.split.scale(node as usize)).collect();
    let system =
        Bordered::new(reduced.matrix.clone(), columns, pinned, reduced.rhs.clone())?.with_scales(scales)?;
    Ok((system, reduced))
}
