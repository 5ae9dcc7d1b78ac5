//! Corner functions in place of polynomials: which fits take them, and what they are there.
//!
//! Near a vertex where straight edges or circles of interfaces and boundaries meet, the polynomials of all parts of a stencil give way to one
//! set of functions `r^lambda Phi(theta)` that meets every condition there exactly, and to what the data add. Only values at nodes are
//! rows of such a fit. Along a straight edge in space the same functions come with powers of the coordinate along it. See
//! `docs/corners.md`.

use meshless_neighbors::CellList;

use super::basis::{Basis, Jet};
use super::params::{Form, SharpParams};
use super::particular::Particular;
use super::parts::Row;
use super::unknowns::Unknowns;
use crate::corners::{
    Corner, CornerData, Local, LocalSolution, Monomial, Obstacle, Scales, local_problems, rims,
    value_and_gradient,
};
use crate::{Field, Problem};

/// How far from a vertex fits take its functions: this many spacings for each degree of the polynomials that take over there.
const ZONE: f64 = 2.0;

/// Part of the clear distance round a vertex up to which fits may take its functions however wide a stencil is: beyond, most of its nodes
/// are where other things are.
const SHARE_OF_CLEAR: f64 = 0.5;

/// Exponents from here on leave so little that polynomials without a balance do.
const SEVERE: f64 = 2.0;

/// Where a zone is narrower than it should be, or round curved rays, what lies round it is balanced up to this many times as far as it should reach.
const BEYOND: f64 = 2.0;

/// How far from an edge in space all is balanced, in spacings: as far as a stencil sees it.
const BALANCED_BESIDE_EDGE: f64 = 3.0;

/// How near to the end of an edge, where that is a vertex, fits take its functions: farther from the end than this part of a stencil's
/// radius. Measured (`docs/corners.md`).
const BLIND: f64 = 0.25;

/// Exponents below this have fluxes that are too singular for a balance beside the vertex.
const LEAST_BALANCED: f64 = 0.4;

/// Nodes within the clear distance for each function.
const NODES_PER_FUNCTION: f64 = 1.5;

/// Nodes within the clear distance that have polynomials and no prescribed value, for each function: without them nothing holds the
/// functions, and the matrix is singular.
const HOLDING_NODES_PER_FUNCTION: f64 = 1.0;

/// The polynomial that stands for a source round a vertex has this many degrees more than those of a fit, up to the highest.
const SOURCE_DEGREES_BEYOND: usize = 4;
const HIGHEST_SOURCE_DEGREE: usize = 14;

/// Zones that are tried, over the widest one, until the data are polynomials to this part of their size; a smaller one has to be better
/// by a factor.
const SHARES_OF_ZONE: [f64; 4] = [1.0, 0.5, 0.25, 0.0];
const DATA_TOLERANCE: f64 = 1e-10;
const WORTH_LESS: f64 = 0.1;

/// Where the polynomial of a source is compared with it: at its samples, turned by a right angle and nearer by this factor.
const BETWEEN: f64 = 0.95;

/// Distance from a vertex, over the clear one, below which a node is there.
const AT_VERTEX: f64 = 1e-9;

/// Least cosine of the angle between an edge and the normal of a face that ends it.
const ACROSS: f64 = 0.5;

/// Where the part of a sector is looked for, over the clear distance.
const INSIDE: f64 = 0.25;

/// A vertex with the functions that serve it.
#[derive(Debug)]
pub(super) struct Vertex {
    local: Local,
    solution: LocalSolution,
    scales: Scales,
    /// The columns of a fit.
    terms: Vec<Term>,
    /// The polynomial of a source of 1, in every sector.
    units: Vec<Vec<Monomial>>,
    /// Part of every sector.
    parts: Vec<u32>,
    /// How far from it fits take its functions even where they do not see it.
    zone: f64,
    held: bool,
    /// Its functions leave much beyond the zone, which is narrower than it should be, as other singular points are near, or in which
    /// what makes circles straight stretches distances.
    narrow: bool,
    /// Two prescribed values meet: a value right there says nothing.
    ambiguous: bool,
}

/// A column: a function of the vertex, or the constant, times `sum_j factors_j r^(2j) z^(power-2j)` along an edge.
#[derive(Debug)]
struct Term {
    function: Option<usize>,
    power: usize,
    factors: Vec<f64>,
}

/// A vertex, or an edge, that polynomials have to do for, and up to which distance.
#[derive(Debug)]
struct Unserved {
    local: Local,
    distance: f64,
}

/// All vertices that are served, and what is known of those that are not.
#[derive(Debug, Default)]
pub(super) struct Vertices {
    served: Vec<Vertex>,
    unserved: Vec<Unserved>,
    /// Every vertex whose solution is no polynomial.
    pub(super) corners: Vec<Corner>,
}

/// A value with its gradient.
pub(super) type Valued<const D: usize> = (f64, [f64; D]);

impl Vertices {
    /// Finds the vertices of a problem and the functions of those that can have them.
    pub(super) fn find<const D: usize>(
        problem: &Problem<'_, D>,
        params: &SharpParams,
        unknowns: &Unknowns,
        nodes: &CellList<'_, D>,
    ) -> Self {
        let degree = params.degree();
        let mut all = Self::default();
        let mut source = SourcePolynomials {
            degree: (degree + SOURCE_DEGREES_BEYOND).min(HIGHEST_SOURCE_DEGREE),
            made: None,
        };
        let data = CornerData::from(problem);
        let known = problem.dirichlet();
        for local in local_problems(&data, degree as f64 + AT_VERTEX) {
            let nearest = nodes.nearest_one(&local.in_space(local.at));
            let spacing = nearest.map_or(0.0, |j| problem.cloud.spacing()[j as usize]);
            let wanted = ZONE * degree as f64 * spacing;
            match Vertex::new(problem, params, unknowns, nodes, local.clone(), &known, &mut source) {
                Ok(mut vertex) => {
                    if let Some(power) =
                        local.broken_by(&vertex.solution).filter(|p| *p < params.order as f64)
                    {
                        if vertex.is_edge() {
                            // Where an edge ends its functions are not those of the solution.
                            let distance = BALANCED_BESIDE_EDGE * spacing;
                            all.unserved.push(Unserved { local: local.clone(), distance });
                        } else if (vertex.zone < wanted || !local.is_straight()) && power < SEVERE {
                            all.unserved.push(Unserved { local: local.clone(), distance: BEYOND * wanted });
                            vertex.narrow = power >= LEAST_BALANCED && !vertex.ambiguous;
                        }
                        all.corners.push(local.corner(power, None));
                        all.served.push(vertex);
                    }
                }
                Err(obstacle) => {
                    let power = crate::corners::broken_power(&data, &local, params.order);
                    if power.is_some_and(|power| power < SEVERE) {
                        let is_edge = local.along.is_some();
                        let distance = if is_edge { BALANCED_BESIDE_EDGE * spacing } else { wanted };
                        all.unserved.push(Unserved { local: local.clone(), distance });
                    }
                    all.corners.extend(power.map(|power| local.corner(power, Some(obstacle))));
                }
            }
        }
        all.corners.extend(rims(&data, params.order));
        all
    }

    /// Whether polynomials round a point are those of a fit near a singular solution that no functions serve: what they leave is to be
    /// balanced at least.
    pub(super) fn leaves_much<const D: usize>(&self, x: &[f64; D]) -> bool {
        self.unserved.iter().any(|near| near.local.distance(x) < near.distance)
    }

    /// The vertex whose functions a fit round a point takes, wherever its nodes are.
    pub(super) fn near<const D: usize>(&self, x: &[f64; D]) -> Option<usize> {
        self.nearest(x).filter(|&(k, distance)| distance < self.served[k].zone).map(|(k, _)| k)
    }

    /// The vertex that a stencil of this radius round a point contains.
    pub(super) fn within<const D: usize>(&self, x: &[f64; D], radius: f64) -> Option<usize> {
        self.nearest(x)
            .filter(|&(k, distance)| {
                let local = &self.served[k].local;
                let blind = (BLIND * radius, radius);
                distance <= radius && distance < local.clear && local.is_amid(x, blind)
            })
            .map(|(k, _)| k)
    }

    fn nearest<const D: usize>(&self, x: &[f64; D]) -> Option<(usize, f64)> {
        let distances = self.served.iter().enumerate().map(|(k, vertex)| (k, vertex.distance(x)));
        distances.min_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Distance of a point from the nearest vertex with functions of its own.
    pub(super) fn distance<const D: usize>(&self, x: &[f64; D]) -> f64 {
        self.nearest(x).map_or(f64::INFINITY, |(_, distance)| distance)
    }

    /// Whether a point is a vertex with functions of its own.
    pub(super) fn is_one_at(&self, x: &[f64; 2]) -> bool {
        self.served.iter().any(|vertex| vertex.distance(x) <= AT_VERTEX * vertex.local.clear)
    }

    pub(super) fn get(&self, k: usize) -> &Vertex {
        &self.served[k]
    }
}

/// Polynomials with given Laplacians, made where the first source wants one.
struct SourcePolynomials {
    degree: usize,
    made: Option<Particular<2>>,
}

impl SourcePolynomials {
    /// The polynomial whose Laplacian is `response` times a source, in the coordinates from a point over a radius.
    fn of<const D: usize>(
        &mut self,
        source: Option<&Field<D>>,
        (local, radius): (&Local, f64),
        response: f64,
    ) -> Result<(Vec<Monomial>, f64), Obstacle> {
        let Some(field) = source else { return Ok((Vec::new(), 0.0)) };
        if let Some(f) = field.as_constant() {
            return Ok((square(0.25 * response * f), 0.0));
        }
        let made = self.made.get_or_insert_with(|| Particular::new(self.degree));
        let at = local.at;
        let place = |z: &[f64; 2]| local.in_space([at[0] + radius * z[0], at[1] + radius * z[1]]);
        let points: Vec<[f64; D]> = made.samples.iter().map(place).collect();
        let mut values = vec![0.0; points.len()];
        field.eval(&points, &mut values);
        if !values.iter().all(|f| f.is_finite()) {
            return Err(Obstacle::Data);
        }
        values.iter_mut().for_each(|f| *f *= response);
        let mut factors = Vec::new();
        made.solve(&values, &mut factors);
        let Basis::Complete { exponents, .. } = &made.basis else { return Err(Obstacle::Data) };
        // The Laplacian between the samples.
        let (mut jet, mut error) = (Jet::default(), 0.0_f64);
        for z in made.samples.iter().map(|[x, y]| [BETWEEN * y, -BETWEEN * x]) {
            made.basis.evaluate(&z, &mut jet);
            let laplacian: f64 = factors.iter().zip(&jet.laplacians).map(|(c, l)| c * l).sum();
            let f = response * field.at(&place(&z));
            error = error.max((laplacian - f).abs());
        }
        if !error.is_finite() {
            return Err(Obstacle::Data);
        }
        Ok((exponents.iter().copied().zip(factors).collect(), error))
    }
}

/// `factor |x|^2`.
fn square(factor: f64) -> Vec<Monomial> {
    vec![([2, 0], factor), ([0, 2], factor)]
}

impl Vertex {
    fn new<const D: usize>(
        problem: &Problem<'_, D>,
        params: &SharpParams,
        unknowns: &Unknowns,
        nodes: &CellList<'_, D>,
        local: Local,
        known: &[Option<f64>],
        source: &mut SourcePolynomials,
    ) -> Result<Self, Obstacle> {
        if params.unsteady || params.form != Form::Trefftz || problem.has_lower_terms() {
            return Err(Obstacle::Method);
        }
        if let Some(obstacle) = local.obstacle {
            return Err(obstacle);
        }
        let at: [f64; D] = local.in_space(local.at);
        let terms = terms(&local, params.degree());
        let functions = terms.len() + usize::from(local.wedge.is_held());
        let mut found = Vec::new();
        nodes.within(&at, local.clear, &mut found);
        if (found.len() as f64) < NODES_PER_FUNCTION * functions as f64 {
            return Err(Obstacle::Spacing);
        }
        // The part of a sector is that of the node of its region nearest to its middle.
        let parts: Option<Vec<u32>> = (0..local.labels.len())
            .map(|k| {
                let middle: [f64; D] = local.in_space(local.inside(k, INSIDE * local.clear));
                let of_label = |j: &&u32| problem.labels[**j as usize] == local.labels[k];
                let in_sector = |j: &&u32| {
                    let x = &problem.cloud.points()[**j as usize];
                    local.place(&local.coordinates(x).0, |s| s == k).0 == k
                };
                let squared = |j: &u32| {
                    let x = &problem.cloud.points()[*j as usize];
                    (0..D).map(|d| (x[d] - middle[d]).powi(2)).sum::<f64>()
                };
                let own = found.iter().filter(of_label).filter(in_sector);
                own.min_by(|a, b| squared(a).total_cmp(&squared(b)).then(a.cmp(b)))
                    .map(|&j| unknowns.part[j as usize])
            })
            .collect();
        let parts = parts.ok_or(Obstacle::Spacing)?;
        let spacing = nodes.nearest_one(&at).map_or(local.clear, |j| problem.cloud.spacing()[j as usize]);
        let stencil = radius_of_ball::<D>(params.stencil_nodes(D)) * spacing;
        if local.length_an_end() < stencil {
            return Err(Obstacle::Spacing);
        }
        let widest = (local.clear - stencil).max(SHARE_OF_CLEAR * local.clear);
        // Along an edge nothing is gained where a stencil does not see it.
        let is_edge = local.along.is_some();
        let widest = if is_edge { 0.0 } else { (ZONE * params.degree() as f64 * spacing).min(widest) };
        let of_part = |of: &[f64]| parts.iter().map(|&part| of[part as usize]).collect::<Vec<f64>>();
        let (scale, offset) = (of_part(&unknowns.scale), of_part(&unknowns.offset));
        // Where data are no polynomials over the whole zone, a smaller one is better.
        let mut best: Option<(f64, Scales, LocalSolution)> = None;
        for share in SHARES_OF_ZONE {
            let zone = share * widest;
            let radius = (zone + 2.0 * stencil).min(local.clear);
            let sources = (0..parts.len())
                .map(|k| {
                    let field = problem.materials[local.labels[k] as usize].source.as_ref();
                    let response = -radius * radius / (local.wedge.sectors[k].eta * scale[k]);
                    source.of(field, (&local, radius), response)
                })
                .collect::<Result<Vec<_>, _>>()?;
            let (sources, errors): (Vec<_>, Vec<f64>) = sources.into_iter().unzip();
            let doubt = errors.into_iter().fold(0.0, f64::max);
            let mut scales = Scales { scale: scale.clone(), offset: offset.clone(), radius, sources, doubt };
            let solution = local.solve(&CornerData::from(problem), &mut scales, params.degree())?;
            let better = best.as_ref().is_none_or(|(.., known)| solution.doubt < WORTH_LESS * known.doubt);
            if better {
                best = Some((zone, scales, solution));
            }
            if best.as_ref().is_some_and(|(.., known)| known.doubt <= known.size() * DATA_TOLERANCE) {
                break;
            }
        }
        let (zone, scales, solution) = best.ok_or(Obstacle::Data)?;
        let response = |k: usize| -scales.radius * scales.radius / (local.wedge.sectors[k].eta * scale[k]);
        let units = (0..parts.len()).map(|k| square(0.25 * response(k))).collect();
        let (held, ambiguous) = (local.wedge.is_held(), solution.value_depends_on_direction());
        // Nodes that take the functions say of each other that these solve their rows, whatever the factors: others have to hold them.
        let mut near = Vec::new();
        let mut holds = |&&j: &&u32| {
            let x = &problem.cloud.points()[j as usize];
            let away = local.distance(x);
            known[j as usize].is_none() && away >= zone && {
                let seen = nodes.nearest(x, params.stencil_nodes(D), &mut near).last();
                seen.is_some_and(|last| {
                    let last = &problem.cloud.points()[last as usize];
                    (0..D).map(|k| (last[k] - x[k]).powi(2)).sum::<f64>() < away * away
                })
            }
        };
        let enough = (HOLDING_NODES_PER_FUNCTION * functions as f64).ceil() as usize;
        if found.iter().filter(&mut holds).take(enough).count() < enough {
            return Err(Obstacle::Spacing);
        }
        Ok(Self { local, solution, scales, terms, units, parts, zone, held, narrow: false, ambiguous })
    }

    /// Whether its functions alone do not conserve heat, and fluxes beside it can be integrated.
    pub(super) fn is_narrow(&self) -> bool {
        self.narrow
    }

    /// How far a point is away.
    pub(super) fn distance<const D: usize>(&self, x: &[f64; D]) -> f64 {
        self.local.distance(x)
    }

    /// Whether a point of a part is so near that nothing but the rays of the vertex is between.
    pub(super) fn reaches<const D: usize>(&self, x: &[f64; D], part: u32) -> bool {
        self.distance(x) <= self.local.clear && {
            self.local.along.is_none() || {
                let (across, _) = self.local.coordinates(x);
                let (sector, ..) = self.local.place(&across, |k| self.parts[k] == part);
                self.parts[sector] == part
            }
        }
    }

    /// Whether a face of the boundary with this normal ends the edge: the functions know nothing of what holds there.
    pub(super) fn is_ended_by<const D: usize>(&self, normal: &[f64; D]) -> bool {
        self.local.along.is_some() && {
            let axis: [f64; D] = self.local.frame.vector([0.0; 2], 1.0);
            (0..D).map(|k| axis[k] * normal[k]).sum::<f64>().abs() > ACROSS
        }
    }

    /// Whether it is an edge in space.
    pub(super) fn is_edge(&self) -> bool {
        self.local.along.is_some()
    }

    /// Whether a value at a point says something.
    pub(super) fn is_told_by<const D: usize>(&self, x: &[f64; D]) -> bool {
        !self.ambiguous || self.distance(x) > AT_VERTEX * self.local.clear
    }

    /// Whether u is prescribed on a boundary that meets there, so that nothing is left of the constant.
    pub(super) fn is_held(&self) -> bool {
        self.held
    }

    /// Columns of a fit.
    pub(super) fn columns(&self) -> usize {
        self.terms.len()
    }

    /// Writes values and gradients of the functions at a point of a part, for distances in units of `reach` and places along an edge from
    /// that of `center`; the constant, where there is one, is `constant`. Returns what the data and the sources add, and what a source of 1
    /// does.
    pub(super) fn evaluate<const D: usize>(
        &self,
        part: u32,
        (x, center): (&[f64; D], &[f64; D]),
        (reach, constant): (f64, f64),
        jet: &mut Jet<D>,
    ) -> [Valued<D>; 2] {
        let frame = &self.local.frame;
        let ((across, along), (_, middle_along)) =
            (self.local.coordinates(x), self.local.coordinates(center));
        let along = (along - middle_along) / reach;
        let (sector, r, z) = self.local.place(&across, |k| self.parts[k] == part);
        let (sin, cos) = (self.local.middle(sector) + z).sin_cos();
        let cartesian = |[radial, around, along]: [f64; 3], unit: f64| -> [f64; D] {
            let straight = [radial * cos - around * sin, radial * sin + around * cos];
            frame.vector(self.local.gradient(&across, straight).map(|slope| slope / unit), along / unit)
        };
        jet.values.clear();
        jet.gradients.clear();
        for Term { function, power, factors } in &self.terms {
            let [value, radial, around] = match function {
                None => [constant, 0.0, 0.0],
                Some(k) => self.solution.functions[*k].at(sector, r / reach, z),
            };
            let [by, by_radial, by_along] = along_edge(*power, factors, r / reach, along);
            jet.values.push(value * by);
            jet.gradients
                .push(cartesian([radial * by + value * by_radial, around * by, value * by_along], reach));
        }
        let radius = self.scales.radius;
        let mut given = [(0.0, [0.0; D]); 2];
        let forced =
            self.solution.forced.iter().map(|f| (0, f)).chain(self.solution.unit.iter().map(|f| (1, f)));
        for (which, function) in forced {
            let [value, radial, around] = function.at(sector, r / radius, z);
            given[which].0 += value;
            let slope = cartesian([radial, around, 0.0], radius);
            given[which].1.iter_mut().zip(slope).for_each(|(sum, s)| *sum += s);
        }
        let xi = self.local.relative(&across).map(|x| x / radius);
        for (which, polynomial) in [&self.scales.sources[sector], &self.units[sector]].into_iter().enumerate()
        {
            let (value, slope) = value_and_gradient(polynomial, xi);
            given[which].0 += value;
            let slope: [f64; D] = frame.vector(slope.map(|slope| slope / radius), 0.0);
            given[which].1.iter_mut().zip(slope).for_each(|(sum, s)| *sum += s);
        }
        given
    }
}

/// The columns of fits of a degree: in the plane the constant, unless u is prescribed, and all functions; along an edge the same with all
/// powers that the degree leaves.
fn terms(local: &Local, degree: usize) -> Vec<Term> {
    let powers = local.exponents.iter().flat_map(|&(power, count)| vec![power; count]);
    let constant = (!local.wedge.is_held()).then_some((None, 0.0));
    let functions = constant.into_iter().chain(powers.enumerate().map(|(k, power)| (Some(k), power)));
    if local.along.is_none() {
        return functions.map(|(function, _)| Term { function, power: 0, factors: vec![1.0] }).collect();
    }
    // In a narrow wedge there are few up to the degree: then as many as there are harmonic polynomials.
    let most = (degree as f64).max(local.wedge.exponent_of(2.0 * degree as f64 + 1.0)) + AT_VERTEX;
    let of_function = |(function, lambda): (Option<usize>, f64)| {
        (0..=(most - lambda).max(0.0) as usize)
            .map(move |power| (lambda + power as f64, function, lambda, power))
    };
    let mut all: Vec<_> = functions.flat_map(of_function).collect();
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    let within_degree = all.iter().filter(|term| term.0 <= degree as f64 + AT_VERTEX).count();
    all.truncate(within_degree.max((degree + 1).pow(2)));
    let term =
        |(_, function, lambda, power)| Term { function, power, factors: harmonic_factors(lambda, power) };
    all.into_iter().map(term).collect()
}

/// Factors of `r^(2j) z^(k-2j)` that make `r^lambda Phi(theta) z^k` harmonic: `c_0 = 1`,
/// `c_(j+1) = -c_j (k-2j)(k-2j-1) / (4 (j+1)(lambda+j+1))`.
fn harmonic_factors(lambda: f64, power: usize) -> Vec<f64> {
    let mut factors = vec![1.0];
    for j in 0..power / 2 {
        let left = (power - 2 * j) as f64;
        let step = left * (left - 1.0) / (4.0 * (j + 1) as f64 * (lambda + (j + 1) as f64));
        factors.push(-step * factors[j]);
    }
    factors
}

/// `sum_j factors_j r^(2j) z^(k-2j)` with its derivatives in r and z.
fn along_edge(power: usize, factors: &[f64], r: f64, z: f64) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for (j, factor) in factors.iter().enumerate() {
        let (of_r, of_z) = (2 * j as i32, (power - 2 * j) as i32);
        let (in_r, in_z) = (r.powi(of_r), z.powi(of_z));
        sum[0] += factor * in_r * in_z;
        if of_r > 0 {
            sum[1] += factor * f64::from(of_r) * r.powi(of_r - 1) * in_z;
        }
        if of_z > 0 {
            sum[2] += factor * in_r * f64::from(of_z) * z.powi(of_z - 1);
        }
    }
    sum
}

/// Radius, in spacings, of a disc or ball of so many nodes.
fn radius_of_ball<const D: usize>(nodes: usize) -> f64 {
    let each = nodes as f64 / std::f64::consts::PI;
    if D == 3 { (0.75 * each).cbrt() } else { each.sqrt() }
}

/// A functional of the polynomial in z of what [`Vertex::evaluate`] returns, for a stencil of this radius.
pub(super) fn apply<const D: usize>(functional: &Row<D>, (value, gradient): &Valued<D>, radius: f64) -> f64 {
    let slope: f64 = (0..D).map(|k| functional.gradient[k] * gradient[k]).sum();
    functional.value * value + radius * slope
}

#[cfg(test)]
mod tests {
    use super::{along_edge, harmonic_factors};

    /// `r^lambda cos(lambda t) sum_j c_j r^(2j) z^(k-2j)`, its Laplacian by differences, and its derivatives in r and z.
    #[test]
    fn functions_along_an_edge_are_harmonic() {
        for lambda in [0.0, 0.4, 0.73, 1.0, 2.5] {
            for power in 0..7 {
                let factors = harmonic_factors(lambda, power);
                let at = |x: [f64; 3]| {
                    let (r, t) = (x[0].hypot(x[1]), x[1].atan2(x[0]));
                    r.powf(lambda) * (lambda * t).cos() * along_edge(power, &factors, r, x[2])[0]
                };
                let (x, step) = ([0.6, 0.3, 0.4], 1e-3);
                let moved =
                    |axis: usize, by: f64| std::array::from_fn(|k| if k == axis { x[k] + by } else { x[k] });
                let second =
                    |k: usize| (at(moved(k, step)) + at(moved(k, -step)) - 2.0 * at(x)) / (step * step);
                let laplacian: f64 = (0..3).map(second).sum();
                assert!(laplacian.abs() < 1e-4, "{lambda} {power}: {laplacian}");
                let (r, z) = (0.7, 0.4);
                let [_, in_r, in_z] = along_edge(power, &factors, r, z);
                let of = |r: f64, z: f64| along_edge(power, &factors, r, z)[0];
                assert!((in_r - (of(r + step, z) - of(r - step, z)) / (2.0 * step)).abs() < 1e-5);
                assert!((in_z - (of(r, z + step) - of(r, z - step)) / (2.0 * step)).abs() < 1e-5);
            }
        }
    }
}
