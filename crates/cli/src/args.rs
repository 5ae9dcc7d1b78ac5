//! The command line.

use std::path::{Path, PathBuf};

use clap::{Parser, Subcommand};
use meshless::Overrides;
use meshless::scene::Scene;

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
    /// Relative L2 error to reach (not supported yet).
    #[arg(long)]
    pub(crate) tolerance: Option<f64>,
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
}

impl InsteadArgs {
    /// The scene of a file with these values in it.
    pub(crate) fn read(&self, file: &Path) -> Result<Scene, Failure> {
        let mut scene = Scene::read(file).map_err(meshless::Error::from)?;
        let overrides =
            Overrides { method: self.method.as_deref(), order: self.order, spacing: self.spacing.as_deref() };
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
