//! What explicit steps to the steady state cost, beside a sparse solver: (4.6) of the paper on the dipole in 1-D.

use meshless::interfaces::PseudoTimeParams;
use meshless::plan::Plan;
use meshless::scene::Scene;
use meshless::{PseudoTimeCost, pseudo_time};
use meshless_tests::fietier::dipole;

use super::cases::{DIPOLE, particles};
use super::{CONSTRAINED, LATTICE};
use crate::verify::claims::Claims;
use crate::verify::figure::{Curve, Figure};
use crate::verify::options::Effort;
use crate::verify::order;

/// Spacings, the coarsest ones of the dipole: half of the spacing takes eight times as long.
fn rungs(effort: Effort) -> usize {
    if effort == Effort::Quick { 3 } else { 4 }
}

/// Residual over the first one. The condition of the matrix grows like the square of the number of nodes, 160 of them at the
/// finest spacing, so that at most 1e4 of it is left in u.
const TOLERANCE: f64 = 1e-10;

/// Difference to the sparse solver that this allows.
const DIFFERENCE: f64 = 1e4 * TOLERANCE;

/// Steps grow like `1/h^2`, by which explicit steps are bounded, at a rate of decay that does not depend on h.
const GROWTH: [f64; 2] = [1.8, 2.2];

/// Costs by spacing, from the coarsest; an error as text.
pub(super) fn measure(effort: Effort) -> Result<Vec<(f64, PseudoTimeCost)>, String> {
    let params = PseudoTimeParams { tolerance: TOLERANCE, max_steps: 10_000_000 };
    let cost = |&h: &f64| {
        let text = dipole(h, particles(LATTICE)) + &CONSTRAINED.table();
        let scene = Scene::parse(&text, "dipole").map_err(|e| e.to_string())?;
        let plan = Plan::new(&scene).map_err(|e| e.to_string())?;
        Ok((h, pseudo_time(&scene, &plan, &params).map_err(|e| e.to_string())?))
    };
    DIPOLE[..rungs(effort)].iter().map(cost).collect()
}

pub(super) fn check(costs: &[(f64, PseudoTimeCost)], claims: &mut Claims) {
    let steps: Vec<(f64, f64)> = costs.iter().map(|(h, cost)| (*h, cost.steps as f64)).collect();
    claims.within(
        "dipole",
        "pseudo-time: order by which its steps grow as the spacing falls",
        order::fit(&steps).map(|order| -order),
        GROWTH,
    );
    let largest = costs.iter().map(|(_, cost)| cost.difference).fold(0.0, f64::max);
    claims.at_most(
        "dipole",
        "pseudo-time: largest difference to the sparse solver",
        (!costs.is_empty()).then_some(largest),
        DIFFERENCE,
    );
    // Every step is a product with the matrix; the direct solver takes about as many operations as a few of them.
    let ratio = costs.last().map(|(_, cost)| cost.seconds / cost.sparse_seconds);
    claims.at_least(
        "dipole",
        "pseudo-time: its seconds over those of the sparse solver, finest spacing",
        ratio,
        10.0,
    );
}

pub(super) fn figure(costs: &[(f64, PseudoTimeCost)]) -> Figure {
    let curve = |label: &str, seconds: &dyn Fn(&PseudoTimeCost) -> f64| Curve {
        label: label.to_owned(),
        points: costs.iter().map(|(h, cost)| (*h, seconds(cost))).collect(),
    };
    Figure {
        name: "dcpse-dipole-pseudo-time".to_owned(),
        caption: "Seconds of the solve: explicit steps to the steady state, as in the paper, and the sparse solver on the \
                  same rows. Dashed: the third power of the number of nodes."
            .to_owned(),
        x: "spacing of nodes",
        y: "seconds",
        curves: vec![
            curve("pseudo-time", &|cost| cost.seconds),
            curve("sparse solver", &|cost| cost.sparse_seconds),
        ],
        slope: Some(-3.0),
    }
}
