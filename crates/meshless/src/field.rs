//! The field at the nodes, in three coordinates whatever the dimension.

use meshless_interfaces::{NodeDiagnosis, RowKind};

use crate::execute::Discrete;

/// Nodal values of a solution.
#[derive(Debug, Clone)]
pub struct NodalField {
    /// 1, 2 or 3.
    pub dimension: usize,
    /// Coordinates; those beyond the dimension are zero.
    pub points: Vec<[f64; 3]>,
    /// How far apart nodes are there.
    pub spacing: Vec<f64>,
    /// The solution.
    pub u: Vec<f64>,
    /// Its gradient, each node in its own region.
    pub gradient: Option<Vec<[f64; 3]>>,
    /// The velocity, where the scene has a vorticity.
    pub velocity: Option<Vec<[f64; 3]>>,
    /// The exact solution, where the scene has one.
    pub exact: Option<Vec<f64>>,
    /// The diffusivity.
    pub eta: Vec<f64>,
    /// The region.
    pub region: Vec<u16>,
    /// How the row of the node was made.
    pub kind: Vec<RowKind>,
    /// The estimated error, where the method is compared with itself by polynomials of one degree more, on the same nodes.
    pub estimate: Option<Vec<f64>>,
    /// How large the own part of every node in the error is, where there is an estimate: what its neighbours do not say of the difference
    /// of the two solutions that the estimate compares, or by how much what the data do between the nodes changes u.
    pub indicator: Option<Vec<f64>>,
    /// What the stencil and the row of the node look like, where the plan asks for it.
    pub diagnosis: Option<Vec<NodeDiagnosis>>,
}

/// Fields at the particles of a scene in free space, read back from the mesh by the weights that their strengths were deposited with.
#[derive(Debug, Clone, PartialEq)]
pub struct ParticleField {
    /// 1, 2 or 3.
    pub dimension: usize,
    /// Coordinates; those beyond the dimension are zero.
    pub positions: Vec<[f64; 3]>,
    /// What each carries.
    pub strengths: Vec<f64>,
    /// The solution, what a particle does to itself included.
    pub u: Vec<f64>,
    /// Its gradient, where the scene asks for it.
    pub gradient: Option<Vec<[f64; 3]>>,
    /// The velocity, where the scene has a vorticity.
    pub velocity: Option<Vec<[f64; 3]>>,
}

impl NodalField {
    pub(crate) fn new<const D: usize>(
        discrete: &Discrete<D>,
        u: &[f64],
        gradient: Option<Vec<[f64; D]>>,
        exact: Option<Vec<f64>>,
        kinds: &[RowKind],
        diagnosis: Option<Vec<NodeDiagnosis>>,
    ) -> Self {
        Self {
            dimension: D,
            points: discrete.cloud.points().iter().map(padded).collect(),
            spacing: discrete.cloud.spacing().to_vec(),
            u: u.to_vec(),
            gradient: gradient.map(|g| g.iter().map(padded).collect()),
            velocity: None,
            exact,
            estimate: None,
            indicator: None,
            eta: discrete.eta.clone(),
            region: discrete.labels.clone(),
            kind: kinds.to_vec(),
            diagnosis,
        }
    }
}

pub(crate) fn padded<const D: usize>(x: &[f64; D]) -> [f64; 3] {
    let mut padded = [0.0; 3];
    padded[..D].copy_from_slice(x);
    padded
}
