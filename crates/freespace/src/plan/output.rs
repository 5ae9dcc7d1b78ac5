//! What a solve is asked for.

use crate::error::FreeSpaceError;

/// A field that a plan computes; `source` counts the sources that were given, `axis` the directions, 0 for x.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Output {
    /// phi with `-lap phi = source`.
    Potential {
        /// Which source.
        source: usize,
    },
    /// The derivative of phi in a direction.
    Gradient {
        /// Which source.
        source: usize,
        /// Which direction.
        axis: usize,
    },
    /// An estimate of the error of phi, by which it is to be raised: what the next order would add. Gaussian kernels only.
    PotentialError {
        /// Which source.
        source: usize,
    },
    /// The same for a derivative of phi.
    GradientError {
        /// Which source.
        source: usize,
        /// Which direction.
        axis: usize,
    },
    /// A component of `curl psi`, `-lap psi = omega`. In three dimensions sources 0, 1 and 2 are the components of omega;
    /// in two, source 0 is its only one, and the curl is `(d psi/dy, -d psi/dx)`.
    Curl {
        /// Which component.
        axis: usize,
    },
    /// A component of the field with curl omega and divergence theta, `curl psi - grad phi`. The sources are those of
    /// [`Output::Curl`], followed by theta.
    Velocity {
        /// Which component.
        axis: usize,
    },
}

/// A source, or a derivative of it, times a sign.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Term {
    pub(super) source: usize,
    /// Direction of the derivative.
    pub(super) axis: Option<usize>,
    pub(super) sign: f64,
}

/// An output as the sum of terms times the kernel.
#[derive(Debug)]
pub(super) struct Wanted {
    pub(super) terms: Vec<Term>,
    /// The estimate of the error instead of the kernel.
    pub(super) estimate: bool,
    /// Where it is wanted, in spacings from the points.
    pub(super) shift: [f64; 3],
}

impl Output {
    /// Whether it is an estimate.
    pub(super) fn is_estimate(self) -> bool {
        matches!(self, Self::PotentialError { .. } | Self::GradientError { .. })
    }

    /// What the field is the sum of, before it is convolved.
    pub(super) fn terms<const D: usize>(self, sources: usize) -> Result<Vec<Term>, FreeSpaceError> {
        let along = |source, axis, sign| Term { source, axis: Some(axis), sign };
        let terms = match self {
            Self::Potential { source } | Self::PotentialError { source } => {
                vec![Term { source, axis: None, sign: 1.0 }]
            }
            Self::Gradient { source, axis } | Self::GradientError { source, axis } => {
                vec![along(source, axis, 1.0)]
            }
            Self::Curl { axis } => curl::<D>(axis)?,
            Self::Velocity { axis } => {
                let mut terms = curl::<D>(axis)?;
                terms.push(along(if D == 2 { 1 } else { 3 }, axis, -1.0));
                terms
            }
        };
        for term in &terms {
            if term.source >= sources {
                return Err(FreeSpaceError::Output {
                    what: format!("{self:?} needs {} sources, {sources} are given", term.source + 1),
                });
            }
            if term.axis.is_some_and(|a| a >= D) {
                return Err(FreeSpaceError::Output { what: format!("{self:?}: there are {D} directions") });
            }
        }
        Ok(terms)
    }
}

fn curl<const D: usize>(axis: usize) -> Result<Vec<Term>, FreeSpaceError> {
    let along = |source, axis, sign| Term { source, axis: Some(axis), sign };
    match (D, axis) {
        (2, 0) => Ok(vec![along(0, 1, 1.0)]),
        (2, 1) => Ok(vec![along(0, 0, -1.0)]),
        (3, 0..3) => {
            let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
            Ok(vec![along(last, next, 1.0), along(next, last, -1.0)])
        }
        (1, _) => Err(FreeSpaceError::Output { what: "there is no curl in one dimension".to_owned() }),
        _ => Err(FreeSpaceError::Output { what: format!("component {axis} of a curl in {D} dimensions") }),
    }
}
