//! Ghosts by image points, as the paper has them (section 4.2).
//!
//! A ghost is a node of another region; its intercept is its foot on the interface, its image the mirror point beyond
//! that, in the region whose field is continued. The value at the image is interpolated from the nearest nodes of the
//! region, and the ghost follows from a Taylor expansion of first order (4.7).
//!
//! For the slope at the intercept the paper says only that it is "evaluated from (2.4) using Phi on the other side".
//! Taken for both sides of an interface from slopes alone, nothing would tie the values of one side to those of the
//! other: outer shells would float. So the value at the intercept is that at which the two one-sided differences, from
//! the image and from the ghost's own node, carry the flux that (2.4) asks for. That is the reading here.

use meshless_stencils::{ConstrainedFit, Monomials, StencilError};

use super::constrained::{Ghost, GhostScratch};
use super::foot::{Foot, equation, jump};
use super::ghosts::GhostMaker;
use super::params::Interpolation;
use super::sides::Sides;
use crate::{MethodError, Problem};

/// Nodes of an interpolation of higher degree for each monomial; linear and trilinear ones take as many as unknowns.
const NODES_PER_MONOMIAL: f64 = 1.6;

/// Sum of the absolute coefficients above which an interpolation is taken as undetermined. The nearest nodes of a
/// lattice may lie in a plane or on a cone; a few more are taken then.
const LARGEST_NORM: f64 = 6.0;

/// How often the nodes become half as many again.
const MAX_EXTENSIONS: usize = 6;

/// Makes ghosts by image points.
pub(super) struct ImageGhosts<'a, const D: usize> {
    problem: &'a Problem<'a, D>,
    sides: Sides<'a, D>,
    basis: Basis<D>,
}

/// What is interpolated by.
enum Basis<const D: usize> {
    /// Products of different coordinates: `1, x, y, xy, ...`, (4.8).
    Multilinear,
    /// All monomials up to a degree.
    Complete(Monomials<D>),
}

impl<const D: usize> Basis<D> {
    fn count(&self) -> usize {
        match self {
            Self::Multilinear => 1 << D,
            Self::Complete(monomials) => monomials.count(),
        }
    }

    /// Nodes to begin with.
    fn nodes(&self) -> usize {
        match self {
            Self::Complete(monomials) if monomials.degree() > 1 => {
                (NODES_PER_MONOMIAL * self.count() as f64).ceil() as usize
            }
            _ => self.count(),
        }
    }

    fn evaluate(&self, s: &[f64; D], out: &mut [f64]) {
        match self {
            Self::Multilinear => out.iter_mut().enumerate().for_each(|(subset, value)| {
                *value = (0..D).filter(|k| subset >> k & 1 == 1).map(|k| s[k]).product();
            }),
            Self::Complete(monomials) => monomials.evaluate(s, out),
        }
    }
}

impl<'a, const D: usize> ImageGhosts<'a, D> {
    pub(super) fn new(
        problem: &'a Problem<'a, D>,
        interpolation: Interpolation,
    ) -> Result<Self, MethodError> {
        let basis = match interpolation {
            Interpolation::Trilinear => Basis::Multilinear,
            Interpolation::Complete { degree } => Basis::Complete(Monomials::new(degree)),
        };
        Ok(Self { problem, sides: Sides::new(problem)?, basis })
    }

    /// The value at `x` by interpolation between nodes of a region.
    fn interpolate(
        &self,
        x: &[f64; D],
        region: u16,
        unit: f64,
        scratch: &mut GhostScratch,
    ) -> Result<Ghost, StencilError> {
        let (points, unknowns) = (self.problem.cloud.points(), self.basis.count());
        let mut wanted = self.basis.nodes();
        let mut extensions = 0;
        let GhostScratch { fit, found, own, functional, on_observations, .. } = scratch;
        loop {
            self.sides.nearest(x, None, (region, None), wanted, found, own);
            fit.clear(unknowns);
            for &j in own.iter() {
                let s: [f64; D] = std::array::from_fn(|k| (points[j as usize][k] - x[k]) / unit);
                self.basis.evaluate(&s, fit.observe(1.0));
            }
            let solved = value_at_origin(fit, functional, on_observations);
            let norm = on_observations.iter().map(|e| e.abs()).sum::<f64>();
            if (solved.is_ok() && norm <= LARGEST_NORM) || extensions == MAX_EXTENSIONS || own.len() < wanted
            {
                return solved.map(|()| Ghost {
                    nodes: own.clone(),
                    coefficients: on_observations.clone(),
                    ..Ghost::default()
                });
            }
            (wanted, extensions) = (wanted + wanted.div_ceil(2), extensions + 1);
        }
    }
}

fn value_at_origin(
    fit: &mut ConstrainedFit,
    functional: &mut Vec<f64>,
    coefficients: &mut Vec<f64>,
) -> Result<(), StencilError> {
    fit.factor();
    functional.clear();
    functional.resize(fit.unknowns(), 0.0);
    functional[0] = 1.0;
    coefficients.clear();
    coefficients.resize(fit.observations(), 0.0);
    fit.functional(functional, coefficients, &mut [])
}

impl<const D: usize> GhostMaker<D> for ImageGhosts<'_, D> {
    fn across(
        &self,
        q: usize,
        foot: &Foot<D>,
        [own, other]: [u16; 2],
        scratch: &mut GhostScratch,
    ) -> Result<Ghost, StencilError> {
        let x = &self.problem.cloud.points()[q];
        let distance = (0..D).map(|k| (x[k] - foot.point[k]).powi(2)).sum::<f64>().sqrt();
        let image: [f64; D] = std::array::from_fn(|k| 2.0 * foot.point[k] - x[k]);
        let mut ghost = self.interpolate(&image, own, foot.spacing, scratch)?;
        // With v and w the values at image and ghost node, s the share of the other side in both conductivities, a
        // and b the jumps of value and flux, the value at the intercept is (1 - s) v + s (w - a) - b d / (both), and
        // the ghost is twice that minus v.
        let etas = [own, other]
            .map(|r| equation(&self.problem.materials[r as usize], &foot.point, foot.spacing).eta);
        let both = etas[0] + etas[1];
        let share = etas[1] / both;
        let scale = etas[0].max(etas[1]);
        let jump = jump(self.problem, foot, [own, other], scale);
        let flux = jump.flux * scale / foot.spacing;
        ghost.coefficients.iter_mut().for_each(|e| *e *= 1.0 - 2.0 * share);
        ghost.nodes.push(q as u32);
        ghost.coefficients.push(2.0 * share);
        ghost.constant = -2.0 * (share * jump.value + flux * distance / both);
        Ok(ghost)
    }
}
