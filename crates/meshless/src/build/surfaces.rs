//! Surfaces of triangles, read from their files.

use std::sync::Arc;

use meshless_geometry::{GeometryError, MAX_STL_TRIANGLES, TriangleSurface, read_stl};

use crate::Error;
use crate::scene::{Scene, ShapeSpec, SurfaceSpec};

/// Longest file that is read: an ASCII file has about 250 bytes a triangle.
const MAX_BYTES: u64 = 300 * MAX_STL_TRIANGLES as u64;

/// The surface of a file, which is read once for a scene and its copies.
pub(super) fn surface(spec: &SurfaceSpec) -> Result<Arc<TriangleSurface>, Error> {
    if let Some(known) = spec.loaded.get() {
        return Ok(known.clone());
    }
    let (path, bytes) = spec.place.read_beside(&spec.file, MAX_BYTES)?;
    let invalid = |e: GeometryError| spec.place.error(format!("{}: {e}", path.display()), "");
    let triangles = read_stl(&bytes).map_err(invalid)?;
    let surface = TriangleSurface::new(&triangles, &spec.params).map_err(invalid)?;
    Ok(spec.loaded.get_or_init(|| Arc::new(surface)).clone())
}

/// Whether regions have surfaces of triangles with edges.
pub(crate) fn has_creased_regions(scene: &Scene) -> Result<bool, Error> {
    let shapes = scene.regions.iter().filter_map(|region| region.geometry.as_ref()).collect();
    for spec in surfaces_of(shapes) {
        if surface(spec)?.has_creases() {
            return Ok(true);
        }
    }
    Ok(false)
}

/// The surfaces of triangles that shapes are made of.
fn surfaces_of(mut waiting: Vec<&ShapeSpec>) -> Vec<&SurfaceSpec> {
    let mut found = Vec::new();
    while let Some(shape) = waiting.pop() {
        match shape {
            ShapeSpec::Surface(spec) => found.push(spec),
            ShapeSpec::Union(parts) | ShapeSpec::Intersection(parts) | ShapeSpec::Difference(parts) => {
                waiting.extend(parts);
            }
            _ => {}
        }
    }
    found
}

/// Triangles of all surfaces of a scene, and how many had no extent and were left out.
pub(crate) fn triangle_counts(scene: &Scene) -> Result<[usize; 2], Error> {
    let mut waiting: Vec<&ShapeSpec> = vec![&scene.domain.shape];
    waiting.extend(scene.holes.iter().map(|hole| &hole.shape));
    waiting.extend(scene.regions.iter().filter_map(|region| region.geometry.as_ref()));
    let mut counts = [0, 0];
    for spec in surfaces_of(waiting) {
        let surface = surface(spec)?;
        counts[0] += surface.triangles().len();
        counts[1] += surface.degenerate();
    }
    Ok(counts)
}
