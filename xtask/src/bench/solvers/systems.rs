//! The systems that solvers are measured on: a ball of another diffusivity in the middle of the unit box, by each kind of
//! discretisation, with as many unknowns as asked for.

use meshless::interfaces::LinearSystem;
use meshless::plan::Plan;
use meshless::scene::Scene;
use meshless::sparse::{
    ChainLink, DifferenceMatrix, GroupUnknowns, MultigridParams, PreconditionerKind, SolverKind,
    SolverParams, Split,
};

type Error = Box<dyn std::error::Error + Send + Sync>;

/// Radius of the ball.
const RADIUS: f64 = 0.3;

/// A kind of discretisation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// Balances over Voronoi cells in the plane, 7 entries a row.
    Conservative,
    /// Balances near the interface, stencils elsewhere.
    Hybrid,
    /// Stencils of the smeared, log-scaled diffusivity.
    Classical,
    /// Stencils that the interface condition is built into.
    Particle,
    /// DC-PSE with constrained ghosts in space.
    Ghosts,
    /// The seven-point formula in space.
    SevenPoint,
}

impl Kind {
    pub(crate) const ALL: [Self; 6] =
        [Self::Conservative, Self::Hybrid, Self::Classical, Self::Particle, Self::Ghosts, Self::SevenPoint];

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Conservative => "2-D conservative",
            Self::Hybrid => "2-D conservative hybrid",
            Self::Classical => "2-D classical, log-scaled",
            Self::Particle => "2-D particle difference",
            Self::Ghosts => "3-D constrained ghosts",
            Self::SevenPoint => "3-D seven-point",
        }
    }

    fn dimension(self) -> usize {
        if matches!(self, Self::Ghosts | Self::SevenPoint) { 3 } else { 2 }
    }

    fn method(self) -> &'static str {
        match self {
            Self::Conservative => "name = \"gfdm-conservative\"",
            Self::Hybrid => "name = \"gfdm-hybrid\"",
            Self::Classical => "name = \"gfdm-classical\"\nlog_scaling = true",
            Self::Particle => "name = \"particle-difference\"",
            Self::Ghosts | Self::SevenPoint => "name = \"immersed-interface\"",
        }
    }
}

/// The system with about `unknowns` unknowns and the diffusivity `contrast` in the ball, 1 outside, and how a plan solves it
/// with multigrid.
pub(crate) fn system(
    kind: Kind,
    unknowns: usize,
    contrast: f64,
) -> Result<(LinearSystem, SolverParams), Error> {
    let d = kind.dimension();
    let m = (unknowns as f64).powf(1.0 / d as f64);
    if kind == Kind::SevenPoint {
        let kind = SolverKind::Multigrid;
        let preconditioner = PreconditionerKind::Multigrid(MultigridParams::default());
        let params = SolverParams { kind, preconditioner, ..SolverParams::default() };
        return Ok((seven_point(m.round() as usize, contrast)?, params));
    }
    let method = format!("{}\nsolver = \"multigrid\"", kind.method());
    let text = scene(d, 1.0 / m, contrast, &method);
    let scene = Scene::parse(&text, "solvers")?;
    let plan = Plan::new(&scene)?;
    Ok((meshless::linear_system(&scene, &plan)?, plan.solver))
}

/// A ball in a box, held at its faces.
pub(crate) fn scene(dimension: usize, spacing: f64, contrast: f64, method: &str) -> String {
    let row = |value: &str| vec![value; dimension].join(", ");
    let regions = format!(
        "[[regions]]\nname = \"ball\"\nsphere = {{ center = [{}], radius = {RADIUS:?} }}\n\
         diffusivity = {contrast:e}\nsource = \"1\"\n\n\
         [[regions]]\nname = \"box\"\ndiffusivity = \"1\"\nsource = \"1\"\n\n",
        row("0.5")
    );
    format!(
        "title = \"Ball in a box\"\ndimension = {dimension}\n\n\
         [domain]\nbox = {{ min = [{}], max = [{}] }}\n\n\
         [points]\nspacing = {spacing:e}\nlayout = \"irregular\"\nseed = 1\n\n{regions}\
         [[boundaries]]\nface = \"all\"\ndirichlet = \"x\"\n\n[method]\n{method}\n",
        row("0.0"),
        row("1.0"),
    )
}

/// The seven-point formula on `m^3` inner nodes, with harmonic means between them, zero on the boundary, and the constant
/// of a stiff ball split off.
fn seven_point(m: usize, contrast: f64) -> Result<LinearSystem, Error> {
    let n = m * m * m;
    let inside = |i: usize| {
        let at = [i % m, i / m % m, i / (m * m)].map(|k| (k + 1) as f64 / (m + 1) as f64 - 0.5);
        at.iter().map(|x| x * x).sum::<f64>() < RADIUS * RADIUS
    };
    let eta = |i: usize| if inside(i) { contrast } else { 1.0 };
    let rows = DifferenceMatrix::from_rows(n, |i, row| {
        for stride in [1, m, m * m] {
            let k = i / stride % m;
            for other in [(k > 0).then(|| i - stride), (k + 1 < m).then(|| i + stride)] {
                match other {
                    Some(j) => row.push(j, -2.0 * eta(i) * eta(j) / (eta(i) + eta(j))),
                    None => row.add_to_row_sum(eta(i)),
                }
            }
        }
    })?;
    let h = 1.0 / (m + 1) as f64;
    let rhs = vec![h * h; n];
    let split = if contrast > 1.0 {
        let group = (0..n).map(|i| u32::from(inside(i))).collect();
        let ball =
            GroupUnknowns { scale: 1.0 / contrast, chain: vec![ChainLink { cluster: 0, factor: 1.0 }] };
        let middle = (m / 2) * (1 + m + m * m);
        Split::new(group, vec![GroupUnknowns { scale: 1.0, chain: Vec::new() }, ball], vec![middle as u32])?
    } else {
        Split::trivial(n)
    };
    let bordered = split.apply(&rows, &rhs)?;
    Ok(LinearSystem { bordered })
}
