//! The constrained particle derivative approximation (Yoon & Song, section 2.2), in any dimension and of any degree.
//!
//! On the side S of the node, u is a polynomial q; beyond the interface, where the distance from it is d,
//! `u = q + d (g/kappa_O + (kappa_S/kappa_O - 1) dq/dn) + a` with the derivative at the interface: so the fluxes differ by
//! g and the values by a. That is the paper's `p + (1/2) [du/dn] |d|` (35) with `p = q + (1/2) [du/dn] d`: the same
//! functions, so the same least-squares fit. In this form derivatives at the node are those of q alone; and in
//! coordinates along and across the interface with their origin on it, only the polynomial `d` itself has a slope across
//! the interface, so that one column of the fit knows of the contrast, whatever its size.

use meshless_stencils::{FitParams, FitScratch, Functional, LocalFit, StencilError};

use crate::particle_difference::ParticleDifferenceParams;
use crate::particle_difference::feet::Feet;
use crate::particle_difference::frame::Frame;
use crate::particle_difference::wedge::Sides;
use crate::{MethodError, Problem};

/// Fits over the supports of nodes near interfaces.
pub(super) struct ConstrainedFit<'a, const D: usize> {
    problem: &'a Problem<'a, D>,
    feet: &'a Feet<D>,
    params: ParticleDifferenceParams,
    fit: LocalFit<D>,
}

/// Memory of one thread.
pub(super) struct ConstrainedScratch<'a, const D: usize> {
    pub(super) sides: Sides<'a, D>,
    fit: FitScratch<D>,
    offsets: Vec<[f64; D]>,
    weights: Vec<f64>,
    moments: Vec<f64>,
    coefficients: Vec<f64>,
    slopes: Slopes<D>,
    frame: Frame<D>,
    origin: [f64; D],
    radius: f64,
}

/// What the slopes across interfaces add to the polynomials beyond them.
#[derive(Default)]
struct Slopes<const D: usize> {
    /// Polynomial, point, value.
    added: Vec<(usize, usize, f64)>,
    /// By what every polynomial is multiplied, so that none dwarfs the others.
    scales: Vec<f64>,
    /// First derivatives of the polynomials at a foot, by axis, and those of the derivative across.
    first: [Vec<f64>; 3],
    mixed: [Vec<f64>; 3],
}

impl<'a, const D: usize> ConstrainedFit<'a, D> {
    pub(super) fn new(
        problem: &'a Problem<'a, D>,
        feet: &'a Feet<D>,
        params: ParticleDifferenceParams,
    ) -> Self {
        let fit = LocalFit::new(FitParams { degree: params.degree, ..FitParams::default() });
        Self { problem, feet, params, fit }
    }

    pub(super) fn scratch(&self) -> ConstrainedScratch<'a, D> {
        let most = self.problem.supports.lists.max_count() + 1;
        ConstrainedScratch {
            sides: Sides::default(),
            fit: self.fit.scratch(most),
            offsets: Vec::with_capacity(most),
            weights: Vec::with_capacity(most),
            moments: Vec::new(),
            coefficients: Vec::with_capacity(most),
            slopes: Slopes::default(),
            frame: Frame::new(&std::array::from_fn(|k| if k == 0 { 1.0 } else { 0.0 })),
            origin: [0.0; D],
            radius: 1.0,
        }
    }

    /// Sorts the neighbours of node i by sides; those that take part are in `sides.kept` afterwards.
    pub(super) fn sort(
        &self,
        i: usize,
        neighbors: &[u32],
        scratch: &mut ConstrainedScratch<'a, D>,
    ) -> Result<(), MethodError> {
        scratch.sides.sort(self.problem, self.feet, self.params.wedge, i, neighbors)
    }

    /// Factors the fit at node i over the neighbours that were sorted.
    pub(super) fn factor(
        &self,
        i: usize,
        scratch: &mut ConstrainedScratch<'a, D>,
    ) -> Result<(), MethodError> {
        let points = self.problem.cloud.points();
        let x = &points[i];
        let axis = std::array::from_fn(|k| if k == 0 { 1.0 } else { 0.0 });
        let (origin, frame) = scratch.sides.frame().unwrap_or((*x, Frame::new(&axis)));
        (scratch.origin, scratch.frame) = (origin, frame);
        scratch.offsets.clear();
        scratch.weights.clear();
        let radii = self.problem.supports.radius;
        scratch.radius = radii[i];
        for j in std::iter::once(i).chain(scratch.sides.kept.iter().map(|&j| j as usize)) {
            let distance = (0..D).map(|k| (points[j][k] - x[k]).powi(2)).sum::<f64>().sqrt();
            scratch.weights.push(self.params.weight.value(distance, radii[i], radii[j]));
            scratch.offsets.push(frame.turn(&std::array::from_fn(|k| points[j][k] - origin[k])));
            scratch.radius = scratch.radius.max(distance);
        }
        for across in &scratch.sides.across {
            scratch.weights[across.place + 1] *= scratch.sides.legs[across.leg].weight(&self.params);
        }
        self.slopes(scratch).map_err(|source| MethodError::stencil(i, x, source))?;
        let ConstrainedScratch { fit, offsets, weights, slopes, radius, .. } = scratch;
        let edit = |basis: &mut meshless_stencils::BasisValues<'_>| {
            slopes.added.iter().for_each(|&(function, point, value)| basis.add(function, point, value));
            slopes.scales.iter().enumerate().for_each(|(function, &scale)| {
                if scale != 1.0 {
                    basis.scale(function, scale);
                }
            });
        };
        self.fit
            .factor_with(offsets, weights, *radius, 0, &edit, fit)
            .map_err(|source| MethodError::stencil(i, x, source))?;
        Ok(())
    }

    /// What the polynomials have beyond the interfaces more than on this side.
    fn slopes(&self, scratch: &mut ConstrainedScratch<'a, D>) -> Result<(), StencilError> {
        let count = self.fit.monomials().count();
        let ConstrainedScratch { slopes, sides, frame, radius, .. } = scratch;
        slopes.added.clear();
        slopes.scales.clear();
        slopes.scales.resize(count, 1.0);
        let Some((origin, _)) = sides.frame() else { return Ok(()) };
        let mut current = usize::MAX;
        for across in &sides.across {
            let leg = &sides.legs[across.leg];
            let normal = frame.turn(&leg.foot.at.normal);
            let bend = frame.turn(&leg.bend.by_gradient);
            if current != across.leg {
                current = across.leg;
                let at = frame.turn(&std::array::from_fn(|k| leg.foot.at.point[k] - origin[k]));
                self.derivatives(&normal, &at, *radius, slopes)?;
            }
            let along = across.along.map(|(offset, turned)| (frame.turn(&offset), frame.turn(&turned)));
            let factor = (leg.ratio - 1.0) * across.distance;
            for function in 0..count {
                let mut slope: f64 = (0..D).map(|k| normal[k] * slopes.first[k][function]).sum();
                if let Some((offset, turned)) = &along {
                    let beside: f64 = (0..D).map(|k| normal[k] * offset[k]).sum();
                    for k in 0..D {
                        let tangential = offset[k] - beside * normal[k];
                        slope +=
                            tangential * slopes.mixed[k][function] + turned[k] * slopes.first[k][function];
                    }
                }
                let bend: f64 = (0..D).map(|k| bend[k] * slopes.first[k][function]).sum();
                let value = factor * slope + across.bend * bend;
                if value != 0.0 {
                    slopes.added.push((function, across.place + 1, value));
                    let weighted = value.abs() * leg.weight(&self.params);
                    slopes.scales[function] = slopes.scales[function].max(weighted);
                }
            }
        }
        slopes.scales.iter_mut().for_each(|s| *s = 1.0 / *s);
        Ok(())
    }

    /// Derivatives of the polynomials at a foot.
    fn derivatives(
        &self,
        normal: &[f64; D],
        at: &[f64; D],
        radius: f64,
        slopes: &mut Slopes<D>,
    ) -> Result<(), StencilError> {
        let count = self.fit.monomials().count();
        for k in 0..D {
            slopes.first[k].clear();
            slopes.first[k].resize(count, 0.0);
            self.fit.moments_at(&Functional::Partial(k), at, radius, &mut slopes.first[k])?;
        }
        if self.params.wedge == crate::particle_difference::Wedge::Plane {
            return Ok(());
        }
        let mut second = vec![0.0; count];
        for k in 0..D {
            slopes.mixed[k].clear();
            slopes.mixed[k].resize(count, 0.0);
            for (l, n) in normal.iter().enumerate().filter(|(_, n)| **n != 0.0) {
                second.fill(0.0);
                self.fit.moments_at(&Functional::Second(k, l), at, radius, &mut second)?;
                slopes.mixed[k].iter_mut().zip(&second).for_each(|(m, s)| *m += n * s);
            }
        }
        Ok(())
    }

    /// Coefficients of an operator at the node on the values of the kept neighbours, less their shifts; that of the
    /// node is minus their sum for an operator that annihilates constants.
    pub(super) fn coefficients(
        &self,
        functional: &Functional<D>,
        scratch: &mut ConstrainedScratch<'a, D>,
        out: &mut Vec<f64>,
    ) -> Result<(), StencilError> {
        let (turned, at) = (turned(functional, &scratch.frame), scratch.offsets[0]);
        self.coefficients_at(&turned, &at, scratch, out)
    }

    /// The same for the derivative of this side's polynomial along a vector, at a point.
    pub(super) fn slope_at(
        &self,
        point: &[f64; D],
        along: &[f64; D],
        scratch: &mut ConstrainedScratch<'a, D>,
        out: &mut Vec<f64>,
    ) -> Result<(), StencilError> {
        let (origin, frame) = (scratch.origin, scratch.frame);
        let at = frame.turn(&std::array::from_fn(|k| point[k] - origin[k]));
        self.coefficients_at(&Functional::Directional(frame.turn(along)), &at, scratch, out)
    }

    /// The same in the coordinates of the frame.
    fn coefficients_at(
        &self,
        functional: &Functional<D>,
        at: &[f64; D],
        scratch: &mut ConstrainedScratch<'a, D>,
        out: &mut Vec<f64>,
    ) -> Result<(), StencilError> {
        let count = scratch.offsets.len();
        scratch.moments.clear();
        scratch.moments.resize(self.fit.monomials().count(), 0.0);
        self.fit.moments_at(functional, at, scratch.radius, &mut scratch.moments)?;
        scratch.moments.iter_mut().zip(&scratch.slopes.scales).for_each(|(m, s)| *m *= s);
        scratch.coefficients.resize(count, 0.0);
        self.fit.coefficients_for(&scratch.moments, &mut scratch.fit, &mut scratch.coefficients)?;
        out.clear();
        out.extend_from_slice(&scratch.coefficients[1..]);
        Ok(())
    }

    /// The vector of the null space that favours the node itself, on the kept neighbours; it is 1 at the node.
    pub(super) fn correction<'s>(
        &self,
        scratch: &'s mut ConstrainedScratch<'a, D>,
    ) -> Result<&'s [f64], StencilError> {
        scratch.coefficients.resize(scratch.offsets.len(), 0.0);
        self.fit.correction(0, &mut scratch.fit, &mut scratch.coefficients)?;
        Ok(&scratch.coefficients[1..])
    }
}

/// The functional in the coordinates of the frame.
fn turned<const D: usize>(functional: &Functional<D>, frame: &Frame<D>) -> Functional<D> {
    match *functional {
        Functional::Partial(axis) => {
            Functional::Directional(frame.turn(&std::array::from_fn(|k| f64::from(u8::from(k == axis)))))
        }
        Functional::Directional(v) => Functional::Directional(frame.turn(&v)),
        Functional::Diffusion { eta, gradient } => {
            Functional::Diffusion { eta, gradient: frame.turn(&gradient) }
        }
        other => other,
    }
}
