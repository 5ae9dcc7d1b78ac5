//! Whether every region is still where its labels are, and has its interfaces.

use meshless_geometry::{Cloud, RegionMap};
use meshless_neighbors::NeighborLists;

use crate::MethodError;
use crate::parallel;

/// A node without a node of another region within so many spacings is no matter of rounding: the diagonal of a square of
/// the lattice, and a little more.
const CLEAR: f64 = 1.5;

/// Largest share of a region's nodes near interfaces that may have come to lie in another region. Where the field does
/// its work an interface is known to a quarter of a spacing: in a layer of four spacings that is an eighth of the nodes.
const LOST: f64 = 0.25;

/// How far interfaces are looked for, over the distance of the farthest neighbour.
const REACH: f64 = 1.5;

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

/// Whether every node near an interface finds it: methods continue the field of a region to the nodes of another.
pub(super) fn check_interfaces<const D: usize>(
    cloud: &Cloud<D>,
    lists: &NeighborLists,
    labels: &[u16],
    band: &[u32],
    map: &RegionMap<D>,
) -> Result<(), MethodError> {
    let misses = |i: usize| {
        let x = &cloud.points()[i];
        let farthest = lists
            .of(i)
            .iter()
            .map(|&j| (0..D).map(|k| (cloud.points()[j as usize][k] - x[k]).powi(2)).sum::<f64>());
        let reach = REACH * farthest.fold(0.0, f64::max).sqrt();
        let mut beyond: Vec<u16> = lists.of(i).iter().map(|&j| labels[j as usize]).collect();
        beyond.sort_unstable();
        beyond.dedup();
        let meets = |a: u16, b: u16| a != b && map.project(a, b, x, reach).is_ok();
        // The interface with a region in between will do.
        beyond
            .iter()
            .find(|&&own| {
                own != labels[i] && !meets(own, labels[i]) && !beyond.iter().any(|&b| meets(own, b))
            })
            .map(|&own| (own, i))
    };
    let missed = parallel::map(band.len(), |k| misses(band[k] as usize));
    missed.into_iter().flatten().next().map_or(Ok(()), |(region, node)| Err(lost(cloud, region, node)))
}

fn lost<const D: usize>(cloud: &Cloud<D>, region: u16, node: usize) -> MethodError {
    MethodError::LostRegion { region, position: cloud.points()[node].to_vec() }
}
