//! Everything that the fits of all nodes share, and the rows that they make.

use meshless_neighbors::CellList;

use super::adapted::Adapted;
use super::basis::Basis;
use super::fit::{Combination, Fit};
use super::interface::InterfacePoints;
use super::operator::Operator;
use super::params::{Form, SharpParams};
use super::particular::Particular;
use super::rate::{RateFit, Rates};
use super::stencil::{Heard, Stencil};
use super::thickness;
use super::unknowns::Unknowns;
use super::vertex::Vertices;
use crate::parallel;
use crate::{Condition, GradientRow, Material, MethodError, Problem};

/// What is left of the reproduction of a value before a larger stencil is tried.
const REPRODUCTION: f64 = 1e-6;

/// How often a stencil is enlarged, by half each time.
const ENLARGEMENTS: usize = 3;

/// Step of difference quotients of the diffusivity, over the spacing, where no derivative is given.
const GRADIENT_STEP: f64 = 1e-4;

/// Least weight that the own value may leave to the others: below it the row would say nothing.
const LEAST_COMPLEMENT: f64 = 1e-10;

/// `exchange u + eta du/dn = flux` at a boundary node.
#[derive(Debug, Clone, Copy)]
pub(super) struct BoundaryRow<const D: usize> {
    pub(super) normal: [f64; D],
    pub(super) exchange: f64,
    pub(super) flux: f64,
}

/// What all fits share.
pub(super) struct Maker<'a, const D: usize> {
    pub(super) problem: &'a Problem<'a, D>,
    pub(super) params: SharpParams,
    /// Particular parts of sources where the diffusivity is constant; `None` where there is nothing to fit.
    pub(super) particular: Option<Particular<D>>,
    /// Solutions where it varies; `None` where it nowhere does, and in the general form.
    pub(super) adapted: Option<Adapted<D>>,
    pub(super) complete_basis: Basis<D>,
    pub(super) harmonic_basis: Basis<D>,
    /// Polynomials for `du/dt`; none in steady scenes.
    pub(super) rates: Option<Rates<D>>,
    pub(super) unknowns: &'a Unknowns,
    pub(super) interfaces: &'a InterfacePoints<D>,
    /// Vertices where functions of their own take the place of polynomials.
    pub(super) vertices: Vertices,
    pub(super) boundary_rows: Vec<Vec<BoundaryRow<D>>>,
    /// The equation at every node, beside the source; none where it is the Laplacian everywhere.
    operators: Option<Vec<Operator<D>>>,
    /// The factor of du/dt at every node; none where it is 1 everywhere.
    capacities: Option<Vec<f64>>,
    /// Whether a constant solves the equation without data, in every region and across every interface.
    pub(super) keeps_constants: bool,
    nodes: &'a CellList<'a, D>,
    points: CellList<'a, D>,
}

/// Memory of one thread.
#[derive(Debug, Default)]
pub(super) struct Scratch<const D: usize> {
    pub(super) stencil: Stencil<D>,
    pub(super) fit: Fit<D>,
    pub(super) combination: Combination,
    pub(super) rates: RateFit<D>,
    /// Factors of the rates at the nodes of the stencil; empty in steady scenes.
    pub(super) mass: Vec<f64>,
    /// Whether they are those of the value at the node that was factored last.
    has_mass: bool,
}

/// The row of a node: `w_i = sum_j h_j w_j + sum_K H_K C_K + known`, divided by what the own value leaves.
#[derive(Debug, Clone)]
pub(super) struct Row {
    pub(super) node: usize,
    pub(super) neighbors: Vec<u32>,
    /// Off-diagonal entries, in the order of the neighbours.
    pub(super) coefficients: Vec<f64>,
    pub(super) row_sum: f64,
    /// Coefficients of constants: cluster, value.
    pub(super) constants: Vec<(u32, f64)>,
    pub(super) rhs: f64,
    /// Entries of the mass, that of the node itself first; empty in steady scenes.
    pub(super) mass: Vec<f64>,
    pub(super) crosses: bool,
    /// The vertex whose functions its fit has.
    pub(super) vertex: Option<usize>,
    /// Whether it is the balance over the node's cell.
    pub(super) balanced: bool,
    pub(super) enlarged: bool,
    /// The gradient at the node, where it is kept.
    pub(super) gradient: Option<GradientRow>,
}

impl<'a, const D: usize> Maker<'a, D> {
    pub(super) fn new(
        problem: &'a Problem<'a, D>,
        params: SharpParams,
        unknowns: &'a Unknowns,
        nodes: &'a CellList<'a, D>,
        interfaces: &'a InterfacePoints<D>,
    ) -> Result<Self, MethodError> {
        let widest = problem.cloud.spacing().iter().fold(0.0_f64, |a, &b| a.max(b));
        let is_constant = |m: &Material<D>| m.diffusivity.as_constant().is_some();
        let is_fitted =
            |m: &Material<D>| is_constant(m) && m.source.as_ref().is_some_and(|f| f.as_constant().is_none());
        let trefftz = params.form == Form::Trefftz;
        let fitted = trefftz && problem.materials.iter().any(is_fitted);
        let adapted = trefftz && !problem.materials.iter().all(|m| is_constant(m) && !m.has_lower_terms());
        let harmonic_basis = Basis::harmonic(params.degree());
        Ok(Self {
            problem,
            params,
            particular: fitted.then(|| Particular::new(params.source_degree())),
            adapted: adapted.then(|| Adapted::new(&harmonic_basis, params.source_degree())),
            complete_basis: Basis::complete(params.degree()),
            harmonic_basis,
            rates: params.unsteady.then(|| Rates::new(params.order)),
            unknowns,
            interfaces,
            vertices: Vertices::find(problem, &params, unknowns, nodes),
            boundary_rows: boundary_rows(problem)?,
            operators: operators(problem),
            capacities: (params.unsteady && problem.has_capacities())
                .then(|| parallel::map(problem.cloud.len(), |i| problem.capacity(i))),
            keeps_constants: problem.materials.iter().all(|m| m.reaction.is_none())
                && problem.laws.iter().all(|law| law.partition[0] == law.partition[1]),
            nodes,
            points: CellList::new(&interfaces.places, 3.0 * widest)?,
        })
    }

    /// The equation at a node, beside the source.
    pub(super) fn operator(&self, j: usize) -> Operator<D> {
        self.operators.as_ref().map_or(Operator::LAPLACIAN, |operators| operators[j])
    }

    /// The factor of du/dt at a node.
    pub(super) fn capacity(&self, j: usize) -> f64 {
        self.capacities.as_ref().map_or(1.0, |capacities| capacities[j])
    }

    /// Whether rows may be balances over cells: those of steady diffusion.
    pub(super) fn may_balance(&self) -> bool {
        D > 1 && self.rates.is_none() && !self.problem.has_lower_terms()
    }

    /// The conditions on the flux at a node that a fit has as rows: functions of a vertex meet all but those at the ends of an edge.
    pub(super) fn conditions<'r>(
        &'r self,
        j: u32,
        stencil: &Stencil<D>,
    ) -> impl Iterator<Item = &'r BoundaryRow<D>> + use<'r, 'a, D> {
        let vertex = stencil.vertex.map(|vertex| self.vertices.get(vertex));
        let rows = self.boundary_rows[j as usize].iter();
        rows.filter(move |row| vertex.is_none_or(|vertex| vertex.is_ended_by(&row.normal)))
    }

    /// Gathers and factors the stencil of node i, a larger one where the first does not determine its value. Leaves
    /// the combination of the value in `scratch`; returns whether the stencil was enlarged.
    pub(super) fn factor(&self, i: usize, scratch: &mut Scratch<D>) -> Result<bool, MethodError> {
        let center = &self.problem.cloud.points()[i];
        let part = self.unknowns.part[i];
        scratch.has_mass = false;
        let outcome = match &self.rates {
            Some(rates) => self.factor_in_time((center, part), rates, scratch),
            None => self.factor_at((center, part, Heard::All), scratch, determined),
        };
        outcome.ok_or_else(|| MethodError::Unresolved {
            node: i,
            position: center.to_vec(),
            nodes: scratch.stencil.nodes.len(),
            spacing: thickness::resolving_spacing(self.problem, i),
        })
    }

    /// The same for a gradient: the value of the node, which may be prescribed, need not be what others predict.
    pub(super) fn factor_for_gradient(&self, i: usize, scratch: &mut Scratch<D>) -> Result<(), MethodError> {
        let Err(error) = self.factor(i, scratch) else { return Ok(()) };
        let center = &self.problem.cloud.points()[i];
        let at = (center, self.unknowns.part[i], Heard::All);
        self.factor_at(at, scratch, |_| true).map(|_| ()).ok_or(error)
    }

    /// In time a row that answers to a source by the wrong sign would make its node grow by itself, and so may one to which the
    /// rates of the nodes around it are more than its own. Of what fits may hear, the first is taken that leads to neither; then
    /// the first with the right sign; then an equation without du/dt.
    fn factor_in_time(
        &self,
        (center, part): (&[f64; D], u32),
        rates: &Rates<D>,
        scratch: &mut Scratch<D>,
    ) -> Option<bool> {
        let right = |combination: &Combination| determined(combination) && combination.unit_source > 0.0;
        let outweighing = |heard: Heard, scratch: &mut Scratch<D>| {
            let enlarged = self.factor_at((center, part, heard), scratch, right)?;
            let Scratch { stencil, fit, rates: fitted, mass, .. } = scratch;
            scratch.has_mass = rates.outweigh(self, stencil, fit, fitted, mass);
            scratch.has_mass.then_some(enlarged)
        };
        let first = Heard::IN_TIME.into_iter().find_map(|heard| outweighing(heard, scratch));
        first
            .or_else(|| {
                let mut heard = Heard::IN_TIME.into_iter();
                heard.find_map(|heard| self.factor_at((center, part, heard), scratch, right))
            })
            .or_else(|| self.factor_at((center, part, Heard::All), scratch, determined))
    }

    /// What a source of 1 adds to the value of node i, about.
    fn typical(&self, i: usize) -> f64 {
        let level = self.problem.eta[i] * self.unknowns.scale[self.unknowns.part[i] as usize];
        self.problem.cloud.spacing()[i].powi(2) / (4.0 * D as f64 * level)
    }

    /// The same round any point of a part, by what is heard; `None` where no stencil determines the value or is accepted.
    pub(super) fn factor_at(
        &self,
        (center, own, heard): (&[f64; D], u32, Heard),
        scratch: &mut Scratch<D>,
        accept: impl Fn(&Combination) -> bool,
    ) -> Option<bool> {
        let Scratch { stencil, fit, combination, .. } = scratch;
        let mut count = self.params.stencil_nodes(D);
        for attempt in 0..=ENLARGEMENTS {
            let at = (center, own, heard);
            let interfaces = (self.interfaces, &self.points);
            stencil.gather(at, count, self.nodes, self.unknowns, interfaces, &self.vertices);
            fit.factor(self, stencil);
            let remainder = fit.functional(self, stencil, None, combination);
            if remainder <= REPRODUCTION && accept(combination) {
                return Some(attempt > 0);
            }
            count += count / 2;
        }
        None
    }

    /// Whether an interface has a sampled point so near.
    pub(super) fn has_interface_within(&self, x: &[f64; D], radius: f64) -> bool {
        let mut found = Vec::new();
        self.points.within(x, radius, &mut found);
        !found.is_empty()
    }

    /// The node nearest to a point.
    pub(super) fn nearest_one(&self, x: &[f64; D]) -> Option<usize> {
        self.nodes.nearest_one(x).map(|j| j as usize)
    }

    /// The node nearest to a point that is of a region.
    pub(super) fn nearest_of(&self, label: u16, x: &[f64; D]) -> Option<usize> {
        let asked = 2 * self.params.stencil_nodes(D);
        let mut found = Vec::new();
        let nearest = self.nodes.nearest(x, asked, &mut found);
        nearest.map(|j| j as usize).find(|&j| self.problem.labels[j] == label)
    }

    /// The row of node i.
    pub(super) fn row(&self, i: usize, scratch: &mut Scratch<D>) -> Result<Row, MethodError> {
        let enlarged = self.factor(i, scratch)?;
        let Scratch { stencil, fit, combination, rates, mass, has_mass } = scratch;
        let mut known = combination.known;
        if let Some(polynomials) = &self.rates {
            if !*has_mass {
                polynomials.of_value(self, stencil, fit, rates, mass);
            }
            if combination.unit_source > 0.0 {
                known -= rates.known;
            } else {
                // No stencil has it right: an equation without du/dt.
                mass.fill(0.0);
            }
        }
        let part = stencil.parts[0];
        // A row reads as the equation does: a source of 1 would stand on its right-hand side as the volume.
        let volume = self.problem.cloud.spacing()[i].powi(D as i32);
        let unit = combination.unit_source.abs();
        let factor = volume / unit.max(self.typical(i));
        let neighbors = stencil.nodes[1..].to_vec();
        let coefficients: Vec<f64> = combination.values[1..].iter().map(|h| -factor * h).collect();
        let uniform =
            |&other: &u32| self.unknowns.scale[other as usize] == self.unknowns.scale[part as usize];
        let held = stencil.vertex.is_some_and(|vertex| self.vertices.get(vertex).is_held());
        let exchanges = |&j: &u32| self.boundary_rows[j as usize].iter().any(|row| row.exchange != 0.0);
        // Constants are reproduced where nothing but differences is prescribed: no rounding remains of their sum.
        let keeps_constants = self.keeps_constants && !held && stencil.parts.iter().all(uniform);
        let row_sum = if keeps_constants && !stencil.nodes.iter().any(exchanges) {
            0.0
        } else {
            factor * (1.0 - combination.values[0]) + coefficients.iter().sum::<f64>()
        };
        let mut constants: Vec<(u32, f64)> = Vec::new();
        for share in &combination.constants {
            let part = |place: usize| stencil.parts[place];
            for (cluster, sigma) in self.unknowns.shares(part(share.of), share.less.map(part)) {
                let value = -factor * sigma * share.factor;
                match constants.iter_mut().find(|(c, _)| *c == cluster) {
                    Some((_, sum)) => *sum += value,
                    None => constants.push((cluster, value)),
                }
            }
        }
        let rhs = factor * known;
        Ok(Row {
            node: i,
            neighbors,
            coefficients,
            row_sum,
            constants,
            rhs,
            mass: mass.iter().map(|m| factor * m).collect(),
            crosses: stencil.parts.len() > 1,
            vertex: stencil.vertex,
            balanced: false,
            enlarged,
            gradient: self.keeps_gradients().then(|| self.gradient_row(scratch)),
        })
    }
}

/// Whether the value of a node is what others predict.
fn determined(combination: &Combination) -> bool {
    1.0 - combination.values[0] > LEAST_COMPLEMENT
}

fn boundary_rows<const D: usize>(problem: &Problem<'_, D>) -> Result<Vec<Vec<BoundaryRow<D>>>, MethodError> {
    let mut rows = vec![Vec::new(); problem.cloud.len()];
    for (node, conditions) in problem.cloud.boundary().iter().zip(problem.conditions) {
        let i = node.node as usize;
        for (touch, condition) in node.touches.iter().zip(conditions) {
            if matches!(condition, Condition::Dirichlet(_)) {
                continue;
            }
            let (exchange, flux) = condition.as_flux(problem.eta[i]).ok_or_else(|| {
                MethodError::RobinWithoutFlux { node: i, position: problem.cloud.points()[i].to_vec() }
            })?;
            rows[i].push(BoundaryRow { normal: touch.normal, exchange, flux });
        }
    }
    Ok(rows)
}

fn operators<const D: usize>(problem: &Problem<'_, D>) -> Option<Vec<Operator<D>>> {
    if problem.materials.iter().all(|m| m.diffusivity.as_constant().is_some() && !m.has_lower_terms()) {
        return None;
    }
    let operator = |i: usize| {
        let material = &problem.materials[problem.labels[i] as usize];
        let step = GRADIENT_STEP * problem.cloud.spacing()[i];
        Operator::of(material, problem.eta[i], &problem.cloud.points()[i], step)
    };
    Some(parallel::map(problem.cloud.len(), operator))
}
