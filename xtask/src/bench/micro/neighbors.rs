//! Radius lists.

use meshless_neighbors::{Distance, Radius, within_radius};

use super::irregular;
use crate::bench::measure::on_one_and_two;
use crate::bench::table::Table;

const NODES: usize = 1_000_000;
const REPETITIONS: usize = 3;

pub(in crate::bench) fn run() -> crate::bench::Outcome {
    let head = [
        "radius lists",
        "nodes",
        "neighbours",
        "µs/node, 1 thread",
        "target",
        "of target",
        "2 threads",
        "speed-up",
    ];
    let mut table = Table::new(&head);
    lists::<2>(2.9, 1.5, &mut table)?;
    lists::<3>(2.2, 6.0, &mut table)?;
    Ok(vec![table])
}

/// Lists with a radius of `support` spacings; `target` in microseconds a node on one thread.
fn lists<const D: usize>(
    support: f64,
    target: f64,
    table: &mut Table,
) -> Result<(), Box<dyn std::error::Error + Send + Sync>> {
    let (cloud, spacing) = irregular::<D>(NODES)?;
    let radii = vec![support * spacing; cloud.len()];
    let search = || within_radius(cloud.points(), Radius::PerPoint(&radii), Distance::D2);
    let mean = search()?.mean_count();
    let [one, two] = on_one_and_two(REPETITIONS, search)?.map(|s| 1e6 * s / cloud.len() as f64);
    table.row(
        &format!("{D}-D"),
        vec![
            cloud.len().to_string(),
            format!("{mean:.1}"),
            format!("{one:.2}"),
            format!("{target}"),
            format!("{:.2}", one / target),
            format!("{two:.2}"),
            format!("{:.2}", one / two),
        ],
    );
    Ok(())
}
