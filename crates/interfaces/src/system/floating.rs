//! Floating stiff regions, found from the region graph of the cloud.

use meshless_geometry::RegionGraph;
use meshless_sparse::{Cluster, ComponentInfo, DEFAULT_THRESHOLD, DifferenceMatrix, Split, clusters};

use crate::{Condition, Field, InterfaceLaw, MethodError, Problem, adjacent_pairs};

/// A row holds a stiff region if it is tied to the outside by this part of its largest entry: about as many digits are lost
/// where the constant is no unknown of its own.
const HELD: f64 = 1e-4;

/// And by so many times what the ratio of the diffusivities makes of a balance.
const BALANCED: f64 = 100.0;

/// Share of the rows reaching outside of which this must be true: unlucky cells are rarer.
const HOLDING: f64 = 0.1;

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
    /// What floats where the parts of a graph touch as `touching` says, part by part.
    pub(crate) fn find<const D: usize>(
        problem: &Problem<'_, D>,
        graph: RegionGraph,
        touching: Vec<Vec<u32>>,
    ) -> Self {
        if !levels_differ(problem) {
            return Self { graph, clusters: Vec::new() };
        }
        let (components, adjacency) = with_surroundings(problem, &graph, touching);
        let clusters = clusters(&components, &adjacency, DEFAULT_THRESHOLD);
        Self { graph, clusters }
    }
}

/// The connected parts of the regions of a problem, and which of them have nodes that are neighbours.
fn region_graph<const D: usize>(problem: &Problem<'_, D>) -> Result<RegionGraph, MethodError> {
    let pairs = adjacent_pairs(problem.cloud.points(), problem.supports.lists);
    Ok(RegionGraph::new(problem.cloud, problem.labels, &pairs)?)
}

/// The components, and which of them touch.
fn picture<const D: usize>(
    problem: &Problem<'_, D>,
    graph: &RegionGraph,
) -> (Vec<ComponentInfo>, Vec<Vec<u32>>) {
    let count = graph.components().len() as u32;
    with_surroundings(problem, graph, (0..count).map(|c| graph.touching(c).to_vec()).collect())
}

/// The same where who touches whom is known, with what is outside of the domain.
fn with_surroundings<const D: usize>(
    problem: &Problem<'_, D>,
    graph: &RegionGraph,
    mut adjacency: Vec<Vec<u32>>,
) -> (Vec<ComponentInfo>, Vec<Vec<u32>>) {
    let mut components = component_infos(problem, graph);
    add_films(problem, graph, &mut components, &mut adjacency);
    add_surroundings(problem, graph, &mut components, &mut adjacency);
    (components, adjacency)
}

/// The clusters that the rows leave afloat.
///
/// Balances tie a stiff region to soft surroundings by entries smaller than its others by the contrast. Stencils that reach
/// across the interface, with the smeared diffusivity or without regard to it, have entries of one size on both sides: they
/// hold the region whatever the contrast. Its nodal values are well determined then, and not constant to as many digits as
/// splitting would ask for. Components with such rows count as fixed.
fn not_held<const D: usize>(
    problem: &Problem<'_, D>,
    graph: &RegionGraph,
    matrix: &DifferenceMatrix,
    component: &[u32],
) -> Vec<Cluster> {
    let (mut components, adjacency) = picture(problem, graph);
    loop {
        let found = clusters(&components, &adjacency, DEFAULT_THRESHOLD);
        let held: Vec<&Cluster> =
            found.iter().filter(|cluster| is_held(cluster, &components, matrix, component)).collect();
        if held.is_empty() {
            return found;
        }
        for &member in held.iter().flat_map(|cluster| &cluster.own) {
            components[member as usize].touches_fixed = true;
        }
    }
}

/// Whether rows of a cluster that reach outside tie it to there by far more than balances would. Rows that reach nothing else say
/// nothing: what ties a node to its cluster has no size in them.
fn is_held(
    cluster: &Cluster,
    components: &[ComponentInfo],
    matrix: &DifferenceMatrix,
    component: &[u32],
) -> bool {
    let inside = |i: usize| cluster.members.binary_search(&component[i]).is_ok();
    let stiff = cluster.members.iter().map(|&m| components[m as usize].eta_min).fold(f64::INFINITY, f64::min);
    let (mut crossing, mut holding) = (0_u32, 0_u32);
    for i in (0..matrix.n()).filter(|&i| inside(i)) {
        let (columns, row) = matrix.row(i);
        if columns.iter().all(|&j| !inside(j as usize)) {
            continue;
        }
        let (mut tie, mut soft, mut largest) = (0.0_f64, 0.0_f64, 0.0_f64);
        for (&j, a) in columns.iter().zip(row) {
            largest = largest.max(a.abs());
            if !inside(j as usize) {
                tie += a;
                soft = soft.max(components[component[j as usize] as usize].eta_max);
            }
        }
        if soft > 0.0 {
            crossing += 1;
            holding += u32::from(tie.abs() > largest * (BALANCED * soft / stiff).max(HELD));
        }
    }
    f64::from(holding) > HOLDING * f64::from(crossing)
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
    let graph = region_graph(problem)?;
    let count = graph.components().len();
    let component: Vec<u32> = nodes.iter().map(|&node| graph.component_of(node)).collect();
    let found = not_held(problem, &graph, matrix, &component);
    if found.is_empty() {
        return Ok(None);
    }
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
    let films = problem.laws.iter().filter_map(|law| film_level(problem, law));
    let levels = problem.eta.iter().copied().chain(robin).chain(films);
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

/// The diffusivity that a layer of the size of the domain would have if it let through as much as the film of an interface does.
fn film_level<const D: usize>(problem: &Problem<'_, D>, law: &InterfaceLaw<D>) -> Option<f64> {
    let resistance = match law.resistance.as_ref()? {
        Field::Constant(value) => *value,
        // Where it is least, as far as the nodes on one of its sides tell.
        field => {
            let own = problem.labels.iter().zip(problem.cloud.points());
            let near = own.filter(|(label, _)| **label == law.between[0]).map(|(_, x)| field.at(x));
            near.filter(|value| *value >= 0.0).fold(f64::INFINITY, f64::min)
        }
    };
    let level = problem.domain.bounds().diameter() / resistance;
    (level > 0.0 && level.is_finite()).then_some(level)
}

/// Puts a component of its own between parts with a film in between that lets through far less than either of them. All of these are as tight
/// as the tightest: films of several levels would be clusters without nodes.
fn add_films<const D: usize>(
    problem: &Problem<'_, D>,
    graph: &RegionGraph,
    components: &mut Vec<ComponentInfo>,
    adjacency: &mut Vec<Vec<u32>>,
) {
    let label = |c: u32| graph.components()[c as usize].label;
    let count = graph.components().len() as u32;
    let mut films: Vec<[u32; 2]> = Vec::new();
    let mut tightest = f64::INFINITY;
    for law in problem.laws {
        let Some(level) = film_level(problem, law) else { continue };
        let [from, to] = law.between;
        for a in (0..count).filter(|&c| label(c) == from) {
            for b in (0..count).filter(|&c| label(c) == to) {
                let [first, second] = [a, b].map(|c| components[c as usize].eta_min);
                let touch = adjacency[a as usize].contains(&b) || adjacency[b as usize].contains(&a);
                if touch && level * DEFAULT_THRESHOLD <= first.min(second) {
                    films.push([a, b]);
                    tightest = tightest.min(level);
                }
            }
        }
    }
    for [a, b] in films {
        components.push(ComponentInfo { eta_min: tightest, eta_max: tightest, touches_fixed: false });
        adjacency.push(vec![a, b]);
        for (own, other) in [(a, b), (b, a)] {
            adjacency[own as usize].retain(|&c| c != other);
        }
    }
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
    // What reacts has a level of its own.
    for (info, component) in infos.iter_mut().zip(graph.components()) {
        info.touches_fixed |= problem.materials[component.label as usize].reaction.is_some();
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
