use std::collections::{BTreeMap, BTreeSet};

use crate::cloud::Cloud;
use crate::domain::FaceId;
use crate::error::GeometryError;

/// A connected set of nodes with the same label.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Component {
    /// The region's label.
    pub label: u16,
    /// Number of nodes.
    pub nodes: usize,
    /// The node with the lowest index.
    pub representative: u32,
}

/// The connected components of the regions of a cloud, which of them touch each other, and which faces they touch.
///
/// Components are numbered by their representatives, so that the numbering does not depend on the order of the pairs.
#[derive(Clone, Debug)]
pub struct RegionGraph {
    components: Vec<Component>,
    component_of: Vec<u32>,
    touching: Vec<Vec<u32>>,
    /// Adjacent pairs of nodes between components `(low, high)`.
    contacts: BTreeMap<(u32, u32), usize>,
    faces: Vec<Vec<FaceId>>,
}

impl RegionGraph {
    /// From the labels of a cloud's nodes and the pairs of nodes that are adjacent (with no third node in between),
    /// in any order and orientation. A pair given twice counts twice in [`RegionGraph::contact_pairs`].
    ///
    /// # Errors
    /// [`GeometryError::InvalidRegions`] unless there is a label a node and all pairs are in range.
    pub fn new<const D: usize>(
        cloud: &Cloud<D>,
        labels: &[u16],
        pairs: &[(u32, u32)],
    ) -> Result<Self, GeometryError> {
        let n = cloud.len();
        let invalid = |reason: String| GeometryError::InvalidRegions { reason };
        if labels.len() != n {
            return Err(invalid(format!("{} labels for {n} nodes", labels.len())));
        }
        if let Some(&(i, j)) = pairs.iter().find(|&&(i, j)| i as usize >= n || j as usize >= n) {
            return Err(invalid(format!("the pair ({i}, {j}) names a node beyond the {n} there are")));
        }
        let (components, component_of) = connected(labels, pairs);
        let mut contacts = BTreeMap::new();
        for &(i, j) in pairs {
            let (a, b) = (component_of[i as usize], component_of[j as usize]);
            if a != b {
                *contacts.entry((a.min(b), a.max(b))).or_insert(0) += 1;
            }
        }
        let mut touching = vec![Vec::new(); components.len()];
        for &(a, b) in contacts.keys() {
            touching[a as usize].push(b);
            touching[b as usize].push(a);
        }
        for list in &mut touching {
            list.sort_unstable();
        }
        let mut faces = vec![BTreeSet::new(); components.len()];
        for b in cloud.boundary() {
            faces[component_of[b.node as usize] as usize].extend(b.touches.iter().map(|t| t.face));
        }
        let faces = faces.into_iter().map(|set| set.into_iter().collect()).collect();
        Ok(Self { components, component_of, touching, contacts, faces })
    }

    /// The components, by increasing lowest node.
    pub fn components(&self) -> &[Component] {
        &self.components
    }

    /// The component that a node belongs to.
    ///
    /// # Panics
    /// For a node out of range.
    pub fn component_of(&self, node: u32) -> u32 {
        self.component_of[node as usize]
    }

    /// The components next to component `c`, increasing. They have other labels.
    ///
    /// # Panics
    /// For a component out of range.
    pub fn touching(&self, c: u32) -> &[u32] {
        &self.touching[c as usize]
    }

    /// How many adjacent pairs of nodes join two components; zero where they do not touch.
    pub fn contact_pairs(&self, a: u32, b: u32) -> usize {
        self.contacts.get(&(a.min(b), a.max(b))).copied().unwrap_or(0)
    }

    /// The faces on which component `c` has nodes, increasing.
    ///
    /// # Panics
    /// For a component out of range.
    pub fn faces_of(&self, c: u32) -> &[FaceId] {
        &self.faces[c as usize]
    }
}

/// Union-find over the pairs of equal label.
fn connected(labels: &[u16], pairs: &[(u32, u32)]) -> (Vec<Component>, Vec<u32>) {
    let mut parent: Vec<u32> = (0..labels.len() as u32).collect();
    for &(i, j) in pairs {
        if labels[i as usize] == labels[j as usize] {
            let (a, b) = (root(&mut parent, i), root(&mut parent, j));
            // The lower index is the root, hence every root is its component's lowest node.
            parent[a.max(b) as usize] = a.min(b);
        }
    }
    let mut components: Vec<Component> = Vec::new();
    let mut component_of = vec![0; labels.len()];
    for i in 0..labels.len() as u32 {
        let r = root(&mut parent, i);
        if r == i {
            component_of[i as usize] = components.len() as u32;
            components.push(Component { label: labels[i as usize], nodes: 1, representative: i });
        } else {
            component_of[i as usize] = component_of[r as usize];
            components[component_of[r as usize] as usize].nodes += 1;
        }
    }
    (components, component_of)
}

fn root(parent: &mut [u32], mut i: u32) -> u32 {
    while parent[i as usize] != i {
        let above = parent[parent[i as usize] as usize];
        parent[i as usize] = above;
        i = above;
    }
    i
}
