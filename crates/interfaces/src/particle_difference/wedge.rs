//! The support of a node near an interface: who is on which side, and what the condition says.

use crate::particle_difference::Wedge;
use crate::particle_difference::feet::{Feet, may_jump};
use crate::particle_difference::frame::Frame;
use crate::particle_difference::leg::Leg;
use crate::{MethodError, Problem};

/// Cosine between the normal at the foot of a neighbour and that at the foot of the node below which the neighbour is
/// taken to be at another leg of a corner, where a slope that varies smoothly along the interface has no meaning.
const SAME_LEG: f64 = 0.8;

/// A neighbour beyond an interface.
#[derive(Debug, Clone, Copy)]
pub(super) struct Across<const D: usize> {
    /// Its place among the neighbours that are kept.
    pub(super) place: usize,
    /// The interface.
    pub(super) leg: usize,
    /// Its distance from the interface.
    pub(super) distance: f64,
    /// Its foot and the normal there, from the foot of the node and less the normal there.
    pub(super) along: Option<([f64; D], [f64; D])>,
    /// Half the square of the distance, where the second derivative is continued, too.
    pub(super) bend: f64,
}

/// The support of a node near an interface.
#[derive(Debug, Clone, Default)]
pub(super) struct Sides<'a, const D: usize> {
    pub(super) legs: Vec<Leg<'a, D>>,
    /// Neighbours that take part.
    pub(super) kept: Vec<u32>,
    pub(super) across: Vec<Across<D>>,
    /// What the values of the kept neighbours have more than the continuation from this side: zero on this side.
    pub(super) shifts: Vec<f64>,
}

impl<'a, const D: usize> Sides<'a, D> {
    /// Sorts the neighbours of node i; a neighbour whose region has no interface with that of the node near here (it
    /// is behind a third one) is left out.
    pub(super) fn sort(
        &mut self,
        problem: &'a Problem<'a, D>,
        feet: &Feet<D>,
        wedge: Wedge,
        i: usize,
        neighbors: &[u32],
    ) -> Result<(), MethodError> {
        self.clear();
        for foot in feet.of(i) {
            self.legs.push(Leg::new(problem, i, *foot, wedge)?);
        }
        for &j in neighbors {
            let label = problem.labels[j as usize];
            if label == problem.labels[i] || !may_jump(problem, problem.labels[i], label) {
                self.kept.push(j);
                self.shifts.push(0.0);
            } else if let Some(leg) = self.legs.iter().position(|leg| leg.foot.beyond == label) {
                self.push_across(problem, feet, wedge, i, j, leg);
            }
        }
        Ok(())
    }

    fn clear(&mut self) {
        self.legs.clear();
        self.kept.clear();
        self.across.clear();
        self.shifts.clear();
    }

    fn push_across(
        &mut self,
        problem: &Problem<'a, D>,
        feet: &Feet<D>,
        wedge: Wedge,
        i: usize,
        j: u32,
        leg: usize,
    ) {
        let place = self.kept.len();
        let leg_seen = &self.legs[leg];
        let foot = &leg_seen.foot.at;
        let x = &problem.cloud.points()[j as usize];
        let own = feet.towards(j as usize, problem.labels[i]);
        let plane = (0..D).map(|k| (x[k] - foot.point[k]) * foot.normal[k]).sum::<f64>();
        let same_leg = own.filter(|own| {
            let parallel = -(0..D).map(|k| own.at.normal[k] * foot.normal[k]).sum::<f64>();
            let across = (0..D).map(|k| (x[k] - own.at.point[k]) * own.at.normal[k]).sum::<f64>();
            // At a foot in a corner the line to the node is not normal to a leg.
            parallel > SAME_LEG && across.abs() >= SAME_LEG * own.at.distance.abs()
        });
        let (distance, along, flux) = match (wedge, same_leg) {
            (Wedge::Plane, _) => (plane, None, leg_seen.flux_at_foot()),
            (_, Some(own)) => {
                let offset = std::array::from_fn(|k| own.at.point[k] - foot.point[k]);
                let turned = std::array::from_fn(|k| -own.at.normal[k] - foot.normal[k]);
                (own.at.distance.abs(), Some((offset, turned)), leg_seen.flux_at(&own.at.point))
            }
            (_, None) => {
                let offset = std::array::from_fn(|k| x[k] - foot.point[k] - plane * foot.normal[k]);
                (plane, Some((offset, [0.0; D])), leg_seen.flux_beside(problem, i, &offset))
            }
        };
        let bend = if wedge == Wedge::Quadratic { 0.5 * distance * distance } else { 0.0 };
        let mut shift = distance * flux / leg_seen.eta_beyond + bend * leg_seen.bend.given;
        // Constant along normals: no derivative of it enters the flux.
        shift += leg_seen.value_at(&own.map_or(foot.point, |own| own.at.point));
        self.kept.push(j);
        self.shifts.push(shift);
        self.across.push(Across { place, leg, distance, along, bend });
    }

    /// Whether nothing jumps here after all: the same diffusivity on both sides of every interface, and no shift.
    pub(super) fn is_smooth(&self) -> bool {
        self.legs.iter().all(|leg| leg.ratio == 1.0) && self.shifts.iter().all(|&s| s == 0.0)
    }

    /// The frame at the nearest interface.
    pub(super) fn frame(&self) -> Option<([f64; D], Frame<D>)> {
        self.legs.first().map(|leg| (leg.foot.at.point, Frame::new(&leg.foot.at.normal)))
    }
}
