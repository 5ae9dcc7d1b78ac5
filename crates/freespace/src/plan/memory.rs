//! How much memory a plan takes, and how much there is.

use crate::error::FreeSpaceError;

/// Refuses what does not fit; `wide` are the lengths of arrays that there are while Ĝ is made, beside itself.
pub(super) fn check<T>(
    points: [usize; 3],
    lengths: [usize; 3],
    wide: &[[usize; 3]],
    limit_mb: Option<u64>,
) -> Result<(), FreeSpaceError> {
    let Some(available) = limit_mb.or_else(available_mb) else { return Ok(()) };
    let needed = needed_mb::<T>(points, lengths, wide);
    if needed > available { Err(FreeSpaceError::Memory { needed, available }) } else { Ok(()) }
}

/// Megabytes of the plan with one solve for phi, without the scratch of the threads.
fn needed_mb<T>(points: [usize; 3], lengths: [usize; 3], wide: &[[usize; 3]]) -> u64 {
    let product = |n: [usize; 3]| n.iter().map(|&n| n as f64).product::<f64>();
    let half = |lengths: &[usize; 3]| product(lengths.map(|n| n / 2 + 1));
    let octant = half(&lengths);
    let making = 8.0 * (octant + wide.iter().map(half).sum::<f64>());
    let spectra = 2.0 * (lengths[0] / 2 + 1) as f64 * (points[1] * points[2]) as f64;
    let solving = size_of::<T>() as f64 * (spectra + product(points));
    let kept = size_of::<T>() as f64 * octant;
    ((making.max(solving) + kept) / f64::from(1 << 20)) as u64 + 1
}

/// What the system says is available; not all systems do.
fn available_mb() -> Option<u64> {
    let text = std::fs::read_to_string("/proc/meminfo").ok()?;
    let line = text.lines().find_map(|l| l.strip_prefix("MemAvailable:"))?;
    let kilobytes: u64 = line.trim().trim_end_matches("kB").trim().parse().ok()?;
    Some(kilobytes / 1024)
}

#[cfg(test)]
mod tests {
    use super::{check, needed_mb};

    #[test]
    fn a_cube_needs_three_doubles_a_point_and_the_result() {
        let n = 128;
        let megabyte = (n * n * n * 8) as u64 >> 20;
        assert!((4 * megabyte..5 * megabyte).contains(&needed_mb::<f64>([n; 3], [2 * n; 3], &[])));
    }

    #[test]
    fn what_does_not_fit_is_refused_with_the_figure() {
        let error = check::<f64>([1024; 3], [2048; 3], &[], Some(1000)).expect_err("32 GB");
        assert!(error.to_string().contains("1000 MB are available"), "{error}");
    }
}
