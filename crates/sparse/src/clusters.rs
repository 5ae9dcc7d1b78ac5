//! Which parts of a domain float: stiff, and tied to prescribed values only through softer surroundings.

/// A connected part of the domain with its range of diffusivities.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ComponentInfo {
    /// Smallest diffusivity of a node.
    pub eta_min: f64,
    /// Largest diffusivity of a node.
    pub eta_max: f64,
    /// Whether u is fixed somewhere in it, by a Dirichlet or a Robin condition.
    pub fixed: bool,
}

/// A connected set of components that is stiffer than all that surrounds it and in which nothing is fixed: its values
/// are one constant plus something small.
#[derive(Debug, Clone, PartialEq)]
pub struct Cluster {
    /// Its components, ascending.
    pub members: Vec<u32>,
    /// The smallest cluster that contains it.
    pub parent: Option<u32>,
    /// Factor of its constant: the scale of its surroundings.
    pub sigma: f64,
    /// Factor of what varies within it: `sigma` times the ratio of the diffusivities outside and inside.
    pub scale: f64,
}

/// Contrast above which a component floats; below it there is nothing to gain from splitting off a constant.
pub const FLOATING_THRESHOLD: f64 = 10.0;

/// The floating clusters, each after those that contain it.
///
/// A cluster is a connected component of the set where the diffusivity is at least some value, in which nothing is
/// fixed, and whose smallest diffusivity exceeds [`FLOATING_THRESHOLD`] times the largest one of its neighbours. So
/// clusters are nested or disjoint: of rings 1, 1e5, 1e10 from the outside, the two inner ones together are one, and the
/// innermost is another within it.
///
/// `adjacency[c]` lists the components next to c.
pub fn floating_clusters(components: &[ComponentInfo], adjacency: &[Vec<u32>]) -> Vec<Cluster> {
    let mut levels: Vec<f64> = components.iter().map(|c| c.eta_min).collect();
    levels.sort_by(f64::total_cmp);
    levels.dedup();
    let mut clusters: Vec<Cluster> = Vec::new();
    for level in levels {
        for members in superlevel_sets(components, adjacency, level) {
            let Some(ambient) = ambient(components, adjacency, &members) else { continue };
            let eta = members.iter().fold(f64::INFINITY, |a, &c| a.min(components[c as usize].eta_min));
            let fixed = members.iter().any(|&c| components[c as usize].fixed);
            let known = clusters.iter().any(|c| c.members == members);
            if fixed || known || eta <= FLOATING_THRESHOLD * ambient {
                continue;
            }
            // Larger sets come first, so the last one that contains this is the smallest.
            let parent = clusters.iter().rposition(|c| members.iter().all(|m| c.members.contains(m)));
            let sigma = parent.map_or(1.0, |p| clusters[p].scale);
            clusters.push(Cluster {
                members,
                parent: parent.map(|p| p as u32),
                sigma,
                scale: sigma * ambient / eta,
            });
        }
    }
    clusters
}

/// Largest diffusivity next to a set; `None` for a set without surroundings.
fn ambient(components: &[ComponentInfo], adjacency: &[Vec<u32>], members: &[u32]) -> Option<f64> {
    let outside = members.iter().flat_map(|&c| &adjacency[c as usize]).filter(|n| !members.contains(n));
    outside.map(|&n| components[n as usize].eta_max).reduce(f64::max)
}

/// Connected sets of components whose smallest diffusivity is at least `level`.
fn superlevel_sets(components: &[ComponentInfo], adjacency: &[Vec<u32>], level: f64) -> Vec<Vec<u32>> {
    let mut seen: Vec<bool> = components.iter().map(|c| c.eta_min < level).collect();
    let mut sets = Vec::new();
    for start in 0..components.len() {
        if seen[start] {
            continue;
        }
        seen[start] = true;
        let mut set = vec![start as u32];
        let mut next = 0;
        while next < set.len() {
            for &neighbor in &adjacency[set[next] as usize] {
                if !std::mem::replace(&mut seen[neighbor as usize], true) {
                    set.push(neighbor);
                }
            }
            next += 1;
        }
        set.sort_unstable();
        sets.push(set);
    }
    sets
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chain(etas: &[f64], fixed: usize) -> Vec<Cluster> {
        let components: Vec<ComponentInfo> = etas
            .iter()
            .enumerate()
            .map(|(i, &eta)| ComponentInfo { eta_min: eta, eta_max: eta, fixed: i == fixed })
            .collect();
        let n = etas.len() as u32;
        let adjacency: Vec<Vec<u32>> =
            (0..n).map(|i| [i.wrapping_sub(1), i + 1].into_iter().filter(|&j| j < n).collect()).collect();
        floating_clusters(&components, &adjacency)
    }

    #[test]
    fn nested_stiff_rings_are_nested_clusters() {
        let clusters = chain(&[1.0, 1e5, 1e10], 0);
        assert_eq!(clusters.len(), 2);
        assert_eq!((clusters[0].members.as_slice(), clusters[0].parent), (&[1, 2][..], None));
        assert_eq!((clusters[1].members.as_slice(), clusters[1].parent), (&[2][..], Some(0)));
        assert!((clusters[0].scale / 1e-5 - 1.0).abs() < 1e-12);
        assert!((clusters[1].sigma / 1e-5 - 1.0).abs() < 1e-12);
        assert!((clusters[1].scale / 1e-10 - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_stiff_ring_takes_the_soft_core_not_with_it() {
        let clusters = chain(&[1.0, 1e10, 1e5], 0);
        assert_eq!(clusters.len(), 1);
        assert_eq!(clusters[0].members, [1, 2]);
        let clusters = chain(&[1.0, 1e10, 1.0], 0);
        assert_eq!(clusters.len(), 1);
        assert_eq!(clusters[0].members, [1]);
    }

    #[test]
    fn an_ordinary_core_within_a_soft_ring_floats() {
        let clusters = chain(&[1.0, 1e-10, 1.0], 0);
        assert_eq!(clusters.len(), 1);
        assert_eq!(clusters[0].members, [2]);
    }

    #[test]
    fn what_is_fixed_or_hardly_stiffer_does_not_float() {
        assert!(chain(&[1.0, 1e6], 1).is_empty());
        assert!(chain(&[1.0, 9.0], 0).is_empty());
        assert!(chain(&[1.0, 1.0, 1.0], 0).is_empty());
    }
}
