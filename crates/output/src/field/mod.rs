//! Pictures of a scalar field on a plane rectangle.

mod draw;
mod frame;
mod levels;

use crate::contour::Domain;
use crate::error::OutputError;

/// A point of interest that is marked and named in a picture.
#[derive(Debug, Clone, PartialEq)]
pub struct Probe {
    /// Name beside the mark.
    pub name: String,
    /// Position.
    pub at: [f64; 2],
}

/// Filled contours of a scalar field that was sampled on a regular grid over a rectangle.
///
/// Grid node `(i, j)` lies at `min + (i hx, j hy)` and has number `j nx + i`.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FieldPicture {
    /// Title; none if empty.
    pub title: String,
    /// Lower left corner of the rectangle.
    pub min: [f64; 2],
    /// Upper right corner.
    pub max: [f64; 2],
    /// Number of grid nodes across, both ends included.
    pub nx: usize,
    /// Number of grid nodes up, both ends included.
    pub ny: usize,
    /// Value at each grid node; not a number where there is none, outside the domain for example.
    pub values: Vec<f64>,
    /// Region of each grid node. Values are not joined across regions, so that jumps stay sharp; regions whose interface
    /// is not given as a level set meet half-way between the nodes.
    pub labels: Option<Vec<u16>>,
    /// Level set of the domain at each grid node, negative inside: the picture is clipped where it is zero.
    pub mask: Option<Vec<f64>>,
    /// Level sets of the interfaces at each grid node: lines are drawn where they are zero, and regions meet there.
    pub interfaces: Vec<Vec<f64>>,
    /// Slits: open polylines that values are not joined across, drawn as lines.
    pub cuts: Vec<Vec<[f64; 2]>>,
    /// Number of bands, about: their bounds are round numbers.
    pub contours: usize,
    /// Whether the bands are even in the logarithm; values that are not positive then belong to the lowest band.
    pub log: bool,
    /// Nodes to be shown as dots.
    pub nodes: Vec<[f64; 2]>,
    /// Points of interest to be marked and named.
    pub probes: Vec<Probe>,
}

impl FieldPicture {
    /// A picture with about twelve bands, without anything else.
    pub fn new(
        title: impl Into<String>,
        min: [f64; 2],
        max: [f64; 2],
        nx: usize,
        ny: usize,
        values: Vec<f64>,
    ) -> Self {
        Self { title: title.into(), min, max, nx, ny, values, contours: 12, ..Self::default() }
    }

    /// Draws the picture as an SVG document of the given width in pixels; the height follows from the rectangle, whose
    /// two directions have the same scale. A field without values says so.
    ///
    /// # Errors
    /// [`OutputError::Grid`] or [`OutputError::Length`] if the grid is none or a list does not belong to it,
    /// [`OutputError::Size`] if there is no room for the labels.
    pub fn to_svg(&self, width: u32) -> Result<String, OutputError> {
        self.check()?;
        if !(200..=10_000).contains(&width) {
            return Err(OutputError::Size { width, height: width });
        }
        Ok(draw::picture(self, width))
    }

    fn check(&self) -> Result<(), OutputError> {
        let &Self { min, max, nx, ny, .. } = self;
        let extended = (0..2).all(|axis| min[axis] < max[axis] && (max[axis] - min[axis]).is_finite());
        if nx < 2 || ny < 2 || !extended {
            return Err(OutputError::Grid { nx, ny, min, max });
        }
        let length = |name: &str, found: usize| {
            let expected = nx * ny;
            if found == expected {
                Ok(())
            } else {
                Err(OutputError::Length { name: name.to_owned(), expected, found })
            }
        };
        length("values", self.values.len())?;
        length("labels", self.labels.as_ref().map_or(nx * ny, Vec::len))?;
        length("mask", self.mask.as_ref().map_or(nx * ny, Vec::len))?;
        self.interfaces.iter().try_for_each(|level| length("interfaces", level.len()))
    }

    /// The slits in units of the grid.
    fn cuts_on_grid(&self) -> Vec<Vec<[f64; 2]>> {
        let counts = [self.nx, self.ny];
        let on_grid = |x: &[f64; 2]| {
            std::array::from_fn(|k| {
                (x[k] - self.min[k]) / (self.max[k] - self.min[k]) * (counts[k] - 1) as f64
            })
        };
        self.cuts.iter().map(|line| line.iter().map(on_grid).collect()).collect()
    }

    fn domain<'a>(&'a self, values: &'a [f64], cuts: &'a [Vec<[f64; 2]>]) -> Domain<'a> {
        Domain {
            nx: self.nx,
            ny: self.ny,
            values,
            labels: self.labels.as_deref(),
            mask: self.mask.as_deref(),
            interfaces: &self.interfaces,
            cuts,
        }
    }
}
