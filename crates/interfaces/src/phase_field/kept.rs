//! Whether every region is still where its labels are.

use meshless_geometry::{Cloud, RegionMap};
use meshless_neighbors::NeighborLists;

use crate::MethodError;

/// A node without a node of another region within so many spacings is no matter of rounding: the diagonal of a square of
/// the lattice, and a little more.
const CLEAR: f64 = 1.5;

/// Largest share of a region's nodes near interfaces that may have come to lie in another region. Where the field does
/// its work an interface is known to a quarter of a spacing: in a layer of four spacings that is an eighth of the nodes.
const LOST: f64 = 0.25;

/// Compares the regions with the labels that they were made from, at the nodes of the band.
pub(super) fn check_kept<const D: usize>(
    cloud: &Cloud<D>,
    lists: &NeighborLists,
    labels: &[u16],
    band: &[u32],
    map: &RegionMap<D>,
) -> Result<(), MethodError> {
    let points = cloud.points();
    let clear = |i: usize| {
        let reach = (CLEAR * cloud.spacing()[i]).powi(2);
        lists.of(i).iter().all(|&j| {
            let j = j as usize;
            let squared: f64 = (0..D).map(|k| (points[j][k] - points[i][k]).powi(2)).sum();
            labels[j] == labels[i] || squared > reach
        })
    };
    // Nodes of the band and those that are lost, by region, and one of the latter.
    let mut counts = vec![(0_usize, 0_usize, None); map.len()];
    for i in band.iter().map(|&i| i as usize) {
        let count = &mut counts[labels[i] as usize];
        count.0 += 1;
        if map.label(&points[i], cloud.spacing()[i]) != labels[i] {
            count.1 += 1;
            count.2 = count.2.or(Some(i));
            if clear(i) {
                return Err(lost(cloud, labels[i], i));
            }
        }
    }
    match counts.iter().zip(0..).find(|((nodes, gone, _), _)| *gone as f64 > LOST * *nodes as f64) {
        Some(((.., Some(i)), region)) => Err(lost(cloud, region, *i)),
        _ => Ok(()),
    }
}

fn lost<const D: usize>(cloud: &Cloud<D>, region: u16, node: usize) -> MethodError {
    MethodError::LostRegion { region, position: cloud.points()[node].to_vec() }
}
