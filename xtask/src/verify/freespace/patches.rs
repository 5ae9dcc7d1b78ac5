//! Refinement patches: figures 5 and 6 of Hejlesen and Walther (2016), nested levels, and a source with two scales.

use std::time::Instant;

use meshless_freespace::{
    Centring, Kernel, Mesh, Output, Patch, Plan, RefineParams, RefinedPlan, Superposition, Workspace,
};

use super::problems::{self, Field};
use super::runs::Run;

pub(super) const CASE: &str = "patches";
pub(super) const SCALES: &str = "two-scales";

/// A way of refining round the bump of radius 1/2.
#[derive(Debug, Clone, Copy)]
pub(super) struct Layout {
    pub(super) name: &'static str,
    ratio: usize,
    superposition: Superposition,
    /// Boxes, as corners.
    boxes: &'static [[[f64; 2]; 2]],
    /// A box within the first one, refined again.
    inner: Option<[[f64; 2]; 2]>,
    /// Errors count in the innermost patches alone.
    inside: bool,
    centring: Centring,
}

const ROUND: [[f64; 2]; 2] = [[-0.5625; 2], [0.5625; 2]];
const QUARTERS: [[[f64; 2]; 2]; 4] = [
    [[-0.5625, -0.5625], [0.0, 0.0]],
    [[0.0, -0.5625], [0.5625, 0.0]],
    [[-0.5625, 0.0], [0.0, 0.5625]],
    [[0.0, 0.0], [0.5625, 0.5625]],
];

const ONE: Layout = Layout {
    name: "one patch, shift",
    ratio: 2,
    superposition: Superposition::Shift,
    boxes: &[ROUND],
    inner: None,
    inside: false,
    centring: Centring::Cell,
};

pub(super) const LAYOUTS: [Layout; 13] = [
    ONE,
    Layout { name: "one patch, M6*", superposition: Superposition::M6Star, ..ONE },
    Layout { name: "one patch, six points", superposition: Superposition::Lagrange(6), ..ONE },
    Layout { name: "one patch, eight points", superposition: Superposition::Lagrange(8), ..ONE },
    Layout { name: "one patch, ten points", superposition: Superposition::Lagrange(10), ..ONE },
    Layout { name: "nodes, shift", centring: Centring::Node, ..ONE },
    Layout {
        name: "nodes, ten points",
        centring: Centring::Node,
        superposition: Superposition::Lagrange(10),
        ..ONE
    },
    Layout { name: "ratio 3, shift", ratio: 3, ..ONE },
    Layout { name: "ratio 3, M6*", ratio: 3, superposition: Superposition::M6Star, ..ONE },
    Layout { name: "four patches, shift", boxes: &QUARTERS, ..ONE },
    Layout { name: "four patches, M6*", boxes: &QUARTERS, superposition: Superposition::M6Star, ..ONE },
    Layout {
        name: "patch that cuts the source",
        boxes: &[[[-0.25, -0.25], [0.25, 0.375]]],
        inside: true,
        ..ONE
    },
    Layout {
        name: "two levels, M6*",
        superposition: Superposition::M6Star,
        inner: Some([[-0.25, -0.25], [0.25, 0.25]]),
        inside: true,
        ..ONE
    },
];

const WANTED: [Output; 2] = [Output::Curl { axis: 0 }, Output::Curl { axis: 1 }];

/// The base mesh of `n` cells in each direction.
fn base(n: usize, centring: Centring) -> Result<Mesh<2>, String> {
    Mesh::of_box([-1.0; 2], [1.0; 2], [n; 2], centring).map_err(|e| e.to_string())
}

/// The bump of radius 1/2 with patches; errors over all points that no finer patch covers.
pub(super) fn run(layout: &Layout, order: usize, n: usize) -> Result<Run, String> {
    let base = base(n, layout.centring)?;
    let mut patches: Vec<Patch<2>> =
        layout.boxes.iter().map(|[min, max]| Patch::covering(&base, *min, *max, layout.ratio)).collect();
    if let Some([min, max]) = layout.inner {
        let outer = patches[0];
        let first = Patch::covering(&base, min, max, layout.ratio);
        let inside = |a: usize| layout.ratio * (first.first[a] - outer.first[a]);
        patches.push(Patch {
            parent: Some(0),
            first: [inside(0), inside(1)],
            cells: first.cells.map(|c| layout.ratio * c),
            ratio: layout.ratio,
        });
    }
    let params = RefineParams {
        order,
        smoothing: Some(2.0),
        superposition: layout.superposition,
        ..RefineParams::default()
    };
    let field = problems::bump_at([0.0; 2], 0.5);
    let solved = solve(&base, &patches, params, &[field])?;
    let [l2, linf, worst] = solved.errors(&[field], layout.inside);
    Ok(Run {
        case: CASE,
        variant: layout.name,
        kernel: Kernel::Gaussian { order, smoothing: Some(2.0) },
        n,
        dimension: 2,
        spacing: base.spacing()[0],
        points: solved.points(),
        l2,
        linf,
        worst,
        plan_seconds: solved.plan_seconds,
        solve_seconds: solved.solve_seconds,
    })
}

pub(super) struct Solved {
    plan: RefinedPlan<2>,
    fields: Vec<Vec<Vec<f64>>>,
    pub(super) plan_seconds: f64,
    pub(super) solve_seconds: f64,
}

pub(super) fn solve(
    base: &Mesh<2>,
    patches: &[Patch<2>],
    params: RefineParams,
    bumps: &[Field],
) -> Result<Solved, String> {
    let start = Instant::now();
    let plan = RefinedPlan::new(base, patches, params).map_err(|e| e.to_string())?;
    let plan_seconds = start.elapsed().as_secs_f64();
    let sources: Vec<Vec<Vec<f64>>> = (0..plan.len())
        .map(|i| vec![plan.source_mesh(i).sample(|p| problems::vorticity(bumps, p))])
        .collect();
    let start = Instant::now();
    let fields = plan.solve(&sources, &WANTED).map_err(|e| e.to_string())?;
    Ok(Solved { plan, fields, plan_seconds, solve_seconds: start.elapsed().as_secs_f64() })
}

impl Solved {
    /// The run on the source with two scales.
    pub(super) fn of_two_scales(&self, variant: &'static str, order: usize) -> Run {
        let [l2, linf, worst] = self.errors(&two_scales(), false);
        let n = self.finest();
        Run {
            case: SCALES,
            variant,
            kernel: Kernel::Gaussian { order, smoothing: Some(2.0) },
            n,
            dimension: 2,
            spacing: 2.0 / n as f64,
            points: self.points(),
            l2,
            linf,
            worst,
            plan_seconds: self.plan_seconds,
            solve_seconds: self.solve_seconds,
        }
    }

    /// Points of all meshes that sources were sampled on.
    pub(super) fn points(&self) -> usize {
        (0..self.plan.len()).map(|i| self.plan.source_mesh(i).len()).sum()
    }

    /// Cells in each direction of one mesh as fine as the finest.
    pub(super) fn finest(&self) -> usize {
        let spacing = (0..self.plan.len()).map(|i| self.plan.mesh(i).spacing()[0]).fold(2.0, f64::min);
        (2.0 / spacing).round() as usize
    }

    /// Error (31), relative largest error and largest error, over the points that no patch covers, or over those of the
    /// innermost patches.
    pub(super) fn errors(&self, bumps: &[Field], inside: bool) -> [f64; 3] {
        let (mut error, mut size, mut worst, mut largest) = (0.0, 0.0, 0.0_f64, 0.0_f64);
        for (index, fields) in self.fields.iter().enumerate() {
            let mesh = self.plan.mesh(index);
            let covers: Vec<&Mesh<2>> = self.plan.patches_of(index).map(|i| self.plan.mesh(i)).collect();
            if inside && !covers.is_empty() {
                continue;
            }
            for point in 0..mesh.len() {
                let p = mesh.point(point);
                let in_patch = |m: &&&Mesh<2>| (0..2).all(|a| p[a] > m.min()[a] && p[a] < m.max()[a]);
                if covers.iter().any(|m| in_patch(&m)) {
                    continue;
                }
                let exact = problems::velocity(bumps, p);
                for a in 0..2 {
                    let difference = fields[a][point] - exact[a];
                    error += difference * difference * mesh.cell_volume();
                    size += exact[a] * exact[a] * mesh.cell_volume();
                    worst = worst.max(difference.abs());
                    largest = largest.max(exact[a].abs());
                }
            }
        }
        [(error / size).sqrt(), worst / largest, worst]
    }
}

/// A wide bump and one that is fourteen times as narrow and as strong in velocity.
const TWO_SCALES: [(f64, [f64; 2], f64); 2] = [(1.0, [0.0, 0.0], 0.9), (1.0, [0.3, 0.2], 0.0625)];

/// Cells of its parent by which a patch is larger than the narrow bump on each side: outside of it the parent's error stays,
/// which reaches as far as the parent's kernel.
const BEYOND: f64 = 20.0;

/// Ways of refining: by what the cells of the finest patch are smaller than those of the base mesh, in powers of two, and how
/// they are brought together.
pub(super) const LEVELS: [(&str, u32, Superposition); 3] = [
    (PAYING, 2, Superposition::Lagrange(10)),
    ("two levels, M6*", 2, Superposition::M6Star),
    (COARSE, 3, Superposition::Lagrange(10)),
];

/// One mesh.
pub(super) const UNIFORM: &str = "uniform";

/// The base mesh resolves the narrow bump.
pub(super) const PAYING: &str = "two levels, ten points";

/// The base mesh does not.
pub(super) const COARSE: &str = "three levels, ten points";

pub(super) fn two_scales() -> Vec<Field> {
    TWO_SCALES
        .iter()
        .map(|&(height, centre, radius)| Field { height, ..problems::bump_at(centre, radius) })
        .collect()
}

/// The source with two scales, on one mesh of `n` cells in each direction.
pub(super) fn uniform(order: usize, n: usize) -> Result<Run, String> {
    let bumps = two_scales();
    let mesh = base(n, Centring::Cell)?;
    let kernel = Kernel::Gaussian { order, smoothing: Some(2.0) };
    let start = Instant::now();
    let plan: Plan<2> = Plan::new(&mesh, kernel).map_err(|e| e.to_string())?;
    let plan_seconds = start.elapsed().as_secs_f64();
    let source = mesh.sample(|p| problems::vorticity(&bumps, p));
    let mut fields = Vec::new();
    let start = Instant::now();
    plan.solve(&[&source], &WANTED, &mut Workspace::default(), &mut fields).map_err(|e| e.to_string())?;
    let solve_seconds = start.elapsed().as_secs_f64();
    let exact: Vec<Vec<f64>> = (0..2).map(|a| mesh.sample(|p| problems::velocity(&bumps, p)[a])).collect();
    let [l2, linf, worst] = super::runs::errors(&fields, &exact);
    Ok(Run {
        case: SCALES,
        variant: UNIFORM,
        kernel,
        n,
        dimension: 2,
        spacing: mesh.spacing()[0],
        points: mesh.len(),
        l2,
        linf,
        worst,
        plan_seconds,
        solve_seconds,
    })
}

/// The same with patches round the narrow bump, whose finest cells are those of a mesh of `n`.
pub(super) fn refined(
    order: usize,
    n: usize,
    (variant, levels, superposition): (&'static str, u32, Superposition),
) -> Result<Run, String> {
    let bumps = two_scales();
    let (_, centre, radius) = TWO_SCALES[1];
    let base = base(n >> levels, Centring::Cell)?;
    let mut patches: Vec<Patch<2>> = Vec::new();
    // Boxes in cells of the base, divided by the refinement so far.
    let mut corner = [0; 2];
    for level in 0..levels {
        let parent_mesh = self::base(n >> (levels - level), Centring::Cell)?;
        let half = radius + BEYOND * parent_mesh.spacing()[0];
        let round = Patch::covering(&parent_mesh, centre.map(|c| c - half), centre.map(|c| c + half), 2);
        let first = std::array::from_fn(|a| round.first[a] - corner[a]);
        patches.push(Patch { parent: patches.len().checked_sub(1), first, ..round });
        corner = round.first.map(|c| 2 * c);
    }
    let params = RefineParams { order, smoothing: Some(2.0), superposition, ..RefineParams::default() };
    Ok(solve(&base, &patches, params, &bumps)?.of_two_scales(variant, order))
}
