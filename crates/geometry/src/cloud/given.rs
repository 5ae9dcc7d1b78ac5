//! Clouds round points that come from elsewhere, such as the pixels of an image or the points of a scan.

use super::{BoundaryNode, Cloud, Spacing};
use crate::boundary::{Sampler, sample};
use crate::domain::Domain;
use crate::error::GeometryError;
use crate::random::Random;
use crate::spatial_hash::SpatialHash;

/// Points nearer to the boundary than this times the spacing are left out: the nodes on it stand for them. The pixels of
/// an image, half a spacing from its edges, are not.
const CLEARANCE: f64 = 0.3;

/// Largest distance of a boundary node from the nearest point, in spacings.
const REACH: f64 = 2.0;

/// Smallest distance of points that are kept for a coarser cloud, over the coarser spacing: a lattice then becomes one of
/// exactly that spacing.
const APART: f64 = 0.95;

/// What [`around`] is asked for.
#[derive(Clone, Debug)]
pub struct GivenParams<const D: usize> {
    /// Distance between neighbouring points; where it is not given the points are taken to be spread evenly, each with
    /// the same share of the domain.
    pub spacing: Option<Spacing<D>>,
    /// 1 keeps all points; more keeps about every `thin^D`-th, spread as evenly as the points themselves.
    pub thin: f64,
    /// More nodes than this are an error.
    pub max_nodes: usize,
}

/// A cloud round given points.
#[derive(Clone, Debug)]
pub struct GivenCloud<const D: usize> {
    /// The nodes: those on the boundary first, then the points in their order.
    pub cloud: Cloud<D>,
    /// For every node the index of the point that it is; for nodes on the boundary that of the nearest point.
    pub origin: Vec<u32>,
}

/// A cloud whose interior nodes are the given points and whose boundary nodes are placed on the faces of the domain, about
/// as far apart as the points are. Points on the boundary, or within 0.3 spacings of it, are left out.
///
/// # Errors
/// [`GeometryError::InvalidCloud`] where no point is left inside, or a part of the boundary has no points near it;
/// [`GeometryError::InvalidSpacing`], [`GeometryError::TooManyNodes`].
pub fn around<const D: usize>(
    domain: &Domain<D>,
    points: &[[f64; D]],
    params: &GivenParams<D>,
) -> Result<GivenCloud<D>, GeometryError> {
    let all: Vec<u32> = (0..points.len() as u32).collect();
    let own = own_spacing(domain, points, &all, params)?;
    let (kept, spacing) = if params.thin > 1.0 {
        let kept = thinned(domain, points, &own, params.thin)?;
        // How much coarser the points that are left really are.
        let factor = (all.len() as f64 / kept.len().max(1) as f64).powf(1.0 / D as f64);
        let spacing = match &own {
            Spacing::Uniform(h) => Spacing::Uniform(factor * h),
            Spacing::Graded(f) => {
                let f = std::sync::Arc::clone(f);
                Spacing::Graded(std::sync::Arc::new(move |x: &[f64; D]| factor * f(x)))
            }
        };
        (kept, spacing)
    } else {
        (all, own)
    };
    let mut sampler = Sampler::new(domain, &spacing, params.max_nodes);
    sample(&mut sampler, false, &mut Random::new(1))?;
    let boundary = sampler.nodes.len();
    let mut inside = SpatialHash::new();
    let mut origin = Vec::with_capacity(boundary + kept.len());
    for &i in &kept {
        let x = points[i as usize];
        let h = spacing.at(&x)?;
        inside.insert(x, h);
        if -domain.distance_estimate(&x) >= CLEARANCE * h {
            sampler.push(x, h)?;
            origin.push(i);
        }
    }
    if origin.is_empty() {
        return Err(GeometryError::cloud("none of the points lies inside of the domain"));
    }
    let near: Result<Vec<u32>, GeometryError> =
        (0..boundary).map(|b| nearest(&inside, &kept, &sampler, b)).collect();
    let origin = [near?, origin].concat();
    let touches = sampler.touches.into_iter().enumerate();
    let touching = touches.map(|(i, touches)| BoundaryNode { node: i as u32, touches }).collect();
    let cloud =
        Cloud::from_parts(sampler.nodes.points().to_vec(), touching, sampler.nodes.spacing().to_vec())?;
    Ok(GivenCloud { cloud, origin })
}

/// The index of the point that is nearest to boundary node `b`.
fn nearest<const D: usize>(
    inside: &SpatialHash<D>,
    kept: &[u32],
    sampler: &Sampler<'_, D>,
    b: usize,
) -> Result<u32, GeometryError> {
    let (x, h) = (sampler.nodes.points()[b], sampler.nodes.spacing()[b]);
    match inside.nearest(&x, REACH * h, None) {
        Some((found, _)) => Ok(kept[found as usize]),
        None => Err(GeometryError::cloud(format!(
            "no point lies within {REACH} spacings ({:.4e}) of the boundary at {x:?}: the points must fill the domain",
            REACH * h
        ))),
    }
}

/// The spacing of the points: as given, or that of an even cloud, in which a point inside stands for `h^D` and one on the
/// boundary for half of that.
fn own_spacing<const D: usize>(
    domain: &Domain<D>,
    points: &[[f64; D]],
    kept: &[u32],
    params: &GivenParams<D>,
) -> Result<Spacing<D>, GeometryError> {
    if let Some(spacing) = &params.spacing {
        return Ok(spacing.clone());
    }
    let measure = domain.measure_estimate();
    let even = |count: f64| (measure / count.max(1.0)).powf(1.0 / D as f64);
    // Who is near the boundary depends on the spacing, weakly.
    let h = (0..2).fold(even(kept.len() as f64), |h, _| {
        let near = |&&i: &&u32| -domain.distance_estimate(&points[i as usize]) < CLEARANCE * h;
        even(kept.len() as f64 - 0.5 * kept.iter().filter(near).count() as f64)
    });
    Ok(Spacing::Uniform(h))
}

/// Points in their order, each unless one that is kept is too near.
fn thinned<const D: usize>(
    domain: &Domain<D>,
    points: &[[f64; D]],
    own: &Spacing<D>,
    thin: f64,
) -> Result<Vec<u32>, GeometryError> {
    let mut hash = SpatialHash::new();
    let mut kept = Vec::new();
    for (i, x) in points.iter().enumerate() {
        let h = thin * own.at(x)?;
        let interior = -domain.distance_estimate(x) >= CLEARANCE * h;
        if interior && !hash.conflicts(x, h, APART) {
            hash.insert(*x, h);
            kept.push(i as u32);
        }
    }
    Ok(kept)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::Shape;

    const ALL: GivenParams<2> = GivenParams { spacing: None, thin: 1.0, max_nodes: 100_000 };

    /// The middles of n by n pixels of the unit square, or with its edges.
    fn raster(n: usize, edges: bool) -> Vec<[f64; 2]> {
        let at = |k: usize| if edges { k as f64 / (n - 1) as f64 } else { (k as f64 + 0.5) / n as f64 };
        (0..n * n).map(|k| [at(k % n), at(k / n)]).collect()
    }

    #[test]
    fn pixels_become_nodes_and_the_edges_get_nodes_of_their_own() {
        let domain = Domain::boxed([0.0, 0.0], [1.0, 1.0]).unwrap();
        let GivenCloud { cloud, origin } = around(&domain, &raster(20, false), &ALL).unwrap();
        assert!((cloud.spacing()[0] - 0.05).abs() < 1e-12);
        assert_eq!((cloud.len() - cloud.boundary().len(), cloud.boundary().len()), (400, 80));
        assert_eq!(cloud.boundary().iter().filter(|b| b.touches.len() == 2).count(), 4);
        for (i, &o) in origin.iter().enumerate() {
            let (x, y) = (cloud.points()[i], raster(20, false)[o as usize]);
            let distance = ((x[0] - y[0]).powi(2) + (x[1] - y[1]).powi(2)).sqrt();
            assert!(if cloud.is_boundary(i) { distance < 0.04 } else { distance == 0.0 }, "{x:?} {y:?}");
        }
    }

    #[test]
    fn points_on_the_boundary_are_replaced_and_a_disc_can_be_cut_out_of_a_raster() {
        let square = Domain::boxed([0.0, 0.0], [1.0, 1.0]).unwrap();
        let cloud = around(&square, &raster(21, true), &ALL).unwrap().cloud;
        assert_eq!((cloud.len(), cloud.boundary().len()), (441, 80));
        let disc = Domain::from_shape(Shape::ball([0.5, 0.5], 0.4).unwrap(), None).unwrap();
        let points: Vec<[f64; 2]> = raster(40, false).into_iter().filter(|x| disc.contains(x, 0.0)).collect();
        let cloud = around(&disc, &points, &ALL).unwrap().cloud;
        assert!((cloud.spacing()[0] / 0.025 - 1.0).abs() < 0.02, "{}", cloud.spacing()[0]);
        let expected = 0.8 * std::f64::consts::PI / 0.025;
        assert!((cloud.boundary().len() as f64 / expected - 1.0).abs() < 0.05);
    }

    #[test]
    fn thinning_a_raster_leaves_a_raster() {
        let domain = Domain::boxed([0.0, 0.0], [1.0, 1.0]).unwrap();
        let cloud = around(&domain, &raster(41, true), &GivenParams { thin: 2.0, ..ALL }).unwrap().cloud;
        let inside = cloud.len() - cloud.boundary().len();
        assert!((324..=400).contains(&inside), "{inside}");
        assert!((cloud.spacing()[0] / 0.05 - 1.0).abs() < 0.15, "{}", cloud.spacing()[0]);
    }

    #[test]
    fn points_that_leave_a_part_of_the_domain_empty_are_an_error() {
        let domain = Domain::boxed([0.0, 0.0], [1.0, 1.0]).unwrap();
        let half: Vec<[f64; 2]> = raster(20, false).into_iter().filter(|x| x[0] < 0.5).collect();
        let error = around(&domain, &half, &ALL).unwrap_err().to_string();
        assert!(error.contains("fill the domain"), "{error}");
        assert!(around(&domain, &[[0.0, 0.0]], &ALL).unwrap_err().to_string().contains("none of the points"));
    }
}
