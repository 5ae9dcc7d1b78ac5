//! The matrix-vector product against the bandwidth of the memory.

use meshless_neighbors::{NeighborLists, Radius, within_radius};
use meshless_sparse::{
    Csr, DifferenceMatrix, MatrixError, PreconditionerKind, Prepared, SolverKind, SolverParams,
};
use rayon::prelude::*;

use super::irregular;
use crate::bench::measure::on_one_and_two;
use crate::bench::table::Table;

const NODES: usize = 500_000;
const REPETITIONS: usize = 7;

/// Numbers in each array of the bandwidth test: far more than any cache holds.
const STREAM: usize = 1 << 24;

/// Elements that one task of the bandwidth test works on.
const CHUNK: usize = 1 << 16;

pub(in crate::bench) fn run() -> crate::bench::Outcome {
    let bandwidth = triad()?;
    let mut table = Table::new(&["", "threads", "ms", "GB/s", "of the bandwidth"]);
    let mut row = |name: &str, threads: usize, seconds: f64, bytes: f64| {
        let rate = bytes / seconds;
        let ratio = rate / bandwidth[threads - 1];
        table.row(
            name,
            vec![
                threads.to_string(),
                format!("{:.2}", 1e3 * seconds),
                format!("{:.1}", 1e-9 * rate),
                format!("{ratio:.2}"),
            ],
        );
    };
    for threads in [1, 2] {
        row("a = b + s c", threads, TRIAD_BYTES / bandwidth[threads - 1], TRIAD_BYTES);
    }
    let (lists, matrix) = matrix()?;
    let (x, n) = (vec![1.0; matrix.ncols()], matrix.nrows());
    // Every entry with its column once, one offset a row, x once, y once.
    let bytes = (matrix.bytes() + 16 * n) as f64;
    let product = on_one_and_two(REPETITIONS, || {
        let mut y = vec![0.0; n];
        matrix.mul_vec(&x, &mut y);
        y
    })?;
    for threads in [1, 2] {
        row(
            &format!("y = A x, {n} rows, {:.1} entries each", matrix.nnz() as f64 / n as f64),
            threads,
            product[threads - 1],
            bytes,
        );
    }
    let assembly = on_one_and_two(3, || rows(&lists))?;
    for threads in [1, 2] {
        row("assembly from rows", threads, assembly[threads - 1], bytes);
    }
    for preconditioner in [PreconditionerKind::Jacobi, PreconditionerKind::Ilu0] {
        let params =
            SolverParams { kind: SolverKind::BiCgStab { l: 2 }, preconditioner, ..SolverParams::default() };
        let setup = on_one_and_two(3, || Prepared::new(&matrix, &params))?;
        for threads in [1, 2] {
            row(&format!("set-up, {}", preconditioner.name()), threads, setup[threads - 1], bytes);
        }
    }
    Ok(vec![table])
}

/// Bytes that the bandwidth test moves: two arrays read, one written.
const TRIAD_BYTES: f64 = (3 * 8 * STREAM) as f64;

/// Bytes a second on one thread and on two (J. McCalpin's STREAM triad, without counting the read before the write).
fn triad() -> Result<[f64; 2], rayon::ThreadPoolBuildError> {
    let (b, c) = (vec![1.0_f64; STREAM], vec![2.0_f64; STREAM]);
    let a = std::sync::Mutex::new(vec![0.0_f64; STREAM]);
    let seconds = on_one_and_two(REPETITIONS, || {
        let mut a = a.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        a.par_chunks_mut(CHUNK).zip(b.par_chunks(CHUNK)).zip(c.par_chunks(CHUNK)).for_each(|((a, b), c)| {
            for i in 0..a.len() {
                a[i] = b[i] + 3.0 * c[i];
            }
        });
    })?;
    Ok(seconds.map(|s| TRIAD_BYTES / s))
}

/// A matrix with the pattern of a strong form in the plane: 27 neighbours.
fn matrix() -> Result<(NeighborLists, Csr), Box<dyn std::error::Error + Send + Sync>> {
    let (cloud, spacing) = irregular::<2>(NODES)?;
    let lists =
        within_radius(cloud.points(), Radius::Uniform(2.9 * spacing), meshless_neighbors::Distance::D2)?;
    let matrix = rows(&lists)?.to_csr();
    Ok((lists, matrix))
}

fn rows(lists: &NeighborLists) -> Result<DifferenceMatrix, MatrixError> {
    DifferenceMatrix::from_rows(lists.len(), |i, out| {
        lists.of(i).iter().for_each(|&j| out.push(j as usize, -1.0));
        out.add_to_row_sum(1.0);
    })
}
