//! The solution as a picture: a profile in 1-D, contours in 2-D, contours on the middle plane in 3-D.

use meshless_interfaces::{Sample, Sampler};
use meshless_output::{FieldPicture, Probe, Profile};
use rayon::prelude::*;

use super::Solved;
use crate::Error;
use crate::plan::Plan;
use crate::scene::Scene;

/// Width of a picture in pixels.
const WIDTH: u32 = 640;

/// Height of a profile in pixels.
const PROFILE_HEIGHT: u32 = 400;

/// Samples along the longer side of a contour picture.
const SAMPLES: usize = 220;

/// Bands of colour.
const CONTOURS: usize = 14;

/// Nodes up to which they are shown.
const MAX_SHOWN_NODES: usize = 2500;

/// A drawing of the solution.
#[derive(Debug, Clone)]
pub struct Picture {
    /// The drawing as SVG.
    pub svg: String,
}

pub(super) fn draw<const D: usize>(scene: &Scene, plan: &Plan, solved: &Solved<D>) -> Result<Picture, Error> {
    let svg = if D == 1 {
        profile(scene, solved)?.to_svg(WIDTH, PROFILE_HEIGHT)?
    } else {
        plane(scene, plan, solved)?.to_svg(WIDTH)?
    };
    Ok(Picture { svg })
}

fn profile<const D: usize>(scene: &Scene, solved: &Solved<D>) -> Result<Profile, Error> {
    let points = solved.discrete.cloud.points();
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by(|&a, &b| points[a][0].total_cmp(&points[b][0]));
    let regions = scene
        .regions
        .iter()
        .enumerate()
        .map(|(label, region)| {
            let own = order.iter().filter(|&&i| solved.discrete.labels[i] as usize == label);
            (region.name.clone(), own.map(|&i| (points[i][0], solved.system.u[i])).collect())
        })
        .collect();
    let exact = if scene.regions.iter().all(|r| r.exact.is_some()) {
        let exact = solved.discrete.exact(scene)?;
        order.iter().map(|&i| (points[i][0], exact.values[i])).collect()
    } else {
        Vec::new()
    };
    Ok(Profile {
        title: scene.title.clone(),
        x_label: "x".to_owned(),
        u_label: "u".to_owned(),
        regions,
        exact,
    })
}

/// The solution between the nodes, by the fits of the method where it has its own.
fn between_nodes<const D: usize>(
    plan: &Plan,
    solved: &Solved<D>,
    places: &[[f64; D]],
) -> Result<Vec<Option<Sample<D>>>, Error> {
    let problem = solved.discrete.problem();
    let sampler = Sampler::new(&problem, &solved.system.u)?;
    let own = plan.method.params.build().samples(&problem, &solved.system, places)?;
    let own = own.unwrap_or_else(|| vec![None; places.len()]);
    // Where a method has no fit, that of the nodes of the region is better than a hole in the picture.
    let sample =
        |scratch: &mut _, (x, own): (&[f64; D], Option<Sample<D>>)| own.or_else(|| sampler.at(x, scratch));
    Ok(places.par_iter().zip(own).map_init(|| sampler.scratch(), sample).collect())
}

fn plane<const D: usize>(scene: &Scene, plan: &Plan, solved: &Solved<D>) -> Result<FieldPicture, Error> {
    let problem = solved.discrete.problem();
    let bounds = problem.domain.bounds();
    let lengths = bounds.lengths();
    let (width, height) = (lengths[0], lengths[D - 1 - usize::from(D == 3)]);
    let longer = width.max(height);
    let samples = |length: f64| ((SAMPLES as f64 * length / longer) as usize).max(8);
    let (nx, ny) = (samples(width), samples(height));
    let middle = bounds.center();
    let at = |index: usize| {
        let mut x = middle;
        x[0] = bounds.min[0] + width * (index % nx) as f64 / (nx - 1) as f64;
        x[1] = bounds.min[1] + height * (index / nx) as f64 / (ny - 1) as f64;
        x
    };
    // A little beyond the boundary, so that the outline of a curved domain can be cut from whole cells.
    let margin = 3.0 * longer / SAMPLES as f64;
    let (mut values, mut labels) = (vec![f64::NAN; nx * ny], vec![0; nx * ny]);
    let near: Vec<usize> =
        (0..nx * ny).into_par_iter().filter(|&k| problem.domain.level(&at(k)) <= margin).collect();
    let places: Vec<[f64; D]> = near.iter().map(|&k| at(k)).collect();
    for (&k, sample) in near.iter().zip(between_nodes(plan, solved, &places)?) {
        if let Some(sample) = sample {
            (values[k], labels[k]) = (sample.value, sample.region);
        }
    }
    let levels = |level: &(dyn Fn(&[f64; D]) -> f64 + Sync)| {
        (0..nx * ny).into_par_iter().map(|k| level(&at(k))).collect()
    };
    let title = match D {
        3 => format!("{} (z = {:.3})", scene.title, middle[D - 1]),
        _ => scene.title.clone(),
    };
    let min = [bounds.min[0], bounds.min[1]];
    let max = [bounds.max[0], bounds.max[1]];
    let mut picture = FieldPicture::new(&title, min, max, nx, ny, values);
    picture.contours = CONTOURS;
    if scene.regions.len() > 1 {
        picture.labels = Some(labels);
        picture.interfaces = (0..scene.regions.len() as u16 - 1)
            .filter_map(|label| problem.regions.shape(label))
            .map(|shape| levels(&|x| shape.level(x)))
            .collect();
    }
    let planar = |v: &[f64; D]| [v[0], v[1]];
    picture.cuts = problem.slits.iter().map(|s| s.slit.vertices().iter().map(planar).collect()).collect();
    if crate::build::is_curved(scene) {
        picture.mask = Some(levels(&|x| problem.domain.level(x)));
    }
    if D == 2 && problem.cloud.len() <= MAX_SHOWN_NODES {
        picture.nodes = problem.cloud.points().iter().map(|x| [x[0], x[1]]).collect();
        picture.probes =
            scene.probes.iter().map(|p| Probe { name: String::new(), at: [p[0], p[1]] }).collect();
    }
    Ok(picture)
}
