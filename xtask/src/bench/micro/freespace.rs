//! Convolution in free space against the bare transforms of its lines.

use meshless_freespace::{Centring, Kernel, Mesh, Output, Plan, Workspace};

use crate::bench::measure::seconds;
use crate::bench::table::Table;

const REPETITIONS: usize = 5;

pub(in crate::bench) fn run() -> crate::bench::Outcome {
    let mut table = Table::new(&[
        "phi, 1 thread",
        "transforms alone, s",
        "solve, s",
        "ratio (≤ 1.25)",
        "to transforms of several lines",
        "set-up, solves (≤ 1)",
        "doubles per point (≤ 5.5)",
        "2 threads, speed-up",
        "with grad phi, solves",
    ]);
    measure::<2>([1024; 2], &mut table)?;
    measure::<3>([128; 3], &mut table)?;
    measure::<3>([256; 3], &mut table)?;
    Ok(vec![table])
}

fn measure<const D: usize>(
    cells: [usize; D],
    table: &mut Table,
) -> Result<(), Box<dyn std::error::Error + Send + Sync>> {
    let mesh = Mesh::of_box([0.0; D], [1.0; D], cells, Centring::Cell)?;
    let source = mesh.sample(|p| p.iter().map(|x| x * (1.0 - x)).product());
    let kernel = Kernel::gaussian(10);
    let set_up = meshless::on_threads(1, || busy(2, || Plan::<D>::new(&mesh, kernel)))?;
    let plan: Plan<D> = Plan::new(&mesh, kernel)?;
    let phi = [Output::Potential { source: 0 }];
    let all: Vec<Output> = (0..D).map(|axis| Output::Gradient { source: 0, axis }).chain(phi).collect();
    let bare = busy(REPETITIONS, || plan.bare_transforms());
    let packed = busy(REPETITIONS, || plan.bare_packed_transforms());
    let [one, first, second] = solves(&plan, &source, &phi)?;
    let [with_gradient, ..] = solves(&plan, &source, &all)?;
    table.row(
        &format!("{D}-D, N = {}", cells[0]),
        vec![
            format!("{bare:.3}"),
            format!("{one:.3}"),
            format!("{:.2}", one / bare),
            format!("{:.2}", one / packed),
            format!("{:.2}", set_up / one),
            format!("{:.2}", plan.bytes(1, 1) as f64 / (8 * mesh.len()) as f64),
            format!("{:.2}", first / second),
            format!("{:.2}", with_gradient / one),
        ],
    );
    Ok(())
}

/// Seconds that one thread is busy with a solve, and seconds on the clock on one thread and on two, in memory that was used
/// before.
fn solves<const D: usize>(
    plan: &Plan<D>,
    source: &[f64],
    wanted: &[Output],
) -> Result<[f64; 3], Box<dyn std::error::Error + Send + Sync>> {
    let mut times = [0.0; 3];
    let (mut workspace, mut fields) = (Workspace::default(), Vec::new());
    plan.solve(&[source], wanted, &mut workspace, &mut fields)?;
    times[0] = meshless::on_threads(1, || {
        busy(REPETITIONS, || plan.solve(&[source], wanted, &mut workspace, &mut fields))
    })?;
    for threads in 1..=2 {
        times[threads] = meshless::on_threads(threads, || {
            seconds(REPETITIONS, || plan.solve(&[source], wanted, &mut workspace, &mut fields))
        })?;
    }
    Ok(times)
}

/// The least time that this thread is busy with `work`: whoever else uses the machine does not count, which the ratio of two
/// times needs. Where the system does not tell, the clock has to do.
fn busy<T>(repetitions: usize, mut work: impl FnMut() -> T) -> f64 {
    let Some(_) = busy_so_far() else { return seconds(repetitions, work) };
    (0..repetitions)
        .filter_map(|_| {
            let start = busy_so_far()?;
            std::hint::black_box(work());
            Some(busy_so_far()? - start)
        })
        .fold(f64::INFINITY, f64::min)
}

/// Seconds that this thread has run so far.
fn busy_so_far() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    let nanoseconds: f64 = text.split_whitespace().next()?.parse().ok()?;
    Some(1e-9 * nanoseconds)
}
