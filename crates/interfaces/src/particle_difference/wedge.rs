//! The support of a node near an interface: who is on which side, and what the condition says.

use crate::particle_difference::feet::{Feet, Foot, may_jump};
use crate::particle_difference::{Wedge, frame::Frame};
use crate::problem::InterfaceJump;
use crate::{MethodError, Problem};

/// Cosine between the normal at the foot of a neighbour and that at the foot of the node below which the neighbour is
/// taken to be at another leg of a corner, where a slope that varies smoothly along the interface has no meaning.
const SAME_LEG: f64 = 0.8;

/// An interface within the support of a node, with the condition across it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Leg<'a, const D: usize> {
    pub(super) foot: Foot<D>,
    /// Diffusivity on this side over that beyond, at the foot.
    pub(super) ratio: f64,
    /// Diffusivity beyond, at the foot.
    eta_beyond: f64,
    /// What is prescribed, and the sign of its value from this side.
    jump: Option<(&'a InterfaceJump<D>, f64)>,
}

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
            self.legs.push(Leg::new(problem, problem.labels[i], *foot)?);
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
        let Leg { foot, eta_beyond, jump, .. } = self.legs[leg];
        let x = &problem.cloud.points()[j as usize];
        let own = feet.towards(j as usize, problem.labels[i]);
        let plane = (0..D).map(|k| (x[k] - foot.at.point[k]) * foot.at.normal[k]).sum::<f64>();
        let (distance, at, along) = match (wedge, own) {
            (Wedge::Varying, Some(own)) => {
                let normal = own.at.normal.map(|n| -n);
                let cosine: f64 = (0..D).map(|k| normal[k] * foot.at.normal[k]).sum();
                let offset = std::array::from_fn(|k| own.at.point[k] - foot.at.point[k]);
                let turned = std::array::from_fn(|k| normal[k] - foot.at.normal[k]);
                if cosine > SAME_LEG {
                    (own.at.distance.abs(), own.at.point, Some((offset, turned)))
                } else {
                    (plane, foot.at.point, None)
                }
            }
            _ => (plane, foot.at.point, None),
        };
        let mut shift = 0.0;
        if let Some((jump, sign)) = jump {
            if let Some(flux) = &jump.flux {
                shift += distance * flux.at(&at) / eta_beyond;
            }
            if let Some(value) = &jump.value {
                // Constant along normals: no derivative of it enters the flux.
                let at = own.map_or(foot.at.point, |own| own.at.point);
                shift += sign * value.at(&at);
            }
        }
        self.kept.push(j);
        self.shifts.push(shift);
        self.across.push(Across { place, leg, distance, along });
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

impl<'a, const D: usize> Leg<'a, D> {
    fn new(problem: &'a Problem<'a, D>, own: u16, foot: Foot<D>) -> Result<Self, MethodError> {
        let eta = [own, foot.beyond].map(|l| problem.materials[l as usize].diffusivity.at(&foot.at.point));
        if let Some(bad) = eta.into_iter().find(|eta| !(*eta > 0.0 && eta.is_finite())) {
            let what = format!(
                "the diffusivity is {bad} at the interface point {:?}; it must be positive and finite up to the \
                 interface",
                foot.at.point
            );
            return Err(MethodError::InvalidProblem { what });
        }
        let jump = problem.jump_between(own, foot.beyond);
        Ok(Self { foot, ratio: eta[0] / eta[1], eta_beyond: eta[1], jump })
    }
}
