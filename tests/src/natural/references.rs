//! Reference figures, from `tests/references/natural.csv`: closed forms and high-order finite elements that are refined
//! towards corners. The scripts beside the table made it.

use std::sync::OnceLock;

/// What a figure is of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// u at a point of a region.
    Value,
    /// Root mean square of u over a region.
    Rms,
    /// The integral of `eta du/dn` over the part of a condition, n out of the domain: what enters.
    Flux,
}

/// A row of the table.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    /// The problem.
    pub case: &'static str,
    /// What the problem varies, mostly a diffusivity.
    pub parameter: f64,
    /// What it is of.
    pub quantity: Quantity,
    /// The region, or the condition.
    pub name: &'static str,
    /// The point; empty where there is none.
    pub at: Vec<f64>,
    /// The figure.
    pub value: f64,
    /// By how much two computations of it differ.
    pub uncertainty: f64,
}

const TABLE: &str = include_str!("../../references/natural.csv");

/// All figures.
pub fn table() -> &'static [Figure] {
    static ROWS: OnceLock<Vec<Figure>> = OnceLock::new();
    ROWS.get_or_init(|| {
        let row = |(number, line)| {
            figure(line).unwrap_or_else(|| panic!("line {} of natural.csv is no figure: {line}", number + 1))
        };
        TABLE.lines().enumerate().skip(1).map(row).collect()
    })
}

/// The figures of a problem.
pub fn of(case: &str, parameter: f64) -> impl Iterator<Item = &'static Figure> {
    table().iter().filter(move |f| f.case == case && f.parameter == parameter)
}

fn figure(line: &'static str) -> Option<Figure> {
    // The last column says where the figure is from; it alone may have commas.
    let [case, parameter, quantity, name, at, value, uncertainty, _] =
        line.splitn(8, ',').collect::<Vec<_>>().try_into().ok()?;
    Some(Figure {
        case,
        parameter: parameter.parse().ok()?,
        quantity: match quantity {
            "u" => Quantity::Value,
            "rms" => Quantity::Rms,
            "flux" => Quantity::Flux,
            _ => return None,
        },
        name,
        at: at.split_whitespace().map(|x| x.parse().ok()).collect::<Option<_>>()?,
        value: value.parse().ok()?,
        uncertainty: uncertainty.parse().ok()?,
    })
}

#[cfg(test)]
mod tests {
    use super::{Quantity, of, table};

    #[test]
    fn every_problem_has_points_and_every_figure_is_known_well() {
        for figure in table() {
            let values = of(figure.case, figure.parameter).filter(|f| f.quantity != Quantity::Rms).count();
            assert!(values > 0, "{}: nothing to compare with", figure.case);
            // Mean squares are integrals over the singularities themselves; what a standard allows is a hundredth. In space meshes towards edges
            // grow fast, and solutions are compared that are off by percents.
            let limit = match figure.quantity {
                Quantity::Rms => 1e-3,
                _ if figure.case == "iso-10211-4" => 1.01e-2,
                _ if figure.at.len() == 3 => 5e-4,
                _ => 1e-5,
            };
            assert!(
                figure.value.is_finite() && figure.uncertainty <= limit * figure.value.abs(),
                "{figure:?}"
            );
        }
    }
}
