//! Where a solution is worst: a number a node, in units of u.
//!
//! Two solutions differ at a node by what is wrong there and by what comes from elsewhere. The latter is smooth: what the neighbours of a
//! node, by a polynomial of first degree, do not say of the difference is the node's own. To that comes what the data do between the
//! nodes: a source and a diffusivity are taken at points as far apart as nodes, and by how much one of them is not what the others say
//! changes u by the size of that times the square of the spacing.

use meshless_interfaces::{Field, Problem};
use meshless_neighbors::{CellList, NeighborLists};
use rayon::prelude::*;

/// Orders of differences of the data at most: higher ones see rounding.
const MOST: usize = 8;

/// What of a difference over the nodes of a cloud their neighbours in the same region do not say.
pub(super) fn of_differences<const D: usize>(
    points: &[[f64; D]],
    lists: &NeighborLists,
    labels: &[u16],
    differences: &[f64],
) -> Vec<f64> {
    let own = |i: usize| {
        let mut fit = Linear::<D>::default();
        for &j in lists.of(i) {
            let j = j as usize;
            if labels[j] == labels[i] {
                let offset = std::array::from_fn(|k| points[j][k] - points[i][k]);
                fit.add(offset, differences[j]);
            }
        }
        fit.value().map_or(0.0, |said| (differences[i] - said).abs())
    };
    (0..points.len()).into_par_iter().map(own).collect()
}

/// The root mean square over the neighbours of every node and itself: single nodes are large or small by chance.
pub(super) fn smoothed(lists: &NeighborLists, told: &[f64]) -> Vec<f64> {
    let mean = |i: usize| {
        let near = lists.of(i);
        let squares: f64 = near.iter().map(|&j| told[j as usize].powi(2)).sum::<f64>() + told[i].powi(2);
        (squares / (near.len() + 1) as f64).sqrt()
    };
    (0..told.len()).into_par_iter().map(mean).collect()
}

/// What is told at the nodes of one cloud, at those of another: by the nearest one.
pub(super) fn at_nearest<const D: usize>(
    from: &[[f64; D]],
    spacing: &[f64],
    told: &[f64],
    to: &[[f64; D]],
) -> Option<Vec<f64>> {
    let widest = spacing.iter().fold(0.0_f64, |a, &b| a.max(b));
    let index = CellList::new(from, widest).ok()?;
    to.par_iter().map(|x| index.nearest_one(x).map(|i| told[i as usize])).collect()
}

/// What the data of the equation do between the nodes, for fits of a degree, by how much that changes u.
pub(super) fn of_data<const D: usize>(problem: &Problem<'_, D>, u: &[f64], degree: usize) -> Vec<f64> {
    let (points, spacing) = (problem.cloud.points(), problem.cloud.spacing());
    let varies = |field: &Field<D>| field.as_constant().is_none();
    if !problem.materials.iter().any(|m| varies(&m.diffusivity) || m.source.as_ref().is_some_and(varies)) {
        return vec![0.0; points.len()];
    }
    let degree = degree.min(MOST);
    let own = |i: usize| {
        let (x, h, eta) = (&points[i], spacing[i], problem.eta[i]);
        let material = &problem.materials[problem.labels[i] as usize];
        let mut changed = 0.0_f64;
        if let Some(source) = material.source.as_ref().filter(|f| varies(f)) {
            changed = changed.max(between(source, x, h, degree) * h * h / eta);
        }
        if varies(&material.diffusivity) {
            let step = problem.supports.lists.of(i).iter().map(|&j| (u[j as usize] - u[i]).abs());
            let part = between(&material.diffusivity, x, h, degree) / eta;
            changed = changed.max(part.min(1.0) * step.fold(0.0, f64::max));
        }
        changed
    };
    (0..points.len()).into_par_iter().map(own).collect()
}

/// By how much the middle one of some values along an axis is not what the others say.
fn between<const D: usize>(field: &Field<D>, x: &[f64; D], h: f64, degree: usize) -> f64 {
    let count = degree + 2;
    let mut largest = 0.0_f64;
    for axis in 0..D {
        let (mut sum, mut middle, mut binomial) = (0.0, 1.0_f64, 1.0_f64);
        for k in 0..count {
            let mut at = *x;
            // Between the nodes: half a step off where there are as many on both sides.
            at[axis] += (k as f64 - 0.5 * (count - 1) as f64) * h;
            let sign = if k % 2 == 0 { 1.0 } else { -1.0 };
            sum += sign * binomial * field.at(&at);
            middle = middle.max(binomial);
            binomial *= (count - 1 - k) as f64 / (k + 1) as f64;
        }
        let off = sum.abs() / middle;
        // Beyond its region an expression need not be a number.
        if off.is_finite() {
            largest = largest.max(off);
        }
    }
    largest
}

/// Sums of a least-squares fit of first degree, for its value at the origin.
struct Linear<const D: usize> {
    squares: [[f64; 4]; 4],
    values: [f64; 4],
    count: usize,
    sum: f64,
}

impl<const D: usize> Default for Linear<D> {
    fn default() -> Self {
        Self { squares: [[0.0; 4]; 4], values: [0.0; 4], count: 0, sum: 0.0 }
    }
}

/// Pivots over the largest entry below which a fit is not determined: nodes on a line.
const SINGULAR: f64 = 1e-6;

impl<const D: usize> Linear<D> {
    fn add(&mut self, offset: [f64; D], value: f64) {
        let basis: [f64; 4] = std::array::from_fn(|k| match k {
            0 => 1.0,
            _ if k <= D => offset[k - 1],
            _ => 0.0,
        });
        for (row, a) in self.squares.iter_mut().zip(basis) {
            row.iter_mut().zip(basis).for_each(|(entry, b)| *entry += a * b);
        }
        self.values.iter_mut().zip(basis).for_each(|(entry, a)| *entry += a * value);
        self.count += 1;
        self.sum += value;
    }

    /// `None` without a point.
    fn value(mut self) -> Option<f64> {
        if self.count == 0 {
            return None;
        }
        let mean = self.sum / self.count as f64;
        // Elimination from the last to the first, which is the value at the origin.
        for k in (1..=D).rev() {
            let size = self.squares[k][k];
            let extent: f64 = (1..=D).map(|j| self.squares[j][j]).fold(0.0, f64::max);
            if !(size > SINGULAR * extent && extent > 0.0) {
                return Some(mean);
            }
            for j in 0..k {
                let factor = self.squares[j][k] / size;
                for l in 0..k {
                    self.squares[j][l] -= factor * self.squares[k][l];
                }
                self.values[j] -= factor * self.values[k];
            }
        }
        let pivot = self.squares[0][0];
        Some(if pivot > SINGULAR * self.count as f64 { self.values[0] / pivot } else { mean })
    }
}

#[cfg(test)]
mod tests {
    use meshless_neighbors::nearest;

    use super::*;

    #[test]
    fn what_neighbours_say_is_no_nodes_own() {
        let points: Vec<[f64; 2]> =
            (0..100).map(|k| [f64::from(k % 10) + 0.1 * f64::from(k % 7), f64::from(k / 10)]).collect();
        let lists = nearest(&points, 12).expect("lists");
        let linear: Vec<f64> = points.iter().map(|x| 3.0 + 2.0 * x[0] - x[1]).collect();
        let none = of_differences(&points, &lists, &[0; 100], &linear);
        assert!(none.iter().all(|own| *own < 1e-12), "{none:?}");
        let mut one = linear;
        one[55] += 1.0;
        let own = of_differences(&points, &lists, &[0; 100], &one);
        assert!((own[55] - 1.0).abs() < 1e-12 && own[0] < 1e-12 && own[54] < 0.5, "{own:?}");
    }

    #[test]
    fn polynomials_of_the_degree_do_nothing_between_the_nodes() {
        let cubic = Field::<2>::from_fn(|x| x[0].powi(3) - x[0] * x[1] + 2.0);
        assert!(between(&cubic, &[0.3, 0.4], 0.1, 3) < 1e-14);
        let narrow = Field::<2>::from_fn(|x| (-(x[0] * x[0] + x[1] * x[1]) / 1e-4).exp());
        // Of an even degree it is asked half-way between nodes, of an odd one at them.
        assert!(between(&narrow, &[0.05, 0.0], 0.1, 2) > 0.9);
        assert!(between(&narrow, &[0.0, 0.0], 0.1, 3) > 0.9);
    }
}
