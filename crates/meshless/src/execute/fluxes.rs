//! Totals of the flux `eta du/dn` for the report: through the parts of the boundary, and through the interfaces.

use super::balance::Flows;
use crate::report::{BalanceReport, FluxReport};

/// The fluxes of a balance.
pub(super) fn fluxes(flows: &Flows, balance: &BalanceReport) -> FluxReport {
    FluxReport {
        boundaries: flows.boundaries.clone(),
        interfaces: flows.interfaces.clone(),
        left_over: balance.relative,
    }
}
