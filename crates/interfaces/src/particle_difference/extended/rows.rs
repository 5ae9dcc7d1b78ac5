//! Rows over nodes and jumps.

use meshless_stencils::{FitParams, FitScratch, Functional, LocalFit, StencilError, Weight};

use super::joint::JointFit;
use super::points::{InterfacePoints, Point, separation};
use crate::gfdm::add_correction;
use crate::local::enlarged_support;
use crate::particle_difference::feet::{Feet, Foot, may_jump};
use crate::particle_difference::fit::ConstrainedScratch;
use crate::particle_difference::leg::GRADIENT_STEP;
use crate::particle_difference::rows::{calmest, own_share};
use crate::particle_difference::{ParticleDifferenceParams, Wedge};
use crate::{MethodError, Problem};

/// A row `sum_j c_j (u_j - u_i) + r u_i + sum_k e_k J_k = b`; that of a point has no node i of its own, and its first sum
/// is `sum_j c_j u_j`.
#[derive(Debug, Clone, Default)]
pub(super) struct ExtendedRow {
    pub(super) nodes: Vec<(u32, f64)>,
    pub(super) jumps: Vec<(u32, f64)>,
    pub(super) row_sum: f64,
    pub(super) rhs: f64,
    pub(super) enlarged: bool,
}

impl ExtendedRow {
    /// The own entry of node i over the absolute ones of the others, once the jumps are eliminated by their equations, which have no
    /// others in them.
    fn own_share(&self, i: usize, of_points: &[ExtendedRow]) -> f64 {
        let mut entries = self.nodes.clone();
        for &(k, c) in &self.jumps {
            let point = &of_points[k as usize];
            let own: f64 = point.jumps.iter().map(|jump| jump.1).sum();
            entries.extend(point.nodes.iter().map(|&(j, of_node)| (j, -c * of_node / own)));
        }
        merge(&mut entries);
        // Rows are minus the operator.
        let others: Vec<f64> = entries.iter().filter(|e| e.0 as usize != i).map(|e| -e.1).collect();
        own_share(&others)
    }
}

/// Makes the rows.
pub(super) struct RowMaker<'a, const D: usize> {
    problem: &'a Problem<'a, D>,
    feet: &'a Feet<D>,
    points: &'a InterfacePoints<D>,
    params: ParticleDifferenceParams,
    fit: LocalFit<D>,
    /// Where u changes with time.
    joint: Option<JointFit<'a, D>>,
}

/// Memory of one thread.
pub(super) struct Scratch<'a, const D: usize> {
    joint: Option<ConstrainedScratch<'a, D>>,
    fit: FitScratch<D>,
    nodes: Vec<u32>,
    offsets: Vec<[f64; D]>,
    weights: Vec<f64>,
    coefficients: Vec<f64>,
}

/// Whence a fit is made: a point, its region, the interfaces that it sees, and how it weighs.
#[derive(Clone, Copy)]
struct Centre<'f, const D: usize> {
    at: [f64; D],
    region: u16,
    node: usize,
    feet: &'f [Foot<D>],
    weight: Weight,
    /// Whether the node is favoured by what the fit leaves free, as in rows of boundary nodes.
    corrected: bool,
}

impl<'f, const D: usize> Centre<'f, D> {
    /// The interface to a region that it sees.
    fn foot_towards(&self, label: u16) -> Option<&'f Foot<D>> {
        self.feet.iter().find(|foot| foot.beyond == label)
    }
}

impl<'a, const D: usize> RowMaker<'a, D> {
    pub(super) fn new(
        problem: &'a Problem<'a, D>,
        feet: &'a Feet<D>,
        points: &'a InterfacePoints<D>,
        params: ParticleDifferenceParams,
    ) -> Self {
        let fit = LocalFit::new(FitParams { degree: params.degree, ..FitParams::default() });
        let joint = params.decaying.then(|| JointFit::new(problem, feet, params));
        Self { problem, feet, points, params, fit, joint }
    }

    pub(super) fn scratch(&self) -> Scratch<'a, D> {
        let most = self.problem.supports.lists.max_count() + 1;
        Scratch {
            joint: self.joint.as_ref().map(JointFit::scratch),
            fit: self.fit.scratch(most),
            nodes: Vec::new(),
            offsets: Vec::new(),
            weights: Vec::new(),
            coefficients: Vec::new(),
        }
    }

    /// The row of a node where u is not prescribed.
    pub(super) fn node(
        &self,
        i: usize,
        of_points: &[ExtendedRow],
        scratch: &mut Scratch<'a, D>,
    ) -> Result<ExtendedRow, MethodError> {
        let problem = self.problem;
        let (x, h, eta) = (problem.cloud.points()[i], problem.cloud.spacing()[i], problem.eta[i]);
        let (mut row_sum, mut rhs, functional, size) = match problem.cloud.boundary_of(i) {
            None => {
                let field = &problem.materials[problem.labels[i] as usize].diffusivity;
                let gradient = field.gradient(&x, GRADIENT_STEP * h);
                let source = problem.source.map_or(0.0, |f| f[i]);
                (0.0, source, Functional::Diffusion { eta, gradient }, h.powi(D as i32))
            }
            Some(_) => {
                let (a, g, direction) = self.boundary(i)?;
                (a, g, Functional::Directional(direction), h.powi(D as i32 - 1))
            }
        };
        let on_boundary = problem.cloud.is_boundary(i);
        let centre = Centre { corrected: on_boundary && self.params.decaying, ..self.at_node(i) };
        let (mut row, mut jump) = self.fitted(&centre, &functional, -size, scratch)?;
        if self.params.decaying && !on_boundary {
            (row, jump) = self.calmer((row, jump), &centre, (&functional, -size), of_points, scratch);
        }
        row_sum *= size;
        rhs = size * rhs - jump;
        row.nodes.retain(|&(j, _)| j as usize != i);
        Ok(ExtendedRow { row_sum, rhs, ..row })
    }

    fn at_node(&self, i: usize) -> Centre<'a, D> {
        let (at, region) = (self.problem.cloud.points()[i], self.problem.labels[i]);
        Centre { at, region, node: i, feet: self.feet.of(i), weight: self.params.weight, corrected: false }
    }

    /// From the side of the first of the regions that a point is between; `feet` is the point's own.
    fn at_point<'f>(&self, point: &Point<D>, feet: &'f [Foot<D>]) -> Centre<'f, D> {
        let region = point.between[0];
        Centre { at: point.at, region, node: point.node, feet, weight: self.params.weight, corrected: false }
    }

    /// In place of a row whose own value counts too little once the jumps are eliminated: see [`calmest`].
    fn calmer(
        &self,
        first: (ExtendedRow, f64),
        centre: &Centre<'_, D>,
        (functional, factor): (&Functional<D>, f64),
        of_points: &[ExtendedRow],
        scratch: &mut Scratch<'a, D>,
    ) -> (ExtendedRow, f64) {
        let i = centre.node;
        let even = Centre { weight: Weight::Uniform, ..*centre };
        let share = |(row, _): &(ExtendedRow, f64)| row.own_share(i, of_points);
        calmest(self.problem, i, first, share, |neighbors, enlarged| {
            let mut row = ExtendedRow { enlarged, ..ExtendedRow::default() };
            let given = self.apply(&even, neighbors, functional, factor, scratch, &mut row).ok()?;
            Some((row, given))
        })
    }

    /// The conditions of the faces of a boundary node, added: `a u + flux = g`, the flux as a derivative along a vector
    /// that is to be subtracted.
    fn boundary(&self, i: usize) -> Result<(f64, f64, [f64; D]), MethodError> {
        let problem = self.problem;
        let index = problem.cloud.boundary().iter().position(|b| b.node as usize == i);
        let (mut a, mut g, mut direction) = (0.0, 0.0, [0.0; D]);
        let Some(index) = index else { return Ok((a, g, direction)) };
        let node = &problem.cloud.boundary()[index];
        for (touch, condition) in node.touches.iter().zip(&problem.conditions[index]) {
            let (factor, given) = condition.as_flux(problem.eta[i]).ok_or_else(|| {
                MethodError::RobinWithoutFlux { node: i, position: problem.cloud.points()[i].to_vec() }
            })?;
            a += factor;
            g += given;
            direction.iter_mut().zip(touch.normal).for_each(|(d, n)| *d -= problem.eta[i] * n);
        }
        Ok((a, g, direction))
    }

    /// The gradient at a node, on its own side, of values `u` and jumps.
    pub(super) fn gradient(
        &self,
        i: usize,
        u: &[f64],
        jumps: &[f64],
        scratch: &mut Scratch<'a, D>,
    ) -> Result<[f64; D], MethodError> {
        let centre = self.at_node(i);
        let mut gradient = [0.0; D];
        for axis in 0..D {
            let functional = Functional::Directional(std::array::from_fn(|k| f64::from(u8::from(k == axis))));
            let (row, given) = self.fitted(&centre, &functional, 1.0, scratch)?;
            let of_nodes: f64 = row.nodes.iter().map(|&(j, c)| c * (u[j as usize] - u[i])).sum();
            gradient[axis] =
                given + of_nodes + row.jumps.iter().map(|&(k, c)| c * jumps[k as usize]).sum::<f64>();
        }
        Ok(gradient)
    }

    /// The condition at a point where u is prescribed: the polynomial of the first side has that value, up to the jump of u.
    fn value_at_point(
        &self,
        k: usize,
        value: f64,
        scratch: &mut Scratch<'a, D>,
    ) -> Result<ExtendedRow, MethodError> {
        let point = self.points.list[k];
        let feet = [point.foot()];
        let centre = self.at_point(&point, &feet);
        let (mut row, given) = self.fitted(&centre, &Functional::Value, 1.0, scratch)?;
        row.rhs = value - given;
        row.row_sum = row.nodes.iter().map(|(_, c)| c).sum();
        Ok(row)
    }

    /// The flux condition at a point: `kappa_B (dq/dn + J) - kappa_A dq/dn = g`, divided by both conductivities; or, where
    /// u is prescribed on the interface, that.
    pub(super) fn point(&self, k: usize, scratch: &mut Scratch<'a, D>) -> Result<ExtendedRow, MethodError> {
        let (problem, point) = (self.problem, self.points.list[k]);
        let [first, second] = point.between;
        if let Some((jump, _)) = problem.law_between(first, second)
            && let Some(u) = &jump.prescribed
        {
            return self.value_at_point(k, u.at(&point.at), scratch);
        }
        if let (Some(joint), Some(scratch)) = (&self.joint, &mut scratch.joint) {
            return joint.row(k as u32, &point, scratch);
        }
        let eta = point.between.map(|l| problem.materials[l as usize].diffusivity.at(&point.at));
        let flux = problem.law_between(first, second).and_then(|(jump, _)| jump.flux.as_ref());
        let h = problem.cloud.spacing()[point.node];
        let sum = eta[0] + eta[1];
        let mut row = ExtendedRow::default();
        let factor = h * (eta[1] - eta[0]) / sum;
        if factor != 0.0 {
            let feet = [point.foot()];
            let centre = self.at_point(&point, &feet);
            let slope = Functional::Directional(point.normal);
            let (fitted, given) = self.fitted(&centre, &slope, factor, scratch)?;
            row = ExtendedRow { rhs: -given, ..fitted };
            // The coefficients of a derivative add up to nothing, so values and differences are the same.
            row.row_sum = row.nodes.iter().map(|(_, c)| c).sum();
        }
        row.rhs += h * flux.map_or(0.0, |g| g.at(&point.at)) / sum;
        row.jumps.push((k as u32, h * eta[1] / sum));
        Ok(row)
    }

    /// `factor` times an operator on the polynomial of the centre's side, over the support of its node or, where that does
    /// not determine it, over an enlarged one; and what is given of it.
    fn fitted(
        &self,
        centre: &Centre<'_, D>,
        functional: &Functional<D>,
        factor: f64,
        scratch: &mut Scratch<'a, D>,
    ) -> Result<(ExtendedRow, f64), MethodError> {
        let (problem, node) = (self.problem, centre.node);
        let mut row = ExtendedRow::default();
        let near = problem.supports.lists.of(node);
        if let Ok(given) = self.apply(centre, near, functional, factor, scratch, &mut row) {
            return Ok((row, given));
        }
        row = ExtendedRow { enlarged: true, ..ExtendedRow::default() };
        let given =
            self.apply(centre, &enlarged_support(problem, node), functional, factor, scratch, &mut row)?;
        Ok((row, given))
    }

    /// Whether u and its flux go on from the centre's region to another one as if there were no interface.
    fn goes_on(&self, centre: &Centre<'_, D>, label: u16) -> bool {
        label == centre.region || !may_jump(self.problem, centre.region, label)
    }

    /// The coefficients of an operator on the polynomial of the centre's side, for the nodes that it can be fitted to.
    fn operator(
        &self,
        centre: &Centre<'_, D>,
        neighbors: &[u32],
        functional: &Functional<D>,
        scratch: &mut Scratch<'a, D>,
    ) -> Result<(), MethodError> {
        let x = &centre.at;
        let (points, radii) = (self.problem.cloud.points(), self.problem.supports.radius);
        let Scratch { fit, nodes, offsets, weights, coefficients, .. } = scratch;
        nodes.clear();
        nodes.extend(neighbors.iter().copied().filter(|&j| {
            let label = self.problem.labels[j as usize];
            self.goes_on(centre, label) || centre.foot_towards(label).is_some()
        }));
        nodes.push(centre.node as u32);
        offsets.clear();
        weights.clear();
        let mut radius = radii[centre.node];
        for &j in nodes.iter() {
            let offset: [f64; D] = std::array::from_fn(|k| points[j as usize][k] - x[k]);
            let distance = offset.iter().map(|d| d * d).sum::<f64>().sqrt();
            offsets.push(offset);
            weights.push(centre.weight.value(distance, radii[centre.node], radii[j as usize]));
            radius = radius.max(distance);
        }
        let located = |source: StencilError| MethodError::stencil(centre.node, x, source);
        self.fit.factor(offsets, weights, radius, fit).map_err(located)?;
        coefficients.resize(nodes.len(), 0.0);
        self.fit.coefficients(functional, fit, coefficients).map_err(located)?;
        if centre.corrected {
            let own = nodes.len() - 1;
            let mut null = vec![0.0; nodes.len()];
            self.fit.correction(own, fit, &mut null).map_err(located)?;
            add_correction(&mut coefficients[..own], &null[..own]);
        }
        Ok(())
    }

    /// Adds `factor` times an operator on the polynomial of the centre's side to a row; returns what is given of it.
    fn apply(
        &self,
        centre: &Centre<'_, D>,
        neighbors: &[u32],
        functional: &Functional<D>,
        factor: f64,
        scratch: &mut Scratch<'a, D>,
        row: &mut ExtendedRow,
    ) -> Result<f64, MethodError> {
        self.operator(centre, neighbors, functional, scratch)?;
        let problem = self.problem;
        let mut given = 0.0;
        for (&j, &c) in scratch.nodes.iter().zip(&scratch.coefficients) {
            row.nodes.push((j, factor * c));
            let label = problem.labels[j as usize];
            if self.goes_on(centre, label) {
                continue;
            }
            let Some(foot) = centre.foot_towards(label) else { continue };
            let y = &problem.cloud.points()[j as usize];
            let plane: f64 = (0..D).map(|k| (y[k] - foot.at.point[k]) * foot.at.normal[k]).sum();
            let own =
                self.feet.towards(j as usize, centre.region).filter(|_| self.params.wedge != Wedge::Plane);
            let (at, distance) =
                own.map_or((foot.at.point, plane), |own| (own.at.point, own.at.distance.abs()));
            let sign = if centre.region < label { 1.0 } else { -1.0 };
            let normal = foot.at.normal.map(|n| sign * n);
            let between = [centre.region.min(label), centre.region.max(label)];
            let h = problem.cloud.spacing()[centre.node];
            let reach = [separation(problem, &between), h];
            self.points.interpolate(between, &at, &normal, reach, -factor * c * distance, &mut row.jumps);
            if let Some((jump, sign)) = problem.law_between(centre.region, label)
                && let Some(value) = &jump.value
            {
                given -= factor * c * sign * value.at(&at);
            }
        }
        merge(&mut row.jumps);
        Ok(given)
    }
}

/// Adds up what belongs to the same unknown.
fn merge(entries: &mut Vec<(u32, f64)>) {
    entries.sort_by_key(|e| e.0);
    entries.dedup_by(|next, kept| {
        let same = next.0 == kept.0;
        if same {
            kept.1 += next.1;
        }
        same
    });
}
