//! A vertex, or what is across an edge in space: sectors, their materials, what holds on the outer rays, and the data along all rays.

use std::f64::consts::TAU;

use meshless_geometry::{Edge, FaceId, Frame, Vertex};
use nalgebra::{DMatrix, DVector};

use super::straightening::Straightening;
use super::wedge::{End, Forced, Harmonic, RayData, Sector, Wedge};
use super::{Corner, CornerData, condition_at};
use crate::Condition;
use crate::equation::between;

/// Where diffusivities and the kinds of conditions beside a vertex are read, over the length of its shortest ray.
const BESIDE: f64 = 1e-3;

/// Polynomials along rays that stand for data there have this many degrees more than those of a fit, up to the highest.
const DEGREES_BEYOND: usize = 4;
const HIGHEST_DEGREE: usize = 14;

/// Components of directions below this are rounding: on the plane `x = 0` a value x is zero.
const NO_COMPONENT: f64 = 1e-15;

/// How far from whole numbers an exponent may be for its function to count as a polynomial.
const WHOLE: f64 = 1e-7;

/// Logarithms that stand with this power or a higher one do not count at edges in space.
const WEAK: f64 = 2.0;

/// Part of the largest coefficient of data below which one is rounding.
const ROUNDING: f64 = 1e-12;

/// Part of the data that polynomials may miss and count as meeting them: rounding of polynomials of degree 14.
const MET: f64 = 1e-10;

/// Part of what the source and the data do at a vertex below which a logarithm or a function of the angle is rounding, or the error
/// of the polynomials that stand for the data.
const NEGLIGIBLE: f64 = 1e-7;

/// Angle, in radians, up to which a point belongs to the sector on the other side of a ray as well: rounding.
const ON_RAY: f64 = 1e-6;

/// Errors of the polynomials that stand for the data may be so many times as large as between the points where they are known.
const DOUBTFUL: f64 = 10.0;

/// How near to a vertex a source is told there, over the length of its shortest ray, and the part of it farther away below which it
/// vanishes.
const AT_VERTEX: f64 = 1e-9;
const VANISHING: f64 = 1e-6;

/// How far along the rays data are looked at to tell what they do at the vertex, over their length.
const NEAR: f64 = 0.25;

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

/// A monomial of a polynomial in the coordinates from a vertex: exponents, factor.
pub(crate) type Monomial = ([u8; 2], f64);

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
    straightening: Straightening,
    /// The sectors, with scale 1.
    pub(crate) wedge: Wedge,
    /// Regions of the sectors.
    pub(crate) labels: Vec<u16>,
    /// Faces of the outer rays.
    faces: Vec<FaceId>,
    /// Distance within which there is nothing else.
    pub(crate) clear: f64,
    /// What prevents the corner functions from being exact.
    pub(crate) obstacle: Option<Obstacle>,
    /// Exponents and how many functions each has, up to the degree asked for.
    pub(crate) exponents: Vec<(f64, usize)>,
}

/// What solves a local problem: `u = c + s w` in every sector.
#[derive(Debug, Clone)]
pub(crate) struct LocalSolution {
    /// Homogeneous functions of `r / R`.
    pub(crate) functions: Vec<Harmonic>,
    /// What the data and the source add, in `r / R`.
    pub(crate) forced: Vec<Forced>,
    /// What a source of 1 everywhere adds, beside its polynomial.
    pub(crate) unit: Vec<Forced>,
    /// How far the polynomials that stand for the data are off, and their degree.
    pub(crate) doubt: f64,
    data_degree: usize,
}

/// The scales in which a local problem is solved.
#[derive(Debug, Clone)]
pub(crate) struct Scales {
    /// Of every sector's unknown.
    pub(crate) scale: Vec<f64>,
    /// What is known of its constant.
    pub(crate) offset: Vec<f64>,
    /// The distance R that r is divided by.
    pub(crate) radius: f64,
    /// Polynomials in the coordinates from the vertex over R, before any straightening, that have the right Laplacian in every sector.
    pub(crate) sources: Vec<Vec<Monomial>>,
    /// How far these are off.
    pub(crate) doubt: f64,
}

impl Scales {
    /// Scale 1 everywhere, and what the sources are right at the vertex.
    pub(crate) fn plain<const D: usize>(problem: &CornerData<'_, D>, local: &Local) -> Self {
        let sectors = local.wedge.sectors.len();
        let radius = NEAR * local.clear;
        let source = |k: usize| {
            let material = &problem.materials[local.labels[k] as usize];
            let at = |distance: f64| {
                let f = material
                    .source
                    .as_ref()
                    .map_or(0.0, |f| f.at(&local.in_space(local.inside(k, distance))));
                if f.is_finite() { f } else { 0.0 }
            };
            // A source that vanishes at the vertex leaves rounding there.
            let here = at(AT_VERTEX * local.clear);
            let f = if here.abs() > VANISHING * at(radius).abs() { here } else { 0.0 };
            square(-radius * radius * f / (4.0 * local.wedge.sectors[k].eta))
        };
        Self {
            scale: vec![1.0; sectors],
            offset: vec![0.0; sectors],
            radius,
            sources: (0..sectors).map(source).collect(),
            doubt: 0.0,
        }
    }
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

    /// The smallest power at which a solution is no polynomial in the sectors. Logarithms count in the plane only: in space they are at
    /// every edge of a heated box, and as weak as `r^2 ln r`.
    pub(crate) fn broken_by(&self, solution: &LocalSolution) -> Option<f64> {
        let exponent = self.broken_exponent();
        let power = solution.broken_power(exponent);
        if self.along.is_some() && power.is_some_and(|power| power >= WEAK) { exponent } else { power }
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
    fn direction(&self, ray: usize) -> [f64; 2] {
        let turned: f64 = self.wedge.sectors[..ray].iter().map(|s| s.opening).sum();
        let (sin, cos) = (self.start + turned).sin_cos();
        [cos, sin].map(|x| if x.abs() < NO_COMPONENT { 0.0 } else { x })
    }

    /// The point at a distance along a ray.
    fn on_ray(&self, ray: usize, distance: f64) -> [f64; 2] {
        let [x, y] = self.straightening.back(self.direction(ray), distance);
        [self.at[0] + x, self.at[1] + y]
    }

    /// What a flux there is multiplied by to be one through the straight ray.
    fn stretch(&self, ray: usize, distance: f64) -> f64 {
        let [x, y] = self.straightening.across(self.direction(ray), distance);
        x.hypot(y)
    }

    /// Solves the local problem with its data and the polynomials of its sources, to which those are added that meet the data by
    /// themselves; an obstacle where these have no values.
    pub(crate) fn solve<const D: usize>(
        &self,
        problem: &CornerData<'_, D>,
        scales: &mut Scales,
        degree: usize,
    ) -> Result<LocalSolution, Obstacle> {
        if self.obstacle == Some(Obstacle::Contact) {
            return Err(Obstacle::Contact);
        }
        let mut wedge = self.wedge.clone();
        wedge.sectors.iter_mut().zip(&scales.scale).for_each(|(sector, &scale)| sector.scale = scale);
        let functions: Vec<Harmonic> =
            self.exponents.iter().flat_map(|&(power, count)| wedge.functions(power, count)).collect();
        // Along what was curved not even constants are polynomials.
        let is_straight = self.straightening.is_identity();
        let data_degree = if is_straight { degree + DEGREES_BEYOND } else { HIGHEST_DEGREE };
        let data_degree = data_degree.min(HIGHEST_DEGREE);
        let (mut data, doubt) = self.data(problem, &wedge, scales, data_degree).ok_or(Obstacle::Data)?;
        let along = (scales.radius, data_degree);
        let doubt_of_sources =
            self.take_sources(&wedge, along, &scales.sources, &mut data).ok_or(Obstacle::Data)?;
        if !is_straight {
            self.meet_data(&wedge, along, degree, &mut scales.sources, &mut data);
        }
        let largest = data.iter().flat_map(numbers).fold(0.0_f64, |m, x| m.max(x.abs()));
        let mut forced = Vec::new();
        for (power, mut data) in data.into_iter().enumerate() {
            round(&mut data, ROUNDING * largest);
            let power = power as f64;
            forced.push(wedge.forced(power, &data).ok_or(Obstacle::Data)?);
        }
        let units: Vec<Vec<Monomial>> = wedge
            .sectors
            .iter()
            .map(|s| square(-scales.radius * scales.radius / (4.0 * s.eta * s.scale)))
            .collect();
        let mut unit_data = Vec::new();
        self.take_sources(&wedge, along, &units, &mut unit_data).ok_or(Obstacle::Data)?;
        let mut unit = Vec::new();
        for (power, data) in unit_data.iter().enumerate().filter(|(_, data)| numbers(data).any(|x| x != 0.0))
        {
            unit.push(wedge.forced(power as f64, data).ok_or(Obstacle::Data)?);
        }
        let doubt = doubt.max(doubt_of_sources).max(scales.doubt);
        Ok(LocalSolution { functions, forced, unit, doubt, data_degree })
    }

    /// The jumps and values along the rays as polynomials of r / R, one entry a power; fluxes times r.
    fn data<const D: usize>(
        &self,
        problem: &CornerData<'_, D>,
        wedge: &Wedge,
        scales: &Scales,
        degree: usize,
    ) -> Option<(Vec<RayData>, f64)> {
        let radius = scales.radius;
        let mut doubt = 0.0_f64;
        let mut polynomial = |ray: usize, value: &dyn Fn(f64) -> Option<f64>| {
            let (factors, error) = self.along_ray(ray, (radius, degree), value)?;
            doubt = doubt.max(error);
            Some(factors)
        };
        let mut all = vec![empty(wedge); degree + 2];
        let sectors = wedge.sectors.len();
        for ray in 0..wedge.inner_rays() {
            let next = (ray + 1) % sectors;
            all[0].values[ray] = scales.offset[ray] - scales.offset[next];
            let (before, after) = (self.labels[ray], self.labels[next]);
            let Some((jump, sign)) = between(problem.laws, before, after) else { continue };
            let at = |t: f64| self.in_space(self.on_ray(ray + 1, t));
            if let Some(field) = &jump.value {
                let values = polynomial(ray + 1, &|t| Some(sign * field.at(&at(t))))?;
                values.iter().enumerate().for_each(|(power, c)| all[power].values[ray] += c);
            }
            if let Some(field) = &jump.flux {
                let fluxes = polynomial(ray + 1, &|t| Some(field.at(&at(t)) * self.stretch(ray + 1, t)))?;
                fluxes.iter().enumerate().for_each(|(power, c)| all[power + 1].fluxes[ray] += radius * c);
            }
        }
        for (k, end) in wedge.ends.iter().flatten().enumerate() {
            let (ray, sector, face) =
                if k == 0 { (0, 0, self.faces[0]) } else { (sectors, sectors - 1, self.faces[1]) };
            let condition = |t: f64| problem.boundary.condition(face, &self.in_space(self.on_ray(ray, t)));
            // The angle grows into the domain on the first ray, and out of it on the last.
            let (out, eta) = (if k == 0 { -1.0 } else { 1.0 }, wedge.sectors[sector].eta);
            match end {
                End::Dirichlet => {
                    let values = polynomial(ray, &|t| match condition(t)? {
                        Condition::Dirichlet(value) => Some(value),
                        _ => None,
                    })?;
                    values.iter().enumerate().for_each(|(power, c)| all[power].ends[k] = *c);
                    all[0].ends[k] -= scales.offset[sector];
                }
                End::Flux => {
                    let fluxes = polynomial(ray, &|t| match condition(t)?.as_flux(eta)? {
                        (0.0, flux) => Some(flux * self.stretch(ray, t)),
                        _ => None,
                    })?;
                    fluxes
                        .iter()
                        .enumerate()
                        .for_each(|(power, c)| all[power + 1].ends[k] = out * radius * c);
                }
            }
        }
        Some((all, doubt))
    }

    /// Adds harmonic polynomials of a degree to those of the sources where together they meet all data, of which nothing is left then. So
    /// solutions that are polynomials are exact, as they are at straight rays: those that are made straight know them as series.
    fn meet_data(
        &self,
        wedge: &Wedge,
        along: (f64, usize),
        degree: usize,
        sources: &mut [Vec<Monomial>],
        data: &mut [RayData],
    ) -> Option<()> {
        let left = on_rays(data);
        if left.iter().all(|x| *x == 0.0) {
            return None;
        }
        let candidates: Vec<(usize, Vec<Monomial>)> = (0..sources.len())
            .flat_map(|sector| harmonic_polynomials(degree).into_iter().map(move |p| (sector, p)))
            .collect();
        let mut columns = Vec::with_capacity(candidates.len());
        for (sector, polynomial) in &candidates {
            let mut alone = vec![Vec::new(); sources.len()];
            alone[*sector].clone_from(polynomial);
            let mut taken = vec![empty(wedge); data.len()];
            self.take_sources(wedge, along, &alone, &mut taken)?;
            columns.push(on_rays(&taken));
        }
        let size =
            |row: usize| columns.iter().map(|column| column[row].abs()).fold(left[row].abs(), f64::max);
        let sizes: Vec<f64> =
            (0..left.len()).map(size).map(|size| if size > 0.0 { size } else { 1.0 }).collect();
        let matrix = DMatrix::from_fn(left.len(), columns.len(), |row, k| columns[k][row] / sizes[row]);
        let wanted = DVector::from_fn(left.len(), |row, _| -left[row] / sizes[row]);
        let svd = matrix.clone().svd(true, true);
        let factors = svd.solve(&wanted, ROUNDING * svd.singular_values.max()).ok()?;
        if (matrix * &factors - &wanted).amax() > MET * wanted.amax() {
            return None;
        }
        for ((sector, polynomial), factor) in candidates.iter().zip(&factors) {
            sources[*sector].extend(polynomial.iter().map(|(exponents, c)| (*exponents, factor * c)));
        }
        data.iter_mut().for_each(|data| *data = empty(wedge));
        Some(())
    }

    /// The polynomial of a degree in `t / radius` that has the values of a function along a ray, up to what is as far as the radius from
    /// the vertex; and how far it is off.
    fn along_ray(
        &self,
        ray: usize,
        (radius, degree): (f64, usize),
        value: &dyn Fn(f64) -> Option<f64>,
    ) -> Option<(Vec<f64>, f64)> {
        let extent = self.straightening.extent(self.direction(ray), radius);
        let (mut factors, error) = along(extent, degree, value)?;
        if extent != radius {
            let by = radius / extent;
            factors.iter_mut().enumerate().for_each(|(power, c)| *c *= by.powi(power as i32));
        }
        Some((factors, error))
    }

    /// Takes what polynomials in the sectors leave on the rays from the data; returns how far what stands for that is off.
    fn take_sources(
        &self,
        wedge: &Wedge,
        along: (f64, usize),
        sources: &[Vec<Monomial>],
        data: &mut Vec<RayData>,
    ) -> Option<f64> {
        let (sectors, mut doubt) = (wedge.sectors.len(), 0.0_f64);
        for (k, (sector, source)) in
            wedge.sectors.iter().zip(sources).enumerate().filter(|(_, s)| !s.1.is_empty())
        {
            for after in [false, true] {
                let (powers, error) = self.source_along(k + usize::from(after), along, source)?;
                doubt = doubt.max(error * sector.scale);
                if data.len() < powers.len() {
                    data.resize(powers.len(), empty(wedge));
                }
                for ([value, slope], data) in powers.into_iter().zip(data.iter_mut()) {
                    let (value, flux) = (sector.scale * value, sector.eta * sector.scale * slope);
                    match (wedge.ends, after) {
                        (Some(ends), false) if k == 0 => {
                            data.ends[0] -= if ends[0] == End::Dirichlet { value } else { flux };
                        }
                        (Some(ends), true) if k + 1 == sectors => {
                            data.ends[1] -= if ends[1] == End::Dirichlet { value } else { flux };
                        }
                        _ => {
                            let ray = if after { k } else { (k + sectors - 1) % sectors };
                            // A jump is the later sector less the earlier one, and this sector is the earlier one of the ray
                            // after it.
                            let sign = if after { 1.0 } else { -1.0 };
                            data.values[ray] += sign * value;
                            data.fluxes[ray] += sign * flux;
                        }
                    }
                }
            }
        }
        Some(doubt)
    }

    /// A polynomial along a ray, and r times its derivative across: factors of the powers of r / R. How far they are off, too.
    fn source_along(
        &self,
        ray: usize,
        (radius, degree): (f64, usize),
        source: &[Monomial],
    ) -> Option<(Vec<[f64; 2]>, f64)> {
        let direction = self.direction(ray);
        if self.straightening.is_identity() {
            let most = source.iter().map(|(e, _)| usize::from(e[0] + e[1])).max()?;
            let mut powers = vec![[0.0; 2]; most + 1];
            for monomial in source {
                let (value, gradient) = value_and_gradient(&[*monomial], direction);
                let [own_value, own_slope] = &mut powers[usize::from(monomial.0[0] + monomial.0[1])];
                *own_value += value;
                *own_slope += gradient[1] * direction[0] - gradient[0] * direction[1];
            }
            return Some((powers, 0.0));
        }
        let at = |t: f64| {
            let x = self.straightening.back(direction, t).map(|x| x / radius);
            let (value, gradient) = value_and_gradient(source, x);
            let [across_x, across_y] = self.straightening.across(direction, t);
            (value, gradient[0] * across_x + gradient[1] * across_y)
        };
        let (values, error) = self.along_ray(ray, (radius, degree), &|t| Some(at(t).0))?;
        let (slopes, of_slopes) = self.along_ray(ray, (radius, degree), &|t| Some(at(t).1))?;
        let mut powers = vec![[0.0; 2]; degree + 2];
        powers.iter_mut().zip(values).for_each(|(power, value)| power[0] = value);
        powers[1..].iter_mut().zip(slopes).for_each(|(power, slope)| power[1] = slope);
        Some((powers, error.max(of_slopes)))
    }
}

impl LocalSolution {
    /// The smallest power at which it is no polynomial in the sectors: that of a function, of a logarithm, or 0 where the value depends
    /// on the direction; `None` where polynomials do.
    pub(crate) fn broken_power(&self, exponents: Option<f64>) -> Option<f64> {
        let size = |factors: &[[f64; 2]]| factors.iter().flatten().fold(0.0_f64, |m, x| m.max(x.abs()));
        let turning = self.value_depends_on_direction();
        let logarithm =
            self.forced.iter().find(|f| size(&f.logarithm) > self.rounding(f.power)).map(|f| f.power);
        let least = [turning.then_some(0.0), logarithm, exponents];
        least.into_iter().flatten().min_by(f64::total_cmp)
    }

    /// What may be an error of the data's polynomials in a factor of a power: a derivative of order k of a polynomial is up to
    /// `degree^(2 k)` times as large as the polynomial (Markov's inequality).
    fn rounding(&self, power: f64) -> f64 {
        let size = self.size();
        let error = DOUBTFUL * self.doubt.max(f64::EPSILON * size);
        (NEGLIGIBLE * size).max(error * (self.data_degree as f64).powf(2.0 * power))
    }

    /// The size of what the data add.
    pub(crate) fn size(&self) -> f64 {
        self.forced.iter().flat_map(|f| f.plain.iter().flatten()).fold(0.0, |m, x| m.max(x.abs()))
    }

    /// Whether there is no one value at the vertex: two that are prescribed meet there.
    pub(crate) fn value_depends_on_direction(&self) -> bool {
        let Some(first) = self.forced.first().filter(|f| f.power == 0.0) else { return false };
        let [plain, turning] = [0, 1].map(|k| first.plain.iter().fold(0.0_f64, |m, f| m.max(f[k].abs())));
        turning > (NEGLIGIBLE * plain.max(turning)).max(self.rounding(0.0))
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

/// No data at all.
fn empty(wedge: &Wedge) -> RayData {
    let none = vec![0.0; wedge.inner_rays()];
    RayData { values: none.clone(), fluxes: none, ends: [0.0; 2] }
}

fn numbers(data: &RayData) -> impl Iterator<Item = f64> + '_ {
    data.values.iter().chain(&data.fluxes).chain(&data.ends).copied()
}

fn round(data: &mut RayData, least: f64) {
    let all = data.values.iter_mut().chain(&mut data.fluxes).chain(&mut data.ends);
    all.filter(|x| x.abs() <= least).for_each(|x| *x = 0.0);
}

/// All data at some places along the rays.
fn on_rays(data: &[RayData]) -> Vec<f64> {
    let powers: Vec<Vec<f64>> = data.iter().map(|data| numbers(data).collect()).collect();
    let count = powers.first().map_or(0, Vec::len);
    let at = |number: usize, t: f64| powers.iter().rev().fold(0.0, |sum, power| sum * t + power[number]);
    let places = (1..=data.len()).map(|k| k as f64 / data.len() as f64);
    places.flat_map(|t| (0..count).map(move |number| (number, t))).map(|(number, t)| at(number, t)).collect()
}

/// `Re (x + i y)^k` and `Im (x + i y)^k` up to a degree.
fn harmonic_polynomials(degree: usize) -> Vec<Vec<Monomial>> {
    let mut all: Vec<Vec<Monomial>> = Vec::with_capacity(2 * degree + 1);
    let mut binomials = vec![1.0];
    for k in 0..=degree {
        for odd in [0, 1] {
            let part = binomials.iter().enumerate().skip(odd).step_by(2).map(|(j, binomial)| {
                let sign = if j / 2 % 2 == 0 { 1.0 } else { -1.0 };
                ([(k - j) as u8, j as u8], sign * binomial)
            });
            all.push(part.collect());
        }
        binomials = (0..=k + 1)
            .map(|j| binomials.get(j).unwrap_or(&0.0) + if j > 0 { binomials[j - 1] } else { 0.0 })
            .collect();
    }
    all.retain(|polynomial| !polynomial.is_empty());
    all
}

/// `factor |x|^2`.
fn square(factor: f64) -> Vec<Monomial> {
    vec![([2, 0], factor), ([0, 2], factor)]
}

/// Value and gradient of a polynomial.
pub(crate) fn value_and_gradient(polynomial: &[Monomial], [x, y]: [f64; 2]) -> (f64, [f64; 2]) {
    let mut sum = (0.0, [0.0; 2]);
    for &([i, j], factor) in polynomial {
        let (i, j) = (i32::from(i), i32::from(j));
        sum.0 += factor * x.powi(i) * y.powi(j);
        sum.1[0] += if i > 0 { factor * f64::from(i) * x.powi(i - 1) * y.powi(j) } else { 0.0 };
        sum.1[1] += if j > 0 { factor * f64::from(j) * x.powi(i) * y.powi(j - 1) } else { 0.0 };
    }
    sum
}

/// The polynomial of a degree in `t / radius` that has the values of a function at Chebyshev points from 0 to the radius, and how far
/// it is off between them.
fn along(radius: f64, degree: usize, value: &dyn Fn(f64) -> Option<f64>) -> Option<(Vec<f64>, f64)> {
    let count = degree + 1;
    let place = |k: f64| {
        let angle = std::f64::consts::PI * (k + 0.5) / count as f64;
        0.5 * (1.0 - angle.cos())
    };
    let at = |k: f64| value(radius * place(k)).filter(|v| v.is_finite());
    let values: Option<Vec<f64>> = (0..count).map(|k| at(k as f64)).collect();
    let values = values?;
    if values.iter().all(|v| *v == values[0]) {
        return Some((vec![values[0]], 0.0));
    }
    let powers = DMatrix::from_fn(count, count, |k, power| place(k as f64).powi(power as i32));
    let factors: Vec<f64> = powers.lu().solve(&DVector::from_vec(values))?.iter().copied().collect();
    let polynomial = |t: f64| factors.iter().rev().fold(0.0, |sum, c| sum * t + c);
    let mut error = 0.0_f64;
    for k in 0..degree {
        let between = k as f64 + 0.5;
        error = error.max((polynomial(place(between)) - at(between)?).abs());
    }
    Some((factors, error))
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
