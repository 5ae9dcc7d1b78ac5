//! Decisions where a scene gives an error to reach.

use meshless_interfaces::sharp::Sharp;

use super::choose::RESOLVED;
use super::effects::{Effect, Survey};
use super::knows;
use crate::scene::{AccuracyOf, MethodName, Scene};
use crate::{Error, build};

/// An error to reach, and how far to go for it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AccuracyPlan {
    /// Relative error.
    pub tolerance: f64,
    /// What it is about.
    pub of: AccuracyOf,
    /// Nodes of the finest cloud that may be tried.
    pub max_nodes: f64,
}

/// Tolerance from which on methods that keep the maximum principle are good enough.
const COARSE: f64 = 2e-2;

/// Tolerances down to which the sharp method takes order 4, 6 and so on, by dimension; the last order below.
const SHARP_ORDERS: [&[(f64, usize)]; 3] =
    [&[(1e-3, 4), (1e-6, 6), (0.0, 8)], &[(1e-3, 4), (1e-5, 6), (0.0, 8)], &[(1e-4, 4), (0.0, 6)]];

/// The least order of the sharp method where data vary below the spacing, in the plane and on the line: a layer of a thousandth of the domain has an error of 3e-2 on
/// 60,000 nodes of order 4, and of 1.4e-3 on 122,000 of order 6.
const AT_FEATURES: usize = 6;

/// Tolerances down to which stencils take order 2, 4 and so on where nothing jumps and the sharp method does not serve.
const STENCIL_ORDERS: [(f64, usize); 3] = [(1e-3, 2), (1e-5, 4), (0.0, 6)];

/// What serves a tolerance.
pub(super) struct Choice {
    pub(super) name: MethodName,
    pub(super) order: Option<usize>,
    pub(super) why: String,
}

impl AccuracyPlan {
    pub(super) fn new(scene: &Scene) -> Option<Self> {
        let spec = scene.accuracy.as_ref()?;
        Some(Self { tolerance: spec.tolerance, of: spec.of, max_nodes: spec.max_nodes as f64 })
    }

    /// Method and order for a scene that names no method.
    ///
    /// # Errors
    /// Those of the geometry of the scene.
    pub(super) fn choose(&self, scene: &Scene, survey: &Survey) -> Result<Choice, Error> {
        let tolerance = self.tolerance;
        let choice = |name, order, why: &str| Choice {
            name,
            order: scene.method.order.or(order),
            why: format!("a tolerance of {tolerance:.1e}: {why}"),
        };
        let choice = |name, order, why| Ok(choice(name, order, why));
        let jumps = survey.has_interface();
        if jumps && scene.is_labelled() && scene.output.fluxes {
            let why = "interfaces are known from labels only: balances have the fluxes";
            return choice(MethodName::GfdmHybrid, None, why);
        }
        if let Some(why) = survey.needs_balances(scene) {
            return choice(MethodName::GfdmConservative, None, why);
        }
        if survey.has(|e| matches!(e, Effect::Advection { peclet } if *peclet > RESOLVED)) {
            let why = "the velocity carries more than a cell conducts: upwind balances";
            return choice(MethodName::GfdmConservative, None, why);
        }
        // Fluxes take gradients up to interfaces.
        // Singular corners take functions of their own.
        if jumps && tolerance >= COARSE && !scene.output.fluxes && !survey.has_corners(scene) {
            return choice(
                MethodName::GfdmHybrid,
                None,
                "balances at interfaces, stencils elsewhere, will do",
            );
        }
        if scene.time.is_none() {
            let order = self.order_of(SHARP_ORDERS[scene.dimension - 1]);
            // What is narrow takes most of the nodes, the fewer the higher the order.
            let is_low = scene.dimension < 3 && order.is_some_and(|order| order < AT_FEATURES);
            let order =
                if is_low && build::has_features(scene, AT_FEATURES)? { Some(AT_FEATURES) } else { order };
            return choice(MethodName::Sharp, order, "high order on both sides of interfaces");
        }
        let high = scene.method.order.is_some_and(|order| order > 2 && Sharp::offers(order, scene.dimension));
        if jumps && (high || scene.output.fluxes) {
            return choice(MethodName::Sharp, None, "high order on both sides of interfaces, also in time");
        }
        if jumps && !knows::all(MethodName::ParticleDifference, &survey.effects) {
            return choice(MethodName::Sharp, None, "high order on both sides of interfaces, also in time");
        }
        if jumps {
            let why = "second order up to interfaces, also in time";
            return choice(MethodName::ParticleDifference, None, why);
        }
        choice(MethodName::GfdmClassical, self.order_of(&STENCIL_ORDERS), "stencils, also in time")
    }

    /// The order of a method that the scene names without one.
    pub(super) fn order(&self, name: MethodName, dimension: usize) -> Option<usize> {
        self.order_of(SHARP_ORDERS[dimension - 1]).filter(|_| name == MethodName::Sharp)
    }

    /// The first of the orders that serves the tolerance.
    fn order_of(&self, orders: &[(f64, usize)]) -> Option<usize> {
        orders.iter().find(|(down_to, _)| self.tolerance >= *down_to).map(|&(_, order)| order)
    }
}
