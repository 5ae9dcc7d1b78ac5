//! What can go wrong between a scene and its solution.

use std::path::PathBuf;

use meshless_freespace::FreeSpaceError;
use meshless_geometry::GeometryError;
use meshless_interfaces::MethodError;
use meshless_neighbors::NeighborError;
use meshless_output::OutputError;
use thiserror::Error;

use crate::scene::SceneError;

/// Why a scene has no solution.
#[derive(Debug, Error)]
pub enum Error {
    /// The scene is wrong: says where and what to do.
    #[error(transparent)]
    Scene(Box<SceneError>),
    /// The cloud is too coarse for what the scene has: says where and what to do.
    #[error(transparent)]
    TooCoarse(Box<SceneError>),
    /// A tolerance that was not met: says what was.
    #[error(transparent)]
    Unmet(Box<SceneError>),
    /// Shapes, domain or cloud.
    #[error("geometry: {0}")]
    Geometry(#[from] GeometryError),
    /// Neighbour lists.
    #[error("neighbour lists: {0}")]
    Neighbors(#[from] NeighborError),
    /// Discretisation or solve.
    #[error("{0}")]
    Method(#[from] MethodError),
    /// Time steps.
    #[error("time steps: {0}")]
    Time(String),
    /// A checkpoint that cannot be gone on from.
    #[error("checkpoint {path}: {reason}")]
    Checkpoint {
        /// The file.
        path: PathBuf,
        /// Why not.
        reason: String,
    },
    /// Whoever watches the progress asked to stop.
    #[error("stopped at t = {t}")]
    Stopped {
        /// Time reached.
        t: f64,
    },
    /// Free space.
    #[error("free space: {0}")]
    FreeSpace(#[from] FreeSpaceError),
    /// Pictures and files.
    #[error("output: {0}")]
    Output(#[from] OutputError),
}

impl From<SceneError> for Error {
    fn from(error: SceneError) -> Self {
        Self::Scene(Box::new(error))
    }
}

impl Error {
    /// Whether the input is at fault, rather than the solve.
    pub fn is_input(&self) -> bool {
        matches!(self, Self::Scene(_) | Self::TooCoarse(_) | Self::Checkpoint { .. })
    }

    /// Whether a finer cloud may help.
    pub fn is_too_coarse(&self) -> bool {
        use MethodError::{Cell, NoFoot, Stencil, ThinLayer, Unresolved};
        matches!(
            self,
            Self::TooCoarse(_)
                | Self::Method(
                    Unresolved { .. }
                        | ThinLayer { .. }
                        | NoFoot { .. }
                        | Stencil { .. }
                        | Cell { .. }
                        | MethodError::Incompatible { .. }
                )
        )
    }
}
