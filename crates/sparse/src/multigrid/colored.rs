//! Gauss-Seidel by colours.

use crate::difference::DifferenceMatrix;
use crate::parallel;

/// Rows that one task works through.
const ROWS_PER_TASK: usize = 1024;

/// Rows by colour; rows of one colour have no entries in each other's columns.
#[derive(Debug)]
pub(crate) struct Colored {
    colors: Vec<Vec<u32>>,
    inverse: Vec<f64>,
}

impl Colored {
    /// Colours greedily, in the order of the rows.
    pub(crate) fn new(a: &DifferenceMatrix, inverse: Vec<f64>) -> Self {
        let n = a.n();
        let reverse = a.off_diagonal().transpose();
        let mut color = vec![usize::MAX; n];
        let mut colors: Vec<Vec<u32>> = Vec::new();
        let mut taken: Vec<usize> = Vec::new();
        for i in 0..n {
            taken.clear();
            let both = a.row(i).0.iter().chain(reverse.row(i).0);
            taken.extend(both.map(|&j| color[j as usize]).filter(|&c| c != usize::MAX));
            taken.sort_unstable();
            taken.dedup();
            // The first number that is missing.
            let free = taken.iter().zip(0..).find(|(c, k)| **c != *k).map_or(taken.len(), |(_, k)| k);
            color[i] = free;
            if free == colors.len() {
                colors.push(Vec::new());
            }
            colors[free].push(i as u32);
        }
        Self { colors, inverse }
    }

    pub(crate) fn bytes(&self) -> usize {
        size_of_val(&*self.inverse) + self.colors.iter().map(|c| size_of_val(&**c)).sum::<usize>()
    }

    pub(crate) fn sweep(
        &self,
        a: &DifferenceMatrix,
        b: &[f64],
        x: &mut [f64],
        t: &mut [f64],
        backward: bool,
    ) {
        for k in 0..self.colors.len() {
            let rows = &self.colors[if backward { self.colors.len() - 1 - k } else { k }];
            let new = &mut t[..rows.len()];
            let old = &*x;
            parallel::for_each_part(new, ROWS_PER_TASK, &|task, new| {
                for (new, &i) in new.iter_mut().zip(&rows[task * ROWS_PER_TASK..]) {
                    let i = i as usize;
                    *new = old[i] + (b[i] - a.row_product(i, old)) * self.inverse[i];
                }
            });
            rows.iter().zip(&*new).for_each(|(&i, &new)| x[i as usize] = new);
        }
    }
}
