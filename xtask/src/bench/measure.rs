//! Wall-clock time.

use std::hint::black_box;
use std::time::Instant;

/// Seconds that `work` takes: the median of several runs.
pub(super) fn seconds<T>(repetitions: usize, mut work: impl FnMut() -> T) -> f64 {
    let times = (0..repetitions)
        .map(|_| {
            let start = Instant::now();
            black_box(work());
            start.elapsed().as_secs_f64()
        })
        .collect();
    median(times)
}

/// The median; that of an even number of values is the upper one.
pub(super) fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

/// The same on one thread and on two.
pub(super) fn on_one_and_two<T: Send>(
    repetitions: usize,
    work: impl Fn() -> T + Sync + Send,
) -> Result<[f64; 2], rayon::ThreadPoolBuildError> {
    let on = |threads| meshless::on_threads(threads, || seconds(repetitions, &work));
    Ok([on(1)?, on(2)?])
}

#[cfg(test)]
mod tests {
    use super::median;

    #[test]
    fn the_median_is_the_middle() {
        assert_eq!(median(vec![3.0, 1.0, 2.0]), 2.0);
        assert_eq!(median(vec![4.0, 1.0]), 4.0);
        assert!(median(Vec::new()).is_nan());
    }
}
