//! The convex pieces that a grid is cut into.

use super::Vertex;
use super::clip::{Corner, Zero, clip, mix, mix2};
use super::cuts::{is_left, side};
use super::extend::extend;

/// A field on a grid: where it is known, in which region, and where it ends.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Domain<'a> {
    pub(crate) nx: usize,
    pub(crate) ny: usize,
    /// Value at each grid node, not a number where unknown.
    pub(crate) values: &'a [f64],
    /// Region of each grid node; one region if absent.
    pub(crate) labels: Option<&'a [u16]>,
    /// Level set of the domain, negative inside; the domain ends with the known nodes if absent.
    pub(crate) mask: Option<&'a [f64]>,
    /// Level sets of the interfaces between the regions.
    pub(crate) interfaces: &'a [Vec<f64>],
    /// Lines within regions that the field jumps across, in units of the grid.
    pub(crate) cuts: &'a [Vec<[f64; 2]>],
}

/// Convex polygons with values at their corners.
#[derive(Debug, Default)]
pub(crate) struct Pieces {
    vertices: Vec<Vertex>,
    ends: Vec<usize>,
}

impl Pieces {
    /// The pieces of all cells. With a mask the field is continued by one node and clipped; with labels each region is
    /// continued on its own up to the interface.
    pub(crate) fn new(domain: &Domain) -> Self {
        let mut pieces = Self::default();
        for region in domain.regions() {
            pieces.add_region(domain, region);
        }
        pieces
    }

    /// The pieces of one region.
    pub(crate) fn of_region(domain: &Domain, region: u16) -> Self {
        let mut pieces = Self::default();
        pieces.add_region(domain, region);
        pieces
    }

    fn add_region(&mut self, domain: &Domain, region: u16) {
        let own: Vec<f64> = (0..domain.values.len())
            .map(|k| if domain.region(k) == Some(region) { domain.values[k] } else { f64::NAN })
            .collect();
        let continued = extend(&own, domain.nx, domain.ny);
        let mut cutter =
            Cutter { domain, region, continued: &continued, polygon: Vec::new(), scratch: Vec::new() };
        for j in 0..domain.ny - 1 {
            for i in 0..domain.nx - 1 {
                cutter.cell(i, j, self);
            }
        }
    }

    /// The corners of each piece, counter-clockwise.
    pub(crate) fn iter(&self) -> impl Iterator<Item = &[Vertex]> {
        let starts = std::iter::once(0).chain(self.ends.iter().copied());
        starts.zip(&self.ends).map(|(start, &end)| &self.vertices[start..end])
    }

    fn push(&mut self, corners: impl Iterator<Item = Vertex>) {
        self.vertices.extend(corners);
        self.ends.push(self.vertices.len());
    }
}

impl Domain<'_> {
    /// Whether the field is known at a grid node.
    pub(crate) fn contains(&self, k: usize) -> bool {
        self.region(k).is_some()
    }

    /// The regions that occur, ascending.
    pub(crate) fn regions(&self) -> Vec<u16> {
        let mut regions: Vec<u16> = (0..self.values.len()).filter_map(|k| self.region(k)).collect();
        regions.sort_unstable();
        regions.dedup();
        regions
    }

    /// Region of a grid node, none where the field is unknown.
    fn region(&self, k: usize) -> Option<u16> {
        let known = self.values[k].is_finite() && self.mask.is_none_or(|mask| mask[k] <= 0.0);
        known.then(|| self.labels.map_or(0, |labels| labels[k]))
    }
}

/// A corner with the two functions that the field is clipped by.
#[derive(Debug, Clone, Copy)]
struct Sided {
    at: [f64; 2],
    value: f64,
    /// Positive in other regions.
    side: f64,
    /// Positive outside the domain.
    outside: f64,
}

impl Corner for Sided {
    fn at(&self) -> [f64; 2] {
        self.at
    }

    fn toward(&self, other: &Self, t: f64) -> Self {
        Self {
            at: mix2(self.at, other.at, t),
            value: mix(self.value, other.value, t),
            side: mix(self.side, other.side, t),
            outside: mix(self.outside, other.outside, t),
        }
    }
}

struct Cutter<'a> {
    domain: &'a Domain<'a>,
    region: u16,
    continued: &'a [f64],
    polygon: Vec<Sided>,
    scratch: Vec<Sided>,
}

impl Cutter<'_> {
    fn cell(&mut self, i: usize, j: usize, pieces: &mut Pieces) {
        let nodes = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)];
        let numbers = nodes.map(|(i, j)| j * self.domain.nx + i);
        let regions = numbers.map(|k| self.domain.region(k));
        if !regions.contains(&Some(self.region)) {
            return;
        }
        let sides = self.sides(numbers, regions);
        let corners: [Sided; 4] = std::array::from_fn(|c| {
            let k = numbers[c];
            let outside =
                self.domain.mask.map_or(if regions[c].is_none() { f64::NAN } else { -1.0 }, |mask| mask[k]);
            Sided {
                at: [nodes[c].0 as f64, nodes[c].1 as f64],
                value: self.continued[k],
                side: sides[c],
                outside,
            }
        });
        let within = regions.iter().all(|region| *region == Some(self.region));
        match self.domain.cut_through(nodes).filter(|_| within) {
            None => self.cut(&corners, pieces),
            Some(segment) => {
                for left in [true, false] {
                    let own = nodes.map(|(i, j)| is_left(&segment, &[i as f64, j as f64]) == left);
                    let part = std::array::from_fn(|c| {
                        let beside = side(&segment, &corners[c].at);
                        let mut corner = Sided { side: if left { -beside } else { beside }, ..corners[c] };
                        if !own[c] {
                            let here = (0..4).filter(|&k| own[k]).map(|k| nodes[k]);
                            corner.value = self.domain.beyond_cut(nodes[c], here);
                        }
                        corner
                    });
                    self.cut(&part, pieces);
                }
            }
        }
    }

    /// Which side of the region's border each corner lies on: by the level set that tells the region from the others in
    /// this cell, else half-way between the nodes.
    fn sides(&self, numbers: [usize; 4], regions: [Option<u16>; 4]) -> [f64; 4] {
        let own = |c: usize| regions[c] == Some(self.region);
        let other = |c: usize| regions[c].is_some_and(|region| region != self.region);
        if !(0..4).any(other) {
            return [-1.0; 4];
        }
        for level in self.domain.interfaces {
            for sign in [1.0, -1.0] {
                let side = numbers.map(|k| sign * level[k]);
                if (0..4).all(|c| (!own(c) || side[c] <= 0.0) && (!other(c) || side[c] >= 0.0)) {
                    return side;
                }
            }
        }
        std::array::from_fn(|c| if other(c) { 1.0 } else { -1.0 })
    }

    fn cut(&mut self, corners: &[Sided; 4], pieces: &mut Pieces) {
        let usable =
            |corner: &Sided| !corner.value.is_nan() && !corner.outside.is_nan() && !corner.side.is_nan();
        let whole = corners.iter().all(|c| c.side <= 0.0 && c.outside <= 0.0);
        let missing = corners.iter().filter(|c| !usable(c)).count();
        if missing > 1 {
            return;
        }
        if missing == 1 {
            self.triangle(corners.iter().filter(|c| usable(c)).copied(), pieces);
        } else if whole && !is_saddle(corners.map(|c| c.value)) {
            pieces.push(corners.iter().map(|c| Vertex { at: c.at, value: c.value }));
        } else {
            let mean = |f: fn(&Sided) -> f64| 0.25 * corners.iter().map(f).sum::<f64>();
            let centre = Sided {
                at: [mean(|c| c.at[0]), mean(|c| c.at[1])],
                value: mean(|c| c.value),
                side: mean(|c| c.side),
                outside: mean(|c| c.outside),
            };
            for c in 0..4 {
                self.triangle([corners[c], corners[(c + 1) % 4], centre].into_iter(), pieces);
            }
        }
    }

    fn triangle(&mut self, corners: impl Iterator<Item = Sided>, pieces: &mut Pieces) {
        self.polygon.clear();
        self.polygon.extend(corners);
        clip(&mut self.polygon, &mut self.scratch, Zero::Kept, |c| c.side);
        clip(&mut self.polygon, &mut self.scratch, Zero::Kept, |c| c.outside);
        if self.polygon.len() > 2 {
            pieces.push(self.polygon.iter().map(|c| Vertex { at: c.at, value: c.value }));
        }
    }
}

/// Whether both ends of one diagonal lie above both ends of the other: a level between them crosses the border of the
/// cell four times, and the mean at the centre decides which crossings belong together.
fn is_saddle([a, b, c, d]: [f64; 4]) -> bool {
    a.min(c) > b.max(d) || b.min(d) > a.max(c)
}
