//! The solution of a local problem: its functions, the polynomials that its data are along the rays, and what these add.

use nalgebra::{DMatrix, DVector};

use super::CornerData;
use super::local::{Local, Obstacle};
use super::wedge::{End, Forced, Harmonic, RayData, Wedge};
use crate::Condition;
use crate::equation::between;

/// Polynomials along rays that stand for data there have this many degrees more than those of a fit, up to the highest.
const DEGREES_BEYOND: usize = 4;
const HIGHEST_DEGREE: usize = 14;

/// Logarithms that stand with this power or a higher one do not count at edges in space.
const WEAK: f64 = 2.0;

/// Part of the largest coefficient of data below which one is rounding.
const ROUNDING: f64 = 1e-12;

/// Part of the data that polynomials may miss and count as meeting them: rounding of polynomials of degree 14.
const MET: f64 = 1e-10;

/// Part of what the source and the data do at a vertex below which a logarithm or a function of the angle is rounding, or the error
/// of the polynomials that stand for the data.
const NEGLIGIBLE: f64 = 1e-7;

/// Errors of the polynomials that stand for the data may be so many times as large as between the points where they are known.
const DOUBTFUL: f64 = 10.0;

/// How near to a vertex a source is told there, over the length of its shortest ray, and the part of it farther away below which it
/// vanishes.
const AT_VERTEX: f64 = 1e-9;
const VANISHING: f64 = 1e-6;

/// How far along the rays data are looked at to tell what they do at the vertex, over their length.
const NEAR: f64 = 0.25;

/// A monomial of a polynomial in the coordinates from a vertex: exponents, factor.
pub(crate) type Monomial = ([u8; 2], f64);

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
    /// The smallest power at which a solution is no polynomial in the sectors. Logarithms count in the plane only: in space they are at
    /// every edge of a heated box, and as weak as `r^2 ln r`.
    pub(crate) fn broken_by(&self, solution: &LocalSolution) -> Option<f64> {
        let exponent = self.broken_exponent();
        let power = solution.broken_power(exponent);
        if self.along.is_some() && power.is_some_and(|power| power >= WEAK) { exponent } else { power }
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
