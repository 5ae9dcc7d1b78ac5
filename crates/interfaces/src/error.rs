//! Errors of the discretisations.

use std::fmt;

use meshless_cells::CellError;
use meshless_sparse::SolveError;
use meshless_stencils::StencilError;
use thiserror::Error;

/// A region in an error.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum RegionName {
    /// Its place in the list, from 0.
    Place(u16),
    /// Its name, where whoever made the list has put it in; see [`MethodError::named`].
    Name(String),
}

impl fmt::Display for RegionName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Place(place) => write!(f, "{place} (from 0)"),
            Self::Name(name) => write!(f, "\"{name}\""),
        }
    }
}

/// Why a problem could not be discretised or solved.
#[derive(Debug, Error)]
pub enum MethodError {
    /// A local fit cannot reproduce the operator even on an enlarged support.
    #[error(
        "no stencil at node {node} (near {position:?}): {source}; use a smaller spacing or a larger support there"
    )]
    Stencil {
        /// The node.
        node: usize,
        /// Its coordinates.
        position: Vec<f64>,
        /// What the fit said.
        source: StencilError,
    },
    /// The nodes near an interface do not determine the polynomials of its sides.
    #[error(
        "the {nodes} nodes round node {node} (near {position:?}) do not determine the value there: the gap or layer that it \
         lies in is too thin for the fit; take a spacing of about {spacing:.2e} there, or a lower order"
    )]
    Unresolved {
        /// The node.
        node: usize,
        /// Its coordinates.
        position: Vec<f64>,
        /// Nodes of the largest stencil that was tried.
        nodes: usize,
        /// A spacing that resolves the gap or layer.
        spacing: f64,
    },
    /// A layer, a gap or an inclusion that the nodes do not resolve.
    #[error(
        "region {region} is {thickness:.2e} thin near {position:?}, too thin for fits on nodes this far apart; take a spacing \
         of about {spacing:.2e} there, or gfdm-hybrid"
    )]
    ThinLayer {
        /// The region.
        region: RegionName,
        /// The middle of it there.
        position: Vec<f64>,
        /// How thin it is.
        thickness: f64,
        /// A spacing that resolves it.
        spacing: f64,
    },
    /// Rows of a method in time that let something grow.
    #[error(
        "since t = {since} something grows by itself, {growth:.1e}-fold by t = {t} and most near {position:?}: on this cloud the rows have a \
         mode that grows where diffusion lets all decay; take gfdm-conservative or gfdm-hybrid, or another cloud (`seed`, `layout`, \
         `spacing` in [points])"
    )]
    Grows {
        /// When it was found.
        t: f64,
        /// When it began.
        since: f64,
        /// Size over that at the beginning.
        growth: f64,
        /// Where it is largest.
        position: Vec<f64>,
    },
    /// A Voronoi cell could not be closed.
    #[error("no Voronoi cell at node {node} (near {position:?}): {source}")]
    Cell {
        /// The node.
        node: usize,
        /// Its coordinates.
        position: Vec<f64>,
        /// What the clipping said.
        source: CellError,
    },
    /// A phase field that has lost a region: nodes of it have come to lie in another one.
    #[error(
        "interfaces cannot be found from labels: region {region} is too thin near {position:?}; it must be about two \
         nodes thick. Give more points, or the shapes of the regions"
    )]
    LostRegion {
        /// The region.
        region: u16,
        /// A node of it.
        position: Vec<f64>,
    },
    /// A boundary node or a piece of boundary without a condition.
    #[error("no boundary condition at node {node} (near {position:?})")]
    NoCondition {
        /// The node.
        node: usize,
        /// Its coordinates.
        position: Vec<f64>,
    },
    /// A Robin condition `a u + b eta du/dn = g` with `b = 0`.
    #[error("the Robin condition at node {node} has b = 0 (near {position:?}); prescribe u instead")]
    RobinWithoutFlux {
        /// The node.
        node: usize,
        /// Its coordinates.
        position: Vec<f64>,
    },
    /// No interface of a region near a node of another one, where its field was to be continued.
    #[error(
        "no interface of region {region} near node {node} (near {position:?}), where its field is to be continued; where \
         three regions meet, or layers are thinner than the spacing, use gfdm-hybrid"
    )]
    NoFoot {
        /// The node.
        node: usize,
        /// Its coordinates.
        position: Vec<f64>,
        /// The region.
        region: RegionName,
    },
    /// Parts of the problem that do not fit together, or a diffusivity or source that is no number to compute with.
    #[error("the problem is not sound: {what}")]
    InvalidProblem {
        /// What does not fit, and where.
        what: String,
    },
    /// A method was asked for something that it does not do.
    #[error("{method} cannot {what}; {instead}")]
    Unsupported {
        /// The method.
        method: &'static str,
        /// What was asked.
        what: &'static str,
        /// What to use.
        instead: &'static str,
    },
    /// No condition fixes the constant of u, and sources and fluxes do not balance.
    #[error(
        "only fluxes are prescribed on the boundary, so sources and boundary fluxes must balance, but {defect:.2e} of \
         them is left over; prescribe u somewhere, or correct the source or the fluxes"
    )]
    Incompatible {
        /// The part of sources and fluxes that is left over, relative to their size.
        defect: f64,
    },
    /// Neighbour lists for cells or samples.
    #[error("neighbour lists: {0}")]
    Neighbors(#[from] meshless_neighbors::NeighborError),
    /// The region graph.
    #[error("regions: {0}")]
    Geometry(#[from] meshless_geometry::GeometryError),
    /// The rows of the method are no matrix.
    #[error("matrix: {0}")]
    Matrix(#[from] meshless_sparse::MatrixError),
    /// The linear system could not be solved.
    #[error(transparent)]
    Solve(#[from] SolveError),
}

impl MethodError {
    /// The same with the name of its region, where there is one and its place in the list is all that is known of it.
    #[must_use]
    pub fn named(mut self, name: impl Fn(u16) -> Option<String>) -> Self {
        if let Self::ThinLayer { region, .. } | Self::NoFoot { region, .. } = &mut self
            && let RegionName::Place(place) = *region
            && let Some(name) = name(place)
        {
            *region = RegionName::Name(name);
        }
        self
    }

    pub(crate) fn stencil<const D: usize>(node: usize, x: &[f64; D], source: StencilError) -> Self {
        Self::Stencil { node, position: x.to_vec(), source }
    }

    pub(crate) fn cell<const D: usize>(node: usize, x: &[f64; D], source: CellError) -> Self {
        Self::Cell { node, position: x.to_vec(), source }
    }
}
