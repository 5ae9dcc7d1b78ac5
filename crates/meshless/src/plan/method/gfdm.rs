//! Generalised finite differences in plans.

use meshless_interfaces::gfdm::{GfdmParams, Selection};

use super::Steps;
use crate::plan::effects::{Effect, Survey};
use crate::scene::{MethodName, Scene};

/// Share of the nodes that the hybrid methods make conservative where there is an interface, about.
const SHARE_NEAR_INTERFACES: f64 = 0.2;

/// Order of balances over cells on a regular cloud.
const ORDER_OF_BALANCES: usize = 2;

pub(super) fn params(name: MethodName, scene: &Scene, survey: &Survey) -> GfdmParams {
    let mut gfdm = match name {
        MethodName::GfdmClassical => GfdmParams::classical(),
        MethodName::GfdmConservative => GfdmParams::conservative(),
        MethodName::GfdmPositive => GfdmParams::positive(),
        _ => GfdmParams::hybrid(),
    };
    if !survey.has_interface() {
        gfdm.strong.smoothing = 0;
    }
    let options = &scene.method.options;
    gfdm.strong.smoothing = options.smoothing.unwrap_or(gfdm.strong.smoothing);
    gfdm.strong.log_scaling = options.log_scaling.unwrap_or(gfdm.strong.log_scaling);
    gfdm.strong.correction = options.correction.unwrap_or(gfdm.strong.correction);
    gfdm.strong.degree = scene.method.order.unwrap_or(gfdm.strong.degree);
    gfdm.conservative_neumann = options.conservative_neumann.unwrap_or(gfdm.conservative_neumann);
    gfdm.selection_tolerance = options.selection_tolerance.unwrap_or(gfdm.selection_tolerance);
    // A scene that names the method gets the paper's selection unless it says otherwise; where the choice is ours, regions
    // tell where interfaces are, also where a jump is too small to spoil the diagonal dominance.
    let by_region = options.select_by_region.unwrap_or(scene.method.name == MethodName::Auto);
    gfdm.select_by_region = by_region && survey.has_interface();
    gfdm
}

pub(super) fn order(params: &GfdmParams) -> usize {
    match params.selection {
        Selection::All => ORDER_OF_BALANCES,
        _ => params.strong.degree,
    }
}

pub(super) fn steps(params: &GfdmParams, survey: &Survey) -> Steps {
    let selection = matches!(params.selection, Selection::Flagged | Selection::FlaggedAndNeighbors);
    let flux_rows = survey.has(|e| matches!(e, Effect::Neumann | Effect::Flux | Effect::Robin));
    Steps {
        stencils: params.selection != Selection::All,
        no_stencils: "every row is conservative",
        selection,
        constrained: None,
        cells: match params.selection {
            Selection::All => 1.0,
            Selection::None => 0.0,
            _ if survey.has_interface() => SHARE_NEAR_INTERFACES,
            _ => 0.0,
        },
        // Also where conditions on the flux are collocated: unsound rows are replaced by balances.
        may_need_cells: selection || params.selection == Selection::All || flux_rows,
    }
}
