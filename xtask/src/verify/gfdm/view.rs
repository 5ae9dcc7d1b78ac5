//! Looking up the runs of one case.

use super::Variant;
use super::sweep::{CLAIMED, SEED};
use crate::verify::options::Effort;
use crate::verify::order;
use crate::verify::runner::Runner;
use crate::verify::study::{self, Key, Outcome};

/// Errors below this are round-off: the method is exact there, and an order has no meaning.
pub(super) const EXACT: f64 = 1e-9;

/// Fewest rungs from which an order is fitted.
const FEWEST_RUNGS: usize = 3;

/// The runs of one case.
#[derive(Debug, Clone, Copy)]
pub(super) struct View<'a> {
    pub(super) outcomes: &'a [Outcome],
    pub(super) case: &'static str,
    pub(super) effort: Effort,
}

impl<'a> View<'a> {
    pub(super) fn new(runner: &'a Runner<'_>, case: &'static str) -> Self {
        Self { outcomes: &runner.outcomes, case, effort: runner.options.effort }
    }

    /// The finest rung that every method has climbed.
    pub(super) fn common_level(&self) -> usize {
        if self.effort == Effort::Quick { CLAIMED - 1 } else { CLAIMED }
    }

    pub(super) fn at(&self, variant: Variant, jump: f64, level: usize) -> Option<&'a Outcome> {
        study::find(self.outcomes, &Key { case: self.case, variant, jump, level, seed: SEED })
    }

    /// Relative L2 error of a run.
    pub(super) fn error(&self, variant: Variant, jump: f64, level: usize) -> Option<f64> {
        self.at(variant, jump, level).map(Outcome::l2)
    }

    /// Error of the first run over that of the second.
    pub(super) fn ratio(&self, over: (Variant, f64), under: (Variant, f64), level: usize) -> Option<f64> {
        Some(self.error(over.0, over.1, level)? / self.error(under.0, under.1, level)?)
    }

    /// Order over the whole ladder.
    pub(super) fn order(&self, variant: Variant, jump: f64) -> Option<f64> {
        let ladder =
            study::ladder(self.outcomes, &Key { case: self.case, variant, jump, level: 0, seed: SEED });
        if ladder.len() < FEWEST_RUNGS { None } else { order::fit(&ladder) }
    }

    /// The runs of a variant.
    pub(super) fn of(&self, variant: Variant) -> impl Iterator<Item = &'a Outcome> {
        let case = self.case;
        self.outcomes.iter().filter(move |o| o.key.case == case && o.key.variant == variant)
    }

    /// The largest of a figure over the runs of a variant.
    pub(super) fn largest(&self, variant: Variant, figure: impl Fn(&Outcome) -> Option<f64>) -> Option<f64> {
        largest(self.of(variant).filter_map(figure))
    }
}

/// The largest of some figures; a NaN among them is the result.
pub(super) fn largest(figures: impl Iterator<Item = f64>) -> Option<f64> {
    figures.fold(None, |best, x| match best {
        Some(b) if b.is_nan() || b >= x => Some(b),
        _ => Some(x),
    })
}

/// The largest of some figures over the smallest.
pub(super) fn spread(figures: &[f64]) -> Option<f64> {
    let high = largest(figures.iter().copied())?;
    let low = figures.iter().copied().fold(f64::INFINITY, f64::min);
    Some(high / low)
}

#[cfg(test)]
mod tests {
    use super::{largest, spread};

    #[test]
    fn a_nan_is_not_lost() {
        assert!(largest([1.0, f64::NAN, 2.0].into_iter()).is_some_and(f64::is_nan));
        assert_eq!(largest([1.0, 3.0, 2.0].into_iter()), Some(3.0));
        assert_eq!(largest([].into_iter()), None);
        assert_eq!(spread(&[2.0, 1.0, 4.0]), Some(4.0));
    }
}
