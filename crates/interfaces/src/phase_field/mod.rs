//! Interfaces of a cloud whose nodes are labelled, by a phase field on the nodes.
//!
//! Fiétier et al., section 4.2: the field psi of a region starts as +1 at its nodes and -1 elsewhere and follows
//! `dpsi/dt = lap psi + psi (1 - psi^2) / w^2 - |grad psi| div(grad psi / |grad psi|)` (4.10) to the profile
//! `psi = -tanh(D / (sqrt 2 w))` (4.11), with D the distance from the region's surface, negative inside. The second and
//! the last term together are the second derivative along the normal, so that is what is computed.
//!
//! From the nodal distances [`regions_from_labels`] makes a [`RegionMap`] that any method can work with: a cloud that
//! knows the region of every node and no geometry, as from an image or a scan, is solved through it.

mod averages;
mod derivatives;
mod evolve;
mod kept;
mod surface;

use std::sync::Arc;

use meshless_geometry::{Cloud, RegionMap, Shape};
use meshless_neighbors::NeighborLists;

use crate::MethodError;
use averages::{AveragedRegion, Averages};
use derivatives::Derivatives;
use evolve::evolve;
use kept::{check_interfaces, check_kept};
use surface::{Blend, RegionSurface};

/// Standard deviation of the place of an interface of which labels alone are known, in units of the spacing: anywhere
/// between two nodes, `1/sqrt(12)`.
const LABELS_KNOW: f64 = 0.288_675_134_594_812_9;

/// Choices of the phase field.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PhaseFieldParams {
    /// The width w of (4.10) in units of the spacing.
    pub width: f64,
    /// Largest mean drift of an interface, in units of the spacing: the run stops before it. By default half of the
    /// standard deviation that labels leave open, so that the drift adds an eighth to the error.
    pub drift: f64,
    /// Most time steps.
    pub max_steps: usize,
}

impl Default for PhaseFieldParams {
    fn default() -> Self {
        Self { width: 2.0, drift: LABELS_KNOW / 2.0, max_steps: 400 }
    }
}

/// How a phase field came to rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PhaseFieldInfo {
    /// Time steps.
    pub steps: usize,
    /// How far the interface has moved outwards, in units of the spacing: the growth of the region's volume since the
    /// step function, over its surface.
    pub drift: f64,
    /// Mean of `|sqrt 2 w |grad psi| / (1 - psi^2) - 1|` near the interface: how far from the profile (4.11) it is.
    pub defect: f64,
    /// Why it stopped.
    pub stop: PhaseFieldStop,
}

/// Why a phase field stopped.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PhaseFieldStop {
    /// The profile no longer gets better.
    Settled,
    /// The interface has begun to drift.
    Drift,
    /// All steps are done.
    Steps,
    /// A layer was too thin for its field: the regions are where Gaussian averages of their labels outweigh the others.
    Averaged,
}

/// The regions of a cloud from the labels of its nodes alone, with how each region's field came to rest.
///
/// `lists` are supports for DC-PSE operators of second order (about 6, 26, 57 neighbours in 1-, 2-, 3-D); `regions` is
/// the number of regions, each of which must have nodes. The last region is the background.
///
/// Where a layer is too thin for the fields, all regions are where Gaussian averages of their labels, of a standard
/// deviation of 0.8 spacings, outweigh those of the others ([`PhaseFieldStop::Averaged`]).
///
/// # Errors
/// [`MethodError::InvalidProblem`] for labels that do not fit, [`MethodError::Stencil`] where nodes near an interface
/// have too few neighbours for second derivatives, and
/// [`MethodError::LostRegion`] where a region is so thin that its nodes have come to lie in another one.
pub fn regions_from_labels<const D: usize>(
    cloud: &Cloud<D>,
    lists: &NeighborLists,
    labels: &[u16],
    regions: usize,
    params: &PhaseFieldParams,
) -> Result<(RegionMap<D>, Vec<PhaseFieldInfo>), MethodError> {
    let invalid = |what: String| Err(MethodError::InvalidProblem { what });
    if labels.len() != cloud.len() || lists.len() != cloud.len() {
        return invalid(format!(
            "{} labels and {} lists for {} nodes",
            labels.len(),
            lists.len(),
            cloud.len()
        ));
    }
    if let Some(region) = (0..regions).find(|&r| !labels.contains(&(r as u16))) {
        return invalid(format!("region {region} has no nodes, so that its interface is nowhere"));
    }
    if let Some(label) = labels.iter().find(|&&l| usize::from(l) >= regions) {
        return invalid(format!("the label {label} of {regions} regions"));
    }
    if regions == 1 {
        return Ok((RegionMap::new(vec![None])?, Vec::new()));
    }
    let derivatives = Derivatives::new(cloud, lists, labels, params.width)?;
    let (mut fields, mut infos) = (Vec::with_capacity(regions), Vec::with_capacity(regions));
    for region in 0..regions as u16 {
        let (distance, info) = evolve(cloud, &derivatives, labels, region, params);
        fields.push(derivatives.expand(&distance));
        infos.push(info);
    }
    let blend = Arc::new(Blend::new(cloud, fields));
    let shapes = (0..regions)
        .map(|region| {
            let surface = RegionSurface::new(Arc::clone(&blend), region);
            (region + 1 < regions).then(|| Shape::level_set(Arc::new(surface)))
        })
        .collect();
    let map = RegionMap::new(shapes)?;
    let band = derivatives.band();
    let checked = |map: &RegionMap<D>| {
        check_kept(cloud, lists, labels, band, map)?;
        check_interfaces(cloud, lists, labels, band, map)
    };
    if checked(&map).is_ok() {
        return Ok((map, infos));
    }
    let map = averaged(cloud, labels, regions)?;
    checked(&map)?;
    infos.iter_mut().for_each(|info| info.stop = PhaseFieldStop::Averaged);
    Ok((map, infos))
}

/// The regions by averages of their labels.
fn averaged<const D: usize>(
    cloud: &Cloud<D>,
    labels: &[u16],
    regions: usize,
) -> Result<RegionMap<D>, MethodError> {
    let averages = Arc::new(Averages::new(cloud, labels, regions));
    let shape = |region| {
        let surface = AveragedRegion::new(Arc::clone(&averages), region);
        (region + 1 < regions).then(|| Shape::level_set(Arc::new(surface)))
    };
    Ok(RegionMap::new((0..regions).map(shape).collect())?)
}
