//! The change of unknowns for floating stiff regions.
//!
//! In a stiff region that touches no prescribed value u is one constant plus something as small as the inverse of the
//! contrast, and only that small part makes the flux. As unknowns take the constant C and the small part w:
//!
//! `u_i = sum_K sigma_K C_K + s_i w_i`, over the clusters K that node i lies in.
//!
//! The coefficient of C_K in row i is formed from differences, `sigma_K (sum_j a_ij ([j in K] - [i in K]) + r_i [i in K])`,
//! so inside of K it is exactly zero, not a rounded sum. One node of each cluster is pinned, w = 0; its equation becomes
//! that of the constant.

use crate::{Bordered, Csr, DifferenceMatrix, SolveError, SolveInfo, SolverParams};

/// Groups of unknowns with their scales and constants.
#[derive(Debug, Clone, PartialEq)]
pub struct Split {
    /// Group of every unknown.
    pub group: Vec<u32>,
    /// Scale s of every group.
    pub scale: Vec<f64>,
    /// Clusters that every group lies in.
    pub chain: Vec<Vec<u32>>,
    /// Factor of the constant of every cluster.
    pub sigma: Vec<f64>,
    /// The pinned unknown of every cluster: one that lies in no cluster within it.
    pub pins: Vec<u32>,
}

impl Split {
    /// The system in the unknowns w and C.
    pub fn apply(&self, matrix: &DifferenceMatrix, rhs: &[f64]) -> Bordered {
        let n = matrix.n();
        let mut pinned = vec![false; n];
        self.pins.iter().for_each(|&p| pinned[p as usize] = true);
        let mut columns = vec![Vec::new(); self.sigma.len()];
        let mut corner = vec![vec![0.0; self.sigma.len()]; self.sigma.len()];
        let mut rows = vec![Vec::new(); self.sigma.len()];
        let (mut offsets, mut indices, mut values) = (vec![0], Vec::new(), Vec::new());
        let mut b = rhs.to_vec();
        for i in 0..n {
            let constants = self.constants(matrix, i);
            if pinned[i] {
                indices.push(i as u32);
                values.push(1.0);
                b[i] = 0.0;
                for (k, _) in self.pins.iter().enumerate().filter(|(_, p)| **p as usize == i) {
                    rows[k] = self.scaled_row(matrix, i);
                    constants.iter().for_each(|&(cluster, v)| corner[k][cluster as usize] = v);
                }
            } else {
                let row = self.scaled_row(matrix, i);
                indices.extend(row.iter().map(|e| e.0));
                values.extend(row.iter().map(|e| e.1));
                constants.iter().for_each(|&(cluster, v)| columns[cluster as usize].push((i as u32, v)));
            }
            offsets.push(indices.len());
        }
        let a = Csr::from_trusted(n, offsets, indices, values);
        let extra = self.pins.iter().map(|&p| rhs[p as usize]).collect();
        Bordered { a, columns, rows, corner, rhs: b, extra }
    }

    /// Row i in the unknowns w, sorted by column.
    fn scaled_row(&self, matrix: &DifferenceMatrix, i: usize) -> Vec<(u32, f64)> {
        let scale = |j: u32| self.scale[self.group[j as usize] as usize];
        let (columns, values) = matrix.row(i);
        let mut row: Vec<(u32, f64)> = columns.iter().zip(values).map(|(&j, a)| (j, a * scale(j))).collect();
        let place = row.partition_point(|&(j, _)| (j as usize) < i);
        row.insert(place, (i as u32, matrix.diagonal(i) * scale(i as u32)));
        row
    }

    /// Coefficients of the constants in row i, those that are not zero.
    fn constants(&self, matrix: &DifferenceMatrix, i: usize) -> Vec<(u32, f64)> {
        let chain = |j: usize| self.chain[self.group[j] as usize].as_slice();
        let own = chain(i);
        let mut found: Vec<(u32, f64)> = Vec::new();
        let mut add = |cluster: u32, value: f64| match found.iter_mut().find(|f| f.0 == cluster) {
            Some(entry) => entry.1 += value,
            None => found.push((cluster, value)),
        };
        let (columns, values) = matrix.row(i);
        for (&j, &a) in columns.iter().zip(values) {
            let other = chain(j as usize);
            if other != own {
                other.iter().filter(|k| !own.contains(k)).for_each(|&k| add(k, a * self.sigma[k as usize]));
                own.iter().filter(|k| !other.contains(k)).for_each(|&k| add(k, -a * self.sigma[k as usize]));
            }
        }
        if matrix.row_sum(i) != 0.0 {
            own.iter().for_each(|&k| add(k, matrix.row_sum(i) * self.sigma[k as usize]));
        }
        found
    }

    /// The values u that belong to w and C.
    pub fn recover(&self, w: &[f64], constants: &[f64]) -> Vec<f64> {
        w.iter()
            .zip(&self.group)
            .map(|(w, &group)| {
                let chain = &self.chain[group as usize];
                let sum: f64 = chain.iter().map(|&k| self.sigma[k as usize] * constants[k as usize]).sum();
                sum + self.scale[group as usize] * w
            })
            .collect()
    }

    /// Solves `A u = b` in these unknowns.
    ///
    /// # Errors
    /// Those of [`Bordered::solve`].
    pub fn solve(
        &self,
        matrix: &DifferenceMatrix,
        rhs: &[f64],
        params: &SolverParams,
    ) -> Result<(Vec<f64>, SolveInfo), SolveError> {
        let (w, constants, info) = self.apply(matrix, rhs).solve(params)?;
        Ok((self.recover(&w, &constants), info))
    }
}

/// Solves a system whose rows all annihilate constants, up to a constant (unknown `pin` gets 0).
///
/// `A u + lambda v = b` with the extra unknown lambda, which takes up what of b is not balanced; `volumes` are the v.
/// Returns u and lambda.
///
/// # Errors
/// Those of [`Bordered::solve`].
pub fn solve_up_to_constant(
    matrix: &DifferenceMatrix,
    rhs: &[f64],
    volumes: &[f64],
    pin: usize,
    params: &SolverParams,
) -> Result<(Vec<f64>, f64, SolveInfo), SolveError> {
    let n = matrix.n();
    let split = Split {
        group: vec![0; n],
        scale: vec![1.0],
        chain: vec![vec![0]],
        sigma: vec![1.0],
        pins: vec![pin as u32],
    };
    let mut bordered = split.apply(matrix, rhs);
    // The constant itself has no influence anywhere; its place is taken by lambda.
    bordered.columns[0] = (0..n).filter(|&i| i != pin).map(|i| (i as u32, volumes[i])).collect();
    bordered.corner[0][0] = volumes[pin];
    let (u, lambda, info) = bordered.solve(params)?;
    Ok((u, lambda[0], info))
}
