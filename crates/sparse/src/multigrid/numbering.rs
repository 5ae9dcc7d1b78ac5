//! A numbering for matrices that come without one.

use crate::csr::Csr;
use crate::parallel;

/// Mean distance of entries from the diagonal, as a part of the rows, from which on a numbering is no order. One drawn by lot has
/// 1/3 of that; rows of a grid, one after the other, have less than 1/30 from a few hundred nodes on, planes of a cloud in space with 70
/// entries a row 1/12 at a few thousand.
const NO_ORDER: f64 = 1.0 / 8.0;

/// A numbering that does not bring entries nearer to the diagonal by this factor is none either: the matrix has no order to find.
const WORTH: f64 = 0.5;

/// Unknowns up to which a matrix is always renumbered: what comes of it does not depend on the numbers then. Larger ones would pay for
/// it with a copy and half as long a set-up more.
const SMALL: usize = 4096;

/// An order of the unknowns in which neighbours are near each other, if they are few, or if the one they have is no order and there is one. Aggregates
/// are founded in that order and Gauss-Seidel follows it: both are better along fronts than at random. The matrix comes without its
/// diagonal.
pub(crate) fn found(a: &Csr) -> Option<Vec<u32>> {
    if a.nrows() <= SMALL {
        return Some(cuthill_mckee(a));
    }
    let given = spread(a, |i| i);
    if given <= NO_ORDER * a.nrows() as f64 {
        return None;
    }
    let order = cuthill_mckee(a);
    let mut place = vec![0; order.len()];
    order.iter().enumerate().for_each(|(k, &i)| place[i as usize] = k);
    (spread(a, |i| place[i]) <= WORTH * given).then_some(order)
}

/// Mean distance of the entries from the diagonal, which is one of them.
fn spread(a: &Csr, place: impl Fn(usize) -> usize + Sync) -> f64 {
    let of = |i: usize| -> f64 {
        let here = place(i);
        a.row(i).0.iter().map(|&j| place(j as usize).abs_diff(here) as f64).sum()
    };
    parallel::map_rows(a.nrows(), of).iter().sum::<f64>() / (a.nnz() + a.nrows()).max(1) as f64
}

/// Level by level from an end of each connected part, neighbours by their degree (Cuthill and McKee 1969; the end as George
/// and Liu 1979 find it). Among equals the evenness of the entries decides, and only then the number: the order is the same
/// whatever the numbering was, unless there are rows that nothing tells apart.
fn cuthill_mckee(a: &Csr) -> Vec<u32> {
    let n = a.nrows();
    let evenness = parallel::map_rows(n, |i| {
        let sizes = || a.row(i).1.iter().map(|v| v.abs());
        sizes().fold(f64::INFINITY, f64::min) / sizes().fold(0.0, f64::max)
    });
    let graph = Both { a, reverse: &a.transpose(), evenness: &evenness };
    let mut starts: Vec<u32> = (0..n as u32).collect();
    starts.sort_by(|&i, &j| evenness[i as usize].total_cmp(&evenness[j as usize]));
    let mut order: Vec<u32> = Vec::with_capacity(n);
    let mut seen = vec![0u32; n];
    let mut stamp = 0;
    for start in starts {
        if seen[start as usize] == u32::MAX {
            continue;
        }
        // Twice to the last of the farthest: an end, or near one.
        let mut end = start;
        for _again in 0..2 {
            stamp += 1;
            let mut part = Vec::new();
            graph.walk(end, &mut seen, stamp, &mut part);
            end = part.last().copied().unwrap_or(end);
        }
        graph.walk(end, &mut seen, u32::MAX, &mut order);
    }
    order
}

/// A matrix as an undirected graph.
struct Both<'a> {
    a: &'a Csr,
    reverse: &'a Csr,
    /// The smallest entry of every row over the largest: sizes of rows do not matter.
    evenness: &'a [f64],
}

impl Both<'_> {
    fn degree(&self, i: u32) -> usize {
        self.a.row(i as usize).0.len() + self.reverse.row(i as usize).0.len()
    }

    /// Appends the nodes that can be reached from `start`, the near ones first, and marks them.
    fn walk(&self, start: u32, seen: &mut [u32], mark: u32, order: &mut Vec<u32>) {
        seen[start as usize] = mark;
        let mut next = order.len();
        order.push(start);
        while next < order.len() {
            let i = order[next] as usize;
            next += 1;
            let from = order.len();
            for &j in self.a.row(i).0.iter().chain(self.reverse.row(i).0) {
                if seen[j as usize] != mark {
                    seen[j as usize] = mark;
                    order.push(j);
                }
            }
            order[from..].sort_unstable_by(|&i, &j| {
                let even = |k: u32| self.evenness[k as usize];
                let by_number = || even(i).total_cmp(&even(j)).then(i.cmp(&j));
                self.degree(i).cmp(&self.degree(j)).then_with(by_number)
            });
        }
    }
}
