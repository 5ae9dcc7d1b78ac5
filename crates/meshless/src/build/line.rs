//! A line through a domain, in cells: what heat meets on its way, known without a cloud.

use meshless_geometry::{Domain, FaceId, RegionMap};
use meshless_interfaces::{BoundaryData, Condition};

use super::conditions::Boundary;
use super::fields::{field, materials};
use super::points::file_points;
use super::shapes::{domain, regions};
use crate::Error;
use crate::scene::Scene;

/// Points along each axis among which the deepest is looked for.
const SAMPLES_PER_AXIS: [usize; 3] = [257, 65, 17];

/// Parts of the extent of the domain in which the ends of a line are looked for.
const PARTS: usize = 1024;

/// Cells in a row along one axis, through the point that is deepest in the domain.
pub(crate) struct Line<const D: usize> {
    domain: Domain<D>,
    /// Width of a cell.
    pub(crate) width: f64,
    centres: Vec<[f64; D]>,
    /// Region of every cell.
    labels: Vec<u16>,
    /// Where the line leaves the domain, and through which face.
    ends: [([f64; D], FaceId); 2],
}

/// What a scene says along a line, at one time.
pub(crate) struct LineData {
    /// Diffusivity of every cell.
    pub(crate) diffusivity: Vec<f64>,
    /// Source in every cell.
    pub(crate) source: Vec<f64>,
    /// Conditions at the ends; `None` where the scene has none.
    pub(crate) ends: [Option<Condition>; 2],
}

/// The lines along all axes, in so many cells each.
pub(crate) fn lines<const D: usize>(scene: &Scene, cells: usize) -> Result<Vec<Line<D>>, Error> {
    let domain = domain::<D>(scene)?;
    let deepest = deepest(&domain);
    let labels = Labels::new(scene)?;
    Ok((0..D).filter_map(|axis| Line::new(&domain, &labels, &deepest, axis, cells)).collect())
}

fn deepest<const D: usize>(domain: &Domain<D>) -> [f64; D] {
    let (bounds, count) = (domain.bounds(), SAMPLES_PER_AXIS[D - 1]);
    let at = |index: usize| -> [f64; D] {
        std::array::from_fn(|k| {
            let along = ((index / count.pow(k as u32)) % count) as f64 + 0.5;
            bounds.min[k] + bounds.lengths()[k] * along / count as f64
        })
    };
    let levels = (0..count.pow(D as u32)).map(|index| (domain.level(&at(index)), at(index)));
    levels.fold((f64::INFINITY, at(0)), |best, next| if next.0 < best.0 { next } else { best }).1
}

/// What tells the region of a point.
enum Labels<const D: usize> {
    Shapes(RegionMap<D>),
    /// The nearest point of a file.
    Points(Vec<[f64; D]>, Vec<u16>),
}

impl<const D: usize> Labels<D> {
    fn new(scene: &Scene) -> Result<Self, Error> {
        match (&scene.points.file, scene.is_labelled()) {
            (Some(file), true) => {
                let given = file_points::<D>(scene, file)?;
                Ok(Self::Points(given.points, given.labels.unwrap_or_default()))
            }
            _ => Ok(Self::Shapes(regions(scene)?)),
        }
    }

    fn at(&self, x: &[f64; D]) -> u16 {
        let distance = |p: &[f64; D]| (0..D).map(|k| (p[k] - x[k]).powi(2)).sum::<f64>();
        match self {
            Self::Shapes(regions) => regions.label(x, 0.0),
            Self::Points(points, labels) => {
                let nearest = points
                    .iter()
                    .zip(labels)
                    .map(|(p, &label)| (distance(p), label))
                    .min_by(|a, b| a.0.total_cmp(&b.0));
                nearest.map_or(0, |(_, label)| label)
            }
        }
    }
}

impl<const D: usize> Line<D> {
    fn new(
        domain: &Domain<D>,
        labels: &Labels<D>,
        through: &[f64; D],
        axis: usize,
        cells: usize,
    ) -> Option<Self> {
        let part = domain.bounds().lengths()[axis] / PARTS as f64;
        let moved = |by: f64| -> [f64; D] {
            std::array::from_fn(|k| if k == axis { through[k] + by } else { through[k] })
        };
        let reach = |sign: f64| -> f64 {
            let inside = |parts: &usize| domain.level(&moved(sign * part * *parts as f64)) <= 0.0;
            sign * part * (1..=PARTS).take_while(inside).last().unwrap_or(0) as f64
        };
        let (from, to) = (reach(-1.0), reach(1.0));
        let width = (to - from) / cells as f64;
        if width <= 0.0 {
            return None;
        }
        let centres: Vec<[f64; D]> = (0..cells).map(|i| moved(from + width * (i as f64 + 0.5))).collect();
        let labels = centres.iter().map(|x| labels.at(x)).collect();
        let end = |by: f64| Some((moved(by), nearest_face(domain, &moved(by))?));
        Some(Self { domain: domain.clone(), width, centres, labels, ends: [end(from)?, end(to)?] })
    }

    /// The data along the line, of a scene that does not depend on `t`.
    pub(crate) fn data(&self, scene: &Scene) -> LineData {
        let (materials, boundary) = (materials::<D>(scene), Boundary::new(scene, &self.domain));
        let cells =
            || self.centres.iter().zip(&self.labels).map(|(x, &label)| (x, &materials[label as usize]));
        let at_end = |(x, face): &([f64; D], FaceId)| boundary.condition(*face, x);
        LineData {
            diffusivity: cells().map(|(x, material)| material.diffusivity.at(x)).collect(),
            source: cells().map(|(x, material)| material.source.as_ref().map_or(0.0, |f| f.at(x))).collect(),
            ends: [at_end(&self.ends[0]), at_end(&self.ends[1])],
        }
    }

    /// The initial values along the line.
    pub(crate) fn initial(&self, scene: &Scene) -> Vec<f64> {
        let given = scene.time.as_ref().and_then(|time| time.initial.as_ref());
        let given = given.map(|initial| field::<D>(&initial.expr));
        self.centres.iter().map(|x| given.as_ref().map_or(0.0, |f| f.at(x))).collect()
    }
}

/// The face whose surface is nearest to a point.
fn nearest_face<const D: usize>(domain: &Domain<D>, x: &[f64; D]) -> Option<FaceId> {
    let bounds = domain.bounds();
    let faces = (0..domain.faces().len()).filter_map(|i| u16::try_from(i).ok()).map(FaceId);
    let planes = faces.filter_map(|face| {
        let (axis, upper) = domain.box_plane(face)?;
        let plane = if upper { bounds.max[axis] } else { bounds.min[axis] };
        Some((face, (x[axis] - plane).abs()))
    });
    let curved = domain.curved_faces().into_iter().map(|(face, shape, _)| (face, shape.level(x).abs()));
    planes.chain(curved).min_by(|a, b| a.1.total_cmp(&b.1)).map(|(face, _)| face)
}
