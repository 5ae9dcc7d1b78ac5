//! What an estimate by comparison does not see: reasons for which the error is larger.
//!
//! Two solutions that make the same mistake agree. What says so independently of both raises the estimate, so that no tolerance
//! counts as met with less.

use super::balance::{Flows, Ledger, LeftOver};
use crate::report::Estimate;
use crate::scene::Scene;

/// How many times the estimate must be left over where the fluxes are known in one way only: they are less accurate than u.
const ALONE: f64 = 10.0;

/// The same where a better solution, or better fits, leave as much over.
const MORE: f64 = 3.0;

/// Part of the whole that must be left over, beyond doubt, to be no error of fluxes alone: then all of u is off, in every region.
const GROSS: f64 = 0.1;

/// Part of what a solution leaves over below which the better one shows that it is only the flux that is less accurate than u.
const GETS_BETTER: f64 = 0.5;

/// Something that the error is at least as large as.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Reason {
    /// What says so, as `estimate.raised_by` has it.
    pub(crate) by: &'static str,
    /// The least error of the whole, relative.
    pub(crate) whole: Option<f64>,
    /// Of regions by their names.
    pub(crate) regions: Vec<(String, f64)>,
}

/// Whether more is left over than the estimate says, or so much that all regions are off.
pub(crate) fn suspects<const D: usize>(
    scene: &Scene,
    ledger: &Ledger<D>,
    flows: &Flows,
    estimate: &Estimate,
) -> bool {
    let (whole, regions) = ledger.left_over(flows);
    let more = |left: &LeftOver, estimated: Option<f64>| estimated.is_some_and(|e| left.relative > e);
    let of_region = |name: &str| estimate.regions.get(name).copied();
    let named = scene.regions.iter().map(|region| of_region(&region.name)).zip(&regions);
    whole.relative > GROSS
        || more(&whole, estimate.l2)
        || named.into_iter().any(|(estimated, left)| more(left, estimated))
}

/// What the balance says, in view of the fluxes of a better solution, or by better fits.
///
/// Fluxes are known less accurately than u: a smooth solution on few nodes leaves a hundred times the error of u over. But then one
/// of a higher degree leaves much less. So what counts is what both leave over, less what is in doubt; where there is no other, that it
/// is much more than the estimate.
pub(crate) fn by_balance<const D: usize>(
    scene: &Scene,
    ledger: &Ledger<D>,
    flows: &Flows,
    other: Option<&Flows>,
    estimate: &Estimate,
) -> Reason {
    let (whole, regions) = ledger.left_over(flows);
    let other = other.map(|other| ledger.left_over(other));
    let says = |first: LeftOver, second: Option<LeftOver>, estimated: f64| {
        let sure = match second {
            Some(second) if second.relative < GETS_BETTER * first.relative => return None,
            Some(second) => (first.relative.min(second.relative) - first.doubt.max(second.doubt)) / MORE,
            None => first.relative / ALONE - first.doubt,
        };
        (sure > estimated).then_some(first.relative)
    };
    let named = scene.regions.iter().zip(regions).enumerate().filter_map(|(k, (region, left))| {
        let estimated = *estimate.regions.get(&region.name)?;
        let raised = says(left, other.as_ref().map(|(_, regions)| regions[k]), estimated)?;
        Some((region.name.clone(), raised))
    });
    let of_whole = estimate.l2.and_then(|l2| says(whole, other.as_ref().map(|(whole, _)| *whole), l2));
    let regions = named.collect();
    match gross(whole, other.as_ref().map(|(whole, _)| *whole)) {
        None => Reason { by: "balance", whole: of_whole, regions },
        Some(error) => {
            let all = scene.regions.iter().map(|region| (region.name.clone(), error));
            Reason {
                by: "balance",
                whole: Some(of_whole.map_or(error, |w| w.max(error))),
                regions: all.chain(regions).collect(),
            }
        }
    }
}

/// The part of the whole that is left over, where that is much.
fn gross(first: LeftOver, second: Option<LeftOver>) -> Option<f64> {
    let gets_better = second.is_some_and(|second| second.relative < GETS_BETTER * first.relative);
    (!gets_better && first.relative - first.doubt > GROSS).then_some(first.relative)
}

/// Raises an estimate to what the reasons say.
pub(crate) fn raise(estimate: &mut Estimate, reasons: &[Reason]) {
    let compared = estimate.l2;
    for reason in reasons {
        let mut counts = false;
        if let (Some(l2), Some(least)) = (estimate.l2, reason.whole)
            && least > l2
        {
            estimate.l2 = Some(least);
            estimate.compared = compared;
            counts = true;
        }
        for (name, least) in &reason.regions {
            if let Some(known) = estimate.regions.get_mut(name).filter(|known| **known < *least) {
                *known = *least;
                counts = true;
            }
        }
        if counts {
            estimate.raised_by = Some(reason.by.to_owned());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_reason_counts() {
        let regions = [("a".to_owned(), 1e-3), ("b".to_owned(), 1e-2)].into_iter().collect();
        let mut estimate = Estimate { l2: Some(1e-3), regions, ..Estimate::default() };
        raise(&mut estimate, &[Reason { by: "nothing", whole: Some(1e-4), regions: Vec::new() }]);
        assert_eq!((estimate.l2, estimate.raised_by.clone()), (Some(1e-3), None));
        let balance = Reason { by: "balance", whole: Some(0.2), regions: vec![("a".to_owned(), 0.3)] };
        raise(&mut estimate, &[balance, Reason { by: "less", whole: Some(0.1), regions: Vec::new() }]);
        assert_eq!((estimate.l2, estimate.compared), (Some(0.2), Some(1e-3)));
        assert_eq!((estimate.regions["a"], estimate.regions["b"]), (0.3, 1e-2));
        assert_eq!(estimate.raised_by.as_deref(), Some("balance"));
    }

    #[test]
    fn much_left_over_is_an_error_of_all_regions() {
        let left = |relative: f64| LeftOver { absolute: 1.0, relative, doubt: 0.0 };
        assert_eq!(gross(left(0.3), None), Some(0.3));
        assert_eq!((gross(left(0.05), None), gross(left(0.3), Some(left(0.1)))), (None, None));
    }

    #[test]
    fn what_has_no_estimate_gets_none() {
        let mut estimate = Estimate { why_not: Some("thin".to_owned()), ..Estimate::default() };
        raise(&mut estimate, &[Reason { by: "balance", whole: Some(0.2), regions: Vec::new() }]);
        assert_eq!((estimate.l2, estimate.raised_by), (None, None));
    }
}
