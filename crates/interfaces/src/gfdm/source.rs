//! What the balance of a node holds: a cell that an interface cuts has parts on both sides, each with the source, the capacity and the reaction
//! of its region. What is beyond the interface is in the balances of the neighbours there: were it in that of the node, an insulating region
//! in a heated one would be as hot as the heat in its outermost cells makes it (u of a void of 1e-6 was 329 where it is 0.04).

use meshless_cells::Cell;
use meshless_geometry::Aabb;

use super::conservative::{BalanceScratch, CellBalance};
use crate::MethodError;

/// Lines through a cell in each direction across them, by dimension. The heat of a square chip is right to 2e-5 at h = 0.05 by that, with 50
/// cut cells, and to 2e-4 at h = 0.1; by the sources at the nodes alone it is 6e-3 and 8e-2 off.
const LINES: [u32; 3] = [1, 24, 8];

/// Places along a line, its ends among them, at which it is asked what is there, before changes are found by halving.
const PLACES: u32 = 6;

/// How often a part of a line is halved to find where the region changes.
const HALVINGS: u32 = 30;

/// Difference of the data of both sides, over their size, up to which they are one.
const SAME: f64 = 1e-12;

/// The part of a cell that is in one region.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct CellPart {
    /// The region.
    pub(super) region: u16,
    /// The region of the node whose cell it is.
    pub(super) cell: u16,
    /// The integral of the source.
    pub(super) source: f64,
    /// Length, area or volume.
    pub(super) volume: f64,
    /// The integral of the capacity.
    pub(super) capacity: f64,
    /// The integral of the factor of u.
    pub(super) reaction: f64,
}

/// What the cell of a node holds: for its own balance, and for those of neighbours beyond an interface.
#[derive(Debug, Default)]
pub(super) struct Parts {
    pub(super) kept: Vec<CellPart>,
    /// Neighbours, and what they have of the cell.
    pub(super) given: Vec<(u32, CellPart)>,
}

impl CellPart {
    /// A share of the part, for a neighbour in its region.
    fn share(&self, share: f64) -> Self {
        Self {
            region: self.region,
            cell: self.region,
            source: share * self.source,
            volume: share * self.volume,
            capacity: share * self.capacity,
            reaction: share * self.reaction,
        }
    }
}

/// A part of a straight line.
struct Line<const D: usize> {
    start: [f64; D],
    direction: [f64; D],
    from: f64,
    to: f64,
}

impl<const D: usize> Line<D> {
    fn at(&self, t: f64) -> [f64; D] {
        std::array::from_fn(|k| self.start[k] + t * self.direction[k])
    }
}

/// Unit vectors at right angles to each other, of which the first one has a direction: the first axis where that is none.
fn basis<const D: usize>(direction: [f64; D]) -> Vec<[f64; D]> {
    let mut all: Vec<[f64; D]> = Vec::with_capacity(D);
    let axes = (0..D).map(|axis| std::array::from_fn(|k| if k == axis { 1.0 } else { 0.0 }));
    // Of the axes, that which is the nearest to what there is already gives nothing.
    for mut vector in std::iter::once(direction).chain(axes) {
        let size = |v: &[f64; D]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
        let before = size(&vector);
        for known in &all {
            let along: f64 = (0..D).map(|k| vector[k] * known[k]).sum();
            (0..D).for_each(|k| vector[k] -= along * known[k]);
        }
        let left = size(&vector);
        if all.len() < D && left > 0.1 * before {
            all.push(vector.map(|x| x / left));
        }
    }
    all
}

impl<const D: usize> CellBalance<'_, D> {
    /// The cell of node i by regions; all of it is of one where the data are the same on both sides of what cuts it.
    ///
    /// Flat interfaces divide it exactly; along others it is measured.
    fn cut(
        &self,
        i: usize,
        cell: &Cell<D>,
        scratch: &mut BalanceScratch<'_, D>,
    ) -> Result<Vec<CellPart>, MethodError> {
        let problem = self.problem;
        let own = problem.labels[i];
        let x = &problem.cloud.points()[i];
        let content = |region: u16, source: f64, volume: f64| {
            let [_, capacity, reaction] = self.data_of(region, x);
            CellPart {
                region,
                cell: own,
                source: volume * source,
                volume,
                capacity: volume * capacity,
                reaction: volume * reaction,
            }
        };
        let whole = content(own, problem.source.map_or(0.0, |f| f[i]), cell.volume);
        // Where regions are known by labels alone, nothing is known between the nodes.
        let is_cut = problem.regions.len() == problem.materials.len()
            && cell.neighbors().any(|(j, _)| self.changes(i, j as usize));
        if !is_cut {
            return Ok(vec![whole]);
        }
        let exact = if self.is_among_flat(x, 0.5 * cell.reach) { self.volumes(i, scratch)? } else { None };
        let volumes = exact.unwrap_or_else(|| self.measured(i, cell));
        // All of a part has the source that is at the node, as it has the rate of change there.
        let part = |(region, volume): (u16, f64)| content(region, self.data_of(region, x)[0], volume);
        let found: Vec<CellPart> = volumes.into_iter().map(part).collect();
        let is_finite = |part: &CellPart| (part.source + part.capacity + part.reaction).is_finite();
        let is_known = !found.is_empty() && found.iter().all(is_finite);
        Ok(if is_known { found } else { vec![whole] })
    }

    /// The parts of the cell of node i by the balances that have them: what is beyond an interface is in those of its neighbours there that
    /// `balances` names, by the areas of the faces in between; where there is none, it stays.
    pub(super) fn parts(
        &self,
        i: usize,
        cell: &Cell<D>,
        balances: &(dyn Fn(usize) -> bool + Sync),
        scratch: &mut BalanceScratch<'_, D>,
    ) -> Result<Parts, MethodError> {
        let labels = self.problem.labels;
        let mut parts = Parts::default();
        for part in self.cut(i, cell, scratch)? {
            let beyond = cell.neighbors().filter(|(j, _)| {
                let j = *j as usize;
                part.region != labels[i] && labels[j] == part.region && balances(j)
            });
            let faces: Vec<(u32, f64)> = beyond.map(|(j, face)| (j, face.area)).collect();
            let area: f64 = faces.iter().map(|face| face.1).sum();
            match area > 0.0 {
                true => parts.given.extend(faces.iter().map(|(j, face)| (*j, part.share(face / area)))),
                false => parts.kept.push(part),
            }
        }
        Ok(parts)
    }

    /// Whether no interface that is not flat can be within `reach` of a point.
    fn is_among_flat(&self, x: &[f64; D], reach: f64) -> bool {
        self.interfaces.others.iter().all(|shape| {
            let is_far = |bounds: Aabb<D>| !bounds.contains(x, reach);
            shape.bounds().is_some_and(is_far)
        })
    }

    /// The volumes of the regions in the cell of node i, measured along lines.
    fn measured(&self, i: usize, cell: &Cell<D>) -> Vec<(u16, f64)> {
        let mut found: Vec<(u16, f64)> = Vec::new();
        let mut length = 0.0;
        for line in self.lines(i, cell) {
            length += line.to - line.from;
            self.along(&line, &mut |region, from, to| match found.iter_mut().find(|part| part.0 == region) {
                Some(part) => part.1 += to - from,
                None => found.push((region, to - from)),
            });
        }
        let weight = cell.volume / length;
        found.iter_mut().for_each(|part| part.1 *= weight);
        found
    }

    /// Lines through the cell of node i towards what is beyond the interface, which they cross at a large angle, at even distances.
    fn lines(&self, i: usize, cell: &Cell<D>) -> Vec<Line<D>> {
        let mut direction = [0.0; D];
        for (_, face) in cell.neighbors().filter(|(j, _)| self.changes(i, *j as usize)) {
            (0..D).for_each(|k| direction[k] += face.area * face.normal[k]);
        }
        let [direction, others @ ..] = &basis(direction)[..] else { return Vec::new() };
        let (x, reach, count) = (&self.problem.cloud.points()[i], 0.5 * cell.reach, LINES[D - 1]);
        let mut lines = Vec::new();
        for number in 0..count.pow(D as u32 - 1) {
            let mut start = *x;
            for (k, other) in others.iter().enumerate() {
                let place = number / count.pow(k as u32) % count;
                let shift = reach * ((2.0 * f64::from(place) + 1.0) / f64::from(count) - 1.0);
                (0..D).for_each(|axis| start[axis] += shift * other[axis]);
            }
            let mut line = Line { start, direction: *direction, from: -reach, to: reach };
            for face in &cell.faces {
                let away = (0..D).map(|k| face.normal[k] * (face.centroid[k] - start[k])).sum::<f64>();
                let slope = (0..D).map(|k| face.normal[k] * direction[k]).sum::<f64>();
                match slope {
                    slope if slope > 0.0 => line.to = line.to.min(away / slope),
                    slope if slope < 0.0 => line.from = line.from.max(away / slope),
                    _ if away < 0.0 => line.to = f64::NEG_INFINITY,
                    _ => {}
                }
            }
            if line.from < line.to {
                lines.push(line);
            }
        }
        lines
    }

    /// The pieces of a line by regions.
    fn along(&self, line: &Line<D>, piece: &mut dyn FnMut(u16, f64, f64)) {
        let label = |t: f64| self.problem.regions.label(&line.at(t), 0.0);
        let place = |k: u32| line.from + (line.to - line.from) * f64::from(k) / f64::from(PLACES - 1);
        let (mut start, mut region) = (line.from, label(place(0)));
        for k in 1..PLACES {
            let next = label(place(k));
            if next == region {
                continue;
            }
            let (mut before, mut after) = (place(k - 1), place(k));
            for _ in 0..HALVINGS {
                let middle = 0.5 * (before + after);
                *(if label(middle) == region { &mut before } else { &mut after }) = middle;
            }
            piece(region, start, after);
            (start, region) = (after, next);
        }
        piece(region, start, line.to);
    }

    /// Source, capacity and reaction of a region at a point.
    fn data_of(&self, label: u16, x: &[f64; D]) -> [f64; 3] {
        let material = &self.problem.materials[label as usize];
        let source = material.source.as_ref().map_or(0.0, |field| field.at(x));
        [source, material.capacity_at(x), material.reaction_at(x)]
    }

    /// Whether a neighbour is in a region of other data.
    fn changes(&self, i: usize, j: usize) -> bool {
        let labels = [i, j].map(|k| self.problem.labels[k]);
        labels[0] != labels[1] && {
            let [here, there] = labels.map(|label| self.data_of(label, &self.problem.cloud.points()[i]));
            // What is no number on the other side is another source, too.
            let is_same = |(a, b): (&f64, &f64)| (a - b).abs() <= SAME * a.abs().max(b.abs());
            !here.iter().zip(&there).all(is_same)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::basis;

    #[test]
    fn a_basis_goes_through_the_direction_and_is_orthonormal() {
        for direction in [[1.0, 2.0, -2.0], [0.0, 0.0, 3.0], [0.0; 3], [1e-9, 1.0, 0.0]] {
            let all = basis(direction);
            assert_eq!(all.len(), 3);
            for (k, a) in all.iter().enumerate() {
                for (l, b) in all.iter().enumerate() {
                    let product: f64 = a.iter().zip(b).map(|(a, b)| a * b).sum();
                    assert!((product - if k == l { 1.0 } else { 0.0 }).abs() < 1e-12, "{all:?}");
                }
            }
            let size = direction.iter().map(|x: &f64| x * x).sum::<f64>().sqrt();
            assert!((0..3).all(|k| (size * all[0][k] - direction[k]).abs() < 1e-12), "{all:?}");
        }
    }
}
