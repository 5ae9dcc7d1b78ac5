//! Voronoi cells from neighbourhoods.

use meshless_cells::{CellError, CellScratch, Container, box_planes, voronoi_cell};
use meshless_neighbors::{Distance, NeighborLists, Radius, within_radius};
use rayon::prelude::*;

use super::irregular;
use crate::bench::measure::on_one_and_two;
use crate::bench::table::Table;

const NODES: usize = 100_000;
const REPETITIONS: usize = 3;

pub(in crate::bench) fn run() -> crate::bench::Outcome {
    let mut table = Table::new(&[
        "Voronoi cells",
        "candidates",
        "incomplete",
        "µs/cell, 1 thread",
        "2 threads",
        "speed-up",
    ]);
    cells::<2>(2.9, &mut table)?;
    cells::<3>(2.2, &mut table)?;
    Ok(vec![table])
}

fn cells<const D: usize>(
    support: f64,
    table: &mut Table,
) -> Result<(), Box<dyn std::error::Error + Send + Sync>> {
    let (cloud, spacing) = irregular::<D>(NODES)?;
    let radius = support * spacing;
    let lists = within_radius(cloud.points(), Radius::Uniform(radius), Distance::D2)?;
    let incomplete = all(cloud.points(), &lists, radius)?;
    let [one, two] = on_one_and_two(REPETITIONS, || all(cloud.points(), &lists, radius))?
        .map(|s| 1e6 * s / cloud.len() as f64);
    table.row(
        &format!("{D}-D"),
        vec![
            format!("{:.1}", lists.mean_count()),
            incomplete.to_string(),
            format!("{one:.2}"),
            format!("{two:.2}"),
            format!("{:.2}", one / two),
        ],
    );
    Ok(())
}

/// All cells; counts those that nodes beyond the radius might touch, which a method would search farther for.
fn all<const D: usize>(points: &[[f64; D]], lists: &NeighborLists, radius: f64) -> Result<usize, CellError> {
    let planes = box_planes(&[0.0; D], &[1.0; D]);
    let container = Container { min: [0.0; D], max: [1.0; D], planes: &planes, cuts: &[], walls: None };
    (0..points.len())
        .into_par_iter()
        .map_init(
            || (CellScratch::default(), Vec::new()),
            |(scratch, candidates), i| {
                candidates.clear();
                candidates.extend(lists.of(i).iter().map(|&j| (j, points[j as usize])));
                match voronoi_cell(&points[i], candidates, radius, &container, scratch) {
                    Ok(_) => Ok(0),
                    Err(CellError::Incomplete { .. }) => Ok(1),
                    Err(error) => Err(error),
                }
            },
        )
        .sum()
}
