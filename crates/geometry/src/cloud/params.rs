use std::fmt;
use std::sync::Arc;

use super::sizes::{Size, Sizes};
use crate::error::GeometryError;

/// How nodes are laid out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layout {
    /// A regular grid, divided evenly between the faces of a box.
    Grid,
    /// A grid whose interior nodes are moved at random by up to a quarter of the spacing along each axis.
    Jittered,
    /// The same by up to half the spacing, so that nodes may come arbitrarily near to each other: the irregular clouds of
    /// the literature on particle methods, to see what a method bears.
    Scattered,
    /// Poisson-disk: random, with a smallest distance and without holes.
    Irregular,
}

/// A spacing as a function of position.
pub type SpacingFn<const D: usize> = dyn Fn(&[f64; D]) -> f64 + Send + Sync;

/// The distance between nodes that is aimed at: `s` means about `1 / s^D` nodes a unit of volume.
///
/// In irregular clouds the smallest distance is then 0.895 `s` in 2-D and 0.9 `s` in 3-D (measured), except between
/// nodes on boundary curves, which may come as near as half of `s` in acute corners and narrow gaps; no point of the
/// domain is farther than about 1.1 `s` from a node where the spacing is uniform.
#[derive(Clone)]
pub enum Spacing<const D: usize> {
    /// The same everywhere.
    Uniform(f64),
    /// A function of position; it should change by less than about its half over its own length. Irregular layout
    /// only.
    Graded(Arc<SpacingFn<D>>),
}

impl<const D: usize> Spacing<D> {
    /// The spacing at `x`.
    ///
    /// # Errors
    /// [`GeometryError::InvalidSpacing`] where it is not positive and finite.
    pub fn at(&self, x: &[f64; D]) -> Result<f64, GeometryError> {
        let spacing = match self {
            Self::Uniform(s) => *s,
            Self::Graded(f) => f(x),
        };
        if spacing.is_finite() && spacing > 0.0 {
            return Ok(spacing);
        }
        Err(GeometryError::InvalidSpacing { at: x.to_vec(), spacing })
    }

    /// The largest spacing that is nowhere larger than this one, and at each of the places no larger than asked for there; away from them what
    /// they ask for grows by a quarter of the distance.
    pub fn at_most(self, places: Vec<Size<D>>) -> Self {
        if places.is_empty() {
            return self;
        }
        let sizes = Sizes::new(places);
        // What is no spacing is refused where it is evaluated.
        Self::Graded(Arc::new(move |x: &[f64; D]| {
            self.at(x).map_or(f64::NAN, |largest| sizes.at(x, largest))
        }))
    }
}

impl<const D: usize> fmt::Debug for Spacing<D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Uniform(s) => f.debug_tuple("Uniform").field(s).finish(),
            Self::Graded(_) => f.write_str("Graded"),
        }
    }
}

/// What [`generate`](crate::generate) is asked for.
#[derive(Clone, Debug)]
pub struct CloudParams<const D: usize> {
    /// Distance between nodes.
    pub spacing: Spacing<D>,
    /// Arrangement of the nodes.
    pub layout: Layout,
    /// Seed of the random numbers; the same seed gives the same cloud, bit for bit.
    pub seed: u64,
    /// More nodes than this are an error, found before they are generated.
    pub max_nodes: usize,
}
