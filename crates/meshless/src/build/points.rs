//! The cloud of a scene: generated, or round the points of a file.

use meshless_geometry::{
    Cloud, CloudParams, Domain, GapParams, GivenParams, RegionMap, Size, around, check_size, generate,
};
use meshless_interfaces::thin_layers;

use super::corners::{AtCorners, corner_spacings};
use super::features::feature_spacings;
use super::shapes::{explain_cloud, layout, regions, spacing};
use crate::scene::{Adapted, Features, FilePoints, GapSpec, PointsFileSpec, Scene, Wanted};
use crate::{Error, MAX_NODES};

/// How far outside of the domain a point may lie, relative to the domain's size: rounding in the file.
const OUTSIDE: f64 = 1e-6;

/// Nodes, and what tells their regions.
pub(crate) struct Placed<const D: usize> {
    pub(crate) cloud: Cloud<D>,
    /// The shapes of the regions; where the file tells the regions, there is one region only.
    pub(crate) regions: RegionMap<D>,
    /// The region of every node, where the file tells; a node on the boundary has that of the nearest point.
    pub(crate) labels: Option<Vec<u16>>,
}

/// The points of the file, where the scene has one.
pub(crate) fn file_points<const D: usize>(
    scene: &Scene,
    file: &PointsFileSpec,
) -> Result<FilePoints<D>, Error> {
    Ok(file.read::<D>(scene.is_labelled().then_some(&scene.regions))?)
}

/// What is asked of a cloud that is generated.
fn params<const D: usize>(scene: &Scene, method: AtCorners) -> Result<CloudParams<D>, Error> {
    let mut places = corner_spacings(scene, method)?;
    if scene.points.corners.is_some() {
        let adapted = &scene.points.adapted;
        let size = |wanted: &Wanted, times: f64| Size {
            at: std::array::from_fn(|k| wanted.at[k]),
            spacing: times * wanted.spacing,
            within: wanted.within,
        };
        places.extend(features(scene, method.order)?.iter().map(|wanted| size(wanted, adapted.times)));
        places.extend(adapted.wanted.iter().map(|wanted| size(wanted, adapted.wanted_times)));
    }
    Ok(CloudParams {
        spacing: spacing(scene).at_most(places),
        layout: layout(scene),
        seed: scene.points.seed,
        max_nodes: MAX_NODES,
    })
}

/// What the data of a scene ask for, which is told once.
fn features(scene: &Scene, order: usize) -> Result<Vec<Wanted>, Error> {
    let tolerance = scene.accuracy.as_ref().map(|spec| spec.tolerance);
    let make = || -> Result<Vec<Wanted>, Error> {
        match scene.dimension {
            1 => Ok(feature_spacings::<1>(scene, order)?.iter().map(wanted).collect()),
            2 => Ok(feature_spacings::<2>(scene, order)?.iter().map(wanted).collect()),
            _ => Ok(feature_spacings::<3>(scene, order)?.iter().map(wanted).collect()),
        }
    };
    let known = &scene.points.adapted.features;
    match known.get() {
        Some(known) if known.order == order && known.tolerance == tolerance => Ok(known.wanted.clone()),
        Some(_) => make(),
        None => {
            let made = make()?;
            Ok(known.get_or_init(|| Features { order, tolerance, wanted: made }).wanted.clone())
        }
    }
}

/// Whether the data of a scene vary so far below its spacing that its cloud is to be finer there, for a method of an order.
pub(crate) fn has_features(scene: &Scene, order: usize) -> Result<bool, Error> {
    let adapts = scene.points.corners.is_some() && scene.free_space.is_none();
    Ok(adapts && !features(scene, order)?.is_empty())
}

fn wanted<const D: usize>(size: &Size<D>) -> Wanted {
    let at = std::array::from_fn(|k| size.at.get(k).copied().unwrap_or_default());
    Wanted { at, spacing: size.spacing, within: size.within }
}

/// What is asked for in layers and gaps, if anything is.
fn gaps<const D: usize>(scene: &Scene, domain: &Domain<D>) -> Option<GapParams> {
    if let Some(GapSpec { least, across }) = scene.points.gaps {
        return Some(GapParams { across, least });
    }
    let Adapted { times, least_gap, .. } = scene.points.adapted;
    let least = least_gap * domain.bounds().diameter();
    scene.points.corners.map(|_| GapParams { across: thin_layers::RESOLVED / times, least: times * least })
}

/// About how many nodes the cloud of a scene will have.
pub(super) fn estimated<const D: usize>(
    scene: &Scene,
    method: AtCorners,
    domain: &Domain<D>,
) -> Result<f64, Error> {
    if let Some(file) = &scene.points.file {
        return Ok(file_points::<D>(scene, file)?.points.len() as f64);
    }
    let params = params(scene, method)?;
    let estimate = match gaps(scene, domain).filter(|_| !scene.is_labelled()) {
        Some(gaps) => regions(scene)?.foresee_nodes(domain, &params, &gaps),
        None => check_size(domain, &params.spacing, params.max_nodes),
    };
    estimate.map_err(|e| explain_cloud(scene, e))
}

/// The cloud and the regions of a scene.
pub(crate) fn place<const D: usize>(
    scene: &Scene,
    method: AtCorners,
    domain: &Domain<D>,
) -> Result<Placed<D>, Error> {
    let regions = if scene.is_labelled() { RegionMap::new(vec![None])? } else { regions(scene)? };
    let Some(file) = &scene.points.file else {
        let params = params(scene, method)?;
        let made = match gaps(scene, domain) {
            Some(gaps) => regions.generate(domain, &params, &gaps),
            None => generate(domain, &params),
        };
        let cloud = made.map_err(|e| explain_cloud(scene, e))?;
        return Ok(Placed { cloud, regions, labels: None });
    };
    let given = file_points::<D>(scene, file)?;
    let reach = OUTSIDE * domain.bounds().diameter();
    if let Some(i) = given.points.iter().position(|x| !domain.contains(x, reach)) {
        let message = format!("the point {:?} lies outside of the domain", given.points[i]);
        return Err(given.error(i, message, "remove it, or enlarge the domain").into());
    }
    let params =
        GivenParams { spacing: file.spaced.then(|| spacing(scene)), thin: file.thin, max_nodes: MAX_NODES };
    let made = around(domain, &given.points, &params)
        .map_err(|e| file.place.error(e.to_string(), "a `spacing` says how far apart the points are"))?;
    let labels = given.labels.map(|all| made.origin.iter().map(|&o| all[o as usize]).collect());
    Ok(Placed { cloud: made.cloud, regions, labels })
}
