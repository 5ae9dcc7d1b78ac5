//! The solution along a line: position against value.

use crate::chart::{Axis, Chart, Series, Stroke};
use crate::error::OutputError;

/// Values along a line, coloured by region, beside an exact curve if there is one.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Profile {
    /// Title; none if empty.
    pub title: String,
    /// What the position is.
    pub x_label: String,
    /// What the value is.
    pub u_label: String,
    /// The points `(position, value)` of each region with the region's name, in any order.
    pub regions: Vec<(String, Vec<(f64, f64)>)>,
    /// The exact curve `(position, value)`, in order. A value that is not a number leaves a gap, at a jump for example.
    pub exact: Vec<(f64, f64)>,
}

impl Profile {
    /// Draws the profile as an SVG document of the given size in pixels.
    ///
    /// # Errors
    /// [`OutputError::Size`] if there is no room for the labels.
    pub fn to_svg(&self, width: u32, height: u32) -> Result<String, OutputError> {
        let mut series: Vec<Series> = self
            .regions
            .iter()
            .map(|(name, points)| {
                let mut points = points.clone();
                points.sort_by(|a, b| a.0.total_cmp(&b.0));
                Series { name: name.clone(), points, stroke: Stroke::Markers }
            })
            .collect();
        if !self.exact.is_empty() {
            series.push(Series {
                name: "exact".to_owned(),
                points: self.exact.clone(),
                stroke: Stroke::Curve,
            });
        }
        let (x, y) = (Axis::linear(&self.x_label), Axis::linear(&self.u_label));
        Chart { title: self.title.clone(), x, y, series, reference_slopes: Vec::new() }.to_svg(width, height)
    }
}
