//! Error against seconds as a diagram and as a table.

use meshless_output::{Axis, Chart, OutputError, Series};

use super::CostReport;

/// Size of the diagram in pixels.
const SIZE: (u32, u32) = (820, 460);

/// Error against seconds, a line for each method and order, as SVG.
///
/// # Errors
/// Those of the drawing.
pub fn chart(report: &CostReport) -> Result<String, OutputError> {
    let mut series: Vec<Series> = Vec::new();
    for run in &report.runs {
        let label = run.label();
        let point = run.error.map(|error| (run.seconds, error));
        match series.iter_mut().find(|s| s.name == label) {
            Some(found) => found.points.extend(point),
            None => series.push(Series::new(label, point.into_iter().collect())),
        }
    }
    series.retain(|s| !s.points.is_empty());
    let chart = Chart {
        title: report.title.clone(),
        x: Axis::log("seconds from points to solution"),
        y: Axis::log("relative L2 error"),
        series,
        reference_slopes: Vec::new(),
    };
    chart.to_svg(SIZE.0, SIZE.1)
}

/// The runs as comma-separated values with a line of names.
pub fn table(report: &CostReport) -> String {
    let mut text = "method,order,spacing,unknowns,error,seconds,best_buy\n".to_owned();
    for run in &report.runs {
        let error = run.error.map(|e| format!("{e:e}")).unwrap_or_default();
        // A kernel's name has a comma.
        let method = run.method.replace(',', ";");
        text += &format!(
            "{method},{},{:e},{},{error},{:e},{}\n",
            run.order, run.spacing, run.unknowns, run.seconds, run.best_buy
        );
    }
    text
}
