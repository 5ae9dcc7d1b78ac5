//! The field as a picture.

use meshless_output::{FieldPicture, Probe, Profile};

use super::Source;
use crate::Error;
use crate::execute::Picture;
use crate::scene::Scene;

/// Size of pictures in pixels.
const SIZE: (u32, u32) = (640, 400);

/// Most samples along the longer side of a contour picture.
const SAMPLES: usize = 220;

/// Bands of colour.
const CONTOURS: usize = 14;

/// The picture of a field, which has a name.
pub(super) fn draw<const D: usize>(
    scene: &Scene,
    source: &Source<D>,
    (name, u): (&str, &Vec<f64>),
) -> Result<Picture, Error> {
    let svg = if D == 1 {
        let profile = Profile {
            title: scene.title.clone(),
            x_label: "x".to_owned(),
            u_label: name.to_owned(),
            regions: vec![(String::new(), source.points.iter().zip(u).map(|(p, u)| (p[0], *u)).collect())],
            exact: Vec::new(),
        };
        profile.to_svg(SIZE.0, SIZE.1)?
    } else {
        plane(scene, source, name, u).to_svg(SIZE.0)?
    };
    Ok(Picture { svg })
}

/// The plane, or the middle one.
fn plane<const D: usize>(scene: &Scene, source: &Source<D>, name: &str, u: &[f64]) -> FieldPicture {
    let (mesh, points) = (&source.mesh, source.mesh.points());
    let step = points[0].max(points[1]).div_ceil(SAMPLES);
    let samples = [points[0].div_ceil(step), points[1].div_ceil(step)];
    let middle = |a: usize| points[a] / 2;
    let at = |i: usize, j: usize| {
        mesh.index(std::array::from_fn(|a| [i * step, j * step, middle(a.min(D - 1))][a]))
    };
    let values = (0..samples[0] * samples[1]).map(|k| u[at(k % samples[0], k / samples[0])]).collect();
    let last = |a: usize| mesh.coordinate(a, (samples[a] - 1) * step);
    let mut title = scene.title.clone();
    if name != "u" {
        title += &format!(": {name}");
    }
    if D == 3 {
        title += &format!(" (z = {:.3})", mesh.coordinate(2, middle(2)));
    }
    let min = [mesh.coordinate(0, 0), mesh.coordinate(1, 0)];
    let mut picture = FieldPicture::new(&title, min, [last(0), last(1)], samples[0], samples[1], values);
    picture.contours = CONTOURS;
    if D == 2 {
        picture.probes =
            scene.probes.iter().map(|p| Probe { name: String::new(), at: [p[0], p[1]] }).collect();
    }
    picture
}
