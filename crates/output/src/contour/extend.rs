//! Values one grid node beyond where they are known.

/// Continues `values`, which are not numbers where unknown, to the eight neighbours of known nodes: by linear
/// extrapolation along the grid and its diagonals where two nodes in a row are known, else by the neighbours' mean.
pub(super) fn extend(values: &[f64], nx: usize, ny: usize) -> Vec<f64> {
    let known = |i: isize, j: isize| -> Option<f64> {
        let inside = (0..nx as isize).contains(&i) && (0..ny as isize).contains(&j);
        if inside { Some(values[j as usize * nx + i as usize]).filter(|v| !v.is_nan()) } else { None }
    };
    let continued = |i: isize, j: isize| -> f64 {
        let (mut linear, mut constant) = ((0.0, 0_u32), (0.0, 0_u32));
        for (di, dj) in [(-1, -1), (0, -1), (1, -1), (-1, 0), (1, 0), (-1, 1), (0, 1), (1, 1)] {
            if let Some(near) = known(i + di, j + dj) {
                constant = (constant.0 + near, constant.1 + 1);
                if let Some(far) = known(i + 2 * di, j + 2 * dj) {
                    linear = (linear.0 + 2.0 * near - far, linear.1 + 1);
                }
            }
        }
        let (sum, count) = if linear.1 > 0 { linear } else { constant };
        // No neighbour at all gives 0/0, which is what "unknown" is.
        sum / f64::from(count)
    };
    (0..nx * ny)
        .map(|k| if values[k].is_nan() { continued((k % nx) as isize, (k / nx) as isize) } else { values[k] })
        .collect()
}
