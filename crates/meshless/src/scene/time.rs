//! `[time]`: scenes that change, and what they are at one time.

use super::Scene;
use super::error::SceneError;
use super::expression::ExprField;
use super::fields::{Role, each, each_mut};
use super::reader::Table;
use super::source::Place;

/// Tolerance of a scene that gives none.
const DEFAULT_TOLERANCE: f64 = 1e-4;

/// How u changes with time, `capacity du/dt - div(eta grad u) = f`, from 0 to `end`.
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
    /// The matrix: the diffusivity or another coefficient of the equation, or one of a Robin condition.
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
        let mut scene = self.clone();
        for interface in &mut scene.interfaces {
            interface.rates =
                [&interface.jump, &interface.flux_jump].map(|field| field.as_ref()?.rate_at_time(d, t));
        }
        each_mut(&mut scene, &mut |_, field| *field = field.at_time(d, t));
        scene
    }

    /// What changes with time.
    pub(crate) fn varying(&self) -> Varying {
        let changing = self.changing();
        let any = |role: Role| changing.iter().any(|(of, _)| *of == role);
        Varying { matrix: any(Role::Matrix), data: any(Role::Matrix) || any(Role::Data) }
    }

    /// The expressions that depend on `t`, but for exact solutions.
    pub(crate) fn changing_data(&self) -> Vec<&ExprField> {
        self.changing().into_iter().map(|(_, field)| field).collect()
    }

    fn changing(&self) -> Vec<(Role, &ExprField)> {
        let mut found = Vec::new();
        each(self, &mut |role, field| {
            if role != Role::Exact && field.varies_in_time(self.dimension) {
                found.push((role, field));
            }
        });
        found
    }

    /// What is other than in the same scene at another time; both at one time each.
    pub(crate) fn differs_from(&self, other: &Self) -> Varying {
        let all = |scene: &Self, of: Role| {
            let mut found = Vec::new();
            each(scene, &mut |role, field| {
                if role == of {
                    found.push(field.expr.clone());
                }
            });
            if of == Role::Data {
                let rates = scene.interfaces.iter().flat_map(|interface| interface.rates.iter().flatten());
                found.extend(rates.map(|field| field.expr.clone()));
            }
            found
        };
        let [matrix, data] = [Role::Matrix, Role::Data].map(|role| {
            let (ours, theirs) = (all(self, role), all(other, role));
            ours.iter().zip(&theirs).any(|(a, b)| !a.is_same(b))
        });
        Varying { matrix, data: data || matrix }
    }
}
