//! What accuracy costs in time, for one scene: every method that can solve it on a ladder of clouds, error against
//! seconds.
//!
//! The error is that against the exact solution where the scene has one, else against the solution of the most accurate
//! method on a cloud finer than all others, by its own estimate; in free space, where it is known from the spectrum of the source, that
//! estimate. Seconds are those from points to solution, without errors, estimates and pictures; short runs are repeated
//! and their median counts.

mod candidates;
mod ladder;
mod reference;
mod show;

use serde::Serialize;

use crate::Error;
use crate::scene::{MethodName, Scene};

pub use show::{chart, table};

/// What to run.
#[derive(Debug, Clone, PartialEq)]
pub struct CostParams {
    /// Only these methods; all that serve the scene if empty.
    pub methods: Vec<MethodName>,
    /// Seconds that the whole may take, about: a ladder ends where its next rung would take longer than its share.
    pub seconds: f64,
}

impl Default for CostParams {
    fn default() -> Self {
        Self { methods: Vec::new(), seconds: 120.0 }
    }
}

/// A run of a ladder.
#[derive(Debug, Clone, Default, Serialize)]
pub struct CostRun {
    /// Name of the method.
    pub method: String,
    /// Order of its polynomials; 0 for a kernel of free space that has none.
    pub order: usize,
    /// Typical distance of nodes.
    pub spacing: f64,
    /// Nodes whose value was solved for.
    pub unknowns: usize,
    /// Relative L2 error.
    pub error: Option<f64>,
    /// Wall-clock seconds from points to solution.
    pub seconds: f64,
    /// Whether no other run is more accurate in less time.
    pub best_buy: bool,
    /// Why there is no error.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub why: Option<String>,
}

impl CostRun {
    /// Method and order as one name.
    pub fn label(&self) -> String {
        if self.order == 0 { self.method.clone() } else { format!("{}, order {}", self.method, self.order) }
    }
}

/// Error against seconds.
#[derive(Debug, Clone, Default, Serialize)]
pub struct CostReport {
    /// Title of the scene.
    pub title: String,
    /// 1, 2 or 3.
    pub dimension: usize,
    /// What errors are measured against.
    pub reference: String,
    /// Estimated error of that; smaller ones in the table mean nothing. Absent for an exact solution.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reference_error: Option<f64>,
    /// The runs, by method and order, then from coarse to fine.
    pub runs: Vec<CostRun>,
}

/// Runs the ladders; `each` is told every run as it ends.
///
/// # Errors
///
/// Those of a scene that is wrong, or that none of the methods can solve. What a method cannot do, or a cloud too coarse
/// for it, is said in its run.
pub fn cost(scene: &Scene, params: &CostParams, each: &mut dyn FnMut(&CostRun)) -> Result<CostReport, Error> {
    if let Some(file) = &scene.points.file {
        let help = "the report of `meshless solve` has an estimate of the error";
        return Err(file.place.error("points from a file have no ladder of spacings", help).into());
    }
    let mut report = match (scene.free_space.is_some(), scene.dimension) {
        (true, _) => ladder::free_space(scene, params, each)?,
        (_, 1) => ladder::bounded::<1>(scene, params, each)?,
        (_, 2) => ladder::bounded::<2>(scene, params, each)?,
        _ => ladder::bounded::<3>(scene, params, each)?,
    };
    mark_best_buys(&mut report);
    Ok(report)
}

/// Errors below that of the reference say nothing and buy nothing.
fn mark_best_buys(report: &mut CostReport) {
    let floor = report.reference_error.unwrap_or(0.0);
    let priced: Vec<(f64, f64)> = (report.runs.iter())
        .map(|run| (run.error.map_or(f64::INFINITY, |e| e.max(floor)), run.seconds))
        .collect();
    for (run, &(error, seconds)) in report.runs.iter_mut().zip(&priced) {
        let beaten = |&(e, s): &(f64, f64)| (e <= error && s < seconds) || (e < error && s <= seconds);
        run.best_buy = error.is_finite() && !priced.iter().any(beaten);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_run_that_is_slower_and_worse_is_no_best_buy() {
        let run = |error, seconds| CostRun { error, seconds, ..CostRun::default() };
        let runs = vec![
            run(Some(1e-2), 0.1),
            run(Some(1e-4), 1.0),
            run(Some(1e-3), 2.0),
            run(None, 0.01),
            run(Some(1e-9), 3.0),
            run(Some(1e-7), 2.5),
        ];
        let mut report = CostReport { runs, reference_error: Some(1e-6), ..CostReport::default() };
        mark_best_buys(&mut report);
        let marks: Vec<bool> = report.runs.iter().map(|r| r.best_buy).collect();
        assert_eq!(marks, [true, true, false, false, false, true]);
    }
}
