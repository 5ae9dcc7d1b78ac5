//! The polynomials of a stencil, one a part of a region: their bases, columns and particular parts.

use super::adapted::{self, LowerTerms};
use super::basis::{Basis, Jet};
use super::dense;
use super::maker::Maker;
use super::params::{Conservation, Form};
use super::stencil::Stencil;
use super::vertex::{self, Valued};
use crate::{Field, Material};

/// What a row does to a polynomial in z: factors of its value, its gradient and its Laplacian.
#[derive(Debug, Clone, Copy)]
pub(super) struct Row<const D: usize> {
    pub(super) value: f64,
    pub(super) gradient: [f64; D],
    pub(super) laplacian: f64,
}

impl<const D: usize> Row<D> {
    pub(super) fn of_value(value: f64) -> Self {
        Self { value, gradient: [0.0; D], laplacian: 0.0 }
    }

    pub(super) fn of_slope(axis: usize) -> Self {
        Self { gradient: std::array::from_fn(|k| f64::from(k == axis)), ..Self::of_value(0.0) }
    }

    /// The functional times a factor.
    pub(super) fn times(&self, factor: f64) -> Self {
        Self {
            value: factor * self.value,
            gradient: self.gradient.map(|g| factor * g),
            laplacian: factor * self.laplacian,
        }
    }

    pub(super) fn is_value(&self) -> bool {
        self.laplacian == 0.0 && self.gradient == [0.0; D]
    }

    /// Applied to member m of what a jet holds.
    pub(super) fn apply(&self, jet: &Jet<D>, m: usize) -> f64 {
        let slope: f64 = (0..D).map(|k| self.gradient[k] * jet.gradients[m][k]).sum();
        let mut sum = self.value * jet.values[m] + slope;
        if self.laplacian != 0.0 {
            sum += self.laplacian * jet.laplacians[m];
        }
        sum
    }
}

/// The particular part of a harmonic polynomial.
#[derive(Debug, Clone)]
enum Source {
    /// There is no source.
    None,
    /// The same source everywhere: `-f |z|^2 R^2 / (2 D eta s)`.
    Constant(f64),
    /// Coefficients of monomials.
    Fitted(Vec<f64>),
}

/// How the equation enters the polynomial of a part.
#[derive(Debug, Clone, Default)]
enum Equation {
    /// As rows.
    #[default]
    Rows,
    /// The diffusivity is constant: harmonic polynomials and a particular part.
    Harmonic {
        source: Source,
        /// `-R^2 / (2 D eta s)`: the particular part of a source of 1 over `|z|^2`.
        unit: f64,
    },
    /// The equation is more than the Laplacian: coefficients of what each harmonic polynomial lacks to solve it, of the particular part of
    /// the source, of that of a source of 1, and in time of those of rates that are monomials.
    Adapted(Vec<f64>),
    /// The functions of a vertex, which all parts have in common.
    Vertex,
}

/// The polynomial of one part.
#[derive(Debug, Clone, Default)]
struct Part {
    equation: Equation,
    /// What the values of the part are multiplied by in this stencil, `w' = omega w`: less than 1 where it is softer than the own part.
    omega: f64,
    /// The scale of the unknown in its place, `s' = s / omega`.
    scale: f64,
    /// Weight of the values of the part where its unknown is left as it is.
    loudness: f64,
    first_column: usize,
    /// One more column: a source that is constant, and not known.
    open: bool,
}

/// Whether a part is less conductive than that of the center. In time the rows of the center then leave du/dt in it open: their
/// answer to it would have any sign and be as large as that to their own, and modes of stiff parts would grow by
/// themselves. (The other way round it is what ties the flux to the softer side.)
fn is_softer<const D: usize>(maker: &Maker<'_, D>, stencil: &Stencil<D>, place: usize) -> bool {
    let eta = |place: usize| {
        let node = stencil.part_of.iter().position(|&p| p == place)?;
        Some(maker.problem.eta[stencil.nodes[node] as usize])
    };
    place > 0 && eta(place).zip(eta(0)).is_some_and(|(other, own)| other < own)
}

/// `(eta s)` of a part over that of the center's, where it is less: the units in which a fit sees it.
///
/// Where a soft part holds a source, its values are of the size `f / eta`, and what a polynomial misses of them would be weighed against
/// the values of the stiff part. A stiff part wants nothing of a soft one but its flux. So a target in a stiff part sees the values
/// of softer ones in units of the flux, and one in a soft part sees those of stiffer ones as they are. In time, rows choose what they hear
/// by themselves ([`Heard`](super::stencil::Heard)). In space without balances, which close what such fits leave, all parts are seen as
/// they are: a ball of contrast 100 would have four times the error.
fn omega<const D: usize>(maker: &Maker<'_, D>, stencil: &Stencil<D>, place: usize) -> f64 {
    let unbalanced = D == 3 && maker.params.conservation == Conservation::None;
    if place == 0 || unbalanced || maker.rates.is_some() {
        return 1.0;
    }
    // The diffusivity may vary in a part: that at its node nearest to the center stands for it.
    let level = |place: usize| {
        let node = stencil.part_of.iter().position(|&p| p == place)?;
        let scale = maker.unknowns.scale[stencil.parts[place] as usize];
        Some(maker.problem.eta[stencil.nodes[node] as usize] * scale)
    };
    level(place).zip(level(0)).map_or(1.0, |(other, own)| (other / own).min(1.0))
}

fn evaluate_monomials<const D: usize>(basis: &Basis<D>, z: &[f64; D], slopes: bool, jet: &mut Jet<D>) {
    if slopes {
        basis.evaluate(z, jet);
    } else {
        basis.evaluate_values(z, jet);
    }
}

/// How the functions of a vertex enter a stencil.
#[derive(Debug, Clone)]
struct AtVertex<const D: usize> {
    /// Which one.
    vertex: usize,
    /// The parts of the stencil.
    parts: Vec<u32>,
    center: [f64; D],
    radius: f64,
    /// Distance of the farthest node from the vertex.
    reach: f64,
    /// The place of the part whose constant the others are told from, that of the smallest scale; `None` where u is prescribed at
    /// the vertex.
    reference: Option<usize>,
    /// What the data add at the point that was evaluated last, and what a source of 1 does.
    given: [Valued<D>; 2],
}

/// The polynomials of a stencil.
#[derive(Debug, Default)]
pub(super) struct Parts<const D: usize> {
    at_vertex: Option<AtVertex<D>>,
    parts: Vec<Part>,
    columns: usize,
    /// Harmonic polynomials of a fit.
    functions: usize,
    pub(super) jet: Jet<D>,
    /// Monomials of particular parts at the point that was evaluated last, and the point.
    particular: Jet<D>,
    z: Vec<f64>,
    samples: Vec<[f64; D]>,
    values: Vec<f64>,
    eta: Vec<f64>,
    unit: Vec<f64>,
    adapted: adapted::Scratch,
}

impl<const D: usize> Parts<D> {
    /// Chooses the form of every part of a stencil and makes what solves its equation.
    pub(super) fn prepare(&mut self, maker: &Maker<'_, D>, stencil: &Stencil<D>) {
        self.parts.resize_with(stencil.parts.len(), Part::default);
        self.columns = 0;
        self.functions = maker.harmonic_basis.len();
        self.at_vertex = None;
        if let Some(vertex) = stencil.vertex {
            return self.prepare_at_vertex(maker, stencil, vertex);
        }
        for place in 0..stencil.parts.len() {
            let part = stencil.parts[place] as usize;
            let material = &maker.problem.materials[maker.unknowns.label[part] as usize];
            let omega = omega(maker, stencil, place);
            let scale = maker.unknowns.scale[part] / omega;
            let response = -stencil.radius * stencil.radius / scale;
            // Where diffusivity or source are no numbers somewhere near, rows see them at nodes of their own region only.
            let solved = match (maker.params.form, material.diffusivity.as_constant()) {
                (Form::General, _) => None,
                (Form::Trefftz, Some(eta)) if !material.has_lower_terms() => {
                    self.harmonic(maker, stencil, material, response / eta)
                }
                (Form::Trefftz, _) => self.adapted(maker, stencil, material, response),
            };
            let first_column = self.columns;
            let basis = if solved.is_some() { &maker.harmonic_basis } else { &maker.complete_basis };
            let open = maker.rates.is_some() && is_softer(maker, stencil, place);
            self.columns += basis.len() + usize::from(open);
            self.parts[place] = Part {
                equation: solved.unwrap_or_default(),
                omega,
                loudness: 1.0,
                scale,
                first_column,
                open,
            };
        }
    }

    fn prepare_at_vertex(&mut self, maker: &Maker<'_, D>, stencil: &Stencil<D>, vertex: usize) {
        let functions = maker.vertices.get(vertex);
        for place in 0..stencil.parts.len() {
            let (loudness, scale) =
                (omega(maker, stencil, place), maker.unknowns.scale[stencil.parts[place] as usize]);
            self.parts[place] =
                Part { equation: Equation::Vertex, omega: 1.0, loudness, scale, ..Part::default() };
        }
        self.columns = functions.columns();
        let points = maker.problem.cloud.points();
        let reach =
            stencil.nodes.iter().fold(0.0_f64, |m, &j| m.max(functions.distance(&points[j as usize])));
        let scale = |place: usize| maker.unknowns.scale[stencil.parts[place] as usize];
        let softest_first =
            (0..stencil.parts.len()).min_by(|&a, &b| scale(a).total_cmp(&scale(b)).then(a.cmp(&b)));
        let reference = softest_first.filter(|_| !functions.is_held());
        let given = [(0.0, [0.0; D]); 2];
        let (center, radius, parts) = (stencil.center, stencil.radius, stencil.parts.clone());
        self.at_vertex = Some(AtVertex { vertex, parts, center, radius, reach, reference, given });
    }

    /// What constants of parts add to the polynomial of one, which stand beside the functions of a vertex: the place of the part that is
    /// added, that of the one that is taken away, the factor of their difference.
    pub(super) fn constants_beside(
        &self,
        maker: &Maker<'_, D>,
        part: usize,
    ) -> Option<(usize, Option<usize>, f64)> {
        let AtVertex { reference, parts, .. } = self.at_vertex.as_ref()?;
        let scale = maker.unknowns.scale[parts[part] as usize];
        // `c_reference + s_reference W = c + s w`, or the prescribed value in place of the left side.
        (*reference != Some(part)).then_some((part, *reference, -1.0 / scale))
    }

    /// The place of the part whose constant stands beside the polynomial of one where u is asked for; `None` where no constant does.
    pub(super) fn constant_of(&self, part: usize) -> Option<usize> {
        match &self.at_vertex {
            Some(at) => at.reference,
            None => Some(part),
        }
    }

    /// Writes a field at samples of the stencil's ball to `values`; `None` where it is not a number somewhere.
    fn sample(
        &mut self,
        stencil: &Stencil<D>,
        samples: &[[f64; D]],
        field: &Field<D>,
        values: &mut Vec<f64>,
    ) -> Option<()> {
        let center = &stencil.center;
        let place = |z: &[f64; D]| std::array::from_fn(|k| center[k] + stencil.radius * z[k]);
        self.samples.clear();
        self.samples.extend(samples.iter().map(place));
        values.resize(samples.len(), 0.0);
        field.eval(&self.samples, values);
        values.iter().all(|f| f.is_finite()).then_some(())
    }

    fn harmonic(
        &mut self,
        maker: &Maker<'_, D>,
        stencil: &Stencil<D>,
        material: &Material<D>,
        response: f64,
    ) -> Option<Equation> {
        let unit = response / (2 * D) as f64;
        let field = match &material.source {
            None => return Some(Equation::Harmonic { source: Source::None, unit }),
            Some(field) => field,
        };
        if let Some(f) = field.as_constant() {
            return Some(Equation::Harmonic { source: Source::Constant(f), unit });
        }
        let particular = maker.particular.as_ref()?;
        let mut values = std::mem::take(&mut self.values);
        let finite = self.sample(stencil, &particular.samples, field, &mut values);
        let mut coefficients = Vec::new();
        if finite.is_some() {
            values.iter_mut().for_each(|f| *f *= response);
            particular.solve(&values, &mut coefficients);
        }
        self.values = values;
        finite.map(|()| Equation::Harmonic { source: Source::Fitted(coefficients), unit })
    }

    fn adapted(
        &mut self,
        maker: &Maker<'_, D>,
        stencil: &Stencil<D>,
        material: &Material<D>,
        response: f64,
    ) -> Option<Equation> {
        let adapted = maker.adapted.as_ref()?;
        let [mut eta, mut values] = [&mut self.eta, &mut self.values].map(std::mem::take);
        let mut finite = self.sample(stencil, &adapted.samples, &material.diffusivity, &mut eta);
        self.unit.clear();
        self.unit.extend(eta.iter().map(|eta| response / eta));
        match &material.source {
            Some(field) => {
                finite = finite.and(self.sample(stencil, &adapted.samples, field, &mut values));
                values.iter_mut().zip(&self.unit).for_each(|(f, unit)| *f *= unit);
            }
            None => {
                values.clear();
                values.resize(eta.len(), 0.0);
            }
        }
        let mut sources = vec![values, self.unit.clone()];
        if let Some(rates) = &maker.rates {
            // A rate is a source of the opposite sign.
            sources.extend(rates.monomials(&adapted.samples).into_iter().map(|mut monomial: Vec<f64>| {
                monomial.iter_mut().zip(&self.unit).for_each(|(value, unit)| *value *= -unit);
                monomial
            }));
        }
        let lower = finite.and_then(|()| self.lower_terms(stencil, &adapted.samples, material, &eta));
        let mut coefficients = Vec::new();
        let found = lower.is_some_and(|lower| {
            let sources: Vec<&[f64]> = sources.iter().map(Vec::as_slice).collect();
            adapted.solve((&eta, &lower), &sources, &mut self.adapted, &mut coefficients)
        });
        (self.eta, self.values) = (eta, sources.swap_remove(0));
        found.then_some(Equation::Adapted(coefficients))
    }

    /// The velocity and the reaction of a material in the units of a stencil, with the diffusivity at the samples; `None` where they are no
    /// numbers somewhere.
    fn lower_terms(
        &mut self,
        stencil: &Stencil<D>,
        samples: &[[f64; D]],
        material: &Material<D>,
        eta: &[f64],
    ) -> Option<LowerTerms<D>> {
        let mut lower = LowerTerms::default();
        let mut over_eta = |field: &Field<D>, unit: f64| {
            let mut values = Vec::new();
            self.sample(stencil, samples, field, &mut values)?;
            values.iter_mut().zip(eta).for_each(|(value, eta)| *value *= unit / eta);
            Some(values)
        };
        let radius = stencil.radius;
        if let Some(velocity) = &material.velocity {
            let mut all: [Vec<f64>; D] = std::array::from_fn(|_| Vec::new());
            for (values, field) in all.iter_mut().zip(velocity) {
                *values = over_eta(field, radius)?;
            }
            lower.velocity = Some(all);
        }
        if let Some(reaction) = &material.reaction {
            lower.reaction = Some(over_eta(reaction, radius * radius)?);
        }
        Some(lower)
    }

    pub(super) fn columns(&self) -> usize {
        self.columns
    }

    pub(super) fn first_column(&self, part: usize) -> usize {
        self.parts[part].first_column
    }

    /// What the values of the nodes of a part are multiplied by before they enter the fit.
    pub(super) fn omega(&self, part: usize) -> f64 {
        self.parts[part].omega
    }

    /// Weight of the values of the nodes of a part, beside that of their distance.
    pub(super) fn loudness(&self, part: usize) -> f64 {
        self.parts[part].loudness
    }

    /// The scale of what enters.
    pub(super) fn scale(&self, part: usize) -> f64 {
        self.parts[part].scale
    }

    /// Whether the equation of a part is in rows.
    pub(super) fn has_rows(&self, part: usize) -> bool {
        matches!(self.parts[part].equation, Equation::Rows)
    }

    /// `R^2 / (eta s)` of a part in the harmonic form, of which `lap P` in z is that times `-f`; `None` for rows.
    pub(super) fn response(&self, part: usize) -> Option<f64> {
        match self.parts[part].equation {
            Equation::Harmonic { unit, .. } => Some(-((2 * D) as f64) * unit),
            _ => None,
        }
    }

    /// The coefficients, in monomials of the adapted form, of the particular parts of rates that are monomials: one list after the other.
    pub(super) fn of_rates(&self, part: usize, monomials: usize) -> Option<&[f64]> {
        match &self.parts[part].equation {
            Equation::Adapted(coefficients) => Some(&coefficients[(self.functions + 2) * monomials..]),
            _ => None,
        }
    }

    /// The place of the column of the constant source of a part among its columns, and what a functional at the point that
    /// was evaluated last has there, if it has it; an equation in rows has it on its right-hand side.
    pub(super) fn open_source(&self, part: usize, functional: &Row<D>, jet: &Jet<D>) -> Option<(usize, f64)> {
        let Part { equation, open, .. } = &self.parts[part];
        open.then(|| match equation {
            Equation::Rows => (jet.values.len(), functional.laplacian),
            _ => (jet.values.len(), self.of_square(functional)),
        })
    }

    /// A functional of `|z|^2` at the point that was evaluated last.
    fn of_square(&self, functional: &Row<D>) -> f64 {
        let square: f64 = self.z.iter().map(|z| z * z).sum();
        let slope: f64 = self.z.iter().zip(functional.gradient).map(|(z, g)| 2.0 * z * g).sum();
        functional.value * square + slope + functional.laplacian * (2 * D) as f64
    }

    /// Evaluates the functions of a part at z, their slopes if asked for, and what its particular part needs there; without slopes,
    /// for rows of values only.
    pub(super) fn evaluate(
        &mut self,
        maker: &Maker<'_, D>,
        part: usize,
        z: &[f64; D],
        slopes: bool,
        jet: &mut Jet<D>,
    ) {
        self.z.clear();
        self.z.extend(z);
        match &self.parts[part].equation {
            Equation::Vertex => self.evaluate_at_vertex(maker, part, z, jet),
            Equation::Rows => maker.complete_basis.evaluate(z, jet),
            Equation::Harmonic { source, .. } => {
                maker.harmonic_basis.evaluate(z, jet);
                if let (Source::Fitted(_), Some(particular)) = (source, &maker.particular) {
                    evaluate_monomials(&particular.basis, z, slopes, &mut self.particular);
                }
            }
            Equation::Adapted(coefficients) => {
                maker.harmonic_basis.evaluate(z, jet);
                let Some(adapted) = &maker.adapted else { return };
                let monomials = &mut self.particular;
                evaluate_monomials(&adapted.basis, z, slopes, monomials);
                let functions = jet.values.len();
                let lacking = &coefficients[..functions * monomials.values.len()];
                dense::add_combination(&monomials.values, lacking, &mut jet.values);
                if slopes {
                    for (gradient, lacks) in monomials.gradients.iter().zip(lacking.chunks_exact(functions)) {
                        for (slope, c) in jet.gradients.iter_mut().zip(lacks) {
                            slope.iter_mut().zip(gradient).for_each(|(s, g)| *s += c * g);
                        }
                    }
                }
            }
        }
    }

    fn evaluate_at_vertex(&mut self, maker: &Maker<'_, D>, part: usize, z: &[f64; D], jet: &mut Jet<D>) {
        let Some(at) = &mut self.at_vertex else { return };
        let x = std::array::from_fn(|k| at.center[k] + at.radius * z[k]);
        let scale = |place: usize| maker.unknowns.scale[at.parts[place] as usize];
        let constant = at.reference.map_or(0.0, |reference| scale(reference) / scale(part));
        let vertex = maker.vertices.get(at.vertex);
        at.given = vertex.evaluate(at.parts[part], (&x, &at.center), (at.reach, constant), jet);
        jet.gradients.iter_mut().flatten().for_each(|slope| *slope *= at.radius);
    }

    /// A functional of the particular part at the point that was evaluated last: for the source, and for a source of 1.
    pub(super) fn apply_to_particular(&self, part: usize, functional: &Row<D>) -> [f64; 2] {
        let of_monomials = |coefficients: &[f64]| -> f64 {
            if functional.is_value() {
                return functional.value * dense::dot(coefficients, &self.particular.values);
            }
            coefficients.iter().enumerate().map(|(m, c)| c * functional.apply(&self.particular, m)).sum()
        };
        match &self.parts[part].equation {
            Equation::Rows => [0.0; 2],
            Equation::Vertex => self.at_vertex.as_ref().map_or([0.0; 2], |at| {
                at.given.each_ref().map(|given| vertex::apply(functional, given, at.radius))
            }),
            Equation::Harmonic { source, unit } => {
                let of_one = unit * self.of_square(functional);
                let of_source = match source {
                    Source::None => 0.0,
                    Source::Constant(f) => f * of_one,
                    Source::Fitted(coefficients) => of_monomials(coefficients),
                };
                [of_source, of_one]
            }
            Equation::Adapted(coefficients) => {
                let count = self.particular.values.len();
                let given = &coefficients[self.functions * count..];
                [of_monomials(&given[..count]), of_monomials(&given[count..2 * count])]
            }
        }
    }
}
