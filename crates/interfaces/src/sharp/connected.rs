//! The connected parts of the regions.
//!
//! Nodes of one region are connected where no third node lies between them. In a gap thinner than the spacing nodes of both sides
//! do, so that a node in it would be a part by itself, whose polynomial nothing but the node and two or three points of the
//! interface determine. Such parts are joined to those that a straight way through their own region leads to.

use std::collections::BTreeMap;

use meshless_geometry::RegionGraph;
use meshless_neighbors::CellList;

use crate::{MethodError, Problem, adjacent_pairs, parallel};

/// Nodes round that of a small part that are asked.
const NODES_ASKED: usize = 48;

/// How densely it is asked whose the way between two nodes is, in spacings.
const STEP: f64 = 0.02;

/// Connected parts of the regions.
#[derive(Debug)]
pub(super) struct ConnectedParts {
    pub(super) graph: RegionGraph,
    /// Part of every node.
    pub(super) of_node: Vec<u32>,
}

impl ConnectedParts {
    pub(super) fn find<const D: usize>(
        problem: &Problem<'_, D>,
        nodes: &CellList<'_, D>,
    ) -> Result<Self, MethodError> {
        let Problem { cloud, labels, .. } = *problem;
        let mut pairs = adjacent_pairs(cloud.points(), problem.supports.lists);
        let mut graph = RegionGraph::new(cloud, labels, &pairs)?;
        let ways = ways(problem, &graph, nodes);
        if !ways.is_empty() {
            pairs.extend(ways);
            graph = RegionGraph::new(cloud, labels, &pairs)?;
        }
        let of_node = (0..cloud.len() as u32).map(|i| graph.component_of(i)).collect();
        Ok(Self { graph, of_node })
    }
}

/// Pairs of nodes of one region in different parts between which the way leads through the region: for every node but those of
/// the largest part of a region the nearest such node of each part.
fn ways<const D: usize>(
    problem: &Problem<'_, D>,
    graph: &RegionGraph,
    nodes: &CellList<'_, D>,
) -> Vec<(u32, u32)> {
    let is_largest = largest(graph);
    if !is_largest.contains(&false) {
        return Vec::new();
    }
    let of = |i: u32| graph.component_of(i);
    parallel::collect(problem.cloud.len(), |i, pairs| {
        let own = of(i as u32);
        if is_largest[own as usize] {
            return;
        }
        let (mut found, mut joined) = (Vec::new(), vec![own]);
        for j in nodes.nearest(&problem.cloud.points()[i], NODES_ASKED, &mut found) {
            let same = problem.labels[j as usize] == problem.labels[i];
            if same && !joined.contains(&of(j)) && leads_through(problem, i, j as usize) {
                joined.push(of(j));
                pairs.push((i as u32, j));
            }
        }
    })
}

/// Which parts are the largest of their region, the first of equals.
fn largest(graph: &RegionGraph) -> Vec<bool> {
    let parts = graph.components();
    let mut of_label = BTreeMap::new();
    for (k, part) in parts.iter().enumerate() {
        let best = of_label.entry(part.label).or_insert(k);
        if part.nodes > parts[*best].nodes {
            *best = k;
        }
    }
    parts.iter().enumerate().map(|(k, part)| of_label.get(&part.label) == Some(&k)).collect()
}

/// Whether the straight way between two nodes of a region stays in it.
fn leads_through<const D: usize>(problem: &Problem<'_, D>, i: usize, j: usize) -> bool {
    let (x, y) = (&problem.cloud.points()[i], &problem.cloud.points()[j]);
    let step = STEP * problem.cloud.spacing()[i];
    let distance = (0..D).map(|k| (y[k] - x[k]).powi(2)).sum::<f64>().sqrt();
    let steps = (distance / step).ceil().max(2.0) as usize;
    (1..steps).all(|k| {
        let t = k as f64 / steps as f64;
        let at = std::array::from_fn(|d| x[d] + t * (y[d] - x[d]));
        problem.regions.label(&at, 0.0) == problem.labels[i] && problem.domain.contains(&at, step)
    })
}
