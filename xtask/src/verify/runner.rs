//! One run: a scene with a method, solved through the facade as a user would.

use std::io::{IsTerminal, Write};

use meshless::plan::{Plan, Stage};
use meshless::scene::{LayoutName, Scene};
use meshless::{Error, Silent, Solution};
use meshless_sparse::{PreconditionerKind, SolverKind};

use super::options::Options;
use super::row::Row;
use super::study::{self, Key, Outcome};

/// Runs scenes and keeps what came out.
#[derive(Debug)]
pub(crate) struct Runner<'a> {
    pub(crate) options: &'a Options,
    pub(crate) outcomes: Vec<Outcome>,
    /// Runs that ended with an error, in words.
    pub(crate) failures: Vec<String>,
    pub(crate) suite: &'static str,
}

/// What is done besides solving.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Extra {
    /// On a grid instead of an irregular cloud.
    pub(crate) grid: bool,
    /// Draw the solution.
    pub(crate) picture: bool,
    /// By BiCGStab(2) to this residual, whatever the plan says.
    pub(crate) krylov: Option<f64>,
    /// Estimate the error.
    pub(crate) estimate: bool,
    /// To this residual, by the plan's solver.
    pub(crate) residual: Option<f64>,
    /// Memory that it takes, in GB, where that matters.
    pub(crate) memory: f64,
}

/// Solves `problem`, the text of a scene without `[method]`, as `key` says.
pub(crate) fn solve(problem: &str, key: &Key, extra: Extra) -> Result<Solution, Error> {
    let mut scene = Scene::parse(&(problem.to_owned() + &key.variant.table()), key.case)?;
    if extra.grid {
        scene.points.layout = LayoutName::Grid;
    }
    scene.output.plot = extra.picture;
    let mut plan = Plan::new(&scene)?;
    plan.stages.retain(|stage| *stage != Stage::Estimate || extra.estimate);
    if let Some(tolerance) = extra.krylov {
        plan.solver.kind = SolverKind::BiCgStab { l: 2 };
        plan.solver.preconditioner = PreconditionerKind::Ilu0;
        plan.solver.tolerance = tolerance;
    }
    plan.solver.tolerance = extra.residual.unwrap_or(plan.solver.tolerance);
    meshless::execute(&scene, &plan, &mut Silent)
}

impl<'a> Runner<'a> {
    pub(crate) fn new(suite: &'static str, options: &'a Options) -> Self {
        Self { options, outcomes: Vec::new(), failures: Vec::new(), suite }
    }

    /// Solves and keeps the figures, unless the command line leaves this run out or it was done before.
    pub(crate) fn run(&mut self, problem: &str, key: Key) -> Option<&Outcome> {
        self.run_with(problem, key, Extra::default(), |_| {})
    }

    /// The same, handing the solution to `look` before its field is dropped.
    pub(crate) fn run_with(
        &mut self,
        problem: &str,
        key: Key,
        extra: Extra,
        look: impl FnOnce(&Solution),
    ) -> Option<&Outcome> {
        if !self.options.wants(key.case, key.variant.method) || study::find(&self.outcomes, &key).is_some() {
            return study::find(&self.outcomes, &key);
        }
        announce(self.suite, &key);
        match solve(problem, &key, extra) {
            Ok(solution) => {
                look(&solution);
                let row = row(self.suite, &key, extra, &solution);
                study::push(&mut self.outcomes, Outcome { key, row, report: solution.report });
                self.outcomes.last()
            }
            Err(error) => {
                self.fail(&key, &error.to_string());
                None
            }
        }
    }

    /// Notes a run that ended with an error.
    pub(crate) fn fail(&mut self, key: &Key, error: &str) {
        let Key { case, variant, jump, level, .. } = key;
        self.failures.push(format!("{case} with {} at {jump:e}, level {level}: {error}", variant.label()));
    }
}

pub(crate) fn row(suite: &'static str, key: &Key, extra: Extra, solution: &Solution) -> Row {
    let report = &solution.report;
    let mut params = vec![format!("jump={:e}", key.jump)];
    params.extend(key.variant.params());
    if extra.grid {
        params.push("grid".to_owned());
    }
    if let Some(tolerance) = extra.krylov {
        params.push(format!("bicgstab to {tolerance:e}"));
    }
    let (errors, seconds) = (report.errors.as_ref(), &report.seconds);
    Row {
        suite,
        case: key.case,
        method: key.variant.method,
        params: params.join("; "),
        dimension: report.dimension,
        unknowns: report.unknowns,
        spacing: report.spacing,
        contrast: report.contrast,
        seed: key.seed,
        err_l2: errors.map(|e| e.l2),
        err_linf: errors.map(|e| e.linf),
        err_grad_linf: errors.map(|e| e.gradient_linf),
        order_l2: None,
        order_linf: None,
        iterations: report.solver.iterations,
        residual: report.solver.residual,
        t_points: seconds.points,
        t_neighbors: seconds.neighbors,
        t_stencils: seconds.stencils,
        t_assembly: seconds.assembly,
        t_solve: seconds.solve,
        t_total: seconds.total,
        peak_memory_mb: report.peak_memory_mb,
        threads: rayon::current_num_threads(),
    }
}

/// Says that a run begins.
pub(crate) fn announce(suite: &str, key: &Key) {
    let Key { case, variant, jump, level, .. } = key;
    progress(&format!("{suite} {case} {} {jump:e} level {level}", variant.label()));
}

/// Says on a terminal what is being run, on one line that is written over.
pub(crate) fn progress(text: &str) {
    let mut stderr = std::io::stderr();
    if stderr.is_terminal() {
        // A progress line that cannot be written is no reason to stop.
        let _ = write!(stderr, "\r\x1b[2K{text}");
        let _ = stderr.flush();
    }
}
