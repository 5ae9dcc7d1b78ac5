//! Refinement patches in three dimensions: a bump, and the torus of figure 5, with patches against one fine mesh.

use std::time::Instant;

use meshless_freespace::{
    Centring, Kernel, Mesh, Output, Patch, Plan, RefineParams, RefinedPlan, Superposition, Workspace,
};

use super::PATCH_ORDERS;
use super::problems;
use super::runs::Run;
use crate::verify::options::Effort;

pub(super) const CASE: &str = "patches-3d";

/// What fills a part of space: its source, and the field that should come of it.
#[derive(Debug, Clone, Copy)]
struct Body {
    /// The base mesh and the box in which errors count reach so far from the middle.
    base: [f64; 3],
    counted: [f64; 3],
    /// The source, or the components of the vorticity.
    given: fn([f64; 3]) -> [f64; 3],
    components: usize,
    wanted: [Output; 3],
    exact: fn([f64; 3]) -> [f64; 3],
}

/// A potential that is a bump.
const BALL: Body = Body {
    base: [1.0; 3],
    counted: [0.5625; 3],
    given: |p| [problems::ball_source(RADIUS)(p), 0.0, 0.0],
    components: 1,
    wanted: [
        Output::Gradient { source: 0, axis: 0 },
        Output::Gradient { source: 0, axis: 1 },
        Output::Gradient { source: 0, axis: 2 },
    ],
    exact: |p| problems::ball_gradient(RADIUS)(p),
};

/// A torus of vorticity. The finest cells of N cells of the base are those of N cells across the torus.
const TORUS: Body = Body {
    base: [2.0, 2.0, 1.0],
    counted: [2.0 * problems::RADIUS, 2.0 * problems::RADIUS, problems::RADIUS],
    given: problems::torus_vorticity,
    components: 3,
    wanted: [Output::Curl { axis: 0 }, Output::Curl { axis: 1 }, Output::Curl { axis: 2 }],
    exact: problems::torus_velocity,
};

/// A way of covering a body with patches.
#[derive(Debug, Clone, Copy)]
pub(super) struct Layout {
    pub(super) name: &'static str,
    body: Body,
    /// Boxes, as corners.
    boxes: &'static [[[f64; 3]; 2]],
    superposition: Superposition,
    /// Cells of the base mesh in the first direction.
    pub(super) bases: [usize; 2],
    /// Orders that are looked at, unless all are.
    orders: &'static [usize],
}

impl Layout {
    pub(super) fn orders(&self, effort: Effort) -> &'static [usize] {
        if effort == Effort::Full { &PATCH_ORDERS } else { self.orders }
    }
}

const ROUND: [[f64; 3]; 2] = [[-0.5625; 3], [0.5625; 3]];
const HALVES: [[[f64; 3]; 2]; 2] =
    [[[-0.5625; 3], [0.0, 0.5625, 0.5625]], [[0.0, -0.5625, -0.5625], [0.5625; 3]]];
const ROUND_TORUS: [[f64; 3]; 2] = [[-1.125, -1.125, -0.625], [1.125, 1.125, 0.625]];

const BALL_WHOLE: Layout = Layout {
    name: FINE,
    body: BALL,
    boxes: &[],
    superposition: Superposition::Shift,
    bases: BASES,
    orders: &ORDERS,
};

const TORUS_WHOLE: Layout = Layout {
    name: TORUS_ONE,
    body: TORUS,
    boxes: &[ROUND_TORUS],
    superposition: Superposition::Shift,
    bases: TORUS_BASES,
    orders: &TORUS_ORDERS,
};

pub(super) const LAYOUTS: [Layout; 6] = [
    BALL_WHOLE,
    Layout { name: ONE, boxes: &[ROUND], ..BALL_WHOLE },
    Layout { name: TWO, boxes: &HALVES, ..BALL_WHOLE },
    Layout { name: ONE_BY_M6, boxes: &[ROUND], superposition: Superposition::M6Star, ..BALL_WHOLE },
    TORUS_WHOLE,
    Layout { name: TORUS_BY_M6, superposition: Superposition::M6Star, ..TORUS_WHOLE },
];

pub(super) const FINE: &str = "one fine mesh";
pub(super) const ONE: &str = "one patch, shift";
pub(super) const TWO: &str = "two bordering patches, shift";
pub(super) const ONE_BY_M6: &str = "one patch, M6*";
pub(super) const TORUS_ONE: &str = "torus, one patch, shift";
pub(super) const TORUS_BY_M6: &str = "torus, one patch, M6*";

/// Orders that are looked at, and cells of the base mesh, of the ball and the torus: the core of the torus is an eighth of its base.
pub(super) const ORDERS: [usize; 2] = [4, 6];
pub(super) const BASES: [usize; 2] = [32, 64];
pub(super) const TORUS_ORDERS: [usize; 2] = [4, 10];
pub(super) const TORUS_BASES: [usize; 2] = [64, 128];

/// Radius of the bump.
const RADIUS: f64 = 0.5;

/// What kernels are cut off at: far below the errors here, and bands are narrower.
const TOLERANCE: f64 = 1e-10;

/// A body on a base mesh of `n` cells in the first direction with patches, or on one mesh as fine as those.
pub(super) fn run(layout: Layout, order: usize, n: usize) -> Result<Run, String> {
    let Layout { name: variant, body, boxes, superposition, .. } = layout;
    let said = |e: meshless_freespace::FreeSpaceError| format!("{variant}, m = {order}, N = {n}: {e}");
    let fine = boxes.is_empty();
    let across = if fine { 2 * n } else { n };
    let cells = body.base.map(|side| (across as f64 * side / body.base[0]).round() as usize);
    let base = Mesh::of_box(body.base.map(|x| -x), body.base, cells, Centring::Cell).map_err(said)?;
    let kernel = Kernel::Gaussian { order, smoothing: Some(2.0) };
    let patches: Vec<Patch<3>> =
        boxes.iter().map(|[min, max]| Patch::covering(&base, *min, *max, 2)).collect();
    let start = Instant::now();
    let (meshes, plan_seconds, solve_seconds, points) = if fine {
        let plan: Plan<3> = Plan::new(&base, kernel).map_err(said)?;
        let plan_seconds = start.elapsed().as_secs_f64();
        let sources = body.sources(&base);
        let sources: Vec<&[f64]> = sources.iter().map(Vec::as_slice).collect();
        let (start, mut fields) = (Instant::now(), Vec::new());
        plan.solve(&sources, &body.wanted, &mut Workspace::default(), &mut fields).map_err(said)?;
        (vec![(base, fields)], plan_seconds, start.elapsed().as_secs_f64(), base.len())
    } else {
        let params = RefineParams { order, smoothing: Some(2.0), tolerance: TOLERANCE, superposition };
        let plan = RefinedPlan::new(&base, &patches, params).map_err(said)?;
        let plan_seconds = start.elapsed().as_secs_f64();
        let sources: Vec<Vec<Vec<f64>>> =
            (0..plan.len()).map(|i| body.sources(plan.source_mesh(i))).collect();
        let start = Instant::now();
        let fields = plan.solve(&sources, &body.wanted).map_err(said)?;
        let points = (0..plan.len()).map(|i| plan.source_mesh(i).len()).sum();
        // All of the body is in patches: errors count there alone, as on the fine mesh.
        let meshes = fields.into_iter().enumerate().skip(1).map(|(i, fields)| (*plan.mesh(i), fields));
        (meshes.collect(), plan_seconds, start.elapsed().as_secs_f64(), points)
    };
    let [l2, linf, worst] = body.errors(&meshes);
    Ok(Run {
        case: CASE,
        variant,
        kernel,
        n,
        dimension: 3,
        spacing: 2.0 * body.base[0] / n as f64,
        points,
        l2,
        linf,
        worst,
        plan_seconds,
        solve_seconds,
    })
}

impl Body {
    fn sources(&self, mesh: &Mesh<3>) -> Vec<Vec<f64>> {
        let given: Vec<[f64; 3]> = (0..mesh.len()).map(|point| (self.given)(mesh.point(point))).collect();
        (0..self.components).map(|a| given.iter().map(|components| components[a]).collect()).collect()
    }

    /// Error (31), relative largest error and largest error of the field.
    fn errors(&self, meshes: &[(Mesh<3>, Vec<Vec<f64>>)]) -> [f64; 3] {
        let (mut error, mut size, mut worst, mut largest) = (0.0, 0.0, 0.0_f64, 0.0_f64);
        for (mesh, fields) in meshes {
            for point in 0..mesh.len() {
                let p = mesh.point(point);
                if (0..3).any(|a| p[a].abs() > self.counted[a]) {
                    continue;
                }
                for (field, exact) in fields.iter().zip((self.exact)(p)) {
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
}
