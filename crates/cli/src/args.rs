//! The command line.

use std::path::{Path, PathBuf};

use clap::{Parser, Subcommand};
use meshless::Overrides;
use meshless::scene::{Given, Scene};

use crate::Failure;

/// Solves elliptic interface problems on point clouds.
#[derive(Debug, Parser)]
#[command(name = "meshless", version, arg_required_else_help = true)]
pub(crate) struct Args {
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Solve a scene.
    Solve(SolveArgs),
    /// Show what a scene calls for and how it would be solved, without solving it.
    Plan(PlanArgs),
    /// Show what accuracy costs in time: run the methods that serve the scene on a ladder of clouds.
    Cost(CostArgs),
    /// List the methods, their orders, dimensions and limits.
    Methods,
}

#[derive(Debug, clap::Args)]
pub(crate) struct SolveArgs {
    /// The scene file.
    pub(crate) scene: PathBuf,
    /// Folder for output files; made if it does not exist.
    #[arg(long, default_value = "meshless-out")]
    pub(crate) out: PathBuf,
    /// Print one JSON object on standard output, and nothing else there.
    #[arg(long)]
    pub(crate) json: bool,
    #[command(flatten)]
    pub(crate) instead: InsteadArgs,
    /// File to keep an unsteady run in; if it exists the run goes on from it, to the same result.
    #[arg(long)]
    pub(crate) checkpoint: Option<PathBuf>,
    /// Threads to use; all cores by default. Results do not depend on it.
    #[arg(long)]
    pub(crate) threads: Option<usize>,
}

/// What takes the place of the scene's own values.
#[derive(Debug, clap::Args)]
pub(crate) struct InsteadArgs {
    /// Method to use instead of the scene's.
    #[arg(long)]
    pub(crate) method: Option<String>,
    /// Order to use instead of the scene's.
    #[arg(long)]
    pub(crate) order: Option<usize>,
    /// Spacing to use instead of the scene's: a number, or an expression of position.
    #[arg(long, allow_hyphen_values = true)]
    pub(crate) spacing: Option<String>,
    /// Relative L2 error to reach: the spacing is refined until the estimate says so.
    #[arg(long, allow_hyphen_values = true)]
    pub(crate) tolerance: Option<f64>,
}

impl InsteadArgs {
    /// The scene of a file with these values in it.
    pub(crate) fn read(&self, file: &Path) -> Result<Scene, Failure> {
        let given = match (&self.spacing, self.tolerance) {
            (Some(_), _) => Given::Spacing,
            (None, Some(_)) => Given::Tolerance,
            (None, None) => Given::Nothing,
        };
        let mut scene = Scene::read_given(file, given).map_err(meshless::Error::from)?;
        let overrides = Overrides {
            method: self.method.as_deref(),
            order: self.order,
            spacing: self.spacing.as_deref(),
            tolerance: self.tolerance,
        };
        overrides.apply(&mut scene).map_err(|e| Failure::input(format!("error: {e}")))?;
        Ok(scene)
    }
}

#[derive(Debug, clap::Args)]
pub(crate) struct PlanArgs {
    /// The scene file.
    pub(crate) scene: PathBuf,
    /// Print one JSON object on standard output, and nothing else there.
    #[arg(long)]
    pub(crate) json: bool,
    #[command(flatten)]
    pub(crate) instead: InsteadArgs,
}

#[derive(Debug, clap::Args)]
pub(crate) struct CostArgs {
    /// The scene file.
    pub(crate) scene: PathBuf,
    /// Folder for the diagram and the table; made if it does not exist.
    #[arg(long, default_value = "meshless-out")]
    pub(crate) out: PathBuf,
    /// Print one JSON object on standard output, and nothing else there.
    #[arg(long)]
    pub(crate) json: bool,
    /// Only this method; may be given several times.
    #[arg(long)]
    pub(crate) method: Vec<String>,
    /// Finest spacing of the ladder, instead of the scene's: a number, or an expression of position.
    #[arg(long, allow_hyphen_values = true)]
    pub(crate) spacing: Option<String>,
    /// Seconds that all of it may take, about.
    #[arg(long, default_value_t = 120.0)]
    pub(crate) seconds: f64,
    /// Threads to use; all cores by default.
    #[arg(long)]
    pub(crate) threads: Option<usize>,
}

impl CostArgs {
    /// The scene of the file.
    pub(crate) fn read(&self) -> Result<Scene, Failure> {
        let instead =
            InsteadArgs { method: None, order: None, spacing: self.spacing.clone(), tolerance: None };
        instead.read(&self.scene)
    }
}
