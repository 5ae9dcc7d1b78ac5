//! The local problem at a vertex in the plane: sectors of constant diffusivity between straight rays.
//!
//! Its homogeneous solutions are `r^lambda Phi(theta)`, with `Phi = a cos(lambda z) + b sin(lambda z)` in every sector, z
//! the angle from the sector's middle. The exponents are found by counting (Wittrick and Williams, "A general algorithm
//! for computing natural frequencies of elastic structures", 1971): the number of those below lambda is the number of
//! negative eigenvalues of a small symmetric matrix over the rays.

use std::f64::consts::PI;

use nalgebra::{DMatrix, DVector};

/// Largest `angle * lambda` of a piece of a sector in the counting matrix, over pi: below 1 nothing has a pole.
const LARGEST_PHASE: f64 = 0.8;

/// Smallest exponent that is looked for: a constant has 0. Contrasts of 1e10 have 1e-5.
const LEAST_EXPONENT: f64 = 1e-7;

/// Relative width down to which exponents are bisected.
const EXPONENT_WIDTH: f64 = 1e-15;

/// Exponents nearer to each other than this are one, with as many functions.
const MERGED: f64 = 1e-9;

/// Singular values below this part of the largest are zero, in the systems that match sectors.
const RANK_TOLERANCE: f64 = 1e-11;

/// The same, for a power to have solutions without data: an exponent that is as near to it.
const RESONANT: f64 = 1e-9;

/// What is left of a matching system of unit rows beyond which it has no solution.
const MATCHED: f64 = 1e-8;

/// What holds on an outer ray.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum End {
    /// u is prescribed.
    Dirichlet,
    /// The flux is.
    Flux,
}

/// One sector. Its unknown is w in `u = c + s w`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Sector {
    /// Its angle.
    pub(crate) opening: f64,
    /// The diffusivity.
    pub(crate) eta: f64,
    /// The scale s of its unknown.
    pub(crate) scale: f64,
}

/// The sectors round a vertex, counterclockwise.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Wedge {
    /// The sectors.
    pub(crate) sectors: Vec<Sector>,
    /// What holds on the first and the last ray; `None` where the sectors go all round.
    pub(crate) ends: Option<[End; 2]>,
}

/// `r^power Phi(theta)`, homogeneous: factors of the two functions of every sector.
#[derive(Debug, Clone)]
pub(crate) struct Harmonic {
    /// The exponent lambda.
    pub(crate) power: f64,
    /// `[a, b]` for every sector.
    pub(crate) factors: Vec<[f64; 2]>,
}

/// What a wedge has to do on its rays at one power of r: jumps of `s w` and of `eta s dw/dtheta` across the rays between sectors
/// (the later sector less the earlier one), and values or `eta s dw/dtheta` on the outer ones.
#[derive(Debug, Clone, Default)]
pub(crate) struct RayData {
    /// Jumps of the value, of every ray between two sectors; the last one is that between the last sector and the first.
    pub(crate) values: Vec<f64>,
    /// Jumps of the flux, likewise.
    pub(crate) fluxes: Vec<f64>,
    /// What is given on the outer rays.
    pub(crate) ends: [f64; 2],
}

/// `r^power (Psi + ln r Phi)` with a homogeneous `r^power Phi`, none of which there is without resonance.
#[derive(Debug, Clone)]
pub(crate) struct Forced {
    /// The power.
    pub(crate) power: f64,
    /// Factors of the two functions of every sector, in Psi.
    pub(crate) plain: Vec<[f64; 2]>,
    /// Those of Phi, which stands with the logarithm; empty without.
    pub(crate) logarithm: Vec<[f64; 2]>,
}

/// The functions of a sector at an angle from its middle: `cos(lambda z)` and `sin(lambda z)`, the latter over lambda below 1, where
/// it becomes z.
pub(crate) fn waves(power: f64, z: f64) -> [f64; 2] {
    let (sin, cos) = (power * z).sin_cos();
    if power >= 1.0 {
        [cos, sin]
    } else if power > 0.0 {
        [cos, sin / power]
    } else {
        [1.0, z]
    }
}

/// Their derivatives.
pub(crate) fn slopes(power: f64, z: f64) -> [f64; 2] {
    let (sin, cos) = (power * z).sin_cos();
    if power >= 1.0 { [-power * sin, power * cos] } else { [-power * sin, cos] }
}

/// What goes with `ln r Phi`: a `chi` with `chi'' + lambda^2 chi = -2 lambda Phi`, for either function.
fn beside_logarithm(power: f64, z: f64) -> [f64; 2] {
    let (sin, cos) = (power * z).sin_cos();
    [-z * sin, z * cos]
}

fn beside_logarithm_slopes(power: f64, z: f64) -> [f64; 2] {
    let (sin, cos) = (power * z).sin_cos();
    [-sin - power * z * cos, cos - power * z * sin]
}

/// Value, derivative in r and derivative in theta over r of `r^power (psi + ln r phi)`, both given with their derivatives in theta.
fn polar(power: f64, r: f64, [psi, psi_slope]: [f64; 2], [phi, phi_slope]: [f64; 2]) -> [f64; 3] {
    // Where the gradient is infinite, it is not told: at the vertex itself.
    if r == 0.0 && power < 1.0 {
        return [if power == 0.0 { psi } else { 0.0 }, 0.0, 0.0];
    }
    let ln = if phi == 0.0 && phi_slope == 0.0 { 0.0 } else { r.max(f64::MIN_POSITIVE).ln() };
    let lower = r.powf(power - 1.0);
    let value = psi + ln * phi;
    [r.powf(power) * value, lower * (power * value + phi), lower * (psi_slope + ln * phi_slope)]
}

fn combine(factors: [f64; 2], functions: [f64; 2]) -> f64 {
    factors[0] * functions[0] + factors[1] * functions[1]
}

impl Harmonic {
    /// Value, derivative in r and derivative in theta over r, at r and the angle z from the middle of a sector.
    pub(crate) fn at(&self, sector: usize, r: f64, z: f64) -> [f64; 3] {
        let (power, factors) = (self.power, self.factors[sector]);
        let phi = [combine(factors, waves(power, z)), combine(factors, slopes(power, z))];
        polar(power, r, phi, [0.0; 2])
    }
}

impl Forced {
    #[cfg(test)]
    fn is_logarithmic(&self) -> bool {
        !self.logarithm.is_empty()
    }

    /// Value, derivative in r and derivative in theta over r, at r and the angle z from the middle of a sector.
    pub(crate) fn at(&self, sector: usize, r: f64, z: f64) -> [f64; 3] {
        let (power, plain) = (self.power, self.plain[sector]);
        let mut psi = [combine(plain, waves(power, z)), combine(plain, slopes(power, z))];
        let Some(&logarithm) = self.logarithm.get(sector) else { return polar(power, r, psi, [0.0; 2]) };
        psi[0] += combine(logarithm, beside_logarithm(power, z));
        psi[1] += combine(logarithm, beside_logarithm_slopes(power, z));
        polar(power, r, psi, [combine(logarithm, waves(power, z)), combine(logarithm, slopes(power, z))])
    }
}

impl Wedge {
    /// Rays between two sectors; where the sectors go all round, the one between the last and the first comes last.
    pub(crate) fn inner_rays(&self) -> usize {
        self.sectors.len() - usize::from(self.ends.is_some())
    }

    /// Whether u is prescribed on an outer ray.
    pub(crate) fn is_held(&self) -> bool {
        self.ends.is_some_and(|ends| ends.contains(&End::Dirichlet))
    }

    /// About the exponent up to which there are so many functions.
    pub(crate) fn exponent_of(&self, functions: f64) -> f64 {
        let angle: f64 = self.sectors.iter().map(|s| s.opening).sum();
        // All round every exponent is about double.
        let each = if self.ends.is_some() { PI } else { 0.5 * angle };
        functions * each / angle
    }

    /// The exponents from just above 0 to `most`, with how many functions each has.
    pub(crate) fn exponents(&self, most: f64) -> Vec<(f64, usize)> {
        let rays = CountingRays::new(self, most);
        let mut found = Vec::new();
        let (low, high) = (LEAST_EXPONENT, most);
        rays.between([low, high], [rays.below(low), rays.below(high)], &mut found);
        let mut merged: Vec<(f64, usize)> = Vec::new();
        for (power, count) in found {
            match merged.last_mut() {
                Some((last, functions)) if power - *last <= MERGED * power.max(1.0) => *functions += count,
                _ => merged.push((power, count)),
            }
        }
        merged
    }

    /// The functions of an exponent.
    pub(crate) fn functions(&self, power: f64, count: usize) -> Vec<Harmonic> {
        let columns = 2 * self.sectors.len();
        let (_, Some(v)) = singular(&self.matching(power)) else { return Vec::new() };
        let member = |k: usize| {
            let row = v.row(columns - 1 - k);
            let largest = (0..self.sectors.len())
                .fold(0.0_f64, |m, sector| m.max(row[2 * sector].hypot(row[2 * sector + 1])));
            let factors = (0..self.sectors.len()).map(|s| [row[2 * s] / largest, row[2 * s + 1] / largest]);
            Harmonic { power, factors: factors.collect() }
        };
        (0..count.min(columns)).map(member).collect()
    }

    /// The homogeneous solutions of a power, where there are any.
    fn resonant(&self, power: f64) -> Vec<Harmonic> {
        if power == 0.0 {
            return Vec::new();
        }
        let (sizes, _) = singular(&self.matching(power));
        let count = sizes.iter().filter(|size| **size < RESONANT * sizes.amax()).count();
        self.functions(power, count)
    }

    /// The solution at one power that has given jumps and values on the rays; `None` where there is none.
    pub(crate) fn forced(&self, power: f64, data: &RayData) -> Option<Forced> {
        let resonant = self.resonant(power);
        let columns = 2 * self.sectors.len();
        let right = self.right_hand_side(power, data);
        let size = right.amax();
        let zero = vec![[0.0; 2]; self.sectors.len()];
        if size == 0.0 {
            return Some(Forced { power, plain: zero, logarithm: Vec::new() });
        }
        let mut matrix = self.matching(power).resize_horizontally(columns + resonant.len(), 0.0);
        for (k, function) in resonant.iter().enumerate() {
            matrix.set_column(columns + k, &self.logarithm_column(power, function));
        }
        let svd = matrix.clone().svd(true, true);
        let largest = svd.singular_values.amax();
        let solution = svd.solve(&right, RANK_TOLERANCE * largest).ok()?;
        let left_over = (&matrix * &solution - &right).amax();
        if left_over.is_nan() || left_over > MATCHED * size {
            return None;
        }
        let plain = (0..self.sectors.len()).map(|s| [solution[2 * s], solution[2 * s + 1]]).collect();
        let mut logarithm = zero;
        let mut strongest = 0.0_f64;
        for (k, function) in resonant.iter().enumerate() {
            let alpha = solution[columns + k];
            strongest = strongest.max(alpha.abs());
            for (sum, factors) in logarithm.iter_mut().zip(&function.factors) {
                (0..2).for_each(|j| sum[j] += alpha * factors[j]);
            }
        }
        let rounding = MERGED * solution.amax();
        Some(Forced { power, plain, logarithm: if strongest > rounding { logarithm } else { Vec::new() } })
    }

    /// The rows that match sectors: jumps of the value and of the flux on every ray between two, and what holds on the outer ones; in
    /// units of the larger side.
    fn matching(&self, power: f64) -> DMatrix<f64> {
        let columns = 2 * self.sectors.len();
        let mut matrix = DMatrix::zeros(columns, columns);
        let mut row = 0;
        for ray in 0..self.inner_rays() {
            let (before, after) = (ray, (ray + 1) % self.sectors.len());
            let [of_value, of_flux] = self.units(ray, power);
            for (sector, sign, side) in [(before, -1.0, 0.5), (after, 1.0, -0.5)] {
                let Sector { opening, eta, scale } = self.sectors[sector];
                let (value, slope) = (waves(power, side * opening), slopes(power, side * opening));
                for k in 0..2 {
                    matrix[(row, 2 * sector + k)] += sign * scale * of_value * value[k];
                    matrix[(row + 1, 2 * sector + k)] += sign * eta * scale * of_flux * slope[k];
                }
            }
            row += 2;
        }
        for (end, (sector, side)) in
            self.ends.iter().flatten().zip([(0, -0.5), (self.sectors.len() - 1, 0.5)])
        {
            let opening = self.sectors[sector].opening;
            let entries = match end {
                End::Dirichlet => waves(power, side * opening),
                End::Flux => slopes(power, side * opening).map(|x| x / power.max(1.0)),
            };
            (0..2).for_each(|k| matrix[(row, 2 * sector + k)] = entries[k]);
            row += 1;
        }
        matrix
    }

    /// Factors of the two rows of a ray between sectors.
    fn units(&self, ray: usize, power: f64) -> [f64; 2] {
        let sides = [ray, (ray + 1) % self.sectors.len()].map(|k| self.sectors[k]);
        let largest = |size: fn(&Sector) -> f64| sides.iter().map(size).fold(0.0, f64::max);
        [1.0 / largest(|s| s.scale), 1.0 / (power.max(1.0) * largest(|s| s.eta * s.scale))]
    }

    fn right_hand_side(&self, power: f64, data: &RayData) -> DVector<f64> {
        let mut right = DVector::zeros(2 * self.sectors.len());
        let mut row = 0;
        for ray in 0..self.inner_rays() {
            let [of_value, of_flux] = self.units(ray, power);
            right[row] = of_value * data.values.get(ray).copied().unwrap_or(0.0);
            right[row + 1] = of_flux * data.fluxes.get(ray).copied().unwrap_or(0.0);
            row += 2;
        }
        for (k, end) in self.ends.iter().flatten().enumerate() {
            let Sector { eta, scale, .. } = self.sectors[if k == 0 { 0 } else { self.sectors.len() - 1 }];
            right[row] = match end {
                End::Dirichlet => data.ends[k] / scale,
                End::Flux => data.ends[k] / (eta * scale * power.max(1.0)),
            };
            row += 1;
        }
        right
    }

    /// What stands beside the logarithm of a homogeneous solution, in the rows that match sectors.
    fn logarithm_column(&self, power: f64, function: &Harmonic) -> DVector<f64> {
        let mut column = DVector::zeros(2 * self.sectors.len());
        let mut row = 0;
        let at = |sector: usize, side: f64| {
            let (z, factors) = (side * self.sectors[sector].opening, function.factors[sector]);
            [
                combine(factors, beside_logarithm(power, z)),
                combine(factors, beside_logarithm_slopes(power, z)),
            ]
        };
        for ray in 0..self.inner_rays() {
            let (before, after) = (ray, (ray + 1) % self.sectors.len());
            let [of_value, of_flux] = self.units(ray, power);
            for (sector, sign, side) in [(before, -1.0, 0.5), (after, 1.0, -0.5)] {
                let Sector { eta, scale, .. } = self.sectors[sector];
                let [value, slope] = at(sector, side);
                column[row] += sign * scale * of_value * value;
                column[row + 1] += sign * eta * scale * of_flux * slope;
            }
            row += 2;
        }
        for (end, (sector, side)) in
            self.ends.iter().flatten().zip([(0, -0.5), (self.sectors.len() - 1, 0.5)])
        {
            let [value, slope] = at(sector, side);
            column[row] = match end {
                End::Dirichlet => value,
                End::Flux => slope / power.max(1.0),
            };
            row += 1;
        }
        column
    }
}

/// Singular values and right singular vectors, as rows, in falling order.
fn singular(matrix: &DMatrix<f64>) -> (DVector<f64>, Option<DMatrix<f64>>) {
    let svd = matrix.clone().svd(false, true);
    (svd.singular_values, svd.v_t)
}

/// The rays of the counting matrix: those of the wedge, and more between them where a sector is wide.
struct CountingRays {
    /// Pieces: the rays on both sides, the angle, the diffusivity.
    pieces: Vec<([usize; 2], f64, f64)>,
    rays: usize,
    /// Which rays are struck: u is prescribed there.
    struck: Vec<bool>,
    /// 1 where a constant is a solution, which is negative at every lambda above 0.
    constants: usize,
}

impl CountingRays {
    fn new(wedge: &Wedge, most: f64) -> Self {
        let largest = LARGEST_PHASE * PI / most;
        // A single ray would be its own neighbour.
        let least = if wedge.ends.is_none() { 3_usize.div_ceil(wedge.sectors.len()) } else { 1 };
        let mut pieces = Vec::new();
        let mut rays = 0;
        for sector in &wedge.sectors {
            let count = ((sector.opening / largest).ceil() as usize).max(least).max(2);
            for _ in 0..count {
                pieces.push(([rays, rays + 1], sector.opening / count as f64, sector.eta));
                rays += 1;
            }
        }
        let mut struck = vec![false; rays + 1];
        match wedge.ends {
            None => pieces.iter_mut().for_each(|(sides, ..)| sides[1] %= rays),
            Some(ends) => {
                rays += 1;
                struck[0] = ends[0] == End::Dirichlet;
                struck[rays - 1] = ends[1] == End::Dirichlet;
            }
        }
        struck.truncate(rays);
        Self { pieces, rays, struck, constants: usize::from(!wedge.is_held()) }
    }

    /// How many exponents are below lambda.
    fn below(&self, lambda: f64) -> usize {
        let mut matrix = DMatrix::<f64>::zeros(self.rays, self.rays);
        let mut size = vec![0.0; self.rays];
        for &([i, j], angle, eta) in &self.pieces {
            let (sin, cos) = (lambda * angle).sin_cos();
            let (own, other) = (eta * lambda * cos / sin, -eta * lambda / sin);
            matrix[(i, i)] += own;
            matrix[(j, j)] += own;
            matrix[(i, j)] += other;
            matrix[(j, i)] += other;
            size[i] += eta / angle;
            size[j] += eta / angle;
        }
        let kept: Vec<usize> = (0..self.rays).filter(|&k| !self.struck[k]).collect();
        let scaled = DMatrix::from_fn(kept.len(), kept.len(), |a, b| {
            matrix[(kept[a], kept[b])] / (size[kept[a]] * size[kept[b]]).sqrt()
        });
        let negative = scaled.symmetric_eigenvalues().iter().filter(|value| **value < 0.0).count();
        negative.saturating_sub(self.constants)
    }

    /// Appends the exponents between two values that have so many below them.
    fn between(&self, [low, high]: [f64; 2], [before, after]: [usize; 2], found: &mut Vec<(f64, usize)>) {
        if after <= before {
            return;
        }
        let middle = 0.5 * (low + high);
        if high - low <= EXPONENT_WIDTH * high || middle <= low || middle >= high {
            found.push((middle, after - before));
            return;
        }
        let at_middle = self.below(middle).clamp(before, after);
        self.between([low, middle], [before, at_middle], found);
        self.between([middle, high], [at_middle, after], found);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_PI_2, TAU};

    fn wedge(sectors: &[(f64, f64)], ends: Option<[End; 2]>) -> Wedge {
        let sector = |&(opening, eta): &(f64, f64)| Sector { opening, eta, scale: 1.0 };
        Wedge { sectors: sectors.iter().map(sector).collect(), ends }
    }

    fn kellogg() -> Wedge {
        let contrast = 161.447_638_797_588_1;
        wedge(&[(FRAC_PI_2, contrast), (FRAC_PI_2, 1.0), (FRAC_PI_2, contrast), (FRAC_PI_2, 1.0)], None)
    }

    #[test]
    fn exponents_are_those_of_closed_forms() {
        let (held, free) = (End::Dirichlet, End::Flux);
        let of = |w: Wedge| w.exponents(4.5).iter().map(|e| e.0).collect::<Vec<_>>();
        for (ends, shift) in [([held, held], 0.0), ([free, free], 0.0), ([held, free], 0.5)] {
            let found = of(wedge(&[(1.5 * PI, 3.0)], Some(ends)));
            let exact: Vec<f64> =
                (0..8).map(|k| (f64::from(k) + shift) / 1.5).filter(|&l| l > 0.0 && l < 4.5).collect();
            assert_eq!(found.len(), exact.len(), "{found:?}");
            assert!(found.iter().zip(&exact).all(|(a, b)| (a - b).abs() < 1e-13), "{found:?}");
        }
        let plain = wedge(&[(TAU, 2.0)], None).exponents(4.5);
        assert_eq!(plain.iter().map(|e| e.1).collect::<Vec<_>>(), [2, 2, 2, 2]);
        let found = of(kellogg());
        for (a, b) in found.iter().zip([0.1, 1.9, 2.0, 2.1, 3.9, 4.0, 4.1]) {
            assert!((a - b).abs() < 1e-12, "{found:?}");
        }
        // A checkerboard of contrast 1e10: (4/pi) atan(1e-5).
        let board = wedge(&[(FRAC_PI_2, 1e10), (FRAC_PI_2, 1.0), (FRAC_PI_2, 1e10), (FRAC_PI_2, 1.0)], None);
        assert!((board.exponents(1.0)[0].0 / 1.273_24e-5 - 1.0).abs() < 1e-4);
    }

    /// The largest jump across the rays, and the largest Laplacian by differences.
    fn misfit(wedge: &Wedge, value: &dyn Fn(usize, f64, f64) -> [f64; 3]) -> [f64; 2] {
        let mut worst = [0.0_f64; 2];
        for ray in 0..wedge.inner_rays() {
            let next = (ray + 1) % wedge.sectors.len();
            let (a, b) = (wedge.sectors[ray], wedge.sectors[next]);
            let [low, high] = [value(ray, 0.7, 0.5 * a.opening), value(next, 0.7, -0.5 * b.opening)];
            worst[0] = worst[0].max((b.scale * high[0] - a.scale * low[0]).abs() / a.scale.max(b.scale));
            let [fa, fb] = [a.eta * a.scale, b.eta * b.scale];
            worst[0] = worst[0].max((fb * high[2] - fa * low[2]).abs() / fa.max(fb));
        }
        let step = 1e-4;
        for sector in 0..wedge.sectors.len() {
            let (r, z) = (0.7, 0.1);
            let around = value(sector, r + step, z)[0] + value(sector, r - step, z)[0];
            let across = value(sector, r, z + step / r)[0] + value(sector, r, z - step / r)[0];
            let [own, slope, _] = value(sector, r, z);
            let second = (around - 2.0 * own) / (step * step);
            let numeric = (value(sector, r + step, z)[0] - value(sector, r - step, z)[0]) / (2.0 * step);
            assert!((numeric - slope).abs() < 1e-6 * (1.0 + slope.abs()));
            worst[1] = worst[1].max((second + slope / r + (across - 2.0 * own) / (step * step)).abs());
        }
        worst
    }

    #[test]
    fn functions_are_harmonic_and_match() {
        for stiff in [1e-10, 0.2, 1.0, 30.0, 1e10] {
            let mut chip = wedge(&[(FRAC_PI_2, stiff), (1.5 * PI, 1.0)], None);
            if stiff > 1.0 {
                chip.sectors[0].scale = 1.0 / stiff;
            }
            for (power, count) in chip.exponents(4.2) {
                let functions = chip.functions(power, count);
                assert_eq!(functions.len(), count);
                for function in functions {
                    let [jump, laplacian] = misfit(&chip, &|s, r, z| function.at(s, r, z));
                    assert!(jump < 1e-11 && laplacian < 1e-5, "{stiff} {power}: {jump} {laplacian}");
                }
            }
        }
    }

    #[test]
    fn a_source_in_a_right_angle_has_a_logarithm() {
        // -lap u = 1 with u = 0 on both sides of a quadrant: the jumps are those of -r^2/4.
        let corner = wedge(&[(FRAC_PI_2, 1.0)], Some([End::Dirichlet; 2]));
        let data = RayData { ends: [0.25; 2], ..RayData::default() };
        let forced = corner.forced(2.0, &data).expect("solvable");
        assert!(forced.is_logarithmic());
        for side in [-0.5, 0.5] {
            assert!((forced.at(0, 0.3, side * FRAC_PI_2)[0] - 0.25 * 0.09).abs() < 1e-14);
        }
        let [_, laplacian] = misfit(&corner, &|s, r, z| forced.at(s, r, z));
        assert!(laplacian < 1e-5, "{laplacian}");
        // In a half-plane the solution is a polynomial.
        let wall = wedge(&[(PI, 1.0)], Some([End::Dirichlet; 2]));
        let forced = wall.forced(2.0, &data).expect("solvable");
        assert!(!forced.is_logarithmic());
    }

    #[test]
    fn two_values_that_meet_are_joined_by_the_angle() {
        let corner = wedge(&[(0.3, 2.0), (0.5, 1.0)], Some([End::Dirichlet; 2]));
        let data = RayData { ends: [1.0, 3.0], ..RayData::default() };
        let forced = corner.forced(0.0, &data).expect("solvable");
        assert!((forced.at(0, 0.2, -0.15)[0] - 1.0).abs() < 1e-14);
        assert!((forced.at(1, 0.7, 0.25)[0] - 3.0).abs() < 1e-14);
        let [jump, _] = misfit(&corner, &|s, r, z| forced.at(s, r, z));
        assert!(jump < 1e-13);
    }
}
