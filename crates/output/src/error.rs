//! Why a picture or a file could not be made.

use std::path::PathBuf;

use thiserror::Error;

/// Why a picture or a file could not be made.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum OutputError {
    /// A file could not be written; what was there before is untouched.
    #[error("cannot write {path}")]
    Io {
        /// The file that was to be written.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// A list has another length than the grid or the cloud it belongs to.
    #[error("`{name}` has {found} entries, but {expected} are needed")]
    Length {
        /// Name of the list.
        name: String,
        /// Length needed.
        expected: usize,
        /// Length found.
        found: usize,
    },
    /// A coordinate is not finite.
    #[error("point {index} at {position:?} is not finite")]
    NotFinite {
        /// Number of the point.
        index: usize,
        /// Its position.
        position: Vec<f64>,
    },
    /// A picture is too small to hold its labels.
    #[error(
        "a picture of {width} by {height} pixels is too small or too large; use between 200 and 10000 each way"
    )]
    Size {
        /// Width in pixels.
        width: u32,
        /// Height in pixels.
        height: u32,
    },
    /// The rectangle or grid of a field has no extent.
    #[error(
        "a field needs at least 2 by 2 grid nodes on a rectangle of finite extent, not {nx} by {ny} on {min:?} to {max:?}"
    )]
    Grid {
        /// Number of grid nodes across.
        nx: usize,
        /// Number of grid nodes up.
        ny: usize,
        /// Lower left corner.
        min: [f64; 2],
        /// Upper right corner.
        max: [f64; 2],
    },
    /// The plotting library failed.
    #[error("cannot draw the chart: {0}")]
    Drawing(String),
    /// The VTK library failed.
    #[error("cannot encode the point cloud: {0}")]
    Vtk(String),
}
