//! Vertices of interfaces and boundaries in the plane, where solutions are singular: `u ~ r^lambda`.
//!
//! Where straight edges meet, the local solutions are known in closed form (`docs/corners.md`). [`corners`] finds the vertices of a
//! problem and says which of them have a solution that is no polynomial on every side; the sharp method uses the functions there in
//! place of polynomials.

mod local;
mod wedge;

use meshless_geometry::{FaceId, PlanarPiece, PlanarPieces};

pub use local::Obstacle;
pub(crate) use local::{Local, LocalSolution, Monomial, Scales, in_space};

use crate::{Condition, Problem};

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

/// A vertex at which the solution is no polynomial.
#[derive(Debug, Clone, PartialEq)]
pub struct Corner {
    /// Where.
    pub at: Vec<f64>,
    /// The smallest power of the distance that a solution has there and polynomials have not; 0 where two prescribed values meet.
    pub exponent: f64,
    /// Why corner functions do not serve it; `None` where they do.
    pub obstacle: Option<Obstacle>,
}

/// The local problems at all vertices of the plane, with exponents up to a degree.
pub(crate) fn local_problems<const D: usize>(problem: &Problem<'_, D>, degree: f64) -> Vec<Local> {
    let pieces = PlanarPieces::new(problem.domain, problem.regions);
    let vertices = pieces.vertices(&breaks(problem, &pieces));
    vertices.iter().flat_map(|vertex| Local::all(problem, vertex, degree)).collect()
}

/// The vertices at which the solution has a power of the distance below `order` that is no polynomial. With a method that has no
/// functions for them, all of them are obstacles to its order.
pub fn corners<const D: usize>(problem: &Problem<'_, D>, order: usize) -> Vec<Corner> {
    let broken = |local: &Local| Some((local.at, broken_power(problem, local, order)?));
    let all = local_problems(problem, order as f64);
    all.iter()
        .filter_map(broken)
        .map(|(at, exponent)| Corner { at: at.to_vec(), exponent, obstacle: Some(Obstacle::Method) })
        .collect()
}

/// The smallest power below `order` that is no polynomial on every side of a vertex, as far as data of degree 0 tell.
pub(crate) fn broken_power<const D: usize>(problem: &Problem<'_, D>, local: &Local, order: usize) -> Option<f64> {
    let exponent = local.broken_exponent();
    let scales = Scales::plain(problem, local);
    let solution = local.solve(problem, &scales, 0).ok();
    let power = match &solution {
        Some(solution) => solution.broken_power(exponent),
        None => exponent,
    };
    power.filter(|power| *power < order as f64)
}

/// The points of the boundary where conditions change their kind or their values jump, inside of smooth pieces.
fn breaks<const D: usize>(problem: &Problem<'_, D>, pieces: &PlanarPieces) -> Vec<[f64; 2]> {
    let spacing = problem.cloud.spacing().iter().fold(f64::INFINITY, |a, &b| a.min(b));
    let mut found = Vec::new();
    for piece in pieces.pieces() {
        let Some(face) = piece.face else { continue };
        let count = (SAMPLES * piece.length() / spacing).ceil() as usize;
        let count = count.clamp(LEAST_SAMPLES, MOST_SAMPLES);
        // Ends belong to vertices anyhow, and data at them to either side.
        let place = |k: usize| (k as f64 + 0.5) / count as f64;
        let data: Vec<Datum> = (0..count).map(|k| Datum::at(problem, face, piece, place(k))).collect();
        let largest = data.iter().fold(0.0_f64, |m, d| m.max(d.value.abs()));
        let step = |k: usize| data.get(k + 1).zip(data.get(k)).map_or(0.0, |(b, a)| (b.value - a.value).abs());
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
    fn at<const D: usize>(problem: &Problem<'_, D>, face: FaceId, piece: &PlanarPiece, t: f64) -> Self {
        let (kind, value) = match problem.boundary.condition(face, &in_space(piece.at(t))) {
            None => (0, 0.0),
            Some(Condition::Dirichlet(value)) => (1, value),
            Some(Condition::Neumann(value)) => (2, value),
            Some(Condition::Flux(value)) => (3, value),
            Some(Condition::Robin { a, b, g }) => (if a == 0.0 { 3 } else { 4 }, g / b),
        };
        Self { kind, value }
    }
}
