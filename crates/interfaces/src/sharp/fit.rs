//! The local fit at a node: one polynomial a part of a region, the equation and the interface conditions as rows.

use meshless_stencils::Qr;

use super::basis::Jet;
use super::maker::Maker;
use super::operator::Operator;
use super::parts::Parts;
pub(super) use super::parts::Row;
use super::stencil::{Heard, Stencil};

/// `exp(-DECAY (r/R)^2)` is the weight of the value at a node.
pub(super) const DECAY: f64 = 3.5;

/// Weight of the rows of boundary conditions on the flux.
const BOUNDARY_WEIGHT: f64 = 10.0;

/// Least weight of a soft part beside a stiff one in units of the energy: it has to determine its own polynomial still.
const LEAST_HEARD: f64 = 1e-6;

/// Pivots below this part of the largest count as none (Golub & Van Loan, section 5.4).
pub(super) const RANK_TOLERANCE: f64 = 1e-12;

/// Constants of parts of a stencil on a right-hand side: `factor (c_of - c_less)`. In differences, so that what both have in common
/// is not rounded: where parts are stiff, the factor is as large as they are.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Share {
    pub(super) of: usize,
    pub(super) less: Option<usize>,
    pub(super) factor: f64,
}

/// What a row of the fit has on its right-hand side beside the value of a node: a number, what it would be for the
/// source 1, and the constants of parts. Those of the sides of an interface with partition coefficients stand by themselves.
#[derive(Debug, Clone, Copy, Default)]
struct Given {
    known: f64,
    unit_source: f64,
    shares: [Share; 2],
}

/// What a row does to the polynomial of a part at a point.
#[derive(Debug, Clone, Copy)]
pub(super) struct Term<const D: usize> {
    pub(super) row: usize,
    pub(super) part: usize,
    pub(super) z: [f64; D],
    pub(super) functional: Row<D>,
    /// What a source of 1 has on the right-hand side of a row that is the equation; 0 for all others.
    pub(super) equation: f64,
}

/// One term of a functional that is wanted: what it does to the polynomial in z of a part of the stencil at a point.
#[derive(Debug, Clone, Copy)]
pub(super) struct Wanted<const D: usize> {
    pub(super) part: usize,
    pub(super) z: [f64; D],
    pub(super) functional: Row<D>,
}

/// Memory of one thread.
#[derive(Debug, Default)]
pub(super) struct Fit<const D: usize> {
    qr: Qr,
    pub(super) parts: Parts<D>,
    /// The rows by parts, where the mass of a row is wanted.
    pub(super) terms: Vec<Term<D>>,
    in_time: bool,
    given: Vec<Given>,
    /// Factors of the values in their rows, one a node: the weight of the row, and the units of the part.
    pub(super) weights: Vec<f64>,
    wanted: Vec<f64>,
    /// What the columns were multiplied by; empty where they were not.
    column_units: Vec<f64>,
    z: Vec<f64>,
    /// Factors of the rows in the functional that was asked for last.
    pub(super) factors: Vec<f64>,
}

/// A functional of the own polynomial in terms of values and data.
#[derive(Debug, Clone, Default)]
pub(super) struct Combination {
    /// Factors of the values `w` of the nodes of the stencil.
    pub(super) values: Vec<f64>,
    /// The constants of the parts of the stencil, each pair once.
    pub(super) constants: Vec<Share>,
    /// What the data add.
    pub(super) known: f64,
    /// What a source of 1 would add.
    pub(super) unit_source: f64,
}

impl Combination {
    fn add(&mut self, share: Share) {
        match self.constants.iter_mut().find(|s| (s.of, s.less) == (share.of, share.less)) {
            Some(sum) => sum.factor += share.factor,
            None => self.constants.push(share),
        }
    }
}

impl<const D: usize> Fit<D> {
    /// Fills and factors the matrix of a stencil.
    pub(super) fn factor(&mut self, maker: &Maker<'_, D>, stencil: &Stencil<D>) {
        self.in_time = maker.rates.is_some();
        self.parts.prepare(maker, stencil);
        self.assemble(maker, stencil);
        self.column_units.clear();
        if stencil.vertex.is_some() {
            self.equilibrate();
        }
        if stencil.parts.len() == 1 && stencil.vertex.is_none() {
            if self.qr.factor(RANK_TOLERANCE) {
                return;
            }
            self.assemble(maker, stencil);
        }
        self.qr.factor_pivoted(RANK_TOLERANCE);
    }

    /// Makes all columns as long as 1: functions that live in a soft sector alone are as good as others.
    fn equilibrate(&mut self) {
        for column in 0..self.qr.columns() {
            let entries = self.qr.column_mut(column);
            let length = entries.iter().map(|x| x * x).sum::<f64>().sqrt();
            let unit = if length > 0.0 { 1.0 / length } else { 1.0 };
            entries.iter_mut().for_each(|x| *x *= unit);
            self.column_units.push(unit);
        }
    }

    /// The derivative along an axis of the own polynomial at the node, or with `None` its value there. Returns what is
    /// left of its reproduction.
    pub(super) fn functional(
        &mut self,
        maker: &Maker<'_, D>,
        stencil: &Stencil<D>,
        axis: Option<usize>,
        out: &mut Combination,
    ) -> f64 {
        let size = axis.map_or(1.0, |_| 1.0 / stencil.radius);
        let at_center = match axis {
            None => Row::of_value(size),
            Some(axis) => Row::of_slope(axis).times(size),
        };
        self.functional_of(maker, &[Wanted { part: 0, z: [0.0; D], functional: at_center }], out) / size
    }

    /// The sum of functionals of polynomials of the stencil, at any points: an integral over a face, say. Returns what is left of
    /// its reproduction.
    pub(super) fn functional_of(
        &mut self,
        maker: &Maker<'_, D>,
        wanted: &[Wanted<D>],
        out: &mut Combination,
    ) -> f64 {
        self.wanted.clear();
        self.wanted.resize(self.qr.columns(), 0.0);
        let mut particular = [0.0; 2];
        let mut jet = std::mem::take(&mut self.parts.jet);
        for Wanted { part, z, functional } in wanted {
            self.parts.evaluate(maker, *part, z, true, &mut jet);
            let first = self.parts.first_column(*part);
            // Of w; the polynomial is that of `w' = omega w`.
            let functional = &functional.times(1.0 / self.parts.omega(*part));
            for m in 0..jet.values.len() {
                self.wanted[first + m] += functional.apply(&jet, m);
            }
            if let Some((column, entry)) = self.parts.open_source(*part, functional, &jet) {
                self.wanted[first + column] += entry;
            }
            let added = self.parts.apply_to_particular(*part, functional);
            particular.iter_mut().zip(added).for_each(|(sum, p)| *sum += p);
        }
        self.parts.jet = jet;
        self.wanted.iter_mut().zip(&self.column_units).for_each(|(entry, unit)| *entry *= unit);
        let left_over = self.combine(particular, out);
        for Wanted { part, functional, .. } in wanted {
            let share = self.share(maker, *part, functional.value);
            if share.factor != 0.0 {
                out.add(share);
            }
        }
        left_over
    }

    /// What constants of parts add to `factor` times the polynomial of one beside its columns.
    fn share(&self, maker: &Maker<'_, D>, part: usize, factor: f64) -> Share {
        let beside = self.parts.constants_beside(maker, part);
        beside.map_or_else(Share::default, |(of, less, each)| Share { of, less, factor: factor * each })
    }

    /// Solves for all polynomials at once; false where the rows do not determine them all.
    pub(super) fn solve(
        &mut self,
        stencil: &Stencil<D>,
        value: impl Fn(u32) -> f64,
        constants: impl Fn(u32, Option<u32>) -> f64,
    ) -> bool {
        if self.qr.rank() < self.qr.columns() {
            return false;
        }
        self.factors.clear();
        self.factors.extend(self.given.iter().map(|&Given { known, shares, .. }| {
            let part = |place: usize| stencil.parts[place];
            let of = |share: &Share| share.factor * constants(part(share.of), share.less.map(part));
            shares.iter().filter(|share| share.factor != 0.0).fold(known, |sum, share| sum + of(share))
        }));
        let nodes = stencil.nodes.iter().zip(&self.weights);
        self.factors.iter_mut().zip(nodes).for_each(|(row, (&j, weight))| *row += weight * value(j));
        self.qr.apply_transpose(&mut self.factors);
        self.z.resize(self.qr.columns(), 0.0);
        self.qr.back_substitute(&self.factors, &mut self.z);
        true
    }

    /// Value and gradient (in z) of the own polynomial at `z`, after [`Fit::solve`].
    pub(super) fn own(&mut self, maker: &Maker<'_, D>, z: &[f64; D]) -> (f64, [f64; D]) {
        let mut jet = std::mem::take(&mut self.parts.jet);
        self.parts.evaluate(maker, 0, z, true, &mut jet);
        let own = &self.z[..jet.values.len()];
        let value: f64 = own.iter().zip(&jet.values).map(|(c, v)| c * v).sum();
        let slope = |axis: usize| own.iter().zip(&jet.gradients).map(|(c, g)| c * g[axis]).sum::<f64>();
        let particular = |row: &Row<D>| self.parts.apply_to_particular(0, row)[0];
        let gradient = std::array::from_fn(|axis| slope(axis) + particular(&Row::of_slope(axis)));
        let value = value + particular(&Row::of_value(1.0));
        self.parts.jet = jet;
        (value, gradient)
    }

    /// The combination of values and data that gives what is wanted. Returns what is left of its reproduction.
    fn combine(&mut self, particular: [f64; 2], out: &mut Combination) -> f64 {
        self.z.resize(self.qr.columns(), 0.0);
        self.factors.resize(self.given.len(), 0.0);
        let remainder = self.qr.least_norm(&self.wanted, &mut self.z, &mut self.factors);
        out.values.clear();
        out.values.extend(self.factors.iter().zip(&self.weights).map(|(f, w)| f * w));
        out.constants.clear();
        [out.known, out.unit_source] = particular;
        for (factor, given) in self.factors.iter().zip(&self.given) {
            out.known += factor * given.known;
            out.unit_source += factor * given.unit_source;
            for share in given.shares.iter().filter(|share| share.factor != 0.0) {
                out.add(Share { factor: factor * share.factor, ..*share });
            }
        }
        remainder
    }

    fn assemble(&mut self, maker: &Maker<'_, D>, stencil: &Stencil<D>) {
        let boundary: usize = stencil.nodes.iter().map(|&j| maker.conditions(j, stencil).count()).sum();
        let at_nodes = stencil.part_of.iter().filter(|&&part| self.parts.has_rows(part)).count();
        let at_points = |&(_, sides): &(u32, [usize; 2])| {
            2 + sides.iter().filter(|&&part| self.parts.has_rows(part)).count()
        };
        let interface: usize = stencil.points.iter().map(at_points).sum();
        let columns = self.parts.columns();
        self.qr.resize(stencil.nodes.len() + at_nodes + interface + boundary, columns);
        for column in 0..columns {
            self.qr.column_mut(column).fill(0.0);
        }
        self.given.clear();
        self.weights.clear();
        self.terms.clear();
        self.node_rows(maker, stencil);
        self.interface_rows(maker, stencil);
    }

    /// Adds the functional of a part's polynomial at z to a row; its right-hand side is what the particular part leaves.
    fn put(
        &mut self,
        row: usize,
        part: usize,
        (z, jet): (&[f64; D], &Jet<D>),
        functional: &Row<D>,
        given: &mut Given,
    ) {
        if self.in_time {
            let equation = given.unit_source;
            self.terms.push(Term { row, part, z: *z, functional: *functional, equation });
        }
        let first = self.parts.first_column(part);
        if functional.is_value() {
            for (m, value) in jet.values.iter().enumerate() {
                self.qr.column_mut(first + m)[row] = functional.value * value;
            }
        } else {
            for m in 0..jet.values.len() {
                self.qr.column_mut(first + m)[row] = functional.apply(jet, m);
            }
        }
        if let Some((column, entry)) = self.parts.open_source(part, functional, jet) {
            self.qr.column_mut(first + column)[row] = entry;
        }
        let [known, unit] = self.parts.apply_to_particular(part, functional);
        given.known -= known;
        given.unit_source -= unit;
    }

    /// Rows of the nodes: the value; the equation; conditions on the flux where there are any.
    fn node_rows(&mut self, maker: &Maker<'_, D>, stencil: &Stencil<D>) {
        let radius = stencil.radius;
        let points = maker.problem.cloud.points();
        let center = &stencil.center;
        let nodes = stencil.nodes.len();
        let conductance =
            |j: usize| maker.problem.eta[j] * maker.unknowns.scale[maker.unknowns.part[j] as usize];
        let stiffest = match stencil.heard {
            Heard::UnitsOfEnergy => {
                stencil.nodes.iter().fold(0.0_f64, |m, &j| m.max(conductance(j as usize)))
            }
            Heard::All | Heard::OwnPart => 0.0,
        };
        let louder = |j: usize| match stiffest > 0.0 {
            true => (conductance(j) / stiffest).sqrt().max(LEAST_HEARD),
            false => 1.0,
        };
        self.given.resize(nodes, Given::default());
        let vertex = stencil.vertex.map(|vertex| maker.vertices.get(vertex));
        let mut jet = std::mem::take(&mut self.parts.jet);
        for (row, (&j, &part)) in stencil.nodes.iter().zip(&stencil.part_of).enumerate() {
            let j = j as usize;
            let z: [f64; D] = std::array::from_fn(|k| (points[j][k] - center[k]) / radius);
            let slopes = !maker.boundary_rows[j].is_empty();
            self.parts.evaluate(maker, part, &z, slopes, &mut jet);
            let weight = louder(j) * (-DECAY * z.iter().map(|z| z * z).sum::<f64>()).exp();
            let told = vertex.is_none_or(|vertex| vertex.is_told_by(&points[j]));
            // The functions of a vertex are in the units of the nodes: those of softer parts are weighed instead.
            let weight = if told { weight * self.parts.loudness(part) } else { 0.0 };
            self.weights.push(weight * self.parts.omega(part));
            let shares = [self.share(maker, part, -weight), Share::default()];
            let mut given = Given { shares, ..Given::default() };
            self.put(row, part, (&z, &jet), &Row::of_value(weight), &mut given);
            self.given[row] = given;
            let (eta, scale) = (maker.problem.eta[j], self.parts.scale(part));
            if self.parts.has_rows(part) {
                let source = maker.problem.source.map_or(0.0, |f| f[j]);
                let held = (stencil.parts[part], eta * scale);
                self.equation(maker, (part, held), (&z, &jet), &maker.operator(j), radius, source);
            }
            for condition in maker.conditions(j as u32, stencil) {
                let functional = Row {
                    value: BOUNDARY_WEIGHT * radius * condition.exchange / eta,
                    gradient: condition.normal.map(|n| BOUNDARY_WEIGHT * n),
                    laplacian: 0.0,
                };
                let factor = BOUNDARY_WEIGHT * radius / (eta * scale);
                let offset = maker.unknowns.offset[stencil.parts[part] as usize];
                let known = factor * (condition.flux - condition.exchange * offset);
                let of = self.parts.constant_of(part);
                let share = of.map_or_else(Share::default, |of| Share {
                    of,
                    less: None,
                    factor: -factor * condition.exchange,
                });
                let mut given = Given { known, unit_source: 0.0, shares: [share, Share::default()] };
                self.put(self.given.len(), part, (&z, &jet), &functional, &mut given);
                self.given.push(given);
            }
        }
        self.parts.jet = jet;
    }

    /// The row `lap Q + drift . grad Q - decay Q = -f / (eta s) + decay c / s` of `u = c + s Q`, times the square of the radius, for a place among the
    /// parts of the stencil, with the part and `eta s`.
    fn equation(
        &mut self,
        maker: &Maker<'_, D>,
        (place, (part, conductance)): (usize, (u32, f64)),
        at: (&[f64; D], &Jet<D>),
        operator: &Operator<D>,
        radius: f64,
        source: f64,
    ) {
        let strength = maker.params.equation_weight;
        let decay = strength * radius * radius * operator.decay;
        let functional = Row {
            value: -decay,
            gradient: operator.drift.map(|s| strength * radius * s),
            laplacian: strength,
        };
        let unit = -strength * radius * radius / conductance;
        let mut given = Given { known: unit * source, unit_source: unit, ..Given::default() };
        if decay != 0.0 {
            let factor = decay / self.parts.scale(place);
            given.known += factor * maker.unknowns.offset[part as usize];
            given.shares[0] = Share { of: place, less: None, factor };
        }
        self.put(self.given.len(), place, at, &functional, &mut given);
        self.given.push(given);
    }

    /// Rows of the interface points: the equation on both sides, the law of the values, the jump of the flux.
    fn interface_rows(&mut self, maker: &Maker<'_, D>, stencil: &Stencil<D>) {
        let radius = stencil.radius;
        let center = &stencil.center;
        let weight = maker.params.jump_weight;
        let mut jet = std::mem::take(&mut self.parts.jet);
        for &(index, places) in &stencil.points {
            let at = &maker.interfaces.places[index as usize];
            let point = &maker.interfaces.points[index as usize];
            let z: [f64; D] = std::array::from_fn(|k| (at[k] - center[k]) / radius);
            let scales = places.map(|place| self.parts.scale(place));
            let conductance: [f64; 2] = std::array::from_fn(|s| point.sides[s].eta * scales[s]);
            let largest = conductance[0].max(conductance[1]);
            let law = &point.law;
            let [own, other] = law.partition;
            // What the flux of the law makes of a slope in z, and on which side.
            let through = usize::from(!law.of_here);
            let film = law.resistance * conductance[through] / radius;
            // As w are compared: both sides may be stiff.
            let of_value = weight / (scales[0] / own).max(scales[1] / other).max(film);
            let [below, above] = places.map(|place| maker.unknowns.offset[stencil.parts[place] as usize]);
            let (held, shares) = if own == other {
                let share = Share { of: places[0], less: Some(places[1]), factor: of_value / own };
                ((above - below) / own, [share, Share::default()])
            } else {
                let share = |side: usize, factor: f64| Share { of: places[side], less: None, factor };
                (above / other - below / own, [share(0, of_value / own), share(1, -of_value / other)])
            };
            let known = of_value * (law.value - held);
            let mut value = Given { known, unit_source: 0.0, shares };
            let mut flux = Given { known: weight * radius * law.flux / largest, ..Given::default() };
            let first = self.given.len();
            self.given.resize(first + 2, Given::default());
            for (s, sign) in [-1.0, 1.0].into_iter().enumerate() {
                self.parts.evaluate(maker, places[s], &z, true, &mut jet);
                let row = Row::of_value(sign * of_value * scales[s] / law.partition[s]);
                let row = match film != 0.0 && s == through {
                    true => Row { gradient: point.normal.map(|n| -of_value * film * n), ..row },
                    false => row,
                };
                self.put(first, places[s], (&z, &jet), &row, &mut value);
                let strength = sign * weight * conductance[s] / largest;
                let slope = Row { gradient: point.normal.map(|n| strength * n), ..Row::of_value(0.0) };
                self.put(first + 1, places[s], (&z, &jet), &slope, &mut flux);
                if self.parts.has_rows(places[s]) {
                    let side = &point.sides[s];
                    let at = (&z, &jet);
                    let of = (places[s], (stencil.parts[places[s]], conductance[s]));
                    self.equation(maker, of, at, &side.operator, radius, side.source);
                }
            }
            (self.given[first], self.given[first + 1]) = (value, flux);
        }
        self.parts.jet = jet;
    }
}
