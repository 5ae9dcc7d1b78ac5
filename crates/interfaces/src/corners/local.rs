//! A vertex, or what is across an edge in space, as a local problem: sectors, their materials, and what holds on the outer rays.

use std::f64::consts::TAU;

use meshless_geometry::{Edge, FaceId, Frame, Vertex};

use super::straightening::Straightening;
use super::wedge::{End, Sector, Wedge};
use super::{Corner, CornerData, condition_at};
use crate::Condition;
use crate::equation::between;

/// Where diffusivities and the kinds of conditions beside a vertex are read, over the length of its shortest ray.
const BESIDE: f64 = 1e-3;

/// Components of directions below this are rounding: on the plane `x = 0` a value x is zero.
const NO_COMPONENT: f64 = 1e-15;

/// How far from whole numbers an exponent may be for its function to count as a polynomial.
const WHOLE: f64 = 1e-7;

/// Angle, in radians, up to which a point belongs to the sector on the other side of a ray as well: rounding.
const ON_RAY: f64 = 1e-6;

/// Places along an edge, over half its length, and distances from it, over the clear one, at which data are compared; what they may
/// differ by as rounding.
const STATIONS: [f64; 3] = [0.0, -0.83, 0.71];
const DISTANCES: [f64; 3] = [0.07, 0.31, 0.73];
const SAME: f64 = 1e-9;

/// Difference of angles, in radians, up to which two wedges are the same: rounding of vertices.
const ALIKE: f64 = 1e-12;

/// Why corner functions do not serve a vertex.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Obstacle {
    /// An interface or a boundary that is curved there, and no arc of a circle, or arcs that no one map makes straight.
    Curved,
    /// The diffusivity varies in a region that meets there.
    Varies,
    /// A flux that depends on u, on a boundary that meets there.
    Exchange,
    /// Several parts of the domain touch there.
    Touching,
    /// Conditions that change their kind near it, or data that have no value.
    Data,
    /// In space: sources or data that are not the same all along an edge.
    VariesAlong,
    /// An interface with a resistance or partition coefficients that meets there.
    Contact,
    /// Nodes are too far apart for the sides that meet there.
    Spacing,
    /// The method has no corner functions.
    Method,
}

impl Obstacle {
    /// In words.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Curved => "what meets there is curved",
            Self::Varies => "the diffusivity varies there",
            Self::Exchange => "the flux through a boundary that meets there depends on u",
            Self::Touching => "several parts of the domain touch there",
            Self::Data => "the data there have no value, or change their kind",
            Self::VariesAlong => "the data change along the edge",
            Self::Contact => "u differs on both sides of an interface that meets there",
            Self::Spacing => "the sides that meet there are shorter than a few spacings",
            Self::Method => "the method has no corner functions there",
        }
    }
}

/// How an edge in space ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Tip {
    /// In a vertex.
    Vertex,
    /// At a plane of the boundary at right angles to it.
    Wall,
    /// At such a plane through which nothing flows: its functions are even there.
    Symmetry,
}

/// The extent of an edge in space along itself.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Along {
    half_length: f64,
    /// At the lower end, and at the upper one.
    tips: [Tip; 2],
}

/// A vertex in the plane, or what is across an edge in space, as a local problem.
#[derive(Debug, Clone)]
pub(crate) struct Local {
    /// The plane that it is in: that of the scene, or the one at right angles to an edge through its middle.
    pub(crate) frame: Frame,
    /// How far an edge extends along itself; `None` for a vertex in the plane.
    pub(crate) along: Option<Along>,
    /// Where in the plane.
    pub(crate) at: [f64; 2],
    /// Angle of the first ray.
    start: f64,
    /// What makes its rays straight. Distances and angles in the wedge are those after it.
    pub(super) straightening: Straightening,
    /// The sectors, with scale 1.
    pub(crate) wedge: Wedge,
    /// Regions of the sectors.
    pub(crate) labels: Vec<u16>,
    /// Faces of the outer rays.
    pub(super) faces: Vec<FaceId>,
    /// Distance within which there is nothing else.
    pub(crate) clear: f64,
    /// What prevents the corner functions from being exact.
    pub(crate) obstacle: Option<Obstacle>,
    /// Exponents and how many functions each has, up to the degree asked for.
    pub(crate) exponents: Vec<(f64, usize)>,
}

impl Local {
    /// A point of the plane.
    pub(crate) fn in_space<const D: usize>(&self, x: [f64; 2]) -> [f64; D] {
        self.frame.place(x, 0.0)
    }

    /// Coordinates in the plane, and along an edge from its middle.
    pub(crate) fn coordinates<const D: usize>(&self, x: &[f64; D]) -> ([f64; 2], f64) {
        self.frame.coordinates(x)
    }

    /// Distance of a point, from the line of an edge where that is beside it, else from its nearer end.
    pub(crate) fn distance<const D: usize>(&self, x: &[f64; D]) -> f64 {
        let (across, z) = self.coordinates(x);
        let r = (across[0] - self.at[0]).hypot(across[1] - self.at[1]);
        match self.along {
            Some(along) if z.abs() > along.half_length => r.hypot(z.abs() - along.half_length),
            _ => r,
        }
    }

    /// Length of an edge over the number of its ends that are none of symmetry; as long as can be without.
    pub(crate) fn length_an_end(&self) -> f64 {
        self.along.map_or(f64::INFINITY, |along| {
            let ends = along.tips.iter().filter(|tip| **tip != Tip::Symmetry).count();
            2.0 * along.half_length / ends as f64
        })
    }

    /// Whether the functions of an edge are those of the solution at a point as far as its ends are concerned: farther from a vertex than
    /// `blind`, which may be little, and farther from a wall than a stencil reaches.
    pub(crate) fn is_amid<const D: usize>(&self, x: &[f64; D], (blind, stencil): (f64, f64)) -> bool {
        self.along.is_none_or(|along| {
            let (_, z) = self.coordinates(x);
            let is_within = |(tip, sign): (&Tip, f64)| {
                let to_end = along.half_length + sign * z;
                match tip {
                    Tip::Vertex => to_end >= blind,
                    Tip::Wall => to_end >= stencil,
                    Tip::Symmetry => true,
                }
            };
            along.tips.iter().zip([1.0, -1.0]).all(is_within)
        })
    }

    /// Whether no ray of it is curved.
    pub(crate) fn is_straight(&self) -> bool {
        self.straightening.is_identity()
    }

    /// The entry of a report for it.
    pub(crate) fn corner(&self, exponent: f64, obstacle: Option<Obstacle>) -> Corner {
        let at = match self.along {
            None => self.at.to_vec(),
            Some(_) => self.in_space::<3>(self.at).to_vec(),
        };
        let clear = self.clear.min(self.length_an_end());
        let ends = self.along.map_or_else(Vec::new, |along| {
            let at = |z: f64| self.frame.place::<3>(self.at, z).to_vec();
            along.tips.into_iter().zip([at(-along.half_length), at(along.half_length)]).collect()
        });
        let line = ends.iter().map(|(_, at)| at.clone()).collect();
        let tips = ends.into_iter().filter(|(tip, _)| *tip != Tip::Symmetry).map(|(_, at)| at).collect();
        Corner { at, exponent, clear, obstacle, line, tips }
    }

    /// The local problems across an edge.
    pub(crate) fn across<const D: usize>(
        problem: &CornerData<'_, D>,
        edge: &Edge,
        known: &mut KnownWedges,
    ) -> Vec<Self> {
        let mut all = Self::all(problem, (&edge.frame, &edge.around), known);
        for local in &mut all {
            let tips = [0, 1].map(|end| match edge.at_wall[end] {
                false => Tip::Vertex,
                true if local.is_insulated(problem, [-1.0, 1.0][end] * edge.half_length) => Tip::Symmetry,
                true => Tip::Wall,
            });
            local.along = Some(Along { half_length: edge.half_length, tips });
            if local.obstacle.is_none() && local.varies_along(problem, edge.half_length) {
                local.obstacle = Some(Obstacle::VariesAlong);
            }
        }
        all
    }

    /// Whether nothing flows through the wall at which an edge ends.
    fn is_insulated<const D: usize>(&self, problem: &CornerData<'_, D>, end: f64) -> bool {
        DISTANCES.iter().map(|part| part * self.clear).all(|r| {
            (0..self.labels.len()).all(|k| {
                let x: [f64; D] = self.frame.place(self.inside(k, r), end);
                let condition = condition_at(problem, &x, ON_RAY * self.clear);
                condition.and_then(|c| c.as_flux(1.0)) == Some((0.0, 0.0))
            })
        })
    }

    /// Whether sources or data change along an edge of this half length.
    fn varies_along<const D: usize>(&self, problem: &CornerData<'_, D>, half_length: f64) -> bool {
        let sectors = self.wedge.sectors.len();
        let mut seen: Vec<Vec<f64>> = Vec::new();
        for z in STATIONS.map(|part| part * half_length) {
            let mut here = Vec::new();
            for r in DISTANCES.map(|part| part * self.clear) {
                for (k, label) in self.labels.iter().enumerate() {
                    let x: [f64; D] = self.frame.place(self.inside(k, r), z);
                    let source = problem.materials[*label as usize].source.as_ref();
                    here.push(source.map_or(0.0, |f| f.at(&x)));
                }
                for ray in 0..self.wedge.inner_rays() {
                    let x: [f64; D] = self.frame.place(self.on_ray(ray + 1, r), z);
                    let labels = [self.labels[ray], self.labels[(ray + 1) % sectors]];
                    let Some((jump, _)) = between(problem.laws, labels[0], labels[1]) else { continue };
                    here.extend([&jump.value, &jump.flux].map(|f| f.as_ref().map_or(0.0, |f| f.at(&x))));
                }
                for (face, ray) in self.faces.iter().zip([0, sectors]) {
                    let x: [f64; D] = self.frame.place(self.on_ray(ray, r), z);
                    here.extend(match problem.boundary.condition(*face, &x) {
                        Some(Condition::Dirichlet(value)) => [1.0, value, 0.0],
                        Some(other) => other.as_flux(1.0).map_or([3.0, 0.0, 0.0], |(a, flux)| [2.0, a, flux]),
                        None => [4.0, 0.0, 0.0],
                    });
                }
            }
            seen.push(here);
        }
        let differs = |other: &Vec<f64>| {
            let alike = |(a, b): (&f64, &f64)| (a - b).abs() <= SAME * a.abs().max(b.abs());
            other.len() != seen[0].len() || !other.iter().zip(&seen[0]).all(alike)
        };
        seen.iter().skip(1).any(differs)
    }

    /// Angle of the middle of a sector.
    pub(crate) fn middle(&self, sector: usize) -> f64 {
        let before: f64 = self.wedge.sectors[..sector].iter().map(|s| s.opening).sum();
        self.start + before + 0.5 * self.wedge.sectors[sector].opening
    }

    /// The point at a distance in the middle of a sector.
    pub(crate) fn inside(&self, sector: usize, distance: f64) -> [f64; 2] {
        let (sin, cos) = self.middle(sector).sin_cos();
        let [x, y] = self.straightening.back([cos, sin], distance);
        [self.at[0] + x, self.at[1] + y]
    }

    /// The gradient, in the plane, of what has this one at a point after the straightening.
    pub(crate) fn gradient(&self, x: &[f64; 2], gradient: [f64; 2]) -> [f64; 2] {
        self.straightening.gradient(self.relative(x), gradient)
    }

    /// Coordinates of a point from the vertex.
    pub(crate) fn relative(&self, x: &[f64; 2]) -> [f64; 2] {
        [x[0] - self.at[0], x[1] - self.at[1]]
    }

    /// The local problems at a vertex: one for every part of the domain that meets there.
    pub(crate) fn all<const D: usize>(
        problem: &CornerData<'_, D>,
        (frame, vertex): (&Frame, &Vertex),
        known: &mut KnownWedges,
    ) -> Vec<Self> {
        let count = vertex.rays.len();
        let outside: Vec<usize> = (0..count).filter(|&k| vertex.sectors[k].is_none()).collect();
        let firsts: Vec<usize> = match outside.len() {
            0 => vec![0],
            _ => outside.iter().map(|k| (k + 1) % count).filter(|&k| vertex.sectors[k].is_some()).collect(),
        };
        let touching = (firsts.len() > 1).then_some(Obstacle::Touching);
        let part = |&first: &usize| -> Vec<usize> {
            (0..count).map(|k| (first + k) % count).take_while(|&k| vertex.sectors[k].is_some()).collect()
        };
        let parts = firsts.iter().map(part).flat_map(|own| between_films(problem, vertex, own));
        let mut all: Vec<Self> = parts
            .filter_map(|(own, films)| Self::of_part(problem, (frame, vertex), (&own, films), known))
            .collect();
        all.iter_mut().for_each(|local| local.obstacle = local.obstacle.or(touching));
        all
    }

    fn of_part<const D: usize>(
        problem: &CornerData<'_, D>,
        (frame, vertex): (&Frame, &Vertex),
        (own, films): (&[usize], [bool; 2]),
        known: &mut KnownWedges,
    ) -> Option<Self> {
        let closed = own.len() == vertex.rays.len() && films == [false; 2];
        let mut obstacle = None;
        let mut note = |found: bool, what: Obstacle| {
            if found && obstacle.is_none() {
                obstacle = Some(what);
            }
        };
        let mut rays: Vec<usize> = own.to_vec();
        if !closed {
            rays.push((own[own.len() - 1] + 1) % vertex.rays.len());
        }
        let straightening = Straightening::of(rays.iter().map(|&k| &vertex.rays[k]));
        note(straightening.is_none(), Obstacle::Curved);
        let straightening = straightening.unwrap_or_default();
        let beside = BESIDE * vertex.clear;
        let labels: Vec<u16> = own.iter().filter_map(|&k| vertex.sectors[k]).collect();
        let start = vertex.rays[own[0]].angle;
        note(films != [false; 2], Obstacle::Contact);
        // With partition coefficients `u / K` goes on, and `eta K` conducts it.
        let (mut partition, mut before) = (1.0, None);
        let (mut sectors, mut turned) = (Vec::new(), start);
        for (&k, &label) in own.iter().zip(&labels) {
            let opening = vertex.opening(k);
            let (sin, cos) = (turned + 0.5 * opening).sin_cos();
            let x = frame.place([vertex.at[0] + beside * cos, vertex.at[1] + beside * sin], 0.0);
            let diffusivity = &problem.materials.get(label as usize)?.diffusivity;
            note(diffusivity.as_constant().is_none(), Obstacle::Varies);
            let eta = diffusivity.at(&x);
            if !(eta > 0.0 && eta.is_finite()) {
                return None;
            }
            if let Some((law, sign)) = before.and_then(|before| between(problem.laws, before, label))
                && law.partition[0] != law.partition[1]
            {
                note(true, Obstacle::Contact);
                partition *= (law.partition[1] / law.partition[0]).powf(sign);
            }
            before = Some(label);
            sectors.push(Sector { opening, eta: eta * partition, scale: 1.0 });
            turned += opening;
        }
        let outer = [rays[0], rays[rays.len() - 1]];
        // Films have no face, and their flux is of no lower power than others.
        let face = |(&k, film): (&usize, bool)| vertex.rays[k].face.or(film.then_some(FaceId(0)));
        let faces: Vec<FaceId> =
            if closed { Vec::new() } else { outer.iter().zip(films).filter_map(face).collect() };
        let mut ends = None;
        if !closed {
            let [first, last] = [faces.first()?, faces.get(1)?];
            let mut found = [End::Flux; 2];
            let rays = found.iter_mut().zip(outer.iter().zip([first, last])).zip(films);
            for ((end, (&ray, &face)), _) in rays.filter(|(_, film)| !film) {
                let x = frame.place(vertex.along(ray, beside), 0.0);
                match problem.boundary.condition(face, &x) {
                    Some(Condition::Dirichlet(_)) => *end = End::Dirichlet,
                    Some(Condition::Robin { a, .. }) => note(a != 0.0, Obstacle::Exchange),
                    Some(Condition::Neumann(_) | Condition::Flux(_)) => {}
                    None => note(true, Obstacle::Data),
                }
            }
            ends = Some(found);
        }
        let wedge = Wedge { sectors, ends };
        let exponents = known.exponents(&wedge);
        let (frame, along) = (*frame, None);
        Some(Self {
            frame,
            along,
            at: vertex.at,
            start,
            straightening,
            wedge,
            labels,
            faces,
            clear: vertex.clear.min(straightening.reach()),
            obstacle,
            exponents,
        })
    }

    /// The smallest exponent whose function is no polynomial in the sectors.
    pub(crate) fn broken_exponent(&self) -> Option<f64> {
        self.exponents.iter().map(|e| e.0).find(|power| (power - power.round()).abs() > WHOLE)
    }

    /// Sector, distance and angle from the sector's middle of a point; of a point on a ray, the sector of which `prefers` holds.
    pub(crate) fn place(&self, x: &[f64; 2], prefers: impl Fn(usize) -> bool) -> (usize, f64, f64) {
        let [dx, dy] = self.straightening.straight(self.relative(x));
        let r = dx.hypot(dy);
        let sectors = &self.wedge.sectors;
        if r == 0.0 {
            return ((0..sectors.len()).find(|&k| prefers(k)).unwrap_or(0), 0.0, 0.0);
        }
        let total: f64 = sectors.iter().map(|s| s.opening).sum();
        let mut turn = (dy.atan2(dx) - self.start).rem_euclid(TAU);
        // Outside, the nearer end.
        if self.wedge.ends.is_some() && turn > 0.5 * (total + TAU) {
            turn -= TAU;
        }
        let (mut sector, mut from) = (0, 0.0);
        while sector + 1 < sectors.len() && turn > from + sectors[sector].opening {
            from += sectors[sector].opening;
            sector += 1;
        }
        if !prefers(sector) {
            let count = sectors.len();
            if turn - from < ON_RAY && (sector > 0 || self.wedge.ends.is_none()) {
                let before = (sector + count - 1) % count;
                if prefers(before) {
                    return (before, r, 0.5 * sectors[before].opening + (turn - from));
                }
            }
            let to = from + sectors[sector].opening;
            if to - turn < ON_RAY && (sector + 1 < count || self.wedge.ends.is_none()) {
                let after = (sector + 1) % count;
                if prefers(after) {
                    return (after, r, turn - to - 0.5 * sectors[after].opening);
                }
            }
        }
        (sector, r, turn - from - 0.5 * sectors[sector].opening)
    }

    /// The direction of a ray: that before sector k, or the last one.
    pub(super) fn direction(&self, ray: usize) -> [f64; 2] {
        let turned: f64 = self.wedge.sectors[..ray].iter().map(|s| s.opening).sum();
        let (sin, cos) = (self.start + turned).sin_cos();
        [cos, sin].map(|x| if x.abs() < NO_COMPONENT { 0.0 } else { x })
    }

    /// The point at a distance along a ray.
    pub(super) fn on_ray(&self, ray: usize, distance: f64) -> [f64; 2] {
        let [x, y] = self.straightening.back(self.direction(ray), distance);
        [self.at[0] + x, self.at[1] + y]
    }

    /// What a flux there is multiplied by to be one through the straight ray.
    pub(super) fn stretch(&self, ray: usize, distance: f64) -> f64 {
        let [x, y] = self.straightening.across(self.direction(ray), distance);
        x.hypot(y)
    }
}

/// Wedges whose exponents were counted before: many corners of a scene are alike.
pub(crate) struct KnownWedges {
    degree: f64,
    known: Vec<(Wedge, Vec<(f64, usize)>)>,
}

impl KnownWedges {
    /// Of none yet, with exponents up to a degree, and as many functions as there are harmonic polynomials of it.
    pub(crate) fn new(degree: f64) -> Self {
        Self { degree, known: Vec::new() }
    }

    /// The exponents of a wedge, up to the degree.
    pub(crate) fn exponents(&mut self, wedge: &Wedge) -> Vec<(f64, usize)> {
        let alike = |(other, _): &&(Wedge, Vec<(f64, usize)>)| {
            other.ends == wedge.ends
                && other.sectors.len() == wedge.sectors.len()
                && other.sectors.iter().zip(&wedge.sectors).all(|(a, b)| {
                    (a.opening - b.opening).abs() < ALIKE && (a.eta - b.eta).abs() <= f64::EPSILON * a.eta
                })
        };
        if let Some((_, exponents)) = self.known.iter().find(alike) {
            return exponents.clone();
        }
        let exponents = wedge.exponents(self.degree.max(wedge.exponent_of(2.0 * self.degree.round() + 1.0)));
        self.known.push((wedge.clone(), exponents.clone()));
        exponents
    }
}

/// Sectors between the interfaces with a resistance that meet in a vertex, and whether such an interface begins and ends them. Near the vertex
/// hardly anything flows through these: the resistance of a sector falls with the distance, and theirs does not.
fn between_films<const D: usize>(
    problem: &CornerData<'_, D>,
    vertex: &Vertex,
    mut own: Vec<usize>,
) -> Vec<(Vec<usize>, [bool; 2])> {
    let count = vertex.rays.len();
    let is_film = |k: usize| {
        let pair = vertex.sectors[(k + count - 1) % count].zip(vertex.sectors[k]);
        let law = pair.and_then(|(before, after)| between(problem.laws, before, after));
        law.is_some_and(|(law, _)| law.resistance.is_some())
    };
    let closed = own.len() == count;
    if let (true, Some(first)) = (closed, own.iter().position(|&k| is_film(k))) {
        own.rotate_left(first);
    }
    let mut parts: Vec<(Vec<usize>, [bool; 2])> = Vec::new();
    for k in own {
        let begins = is_film(k);
        match parts.last_mut().filter(|_| !begins) {
            Some((part, _)) => part.push(k),
            None => {
                if let Some((_, films)) = parts.last_mut() {
                    films[1] = true;
                }
                parts.push((vec![k], [begins, false]));
            }
        }
    }
    if closed && parts.first().is_some_and(|part| part.1[0]) {
        parts.last_mut().into_iter().for_each(|last| last.1[1] = true);
    }
    parts
}
