//! Nodal distances as level sets that divide space between the regions.

use std::collections::HashMap;
use std::sync::Arc;

use meshless_geometry::{Cloud, LevelSet};

/// Radius within which the expansions of nodes are blended, in spacings: some node is always nearer than that.
const RADIUS: f64 = 2.0;

/// A polynomial of second degree about a node.
#[derive(Debug, Clone, Copy)]
pub(super) struct Expansion<const D: usize> {
    pub(super) value: f64,
    pub(super) gradient: [f64; D],
    pub(super) hessian: [[f64; D]; D],
}

impl<const D: usize> Expansion<D> {
    pub(super) fn constant(value: f64) -> Self {
        Self { value, gradient: [0.0; D], hessian: [[0.0; D]; D] }
    }

    /// Value and gradient at an offset from the node.
    fn at(&self, s: &[f64; D]) -> (f64, [f64; D]) {
        let bent: [f64; D] = std::array::from_fn(|a| (0..D).map(|b| self.hessian[a][b] * s[b]).sum());
        let value = (0..D).map(|k| (self.gradient[k] + 0.5 * bent[k]) * s[k]).sum::<f64>() + self.value;
        (value, std::array::from_fn(|k| self.gradient[k] + bent[k]))
    }
}

/// The distances of all regions between the nodes: expansions of the nodes near a point, blended with smooth weights.
pub(super) struct Blend<const D: usize> {
    points: Vec<[f64; D]>,
    spacing: Vec<f64>,
    /// For every region, an expansion a node.
    fields: Vec<Vec<Expansion<D>>>,
    cell: f64,
    cells: HashMap<[i64; D], Vec<u32>>,
}

impl<const D: usize> Blend<D> {
    pub(super) fn new(cloud: &Cloud<D>, fields: Vec<Vec<Expansion<D>>>) -> Self {
        let cell = RADIUS * cloud.spacing().iter().fold(0.0_f64, |a, &b| a.max(b));
        let mut cells: HashMap<[i64; D], Vec<u32>> = HashMap::new();
        for (i, x) in cloud.points().iter().enumerate() {
            cells.entry(place(x, cell)).or_default().push(i as u32);
        }
        Self { points: cloud.points().to_vec(), spacing: cloud.spacing().to_vec(), fields, cell, cells }
    }

    /// Calls `add(node, offset, weight, gradient of the weight)` for the nodes near x, in an order that is always the
    /// same; the nearest node alone, with weight 1, where none is near.
    fn near(&self, x: &[f64; D], mut add: impl FnMut(usize, &[f64; D], f64, [f64; D])) {
        let home = place(x, self.cell);
        let mut found = false;
        for step in 0..3_usize.pow(D as u32) {
            let key: [i64; D] =
                std::array::from_fn(|k| home[k] + (step / 3_usize.pow(k as u32) % 3) as i64 - 1);
            for &i in self.cells.get(&key).map_or(&[][..], Vec::as_slice) {
                let i = i as usize;
                let radius = RADIUS * self.spacing[i];
                let offset: [f64; D] = std::array::from_fn(|k| x[k] - self.points[i][k]);
                let share = 1.0 - offset.iter().map(|c| c * c).sum::<f64>() / (radius * radius);
                if share > 0.0 {
                    found = true;
                    // (1 - r^2)^3: two continuous derivatives where a node begins to count.
                    let slope = -6.0 * share * share / (radius * radius);
                    add(i, &offset, share.powi(3), offset.map(|c| slope * c));
                }
            }
        }
        if !found && let Some(i) = self.nearest(x) {
            add(i, &std::array::from_fn(|k| x[k] - self.points[i][k]), 1.0, [0.0; D]);
        }
    }

    /// The nearest of all nodes: only asked for outside of the cloud.
    fn nearest(&self, x: &[f64; D]) -> Option<usize> {
        let squared = |i: usize| (0..D).map(|k| (x[k] - self.points[i][k]).powi(2)).sum::<f64>();
        (0..self.points.len()).min_by(|&a, &b| squared(a).total_cmp(&squared(b)))
    }

    /// The distances of all regions, and their gradients.
    fn at(&self, x: &[f64; D], out: &mut Vec<(f64, [f64; D])>) {
        out.clear();
        out.resize(self.fields.len(), (0.0, [0.0; D]));
        let (mut mass, mut mass_slope) = (0.0, [0.0; D]);
        self.near(x, |i, offset, weight, slope| {
            mass += weight;
            (0..D).for_each(|k| mass_slope[k] += slope[k]);
            for (field, sum) in self.fields.iter().zip(out.iter_mut()) {
                let (value, gradient) = field[i].at(offset);
                sum.0 += weight * value;
                (0..D).for_each(|k| sum.1[k] += weight * gradient[k] + slope[k] * value);
            }
        });
        for (value, gradient) in out {
            *value /= mass;
            (0..D).for_each(|k| gradient[k] = (gradient[k] - *value * mass_slope[k]) / mass);
        }
    }
}

fn place<const D: usize>(x: &[f64; D], cell: f64) -> [i64; D] {
    x.map(|c| (c / cell).floor() as i64)
}

/// One region with all before it: half of the smallest of their distances less the smallest of the others. So every point is in
/// exactly one region, between two regions, whose distances differ in sign, the level is the mean of both, and an
/// interface is found from beyond a thin layer.
pub(super) struct RegionSurface<const D: usize> {
    blend: Arc<Blend<D>>,
    region: usize,
}

impl<const D: usize> RegionSurface<D> {
    pub(super) fn new(blend: Arc<Blend<D>>, region: usize) -> Self {
        Self { blend, region }
    }

    fn at(&self, x: &[f64; D]) -> (f64, [f64; D]) {
        let mut all = Vec::new();
        self.blend.at(x, &mut all);
        let (up_to_own, beyond) = all.split_at((self.region + 1).min(all.len()));
        let least = |of: &[(f64, [f64; D])]| {
            of.iter().copied().min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((0.0, [0.0; D]))
        };
        let (own, other) = (least(up_to_own), least(beyond));
        (0.5 * (own.0 - other.0), std::array::from_fn(|k| 0.5 * (own.1[k] - other.1[k])))
    }
}

impl<const D: usize> LevelSet<D> for RegionSurface<D> {
    fn value(&self, x: &[f64; D]) -> f64 {
        self.at(x).0
    }

    fn gradient(&self, x: &[f64; D]) -> [f64; D] {
        self.at(x).1
    }
}
