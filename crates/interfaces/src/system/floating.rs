//! Floating stiff regions, found from the region graph of the cloud.

use meshless_geometry::RegionGraph;
use meshless_sparse::{Cluster, ComponentInfo, DEFAULT_THRESHOLD, DifferenceMatrix, Split, clusters};

use crate::{Condition, MethodError, Problem, adjacent_pairs};

/// The change of unknowns for a problem in which something floats.
pub(super) struct Floating {
    pub(super) split: Split,
    /// An unknown in no floating region, about the middle of the list; `None` where all are in one.
    pub(super) free: Option<usize>,
}

/// The connected parts of the regions, and which sets of them float.
#[derive(Debug)]
pub(crate) struct FloatingParts {
    /// Connected parts and who touches whom.
    pub(crate) graph: RegionGraph,
    /// What floats; empty where nothing does.
    pub(crate) clusters: Vec<Cluster>,
}

impl FloatingParts {
    pub(crate) fn find<const D: usize>(problem: &Problem<'_, D>) -> Result<Self, MethodError> {
        let pairs = adjacent_pairs(problem.cloud.points(), problem.supports.lists);
        let graph = RegionGraph::new(problem.cloud, problem.labels, &pairs)?;
        if !levels_differ(problem) {
            return Ok(Self { graph, clusters: Vec::new() });
        }
        let count = graph.components().len();
        let mut components = component_infos(problem, &graph);
        let mut adjacency: Vec<Vec<u32>> = (0..count as u32).map(|c| graph.touching(c).to_vec()).collect();
        add_surroundings(problem, &graph, &mut components, &mut adjacency);
        let clusters = clusters(&components, &adjacency, DEFAULT_THRESHOLD);
        Ok(Self { graph, clusters })
    }
}

/// The change of unknowns for a problem; `None` where nothing floats. `nodes` names the node of every unknown.
pub(super) fn split<const D: usize>(
    problem: &Problem<'_, D>,
    matrix: &DifferenceMatrix,
    nodes: &[u32],
) -> Result<Option<Floating>, MethodError> {
    if !levels_differ(problem) {
        return Ok(None);
    }
    let FloatingParts { graph, clusters: found } = FloatingParts::find(problem)?;
    let count = graph.components().len();
    if found.is_empty() {
        return Ok(None);
    }
    let component: Vec<u32> = nodes.iter().map(|&node| graph.component_of(node)).collect();
    if !all_have_unknowns(&found, &component, count) {
        // A cluster of prescribed values alone has no constant to solve for; the nodal values do for such a scene.
        return Ok(None);
    }
    let split = Split::from_clusters(matrix, &component, count, &found)?;
    let floats = |i: usize| found.iter().any(|cluster| cluster.members.binary_search(&component[i]).is_ok());
    let free = (0..nodes.len()).cycle().skip(nodes.len() / 2).take(nodes.len()).find(|&i| !floats(i));
    Ok(Some(Floating { split, free }))
}

/// Whether anything can float at all: the graph of regions is not built otherwise.
fn levels_differ<const D: usize>(problem: &Problem<'_, D>) -> bool {
    let robin = problem.conditions.iter().flatten().filter_map(|c| robin_level(problem, c));
    let levels = problem.eta.iter().copied().chain(robin);
    let (low, high) = levels.fold((f64::INFINITY, 0.0_f64), |(l, h), level| (l.min(level), h.max(level)));
    high > DEFAULT_THRESHOLD * low
}

/// The diffusivity that the surroundings of the domain would have if they reached as far as the domain and passed as
/// much as a Robin condition does: where it is small beside that of the region, the region floats (a small Biot number).
fn robin_level<const D: usize>(problem: &Problem<'_, D>, condition: &Condition) -> Option<f64> {
    let Condition::Robin { a, b, .. } = *condition else { return None };
    let level = (a / b).abs() * problem.domain.bounds().diameter();
    (level > 0.0 && level.is_finite()).then_some(level)
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
        if conditions.iter().any(|c| matches!(c, Condition::Dirichlet(_))) {
            infos[graph.component_of(node.node) as usize].touches_fixed = true;
        }
    }
    infos
}

/// Adds, for every component with Robin conditions, what it exchanges with: a component of its own, which is fixed.
fn add_surroundings<const D: usize>(
    problem: &Problem<'_, D>,
    graph: &RegionGraph,
    components: &mut Vec<ComponentInfo>,
    adjacency: &mut Vec<Vec<u32>>,
) {
    let mut level_of = vec![0.0_f64; components.len()];
    for (node, conditions) in problem.cloud.boundary().iter().zip(problem.conditions) {
        let level = &mut level_of[graph.component_of(node.node) as usize];
        *level = conditions.iter().filter_map(|c| robin_level(problem, c)).fold(*level, f64::max);
    }
    for (component, level) in (0_u32..).zip(level_of).filter(|(_, level)| *level > 0.0) {
        components.push(ComponentInfo { eta_min: level, eta_max: level, touches_fixed: true });
        adjacency.push(vec![component]);
    }
}
