//! Least-squares stencils: factorisation and one operator, as the strong form needs them.

use meshless_neighbors::{NeighborLists, nearest};
use meshless_stencils::{FitParams, Functional, LocalFit, StencilError, Weight};
use rayon::prelude::*;

use super::irregular;
use crate::bench::measure::on_one_and_two;
use crate::bench::table::Table;

const NODES: usize = 100_000;
const REPETITIONS: usize = 5;

pub(in crate::bench) fn run() -> crate::bench::Outcome {
    let head = [
        "order 2",
        "neighbours",
        "operators",
        "µs/node, 1 thread",
        "target",
        "of target",
        "2 threads",
        "speed-up",
    ];
    let mut table = Table::new(&head);
    stencils::<2>(20, 4.0, &mut table)?;
    stencils::<3>(40, 15.0, &mut table)?;
    Ok(vec![table])
}

fn stencils<const D: usize>(
    count: usize,
    target: f64,
    table: &mut Table,
) -> Result<(), Box<dyn std::error::Error + Send + Sync>> {
    let (cloud, _) = irregular::<D>(NODES)?;
    let lists = nearest(cloud.points(), count)?;
    all(cloud.points(), &lists, 1)?;
    for operators in [1, 1 + D] {
        let [one, two] = on_one_and_two(REPETITIONS, || all(cloud.points(), &lists, operators))?
            .map(|s| 1e6 * s / cloud.len() as f64);
        let first = operators == 1;
        table.row(
            &format!("{D}-D"),
            vec![
                count.to_string(),
                operators.to_string(),
                format!("{one:.2}"),
                if first { format!("{target}") } else { String::new() },
                if first { format!("{:.2}", one / target) } else { String::new() },
                format!("{two:.2}"),
                format!("{:.2}", one / two),
            ],
        );
    }
    Ok(())
}

/// The Laplacian, and the first derivatives where more operators are asked for, at all nodes; the sum of one
/// coefficient each keeps the work from being optimised away.
fn all<const D: usize>(
    points: &[[f64; D]],
    lists: &NeighborLists,
    operators: usize,
) -> Result<f64, StencilError> {
    let fit = LocalFit::<D>::new(FitParams::default());
    let most = lists.max_count() + 1;
    let scratch = || (fit.scratch(most), Vec::with_capacity(most), Vec::with_capacity(most), vec![0.0; most]);
    (0..points.len())
        .into_par_iter()
        .map_init(scratch, |(scratch, offsets, weights, out), i| {
            let centre = points[i];
            let offset = |j: &u32| std::array::from_fn(|k| points[*j as usize][k] - centre[k]);
            offsets.clear();
            offsets.push([0.0; D]);
            offsets.extend(lists.of(i).iter().map(offset));
            let length = |x: &[f64; D]| x.iter().map(|a| a * a).sum::<f64>().sqrt();
            let radius = offsets.iter().map(length).fold(0.0, f64::max);
            weights.clear();
            weights.extend(offsets.iter().map(|x| Weight::Exponential.value(length(x), radius, radius)));
            fit.factor(offsets, weights, radius, scratch)?;
            let out = &mut out[..offsets.len()];
            fit.coefficients(&Functional::Laplacian, scratch, out)?;
            for k in 1..operators {
                fit.coefficients(&Functional::Partial(k - 1), scratch, out)?;
            }
            Ok(out[0])
        })
        .sum()
}
