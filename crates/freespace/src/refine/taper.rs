//! How the source of a patch ends.
//!
//! Where the band of a patch cuts through the source, the source that is transformed has a step and with it all wave numbers.
//! The kernel falls off fast enough, but its derivative in Fourier space does not: the Nyquist frequency has none, so that the
//! transform of the derivative has a step there (2e-5 of `1/k` at order 10, sigma = 2h), whose tail in real space falls like
//! `1/x` and reaches the patch. Smoothed by `[1/2, 1/2]` applied `TAPER` times, the step of the source has a zero of that
//! order at the Nyquist frequency, and the tail falls like `x^-(TAPER + 1)`.

use crate::error::FreeSpaceError;
use crate::mesh::Mesh;

/// Cells beyond the reach of the kernel over which the source of a patch falls to zero.
pub(super) const TAPER: usize = 6;

/// The source with its outermost cells weighed down.
pub(super) fn taper<const D: usize>(mesh: &Mesh<D>, source: &[f64]) -> Result<Vec<f64>, FreeSpaceError> {
    crate::plan::check_values("source", source, mesh.len())?;
    let weights: [Vec<f64>; D] = mesh.points().map(along);
    let mut tapered = source.to_vec();
    for (row, values) in tapered.chunks_exact_mut(mesh.points()[0]).enumerate() {
        let i = mesh.indices(row * mesh.points()[0]);
        let across: f64 = (1..D).map(|a| weights[a][i[a]]).product();
        values.iter_mut().zip(&weights[0]).for_each(|(value, weight)| *value *= across * weight);
    }
    Ok(tapered)
}

/// Weights of `n` points: sums of binomial coefficients at both ends.
fn along(n: usize) -> Vec<f64> {
    let mut weights = vec![1.0; n];
    let (mut binomial, mut sum) = (1.0, 0.0);
    for i in 0..TAPER.min(n / 2) {
        sum += binomial / f64::from(1 << TAPER);
        binomial *= (TAPER - i) as f64 / (i + 1) as f64;
        weights[i] = sum;
        weights[n - 1 - i] = sum;
    }
    weights
}

#[cfg(test)]
mod tests {
    use super::{TAPER, along};

    #[test]
    fn the_highest_frequency_is_taken_out_of_the_step() {
        let weights = along(40);
        // Multiplied by (-1)^i, weights and their moments below the order sum up to what is far from the step.
        let half = &weights[..20];
        let padded = |i: i32| usize::try_from(i).map_or(0.0, |i| half[i.min(19)]);
        for power in 0..TAPER as i32 {
            let sum: f64 = (-1..12)
                .map(|i| {
                    (padded(i + 1) - padded(i))
                        * (if i % 2 == 0 { 1.0 } else { -1.0 })
                        * f64::from(i - 3).powi(power)
                })
                .sum();
            assert!(sum.abs() < 1e-12, "{power}: {sum:e}");
        }
        assert!(weights[TAPER..34].iter().all(|w| *w == 1.0) && weights[0] == 1.0 / 64.0);
    }
}
