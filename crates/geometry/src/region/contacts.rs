//! Where surfaces touch in a point, or along a line, with a gap between them that has no width there.

use rayon::prelude::*;

use super::RegionMap;
use super::layers::{Across, BESIDE, Way};
use crate::cloud::Cloud;
use crate::domain::Domain;
use crate::vector::{axpy, distance};

/// How far from a node tips are looked for, in spacings.
const REACH: f64 = 2.0;

/// Slope of the thickness at a contact below which surfaces touch without an angle. Where the gap of two discs of radius R is 1e-4
/// spacings wide, its slope is `0.02 sqrt(h / R)`.
const TANGENT: f64 = 0.05;

/// Contacts nearer to each other than this, in spacings, are one.
const APART: f64 = 1.0;

/// Where two surfaces touch without an angle: nodes see the gap between them at some distance only.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact<const D: usize> {
    /// Where.
    pub at: [f64; D],
    /// What the gap is of.
    pub gap: u16,
    /// The regions that touch; `None` for the boundary of the domain.
    pub between: [Option<u16>; 2],
    /// The cloud's spacing there.
    pub spacing: f64,
}

impl<const D: usize> RegionMap<D> {
    /// The places where regions touch each other, themselves or the boundary of the domain without an angle, as seen from the nodes.
    pub fn contacts(&self, cloud: &Cloud<D>, domain: &Domain<D>) -> Vec<Contact<D>> {
        if self.len() == 1 {
            return Vec::new();
        }
        let at = |i: usize| {
            let ways = self.ways_near(&cloud.points()[i], cloud.spacing()[i], domain, REACH);
            ways.into_iter().filter_map(|(across, way)| self.touches(&across, &way)).collect::<Vec<_>>()
        };
        let all: Vec<Contact<D>> = (0..cloud.len()).into_par_iter().flat_map_iter(at).collect();
        let mut contacts: Vec<Contact<D>> = Vec::new();
        for contact in all {
            let known = |other: &Contact<D>| distance(&other.at, &contact.at) < APART * other.spacing;
            if !contacts.iter().any(known) {
                contacts.push(contact);
            }
        }
        contacts
    }

    /// The contact that a way leads to, where there is one.
    fn touches(&self, across: &Across<'_, D>, way: &Way<D>) -> Option<Contact<D>> {
        let tip = self.contact(across, way).filter(|tip| tip.slope() < TANGENT)?;
        if !self.grows_thick(across, way) {
            return None;
        }
        let step = BESIDE * across.spacing;
        let beyond = |t: f64| {
            let x = axpy(&tip.from, t, &tip.direction);
            across.domain.contains(&x, 0.0).then(|| self.label(&x, 0.0))
        };
        let between = [beyond(-step), beyond(tip.length + step)];
        Some(Contact { at: tip.middle(), gap: tip.region, between, spacing: across.spacing })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cloud::{CloudParams, Layout, Spacing, generate};
    use crate::shape::Shape;

    fn contacts(shapes: Vec<Shape<2>>, spacing: f64) -> Vec<Contact<2>> {
        let domain = Domain::boxed([-1.0, -1.0], [1.0, 1.0]).expect("a box");
        let params = CloudParams {
            spacing: Spacing::Uniform(spacing),
            layout: Layout::Irregular,
            seed: 1,
            max_nodes: 100_000,
        };
        let cloud = generate(&domain, &params).expect("a cloud");
        let shapes = shapes.into_iter().map(Some).chain([None]).collect();
        RegionMap::new(shapes).expect("regions").contacts(&cloud, &domain)
    }

    fn disc(x: f64, y: f64, radius: f64) -> Shape<2> {
        Shape::ball([x, y], radius).expect("a disc")
    }

    #[test]
    fn discs_that_touch_each_other_or_a_wall_are_found() {
        for spacing in [0.1, 0.04] {
            let pair = contacts(vec![disc(-0.4, 0.01, 0.4), disc(0.3, 0.01, 0.3)], spacing);
            assert_eq!(pair.len(), 1, "{pair:?}");
            assert!(distance(&pair[0].at, &[0.0, 0.01]) < 0.1 * spacing, "{pair:?}");
            assert!(
                pair[0].gap == 2 && pair[0].between.contains(&Some(0)) && pair[0].between.contains(&Some(1))
            );
            let wall = contacts(vec![disc(-0.6, 0.013, 0.4)], spacing);
            assert_eq!(wall.len(), 1, "{wall:?}");
            assert!(
                wall[0].gap == 1 && wall[0].between.contains(&None) && wall[0].between.contains(&Some(0))
            );
            // One disc within another, at its rim.
            let within = contacts(vec![disc(0.25, 0.0, 0.25), disc(0.0, 0.0, 0.5)], spacing);
            assert_eq!(within.len(), 1, "{within:?}");
        }
    }

    #[test]
    fn angles_gaps_and_layers_are_no_contacts() {
        let slab = |low: f64, high: f64| Shape::cuboid([-1.0, low], [1.0, high]).expect("a box");
        let square = Shape::cuboid([0.4, -0.4], [0.9, 0.4]).expect("a box");
        for shapes in [
            vec![disc(-0.405, 0.0, 0.4), disc(0.405, 0.0, 0.4)],
            vec![disc(-0.3, 0.0, 0.4), disc(0.3, 0.0, 0.4)],
            vec![disc(0.0, 0.0, 0.3), disc(0.0, 0.0, 0.32)],
            vec![disc(-1.0, 0.0, 0.4)],
            vec![disc(-0.9, 0.0, 0.4)],
            vec![slab(-1.0, 0.0), slab(0.0, 0.05)],
            vec![slab(-1.0, 0.0), disc(0.0, 0.0, 0.4)],
            vec![square.clone(), disc(-0.9, 0.9, 0.3)],
        ] {
            for spacing in [0.1, 0.04] {
                let found = contacts(shapes.clone(), spacing);
                assert!(found.is_empty(), "{shapes:?} at {spacing}: {found:?}");
            }
        }
    }
}
