//! Regions by Gaussian averages of the labels, for layers that are too thin for a phase field.

use std::collections::HashMap;
use std::sync::Arc;

use meshless_geometry::{Cloud, LevelSet};

/// Standard deviation of the averages, in spacings.
const WIDTH: f64 = 0.8;

/// Nodes farther than so many deviations do not count.
const CUT_OFF: f64 = 6.0;

/// `ln(Phi(s) / Phi(-s)) = A s + B s^3` to 1.4e-4 of Phi, the distribution function of the normal distribution: what the
/// averages on both sides of a plane say of the distance s from it, in deviations.
const A: f64 = 1.5976;
const B: f64 = 0.070_566;

/// Averages of the labels at any point.
pub(super) struct Averages<const D: usize> {
    points: Vec<[f64; D]>,
    spacing: Vec<f64>,
    labels: Vec<u16>,
    regions: usize,
    cell: f64,
    cells: HashMap<[i64; D], Vec<u32>>,
}

impl<const D: usize> Averages<D> {
    pub(super) fn new(cloud: &Cloud<D>, labels: &[u16], regions: usize) -> Self {
        let cell = CUT_OFF * WIDTH * cloud.spacing().iter().fold(0.0_f64, |a, &b| a.max(b));
        let mut cells: HashMap<[i64; D], Vec<u32>> = HashMap::new();
        for (i, x) in cloud.points().iter().enumerate() {
            cells.entry(x.map(|c| (c / cell).floor() as i64)).or_default().push(i as u32);
        }
        let (points, spacing) = (cloud.points().to_vec(), cloud.spacing().to_vec());
        Self { points, spacing, labels: labels.to_vec(), regions, cell, cells }
    }

    /// The weight of every region at x with its gradient, and the mean spacing there.
    fn at(&self, x: &[f64; D]) -> (Vec<(f64, [f64; D])>, f64) {
        let home = x.map(|c| (c / self.cell).floor() as i64);
        let mut sums = vec![(0.0, [0.0; D]); self.regions];
        let (mut mass, mut spacings) = (0.0, 0.0);
        for step in 0..3_usize.pow(D as u32) {
            let key: [i64; D] =
                std::array::from_fn(|k| home[k] + (step / 3_usize.pow(k as u32) % 3) as i64 - 1);
            for &i in self.cells.get(&key).map_or(&[][..], Vec::as_slice) {
                let i = i as usize;
                let width = WIDTH * self.spacing[i];
                let offset: [f64; D] = std::array::from_fn(|k| (x[k] - self.points[i][k]) / width);
                let squared = offset.iter().map(|c| c * c).sum::<f64>();
                if squared > CUT_OFF * CUT_OFF {
                    continue;
                }
                let weight = (-0.5 * squared).exp();
                let sum = &mut sums[usize::from(self.labels[i])];
                sum.0 += weight;
                (0..D).for_each(|k| sum.1[k] -= weight * offset[k] / width);
                mass += weight;
                spacings += weight * self.spacing[i];
            }
        }
        (sums, if mass > 0.0 { spacings / mass } else { 0.0 })
    }
}

/// One region with all before it: where the average of one of them outweighs that of every other.
pub(super) struct AveragedRegion<const D: usize> {
    averages: Arc<Averages<D>>,
    region: usize,
}

impl<const D: usize> AveragedRegion<D> {
    pub(super) fn new(averages: Arc<Averages<D>>, region: usize) -> Self {
        Self { averages, region }
    }

    /// The distance from the surface, negative inside, and its gradient.
    fn distance(&self, x: &[f64; D]) -> (f64, [f64; D]) {
        let (sums, spacing) = self.averages.at(x);
        let (up_to_own, beyond) = sums.split_at((self.region + 1).min(sums.len()));
        let most = |of: &[(f64, [f64; D])]| {
            of.iter().copied().max_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((0.0, [0.0; D]))
        };
        let (own, other) = (most(up_to_own), most(beyond));
        let unit = WIDTH * spacing;
        if own.0 <= 0.0 || other.0 <= 0.0 {
            let far = CUT_OFF * unit.max(f64::MIN_POSITIVE);
            return (if own.0 > 0.0 { -far } else { far }, [0.0; D]);
        }
        // The real root of B s^3 + A s = ratio.
        let (ratio, root) = ((other.0 / own.0).ln(), (3.0 * B / A).sqrt());
        let s = 2.0 / root * ((1.5 * ratio * root / A).asinh() / 3.0).sinh();
        let slope = unit / (A + 3.0 * B * s * s);
        (unit * s, std::array::from_fn(|k| slope * (other.1[k] / other.0 - own.1[k] / own.0)))
    }
}

impl<const D: usize> LevelSet<D> for AveragedRegion<D> {
    fn value(&self, x: &[f64; D]) -> f64 {
        self.distance(x).0
    }

    fn gradient(&self, x: &[f64; D]) -> [f64; D] {
        self.distance(x).1
    }
}
