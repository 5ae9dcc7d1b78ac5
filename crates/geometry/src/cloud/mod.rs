//! Point clouds: what they are, how they are asked for, and how good they are.

mod estimate;
mod front;
mod generate;
mod given;
mod lattice;
mod line;
mod params;
mod quality;
mod sizes;
mod validate;

pub use estimate::{check_size, estimate_nodes};
pub(crate) use estimate::{half_layer, too_many};
pub use generate::generate;
pub use given::{GivenCloud, GivenParams, around};
pub use params::{CloudParams, Layout, Spacing, SpacingFn};
pub use quality::{CloudQuality, quality};
pub use sizes::Size;
pub(crate) use sizes::Sizes;

use crate::domain::FaceId;
use crate::error::GeometryError;

/// A node's share in one face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touch<const D: usize> {
    /// The face.
    pub face: FaceId,
    /// Unit normal of the face at the node, out of the domain.
    pub normal: [f64; D],
}

/// A node on the boundary.
#[derive(Clone, Debug, PartialEq)]
pub struct BoundaryNode<const D: usize> {
    /// Index of the node in [`Cloud::points`].
    pub node: u32,
    /// One entry a smooth surface that the node lies on: one inside of a face, two on an edge, `D` or more in a
    /// corner. Two surfaces of the same face (the sides of a polygon) make two entries with that face.
    pub touches: Vec<Touch<D>>,
}

/// Nodes of a domain, those on the boundary with outward normals, and the spacing that was aimed at.
#[derive(Clone, Debug, PartialEq)]
pub struct Cloud<const D: usize> {
    points: Vec<[f64; D]>,
    boundary: Vec<BoundaryNode<D>>,
    spacing: Vec<f64>,
    /// Position in `boundary` of every node, `INTERIOR` for the others.
    boundary_index: Vec<u32>,
}

const INTERIOR: u32 = u32::MAX;

impl<const D: usize> Cloud<D> {
    /// A cloud from its parts: coordinates, boundary nodes (in any order), and a spacing a node.
    ///
    /// Coinciding nodes are not looked for; the neighbour search reports them.
    ///
    /// # Errors
    /// [`GeometryError::InvalidCloud`] for numbers that are not finite, spacings that are not positive, indices out of
    /// range or named twice, boundary nodes without a touch, and normals that are not of unit length (to 1e-9).
    pub fn from_parts(
        points: Vec<[f64; D]>,
        boundary: Vec<BoundaryNode<D>>,
        spacing: Vec<f64>,
    ) -> Result<Self, GeometryError> {
        validate::check(&points, &boundary, &spacing)?;
        Ok(Self::assemble(points, boundary, spacing))
    }

    fn assemble(mut points: Vec<[f64; D]>, mut boundary: Vec<BoundaryNode<D>>, spacing: Vec<f64>) -> Self {
        boundary.sort_by_key(|b| b.node);
        // A zero has no sign: data such as atan2 would take the other branch.
        points.iter_mut().flatten().for_each(|c| *c += 0.0);
        let mut boundary_index = vec![INTERIOR; points.len()];
        for (k, b) in boundary.iter().enumerate() {
            boundary_index[b.node as usize] = k as u32;
        }
        Self { points, boundary, spacing, boundary_index }
    }

    /// Coordinates of the nodes, along a space-filling curve where [`generate`] made them.
    pub fn points(&self) -> &[[f64; D]] {
        &self.points
    }

    /// Number of nodes.
    pub fn len(&self) -> usize {
        self.points.len()
    }

    /// Whether there are no nodes.
    pub fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// The boundary nodes, by increasing index.
    pub fn boundary(&self) -> &[BoundaryNode<D>] {
        &self.boundary
    }

    /// The boundary entry of node `i`, `None` for interior nodes.
    ///
    /// # Panics
    /// For an index out of range.
    pub fn boundary_of(&self, i: usize) -> Option<&BoundaryNode<D>> {
        match self.boundary_index[i] {
            INTERIOR => None,
            k => Some(&self.boundary[k as usize]),
        }
    }

    /// Whether node `i` lies on the boundary.
    ///
    /// # Panics
    /// For an index out of range.
    pub fn is_boundary(&self, i: usize) -> bool {
        self.boundary_index[i] != INTERIOR
    }

    /// The spacing aimed at, at each node.
    pub fn spacing(&self) -> &[f64] {
        &self.spacing
    }

    /// The same cloud with its nodes in another order: node `i` of the result is node `order[i]`.
    ///
    /// # Errors
    /// [`GeometryError::InvalidCloud`] unless `order` names every node once.
    pub fn permuted(&self, order: &[u32]) -> Result<Self, GeometryError> {
        let inverse = validate::inverse_permutation(order, self.len())?;
        let points = order.iter().map(|&i| self.points[i as usize]).collect();
        let spacing = order.iter().map(|&i| self.spacing[i as usize]).collect();
        let boundary = self
            .boundary
            .iter()
            .map(|b| BoundaryNode { node: inverse[b.node as usize], touches: b.touches.clone() })
            .collect();
        Ok(Self::assemble(points, boundary, spacing))
    }
}
