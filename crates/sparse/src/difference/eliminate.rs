//! Elimination of prescribed values.

use super::DifferenceMatrix;
use crate::error::MatrixError;

/// Marks a node that has no unknown of its own.
const KNOWN: u32 = u32::MAX;

/// A system over the nodes whose values are not prescribed.
#[derive(Debug, Clone, PartialEq)]
pub struct Reduced {
    /// The equations of the unknown nodes.
    pub matrix: DifferenceMatrix,
    /// Their right-hand sides.
    pub rhs: Vec<f64>,
    /// Node of each unknown, increasing.
    pub map: Vec<u32>,
}

impl Reduced {
    /// Values at all nodes: the solution at the unknown ones, `known` elsewhere (the same as was eliminated).
    ///
    /// # Errors
    /// [`MatrixError::Length`] where `solution` does not have one value for each unknown.
    pub fn expand(&self, solution: &[f64], known: &[Option<f64>]) -> Result<Vec<f64>, MatrixError> {
        MatrixError::check_length("solution", solution.len(), self.map.len())?;
        let mut values: Vec<f64> = known.iter().map(|g| g.unwrap_or(0.0)).collect();
        for (&node, &u) in self.map.iter().zip(solution) {
            *values.get_mut(node as usize).ok_or(MatrixError::Length {
                what: "prescribed values",
                found: known.len(),
                expected: node as usize + 1,
            })? = u;
        }
        Ok(values)
    }
}

impl DifferenceMatrix {
    /// Drops the equations of the nodes with prescribed values and carries these values into the other equations:
    /// `a_ij (g_j - u_i)` moves `a_ij g_j` to the right-hand side and adds `-a_ij` to the row sum. Both are exact
    /// up to the one addition each; no diagonal is formed.
    ///
    /// # Errors
    /// [`MatrixError::Length`] where `known` or `rhs` does not have one element for each node, and
    /// [`MatrixError::BadNumber`] for a prescribed value or a right-hand side that is not finite.
    pub fn eliminate(&self, known: &[Option<f64>], rhs: &[f64]) -> Result<Reduced, MatrixError> {
        MatrixError::check_length("prescribed values", known.len(), self.n())?;
        MatrixError::check_length("right-hand side", rhs.len(), self.n())?;
        MatrixError::check_finite("right-hand side", rhs)?;
        if let Some((node, value)) =
            known.iter().enumerate().find_map(|(i, g)| g.map(|g| (i, g)).filter(|g| !g.1.is_finite()))
        {
            return Err(MatrixError::BadNumber { what: "the prescribed value", node, value });
        }
        let mut unknown_of = vec![KNOWN; self.n()];
        let mut map = Vec::with_capacity(self.n());
        for (node, _) in known.iter().enumerate().filter(|(_, g)| g.is_none()) {
            unknown_of[node] = map.len() as u32;
            map.push(node as u32);
        }
        let matrix = Self::from_rows(map.len(), |k, row| {
            let i = map[k] as usize;
            row.add_to_row_sum(self.row_sum(i));
            let (columns, values) = self.row(i);
            for (&j, &a) in columns.iter().zip(values) {
                match unknown_of[j as usize] {
                    KNOWN => row.add_to_row_sum(-a),
                    unknown => row.push(unknown as usize, a),
                }
            }
        })?;
        let reduced_rhs = map.iter().map(|&i| {
            let (columns, values) = self.row(i as usize);
            let carried = columns.iter().zip(values).filter_map(|(&j, a)| known[j as usize].map(|g| a * g));
            rhs[i as usize] - carried.sum::<f64>()
        });
        Ok(Reduced { rhs: reduced_rhs.collect(), matrix, map })
    }
}
