//! The spatial methods as plans see them: one file for each family, one variant of [`MethodParams`] for each.

mod dcpse;
mod free_space;
mod gfdm;
mod particle_difference;
mod sharp;

pub use free_space::{FreeSpaceParams, Transforms};
use meshless_interfaces::Method;
use meshless_interfaces::dcpse::{ImmersedInterface, ImmersedParams, ReactionParams, SurfaceReaction};
use meshless_interfaces::gfdm::{Gfdm, GfdmParams, Selection};
use meshless_interfaces::particle_difference::{
    ParticleDifference, ParticleDifferenceExtended, ParticleDifferenceParams,
};
use meshless_interfaces::sharp::{Sharp, SharpParams};

use super::effects::Survey;
use crate::Error;
use crate::scene::{MethodName, Scene};

/// Parameters of the spatial method.
#[derive(Debug, Clone, PartialEq)]
pub enum MethodParams {
    /// Generalised finite differences: classical, positive, hybrid and conservative.
    Gfdm(GfdmParams),
    /// Interface-immersed particle differences.
    ParticleDifference(ParticleDifferenceParams),
    /// The same with the jumps of the slope as unknowns.
    ParticleDifferenceExtended(ParticleDifferenceParams),
    /// Convolution on a mesh in free space.
    FreeSpace(FreeSpaceParams),
    /// DC-PSE operators with immersed interfaces.
    ImmersedInterface(ImmersedParams),
    /// Sharp fits of high order.
    Sharp(SharpParams),
    /// DC-PSE operators with smeared interfaces.
    SurfaceReaction(ReactionParams),
}

/// What a method builds; decides its stages and what they are expected to cost.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Steps {
    /// Least-squares stencils.
    pub(super) stencils: bool,
    /// Why there are none, if there are none.
    pub(super) no_stencils: &'static str,
    /// A search for the nodes that need another row than the rest.
    pub(super) selection: bool,
    /// Stencils that interface conditions are built into; `None` for methods that have no such stencils.
    pub(super) constrained: Option<bool>,
    /// Share of the nodes that need a Voronoi cell, about.
    pub(super) cells: f64,
    /// Cells are needed at least on the boundary, or may turn out to be.
    pub(super) may_need_cells: bool,
}

/// What a scene asks of a method that it does not do.
pub(super) fn check(name: MethodName, scene: &Scene) -> Result<(), Error> {
    match name {
        MethodName::Sharp => sharp::check(scene),
        MethodName::FreeSpace => free_space::check(scene),
        _ => Ok(()),
    }
}

impl MethodParams {
    /// The parameters of the method `name` in a scene. The only place, with [`Self::build`], that knows all families.
    pub(super) fn new(name: MethodName, scene: &Scene, survey: &Survey) -> Self {
        match name {
            MethodName::ParticleDifference => Self::ParticleDifference(particle_difference::params(scene)),
            MethodName::ParticleDifferenceExtended => {
                Self::ParticleDifferenceExtended(particle_difference::extended(scene))
            }
            MethodName::ImmersedInterface => Self::ImmersedInterface(dcpse::immersed(scene)),
            MethodName::Sharp => Self::Sharp(sharp::params(scene)),
            MethodName::SurfaceReaction => Self::SurfaceReaction(dcpse::reaction(scene)),
            MethodName::FreeSpace => Self::FreeSpace(FreeSpaceParams::of(scene)),
            _ => Self::Gfdm(gfdm::params(name, scene, survey)),
        }
    }

    /// The spatial method itself.
    pub fn build<const D: usize>(&self) -> Box<dyn Method<D>> {
        match self {
            Self::Gfdm(params) => Box::new(Gfdm { params: *params }),
            Self::ParticleDifference(params) => Box::new(ParticleDifference { params: *params }),
            Self::ParticleDifferenceExtended(params) => {
                Box::new(ParticleDifferenceExtended { params: *params })
            }
            Self::ImmersedInterface(params) => Box::new(ImmersedInterface { params: *params }),
            Self::Sharp(params) => Box::new(Sharp { params: *params }),
            Self::SurfaceReaction(params) => Box::new(SurfaceReaction { params: *params }),
            Self::FreeSpace(_) => Box::new(free_space::NoRows),
        }
    }

    /// The same, with the gradients at the nodes kept with the rows where that saves making the stencils again.
    pub(crate) fn keeping_gradients(&self) -> Self {
        match self {
            Self::Sharp(params) => Self::Sharp(SharpParams { keep_gradients: true, ..*params }),
            params => params.clone(),
        }
    }

    /// Whether the rows take the diffusivity of a region for smooth: a jump within it would be lost. Balances take it as it is at
    /// the nodes.
    pub(crate) fn needs_smooth_diffusivity(&self) -> bool {
        match self {
            Self::Gfdm(params) => params.selection == Selection::None,
            _ => true,
        }
    }

    /// Degree of the polynomials that are reproduced away from interfaces.
    pub fn order(&self) -> usize {
        match self {
            Self::Gfdm(params) => gfdm::order(params),
            Self::ParticleDifference(params) | Self::ParticleDifferenceExtended(params) => params.degree,
            Self::ImmersedInterface(params) => params.order,
            Self::Sharp(params) => params.order,
            Self::SurfaceReaction(params) => params.order,
            Self::FreeSpace(params) => params.order.unwrap_or(0),
        }
    }

    /// The same method at a higher order on the same cloud, by which it can be judged; `None` where there is none.
    pub(crate) fn finer(&self, dimension: usize) -> Option<Self> {
        match self {
            Self::Sharp(params) => sharp::finer(params, dimension).map(Self::Sharp),
            _ => None,
        }
    }

    /// What a stencil takes on one core, where the method knows better than a common figure; whether the diffusivity varies
    /// within a region.
    pub(super) fn stencil_microseconds(&self, dimension: usize, varies: bool) -> Option<f64> {
        match self {
            Self::Sharp(params) => Some(sharp::stencil_microseconds(params, dimension, varies)),
            _ => None,
        }
    }

    /// Order at which the error in u falls where something jumps at an interface.
    pub fn interface_order(&self) -> usize {
        match self {
            Self::Gfdm(_) | Self::ParticleDifferenceExtended(_) | Self::SurfaceReaction(_) => 1,
            Self::ParticleDifference(_) | Self::ImmersedInterface(_) => 2,
            Self::Sharp(params) => params.order,
            Self::FreeSpace(params) => params.order.unwrap_or(0),
        }
    }

    pub(super) fn steps(&self, survey: &Survey) -> Steps {
        match self {
            Self::Gfdm(params) => gfdm::steps(params, survey),
            Self::ParticleDifference(_) | Self::ParticleDifferenceExtended(_) => {
                particle_difference::steps(survey)
            }
            Self::ImmersedInterface(_) => dcpse::steps(survey),
            Self::Sharp(params) => sharp::steps(params, survey),
            Self::SurfaceReaction(_) => dcpse::reaction_steps(),
            Self::FreeSpace(_) => free_space::steps(),
        }
    }

    /// Interaction radius in units of the spacing that the method wants; `None` for the common one.
    pub(super) fn support(&self, dimension: usize) -> Option<f64> {
        match self {
            Self::ImmersedInterface(ImmersedParams { order, .. })
            | Self::SurfaceReaction(ReactionParams { order, .. }) => Some(dcpse::support(dimension, *order)),
            Self::Gfdm(_)
            | Self::ParticleDifference(_)
            | Self::ParticleDifferenceExtended(_)
            | Self::Sharp(_)
            | Self::FreeSpace(_) => None,
        }
    }
}
