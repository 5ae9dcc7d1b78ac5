//! How thick the layer round a node is, and the spacing of nodes that would resolve it.

use crate::Problem;
use crate::thin_layers::RESOLVED;

/// How far it is looked for the end of a layer, in units of the spacing, and in which steps.
const REACH: f64 = 2.0;
const STEP: f64 = 0.02;

/// The spacing that resolves what node i lies in; half of its own where that is no thin layer.
pub(super) fn resolving_spacing<const D: usize>(problem: &Problem<'_, D>, i: usize) -> f64 {
    let spacing = problem.cloud.spacing()[i];
    let chords = (1..3_usize.pow(D as u32)).map(|code| {
        let direction = direction::<D>(code);
        let (ahead, behind) = (way(problem, i, &direction), way(problem, i, &direction.map(|d| -d)));
        ahead + behind
    });
    let thickness = chords.fold(f64::INFINITY, f64::min);
    (0.5 * spacing).min(thickness / RESOLVED)
}

/// Unit vectors along axes and diagonals, by the digits of `code` to the base 3.
fn direction<const D: usize>(code: usize) -> [f64; D] {
    let digits: [f64; D] = std::array::from_fn(|k| ((code / 3_usize.pow(k as u32)) % 3) as f64);
    let signs = digits.map(|digit| if digit == 2.0 { -1.0 } else { digit });
    let length = signs.iter().map(|s| s * s).sum::<f64>().sqrt();
    signs.map(|s| s / length)
}

/// How far it is from node i along a direction to the end of its region or of the domain.
fn way<const D: usize>(problem: &Problem<'_, D>, i: usize, direction: &[f64; D]) -> f64 {
    let (x, spacing) = (&problem.cloud.points()[i], problem.cloud.spacing()[i]);
    let tolerance = 0.1 * STEP * spacing;
    let steps = (REACH / STEP) as usize;
    let ends = |step: &usize| {
        let at = std::array::from_fn(|k| x[k] + *step as f64 * STEP * spacing * direction[k]);
        !problem.domain.contains(&at, tolerance) || problem.regions.label(&at, spacing) != problem.labels[i]
    };
    (1..=steps).find(ends).unwrap_or(steps) as f64 * STEP * spacing
}

#[cfg(test)]
mod tests {
    use super::direction;

    #[test]
    fn directions_are_unit_vectors_of_which_every_opposite_is_one() {
        let all: Vec<[f64; 3]> = (1..27).map(direction).collect();
        for d in &all {
            assert!((d.iter().map(|x| x * x).sum::<f64>() - 1.0).abs() < 1e-15);
            assert!(all.contains(&d.map(|x| -x + 0.0)));
        }
    }
}
