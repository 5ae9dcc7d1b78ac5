//! What a suite leaves behind: its runs, its claims, and what the report shows of them.

use meshless::report::Report;

use super::claims::Claim;
use super::figure::Figure;
use super::order;
use super::row::Row;
use super::variant::Variant;

/// What identifies a run within its suite.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Key {
    pub(crate) case: &'static str,
    pub(crate) variant: Variant,
    /// The jump of the coefficient, or whatever else a case varies.
    pub(crate) jump: f64,
    /// Rung of the ladder, 0 for the coarsest.
    pub(crate) level: usize,
    pub(crate) seed: u64,
}

/// A run that ended.
#[derive(Debug, Clone)]
pub(crate) struct Outcome {
    pub(crate) key: Key,
    pub(crate) row: Row,
    pub(crate) report: Report,
}

impl Outcome {
    /// Relative L2 error; not a number where the scene has no exact solution, so that claims on it fail.
    pub(crate) fn l2(&self) -> f64 {
        self.row.err_l2.unwrap_or(f64::NAN)
    }
}

/// A table of the report beside the claims.
#[derive(Debug, Clone)]
pub(crate) struct Table {
    pub(crate) caption: String,
    pub(crate) head: Vec<String>,
    pub(crate) rows: Vec<Vec<String>>,
}

/// A picture that is drawn already.
#[derive(Debug, Clone)]
pub(crate) struct Picture {
    pub(crate) name: String,
    pub(crate) caption: String,
    pub(crate) svg: String,
}

/// What the report shows of a case.
#[derive(Debug, Clone)]
pub(crate) struct Section {
    pub(crate) case: &'static str,
    pub(crate) title: &'static str,
    pub(crate) about: &'static str,
    pub(crate) figures: Vec<Figure>,
    pub(crate) pictures: Vec<Picture>,
    pub(crate) tables: Vec<Table>,
}

/// All of a suite.
#[derive(Debug, Clone)]
pub(crate) struct Study {
    pub(crate) suite: &'static str,
    pub(crate) outcomes: Vec<Outcome>,
    pub(crate) claims: Vec<Claim>,
    pub(crate) sections: Vec<Section>,
}

impl Study {
    /// Whether nothing was run: no outcomes, and no claims but that nothing failed.
    pub(crate) fn is_empty(&self) -> bool {
        self.outcomes.is_empty() && self.claims.iter().all(|claim| claim.case == "all")
    }

    #[cfg(test)]
    pub(crate) fn new(suite: &'static str) -> Self {
        Self { suite, outcomes: Vec::new(), claims: Vec::new(), sections: Vec::new() }
    }
}

/// Finds a run.
pub(crate) fn find<'a>(outcomes: &'a [Outcome], key: &Key) -> Option<&'a Outcome> {
    outcomes.iter().find(|o| o.key == *key)
}

/// The rungs of the ladder that `key` belongs to, coarsest first, as spacing and relative L2 error.
pub(crate) fn ladder(outcomes: &[Outcome], key: &Key) -> Vec<(f64, f64)> {
    let mut rungs: Vec<&Outcome> = outcomes
        .iter()
        .filter(|o| Key { level: o.key.level, ..*key } == o.key && o.row.err_l2.is_some())
        .collect();
    rungs.sort_by_key(|o| o.key.level);
    rungs.iter().map(|o| (o.row.spacing, o.l2())).collect()
}

/// Adds a run, with its orders against the rung before it.
pub(crate) fn push(outcomes: &mut Vec<Outcome>, mut outcome: Outcome) {
    let before =
        outcome.key.level.checked_sub(1).and_then(|level| find(outcomes, &Key { level, ..outcome.key }));
    if let Some(before) = before {
        let rate = |error: fn(&Row) -> Option<f64>| {
            let (coarse, fine) = (error(&before.row)?, error(&outcome.row)?);
            order::between((before.row.spacing, coarse), (outcome.row.spacing, fine))
        };
        let (l2, linf) = (rate(|r| r.err_l2), rate(|r| r.err_linf));
        (outcome.row.order_l2, outcome.row.order_linf) = (l2, linf);
    }
    outcomes.push(outcome);
}

#[cfg(test)]
mod tests {
    use super::Study;
    use crate::verify::claims::Claims;

    #[test]
    fn that_nothing_failed_is_no_run() {
        let claimed = |case: &'static str| {
            let mut claims = Claims::new("x", true);
            claims.at_most(case, "a figure", Some(0.0), 1.0);
            Study { claims: claims.by_case(&[case]), ..Study::new("x") }
        };
        assert!(Study::new("x").is_empty() && claimed("all").is_empty() && !claimed("disc").is_empty());
    }
}
