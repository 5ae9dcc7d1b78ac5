//! Free space in plans.

use meshless_interfaces::{Discretization, Method, MethodError, Problem};

use super::Steps;
use crate::Error;
use crate::scene::{ExprField, GreenName, Scene};

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
    /// What is transformed, and what is transformed back.
    pub transforms: Transforms,
}

/// Fields that are transformed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Transforms {
    /// Forward: components of the vorticity, 1 in the plane, 3 in space, or none.
    pub vorticity: usize,
    /// Forward: the source.
    pub source: bool,
    /// Back: u.
    pub potential: bool,
    /// Back: its gradient.
    pub gradient: bool,
}

impl Transforms {
    fn of(scene: &Scene) -> Self {
        let nonzero = |f: &ExprField| f.as_constant() != Some(0.0);
        let particles = scene.free_space.as_ref().is_some_and(|s| s.particles.is_some());
        let source = particles || scene.regions.iter().any(|r| r.source.as_ref().is_some_and(nonzero));
        let turns = scene.regions.iter().any(|r| r.vorticity.iter().any(nonzero));
        let exact = scene.regions.iter().all(|r| r.exact.is_some());
        // A velocity alone has no potential; without any source, u is zero all the same.
        let potential = source || exact || !turns;
        Self {
            vorticity: if turns { 2 * scene.dimension - 3 } else { 0 },
            source: source || potential,
            potential,
            gradient: potential && (exact || scene.output.vtu || scene.output.csv),
        }
    }

    /// Names of the fields, forward and back.
    pub(crate) fn names(&self, dimension: usize) -> [Vec<String>; 2] {
        const AXES: [&str; 3] = ["x", "y", "z"];
        let each = |name: &str| (0..dimension).map(|a| format!("{name} {}", AXES[a])).collect::<Vec<_>>();
        let mut forward = match self.vorticity {
            0 => Vec::new(),
            1 => vec!["vorticity".to_owned()],
            _ => each("vorticity"),
        };
        forward.extend(self.source.then(|| "source".to_owned()));
        let mut back = if self.vorticity > 0 { each("velocity") } else { Vec::new() };
        back.extend(self.potential.then(|| "u".to_owned()));
        if self.gradient {
            back.extend(each("gradient"));
        }
        [forward, back]
    }
}

impl FreeSpaceParams {
    /// What the scene says.
    pub(crate) fn of(scene: &Scene) -> Self {
        let spec = scene.free_space.as_ref();
        Self {
            kernel: spec.and_then(|s| s.kernel),
            order: scene.method.order,
            sigma: spec.and_then(|s| s.sigma),
            tolerance: scene.accuracy.as_ref().map(|a| a.tolerance),
            transforms: Transforms::of(scene),
        }
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
