//! The rungs of a refinement ladder, as every suite of convergence reads them.

use super::row::Row;
use super::runner::Runner;
use super::study::{Key, Outcome};

/// Which error of a run.
pub(super) type Error = fn(&Row) -> Option<f64>;

/// The rungs of a ladder, as spacing and error.
pub(super) fn rungs(runner: &Runner<'_>, key: &Key, error: Error) -> Vec<(f64, f64)> {
    let mut found: Vec<&Outcome> = runner
        .outcomes
        .iter()
        .filter(|o| Key { level: o.key.level, ..*key } == o.key && error(&o.row).is_some())
        .collect();
    found.sort_by_key(|o| o.key.level);
    found.iter().map(|o| (o.row.spacing, error(&o.row).unwrap_or(f64::NAN))).collect()
}
