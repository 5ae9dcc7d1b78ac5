//! Pictures and files of scattered fields: charts, profiles and contour pictures as SVG, point clouds as VTK.
//!
//! - [`Chart`]: lines on logarithmic or linear axes, for convergence studies;
//! - [`Profile`]: values along a line, by region, beside an exact curve;
//! - [`FieldPicture`]: filled contours of a field on a plane rectangle, clipped to a smooth domain, sharp at interfaces;
//! - [`write_vtu`]: a point cloud with its values, for ParaView;
//! - [`write_text_atomically`]: text files that are complete or not there.
//!
//! Pictures are returned as text; nothing is written unless asked for, and then completely or not at all. The crate is
//! *not* for interactive or three-dimensional graphics, and it does not interpolate: fields come sampled on a grid.
//!
//! ```
//! use meshless_output::FieldPicture;
//!
//! let n = 41;
//! let at = |k: usize| k as f64 / (n - 1) as f64;
//! let values = (0..n * n).map(|k| (3.0 * at(k % n)).sin() * at(k / n)).collect();
//! let svg = FieldPicture::new("u", [0.0, 0.0], [1.0, 1.0], n, n, values).to_svg(560)?;
//! assert!(svg.starts_with("<svg") && svg.ends_with("</svg>\n"));
//! # Ok::<(), meshless_output::OutputError>(())
//! ```

mod chart;
mod color;
mod contour;
mod error;
mod field;
mod file;
mod profile;
mod svg;
mod ticks;
mod vtu;

pub use chart::{Axis, Chart, Scale, Series, Stroke};
pub use error::OutputError;
pub use field::{FieldPicture, Probe};
pub use file::write_text_atomically;
pub use profile::Profile;
pub use vtu::{VtuField, VtuValues, write_vtu};
