//! `[time]`: scenes that change, and what they are at one time.

use super::Scene;
use super::error::SceneError;
use super::expression::ExprField;
use super::reader::Table;
use super::source::Place;
use super::spec::{BoundarySpec, ConditionSpec, InterfaceSpec, RegionSpec, SlitConditionSpec};

/// Tolerance of a scene that gives none.
const DEFAULT_TOLERANCE: f64 = 1e-4;

/// How u changes with time, `du/dt - div(eta grad u) = f`, from 0 to `end`.
#[derive(Debug, Clone)]
pub struct TimeSpec {
    /// The end, positive.
    pub end: f64,
    /// The solution at time 0; zero, if the scene does not say.
    pub initial: Option<ExprField>,
    /// Error of all time steps together, relative to the largest solution, in L2; positive.
    pub tolerance: f64,
    /// Times in between at which the field is kept, increasing, above 0 and below the end.
    pub output: Vec<f64>,
    /// The table in the file.
    pub place: Place,
}

/// What has to be made anew when time goes on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Varying {
    /// The matrix: the diffusivity, or a coefficient of a Robin condition.
    pub(crate) matrix: bool,
    /// The right-hand side: a source, a boundary value, a jump; or the matrix.
    pub(crate) data: bool,
}

pub(super) fn time(root: &Table<'_>) -> Result<Option<TimeSpec>, SceneError> {
    let Some(value) = root.get("time") else { return Ok(None) };
    let table = value.subtable(&["end", "initial", "tolerance", "output"])?;
    let end = table.require("end")?.positive()?;
    Ok(Some(TimeSpec {
        end,
        initial: table.get("initial").map(|value| value.expression()).transpose()?,
        tolerance: table.get("tolerance").map_or(Ok(DEFAULT_TOLERANCE), |value| value.positive())?,
        output: output(&table, end)?,
        place: table.place,
    }))
}

fn output(table: &Table<'_>, end: f64) -> Result<Vec<f64>, SceneError> {
    let Some(value) = table.get("output") else { return Ok(Vec::new()) };
    let mut times: Vec<f64> = Vec::new();
    for item in value.items()? {
        let t = item.number()?;
        let before = times.last().copied().unwrap_or(0.0);
        if !(t > before && t < end) {
            let message = format!("expected a time between {before} and {end}, found {t}");
            return Err(
                item.error(message, "list increasing times before the end; the end is written anyway")
            );
        }
        times.push(t);
    }
    Ok(times)
}

impl Scene {
    /// The scene as it is at one time: its data do not depend on `t` any more.
    pub(crate) fn at_time(&self, t: f64) -> Self {
        let d = self.dimension;
        let at = |field: &ExprField| field.at_time(d, t);
        let mut scene = self.clone();
        for RegionSpec { diffusivity, source, exact, .. } in &mut scene.regions {
            *diffusivity = at(diffusivity);
            [source, exact].into_iter().flatten().for_each(|field| *field = at(field));
        }
        for InterfaceSpec { jump, flux_jump, rates, .. } in &mut scene.interfaces {
            *rates = [&*jump, &*flux_jump].map(|field| field.as_ref()?.rate_at_time(d, t));
            [jump, flux_jump].into_iter().flatten().for_each(|field| *field = at(field));
        }
        let condition_at = |condition: &mut ConditionSpec| match condition {
            ConditionSpec::Dirichlet(f) | ConditionSpec::Neumann(f) | ConditionSpec::Flux(f) => *f = at(f),
            ConditionSpec::Robin { a, b, g } => [a, b, g].into_iter().for_each(|f| *f = at(f)),
        };
        for slit in &mut scene.slits {
            match &mut slit.condition {
                SlitConditionSpec::Jump { jump, flux_jump } => {
                    [jump, flux_jump].into_iter().flatten().for_each(|field| *field = at(field));
                }
                SlitConditionSpec::OnEachSide(condition) => condition_at(condition),
            }
        }
        for BoundarySpec { condition, .. } in &mut scene.boundaries {
            condition_at(condition);
        }
        scene
    }

    /// What changes with time.
    pub(crate) fn varying(&self) -> Varying {
        let [matrix, data] =
            self.data().map(|fields| fields.iter().any(|f| f.varies_in_time(self.dimension)));
        Varying { matrix, data: data || matrix }
    }

    /// The expressions that depend on `t`, but for exact solutions.
    pub(crate) fn changing_data(&self) -> Vec<&ExprField> {
        self.data().into_iter().flatten().filter(|f| f.varies_in_time(self.dimension)).collect()
    }

    /// What is other than in the same scene at another time; both at one time each.
    pub(crate) fn differs_from(&self, other: &Self) -> Varying {
        let [matrix, data] = [0, 1].map(|k| {
            let (ours, theirs) = (&self.data()[k], &other.data()[k]);
            ours.iter().zip(theirs).any(|(a, b)| !a.expr.is_same(&b.expr))
        });
        Varying { matrix, data: data || matrix }
    }

    /// Expressions that make the matrix, and those that make the right-hand side only.
    fn data(&self) -> [Vec<&ExprField>; 2] {
        let (mut matrix, mut data) = (Vec::new(), Vec::new());
        for region in &self.regions {
            matrix.push(&region.diffusivity);
            data.extend(&region.source);
        }
        for interface in &self.interfaces {
            data.extend([&interface.jump, &interface.flux_jump].into_iter().flatten());
            data.extend(interface.rates.iter().flatten());
        }
        let mut conditions: Vec<&ConditionSpec> = self.boundaries.iter().map(|b| &b.condition).collect();
        for slit in &self.slits {
            match &slit.condition {
                SlitConditionSpec::Jump { jump, flux_jump } => {
                    data.extend([jump, flux_jump].into_iter().flatten());
                }
                SlitConditionSpec::OnEachSide(condition) => conditions.push(condition),
            }
        }
        for condition in conditions {
            match condition {
                ConditionSpec::Dirichlet(f) | ConditionSpec::Neumann(f) | ConditionSpec::Flux(f) => {
                    data.push(f);
                }
                ConditionSpec::Robin { a, b, g } => {
                    matrix.extend([a, b]);
                    data.push(g);
                }
            }
        }
        [matrix, data]
    }
}
