//! Which transforms outputs share.
//!
//! The factors of an output – derivatives and shifts – belong to one direction each. So phi and its derivatives along the
//! first two directions are one array until the third direction is transformed back, and phi and its derivative along the
//! first one until the second is. For phi and its gradient that makes two transforms of the third direction, three of the
//! second and four of the first, where four of each had to be done apart.

use super::output::{Term, Wanted};

/// What has to be done for a list of outputs.
#[derive(Debug)]
pub(super) struct Recipe<T> {
    /// Arrays that are transformed back in the third direction.
    pub(super) deep: Vec<Deep>,
    /// How many arrays are transformed back in the second direction.
    pub(super) middle: usize,
    /// For each output, the array that is transformed back in the first direction.
    pub(super) last: Vec<Last>,
    /// Factors of each direction that move all results, real and imaginary parts.
    pub(super) phases: Option<[Vec<[T; 2]>; 3]>,
}

/// A sum of sources and derivatives times Ĝ, or times the estimate of its error.
#[derive(Debug, PartialEq)]
pub(super) struct Deep {
    pub(super) terms: Vec<Term>,
    pub(super) estimate: bool,
    /// The array of the second direction that it becomes as it is.
    pub(super) plain: Option<usize>,
    /// The one that its derivative in the second direction becomes.
    pub(super) along: Option<usize>,
}

/// An output before it is transformed back in the first direction.
#[derive(Debug, PartialEq)]
pub(super) struct Last {
    pub(super) middle: usize,
    /// Whether it is the derivative in the first direction.
    pub(super) along: bool,
    pub(super) sign: f64,
}

impl<T> Recipe<T> {
    /// The only thing to be done in the third direction, if it is a product with real numbers of one source.
    pub(super) fn alone(&self) -> Option<&Deep> {
        match (&self.deep[..], &self.phases) {
            ([deep], None) => match deep.terms[..] {
                [Term { axis: None, sign: 1.0, .. }] if deep.along.is_none() => Some(deep),
                _ => None,
            },
            _ => None,
        }
    }

    pub(super) fn new(wanted: Vec<Wanted>, phases: Option<[Vec<[T; 2]>; 3]>) -> Self {
        let mut recipe = Self { deep: Vec::new(), middle: 0, last: Vec::new(), phases };
        for Wanted { mut terms, estimate } in wanted {
            // What a single term is multiplied by in the first two directions can wait until they are transformed back.
            let (mut axis, mut sign) = (None, 1.0);
            if let [term] = &mut terms[..] {
                axis = term.axis.filter(|a| *a < 2);
                sign = std::mem::replace(&mut term.sign, 1.0);
                term.axis = term.axis.filter(|a| *a == 2);
            }
            let known = recipe.deep.iter().position(|d| d.terms == terms && d.estimate == estimate);
            let deep = known.unwrap_or_else(|| {
                recipe.deep.push(Deep { terms, estimate, plain: None, along: None });
                recipe.deep.len() - 1
            });
            let deep = &mut recipe.deep[deep];
            let middle = if axis == Some(1) { &mut deep.along } else { &mut deep.plain };
            let middle = *middle.get_or_insert_with(|| {
                recipe.middle += 1;
                recipe.middle - 1
            });
            recipe.last.push(Last { middle, along: axis == Some(0), sign });
        }
        recipe
    }
}

#[cfg(test)]
mod tests {
    use super::{Last, Recipe};
    use crate::plan::output::{Output, Wanted};

    fn recipe(outputs: &[Output], sources: usize) -> Recipe<f64> {
        let wanted = |o: &Output| Wanted { terms: o.terms::<3>(sources).expect("right"), estimate: false };
        Recipe::new(outputs.iter().map(wanted).collect(), None)
    }

    #[test]
    fn a_potential_and_its_gradient_share_what_they_can() {
        let gradient = |axis| Output::Gradient { source: 0, axis };
        let all = recipe(&[gradient(0), gradient(1), gradient(2), Output::Potential { source: 0 }], 1);
        assert_eq!((all.deep.len(), all.middle), (2, 3));
        assert_eq!(all.last[0], Last { middle: 0, along: true, sign: 1.0 });
        assert_eq!(all.last[3], Last { middle: 0, along: false, sign: 1.0 });
    }

    #[test]
    fn sums_share_nothing() {
        let curl = recipe(&[0, 1, 2].map(|axis| Output::Curl { axis }), 3);
        assert_eq!((curl.deep.len(), curl.middle), (3, 3));
    }
}
