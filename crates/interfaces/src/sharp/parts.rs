//! The polynomials of a stencil, one a part of a region: their bases, columns and particular parts.

use super::basis::Jet;
use super::maker::Maker;
use super::stencil::Stencil;

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

/// The particular part of a polynomial.
#[derive(Debug, Clone, Default)]
enum Source {
    /// There is no source, or the equation is in rows.
    #[default]
    None,
    /// The same source everywhere: `-f |z|^2 R^2 / (2 D eta s)`.
    Constant(f64),
    /// Coefficients of monomials.
    Fitted(Vec<f64>),
}

/// The polynomial of one part.
#[derive(Debug, Clone, Default)]
struct Part {
    harmonic: bool,
    first_column: usize,
    source: Source,
    /// `-R^2 / (2 D eta s)` in the harmonic form, 0 else: the particular part of a source of 1 over `|z|^2`.
    unit: f64,
}

/// The polynomials of a stencil.
#[derive(Debug, Default)]
pub(super) struct Parts<const D: usize> {
    parts: Vec<Part>,
    columns: usize,
    pub(super) jet: Jet<D>,
    /// Monomials of particular parts at the point that was evaluated last, and the point.
    particular: Jet<D>,
    z: Vec<f64>,
    samples: Vec<[f64; D]>,
    values: Vec<f64>,
}

impl<const D: usize> Parts<D> {
    /// Chooses the form of every part of a stencil and makes the particular parts.
    pub(super) fn prepare(&mut self, maker: &Maker<'_, D>, stencil: &Stencil<D>) {
        self.parts.resize_with(stencil.parts.len(), Part::default);
        self.columns = 0;
        for place in 0..stencil.parts.len() {
            let part = stencil.parts[place] as usize;
            let label = maker.unknowns.label[part] as usize;
            let mut harmonic = maker.harmonic[label];
            let (mut source, mut unit) = (Source::None, 0.0);
            if let (true, Some(eta)) = (harmonic, maker.problem.materials[label].diffusivity.as_constant()) {
                let response = -stencil.radius * stencil.radius / (eta * maker.unknowns.scale[part]);
                unit = response / (2 * D) as f64;
                match self.particular_part(maker, stencil, label, response) {
                    Some(found) => source = found,
                    // The source is not a number somewhere near: rows see it at nodes of its own region only.
                    None => (harmonic, unit) = (false, 0.0),
                }
            }
            self.parts[place] = Part { harmonic, first_column: self.columns, source, unit };
            self.columns += maker.basis_of(harmonic).len();
        }
    }

    fn particular_part(
        &mut self,
        maker: &Maker<'_, D>,
        stencil: &Stencil<D>,
        label: usize,
        response: f64,
    ) -> Option<Source> {
        let Some(field) = &maker.problem.materials[label].source else { return Some(Source::None) };
        if let Some(f) = field.as_constant() {
            return Some(Source::Constant(f));
        }
        let particular = maker.particular.as_ref()?;
        let center = &stencil.center;
        let place = |z: &[f64; D]| std::array::from_fn(|k| center[k] + stencil.radius * z[k]);
        self.samples.clear();
        self.samples.extend(particular.samples.iter().map(place));
        self.values.resize(self.samples.len(), 0.0);
        field.eval(&self.samples, &mut self.values);
        if self.values.iter().any(|f| !f.is_finite()) {
            return None;
        }
        self.values.iter_mut().for_each(|f| *f *= response);
        let mut coefficients = Vec::new();
        particular.solve(&self.values, &mut coefficients);
        Some(Source::Fitted(coefficients))
    }

    pub(super) fn columns(&self) -> usize {
        self.columns
    }

    pub(super) fn first_column(&self, part: usize) -> usize {
        self.parts[part].first_column
    }

    pub(super) fn is_harmonic(&self, part: usize) -> bool {
        self.parts[part].harmonic
    }

    /// Evaluates the basis of a part at z, and what its particular part needs there.
    pub(super) fn evaluate(&mut self, maker: &Maker<'_, D>, part: usize, z: &[f64; D], jet: &mut Jet<D>) {
        maker.basis_of(self.parts[part].harmonic).evaluate(z, jet);
        self.z.clear();
        self.z.extend(z);
        if let (Source::Fitted(_), Some(particular)) = (&self.parts[part].source, &maker.particular) {
            particular.basis.evaluate(z, &mut self.particular);
        }
    }

    /// A functional of the particular part at the point that was evaluated last: for the source, and for a source of 1.
    pub(super) fn apply_to_particular(&self, part: usize, functional: &Row<D>) -> [f64; 2] {
        let Part { source, unit, .. } = &self.parts[part];
        if *unit == 0.0 {
            return [0.0; 2];
        }
        let square: f64 = self.z.iter().map(|z| z * z).sum();
        let slope: f64 = self.z.iter().zip(functional.gradient).map(|(z, g)| 2.0 * z * g).sum();
        let of_one = unit * (functional.value * square + slope + functional.laplacian * (2 * D) as f64);
        let of_source = match source {
            Source::None => 0.0,
            Source::Constant(f) => f * of_one,
            Source::Fitted(coefficients) => {
                coefficients.iter().enumerate().map(|(m, c)| c * functional.apply(&self.particular, m)).sum()
            }
        };
        [of_source, of_one]
    }

    /// Value or derivative in z along an axis of a particular part at the center of the stencil, likewise.
    pub(super) fn particular_at_center(&self, part: usize, axis: Option<usize>) -> [f64; 2] {
        match &self.parts[part].source {
            Source::Fitted(coefficients) => [coefficients[axis.map_or(0, |axis| 1 + axis)], 0.0],
            Source::None | Source::Constant(_) => [0.0; 2],
        }
    }
}
