//! The change of unknowns `u = offset + sum_K sigma_K C_K + s w`, found from the graph of the regions.

use meshless_sparse::{DifferenceMatrix, Split};

use super::connected::ConnectedParts;
use super::held::Held;
use super::interface::InterfacePoints;
use crate::system::FloatingParts;
use crate::{MethodError, Problem};

/// Scale, constants and offset of every connected part of a region.
#[derive(Debug)]
pub(super) struct Unknowns {
    parts: FloatingParts,
    /// Part of every node.
    pub(super) part: Vec<u32>,
    /// Scale `s` of every part.
    pub(super) scale: Vec<f64>,
    /// What is known of its constant: the value that holds a stiff part; and where u jumps between parts that float together, it jumps by so much on the average. Divided
    /// by a small `s`, in `w`, the jump would take the digits of the flux.
    pub(super) offset: Vec<f64>,
    /// Label of every part.
    pub(super) label: Vec<u16>,
    /// The constants of every part: cluster, factor.
    chain: Vec<Vec<(u32, f64)>>,
    /// Whether some parts have a scale and no constant to be solved for.
    held: bool,
}

impl Unknowns {
    /// Parts touch where an interface has a point between them, as the rows of the fits join them there and nowhere else. Nodes
    /// may be neighbours across a thin layer without that.
    pub(super) fn find<const D: usize>(
        problem: &Problem<'_, D>,
        connected: ConnectedParts,
        interfaces: &InterfacePoints<D>,
        with_offsets: bool,
    ) -> Self {
        let ConnectedParts { graph, of_node: part } = connected;
        let count = graph.components().len();
        let mut touching = vec![Vec::new(); count];
        for [a, b] in interfaces.points.iter().map(|point| point.sides.each_ref().map(|side| side.part)) {
            touching[a as usize].push(b);
            touching[b as usize].push(a);
        }
        touching.iter_mut().for_each(|list| {
            list.sort_unstable();
            list.dedup();
        });
        let parts = FloatingParts::find(problem, graph, touching.clone());
        let label = parts.graph.components().iter().map(|c| c.label).collect();
        let mut scale = vec![1.0; count];
        let mut chain = vec![Vec::new(); count];
        for (k, cluster) in (0..).zip(&parts.clusters) {
            // Members beyond the parts stand for what is outside of the domain.
            for &member in cluster.members.iter().filter(|&&m| (m as usize) < count) {
                chain[member as usize].push((k, cluster.factor));
            }
            for (&own, &s) in cluster.own.iter().zip(&cluster.scales).filter(|(m, _)| (**m as usize) < count)
            {
                scale[own as usize] = s;
            }
        }
        let floats = |part: u32| with_offsets && !chain[part as usize].is_empty();
        let mut offset = offsets(count, interfaces, floats);
        let mut held = false;
        if with_offsets {
            let floats = |part: usize| !chain[part].is_empty();
            let levels = Held::find(problem, &part, &touching, interfaces, &scale, floats);
            for (part, (level, s)) in levels.parts.into_iter().enumerate().filter_map(|(p, l)| Some((p, l?)))
            {
                (offset[part], scale[part], held) = (level, s, true);
            }
        }
        Self { parts, part, scale, offset, label, chain, held }
    }

    /// Constants that are unknowns of their own.
    pub(super) fn constants(&self) -> usize {
        self.parts.clusters.len()
    }

    /// Whether some parts have a scale and no constant to be solved for.
    pub(super) fn any_held(&self) -> bool {
        self.held
    }

    /// What the constants add to u in one part, less what they add in another: constant, factor. Those that both have alike do
    /// not show.
    pub(super) fn shares(&self, of: u32, less: Option<u32>) -> impl Iterator<Item = (u32, f64)> + '_ {
        let own = self.chain[of as usize].as_slice();
        let other = less.map_or(&[][..], |less| self.chain[less as usize].as_slice());
        let factor = |chain: &[(u32, f64)], k: u32| chain.iter().find(|c| c.0 == k).map_or(0.0, |c| c.1);
        let of_own = own.iter().map(move |&(k, sigma)| (k, sigma - factor(other, k)));
        let beyond = other.iter().filter(move |(k, _)| own.iter().all(|(j, _)| j != k));
        of_own.chain(beyond.map(|&(k, sigma)| (k, -sigma))).filter(|(_, sigma)| *sigma != 0.0)
    }

    /// The change of unknowns for a matrix whose rows act on `w`, over all nodes.
    pub(super) fn split(&self, rows: &DifferenceMatrix) -> Result<Split, MethodError> {
        let split = Split::from_clusters(rows, &self.part, self.scale.len(), &self.parts.clusters)?;
        Ok(split.with_group_scales(&self.scale)?)
    }
}

/// The mean jumps of u, added up along ways from part to part among those that float, from the first of each such group on.
fn offsets<const D: usize>(
    count: usize,
    interfaces: &InterfacePoints<D>,
    floats: impl Fn(u32) -> bool,
) -> Vec<f64> {
    let mut between: Vec<([u32; 2], f64, f64)> = Vec::new();
    for point in &interfaces.points {
        let pair = point.sides.each_ref().map(|side| side.part);
        if pair[0] == pair[1] || !pair.iter().all(|&part| floats(part)) {
            continue;
        }
        match between.iter_mut().find(|(of, ..)| *of == pair) {
            Some((_, sum, points)) => (*sum, *points) = (*sum + point.law.value, *points + 1.0),
            None => between.push((pair, point.law.value, 1.0)),
        }
    }
    let mut offset: Vec<Option<f64>> = vec![None; count];
    for start in 0..count {
        offset[start].get_or_insert(0.0);
        let mut grown = true;
        while grown {
            grown = false;
            for &([a, b], sum, points) in &between {
                let jump = sum / points;
                match (offset[a as usize], offset[b as usize]) {
                    (Some(known), None) => offset[b as usize] = Some(known + jump),
                    (None, Some(known)) => offset[a as usize] = Some(known - jump),
                    _ => continue,
                }
                grown = true;
            }
        }
    }
    offset.into_iter().map(|known| known.unwrap_or(0.0)).collect()
}
