//! Refinement patches in three dimensions: a bump with patches against one fine mesh.

use std::time::Instant;

use meshless_freespace::{
    Centring, Kernel, Mesh, Output, Patch, Plan, RefineParams, RefinedPlan, Superposition, Workspace,
};

use super::patches::CASE;
use super::problems;
use super::runs::Run;

/// A way of covering the bump: its name, boxes as corners, and how meshes are brought together.
pub(super) type Layout = (&'static str, &'static [[[f64; 3]; 2]], Superposition);

const ROUND: [[f64; 3]; 2] = [[-0.5625; 3], [0.5625; 3]];
const HALVES: [[[f64; 3]; 2]; 2] =
    [[[-0.5625; 3], [0.0, 0.5625, 0.5625]], [[0.0, -0.5625, -0.5625], [0.5625; 3]]];

pub(super) const LAYOUTS: [Layout; 4] = [
    (FINE, &[], Superposition::Shift),
    (ONE, &[ROUND], Superposition::Shift),
    (TWO, &HALVES, Superposition::Shift),
    (ONE_BY_M6, &[ROUND], Superposition::M6Star),
];

pub(super) const FINE: &str = "3-D, one fine mesh";
pub(super) const ONE: &str = "3-D, one patch, shift";
pub(super) const TWO: &str = "3-D, two bordering patches, shift";
pub(super) const ONE_BY_M6: &str = "3-D, one patch, M6*";

/// Orders that are looked at, and cells of the base mesh in each direction.
pub(super) const ORDERS: [usize; 2] = [4, 6];
pub(super) const BASES: [usize; 2] = [32, 64];

/// Radius of the bump.
const RADIUS: f64 = 0.5;

/// What kernels are cut off at: far below the errors here, and bands are narrower.
const TOLERANCE: f64 = 1e-10;

const WANTED: [Output; 3] = [
    Output::Gradient { source: 0, axis: 0 },
    Output::Gradient { source: 0, axis: 1 },
    Output::Gradient { source: 0, axis: 2 },
];

/// The bump of radius 1/2 on a base mesh of `n` cells in each direction with patches, or on one mesh as fine as those.
pub(super) fn run((variant, boxes, superposition): Layout, order: usize, n: usize) -> Result<Run, String> {
    let said = |e: meshless_freespace::FreeSpaceError| format!("{variant}, m = {order}, N = {n}: {e}");
    let fine = boxes.is_empty();
    let cells = [if fine { 2 * n } else { n }; 3];
    let base = Mesh::of_box([-1.0; 3], [1.0; 3], cells, Centring::Cell).map_err(said)?;
    let kernel = Kernel::Gaussian { order, smoothing: Some(2.0) };
    let patches: Vec<Patch<3>> =
        boxes.iter().map(|[min, max]| Patch::covering(&base, *min, *max, 2)).collect();
    let start = Instant::now();
    let (meshes, plan_seconds, solve_seconds, points) = if fine {
        let plan: Plan<3> = Plan::new(&base, kernel).map_err(said)?;
        let plan_seconds = start.elapsed().as_secs_f64();
        let source = base.sample(problems::ball_source(RADIUS));
        let (start, mut fields) = (Instant::now(), Vec::new());
        plan.solve(&[&source], &WANTED, &mut Workspace::default(), &mut fields).map_err(said)?;
        (vec![(base, fields)], plan_seconds, start.elapsed().as_secs_f64(), base.len())
    } else {
        let params = RefineParams { order, smoothing: Some(2.0), tolerance: TOLERANCE, superposition };
        let plan = RefinedPlan::new(&base, &patches, params).map_err(said)?;
        let plan_seconds = start.elapsed().as_secs_f64();
        let sources: Vec<Vec<Vec<f64>>> = (0..plan.len())
            .map(|i| vec![plan.source_mesh(i).sample(problems::ball_source(RADIUS))])
            .collect();
        let start = Instant::now();
        let fields = plan.solve(&sources, &WANTED).map_err(said)?;
        let points = (0..plan.len()).map(|i| plan.source_mesh(i).len()).sum();
        // All of the bump is in patches: errors count there alone, as on the fine mesh.
        let meshes = fields.into_iter().enumerate().skip(1).map(|(i, fields)| (*plan.mesh(i), fields));
        (meshes.collect(), plan_seconds, start.elapsed().as_secs_f64(), points)
    };
    let [l2, linf, worst] = errors(&meshes);
    Ok(Run {
        case: CASE,
        variant,
        kernel,
        n,
        dimension: 3,
        spacing: 2.0 / n as f64,
        points,
        l2,
        linf,
        worst,
        plan_seconds,
        solve_seconds,
    })
}

/// Error (31), relative largest error and largest error of the gradient in the box of the patches.
fn errors(meshes: &[(Mesh<3>, Vec<Vec<f64>>)]) -> [f64; 3] {
    let exact = problems::ball_gradient(RADIUS);
    let (mut error, mut size, mut worst, mut largest) = (0.0, 0.0, 0.0_f64, 0.0_f64);
    for (mesh, fields) in meshes {
        for point in 0..mesh.len() {
            let p = mesh.point(point);
            if p.iter().any(|x| x.abs() > 0.5625) {
                continue;
            }
            let exact = exact(p);
            for (field, exact) in fields.iter().zip(exact) {
                let difference = field[point] - exact;
                error += difference * difference;
                size += exact * exact;
                worst = worst.max(difference.abs());
                largest = largest.max(exact.abs());
            }
        }
    }
    [(error / size).sqrt(), worst / largest, worst]
}
