//! `M du/dt + A u = b(t)`: the rows of a spatial method in time.

use std::time::Instant;

use meshless_interfaces::{
    Condition, Discretization, Mass, Method, PreparedSystem, RowKind, SplitValues, SystemParams, residual,
};
use meshless_sparse::SolveInfo;
use meshless_time::Semidiscrete;

use super::super::{Discrete, Progress};
use crate::Error;
use crate::plan::{Plan, Stage};
use crate::report::Seconds;
use crate::scene::{Scene, Varying};

/// The rows of a scene at one time, and what is made of them.
///
/// The mass of a row is the volume that it stands for, or what the method says. Boundary rows and prescribed values have
/// none.
pub(super) struct Heat<'a, const D: usize> {
    scene: &'a Scene,
    plan: &'a Plan,
    varying: Varying,
    discrete: Discrete<D>,
    method: Box<dyn Method<D>>,
    /// The scene as it is at the time for which `discretization` holds.
    now: Scene,
    discretization: Discretization,
    mass: Mass,
    /// Whether disturbances may grow by themselves, for all that the rows say.
    may_grow: bool,
    /// How often M or A has changed.
    changes: usize,
    prepared: Option<Matrix>,
    info: Option<SolveInfo>,
    /// The unknowns of the last stage, where a method splits off constants itself.
    split: Option<SplitValues>,
    /// Matrices that were factored.
    pub(super) matrices: usize,
    seconds: Seconds,
}

/// How the last system was solved, and the unknowns `w` and `C` of the last stage.
type Solved = (SolveInfo, Option<SplitValues>);

/// `M / c + A` with its factors.
struct Matrix {
    c: f64,
    system: PreparedSystem,
}

impl<'a, const D: usize> Heat<'a, D> {
    pub(super) fn new(
        scene: &'a Scene,
        plan: &'a Plan,
        discrete: Discrete<D>,
        progress: &mut dyn Progress,
    ) -> Result<Self, Error> {
        progress.stage(if plan.runs(Stage::Cells) { Stage::Cells } else { Stage::LaplacianStencils });
        let method = plan.method.params.build::<D>();
        let mut seconds = Seconds::default();
        let discretization = discretize(scene, &discrete, &*method, &mut seconds)?;
        let mass = Mass::of(&discrete.problem(), &discretization)?;
        let may_grow = may_grow(scene, &discrete, &discretization, &mass);
        Ok(Self {
            scene,
            plan,
            varying: scene.varying(),
            discrete,
            method,
            now: scene.at_time(0.0),
            discretization,
            mass,
            may_grow,
            changes: 0,
            prepared: None,
            info: None,
            split: None,
            matrices: 0,
            seconds,
        })
    }

    /// Unknowns: the nodes, and what else a method has.
    pub(super) fn unknowns(&self) -> usize {
        self.discretization.rows.n()
    }

    pub(super) fn nodes(&self) -> usize {
        self.discretization.kinds.len()
    }

    pub(super) fn discrete(&self) -> &Discrete<D> {
        &self.discrete
    }

    /// Where an unknown is.
    pub(super) fn position(&self, unknown: usize) -> Vec<f64> {
        let further =
            unknown.checked_sub(self.nodes()).and_then(|i| self.discretization.interface_points.get(i));
        match (self.discrete.cloud.points().get(unknown), further) {
            (_, Some(point)) => point.at.clone(),
            (Some(point), None) => point.to_vec(),
            (None, None) => Vec::new(),
        }
    }

    /// The discretisation at `end`, how the last system was solved, and what it took.
    pub(super) fn into_parts(
        mut self,
        end: f64,
    ) -> Result<(Discrete<D>, Discretization, Solved, Seconds), Error> {
        self.move_to(end)?;
        if self.info.is_none() {
            // A checkpoint at the very end leaves nothing to solve.
            self.solve_for(DEFAULT_C, &self.discretization.rhs.clone())?;
        }
        let info = self.info.take().ok_or_else(|| Error::Time("no system was solved".to_owned()))?;
        Ok((self.discrete, self.discretization, (info, self.split), self.seconds))
    }

    /// Makes the data anew for another time, where they depend on it.
    fn move_to(&mut self, t: f64) -> Result<(), Error> {
        if !self.varying.data {
            return Ok(());
        }
        let scene = self.scene.at_time(t);
        // Data may change at some times only, as by `if(t < 20, ..)`.
        let changed = scene.differs_from(&self.now);
        if !changed.data {
            return Ok(());
        }
        self.discrete.set_data(&scene, self.plan)?;
        self.discretization = discretize(&scene, &self.discrete, &*self.method, &mut self.seconds)?;
        self.now = scene;
        if changed.matrix {
            self.mass = Mass::of(&self.discrete.problem(), &self.discretization)?;
            self.changes += 1;
            self.may_grow = may_grow(&self.now, &self.discrete, &self.discretization, &self.mass);
            self.prepared = None;
        }
        Ok(())
    }

    /// Solves `(M / c + A) u = rhs`.
    fn solve_for(&mut self, c: f64, rhs: &[f64]) -> Result<(Vec<f64>, Option<SplitValues>), Error> {
        let start = Instant::now();
        let matrix = match self.prepared.take() {
            Some(matrix) if matrix.c == c => matrix,
            other => self.factored(c, other.map(|old| old.system))?,
        };
        let solved = matrix.system.solve_split(rhs);
        let (u, split, info) = solved.map_err(|e| self.discrete.explain(self.scene, e))?;
        self.prepared = Some(matrix);
        self.info = Some(info);
        self.seconds.solve += start.elapsed().as_secs_f64();
        Ok((u, split))
    }

    fn factored(&mut self, c: f64, old: Option<PreparedSystem>) -> Result<Matrix, Error> {
        // Constants of floating regions are found from the nodes alone.
        let nodal = self.unknowns() == self.nodes();
        let split_floating = nodal && self.plan.runs(Stage::FloatingConstants);
        let params = SystemParams { solver: self.plan.solver, split_floating };
        let (rows, constants) = self.mass.shifted(&self.discretization, c)?;
        let system = match (old, &constants) {
            (Some(old), _) => old.renewed(&rows, constants.as_ref(), &params),
            (None, Some(constants)) => {
                PreparedSystem::with_constants(&rows, constants, &self.prescribed(), &params)
            }
            (None, None) => PreparedSystem::new(&self.discrete.problem(), &rows, &self.prescribed(), &params),
        };
        let system = system.map_err(|e| self.discrete.explain(self.scene, e))?;
        self.matrices += 1;
        Ok(Matrix { c, system })
    }

    /// Which unknowns are prescribed values.
    fn prescribed(&self) -> Vec<bool> {
        let mut known: Vec<bool> =
            self.discretization.kinds.iter().map(|&kind| kind == RowKind::Dirichlet).collect();
        known.resize(self.unknowns(), false);
        known
    }

    /// Rates of the prescribed values at a time, and of what algebraic rows leave over at `u`, by their difference over a
    /// share of the whole.
    fn given_rates(&mut self, t: f64, u: &[f64]) -> Result<Vec<f64>, Error> {
        let mut rates = vec![0.0; self.unknowns()];
        let Some(time) = self.scene.time.as_ref().filter(|_| self.varying.data) else { return Ok(rates) };
        let step = RATE_STEP * time.end;
        let mut sides =
            [t, t + step].into_iter().map(|t| self.discrete.prescribed_at(&self.scene.at_time(t)));
        if let (Some(now), Some(later)) = (sides.next().transpose()?, sides.next().transpose()?) {
            for (rate, (a, b)) in rates.iter_mut().zip(now.iter().zip(&later)) {
                *rate = a.zip(*b).map_or(0.0, |(a, b)| (b - a) / step);
            }
        }
        if self.mass.algebraic().next().is_some() {
            let now = residual(&self.discretization, u)?;
            self.move_to(t + step)?;
            let later = residual(&self.discretization, u)?;
            self.move_to(t)?;
            self.mass.algebraic().for_each(|i| rates[i] = (later[i] - now[i]) / step);
        }
        Ok(rates)
    }
}

/// Step of a difference quotient in time, over the whole time.
const RATE_STEP: f64 = 1e-7;

/// A step size for a solve of which only the report is wanted.
const DEFAULT_C: f64 = 1.0;

/// Growth over the whole time that is none.
const NO_GROWTH: f64 = 0.1;

/// Whether rows may let something grow that the equation does not. What is taken up from outside the more the larger u is, does.
fn may_grow<const D: usize>(
    scene: &Scene,
    discrete: &Discrete<D>,
    discretization: &Discretization,
    mass: &Mass,
) -> bool {
    let end = scene.time.as_ref().map_or(0.0, |time| time.end);
    let feeds = |c: &Condition| matches!(c, Condition::Robin { a, b, .. } if a * b < 0.0);
    let bounded = mass.growth_bound(discretization).is_some_and(|rate| rate * end <= NO_GROWTH);
    !bounded && !discrete.problem().conditions.iter().flatten().any(feeds)
}

fn discretize<const D: usize>(
    scene: &Scene,
    discrete: &Discrete<D>,
    method: &dyn Method<D>,
    seconds: &mut Seconds,
) -> Result<Discretization, Error> {
    let start = Instant::now();
    let discretization = method.discretize(&discrete.problem()).map_err(|e| discrete.explain(scene, e))?;
    seconds.stencils += discretization.stencil_seconds;
    seconds.assembly += start.elapsed().as_secs_f64() - discretization.stencil_seconds;
    Ok(discretization)
}

impl<const D: usize> Semidiscrete for Heat<'_, D> {
    type Error = Error;

    fn make_consistent(&mut self, t: f64, u: &mut [f64]) -> Result<(), Error> {
        self.move_to(t)?;
        let kinds = self.discretization.kinds.iter().enumerate();
        let prescribed = kinds.filter(|(_, kind)| **kind == RowKind::Dirichlet);
        prescribed.for_each(|(i, _)| u[i] = self.discretization.rhs[i]);
        let problem = self.discrete.problem();
        let values = self.mass.consistent(&problem, &self.discretization, u, &self.plan.solver);
        u.copy_from_slice(&values.map_err(|e| self.discrete.explain(self.scene, e))?);
        Ok(())
    }

    fn slope(&mut self, t: f64, u: &[f64], out: &mut [f64]) -> Result<(), Error> {
        self.move_to(t)?;
        let given = self.given_rates(t, u)?;
        let problem = self.discrete.problem();
        let residual = residual(&self.discretization, u)?;
        let rates = self.mass.rates(&problem, &self.discretization, &residual, &given, &self.plan.solver);
        out.copy_from_slice(&rates.map_err(|e| self.discrete.explain(self.scene, e))?);
        Ok(())
    }

    fn solve(&mut self, t: f64, c: f64, v: &[f64], u: &mut [f64]) -> Result<(), Error> {
        self.move_to(t)?;
        let held = self.mass.times(v);
        let rhs: Vec<f64> = self.discretization.rhs.iter().zip(held).map(|(b, m)| b + m / c).collect();
        let (solved, split) = self.solve_for(c, &rhs)?;
        u.copy_from_slice(&solved);
        self.split = split;
        Ok(())
    }

    fn damp(&mut self, t: f64, c: f64, e: &mut [f64]) -> Result<(), Error> {
        self.move_to(t)?;
        // Values that are prescribed, or follow from equations, have no error of their own; with a mass that is not diagonal
        // it would count for their neighbours.
        self.mass.algebraic().for_each(|i| e[i] = 0.0);
        let kinds = self.discretization.kinds.iter();
        e.iter_mut().zip(kinds).filter(|(_, k)| **k == RowKind::Dirichlet).for_each(|(e, _)| *e = 0.0);
        self.decay(t, c, e)
    }

    fn decay(&mut self, t: f64, c: f64, e: &mut [f64]) -> Result<(), Error> {
        self.move_to(t)?;
        let rhs: Vec<f64> = self.mass.times(e).into_iter().map(|m| m / c).collect();
        e.copy_from_slice(&self.solve_for(c, &rhs)?.0);
        Ok(())
    }

    fn algebraic(&self, unknowns: usize) -> Vec<bool> {
        let mut algebraic = match &self.mass {
            Mass::Diagonal(mass) => mass.iter().map(|&m| m == 0.0).collect(),
            Mass::Rows(_) => self.prescribed(),
        };
        self.mass.algebraic().for_each(|i| algebraic[i] = true);
        algebraic.resize(unknowns, true);
        algebraic
    }

    fn changes(&self) -> usize {
        self.changes
    }

    fn may_grow(&self) -> bool {
        self.may_grow
    }

    fn norm(&self, e: &[f64]) -> f64 {
        let volumes = &self.discretization.volumes;
        let sum: f64 = e.iter().zip(volumes).map(|(e, v)| v * e * e).sum();
        (sum / volumes.iter().sum::<f64>()).sqrt()
    }
}
