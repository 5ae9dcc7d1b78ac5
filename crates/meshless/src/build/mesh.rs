//! Meshes and particles of scenes in free space.

use meshless_freespace::{Centring, Mesh};

use crate::Error;
use crate::scene::{ParticlesSpec, Scene, ShapeSpec};

/// Longest file of particles, in bytes: room for ten million of them.
const MAX_BYTES: u64 = 1 << 29;

/// Cells in each direction: as many as the spacing asks for.
pub(crate) fn mesh_cells(scene: &Scene) -> Result<Vec<usize>, Error> {
    let Some(spacing) = scene.points.spacing.expr.as_constant() else {
        let help = "give a number; the mesh of free space is regular";
        return Err(scene
            .error_at(&scene.points.spacing, "in free space the spacing is one number", help)
            .into());
    };
    let ShapeSpec::Box(bounds) = &scene.domain.shape else { return Ok(Vec::new()) };
    let sides = bounds.min.iter().zip(&bounds.max).map(|(low, high)| high - low);
    // A spacing that is to divide a side may do so up to round-off only.
    Ok(sides.map(|side| ((side / spacing * (1.0 - 1e-9)).ceil() as usize).max(1)).collect())
}

/// The mesh with so many times the cells.
pub(crate) fn free_mesh<const D: usize>(scene: &Scene, times: usize) -> Result<Mesh<D>, Error> {
    let cells = mesh_cells(scene)?;
    let (mut min, mut max) = ([0.0; D], [0.0; D]);
    if let ShapeSpec::Box(bounds) = &scene.domain.shape {
        (min, max) = (std::array::from_fn(|a| bounds.min[a]), std::array::from_fn(|a| bounds.max[a]));
    }
    Ok(Mesh::of_box(min, max, std::array::from_fn(|a| cells[a] * times), Centring::Cell)?)
}

/// Positions and strengths from a file.
pub(crate) fn particles<const D: usize>(spec: &ParticlesSpec) -> Result<(Vec<[f64; D]>, Vec<f64>), Error> {
    let (path, text) = spec.place.read_text_beside(&spec.file, MAX_BYTES)?;
    let wrong = |message: String, help: &str| Error::from(spec.place.error(message, help));
    let (mut positions, mut strengths) = (Vec::new(), Vec::new());
    let mut first = true;
    for (number, line) in text.lines().enumerate() {
        let line = line.trim();
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        let values: Result<Vec<f64>, _> = line.split(',').map(|cell| cell.trim().parse::<f64>()).collect();
        match values {
            Ok(values) if values.len() == D + 1 && values.iter().all(|v| v.is_finite()) => {
                positions.push(std::array::from_fn(|a| values[a]));
                strengths.push(values[D]);
            }
            // A first line of names.
            Err(_) if first => {}
            _ => {
                let message =
                    format!("{}, line {}: expected {} finite numbers", path.display(), number + 1, D + 1);
                return Err(wrong(message, "each line has the coordinates and the strength of a particle"));
            }
        }
        first = false;
    }
    Ok((positions, strengths))
}
