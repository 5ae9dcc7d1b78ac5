//! `M du/dt + A u = b(t)`: the rows of a spatial method in time.

use std::time::Instant;

use meshless_interfaces::{Discretization, Method, PreparedSystem, RowKind, SystemParams};
use meshless_sparse::{DifferenceMatrix, SolveInfo};
use meshless_time::Semidiscrete;

use super::super::{Discrete, Progress};
use crate::Error;
use crate::plan::{Plan, Stage};
use crate::report::Seconds;
use crate::scene::{Scene, Varying};

/// The rows of a scene at one time, and what is made of them.
///
/// The mass of a row is the volume that it stands for. Boundary rows and prescribed values have none.
pub(super) struct Heat<'a, const D: usize> {
    scene: &'a Scene,
    plan: &'a Plan,
    varying: Varying,
    discrete: Discrete<D>,
    method: Box<dyn Method<D>>,
    /// The scene as it is at the time for which `discretization` holds.
    now: Scene,
    discretization: Discretization,
    mass: Vec<f64>,
    prepared: Option<Matrix>,
    info: Option<SolveInfo>,
    /// Matrices that were factored.
    pub(super) matrices: usize,
    seconds: Seconds,
}

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
        let mass = masses(&discretization);
        Ok(Self {
            scene,
            plan,
            varying: scene.varying(),
            discrete,
            method,
            now: scene.at_time(0.0),
            discretization,
            mass,
            prepared: None,
            info: None,
            matrices: 0,
            seconds,
        })
    }

    pub(super) fn nodes(&self) -> usize {
        self.mass.len()
    }

    pub(super) fn discrete(&self) -> &Discrete<D> {
        &self.discrete
    }

    pub(super) fn discretization(&self) -> &Discretization {
        &self.discretization
    }

    /// The discretisation at `end`, how the last system was solved, and what it took.
    pub(super) fn into_parts(
        mut self,
        end: f64,
    ) -> Result<(Discrete<D>, Discretization, SolveInfo, Seconds), Error> {
        self.move_to(end)?;
        let info = match self.info.take() {
            Some(info) => info,
            // A checkpoint at the very end leaves nothing to solve.
            None => {
                self.solve_for(DEFAULT_C, self.discretization.rhs.clone())?;
                self.info.take().ok_or_else(|| Error::Time("no system was solved".to_owned()))?
            }
        };
        Ok((self.discrete, self.discretization, info, self.seconds))
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
            self.mass = masses(&self.discretization);
            self.prepared = None;
        }
        Ok(())
    }

    /// Solves `(M / c + A) u = rhs`.
    fn solve_for(&mut self, c: f64, rhs: Vec<f64>) -> Result<Vec<f64>, Error> {
        let start = Instant::now();
        if self.prepared.as_ref().is_none_or(|m| m.c != c) {
            let split_floating = self.plan.runs(Stage::FloatingConstants);
            let params = SystemParams { solver: self.plan.solver, split_floating };
            let rows = self.shifted(c)?;
            let system = match self.prepared.take() {
                Some(old) => old.system.renewed(rows, &params),
                None => {
                    let kinds = &self.discretization.kinds;
                    let known: Vec<bool> = kinds.iter().map(|&k| k == RowKind::Dirichlet).collect();
                    PreparedSystem::new(&self.discrete.problem(), rows, &known, &params)
                }
            };
            let system = system.map_err(|e| self.discrete.explain(self.scene, e))?;
            self.prepared = Some(Matrix { c, system });
            self.matrices += 1;
        }
        let Some(Matrix { system, .. }) = &self.prepared else { return Ok(rhs) };
        let (u, info) = system.solve(&rhs).map_err(|e| self.discrete.explain(self.scene, e))?;
        self.info = Some(info);
        self.seconds.solve += start.elapsed().as_secs_f64();
        Ok(u)
    }

    /// `M / c + A` in difference form: the mass goes to the sums of rows, no diagonal is formed.
    fn shifted(&self, c: f64) -> Result<DifferenceMatrix, Error> {
        let rows = &self.discretization.rows;
        let shifted = DifferenceMatrix::from_rows(rows.n(), |i, out| {
            let (columns, values) = rows.row(i);
            columns.iter().zip(values).for_each(|(&j, &a)| out.push(j as usize, a));
            out.add_to_row_sum(rows.row_sum(i) + self.mass[i] / c);
        });
        shifted.map_err(|e| Error::Time(e.to_string()))
    }
}

/// A step size for a solve of which only the report is wanted.
const DEFAULT_C: f64 = 1.0;

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

fn masses(discretization: &Discretization) -> Vec<f64> {
    let mass = |(kind, volume): (&RowKind, &f64)| match kind {
        RowKind::Dirichlet | RowKind::StrongBoundary => 0.0,
        _ => *volume,
    };
    discretization.kinds.iter().zip(&discretization.volumes).map(mass).collect()
}

impl<const D: usize> Semidiscrete for Heat<'_, D> {
    type Error = Error;

    fn slope(&mut self, t: f64, u: &[f64], out: &mut [f64]) -> Result<(), Error> {
        self.move_to(t)?;
        self.discretization.rows.residual(u, &self.discretization.rhs, out);
        self.mass.iter().zip(out).for_each(|(m, r)| *r = if *m > 0.0 { *r / m } else { 0.0 });
        Ok(())
    }

    fn solve(&mut self, t: f64, c: f64, v: &[f64], u: &mut [f64]) -> Result<(), Error> {
        self.move_to(t)?;
        let rhs = &self.discretization.rhs;
        let rhs =
            (0..rhs.len()).map(|i| rhs[i] + if self.mass[i] > 0.0 { self.mass[i] / c * v[i] } else { 0.0 });
        let rhs = rhs.collect();
        u.copy_from_slice(&self.solve_for(c, rhs)?);
        Ok(())
    }

    fn damp(&mut self, t: f64, c: f64, e: &mut [f64]) -> Result<(), Error> {
        self.move_to(t)?;
        let rhs =
            (0..e.len()).map(|i| if self.mass[i] > 0.0 { self.mass[i] / c * e[i] } else { 0.0 }).collect();
        e.copy_from_slice(&self.solve_for(c, rhs)?);
        Ok(())
    }

    fn norm(&self, e: &[f64]) -> f64 {
        let volumes = &self.discretization.volumes;
        let sum: f64 = e.iter().zip(volumes).map(|(e, v)| v * e * e).sum();
        (sum / volumes.iter().sum::<f64>()).sqrt()
    }
}
