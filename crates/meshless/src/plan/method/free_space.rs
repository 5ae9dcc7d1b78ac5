//! Free space in plans.

use meshless_interfaces::{Discretization, Method, MethodError, Problem};

use super::Steps;
use crate::Error;
use crate::scene::{GreenName, Scene};

/// How the problem is convolved; what is `None` follows from the spectrum of the source.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FreeSpaceParams {
    /// The Green's function.
    pub kernel: Option<GreenName>,
    /// Order of a Gaussian kernel.
    pub order: Option<usize>,
    /// Smoothing radius of a Gaussian kernel over the spacing.
    pub sigma: Option<f64>,
    /// Relative L2 error to reach.
    pub tolerance: Option<f64>,
}

pub(super) fn params(scene: &Scene) -> FreeSpaceParams {
    let spec = scene.free_space.as_ref();
    FreeSpaceParams {
        kernel: spec.and_then(|s| s.kernel),
        order: scene.method.order,
        sigma: spec.and_then(|s| s.sigma),
        tolerance: scene.accuracy.as_ref().map(|a| a.tolerance),
    }
}

/// The method that the command line names may not go with the domain.
pub(super) fn check(scene: &Scene) -> Result<(), Error> {
    if scene.free_space.is_some() {
        return Ok(());
    }
    let message = "the method \"free-space\" is for free space, and the domain is bounded";
    Err(scene.domain.place.error(message, "give the domain as `free_space`, or take another method").into())
}

pub(super) fn steps() -> Steps {
    Steps {
        stencils: false,
        no_stencils: "the problem is solved by convolution",
        selection: false,
        constrained: None,
        cells: 0.0,
        may_need_cells: false,
    }
}

/// There is no linear system in free space; the execution of its scenes never asks for one.
pub(super) struct NoRows;

impl<const D: usize> Method<D> for NoRows {
    fn discretize(&self, _problem: &Problem<'_, D>) -> Result<Discretization, MethodError> {
        Err(MethodError::Unsupported {
            method: "free-space",
            what: "solve on a cloud of nodes",
            instead: "give the domain as `free_space`, or take another method",
        })
    }
}
