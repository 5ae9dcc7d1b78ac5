//! The cell in one dimension: an interval.

use crate::body::{Measure, Piece, Source};
use crate::root::bracketed_root;

/// An interval around the node, which is the origin, with the source of each end.
#[derive(Debug, Default, Clone)]
pub(crate) struct Interval {
    lo: f64,
    hi: f64,
    lo_source: Source,
    hi_source: Source,
}

impl Interval {
    pub(crate) fn reset(&mut self, lo: f64, hi: f64) {
        *self = Self { lo, hi, lo_source: Source::Start, hi_source: Source::Start };
    }

    pub(crate) fn radius(&self) -> f64 {
        self.lo.abs().max(self.hi.abs())
    }

    pub(crate) fn ends(&self) -> [f64; 2] {
        [self.lo, self.hi]
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.lo >= self.hi
    }

    /// Keeps the part where `normal * x <= offset`; `normal` is not zero.
    pub(crate) fn clip(&mut self, normal: f64, offset: f64, source: Source) {
        let end = offset / normal;
        if normal > 0.0 && end < self.hi {
            (self.hi, self.hi_source) = (end, source);
        } else if normal < 0.0 && end > self.lo {
            (self.lo, self.lo_source) = (end, source);
        }
    }

    /// Keeps the part where `level` is negative. `None` if the level set is not a number.
    pub(crate) fn cut(&mut self, level: impl Fn(f64) -> f64, source: Source) -> Option<f64> {
        let (lo, hi) = (self.lo, self.hi);
        let (at_lo, at_hi) = (level(lo), level(hi));
        if at_lo.is_nan() || at_hi.is_nan() {
            return None;
        }
        match (at_lo > 0.0, at_hi > 0.0) {
            (false, true) => {
                let t = bracketed_root(at_lo, at_hi, |t| level(lo + t * (hi - lo)))?;
                (self.hi, self.hi_source) = (lo + t * (hi - lo), source);
            }
            (true, false) => {
                let t = bracketed_root(at_hi, at_lo, |t| level(hi + t * (lo - hi)))?;
                (self.lo, self.lo_source) = (hi + t * (lo - hi), source);
            }
            (true, true) => self.hi = self.lo,
            (false, false) => {}
        }
        Some(at_lo.abs().max(at_hi.abs()))
    }

    pub(crate) fn measure(&self, pieces: &mut Vec<Piece>) -> Measure {
        let volume = self.hi - self.lo;
        for (source, sign, end) in [(self.lo_source, -1.0, self.lo), (self.hi_source, 1.0, self.hi)] {
            pieces.push(Piece { source, area: [sign, 0.0, 0.0], centroid: [end, 0.0, 0.0] });
        }
        Measure { volume, moment: [0.5 * volume * (self.lo + self.hi), 0.0, 0.0] }
    }
}
