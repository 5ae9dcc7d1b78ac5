//! Where the data of a scene vary below a spacing, told from the data alone, and the spacings that resolve them.
//!
//! Sources, diffusivities and what conditions prescribe are sampled on cells that are halved: of the box round the domain, and of the
//! pieces of its boundary. On a cell a polynomial through a lattice of values is compared with the values at random places in it. What
//! it is off by changes u: by `w^2 / 8 eta` times that of a source, w the width of the cell; by `w / L` times the relative one of a
//! diffusivity, L the size of the domain, and times that of a prescribed value. Where this is more than the tolerance times the size that
//! the data give u the cell is divided, and all are until there are some thousands, so that what is narrow is met by some of many
//! places. The polynomials are of the order of the method: nodes as far apart as the values of the largest cells that need not be divided
//! resolve the data as well as the method can.

use meshless_geometry::{Domain, FaceId, Patch, RegionMap, Size, side_patch};
use meshless_interfaces::{Condition, Field, Material};
use rayon::prelude::*;

use super::shapes::{domain, regions, spacing};
use super::{Boundary, materials};
use crate::Error;
use crate::scene::{ConditionSpec, ExprField, Scene};

/// The part of the size of u that data may change it by unseen, where the scene gives no error to reach.
const TOLERANCE: f64 = 1e-3;

/// Cells at least, by the number of parameters.
const CELLS: [usize; 4] = [0, 1_024, 4_096, 4_096];

/// Cells that are divided beyond that at most, by the number of parameters: as many as clouds of some 1e5 nodes resolve.
const MOST_DIVIDED: [usize; 4] = [0, 4_096, 8_192, 2_048];

/// Halvings at most.
const DEEPEST: u32 = 28;

/// Random places of a cell, by the number of parameters.
const PLACES: [usize; 4] = [0, 6, 12, 16];

/// The least and the largest degree of polynomials, by the number of parameters.
const DEGREES: [(usize, usize); 4] = [(0, 0), (2, 8), (2, 8), (2, 4)];

/// A spacing that is asked for is smaller than the given one by this factor at least: where the data are smooth, it is the solution that
/// tells how far apart nodes may be.
const CLEARLY: f64 = 0.5;

/// Size of the chords of a level set, over the size of the domain.
const CHORD: f64 = 1.0 / 256.0;

/// Halvings below a cell after which what is off as much as half as before is a jump: of prescribed values these are corners, which have
/// spacings of their own.
const JUMPS: u32 = 4;

/// The spacings that the data of a scene ask for, for a method of an order: those that are clearly smaller than the given one.
pub(super) fn feature_spacings<const D: usize>(scene: &Scene, order: usize) -> Result<Vec<Size<D>>, Error> {
    if scene.is_labelled() || !has_functions(scene) {
        return Ok(Vec::new());
    }
    let now = scene.at_time(0.0);
    let (domain, regions, materials) = (domain::<D>(&now)?, regions::<D>(&now)?, materials::<D>(&now));
    let boundary = Boundary::new(&now, &domain);
    let tolerance = scene.accuracy.as_ref().map_or(TOLERANCE, |spec| spec.tolerance);
    let bounds = domain.bounds();
    let extent = bounds.lengths().iter().fold(0.0_f64, |a, &b| a.max(b));
    let volume = Volume { domain: &domain, regions: &regions, materials: &materials, extent };
    let tell = |cell: &Cell<D>, samples: &Samples<D>| volume.told(cell, samples);
    let mut inside = Tree::<D>::new(bounds.min, bounds.lengths(), extent, order, &tell);
    let patches = patches(&domain, extent);
    let walls: Vec<Wall<'_, D>> = patches
        .iter()
        .map(|(face, patch)| Wall { patch, face: *face, boundary: &boundary, extent })
        .collect();
    let least = walls.iter().map(Wall::size).fold(0.0, f64::max);
    inside.grow(tolerance, least, &tell);
    let size = inside.size().max(least);
    let mut found = inside.asked(tolerance, size, &|cell| cell.place());
    if D == 2 {
        for wall in &walls {
            let tell = |cell: &Cell<1>, samples: &Samples<1>| wall.told(cell, samples);
            let mut tree = Tree::<1>::new([0.0], [1.0], 1.0, order, &tell);
            tree.grow(tolerance, size, &tell);
            found.extend(tree.asked(tolerance, size, &|cell| wall.place(cell)));
        }
    }
    let given = spacing::<D>(scene);
    // What is no spacing is refused where the cloud is made.
    found.retain(|size| given.at(&size.at).is_ok_and(|h| size.spacing < CLEARLY * h));
    Ok(found)
}

/// Whether any of the data is no number.
fn has_functions(scene: &Scene) -> bool {
    let varies = |field: &ExprField| field.expr.as_constant().is_none();
    let conditions = scene.boundaries.iter().any(|spec| match &spec.condition {
        ConditionSpec::Dirichlet(g) | ConditionSpec::Neumann(g) | ConditionSpec::Flux(g) => varies(g),
        ConditionSpec::Robin { a, b, g } => varies(a) || varies(b) || varies(g),
    });
    conditions
        || scene.regions.iter().any(|r| varies(&r.diffusivity) || r.source.as_ref().is_some_and(varies))
}

/// The pieces of the boundary, but those that are too small to be told anything of.
fn patches<'a, const D: usize>(domain: &'a Domain<D>, extent: f64) -> Vec<(FaceId, Patch<'a, D>)> {
    let mut all = Vec::new();
    if D == 1 {
        return all;
    }
    let bounds = domain.bounds();
    if let Some(outer) = domain.outer_box() {
        all.extend((0..2 * D).map(|k| (FaceId(k as u16), side_patch(&outer, k / 2, k % 2 == 1))));
    }
    for (face, shape, _) in domain.curved_faces() {
        all.extend(shape.patches(&bounds, CHORD * extent).into_iter().map(|patch| (face, patch)));
    }
    all.retain(|(_, patch)| !patch.is_small());
    all
}

/// What is told of a cell.
#[derive(Debug, Clone, Copy, Default)]
struct Told {
    /// By how much polynomials are off what is prescribed; 0 where only jumps of that are no features.
    off: f64,
    /// By how much that changes u.
    error: f64,
    /// By how much more, over the size of u.
    relative: f64,
    /// The mean of the source over eight times the diffusivity: times the square of the width it is the size that the source gives u.
    load: f64,
}

/// Places in the unit cell: a lattice and random ones.
struct Samples<const P: usize> {
    lattice: Vec<[f64; P]>,
    /// Random places of this cell.
    places: Vec<[f64; P]>,
    degree: usize,
}

/// A cell in its parameters.
#[derive(Debug, Clone, Copy)]
struct Cell<const P: usize> {
    min: [f64; P],
    width: f64,
    depth: u32,
    told: Told,
    /// Its halves along all parameters, from there on; 0 for none.
    first: u32,
    parts: u32,
}

impl<const P: usize> Cell<P> {
    fn at(&self, place: &[f64; P]) -> [f64; P] {
        std::array::from_fn(|k| self.min[k] + self.width * place[k])
    }

    /// Its middle, its width and what reaches from the middle to its corners.
    fn place(&self) -> ([f64; P], f64, f64) {
        (self.at(&[0.5; P]), self.width, 0.5 * (P as f64).sqrt() * self.width)
    }
}

impl Told {
    /// Whether u changes by more than a part of its size.
    fn is_more(&self, tolerance: f64, size: f64) -> bool {
        self.error > tolerance * size || self.relative > tolerance
    }

    /// By how much u changes, over its size.
    fn part(&self, size: f64) -> f64 {
        if size > 0.0 { self.relative.max(self.error / size) } else { self.relative }
    }
}

type Tell<'a, const P: usize> = &'a (dyn Fn(&Cell<P>, &Samples<P>) -> Told + Sync);

/// Where a cell is, how wide it is, and how far it reaches from there.
type Place<'a, const P: usize, const D: usize> = &'a dyn Fn(&Cell<P>) -> ([f64; D], f64, f64);

/// Cells with the cells that they are divided into.
struct Tree<const P: usize> {
    cells: Vec<Cell<P>>,
    /// Cells that are not divided, and what of the parameters counts.
    leaves: Vec<u32>,
    max: [f64; P],
    degree: usize,
    lattice: Vec<[f64; P]>,
}

impl<const P: usize> Tree<P> {
    fn new(min: [f64; P], lengths: [f64; P], width: f64, order: usize, tell: Tell<'_, P>) -> Self {
        let degree = order.clamp(DEGREES[P].0, DEGREES[P].1);
        let count = degree + 1;
        let lattice = (0..count.pow(P as u32))
            .map(|code| std::array::from_fn(|k| (code / count.pow(k as u32) % count) as f64 / degree as f64));
        let max = std::array::from_fn(|k| min[k] + lengths[k]);
        let root = Cell { min, width, depth: 0, told: Told::default(), first: 0, parts: 0 };
        let lattice = lattice.collect();
        let mut tree = Self { cells: vec![root], leaves: vec![0], max, degree, lattice };
        tree.cells[0].told = tree.told(&tree.cells[0], 0, tell);
        while tree.leaves.len() < CELLS[P] {
            let all = std::mem::take(&mut tree.leaves);
            tree.divide(&all, tell);
        }
        tree
    }

    /// What is told of a cell of a number.
    fn told(&self, cell: &Cell<P>, number: usize, tell: Tell<'_, P>) -> Told {
        let mut random = Random(number as u64);
        let places = (0..PLACES[P]).map(|_| std::array::from_fn(|_| random.next())).collect();
        // The lattice is small: a copy of it is nothing beside the values at it.
        tell(cell, &Samples { lattice: self.lattice.clone(), places, degree: self.degree })
    }

    /// Divides cells; their parts are leaves then.
    fn divide(&mut self, numbers: &[u32], tell: Tell<'_, P>) {
        let mut made = Vec::new();
        for &number in numbers {
            let cell = self.cells[number as usize];
            let width = 0.5 * cell.width;
            let first = (self.cells.len() + made.len()) as u32;
            for code in 0..1_usize << P {
                let min: [f64; P] = std::array::from_fn(|k| cell.min[k] + width * (code >> k & 1) as f64);
                if (0..P).all(|k| min[k] < self.max[k]) {
                    let told = Told::default();
                    made.push(Cell { min, width, depth: cell.depth + 1, told, first: 0, parts: 0 });
                }
            }
            let parts = (self.cells.len() + made.len()) as u32 - first;
            let own = &mut self.cells[number as usize];
            (own.first, own.parts) = (first, parts);
        }
        let before = self.cells.len();
        let told: Vec<Told> =
            made.par_iter().enumerate().map(|(k, cell)| self.told(cell, before + k, tell)).collect();
        self.leaves.extend((before..before + made.len()).map(|k| k as u32));
        self.cells.extend(made.into_iter().zip(told).map(|(cell, told)| Cell { told, ..cell }));
    }

    /// The size that the data give u. What a cell has of a source its parts know better.
    fn size(&self) -> f64 {
        let mut loads: Vec<f64> = self.cells.iter().map(|cell| cell.told.load).collect();
        let mut size = 0.0_f64;
        for (number, cell) in self.cells.iter().enumerate().rev() {
            if cell.parts > 0 {
                let parts = cell.first as usize..(cell.first + cell.parts) as usize;
                loads[number] = parts.map(|k| loads[k]).sum::<f64>() / f64::from(1_u32 << P);
            }
            size = size.max(loads[number].abs() * cell.width * cell.width);
        }
        size
    }

    /// Divides cells on which the data change u by more than so many times its size, those first that change it most; its size is `least` or more.
    fn grow(&mut self, tolerance: f64, least: f64, tell: Tell<'_, P>) {
        let mut left = MOST_DIVIDED[P];
        loop {
            let size = self.size().max(least);
            let needs = |cell: &Cell<P>| cell.told.is_more(tolerance, size) && cell.depth < DEEPEST;
            let mut wanted: Vec<u32> =
                self.leaves.iter().copied().filter(|&leaf| needs(&self.cells[leaf as usize])).collect();
            wanted.sort_by(|&a, &b| {
                let part = |k: u32| self.cells[k as usize].told.part(size);
                part(b).total_cmp(&part(a)).then(a.cmp(&b))
            });
            wanted.truncate(left);
            if wanted.is_empty() {
                return;
            }
            left -= wanted.len();
            let divided: std::collections::BTreeSet<u32> = wanted.iter().copied().collect();
            self.leaves.retain(|leaf| !divided.contains(leaf));
            self.divide(&wanted, tell);
        }
    }

    /// The spacings that cells ask for which need not be divided, and whose parents have to be.
    fn asked<const D: usize>(&self, tolerance: f64, size: f64, place: Place<'_, P, D>) -> Vec<Size<D>> {
        // Parts come after what they are of.
        let mut needs = vec![false; self.cells.len()];
        let mut still = vec![(0.0_f64, 0_u32); self.cells.len()];
        for (number, cell) in self.cells.iter().enumerate().rev() {
            let parts = cell.first as usize..(cell.first + cell.parts) as usize;
            let below = parts.clone().map(|k| still[k]).fold((0.0, 0), |a, b| if b.1 > a.1 { b } else { a });
            still[number] = if cell.parts > 0 { below } else { (cell.told.off, cell.depth) };
            let jumps = below.1 >= cell.depth + JUMPS && below.0 > 0.5 * cell.told.off && cell.told.off > 0.0;
            needs[number] = cell.told.is_more(tolerance, size) && !jumps || parts.clone().any(|k| needs[k]);
        }
        let mut found = Vec::new();
        let mut waiting = vec![0];
        while let Some(number) = waiting.pop() {
            let cell = &self.cells[number];
            if needs[number] && cell.parts > 0 {
                waiting.extend((cell.first..cell.first + cell.parts).map(|k| k as usize));
            } else {
                let (at, width, within) = place(cell);
                found.push(Size { at, spacing: width / self.degree as f64, within });
            }
        }
        found
    }
}

/// By how much polynomials through the lattice are off the values at the places; `None` where one of them is no number.
fn off<const P: usize>(samples: &Samples<P>, lattice: &[f64], places: &[f64]) -> Option<f64> {
    if !lattice.iter().chain(places).all(|value| value.is_finite()) {
        return None;
    }
    let count = samples.degree + 1;
    let mut largest = 0.0_f64;
    for (place, value) in samples.places.iter().zip(places) {
        // Lagrange's polynomials along every axis.
        let weights: [[f64; 9]; P] = std::array::from_fn(|axis| {
            std::array::from_fn(|j| {
                let x = place[axis] * samples.degree as f64;
                let others = (0..count).filter(|&m| m != j && j < count);
                others.map(|m| (x - m as f64) / (j as f64 - m as f64)).product()
            })
        });
        let said: f64 = lattice
            .iter()
            .enumerate()
            .map(|(code, value)| {
                let weight: f64 = (0..P).map(|k| weights[k][code / count.pow(k as u32) % count]).product();
                weight * value
            })
            .sum();
        largest = largest.max((said - value).abs());
    }
    Some(largest)
}

/// The inside of a domain.
struct Volume<'a, const D: usize> {
    domain: &'a Domain<D>,
    regions: &'a RegionMap<D>,
    materials: &'a [Material<D>],
    extent: f64,
}

impl<const D: usize> Volume<'_, D> {
    fn told(&self, cell: &Cell<D>, samples: &Samples<D>) -> Told {
        let places: Vec<[f64; D]> = samples.places.iter().map(|place| cell.at(place)).collect();
        let mut labels: Vec<u16> = (places.iter().filter(|x| self.domain.contains(x, 0.0)))
            .map(|x| self.regions.label(x, 0.0))
            .collect();
        labels.sort_unstable();
        labels.dedup();
        let mut told = Told::default();
        let mut lattice: Vec<[f64; D]> = Vec::new();
        for label in labels {
            let Material { diffusivity, source, .. } = &self.materials[label as usize];
            let eta = diffusivity.at(&cell.at(&[0.5; D]));
            if !(eta.is_finite() && eta > 0.0) {
                continue;
            }
            if lattice.is_empty() {
                lattice.extend(samples.lattice.iter().map(|place| cell.at(place)));
            }
            let values = |field: &Field<D>| {
                let of = |points: &[[f64; D]]| {
                    let mut values = vec![0.0; points.len()];
                    field.eval(points, &mut values);
                    values
                };
                [of(&lattice), of(&places)]
            };
            let w = cell.width;
            if let Some(source) = source {
                let [on_lattice, at_places] = values(source);
                if let Some(off) = off(samples, &on_lattice, &at_places) {
                    told.error = told.error.max(off * w * w / (8.0 * eta));
                    let all = on_lattice.iter().chain(&at_places);
                    let mean = all.sum::<f64>() / (on_lattice.len() + at_places.len()) as f64;
                    told.load += mean / (8.0 * eta);
                }
            }
            if diffusivity.as_constant().is_none() {
                let [on_lattice, at_places] = values(diffusivity);
                let least = on_lattice.iter().chain(&at_places).fold(f64::INFINITY, |a, &b| a.min(b));
                if let (Some(off), true) = (off(samples, &on_lattice, &at_places), least > 0.0) {
                    told.relative = told.relative.max((off / least).min(1.0) * w / self.extent);
                }
            }
        }
        told
    }
}

/// A piece of the boundary.
struct Wall<'a, const D: usize> {
    patch: &'a Patch<'a, D>,
    face: FaceId,
    boundary: &'a Boundary<D>,
    extent: f64,
}

impl<const D: usize> Wall<'_, D> {
    fn at(&self, s: f64) -> [f64; D] {
        self.patch.at([s, 0.5]).at
    }

    fn length(&self, cell: &Cell<1>) -> f64 {
        cell.width * self.patch.extent[0]
    }

    fn place(&self, cell: &Cell<1>) -> ([f64; D], f64, f64) {
        let length = self.length(cell);
        (self.at(cell.at(&[0.5])[0]), length, 0.5 * length)
    }

    /// What a condition prescribes, as far as that is a value of u.
    fn value(condition: Condition) -> f64 {
        match condition {
            Condition::Dirichlet(value) => value,
            Condition::Robin { a, g, .. } if a != 0.0 => g / a,
            _ => 0.0,
        }
    }

    /// The size of what is prescribed along the middle of the piece.
    fn size(&self) -> f64 {
        let of_place = |k: u32| {
            let x = self.at((f64::from(k) + 0.5) / 16.0);
            let entry = self.boundary.entry(self.face, &x);
            entry.map_or(0.0, |entry| Self::value(self.boundary.of_entry(entry, &x)).abs())
        };
        (0..16).map(of_place).filter(|value| value.is_finite()).fold(0.0, f64::max)
    }

    fn told(&self, cell: &Cell<1>, samples: &Samples<1>) -> Told {
        let points = |places: &[[f64; 1]]| -> Vec<[f64; D]> {
            places.iter().map(|place| self.at(cell.at(place)[0])).collect()
        };
        let (lattice, places) = (points(&samples.lattice), points(&samples.places));
        let middle = self.at(cell.at(&[0.5])[0]);
        let Some(entry) = self.boundary.entry(self.face, &middle) else { return Told::default() };
        let same = |x: &[f64; D]| self.boundary.entry(self.face, x) == Some(entry);
        let values = |points: &[[f64; D]]| -> Vec<f64> {
            points.iter().map(|x| Self::value(self.boundary.of_entry(entry, x))).collect()
        };
        let (on_lattice, at_places) = (values(&lattice), values(&places));
        if !lattice.iter().chain(&places).all(same) {
            return Told::default();
        }
        let off = off(samples, &on_lattice, &at_places).unwrap_or_default();
        Told { off, error: off * self.length(cell) / self.extent, ..Told::default() }
    }
}

/// Numbers from 0 to 1, the same for the same start (Steele, Lea, Flood: "Fast splittable pseudorandom number generators", 2014).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0.wrapping_mul(0xff51_afd7_ed55_8ccd);
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }
}
