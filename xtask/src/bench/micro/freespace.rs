//! Convolution in free space against the bare transforms of its lines.
//!
//! A machine that others use, too, is now slow and now fast. What is compared is therefore measured in turn, round after round, and the
//! median of the ratios of a round is shown, with the ratios that a quarter of the rounds is below and above.

use std::time::Instant;

use meshless_freespace::{Centring, Kernel, Mesh, Output, Plan, Workspace};

use crate::bench::measure::median;
use crate::bench::table::Table;

type Failed = Box<dyn std::error::Error + Send + Sync>;

/// Points along a direction and rounds.
const SIZES: [(usize, usize); 3] = [(1024, 31), (128, 15), (256, 7)];

/// Pairs of solves on one thread and two.
const PAIRS: usize = 9;

/// Seconds that the solves of a pair take on one thread, at least.
const LEAST_TIME: f64 = 0.25;

/// Kernels whose set-up is measured.
const KERNELS: [(&str, Kernel); 3] = [
    ("order 10", Kernel::Gaussian { order: 10, smoothing: None }),
    ("spectral", Kernel::Spectral),
    ("truncated", Kernel::Truncated),
];

/// The tables that are filled.
struct Tables {
    solve: Table,
    set_up: Table,
    threads: Table,
}

pub(in crate::bench) fn run() -> crate::bench::Outcome {
    let mut tables = Tables {
        solve: Table::new(&[
            "phi, 1 thread",
            "transforms alone, s",
            "solve, s",
            "ratio (≤ 1.25)",
            "least over least",
            "to transforms of several lines",
            "doubles per point (≤ 5.5)",
            "with grad phi, solves",
        ]),
        set_up: Table::new(&["set-up, solves (≤ 1)", "order 10", "spectral", "truncated"]),
        threads: Table::new(&["2 threads, times as fast (≥ 1.7)", "solve", "set-up", "two solves at once"]),
    };
    let [(flat, rounds), in_space @ ..] = SIZES;
    measure::<2>(flat, rounds, &mut tables)?;
    for (n, rounds) in in_space {
        measure::<3>(n, rounds, &mut tables)?;
    }
    Ok(vec![tables.solve, tables.set_up, tables.threads])
}

fn measure<const D: usize>(n: usize, rounds: usize, tables: &mut Tables) -> Result<(), Failed> {
    let mesh = Mesh::of_box([0.0; D], [1.0; D], [n; D], Centring::Cell)?;
    let source = mesh.sample(|p| p.iter().map(|x| x * (1.0 - x)).product());
    let plan: Plan<D> = Plan::new(&mesh, KERNELS[0].1)?;
    let name = format!("{D}-D, N = {n}");
    let times = meshless::on_threads(1, || one_thread(&plan, &source, rounds))??;
    let solves = times.iter().map(|t| t.solve);
    let of = |time: fn(&Round) -> f64| quarters(times.iter().map(|t| time(t) / t.solve).collect());
    let bare = times.iter().map(|t| t.bare);
    tables.solve.row(
        &name,
        vec![
            format!("{:.3}", median(bare.clone().collect())),
            format!("{:.3}", median(solves.clone().collect())),
            quarters(times.iter().map(|t| t.solve / t.bare).collect()),
            format!("{:.2}", solves.fold(f64::INFINITY, f64::min) / bare.fold(f64::INFINITY, f64::min)),
            quarters(times.iter().map(|t| t.solve / t.packed).collect()),
            format!("{:.2}", plan.bytes(1, 1) as f64 / (8 * mesh.len()) as f64),
            of(|t| t.with_gradient),
        ],
    );
    tables.set_up.row(&name, vec![of(|t| t.set_up[0]), of(|t| t.set_up[1]), of(|t| t.set_up[2])]);
    let pairs = two_threads(&plan, &source)?;
    let of = |k: usize| quarters(pairs.iter().map(|pair| pair[k]).collect());
    tables.threads.row(&name, vec![of(0), of(1), of(2)]);
    Ok(())
}

/// Seconds of what is compared.
struct Round {
    bare: f64,
    packed: f64,
    solve: f64,
    with_gradient: f64,
    set_up: [f64; KERNELS.len()],
}

/// In memory that was used before. The round before the first is not counted.
fn one_thread<const D: usize>(plan: &Plan<D>, source: &[f64], rounds: usize) -> Result<Vec<Round>, Failed> {
    let phi = [Output::Potential { source: 0 }];
    let all: Vec<Output> = (0..D).map(|axis| Output::Gradient { source: 0, axis }).chain(phi).collect();
    let (mut workspace, mut field, mut fields) = (Workspace::default(), Vec::new(), Vec::new());
    let mut times = Vec::with_capacity(rounds);
    for round in 0..=rounds {
        let bare = busy(|| plan.bare_transforms()).0;
        let (solve, solved) = busy(|| plan.solve(&[source], &phi, &mut workspace, &mut field));
        let packed = busy(|| plan.bare_packed_transforms()).0;
        let (with_gradient, also) = busy(|| plan.solve(&[source], &all, &mut workspace, &mut fields));
        solved.and(also)?;
        let set_up = KERNELS.map(|(_, kernel)| busy(|| Plan::<D>::new(plan.mesh(), kernel).is_ok()).0);
        if round > 0 {
            times.push(Round { bare, packed, solve, with_gradient, set_up });
        }
    }
    Ok(times)
}

/// How many times as fast two threads are as one, in each pair of solves and of plans; and what there is to gain: two solves on a thread each,
/// at once, instead of one after the other. Two virtual processors may be one.
fn two_threads<const D: usize>(plan: &Plan<D>, source: &[f64]) -> Result<Vec<[f64; 3]>, Failed> {
    let phi = [Output::Potential { source: 0 }];
    // Seconds of a solve and of a plan, so many times each.
    let on = |threads: usize, times: usize| -> Result<[f64; 2], Failed> {
        let (mut workspace, mut field) = (Workspace::default(), Vec::new());
        let mut solve = || plan.solve(&[source], &phi, &mut workspace, &mut field);
        meshless::on_threads(threads, || {
            // Threads start, and memory is known to them.
            solve()?;
            let solves = clock(|| (0..times).all(|_| solve().is_ok()));
            Ok([solves, clock(|| (0..times).all(|_| Plan::<D>::new(plan.mesh(), KERNELS[0].1).is_ok()))])
        })?
    };
    let times = (LEAST_TIME / on(1, 1)?[0]).ceil() as usize;
    let mut pairs = Vec::with_capacity(PAIRS);
    for _ in 0..PAIRS {
        let (one, two) = (on(1, times)?, on(2, times)?);
        let both = std::thread::scope(|scope| {
            let run = || on(1, times).map_err(|error| error.to_string());
            let (first, second) = (scope.spawn(run), run());
            (first.join(), second)
        });
        let (Ok(Ok(first)), Ok(second)) = both else {
            return Err("a solve failed beside another one".into());
        };
        pairs.push([one[0] / two[0], one[1] / two[1], 2.0 * one[0] / first[0].max(second[0])]);
    }
    Ok(pairs)
}

/// The median, and the values that a quarter is below and above.
fn quarters(mut values: Vec<f64>) -> String {
    values.sort_by(f64::total_cmp);
    let at = |k: usize| values.get(k * values.len().saturating_sub(1) / 4).copied().unwrap_or(f64::NAN);
    format!("{:.2} ({:.2}–{:.2})", at(2), at(1), at(3))
}

/// Seconds on the clock.
fn clock<T>(work: impl FnOnce() -> T) -> f64 {
    let start = Instant::now();
    std::hint::black_box(work());
    start.elapsed().as_secs_f64()
}

/// Seconds that this thread is busy with `work`: while others have the processor, they do not pass. Where the system does not tell, the
/// clock has to do.
fn busy<T>(work: impl FnOnce() -> T) -> (f64, T) {
    let (start, clock) = (busy_so_far(), Instant::now());
    let done = std::hint::black_box(work());
    let seconds = match (start, busy_so_far()) {
        (Some(start), Some(end)) => end - start,
        _ => clock.elapsed().as_secs_f64(),
    };
    (seconds, done)
}

/// Seconds that this thread has run so far. The system counts when threads take turns.
fn busy_so_far() -> Option<f64> {
    std::thread::yield_now();
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    let nanoseconds: f64 = text.split_whitespace().next()?.parse().ok()?;
    Some(1e-9 * nanoseconds)
}

#[cfg(test)]
mod tests {
    use super::{busy, quarters};

    #[test]
    fn quarters_are_of_sorted_values() {
        assert_eq!(quarters(vec![5.0, 1.0, 4.0, 2.0, 3.0]), "3.00 (2.00–4.00)");
        assert_eq!(quarters(vec![1.5]), "1.50 (1.50–1.50)");
    }

    #[test]
    fn work_takes_time() {
        let (seconds, sum) = busy(|| (0..3_000_000).fold(0.0, |sum: f64, i| sum + f64::from(i).sqrt()));
        assert!(seconds > 1e-4 && sum > 0.0, "{seconds}");
    }
}
