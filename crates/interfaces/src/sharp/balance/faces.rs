//! Cells by region: of every region the Voronoi cells of its own nodes, of which the parts in the region count.
//!
//! Interfaces and boundaries are cut where the nearest node on either side changes, so that every piece is a face of one cell, or of
//! two. A cell is used only if its faces close it: what a cell misses of its surface, its balance would miss of the flux.

use meshless_cells::{Cell, CellError, CellScratch, Container, box_planes, voronoi_cell};
use meshless_geometry::FaceId;
use meshless_neighbors::CellList;

use super::{plane, space};
use crate::sharp::maker::Maker;
use crate::{MethodError, Problem};

/// Half the width of the box that a cell is looked for in, in spacings: no part of a region is farther from its nearest node.
const HALF_WIDTH: f64 = 2.5;

/// Radius within which a cell is looked for first, in spacings.
const NEARBY: f64 = 3.0;

/// How much farther than round-off would have it nodes are searched for.
const SEARCH_MARGIN: f64 = 1.01;

/// How far beside an interface it is asked what is there, in spacings: beyond round-off of coordinates, and far less than a cell has
/// to be closed by.
pub(super) const BESIDE: f64 = 1e-12;

/// What may be missing of the surface of a cell, over its size.
const CLOSED: f64 = 1e-5;

/// Distance of a point of an interface from the nearest one that is sampled on it, in spacings, at most.
pub(super) const FARTHEST_POINT: f64 = 1.5;

/// What a face is between.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Beyond {
    /// Another node: of the same region, or across an interface.
    Node(u32),
    /// A face of the domain.
    Boundary(FaceId),
}

/// A point of a face: where, and the normal out of the first node's cell, times the weight.
#[derive(Debug, Clone, Copy)]
pub(super) struct FacePoint<const D: usize> {
    pub(super) at: [f64; D],
    pub(super) normal: [f64; D],
    pub(super) weight: f64,
}

/// A face of a cell.
#[derive(Debug, Clone)]
pub(super) struct Face<const D: usize> {
    pub(super) node: u32,
    pub(super) beyond: Beyond,
    pub(super) middle: [f64; D],
    pub(super) area: f64,
    pub(super) points: Vec<FacePoint<D>>,
}

/// The faces of all cells that could be made.
#[derive(Debug)]
pub(super) struct Faces<const D: usize> {
    /// Each face once.
    pub(super) all: Vec<Face<D>>,
    /// Faces of every node: their places, and whether it is the first node of the face. None where there is no closed cell.
    pub(super) of_node: Vec<Vec<(usize, bool)>>,
}

/// The nodes of one region, and their numbers.
pub(super) struct OfRegion<const N: usize> {
    pub(super) places: Vec<[f64; N]>,
    pub(super) nodes: Vec<u32>,
}

impl<const N: usize> OfRegion<N> {
    /// Those of all regions.
    pub(super) fn all<const D: usize>(
        problem: &Problem<'_, D>,
        place: impl Fn(&[f64; D]) -> [f64; N],
    ) -> Vec<Self> {
        let points = problem.cloud.points();
        let of = |label: usize| {
            let all = 0..points.len() as u32;
            let nodes: Vec<u32> = all.filter(|&j| problem.labels[j as usize] as usize == label).collect();
            Self { places: nodes.iter().map(|&j| place(&points[j as usize])).collect(), nodes }
        };
        (0..problem.regions.len()).map(of).collect()
    }

    pub(super) fn lists<'a, const D: usize>(
        all: &'a [Self],
        problem: &Problem<'_, D>,
    ) -> Result<Vec<CellList<'a, N>>, MethodError> {
        let widest = problem.cloud.spacing().iter().fold(0.0_f64, |a, &b| a.max(b));
        all.iter().map(|region| Ok(CellList::new(&region.places, 3.0 * widest)?)).collect()
    }
}

/// The Voronoi cell of a node among those of its region, within a box about it and the bounds of the domain; `place` gives a point the
/// dimension that cells are made in. `None` where the node is not in the region that it is said to be of, and where there is no cell.
pub(super) fn cell_of<const D: usize, const N: usize>(
    (problem, i): (&Problem<'_, D>, usize),
    (region, list): (&OfRegion<N>, &CellList<'_, N>),
    place: impl Fn(&[f64; D]) -> [f64; N],
    scratch: &mut CellScratch,
) -> Option<Cell<N>> {
    let (at, spacing) = (&problem.cloud.points()[i], problem.cloud.spacing()[i]);
    if problem.regions.label(at, spacing) != problem.labels[i] {
        return None;
    }
    let (x, bounds, reach) = (place(at), problem.domain.bounds(), HALF_WIDTH * spacing);
    let (least, most) = (place(&bounds.min), place(&bounds.max));
    let min: [f64; N] = std::array::from_fn(|k| least[k].max(x[k] - reach));
    let max: [f64; N] = std::array::from_fn(|k| most[k].min(x[k] + reach));
    let planes = box_planes(&min, &max);
    let container = Container { min, max, planes: &planes, cuts: &[], walls: None };
    let mut found = Vec::new();
    // Amid others of its region a cell is small; where there are none beyond, it reaches as far as the box.
    for radius in [NEARBY * spacing, 2.0 * reach * (N as f64).sqrt() * SEARCH_MARGIN] {
        found.clear();
        list.within(&x, radius, &mut found);
        let candidates: Vec<(u32, [f64; N])> = found
            .iter()
            .map(|&place| (region.nodes[place as usize], region.places[place as usize]))
            .filter(|(j, _)| *j as usize != i)
            .collect();
        match voronoi_cell(&x, &candidates, radius, &container, scratch) {
            Err(CellError::Incomplete { .. }) => {}
            other => return other.ok(),
        }
    }
    None
}

/// What the faces of all cells are put together from.
#[derive(Debug)]
pub(super) struct Pieces<const D: usize> {
    /// Of every node the faces with nodes of its own region; `None` where no cell is wanted or could be made.
    pub(super) cells: Vec<Option<Vec<Face<D>>>>,
    /// Faces on interfaces and boundaries.
    pub(super) surfaces: Vec<Face<D>>,
}

impl<const D: usize> Faces<D> {
    /// The cells of the nodes for which a balance is wanted.
    pub(super) fn find(maker: &Maker<'_, D>, wanted: &[bool]) -> Result<Self, MethodError> {
        let count = maker.problem.cloud.len();
        let mut faces = Self { all: Vec::new(), of_node: vec![Vec::new(); count] };
        let Pieces { cells, surfaces } = match D {
            2 => plane::pieces(maker, wanted)?,
            3 => space::pieces(maker, wanted)?,
            _ => return Ok(faces),
        };
        // Nodes whose faces close their cells.
        let mut sums: Vec<([f64; D], f64)> = vec![([0.0; D], 0.0); count];
        let mut add = |node: u32, sign: f64, face: &Face<D>| {
            let (vector, area) = &mut sums[node as usize];
            *area += face.area;
            for point in &face.points {
                (0..D).for_each(|k| vector[k] += sign * point.weight * point.normal[k]);
            }
        };
        for face in cells.iter().flatten().flatten() {
            add(face.node, 1.0, face);
        }
        for face in &surfaces {
            add(face.node, 1.0, face);
            if let Beyond::Node(other) = face.beyond {
                add(other, -1.0, face);
            }
        }
        let closed: Vec<bool> = (0..count)
            .map(|i| {
                let (vector, area) = &sums[i];
                let open = vector.iter().map(|x| x * x).sum::<f64>().sqrt();
                cells[i].is_some() && open <= CLOSED * area
            })
            .collect();
        let is_first = |face: &Face<D>| match face.beyond {
            Beyond::Node(other) => face.node < other || !closed[other as usize],
            Beyond::Boundary(_) => true,
        };
        let own = cells.into_iter().enumerate().filter(|(i, _)| closed[*i]).filter_map(|(_, cell)| cell);
        let own = own.flatten().filter(|face| is_first(face));
        let used = |face: &Face<D>| {
            closed[face.node as usize] || matches!(face.beyond, Beyond::Node(other) if closed[other as usize])
        };
        faces.all = own.chain(surfaces.into_iter().filter(used)).collect();
        for (place, face) in faces.all.iter().enumerate() {
            if closed[face.node as usize] {
                faces.of_node[face.node as usize].push((place, true));
            }
            if let Beyond::Node(other) = face.beyond
                && closed[other as usize]
            {
                faces.of_node[other as usize].push((place, false));
            }
        }
        Ok(faces)
    }
}
