//! Floating stiff regions, found from the region graph of the cloud.

use meshless_geometry::RegionGraph;
use meshless_sparse::{ComponentInfo, Reduced, Split, floating_clusters};

use crate::{MethodError, Problem, adjacent_pairs};

/// The change of unknowns for a problem; `None` where nothing floats.
pub(super) fn split<const D: usize>(
    problem: &Problem<'_, D>,
    reduced: &Reduced,
) -> Result<Option<Split>, MethodError> {
    let pairs = adjacent_pairs(problem.cloud.points(), problem.supports.lists);
    let graph = RegionGraph::new(problem.cloud, problem.labels, &pairs)?;
    let components = component_infos(problem, &graph);
    let adjacency: Vec<Vec<u32>> = (0..components.len() as u32).map(|c| graph.touching(c).to_vec()).collect();
    let clusters = floating_clusters(&components, &adjacency);
    if clusters.is_empty() {
        return Ok(None);
    }
    // The smallest cluster of every component, and all that contain it.
    let innermost: Vec<Option<usize>> =
        (0..components.len() as u32).map(|c| clusters.iter().rposition(|k| k.members.contains(&c))).collect();
    let chain = |innermost: Option<usize>| {
        let mut chain: Vec<u32> = Vec::new();
        let mut next = innermost.map(|k| k as u32);
        while let Some(k) = next {
            chain.push(k);
            next = clusters[k as usize].parent;
        }
        chain
    };
    let group: Vec<u32> = reduced.map.iter().map(|&node| graph.component_of(node)).collect();
    let mut kept: Vec<Option<u32>> = vec![None; clusters.len()];
    for k in 0..clusters.len() {
        let inside = |c: u32| innermost[c as usize] == Some(k);
        kept[k] = pin(reduced, &group, inside);
    }
    // A cluster of which every node has a prescribed value has no equation, and no constant.
    let place: Vec<Option<u32>> = kept
        .iter()
        .scan(0, |count, pin| {
            Some(pin.map(|_| {
                *count += 1;
                *count - 1
            }))
        })
        .collect();
    let chains = innermost
        .iter()
        .map(|&k| chain(k).into_iter().filter_map(|k| place[k as usize]).collect())
        .collect();
    let scale = innermost.iter().map(|k| k.map_or(1.0, |k| clusters[k].scale)).collect();
    let sigma = clusters.iter().zip(&place).filter(|(_, p)| p.is_some()).map(|(c, _)| c.sigma).collect();
    let pins: Vec<u32> = kept.into_iter().flatten().collect();
    Ok((!pins.is_empty()).then_some(Split { group, scale, chain: chains, sigma, pins }))
}

fn component_infos<const D: usize>(problem: &Problem<'_, D>, graph: &RegionGraph) -> Vec<ComponentInfo> {
    let blank = ComponentInfo { eta_min: f64::INFINITY, eta_max: 0.0, fixed: false };
    let mut infos = vec![blank; graph.components().len()];
    for (i, &eta) in problem.eta.iter().enumerate() {
        let info = &mut infos[graph.component_of(i as u32) as usize];
        info.eta_min = info.eta_min.min(eta);
        info.eta_max = info.eta_max.max(eta);
    }
    for (node, conditions) in problem.cloud.boundary().iter().zip(problem.conditions) {
        if conditions.iter().any(|c| c.anchors()) {
            infos[graph.component_of(node.node) as usize].fixed = true;
        }
    }
    infos
}

/// The unknown whose value is pinned: one whose row stays within the components, if there is one.
fn pin(reduced: &Reduced, group: &[u32], inside: impl Fn(u32) -> bool) -> Option<u32> {
    let mut candidates = (0..group.len()).filter(|&i| inside(group[i]));
    let first = candidates.clone().next()?;
    let deep = candidates.find(|&i| reduced.matrix.row(i).0.iter().all(|&j| group[j as usize] == group[i]));
    Some(deep.unwrap_or(first) as u32)
}
