//! A diagram as data. This is the one file that knows how diagrams are drawn.

use meshless_output::{Axis, Chart, OutputError, Series};

/// A diagram with logarithmic axes.
#[derive(Debug, Clone)]
pub(crate) struct Figure {
    /// File name without extension.
    pub(crate) name: String,
    pub(crate) caption: String,
    pub(crate) x: &'static str,
    pub(crate) y: &'static str,
    pub(crate) curves: Vec<Curve>,
    /// Draw a line of this slope for comparison.
    pub(crate) slope: Option<f64>,
}

/// A curve of a diagram.
#[derive(Debug, Clone)]
pub(crate) struct Curve {
    pub(crate) label: String,
    pub(crate) points: Vec<(f64, f64)>,
}

/// Size of a diagram in pixels.
const SIZE: (u32, u32) = (760, 420);

impl Figure {
    /// Draws the diagram.
    pub(crate) fn svg(&self) -> Result<String, OutputError> {
        let series = self.curves.iter().map(|c| Series::new(&c.label, c.points.clone())).collect();
        let chart = Chart {
            title: String::new(),
            x: Axis::log(self.x),
            y: Axis::log(self.y),
            series,
            reference_slopes: self.slope.into_iter().collect(),
        };
        chart.to_svg(SIZE.0, SIZE.1)
    }
}
