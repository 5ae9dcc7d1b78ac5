//! Vertices of interfaces and boundaries in the plane, and edges in space, where solutions are singular: `u ~ r^lambda`.
//!
//! Where straight edges or circles meet, the local solutions are known in closed form (`docs/corners.md`). [`corners()`] finds the vertices or edges of a
//! problem and says which of them have a solution that is no polynomial on every side; the sharp method uses the functions there in
//! place of polynomials.

mod local;
mod rims;
mod solution;
mod straightening;
mod wedge;

use meshless_geometry::{Domain, FaceId, Frame, PlanarPiece, PlanarPieces, RegionMap};

use local::KnownWedges;
pub(crate) use local::Local;
pub use local::Obstacle;
pub(crate) use rims::rims;
pub(crate) use solution::{LocalSolution, Monomial, Scales, value_and_gradient};

use crate::{BoundaryData, Condition, InterfaceLaw, Material, Problem};

/// Samples on a spacing of the boundary, between which its conditions change once at most.
const SAMPLES: f64 = 4.0;

/// Samples on one piece at least and at most.
const LEAST_SAMPLES: usize = 16;
const MOST_SAMPLES: usize = 20_000;

/// How often the way to where conditions change is halved.
const HALVINGS: usize = 60;

/// Two neighbouring differences of data that are as large as a jump's by more than this do not belong to one.
const ABRUPT: f64 = 3.0;

/// Part of the largest value on a piece below which a change within rounding of a point is no jump.
const LEAST_JUMP: f64 = 1e-6;

/// A vertex at which the solution is no polynomial, or in space an edge.
#[derive(Debug, Clone, PartialEq)]
pub struct Corner {
    /// Where; a point of it, of an edge.
    pub at: Vec<f64>,
    /// The smallest power of the distance that a solution has there and polynomials have not; 0 where two prescribed values meet.
    pub exponent: f64,
    /// How far away the next one is, or where else the solution is another one.
    pub clear: f64,
    /// Why corner functions do not serve it; `None` where they do.
    pub obstacle: Option<Obstacle>,
    /// Points along an edge in space, straight on from one to the next; none of a vertex in the plane.
    pub line: Vec<Vec<f64>>,
    /// Where such an edge ends in a vertex: near that its functions are not those of the solution, and nothing serves it.
    pub tips: Vec<Vec<f64>>,
}

/// What corners depend on: a problem before it has a cloud.
#[derive(Clone, Copy)]
pub struct CornerData<'a, const D: usize> {
    /// The domain.
    pub domain: &'a Domain<D>,
    /// The shapes of the regions.
    pub regions: &'a RegionMap<D>,
    /// Data of every region.
    pub materials: &'a [Material<D>],
    /// The boundary conditions.
    pub boundary: &'a dyn BoundaryData<D>,
    /// Laws of the interfaces at which something jumps.
    pub laws: &'a [InterfaceLaw<D>],
    /// A length on which conditions change once at most.
    pub spacing: f64,
}

impl<const D: usize> std::fmt::Debug for CornerData<'_, D> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("CornerData").field("regions", &self.materials.len()).finish_non_exhaustive()
    }
}

impl<'a, const D: usize> From<&Problem<'a, D>> for CornerData<'a, D> {
    fn from(problem: &Problem<'a, D>) -> Self {
        let Problem { domain, regions, materials, boundary, laws, .. } = *problem;
        let spacing = problem.cloud.spacing().iter().fold(f64::INFINITY, |a, &b| a.min(b));
        Self { domain, regions, materials, boundary, laws, spacing }
    }
}

/// The local problems at all vertices of the plane, or at all straight edges in space, with exponents up to a degree.
pub(crate) fn local_problems<const D: usize>(data: &CornerData<'_, D>, degree: f64) -> Vec<Local> {
    let mut known = KnownWedges::new(degree);
    match D {
        2 => {
            let pieces = PlanarPieces::new(data.domain, data.regions);
            let vertices = pieces.vertices(&breaks(data, &pieces));
            let frame = Frame::COORDINATES;
            vertices.iter().flat_map(|vertex| Local::all(data, (&frame, vertex), &mut known)).collect()
        }
        3 => {
            let edges = meshless_geometry::edges(data.domain, data.regions);
            edges.iter().flat_map(|edge| Local::across(data, edge, &mut known)).collect()
        }
        _ => Vec::new(),
    }
}

/// The vertices at which the solution has a power of the distance below `order` that is no polynomial. With a method that has no
/// functions for them, all of them are obstacles to its order.
pub fn corners<const D: usize>(data: &CornerData<'_, D>, order: usize) -> Vec<Corner> {
    let corner = |local: &Local| {
        let exponent = broken_power(data, local, order)?;
        let obstacle = Some(local.obstacle.unwrap_or(Obstacle::Method));
        Some(local.corner(exponent, obstacle))
    };
    let mut all: Vec<Corner> = local_problems(data, order as f64).iter().filter_map(corner).collect();
    all.extend(rims(data, order));
    all
}

/// The smallest power below `order` that is no polynomial on every side of a vertex, for the source right at the vertex.
pub(crate) fn broken_power<const D: usize>(
    data: &CornerData<'_, D>,
    local: &Local,
    order: usize,
) -> Option<f64> {
    let exponent = local.broken_exponent();
    if local.obstacle == Some(Obstacle::VariesAlong) {
        // What u does along the edge is a source across it that is not known.
        return exponent.filter(|power| *power < order as f64);
    }
    let solution = local.solve(data, &mut Scales::plain(data, local), order).ok();
    let power = match &solution {
        Some(solution) => local.broken_by(solution),
        None => exponent,
    };
    power.filter(|power| *power < order as f64)
}

/// The condition on the face of the boundary that a point is nearest to, within a distance.
fn condition_at<const D: usize>(data: &CornerData<'_, D>, x: &[f64; D], step: f64) -> Option<Condition> {
    let faces = (0..data.domain.faces().len() as u16).map(FaceId);
    let feet = faces.filter_map(|face| {
        let foot = data.domain.project_to_face(face, x).ok().filter(|foot| foot.distance.abs() < step)?;
        data.boundary.condition(face, &foot.point).map(|condition| (foot.distance.abs(), condition))
    });
    feet.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, condition)| condition)
}

/// The points of the boundary where conditions change their kind or their values jump, inside of smooth pieces.
fn breaks<const D: usize>(problem: &CornerData<'_, D>, pieces: &PlanarPieces) -> Vec<[f64; 2]> {
    let mut found = Vec::new();
    for piece in pieces.pieces() {
        let Some(face) = piece.face else { continue };
        let count = (SAMPLES * piece.length() / problem.spacing).ceil() as usize;
        let count = count.clamp(LEAST_SAMPLES, MOST_SAMPLES);
        // Ends belong to vertices anyhow, and data at them to either side.
        let place = |k: usize| (k as f64 + 0.5) / count as f64;
        let data: Vec<Datum> = (0..count).map(|k| Datum::at(problem, face, piece, place(k))).collect();
        let largest = data.iter().fold(0.0_f64, |m, d| m.max(d.value.abs()));
        let step =
            |k: usize| data.get(k + 1).zip(data.get(k)).map_or(0.0, |(b, a)| (b.value - a.value).abs());
        for k in 0..count - 1 {
            let changes = data[k].kind != data[k + 1].kind;
            let beside = if k > 0 { step(k - 1) } else { 0.0 }.max(step(k + 1));
            if !changes && step(k) <= ABRUPT * beside + LEAST_JUMP * largest {
                continue;
            }
            let (mut low, mut high) = ((place(k), data[k]), (place(k + 1), data[k + 1]));
            for _ in 0..HALVINGS {
                let t = 0.5 * (low.0 + high.0);
                let datum = Datum::at(problem, face, piece, t);
                let nearer = if changes {
                    datum.kind == low.1.kind
                } else {
                    (datum.value - low.1.value).abs() < (datum.value - high.1.value).abs()
                };
                *(if nearer { &mut low } else { &mut high }) = (t, datum);
            }
            if changes || (low.1.value - high.1.value).abs() > LEAST_JUMP * largest {
                found.push(piece.at(0.5 * (low.0 + high.0)));
            }
        }
    }
    found
}

/// A condition as a kind and a number.
#[derive(Clone, Copy)]
struct Datum {
    kind: u8,
    value: f64,
}

impl Datum {
    fn at<const D: usize>(problem: &CornerData<'_, D>, face: FaceId, piece: &PlanarPiece, t: f64) -> Self {
        let (kind, value) =
            match problem.boundary.condition(face, &Frame::COORDINATES.place(piece.at(t), 0.0)) {
                None => (0, 0.0),
                Some(Condition::Dirichlet(value)) => (1, value),
                Some(Condition::Neumann(value)) => (2, value),
                Some(Condition::Flux(value)) => (3, value),
                Some(Condition::Robin { a, b, g }) => (if a == 0.0 { 3 } else { 4 }, g / b),
            };
        Self { kind, value }
    }
}
