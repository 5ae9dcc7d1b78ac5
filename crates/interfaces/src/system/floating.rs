//! Floating stiff regions, found from the region graph of the cloud.

use meshless_geometry::RegionGraph;
use meshless_sparse::{Cluster, ComponentInfo, DEFAULT_THRESHOLD, DifferenceMatrix, Split, clusters};

use crate::{Condition, MethodError, Problem, adjacent_pairs};

/// The change of unknowns for a problem; `None` where nothing floats. `nodes` names the node of every unknown.
pub(super) fn split<const D: usize>(
    problem: &Problem<'_, D>,
    matrix: &DifferenceMatrix,
    nodes: &[u32],
) -> Result<Option<Split>, MethodError> {
    let pairs = adjacent_pairs(problem.cloud.points(), problem.supports.lists);
    let graph = RegionGraph::new(problem.cloud, problem.labels, &pairs)?;
    let components = component_infos(problem, &graph);
    let adjacency: Vec<Vec<u32>> = (0..components.len() as u32).map(|c| graph.touching(c).to_vec()).collect();
    let found = clusters(&components, &adjacency, DEFAULT_THRESHOLD);
    if found.is_empty() {
        return Ok(None);
    }
    let component: Vec<u32> = nodes.iter().map(|&node| graph.component_of(node)).collect();
    if !all_have_unknowns(&found, &component, components.len()) {
        // A cluster of prescribed values alone has no constant to solve for; the nodal values do for such a scene.
        return Ok(None);
    }
    Ok(Some(Split::from_clusters(matrix, &component, components.len(), &found)?))
}

fn all_have_unknowns(found: &[Cluster], component: &[u32], components: usize) -> bool {
    let mut present = vec![false; components];
    component.iter().for_each(|&c| present[c as usize] = true);
    found.iter().all(|cluster| cluster.own.iter().any(|&c| present[c as usize]))
}

fn component_infos<const D: usize>(problem: &Problem<'_, D>, graph: &RegionGraph) -> Vec<ComponentInfo> {
    let blank = ComponentInfo { eta_min: f64::INFINITY, eta_max: 0.0, touches_fixed: false };
    let mut infos = vec![blank; graph.components().len()];
    for (i, &eta) in problem.eta.iter().enumerate() {
        let info = &mut infos[graph.component_of(i as u32) as usize];
        info.eta_min = info.eta_min.min(eta);
        info.eta_max = info.eta_max.max(eta);
    }
    for (node, conditions) in problem.cloud.boundary().iter().zip(problem.conditions) {
        if conditions.iter().any(Condition::anchors) {
            infos[graph.component_of(node.node) as usize].touches_fixed = true;
        }
    }
    infos
}
