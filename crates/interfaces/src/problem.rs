//! The discretised problem: what every method reads, and nothing of how it was described.

use meshless_geometry::{Cloud, Domain, RegionMap};
use meshless_neighbors::NeighborLists;

use crate::equation::between;
use crate::{BoundaryData, Condition, InterfaceLaw, Material, MethodError, SlitInterface};

/// The supports of all nodes: whom a node may use, and how far its interaction reaches.
#[derive(Debug, Clone, Copy)]
pub struct Supports<'a> {
    /// Symmetric lists (distance d2 of Kraus et al. 2022, section 2.1).
    pub lists: &'a NeighborLists,
    /// Interaction radius `h_i` of every node.
    pub radius: &'a [f64],
}

/// A problem on a cloud, with everything evaluated that lives on nodes.
#[derive(Clone, Copy)]
pub struct Problem<'a, const D: usize> {
    /// The nodes.
    pub cloud: &'a Cloud<D>,
    /// The domain that the nodes fill.
    pub domain: &'a Domain<D>,
    /// Neighbour lists and interaction radii.
    pub supports: Supports<'a>,
    /// Geometry of the regions; tells where interfaces are.
    pub regions: &'a RegionMap<D>,
    /// Region of every node.
    pub labels: &'a [u16],
    /// Data of every region.
    pub materials: &'a [Material<D>],
    /// Diffusivity at every node, that of the node's own region.
    pub eta: &'a [f64],
    /// Source at every node, that of the node's own region; `None` if no region has one.
    pub source: Option<&'a [f64]>,
    /// Conditions of every boundary node, one for each of its touches, in the order of `cloud.boundary()`.
    pub conditions: &'a [Vec<Condition>],
    /// The same conditions as functions of position.
    pub boundary: &'a dyn BoundaryData<D>,
    /// Laws of the interfaces at which something jumps.
    pub laws: &'a [InterfaceLaw<D>],
    /// How fast they change, of those that change with time; empty in steady problems.
    pub law_rates: &'a [InterfaceLaw<D>],
    /// Interfaces that end inside the domain.
    pub slits: &'a [SlitInterface<D>],
}

impl<const D: usize> std::fmt::Debug for Problem<'_, D> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Problem")
            .field("nodes", &self.cloud.len())
            .field("regions", &self.materials.len())
            .finish()
    }
}

impl<const D: usize> Problem<'_, D> {
    /// Checks that the parts fit together: a value a node, a condition a touch, diffusivities that are positive.
    ///
    /// # Errors
    /// [`MethodError::InvalidProblem`] with the first thing that is wrong.
    pub fn check(&self) -> Result<(), MethodError> {
        let invalid = |what: String| Err(MethodError::InvalidProblem { what });
        let nodes = self.cloud.len();
        let lengths = [
            ("neighbour lists", self.supports.lists.len()),
            ("interaction radii", self.supports.radius.len()),
            ("labels", self.labels.len()),
            ("diffusivities", self.eta.len()),
            ("sources", self.source.map_or(nodes, <[f64]>::len)),
        ];
        if let Some((what, found)) = lengths.into_iter().find(|(_, found)| *found != nodes) {
            return invalid(format!("{found} {what} for {nodes} nodes"));
        }
        if let Some(i) = self.eta.iter().position(|&eta| !(eta > 0.0 && eta.is_finite())) {
            let (eta, x) = (self.eta[i], self.cloud.points()[i]);
            return invalid(format!(
                "the diffusivity {eta} at node {i} (at {x:?}) is not positive and finite"
            ));
        }
        if let Some(i) = self.source.and_then(|f| f.iter().position(|f| !f.is_finite())) {
            return invalid(format!(
                "the source at node {i} (at {:?}) is not finite",
                self.cloud.points()[i]
            ));
        }
        let boundary = self.cloud.boundary();
        if self.conditions.len() != boundary.len() {
            return invalid(format!(
                "conditions at {} of {} boundary nodes",
                self.conditions.len(),
                boundary.len()
            ));
        }
        match boundary.iter().zip(self.conditions).find(|(node, given)| node.touches.len() != given.len()) {
            Some((node, given)) => {
                let (node, found, touches) = (node.node, given.len(), node.touches.len());
                invalid(format!("node {node} has {found} conditions on {touches} faces"))
            }
            None => Ok(()),
        }
    }

    /// The largest diffusivity of a node over the smallest.
    pub fn contrast(&self) -> f64 {
        let (low, high) = self.eta.iter().fold((f64::INFINITY, 0.0_f64), |(l, h), &e| (l.min(e), h.max(e)));
        high / low
    }

    /// The diffusivity if it is the same at every node.
    pub fn uniform_diffusivity(&self) -> Option<f64> {
        let first = *self.eta.first()?;
        self.materials.iter().all(|m| m.diffusivity.as_constant() == Some(first)).then_some(first)
    }

    /// Dirichlet values: `Some(value)` at the nodes where u is prescribed.
    ///
    /// Where faces meet that prescribe different values, u has every value in between at the one point, and the node gets their mean: it
    /// is that on the bisector, of which the values round a node see most. Measured on half a square with 20 above and 0 beside it, order 4,
    /// the mean leaves a 15th to a 30th of the error of either value, and an error that falls with the spacing by itself.
    pub fn dirichlet(&self) -> Vec<Option<f64>> {
        let mut known = vec![None; self.cloud.len()];
        for (node, conditions) in self.cloud.boundary().iter().zip(self.conditions) {
            let mut values = conditions.iter().filter_map(|c| match c {
                Condition::Dirichlet(value) => Some(*value),
                _ => None,
            });
            let Some(first) = values.next() else { continue };
            // As a difference from the first, so that equal values stay what they are.
            let (sum, count) = values.fold((0.0, 1.0), |(sum, count), v| (sum + (v - first), count + 1.0));
            known[node.node as usize] = Some(first + sum / count);
        }
        known
    }

    /// The law of the interface between two regions, with the sign that belongs to going from `from` to `to`; `None` where they are perfectly
    /// joined.
    pub fn law_between(&self, from: u16, to: u16) -> Option<(&InterfaceLaw<D>, f64)> {
        between(self.laws, from, to)
    }

    /// How fast it changes, likewise.
    pub fn law_rate_between(&self, from: u16, to: u16) -> Option<(&InterfaceLaw<D>, f64)> {
        between(self.law_rates, from, to)
    }

    /// The velocity at a node, that of its own region.
    pub fn velocity(&self, i: usize) -> [f64; D] {
        self.materials[self.labels[i] as usize].velocity_at(&self.cloud.points()[i])
    }

    /// The factor of u at a node, likewise.
    pub fn reaction(&self, i: usize) -> f64 {
        self.materials[self.labels[i] as usize].reaction_at(&self.cloud.points()[i])
    }

    /// The factor of du/dt at a node, likewise.
    pub fn capacity(&self, i: usize) -> f64 {
        self.materials[self.labels[i] as usize].capacity_at(&self.cloud.points()[i])
    }

    /// Whether any region has a factor of du/dt that is not 1.
    pub fn has_capacities(&self) -> bool {
        self.materials.iter().any(|material| material.capacity.is_some())
    }

    /// Whether the equation of any region has terms in u and its gradient beside the diffusion.
    pub fn has_lower_terms(&self) -> bool {
        self.materials.iter().any(Material::has_lower_terms)
    }

    /// Whether u is fixed somewhere: by a Dirichlet value, by a Robin condition with `a != 0`, or by a reaction.
    pub fn is_anchored(&self) -> bool {
        let reacts = self.materials.iter().any(|material| material.reaction.is_some());
        reacts || self.conditions.iter().flatten().any(Condition::anchors)
    }
}
