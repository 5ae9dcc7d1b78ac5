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

/// Columns of the first direction that are made together.
const BLOCK: usize = 32;

/// Bytes of a place of as many lines as a vector holds.
const PACK: usize = 32;

/// The same of two packs, the real and the imaginary parts of one.
const PACKS: f64 = 2.0 * PACK as f64;

/// Megabytes of the plan with one solve for phi.
fn needed_mb<T>(points: [usize; 3], lengths: [usize; 3], wide: &[[usize; 3]]) -> u64 {
    let product = |n: [usize; 3]| n.iter().map(|&n| n as f64).product::<f64>();
    let half = |lengths: &[usize; 3]| {
        let [x, y, z] = lengths.map(|n| n / 2 + 1);
        product([x, y.saturating_mul(z).div_ceil(BLOCK), BLOCK])
    };
    let octant = product(lengths.map(|n| n / 2 + 1));
    let longest = wide.iter().chain([&lengths]).map(|n| n[0]).max().unwrap_or(1);
    // Each thread has some lines of the first direction for itself, as far as there are lines for it.
    let threads = |tasks: usize| rayon::current_num_threads().min(tasks.max(1)) as f64;
    let columns = (lengths[1] / 2 + 1) * (lengths[2] / 2 + 1);
    let made = 2.0 * PACKS * longest as f64 * threads(columns.div_ceil(BLOCK));
    let making = 8.0 * (octant + wide.iter().chain([&lengths]).map(half).sum::<f64>()) + made;
    // Slabs of whole packs.
    let lanes = PACK / size_of::<T>();
    let (pairs, slabs) = if lengths[1] == 1 { (1, 2 * lanes) } else { (points[1].div_ceil(2).min(4), lanes) };
    let spectra = 2.0 * product([lengths[0] / 2 + 1, points[1], points[2].next_multiple_of(slabs)]);
    let lines = PACKS * (points[0] as f64 + (pairs * lengths[0]) as f64) * threads(points[2].div_ceil(slabs));
    let solving = size_of::<T>() as f64 * (spectra + product(points)) + lines;
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

    /// Measured peaks of processes: 80 and 22 doubles a point.
    #[test]
    fn long_lines_need_room_for_as_many_as_are_transformed_together() {
        let line = needed_mb::<f64>([1 << 21, 1, 1], [1 << 22, 1, 1], &[]);
        assert!((1000..2000).contains(&line), "{line}");
        let strip = needed_mb::<f64>([1_000_000, 1, 4], [2_000_000, 1, 8], &[]);
        assert!((400..1500).contains(&strip), "{strip}");
    }

    #[test]
    fn what_does_not_fit_is_refused_with_the_figure() {
        let error = check::<f64>([1024; 3], [2048; 3], &[], Some(1000)).expect_err("32 GB");
        assert!(error.to_string().contains("1000 MB are available"), "{error}");
    }
}
