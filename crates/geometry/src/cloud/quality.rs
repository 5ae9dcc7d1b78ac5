use rayon::prelude::*;

use super::Cloud;
use crate::aabb::Aabb;
use crate::domain::Domain;
use crate::quasi_random::Kronecker;
use crate::spatial_hash::SpatialHash;

/// Sample points around every node for the fill distance.
const FILL_SAMPLES: usize = 8;

/// How evenly a cloud fills its domain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CloudQuality {
    /// The smallest distance between two nodes (not its half).
    pub separation: f64,
    /// The largest distance from a point of the domain to its nearest node.
    pub fill_distance: f64,
    /// `2 fill_distance / separation`: at least 1, and `sqrt(D)` for square grids.
    pub mesh_ratio: f64,
    /// The smallest distance between two nodes over the smaller of their spacings.
    pub relative_separation: f64,
    /// The largest distance to the nearest node over that node's spacing.
    pub relative_fill: f64,
}

/// Measures a cloud. Distances between nodes are exact. The fill distance is that of quasi-random points of the domain,
/// eight in the cube of half-width one spacing about each node and eight a node in the whole domain: a lower bound,
/// good to a few per cent.
///
/// For clouds of fewer than two nodes everything is infinite.
pub fn quality<const D: usize>(cloud: &Cloud<D>, domain: &Domain<D>) -> CloudQuality {
    let mut hash = SpatialHash::new();
    for (x, &h) in cloud.points().iter().zip(cloud.spacing()) {
        hash.insert(*x, h);
    }
    if cloud.len() < 2 {
        let none = f64::INFINITY;
        return CloudQuality {
            separation: none,
            fill_distance: none,
            mesh_ratio: none,
            relative_separation: none,
            relative_fill: none,
        };
    }
    let nearest = |x: &[f64; D], h: f64, except: Option<u32>| {
        let limit = 2.0 * domain.bounds().diameter() + h;
        let mut reach = 1.5 * h;
        loop {
            if let Some(found) = hash.nearest(x, reach, except) {
                return found;
            }
            if reach > limit {
                return (0, f64::INFINITY);
            }
            reach *= 2.0;
        }
    };
    let spacing = cloud.spacing();
    let smaller = |a: (f64, f64), b: (f64, f64)| (a.0.min(b.0), a.1.min(b.1));
    let larger = |a: (f64, f64), b: (f64, f64)| (a.0.max(b.0), a.1.max(b.1));
    let (separation, relative_separation) = (0..cloud.len())
        .into_par_iter()
        .map(|i| {
            let (j, d) = nearest(&cloud.points()[i], spacing[i], Some(i as u32));
            (d, d / spacing[i].min(spacing[j as usize]))
        })
        .reduce(|| (f64::INFINITY, f64::INFINITY), smaller);
    let fill_at = |x: &[f64; D], h: f64| {
        if domain.level(x) > 0.0 {
            return (0.0, 0.0);
        }
        let (j, d) = nearest(x, h, None);
        (d, d / spacing[j as usize])
    };
    let around = (0..cloud.len())
        .into_par_iter()
        .map(|i| {
            let (x, h) = (cloud.points()[i], spacing[i]);
            let cube = Aabb { min: x.map(|v| v - h), max: x.map(|v| v + h) };
            // Other samples about every node: the sequence starts where that of the node before ends.
            let samples = Kronecker::new(&cube).starting_at(i * FILL_SAMPLES).take(FILL_SAMPLES);
            samples.map(|y| fill_at(&y, h)).fold((0.0, 0.0), larger)
        })
        .reduce(|| (0.0, 0.0), larger);
    let mean = spacing.iter().sum::<f64>() / spacing.len() as f64;
    let everywhere = Kronecker::new(&domain.bounds())
        .take(FILL_SAMPLES * cloud.len())
        .map(|y| fill_at(&y, mean))
        .fold((0.0, 0.0), larger);
    let (fill_distance, relative_fill) = larger(around, everywhere);
    let mesh_ratio = 2.0 * fill_distance / separation;
    CloudQuality { separation, fill_distance, mesh_ratio, relative_separation, relative_fill }
}
