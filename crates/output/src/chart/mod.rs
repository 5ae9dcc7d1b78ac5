//! Line charts with logarithmic or linear axes.

mod draw;
mod frame;

use crate::error::OutputError;

/// How an axis is divided.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Scale {
    /// Logarithmic; points that are not positive cannot be shown and leave a gap.
    #[default]
    Log,
    /// Linear.
    Linear,
}

/// An axis: its label and how it is divided.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Axis {
    /// What is shown along the axis, with its unit.
    pub label: String,
    /// Logarithmic or linear.
    pub scale: Scale,
}

impl Axis {
    /// A logarithmic axis.
    pub fn log(label: impl Into<String>) -> Self {
        Self { label: label.into(), scale: Scale::Log }
    }

    /// A linear axis.
    pub fn linear(label: impl Into<String>) -> Self {
        Self { label: label.into(), scale: Scale::Linear }
    }
}

/// What is drawn of a series.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Stroke {
    /// A line through the points, and a marker at each.
    #[default]
    LineAndMarkers,
    /// A line only, for curves with many points.
    Line,
    /// Markers only, for scattered points.
    Markers,
    /// A thin dark line beneath everything else, for an exact solution.
    Curve,
}

impl Stroke {
    fn has_line(self) -> bool {
        self != Self::Markers
    }

    fn has_markers(self) -> bool {
        matches!(self, Self::LineAndMarkers | Self::Markers)
    }
}

/// A named list of points.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Series {
    /// Name in the legend; a series without a name is not listed there.
    pub name: String,
    /// The points, in the order in which the line runs.
    pub points: Vec<(f64, f64)>,
    /// Line, markers or both.
    pub stroke: Stroke,
}

impl Series {
    /// A line with markers.
    pub fn new(name: impl Into<String>, points: Vec<(f64, f64)>) -> Self {
        Self { name: name.into(), points, stroke: Stroke::LineAndMarkers }
    }
}

/// A chart of several series.
///
/// Every series has a colour that colour-blind readers tell apart and a marker of its own, so that the chart can be
/// read in black and white. The legend stands beside the data.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Chart {
    /// Title; none if empty.
    pub title: String,
    /// Horizontal axis.
    pub x: Axis,
    /// Vertical axis.
    pub y: Axis,
    /// The series. Points that are not finite, or not positive on a logarithmic axis, leave a gap in the line.
    pub series: Vec<Series>,
    /// Orders to compare with: a dashed line `y = C x^order` below the data for each. Only on two logarithmic axes.
    pub reference_slopes: Vec<f64>,
}

impl Chart {
    /// Draws the chart as an SVG document of the given size in pixels. A chart without points says so.
    ///
    /// # Errors
    /// [`OutputError::Size`] if there is no room for the labels.
    ///
    /// ```
    /// use meshless_output::{Axis, Chart, Series};
    ///
    /// let chart = Chart {
    ///     title: "Two strips, contrast 1e6".to_owned(),
    ///     x: Axis::log("h"),
    ///     y: Axis::log("relative error"),
    ///     series: vec![Series::new("conservative", vec![(0.2, 4e-2), (0.1, 1e-2), (0.05, 2.4e-3)])],
    ///     reference_slopes: vec![2.0],
    /// };
    /// assert!(chart.to_svg(640, 420)?.starts_with("<svg"));
    /// # Ok::<(), meshless_output::OutputError>(())
    /// ```
    pub fn to_svg(&self, width: u32, height: u32) -> Result<String, OutputError> {
        if !(200..=10_000).contains(&width) || !(200..=10_000).contains(&height) {
            return Err(OutputError::Size { width, height });
        }
        draw::chart(self, width, height)
    }
}
