//! Which connected sets of components float: found from the graph of components, never listed by hand.

/// Ratio of coefficients from which a constant is worth an unknown of its own: below it, at most one digit is lost.
pub const DEFAULT_THRESHOLD: f64 = 10.0;

/// A component: a connected part of one region, as far as the equations see it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ComponentInfo {
    /// Smallest coefficient in it, positive and finite.
    pub eta_min: f64,
    /// Largest coefficient in it, positive and finite.
    pub eta_max: f64,
    /// Whether its level is fixed: Dirichlet or Robin data on its boundary, or an absorption term.
    pub touches_fixed: bool,
}

/// A connected set of components whose common constant only softer surroundings determine.
#[derive(Debug, Clone, PartialEq)]
pub struct Cluster {
    /// Its components, those of nested clusters included, increasing.
    pub members: Vec<u32>,
    /// The smallest cluster round this one; clusters are listed after their parents.
    pub parent: Option<u32>,
    /// `sigma`: what the cluster's unknown constant is measured in, the scale of its surroundings; 1 for an
    /// outermost cluster.
    pub factor: f64,
    /// Components that belong to this cluster and to none inside it, increasing; never empty.
    pub own: Vec<u32>,
    /// Scale `s` of each component in `own`: `eta s` is as large as it is round the cluster.
    pub scales: Vec<f64>,
}

/// Finds the floating clusters. `adjacency[k]` lists the components that component `k` touches, in either or both
/// directions.
///
/// A cluster is a connected set without fixed components whose coefficients all exceed those of its neighbours
/// outside, and exceed by `threshold` the level that already stands: the smallest coefficient of the cluster round
/// it, or, for an outermost one, the largest level at which the way from the cluster to a fixed component is
/// open (the smallest coefficient on the best way). Every set whose coefficients exceed all neighbours' by the
/// threshold is such a cluster; a coefficient that grows in smaller steps, which adds up to as much, makes
/// clusters too, one for each factor of `threshold`. Clusters are nested or disjoint, so they form trees: of
/// (1 fixed, 1e5, 1e10), {1e5, 1e10} and within it {1e10}; of (1 fixed, 1e-10, 1), the inner 1.
///
/// A set that touches nothing else is no cluster: without fixed data it is a pure Neumann problem
/// ([`pure_neumann`](crate::pure_neumann)). Components whose coefficients are not positive and finite belong to none.
///
/// The scales carry the flux: within a cluster `u = constant + s w` with `s = E / eta_min`, where `E` is the largest
/// `eta_max s` of the neighbours outside. A flux that leaves the surroundings with `w` of order 1 then meets `w`
/// of order 1 inside.
#[must_use]
pub fn clusters(components: &[ComponentInfo], adjacency: &[Vec<u32>], threshold: f64) -> Vec<Cluster> {
    let graph = Graph::new(components, adjacency);
    let mut found: Vec<Cluster> = Vec::new();
    for set in graph.superlevel_sets() {
        // Sets come from the lowest level upwards, so the cluster round this one is known if there is one.
        let parent = found.iter().rposition(|c| c.members.binary_search(&set.members[0]).is_ok());
        let standing = match parent {
            Some(p) => graph.lowest(&found[p].members),
            None => graph.level_of_fixed(&set.members),
        };
        if let Some(standing) = standing
            && set.level > threshold * standing
            && set.level > graph.highest_outside(&set.members)
        {
            let parent = parent.map(|p| p as u32);
            found.push(Cluster {
                members: set.members,
                parent,
                factor: 1.0,
                own: Vec::new(),
                scales: Vec::new(),
            });
        }
    }
    assign_scales(&graph, &mut found);
    found
}

/// A connected component of the set of components with `eta_min >= level`.
struct LevelSet {
    level: f64,
    members: Vec<u32>,
}

struct Graph<'a> {
    components: &'a [ComponentInfo],
    neighbors: Vec<Vec<u32>>,
}

impl<'a> Graph<'a> {
    fn new(components: &'a [ComponentInfo], adjacency: &[Vec<u32>]) -> Self {
        let n = components.len();
        let mut neighbors = vec![Vec::new(); n];
        for (k, touched) in adjacency.iter().enumerate().take(n) {
            for &j in touched.iter().filter(|&&j| (j as usize) < n && j as usize != k) {
                neighbors[k].push(j);
                neighbors[j as usize].push(k as u32);
            }
        }
        for list in &mut neighbors {
            list.sort_unstable();
            list.dedup();
        }
        Self { components, neighbors }
    }

    fn eta(&self, k: u32) -> f64 {
        self.components[k as usize].eta_min
    }

    fn is_sound(&self, k: u32) -> bool {
        let c = self.components[k as usize];
        c.eta_min > 0.0 && c.eta_max.is_finite() && c.eta_min <= c.eta_max
    }

    /// What is reached from `start` without leaving `eta_min >= level`, sorted.
    fn reach(&self, start: u32, level: f64) -> Vec<u32> {
        let mut seen = vec![false; self.components.len()];
        seen[start as usize] = true;
        let mut stack = vec![start];
        let mut members = Vec::new();
        while let Some(k) = stack.pop() {
            members.push(k);
            for &j in &self.neighbors[k as usize] {
                if !seen[j as usize] && self.is_sound(j) && self.eta(j) >= level {
                    seen[j as usize] = true;
                    stack.push(j);
                }
            }
        }
        members.sort_unstable();
        members
    }

    /// All connected sets above a level that touch nothing fixed, larger ones before those inside them.
    fn superlevel_sets(&self) -> Vec<LevelSet> {
        let mut sets: Vec<LevelSet> = Vec::new();
        let mut order: Vec<u32> = (0..self.components.len() as u32).filter(|&k| self.is_sound(k)).collect();
        order.sort_by(|&a, &b| self.eta(a).total_cmp(&self.eta(b)).then(a.cmp(&b)));
        for k in order {
            let level = self.eta(k);
            let members = self.reach(k, level);
            let floats = members.iter().all(|&j| !self.components[j as usize].touches_fixed);
            // Components of equal level in one set give the same set again.
            let is_new = members.iter().find(|&&j| self.eta(j) == level) == Some(&k);
            if floats && is_new {
                sets.push(LevelSet { level, members });
            }
        }
        sets
    }

    fn lowest(&self, members: &[u32]) -> Option<f64> {
        members.iter().map(|&k| self.eta(k)).min_by(f64::total_cmp)
    }

    fn outside<'b>(&'b self, members: &'b [u32]) -> impl Iterator<Item = u32> + 'b {
        let touched = members.iter().flat_map(|&k| self.neighbors[k as usize].iter().copied());
        touched.filter(|j| members.binary_search(j).is_err())
    }

    /// Largest coefficient of the neighbours outside; infinite if there are none.
    fn highest_outside(&self, members: &[u32]) -> f64 {
        let highest = self.outside(members).map(|j| self.components[j as usize].eta_max);
        highest.max_by(f64::total_cmp).unwrap_or(f64::INFINITY)
    }

    /// The largest level above which the set is joined to something fixed; without anything fixed, the lowest level of
    /// all that the set is joined to, because that is where its constant meets the others.
    fn level_of_fixed(&self, members: &[u32]) -> Option<f64> {
        let everything = self.reach(members[0], 0.0);
        let mut levels: Vec<f64> = everything.iter().map(|&k| self.eta(k)).collect();
        levels.sort_by(|a, b| b.total_cmp(a));
        let is_fixed = |level: f64| {
            self.reach(members[0], level).iter().any(|&k| self.components[k as usize].touches_fixed)
        };
        let start = self.lowest(members)?;
        levels.iter().copied().filter(|&l| l <= start).find(|&l| is_fixed(l)).or(levels.last().copied())
    }
}

fn assign_scales(graph: &Graph<'_>, found: &mut [Cluster]) {
    let mut scale = vec![1.0; graph.components.len()];
    let mut innermost = vec![None; graph.components.len()];
    for (c, cluster) in found.iter().enumerate() {
        for &k in &cluster.members {
            innermost[k as usize] = Some(c);
        }
    }
    for c in 0..found.len() {
        let cluster = &found[c];
        let around =
            |j: u32| cluster.parent.is_none_or(|p| found[p as usize].members.binary_search(&j).is_ok());
        let (mut flux, mut factor) = (0.0f64, 0.0f64);
        for j in graph.outside(&cluster.members) {
            flux = flux.max(graph.components[j as usize].eta_max * scale[j as usize]);
            // A nested cluster may touch what is outside of its parent, too, where its constant is not measured.
            if around(j) {
                factor = factor.max(scale[j as usize]);
            }
        }
        let own: Vec<u32> =
            cluster.members.iter().copied().filter(|&k| innermost[k as usize] == Some(c)).collect();
        let scales: Vec<f64> = own.iter().map(|&k| flux / graph.eta(k)).collect();
        for (&k, &s) in own.iter().zip(&scales) {
            scale[k as usize] = s;
        }
        found[c] = Cluster { factor, own, scales, ..found[c].clone() };
    }
}
