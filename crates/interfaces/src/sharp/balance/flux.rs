//! The flux through a face in terms of values and data, from a fit round its middle, or round the node whose cell it is of.

use super::faces::{Beyond, Face};
use crate::sharp::fit::{Row, Wanted};
use crate::sharp::maker::{Maker, Scratch};
use crate::sharp::stencil::Heard;
use crate::{Condition, MethodError, parallel};

/// What is left of the reproduction of a flux before it counts as not determined, over what it is made of.
const REPRODUCTION: f64 = 1e-6;

/// Relative difference of diffusivities in units of their parts up to which they are alike.
const ALIKE: f64 = 1e-3;

/// `int eta du/dn` over a face, n out of the cell of its first node, in terms of the unknowns.
#[derive(Debug, Clone, Default)]
pub(super) struct Flux {
    /// Nodes and factors of their values.
    pub(super) values: Vec<(u32, f64)>,
    /// The sum of these factors: zero, without rounding, where constants make no flux.
    pub(super) sum: f64,
    /// Coefficients of constants: cluster, value.
    pub(super) constants: Vec<(u32, f64)>,
    /// What the data add, as the first cell sees it and as the second one does: the flux may jump in between.
    pub(super) known: [f64; 2],
}

impl Flux {
    /// The mean of two.
    fn mean(mut self, other: &Self) -> Self {
        self.values.iter_mut().for_each(|(_, factor)| *factor *= 0.5);
        self.constants.iter_mut().for_each(|(_, factor)| *factor *= 0.5);
        other.values.iter().for_each(|(j, factor)| self.add_value(*j, 0.5 * factor));
        other.constants.iter().for_each(|(c, factor)| self.add_constant(*c, 0.5 * factor));
        self.sum = 0.5 * (self.sum + other.sum);
        self.known = [0, 1].map(|side| 0.5 * (self.known[side] + other.known[side]));
        self
    }

    fn add_value(&mut self, node: u32, factor: f64) {
        match self.values.iter_mut().find(|(j, _)| *j == node) {
            Some((_, sum)) => *sum += factor,
            None => self.values.push((node, factor)),
        }
    }

    fn add_constant(&mut self, cluster: u32, factor: f64) {
        match self.constants.iter_mut().find(|(c, _)| *c == cluster) {
            Some((_, sum)) => *sum += factor,
            None => self.constants.push((cluster, factor)),
        }
    }
}

impl<const D: usize> Maker<'_, D> {
    /// `eta s` at a node.
    fn conductivity(&self, j: u32) -> f64 {
        self.problem.eta[j as usize] * self.unknowns.scale[self.unknowns.part[j as usize] as usize]
    }

    /// Which of the nodes on either side of an interface is in the softer part. Where both floating ones and what is round them are scaled alike,
    /// in space it is what conducts less that is told by its polynomial.
    fn softer(&self, nodes: [u32; 2]) -> usize {
        let [first, second] = nodes.map(|j| self.conductivity(j));
        let is_alike = D == 3 && (first / second - 1.0).abs() < ALIKE;
        let [first, second] =
            if is_alike { nodes.map(|j| self.problem.eta[j as usize]) } else { [first, second] };
        usize::from(second < first)
    }

    /// The nodes whose fits the flux of a face is told from, with those of the other faces of their cells, and is the mean of; none where it
    /// has a fit of its own round the middle: in the plane, and on interfaces, where most of the error comes from. (By the fit of one node
    /// alone the row of a node that has all of its faces would say nothing: the fit balances any cell.)
    fn seats(&self, face: &Face<D>) -> [Option<u32>; 2] {
        let label = |j: u32| self.problem.labels[j as usize];
        match face.beyond {
            _ if D == 2 => [None; 2],
            Beyond::Boundary(_) => [Some(face.node), None],
            Beyond::Node(other) if label(other) == label(face.node) => [Some(face.node), Some(other)],
            Beyond::Node(_) => [None; 2],
        }
    }

    /// The fluxes of all faces; `None` where no fit determines one.
    pub(super) fn fluxes(&self, faces: &[Face<D>]) -> Result<Vec<Option<Flux>>, MethodError> {
        let mut order: Vec<(Option<u32>, usize)> = Vec::with_capacity(2 * faces.len());
        for (place, face) in faces.iter().enumerate() {
            let [first, second] = self.seats(face);
            order.push((first, place));
            order.extend(second.map(|second| (Some(second), place)));
        }
        order.sort_unstable();
        let shared = |a: &(Option<u32>, usize), b: &(Option<u32>, usize)| a.0.is_some() && a.0 == b.0;
        let groups: Vec<&[(Option<u32>, usize)]> = order.chunk_by(shared).collect();
        let found = parallel::try_map_with(groups.len(), Scratch::default, |scratch, g| {
            let seat = groups[g][0].0.map(|node| node as usize);
            let at = |j: usize| (&self.problem.cloud.points()[j], self.unknowns.part[j], Heard::All);
            let is_known = seat.is_none_or(|j| self.factor_at(at(j), scratch, |_| true).is_some());
            let flux = |&(_, place): &(Option<u32>, usize)| match is_known {
                true => self.flux(&faces[place], seat.is_some(), scratch),
                false => Ok(None),
            };
            groups[g].iter().map(flux).collect::<Result<Vec<_>, _>>()
        })?;
        let mut fluxes: Vec<Option<Flux>> = vec![None; faces.len()];
        for (&(_, place), flux) in order.iter().zip(found.into_iter().flatten()) {
            fluxes[place] = match (fluxes[place].take(), flux) {
                (Some(first), Some(second)) => Some(first.mean(&second)),
                (first, second) => first.or(second),
            };
        }
        Ok(fluxes)
    }

    /// The flux of a face, from the fit that was factored last if that is `seated` for it; `None` where no fit determines it.
    fn flux(
        &self,
        face: &Face<D>,
        seated: bool,
        scratch: &mut Scratch<D>,
    ) -> Result<Option<Flux>, MethodError> {
        match face.beyond {
            Beyond::Node(other) => Ok(self.between((face, other), seated, scratch)),
            Beyond::Boundary(id) => {
                let mut conditions = Vec::with_capacity(face.points.len());
                for point in &face.points {
                    let none =
                        || MethodError::NoCondition { node: face.node as usize, position: point.at.to_vec() };
                    conditions.push(self.problem.boundary.condition(id, &point.at).ok_or_else(none)?);
                }
                Ok(self.at_boundary((face, &conditions), seated, scratch))
            }
        }
    }

    /// The flux by the gradient of the polynomial of the softer side, and as much of the misfits of both nodes' values as a flux between
    /// two points would have.
    fn between(
        &self,
        (face, other): (&Face<D>, u32),
        seated: bool,
        scratch: &mut Scratch<D>,
    ) -> Option<Flux> {
        let nodes = [face.node, other];
        let labels = nodes.map(|j| self.problem.labels[j as usize]);
        let parts = nodes.map(|j| self.unknowns.part[j as usize]);
        let crosses = labels[0] != labels[1];
        if !crosses && parts[0] != parts[1] {
            return None;
        }
        let softer = if crosses { self.softer(nodes) } else { 0 };
        if !seated {
            self.factor_at((&face.middle, parts[softer], Heard::All), scratch, |_| true)?;
        }
        let points = self.problem.cloud.points();
        let conductance = self.conductance(face, other);
        let mut wanted = self.gradients(face, labels[softer], scratch);
        let Scratch { stencil, .. } = scratch;
        // Functions of a vertex may not reach both nodes: then there is nothing that their values could miss.
        let misfits = nodes.iter().all(|j| stencil.nodes.contains(j));
        if !misfits && stencil.vertex.is_none() {
            return None;
        }
        let local = |x: &[f64; D]| std::array::from_fn(|k| (x[k] - stencil.center[k]) / stencil.radius);
        let scales = parts.map(|part| self.unknowns.scale[part as usize]);
        if misfits {
            for (side, sign) in [(0, 1.0), (1, -1.0)] {
                let part = stencil.parts.iter().position(|&p| p == parts[side])?;
                let z = local(&points[nodes[side] as usize]);
                let functional = Row::of_value(sign * conductance * scales[side]);
                wanted.push(Wanted { part, z, functional });
            }
        }
        let size = conductance * scales[softer];
        let mut flux = self.combined(&wanted, size, scratch)?;
        if misfits {
            flux.add_value(nodes[0], -conductance * scales[0]);
            flux.add_value(nodes[1], conductance * scales[1]);
        }
        self.add_sum(&mut flux, scratch);
        let jump = self.problem.law_between(labels[0], labels[1]).filter(|_| crosses);
        if let Some(field) = jump.and_then(|(jump, _)| jump.flux.as_ref()) {
            let jump: f64 = face.points.iter().map(|point| point.weight * field.at(&point.at)).sum();
            flux.known[1 - softer] += if softer == 0 { jump } else { -jump };
        }
        Some(flux)
    }

    /// `|f| / (d_i / eta_i + d_j / eta_j + R)`: what a difference of 1 between two nodes drives through their face.
    fn conductance(&self, face: &Face<D>, other: u32) -> f64 {
        let nodes = [face.node, other].map(|j| j as usize);
        let points = self.problem.cloud.points();
        let distance = |a: &[f64; D], b: &[f64; D]| (0..D).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>().sqrt();
        let [x, y] = nodes.map(|j| &points[j]);
        let ways = match self.problem.labels[nodes[0]] != self.problem.labels[nodes[1]] {
            true => [distance(x, &face.middle), distance(y, &face.middle)],
            false => [0.5 * distance(x, y); 2],
        };
        let eta = nodes.map(|j| self.problem.eta[j]);
        let labels = nodes.map(|j| self.problem.labels[j]);
        let law = self.problem.law_between(labels[0], labels[1]).filter(|_| labels[0] != labels[1]);
        let film = law.map_or(0.0, |(law, sign)| law.at(sign, &face.middle).resistance);
        face.area / (ways[0] / eta[0] + ways[1] / eta[1] + film)
    }

    /// What a boundary lets through: what is prescribed, or where the value is, the gradient of the fit.
    fn at_boundary(
        &self,
        (face, conditions): (&Face<D>, &[Condition]),
        seated: bool,
        scratch: &mut Scratch<D>,
    ) -> Option<Flux> {
        let node = face.node as usize;
        let (label, part) = (self.problem.labels[node], self.unknowns.part[node]);
        // A face on which only a part of u is prescribed has no flux from here: its cell keeps the collocated row.
        let prescribed =
            !conditions.is_empty() && conditions.iter().all(|c| matches!(c, Condition::Dirichlet(_)));
        let field = &self.problem.materials[label as usize].diffusivity;
        let (mut known, mut exchanges) = (0.0, Vec::new());
        if !prescribed {
            for (point, condition) in face.points.iter().zip(conditions) {
                let (exchange, given) = condition.as_flux(field.at(&point.at))?;
                known += point.weight * given;
                if exchange != 0.0 {
                    exchanges.push((point.at, point.weight * exchange));
                }
            }
            if exchanges.is_empty() {
                return Some(Flux { known: [known; 2], ..Flux::default() });
            }
        }
        if !seated {
            self.factor_at((&face.middle, part, Heard::All), scratch, |_| true)?;
        }
        let mut wanted = Vec::new();
        let scale = self.unknowns.scale[part as usize];
        let Scratch { stencil, .. } = scratch;
        let local = |x: &[f64; D]| std::array::from_fn(|k| (x[k] - stencil.center[k]) / stencil.radius);
        let size = match prescribed {
            true => self.problem.eta[node] * scale * face.area / stencil.radius,
            false => exchanges.iter().map(|(_, factor)| scale * factor.abs()).sum(),
        };
        wanted.extend(exchanges.iter().map(|(x, factor)| Wanted {
            part: 0,
            z: local(x),
            functional: Row::of_value(-scale * factor),
        }));
        if prescribed {
            wanted = self.gradients(face, label, scratch);
        }
        let mut flux = self.combined(&wanted, size, scratch)?;
        self.add_sum(&mut flux, scratch);
        let exchanged: f64 = exchanges.iter().map(|(_, factor)| factor).sum();
        if exchanged != 0.0 {
            flux.sum = flux.values.iter().map(|(_, factor)| factor).sum();
            known -= exchanged * self.unknowns.offset[part as usize];
            for (cluster, sigma) in self.unknowns.shares(part, None) {
                flux.add_constant(cluster, -exchanged * sigma);
            }
        }
        flux.known.iter_mut().for_each(|sum| *sum += known);
        Some(flux)
    }

    /// `int eta s grad Q . n` of the own polynomial of the stencil that was factored last.
    fn gradients(&self, face: &Face<D>, label: u16, scratch: &Scratch<D>) -> Vec<Wanted<D>> {
        let stencil = &scratch.stencil;
        let scale = self.unknowns.scale[stencil.parts[0] as usize];
        let field = &self.problem.materials[label as usize].diffusivity;
        let wanted = face.points.iter().map(|point| {
            let strength = field.at(&point.at) * scale * point.weight / stencil.radius;
            let functional = Row { gradient: point.normal.map(|n| strength * n), ..Row::of_value(0.0) };
            let z = std::array::from_fn(|k| (point.at[k] - stencil.center[k]) / stencil.radius);
            Wanted { part: 0, z, functional }
        });
        wanted.collect()
    }

    /// A functional of the fit that was factored last; `None` where that does not determine it.
    fn combined(&self, wanted: &[Wanted<D>], size: f64, scratch: &mut Scratch<D>) -> Option<Flux> {
        let Scratch { stencil, fit, combination, .. } = scratch;
        let remainder = fit.functional_of(self, wanted, combination);
        let known = combination.known;
        if !(remainder <= REPRODUCTION * size && known.is_finite()) {
            return None;
        }
        let values = stencil.nodes.iter().copied().zip(combination.values.iter().copied()).collect();
        let mut flux = Flux { values, known: [known; 2], ..Flux::default() };
        let part = |place: usize| stencil.parts[place];
        for share in &combination.constants {
            for (cluster, sigma) in self.unknowns.shares(part(share.of), share.less.map(part)) {
                flux.add_constant(cluster, sigma * share.factor);
            }
        }
        Some(flux)
    }

    /// The sum of the factors of values: none where constants are reproduced and only differences are prescribed.
    fn add_sum(&self, flux: &mut Flux, scratch: &Scratch<D>) {
        let stencil = &scratch.stencil;
        let scale = |part: u32| self.unknowns.scale[part as usize];
        let uniform = stencil.parts.iter().all(|&part| scale(part) == scale(stencil.parts[0]));
        let exchanges = |&j: &u32| self.boundary_rows[j as usize].iter().any(|row| row.exchange != 0.0);
        let held = stencil.vertex.is_some_and(|vertex| self.vertices.get(vertex).is_held());
        if held || !uniform || !self.keeps_constants || stencil.nodes.iter().any(exchanges) {
            flux.sum = flux.values.iter().map(|(_, factor)| factor).sum();
        }
    }
}
