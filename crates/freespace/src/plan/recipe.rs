//! Which transforms outputs share.
//!
//! The factors of an output – derivatives and shifts – belong to one direction each. So phi and its derivatives along the
//! first two directions are one array until the third direction is transformed back, and phi and its derivative along the
//! first one until the second is. For phi and its gradient that makes two transforms of the third direction, three of the
//! second and four of the first, where four of each had to be done apart. Likewise shifts: phi at eight places of each cell takes two
//! transforms of the third direction, four of the second and eight of the first.

use super::axis::Axis;
use super::output::{Term, Wanted};
use super::real::Real;

/// What has to be done for a list of outputs.
#[derive(Debug)]
pub(super) struct Recipe<T> {
    /// Arrays that are transformed back in the third direction.
    pub(super) deep: Vec<Deep>,
    /// How many arrays are transformed back in the second direction.
    pub(super) middle: usize,
    /// For each output, the array that is transformed back in the first direction.
    pub(super) last: Vec<Last>,
    /// Shifts in each direction, and factors of each wave number that belong to them, real and imaginary parts.
    shifts: [Vec<(f64, Vec<[T; 2]>)>; 3],
}

/// A sum of sources and derivatives times Ĝ, or times the estimate of its error.
#[derive(Debug, PartialEq)]
pub(super) struct Deep {
    pub(super) terms: Vec<Term>,
    pub(super) estimate: bool,
    pub(super) shift: Option<usize>,
    /// Arrays of the second direction that it becomes.
    pub(super) middle: Vec<Middle>,
}

/// An array before it is transformed back in the second direction.
#[derive(Debug, PartialEq)]
pub(super) struct Middle {
    pub(super) array: usize,
    /// Whether it is the derivative in the second direction.
    pub(super) along: bool,
    pub(super) shift: Option<usize>,
}

/// An output before it is transformed back in the first direction.
#[derive(Debug, PartialEq)]
pub(super) struct Last {
    pub(super) middle: usize,
    /// Whether it is the derivative in the first direction.
    pub(super) along: bool,
    pub(super) sign: f64,
    pub(super) shift: Option<usize>,
}

impl<T: Real> Recipe<T> {
    /// The only thing to be done in the third direction, if it is a product with real numbers of one source.
    pub(super) fn alone(&self) -> Option<&Deep> {
        match &self.deep[..] {
            [deep] if deep.shift.is_none() => match (&deep.terms[..], &deep.middle[..]) {
                (
                    [Term { axis: None, sign: 1.0, source: 0 }],
                    [Middle { array: 0, along: false, shift: None }],
                ) => Some(deep),
                _ => None,
            },
            _ => None,
        }
    }

    /// The factors of a shift in a direction.
    pub(super) fn phases(&self, axis: usize, shift: Option<usize>) -> Option<&[[T; 2]]> {
        shift.map(|index| &self.shifts[axis][index].1[..])
    }

    pub(super) fn new(wanted: Vec<Wanted>, axes: &[Axis<T>; 3]) -> Self {
        let shifts = [Vec::new(), Vec::new(), Vec::new()];
        let mut recipe = Self { deep: Vec::new(), middle: 0, last: Vec::new(), shifts };
        for Wanted { mut terms, estimate, shift } in wanted {
            // What a single term is multiplied by in the first two directions can wait until they are transformed back.
            let (mut axis, mut sign) = (None, 1.0);
            if let [term] = &mut terms[..] {
                axis = term.axis.filter(|a| *a < 2);
                sign = std::mem::replace(&mut term.sign, 1.0);
                term.axis = term.axis.filter(|a| *a == 2);
            }
            let [first, second, third] = [0, 1, 2].map(|a| recipe.shifted(a, shift[a], axes));
            let known = recipe
                .deep
                .iter()
                .position(|d| d.terms == terms && d.estimate == estimate && d.shift == third);
            let deep = known.unwrap_or_else(|| {
                recipe.deep.push(Deep { terms, estimate, shift: third, middle: Vec::new() });
                recipe.deep.len() - 1
            });
            let (deep, along) = (&mut recipe.deep[deep], axis == Some(1));
            let known = deep.middle.iter().find(|m| m.along == along && m.shift == second);
            let middle = known.map(|m| m.array).unwrap_or_else(|| {
                deep.middle.push(Middle { array: recipe.middle, along, shift: second });
                recipe.middle += 1;
                recipe.middle - 1
            });
            recipe.last.push(Last { middle, along: axis == Some(0), sign, shift: first });
        }
        recipe
    }

    /// The index of a shift in a direction, none for none.
    fn shifted(&mut self, axis: usize, shift: f64, axes: &[Axis<T>; 3]) -> Option<usize> {
        if shift == 0.0 {
            return None;
        }
        let shifts = &mut self.shifts[axis];
        if let Some(index) = shifts.iter().position(|(known, _)| *known == shift) {
            return Some(index);
        }
        let phases = if axis == 2 { axes[axis].phases_at(shift) } else { axes[axis].phases(shift) };
        shifts.push((shift, phases));
        Some(shifts.len() - 1)
    }
}

#[cfg(test)]
mod tests {
    use super::{Axis, Last, Recipe};
    use crate::mesh::Centring;
    use crate::plan::boundary::{Boundary, Continuation};
    use crate::plan::output::{Output, Wanted};

    fn recipe(outputs: &[Output], sources: usize, shifts: &[[f64; 3]]) -> Recipe<f64> {
        let line = Continuation::new(Boundary::OPEN, 4, Centring::Cell);
        let axes = [0.1, 0.2, 0.3].map(|spacing| Axis::new(4, &line, spacing));
        let wanted = |o: &Output, shift: &[f64; 3]| Wanted {
            terms: o.terms::<3>(sources).expect("right"),
            estimate: false,
            shift: *shift,
        };
        let all = shifts.iter().flat_map(|shift| outputs.iter().map(move |o| wanted(o, shift)));
        Recipe::new(all.collect(), &axes)
    }

    #[test]
    fn a_potential_and_its_gradient_share_what_they_can() {
        let gradient = |axis| Output::Gradient { source: 0, axis };
        let all =
            recipe(&[gradient(0), gradient(1), gradient(2), Output::Potential { source: 0 }], 1, &[[0.0; 3]]);
        assert_eq!((all.deep.len(), all.middle), (2, 3));
        assert_eq!(all.last[0], Last { middle: 0, along: true, sign: 1.0, shift: None });
        assert_eq!(all.last[3], Last { middle: 0, along: false, sign: 1.0, shift: None });
    }

    #[test]
    fn sums_share_nothing() {
        let curl = recipe(&[0, 1, 2].map(|axis| Output::Curl { axis }), 3, &[[0.0; 3]]);
        assert_eq!((curl.deep.len(), curl.middle), (3, 3));
    }

    #[test]
    fn places_of_a_cell_share_what_they_can() {
        let places: Vec<[f64; 3]> =
            (0..8).map(|i| [i & 1, i >> 1 & 1, i >> 2].map(|side| f64::from(side) / 2.0 - 0.25)).collect();
        let all = recipe(&[Output::Potential { source: 0 }], 1, &places);
        assert_eq!((all.deep.len(), all.middle, all.last.len()), (2, 4, 8));
        assert!(all.alone().is_none());
    }
}
