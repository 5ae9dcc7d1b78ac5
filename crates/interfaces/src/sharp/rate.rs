//! The mass of a row: what the row says of a source that is `-du/dt`, known at the nodes alone.
//!
//! A row is a functional of values and data. To it a source is a polynomial in every part, and its answer to the
//! monomials is known. So the rates at the nodes are fitted by one polynomial in every part, through the rate of
//! the node itself, and the answer to that is a combination of the nodal rates. Where there is a capacity, polynomials are fitted to it times
//! the rates, in units of the capacity at the first node of each part.

use meshless_stencils::Qr;

use super::basis::{Basis, Jet};
use super::fit::{DECAY, Fit, RANK_TOLERANCE, Row};
use super::interface::InterfacePoint;
use super::maker::Maker;
use super::particular::inverse_laplacian;
use super::stencil::Stencil;

/// Weight of the rate at the node itself beside that of the nodes around it: the polynomial goes through it. (Where it does
/// not, rates that alternate from node to node have hardly any mass: 60 times as stiff on lattices of order 4, and
/// 1500 times on irregular clouds.)
const CENTRE: f64 = 1e4;

/// Share of the absolute entries of the others that the own one has at least; polynomials of a lower degree are taken
/// where it has less. On irregular clouds of order 8 rows at 0.07 are still harmless, negative ones are not.
const LEAST_OWN: f64 = 0.2;

/// The share that is asked for while there are other fits to try. With 0.2 and contrasts of 1e6 stiff nodes beside an interface grew on
/// every fourth cloud of which nodes were moved by a quarter of a spacing.
const WANTED_OWN: f64 = 0.5;

/// Polynomials of one degree for the rates, and the particular parts that belong to them.
#[derive(Debug)]
struct Level<const D: usize> {
    rates: Basis<D>,
    particular: Basis<D>,
    /// Rows: coefficients of the particular parts; columns: those of their Laplacians.
    inverse: Vec<f64>,
}

/// What the masses of all rows share: polynomials from the highest degree down to constants.
#[derive(Debug)]
pub(super) struct Rates<const D: usize> {
    levels: Vec<Level<D>>,
}

/// Memory of one thread.
#[derive(Debug, Default)]
pub(super) struct RateFit<const D: usize> {
    qr: Qr,
    jet: Jet<D>,
    weights: Vec<f64>,
    moments: Vec<f64>,
    /// The same over the monomials of the adapted form; empty where no part has it.
    adapted: Vec<f64>,
    answers: Vec<f64>,
    z: Vec<f64>,
    factors: Vec<f64>,
    /// The capacity that each part is in units of.
    capacities: Vec<f64>,
    /// What jumps that change with time add to the functional that was asked for last.
    pub(super) known: f64,
}

impl<const D: usize> Rates<D> {
    /// For rows of an even order: with rates of two degrees less the error keeps its order.
    pub(super) fn new(order: usize) -> Self {
        let level = |degree: usize| {
            let (rates, particular) = (Basis::complete(degree), Basis::complete(degree + 2));
            let inverse = inverse_laplacian(&rates, &particular);
            Level { rates, particular, inverse }
        };
        Self { levels: (0..order.max(2) - 1).step_by(2).rev().map(level).collect() }
    }

    /// The values at some points of the monomials of the highest degree and below, one list each.
    pub(super) fn monomials(&self, points: &[[f64; D]]) -> Vec<Vec<f64>> {
        let Some(level) = self.levels.first() else { return Vec::new() };
        let mut all = vec![Vec::with_capacity(points.len()); level.rates.len()];
        let mut jet = Jet::default();
        for z in points {
            level.rates.evaluate_values(z, &mut jet);
            all.iter_mut().zip(&jet.values).for_each(|(list, value)| list.push(*value));
        }
        all
    }

    /// Factors of the rates at the nodes of a stencil in the functional that `fit` was asked for last, which is the value
    /// at the first of them.
    pub(super) fn of_value(
        &self,
        maker: &Maker<'_, D>,
        stencil: &Stencil<D>,
        fit: &Fit<D>,
        scratch: &mut RateFit<D>,
        out: &mut Vec<f64>,
    ) {
        for level in &self.levels {
            scratch.functional(level, maker, stencil, fit, out);
            if own_share(out) > LEAST_OWN {
                return;
            }
        }
    }

    /// The same by the highest degree; whether the own rate has the share that is wanted.
    pub(super) fn outweigh(
        &self,
        maker: &Maker<'_, D>,
        stencil: &Stencil<D>,
        fit: &Fit<D>,
        scratch: &mut RateFit<D>,
        out: &mut Vec<f64>,
    ) -> bool {
        self.of_any(maker, stencil, fit, scratch, out);
        own_share(out) >= WANTED_OWN
    }

    /// The same for any functional round any point.
    pub(super) fn of_any(
        &self,
        maker: &Maker<'_, D>,
        stencil: &Stencil<D>,
        fit: &Fit<D>,
        scratch: &mut RateFit<D>,
        out: &mut Vec<f64>,
    ) {
        if let Some(level) = self.levels.first() {
            scratch.functional(level, maker, stencil, fit, out);
        }
    }
}

/// What a row that compares the values on both sides of an interface is multiplied by: its largest factor is 1.
fn unit_of_value<const D: usize>(point: &InterfacePoint<D>, radius: f64) -> f64 {
    let law = &point.law;
    let film = law.resistance * point.sides[usize::from(!law.of_here)].eta / radius;
    1.0 / law.partition.iter().fold(film, |most, k| most.max(1.0 / k))
}

/// The own entry over the absolute ones of the others; none have any where a node is alone.
fn own_share(mass: &[f64]) -> f64 {
    let others: f64 = mass.iter().skip(1).map(|m| m.abs()).sum();
    mass.first().map_or(0.0, |own| own / others)
}

impl<const D: usize> RateFit<D> {
    fn functional(
        &mut self,
        level: &Level<D>,
        maker: &Maker<'_, D>,
        stencil: &Stencil<D>,
        fit: &Fit<D>,
        out: &mut Vec<f64>,
    ) {
        self.capacities.clear();
        self.capacities.resize(stencil.parts.len(), 1.0);
        for (&j, &part) in stencil.nodes.iter().zip(&stencil.part_of).rev() {
            self.capacities[part] = maker.capacity(j as usize);
        }
        self.answer(level, maker, stencil, fit);
        self.assemble(level, maker, stencil);
        if stencil.parts.len() > 1 || !self.qr.factor(RANK_TOLERANCE) {
            self.assemble(level, maker, stencil);
            self.qr.factor_pivoted(RANK_TOLERANCE);
        }
        self.z.resize(self.answers.len(), 0.0);
        self.factors.resize(self.qr.rows(), 0.0);
        // What the nodes do not determine is left out of the polynomials.
        self.qr.least_norm(&self.answers, &mut self.z, &mut self.factors);
        out.clear();
        out.extend(self.factors.iter().zip(&self.weights).map(|(f, w)| f * w));
        for (factor, (&j, &part)) in out.iter_mut().zip(stencil.nodes.iter().zip(&stencil.part_of)) {
            *factor *= maker.capacity(j as usize) / self.capacities[part];
        }
        let of_points = self.factors[stencil.nodes.len()..].chunks_exact(2).zip(&stencil.points);
        let weight = maker.params.jump_weight;
        let known = of_points.map(|(factors, &(index, _))| {
            let point = &maker.interfaces.points[index as usize];
            let flux = stencil.radius * point.rates[1] / point.largest();
            let value = point.rates[0] * unit_of_value(point, stencil.radius);
            weight * (factors[0] * value + factors[1] * flux)
        });
        self.known = known.sum();
    }

    /// What the functional answers to `-du/dt` in place of f, for every monomial of every part; on the left-hand side.
    fn answer(&mut self, level: &Level<D>, maker: &Maker<'_, D>, stencil: &Stencil<D>, fit: &Fit<D>) {
        let (count, size) = (level.rates.len(), level.particular.len());
        let mut jet = std::mem::take(&mut self.jet);
        self.answers.clear();
        self.answers.resize(count * stencil.parts.len(), 0.0);
        self.adapted.clear();
        self.moments.clear();
        self.moments.resize(size * stencil.parts.len(), 0.0);
        for term in &fit.terms {
            let factor = fit.factors[term.row];
            if fit.parts.response(term.part).is_some() {
                level.particular.evaluate(&term.z, &mut jet);
                let moments = &mut self.moments[term.part * size..][..size];
                (0..size).for_each(|m| moments[m] += factor * term.functional.apply(&jet, m));
            } else if let (Some(adapted), Some(_)) = (&maker.adapted, fit.parts.of_rates(term.part, 0)) {
                let width = adapted.basis.len();
                self.adapted.resize(width * stencil.parts.len(), 0.0);
                adapted.basis.evaluate(&term.z, &mut jet);
                let moments = &mut self.adapted[term.part * width..][..width];
                (0..width).for_each(|m| moments[m] += factor * term.functional.apply(&jet, m));
            } else if term.equation != 0.0 {
                level.rates.evaluate(&term.z, &mut jet);
                let answers = &mut self.answers[term.part * count..][..count];
                answers.iter_mut().zip(&jet.values).for_each(|(a, v)| *a += factor * term.equation * v);
            }
        }
        if let (Some(adapted), false) = (&maker.adapted, self.adapted.is_empty()) {
            let width = adapted.basis.len();
            let parts = self.answers.chunks_exact_mut(count).zip(self.adapted.chunks_exact(width));
            for (part, (answers, moments)) in parts.enumerate() {
                let Some(particular) = fit.parts.of_rates(part, width) else { continue };
                for (answer, coefficients) in answers.iter_mut().zip(particular.chunks_exact(width)) {
                    *answer += coefficients.iter().zip(moments).map(|(c, m)| c * m).sum::<f64>();
                }
            }
        }
        let parts = self.answers.chunks_exact_mut(count).zip(self.moments.chunks_exact(size));
        for (part, (answers, moments)) in parts.enumerate() {
            let Some(response) = fit.parts.response(part) else { continue };
            for (moment, row) in moments.iter().zip(level.inverse.chunks_exact(count)) {
                answers.iter_mut().zip(row).for_each(|(a, inverse)| *a += response * moment * inverse);
            }
        }
        for (answers, capacity) in self.answers.chunks_exact_mut(count).zip(&self.capacities) {
            answers.iter_mut().for_each(|answer| *answer *= capacity);
        }
        self.jet = jet;
    }

    /// The polynomials of the rates: values at the nodes, and at the interface the conditions of u that time leaves.
    fn assemble(&mut self, level: &Level<D>, maker: &Maker<'_, D>, stencil: &Stencil<D>) {
        let count = level.rates.len();
        let columns = count * stencil.parts.len();
        let points = maker.problem.cloud.points();
        let radius = stencil.radius;
        let local =
            |x: &[f64; D]| -> [f64; D] { std::array::from_fn(|k| (x[k] - stencil.center[k]) / radius) };
        self.qr.resize(stencil.nodes.len() + 2 * stencil.points.len(), columns);
        (0..columns).for_each(|column| self.qr.column_mut(column).fill(0.0));
        self.weights.clear();
        for (row, (&j, &part)) in stencil.nodes.iter().zip(&stencil.part_of).enumerate() {
            let z = local(&points[j as usize]);
            let squared = z.iter().map(|z| z * z).sum::<f64>();
            let weight = if squared == 0.0 { CENTRE } else { (-DECAY * squared).exp() };
            self.weights.push(weight);
            level.rates.evaluate(&z, &mut self.jet);
            self.put(row, part * count, &Row::of_value(weight));
        }
        let weight = maker.params.jump_weight;
        for (k, &(index, places)) in stencil.points.iter().enumerate() {
            let point = &maker.interfaces.points[index as usize];
            let row = stencil.nodes.len() + 2 * k;
            let largest = point.largest();
            level.rates.evaluate(&local(&maker.interfaces.places[index as usize]), &mut self.jet);
            let unit = unit_of_value(point, radius);
            for (s, sign) in [-1.0, 1.0].into_iter().enumerate() {
                let side = &point.sides[s];
                // Of the rates themselves: the polynomial over the capacity.
                let ratio = self.capacities[places[s]] / side.capacity;
                let slope = |strength: f64| Row {
                    value: -strength * radius * side.capacity_slope,
                    gradient: point.normal.map(|n| strength * n),
                    ..Row::of_value(0.0)
                };
                let mut value = Row::of_value(sign * unit * weight * ratio / point.law.partition[s]);
                if point.law.resistance != 0.0 && s == usize::from(!point.law.of_here) {
                    let film = slope(-unit * weight * ratio * point.law.resistance * side.eta / radius);
                    value = Row { value: value.value + film.value, ..film };
                }
                self.put(row, places[s] * count, &value);
                self.put(row + 1, places[s] * count, &slope(sign * weight * ratio * side.eta / largest));
            }
        }
    }

    /// Adds the functional of the polynomial of a part, whose columns begin at `first`, to a row.
    fn put(&mut self, row: usize, first: usize, functional: &Row<D>) {
        for m in 0..self.jet.values.len() {
            self.qr.column_mut(first + m)[row] = functional.apply(&self.jet, m);
        }
    }
}
