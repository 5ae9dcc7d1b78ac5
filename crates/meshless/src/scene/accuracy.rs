//! `[accuracy]`: an error to reach instead of a spacing to use.

use std::sync::Arc;

use super::error::SceneError;
use super::reader::Table;
use super::source::{Place, Source};
use super::spec::{BoundsSpec, DomainSpec, ShapeSpec};

/// Nodes of the finest cloud, by dimension, unless the scene says otherwise.
const MAX_NODES: [u64; 3] = [100_000, 1_000_000, 300_000];

/// Nodes of the first cloud, about, by dimension, where the scene gives no spacing to begin with.
const FIRST_NODES: [f64; 3] = [30.0, 400.0, 2000.0];

/// A tolerance of this size asks for nothing.
const LARGEST: f64 = 1.0;

/// What round-off leaves of the error at least, for every node on the way across the first cloud: twice its unit, as the estimate
/// must be below half of the tolerance. Rows in difference form lose this much, and not what the conditioning of the system says,
/// the square of that number: with 30 nodes on the line the estimates of `sharp` are 7e-15 to 6e-14, whatever its order.
const ROUND_OFF: f64 = 2.0 * f64::EPSILON;

/// What a tolerance is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum AccuracyOf {
    /// `u`: the relative L2 error.
    #[default]
    U,
    /// `fluxes`: the largest error of a flux through a condition or an interface, over the largest of these fluxes.
    Fluxes,
    /// `probes`: the largest error of a probe, over the largest value of u.
    Probes,
}

impl AccuracyOf {
    const ALL: [(&'static str, Self); 3] =
        [("u", Self::U), ("fluxes", Self::Fluxes), ("probes", Self::Probes)];

    /// As scenes and reports have it.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::U => "u",
            Self::Fluxes => "fluxes",
            Self::Probes => "probes",
        }
    }
}

/// An error to reach.
#[derive(Debug, Clone)]
pub struct AccuracySpec {
    /// Relative error, positive and below 1.
    pub tolerance: f64,
    /// What it is about.
    pub of: AccuracyOf,
    /// Nodes of the finest cloud that may be tried.
    pub max_nodes: u64,
    /// The value in the file.
    pub place: Place,
}

impl AccuracySpec {
    /// A tolerance that the command line gives in place of the scene's.
    pub(crate) fn from_command_line(
        tolerance: f64,
        dimension: usize,
        scene: Option<&Self>,
    ) -> Result<Self, SceneError> {
        let text = tolerance.to_string();
        let span = 0..text.len();
        let place = Place::new(&Arc::new(Source::new("command line", &text)), "--tolerance", span);
        let max_nodes = scene.map_or(MAX_NODES[dimension - 1], |spec| spec.max_nodes);
        let of = scene.map_or(AccuracyOf::U, |spec| spec.of);
        Self { tolerance, of, max_nodes, place }.checked(dimension)
    }

    fn checked(self, dimension: usize) -> Result<Self, SceneError> {
        if !(self.tolerance > 0.0 && self.tolerance < LARGEST) {
            let message = format!("expected a relative error above 0 and below 1, found {}", self.tolerance);
            return Err(self.place.error(message, ""));
        }
        let across = FIRST_NODES[dimension - 1].powf(1.0 / dimension as f64);
        let least = ROUND_OFF * across;
        if self.tolerance < least {
            let message = format!(
                "a relative error of {:.1e} is beyond double precision: with {across:.0} nodes across, round-off alone leaves \
                 about {least:.1e}",
                self.tolerance
            );
            return Err(self
                .place
                .error(message, "ask for 1e-12 or more: what is smooth can be solved to that"));
        }
        Ok(self)
    }
}

pub(super) fn accuracy(root: &Table<'_>) -> Result<Option<AccuracySpec>, SceneError> {
    let Some(value) = root.get("accuracy") else { return Ok(None) };
    let table = value.subtable(&["tolerance", "max_nodes", "of"])?;
    let tolerance = table.require("tolerance")?;
    let max_nodes = match table.get("max_nodes") {
        Some(value) => value.integer(1, crate::MAX_NODES as u64)?,
        None => MAX_NODES[value.dimension - 1],
    };
    let of = match table.get("of") {
        Some(of) => of.one_of(&AccuracyOf::ALL)?,
        None => AccuracyOf::U,
    };
    if let (AccuracyOf::Probes, false, Some(key)) = (of, root.has("probes"), table.get("of")) {
        return Err(
            key.error("there are no probes", "add [[probes]] with `at`, or ask for \"u\" or \"fluxes\"")
        );
    }
    let spec = AccuracySpec { tolerance: tolerance.number()?, of, max_nodes, place: tolerance.place };
    spec.checked(value.dimension).map(Some)
}

/// The spacing to begin with: a few hundred nodes in the box round the domain. `None` where that box is not known.
pub(super) fn first_spacing(domain: &DomainSpec, dimension: usize) -> Option<f64> {
    let bounds = domain.bounds.clone().or_else(|| hull(&domain.shape))?;
    let volume: f64 = bounds.min.iter().zip(&bounds.max).map(|(low, high)| high - low).product();
    Some((volume / FIRST_NODES[dimension - 1]).powf(1.0 / dimension as f64))
}

/// A box that holds the shape.
fn hull(shape: &ShapeSpec) -> Option<BoundsSpec> {
    match shape {
        ShapeSpec::Box(bounds) => Some(bounds.clone()),
        ShapeSpec::Sphere { center, radius } => Some(BoundsSpec {
            min: center.iter().map(|c| c - radius).collect(),
            max: center.iter().map(|c| c + radius).collect(),
        }),
        ShapeSpec::Cylinder { point, radius, length, .. } => {
            let reach = radius.hypot((*length)? / 2.0);
            Some(BoundsSpec {
                min: point.iter().map(|c| c - reach).collect(),
                max: point.iter().map(|c| c + reach).collect(),
            })
        }
        ShapeSpec::Polygon(vertices) => {
            let ends = |pick: fn(f64, f64) -> f64| {
                (0..2).map(|k| vertices.iter().map(|v| v[k]).reduce(pick)).collect::<Option<Vec<f64>>>()
            };
            Some(BoundsSpec { min: ends(f64::min)?, max: ends(f64::max)? })
        }
        ShapeSpec::Union(parts) => parts.iter().map(hull).reduce(|a, b| {
            let (a, b) = (a?, b?);
            let pick = |x: &[f64], y: &[f64], pick: fn(f64, f64) -> f64| {
                x.iter().zip(y).map(|(x, y)| pick(*x, *y)).collect::<Vec<f64>>()
            };
            Some(BoundsSpec { min: pick(&a.min, &b.min, f64::min), max: pick(&a.max, &b.max, f64::max) })
        })?,
        ShapeSpec::Intersection(parts) => parts.iter().find_map(hull),
        ShapeSpec::Difference(parts) => parts.first().and_then(hull),
        _ => None,
    }
}
