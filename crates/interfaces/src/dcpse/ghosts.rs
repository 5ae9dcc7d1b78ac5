//! Which ghosts there are, and where to find them.

use meshless_stencils::StencilError;

use super::constrained::{ConstrainedGhosts, Ghost, GhostScratch};
use super::foot::{Foot, foot};
use super::image::ImageGhosts;
use super::params::{Ghosts, ImmersedParams};
use crate::method::RowKind;
use crate::operator_rows::OperatorRows;
use crate::parallel;
use crate::{MethodError, Problem, RegionName};

/// Degree of the fits on the boundary where ghosts are made by image points.
const BOUNDARY_DEGREE: usize = 2;

/// Makes values beyond an interface.
pub(super) trait GhostMaker<const D: usize>: Sync {
    /// The field of region `own` at node q of region `other`, beyond the interface between them, whose foot is given.
    fn across(
        &self,
        q: usize,
        foot: &Foot<D>,
        regions: [u16; 2],
        scratch: &mut GhostScratch,
    ) -> Result<Ghost, StencilError>;
}

/// Whether node j may take part in the operator at node i: a node of the same region beyond another region may not, and
/// neither may its value be continued, since the nearest interface there is another one.
pub(super) fn sees<const D: usize>(problem: &Problem<'_, D>, i: usize, j: usize) -> bool {
    let labels = problem.labels;
    if labels[i] != labels[j] || problem.materials.len() == 1 {
        return true;
    }
    // Only near another region can there be one in between.
    if problem.supports.lists.of(i).iter().all(|&k| labels[k as usize] == labels[i]) {
        return true;
    }
    let (a, b) = (&problem.cloud.points()[i], &problem.cloud.points()[j]);
    let middle: [f64; D] = std::array::from_fn(|k| 0.5 * (a[k] + b[k]));
    problem.regions.label(&middle, problem.cloud.spacing()[i]) == labels[i]
}

/// All ghosts of a discretisation.
pub(super) struct GhostTable {
    /// Node and region whose field is continued there, in order.
    keys: Vec<(u32, u16)>,
    ghosts: Vec<Ghost>,
    /// Boundary nodes whose value follows from a condition on the flux, in order.
    boundary: Vec<(u32, Ghost)>,
    /// Nodes whose row uses a ghost.
    rows: Vec<u32>,
}

impl GhostTable {
    /// Makes all ghosts that the operators ask for, in parallel.
    pub(super) fn build<const D: usize>(
        problem: &Problem<'_, D>,
        params: &ImmersedParams,
        kinds: &[RowKind],
        operators: &OperatorRows,
    ) -> Result<Self, MethodError> {
        let (keys, rows) = keys(problem, kinds, operators);
        let degree = match params.ghosts {
            Ghosts::Constrained { degree } => degree,
            // Nodes lie on the boundary: there is nothing beyond it to be mirrored.
            Ghosts::Image(_) => BOUNDARY_DEGREE,
        };
        let fits = ConstrainedGhosts::new(problem, degree, params.unsteady)?;
        let images = match params.ghosts {
            Ghosts::Constrained { .. } => None,
            Ghosts::Image(interpolation) => Some(ImageGhosts::new(problem, interpolation)?),
        };
        let maker: &dyn GhostMaker<D> = match &images {
            Some(images) => images,
            None => &fits,
        };
        let ghosts = parallel::try_map_with(keys.len(), GhostScratch::default, |scratch, k| {
            across(problem, maker, keys[k].0 as usize, keys[k].1, scratch)
        })?;
        let boundary = on_boundary(problem, &fits, kinds)?;
        Ok(Self { keys, ghosts, boundary, rows })
    }

    /// The field of region `own` at node q, which is of another region.
    pub(super) fn across(&self, q: u32, own: u16) -> Option<&Ghost> {
        self.keys.binary_search(&(q, own)).ok().map(|place| &self.ghosts[place])
    }

    /// The value at a boundary node.
    pub(super) fn on_boundary(&self, b: usize) -> Option<&Ghost> {
        self.boundary.binary_search_by_key(&(b as u32), |(node, _)| *node).ok().map(|k| &self.boundary[k].1)
    }

    /// Number of ghosts.
    pub(super) fn len(&self) -> usize {
        self.ghosts.len()
    }

    /// Nodes whose row uses a ghost.
    pub(super) fn rows(&self) -> &[u32] {
        &self.rows
    }
}

/// The ghosts that are needed, and the nodes whose rows need one.
fn keys<const D: usize>(
    problem: &Problem<'_, D>,
    kinds: &[RowKind],
    operators: &OperatorRows,
) -> (Vec<(u32, u16)>, Vec<u32>) {
    let labels = problem.labels;
    let (mut keys, mut rows) = (Vec::new(), Vec::new());
    for i in (0..kinds.len()).filter(|&i| kinds[i] == RowKind::Strong) {
        let before = keys.len();
        let (neighbors, coefficients) = operators.row(problem, i);
        let others = neighbors
            .iter()
            .zip(coefficients)
            .filter(|(j, c)| **c != 0.0 && labels[**j as usize] != labels[i]);
        keys.extend(others.map(|(&j, _)| (j, labels[i])));
        if keys.len() > before {
            rows.push(i as u32);
        }
    }
    keys.sort_unstable();
    keys.dedup();
    (keys, rows)
}

fn across<const D: usize>(
    problem: &Problem<'_, D>,
    maker: &dyn GhostMaker<D>,
    q: usize,
    own: u16,
    scratch: &mut GhostScratch,
) -> Result<Ghost, MethodError> {
    let x = &problem.cloud.points()[q];
    let Some((foot, other)) = foot(problem, q, own) else {
        return Err(MethodError::NoFoot { node: q, position: x.to_vec(), region: RegionName::Place(own) });
    };
    maker.across(q, &foot, [own, other], scratch).map_err(|source| MethodError::stencil(q, x, source))
}

/// The values at the boundary nodes that no value is prescribed at, in order.
pub(super) fn on_boundary<const D: usize>(
    problem: &Problem<'_, D>,
    maker: &ConstrainedGhosts<'_, D>,
    kinds: &[RowKind],
) -> Result<Vec<(u32, Ghost)>, MethodError> {
    let nodes = problem.cloud.boundary();
    let collocated = |&index: &usize| kinds[nodes[index].node as usize] == RowKind::StrongBoundary;
    let places: Vec<usize> = (0..nodes.len()).filter(collocated).collect();
    parallel::try_map_with(places.len(), GhostScratch::default, |scratch, k| {
        Ok((nodes[places[k]].node, boundary_value(problem, maker, places[k], scratch)?))
    })
}

fn boundary_value<const D: usize>(
    problem: &Problem<'_, D>,
    maker: &ConstrainedGhosts<'_, D>,
    index: usize,
    scratch: &mut GhostScratch,
) -> Result<Ghost, MethodError> {
    let node = &problem.cloud.boundary()[index];
    let b = node.node as usize;
    let x = &problem.cloud.points()[b];
    let mut conditions = Vec::with_capacity(node.touches.len());
    for (touch, condition) in node.touches.iter().zip(&problem.conditions[index]) {
        let (a, g) = condition
            .as_flux(problem.eta[b])
            .ok_or_else(|| MethodError::RobinWithoutFlux { node: b, position: x.to_vec() })?;
        conditions.push((touch.normal, a, g));
    }
    maker.on_boundary(b, &conditions, scratch).map_err(|source| MethodError::stencil(b, x, source))
}
