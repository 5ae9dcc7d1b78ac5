//! The plan: what a scene calls for and how it will be solved, as plain data.
//!
//! A plan is made by a pure function of the scene, [`Plan::new`]; it builds no cloud and solves nothing. Execution does
//! what the plan says and nothing else, so what a plan skips costs nothing.

mod accuracy;
mod choose;
mod effects;
mod fallback;
mod free_space;
mod knows;
mod method;
mod predict;
mod show;
mod steps;

use meshless_sparse::SolverParams;

use crate::build::AtCorners;
use crate::scene::{MethodName, Scene};
use crate::{Error, build};

pub use accuracy::AccuracyPlan;
pub use effects::Effect;
pub use method::{FreeSpaceParams, MethodParams, Transforms};
pub use predict::Predicted;
pub use steps::PredictedSteps;

/// What will be done, in order.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// Dimension of the scene.
    pub dimension: usize,
    /// What the scene calls for.
    pub effects: Vec<Effect>,
    /// The spatial method.
    pub method: MethodPlan,
    /// What is taken where the nodes turn out not to resolve a gap or a layer; `None` where that is an error.
    pub fallback: Option<MethodName>,
    /// The smallest spacing that gaps and layers are refined to; `None` where the cloud does not know of them.
    pub refine_gaps_to: Option<f64>,
    /// Whether the cloud is finer round corners at which the solution is singular.
    pub adapts: bool,
    /// Whether it is finer where the data vary below the spacing.
    pub adapts_to_data: bool,
    /// The linear solver.
    pub solver: SolverParams,
    /// The error to reach by smaller and smaller spacings; without one the scene is solved once.
    pub accuracy: Option<AccuracyPlan>,
    /// The stages that will run.
    pub stages: Vec<Stage>,
    /// What will not run, and why.
    pub skipped: Vec<Skipped>,
    /// What it is expected to take.
    pub predicted: Predicted,
}

/// The spatial method and its parameters.
#[derive(Debug, Clone, PartialEq)]
pub struct MethodPlan {
    /// Its name in the scene; never `auto`.
    pub name: MethodName,
    /// Why it was taken.
    pub why: String,
    /// Interaction radius in units of the spacing.
    pub support: f64,
    /// Its parameters.
    pub params: MethodParams,
}

impl MethodPlan {
    /// What it makes of the corners of a scene.
    pub(crate) fn at_corners(&self, scene: &Scene) -> AtCorners {
        let serves = self.name == MethodName::Sharp && scene.time.is_none();
        AtCorners { order: self.params.order(), serves }
    }
}

/// A step of the execution.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Stage {
    /// Generate the cloud.
    Points,
    /// Find the supports.
    Neighbors,
    /// Find the region of every node.
    Regions,
    /// Find interfaces from the regions of the nodes alone, by a phase field.
    PhaseField,
    /// Evaluate the diffusivity at the nodes.
    Diffusivity,
    /// Evaluate the source at the nodes.
    Source,
    /// Least-squares stencils of the Laplacian, times a constant.
    LaplacianStencils,
    /// Least-squares stencils of `div(eta grad u)`, with a gradient of eta.
    DiffusionStencils,
    /// Stencils near interfaces that the conditions there are built into.
    ConstrainedStencils,
    /// Find the nodes whose rows must be conservative.
    NodeSelection,
    /// Functions in place of polynomials near corners at which the solution is singular.
    CornerFunctions,
    /// Voronoi cells of the conservative nodes, and balances over them.
    Cells,
    /// Put the rows together and eliminate prescribed values.
    Assembly,
    /// Find floating stiff regions and split off their constants.
    FloatingConstants,
    /// Solve the linear system.
    Solve,
    /// Step through time.
    TimeSteps,
    /// The velocity at the nodes, in free space.
    Velocity,
    /// The gradient at the nodes.
    Gradient,
    /// Errors against the exact solution.
    Errors,
    /// Values at the probes.
    Probes,
    /// Fluxes through boundaries and interfaces.
    Fluxes,
    /// What enters, arises and is stored, and what of that is left over.
    Balance,
    /// Solve on a coarser cloud to estimate the error.
    Estimate,
    /// Condition, residual and signs of every node's stencil and row.
    Diagnosis,
    /// Solve anew at smaller spacings until the estimate meets the tolerance.
    Refinement,
    /// Write the fields for ParaView.
    Vtu,
    /// Write the fields as comma-separated numbers.
    Csv,
    /// Draw the solution.
    Plot,
}

impl Stage {
    /// Whether the stage makes something of a solution rather than the solution.
    fn is_derived(self) -> bool {
        matches!(
            self,
            Self::Gradient
                | Self::Errors
                | Self::Probes
                | Self::Fluxes
                | Self::Balance
                | Self::Estimate
                | Self::Diagnosis
                | Self::Vtu
                | Self::Csv
                | Self::Plot
        )
    }
}

/// Something that will not run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Skipped {
    /// What.
    pub what: &'static str,
    /// Why.
    pub why: &'static str,
}

impl Plan {
    /// Works out the plan of a scene.
    pub fn new(scene: &Scene) -> Result<Self, Error> {
        let survey = effects::Survey::of(scene)?;
        if scene.free_space.is_some() {
            knows::check(MethodName::FreeSpace, scene, &survey)?;
            return free_space::plan(scene, survey);
        }
        let method = choose::method_plan(scene, &survey)?;
        let predicted = predict::predict(scene, &survey, &method)?;
        let solver = choose::solver(scene, &survey, method.name, predicted.unknowns);
        let (stages, skipped) = choose::stages(scene, &survey, &method);
        if scene.output.fluxes && !stages.contains(&Stage::Fluxes) {
            let message =
                format!("`output.fluxes`: \"{}\" has no gradients up to interfaces", method.name.as_str());
            let help = if scene.is_labelled() {
                "take the method \"gfdm-hybrid\" or \"gfdm-conservative\", whose balances have the fluxes, or remove the key"
            } else {
                "take the method \"sharp\", which has, or \"gfdm-conservative\", or remove the key"
            };
            return Err(scene.domain.place.error(message, help).into());
        }
        let has_corners = survey.has(|effect| matches!(effect, Effect::Corners { .. }));
        let adapts_to_data = build::has_features(scene, method.params.order())?;
        Ok(Self {
            dimension: scene.dimension,
            adapts_to_data,
            adapts: scene.points.corners.is_some() && has_corners,
            effects: survey.effects,
            fallback: fallback::of(scene, &method),
            refine_gaps_to: scene.points.gaps.map(|gaps| gaps.least),
            method,
            solver,
            accuracy: AccuracyPlan::new(scene),
            stages,
            skipped,
            predicted,
        })
    }

    /// Whether a method knows all effects of the scene.
    pub(crate) fn is_known_to(&self, name: MethodName) -> bool {
        knows::all(name, &self.effects)
    }

    /// Whether a stage will run.
    pub fn runs(&self, stage: Stage) -> bool {
        self.stages.contains(&stage)
    }

    /// Whether something jumps at an interface.
    pub fn has_interface(&self) -> bool {
        self.effects.iter().any(Effect::is_at_interface)
    }

    /// The order in the spacing at which the error falls, as far as the plan can promise it: one at slits, whose tips are
    /// singular, and where interfaces are known from labels only, to a share of the spacing; else that of the method.
    pub fn expected_order(&self) -> usize {
        let params = &self.method.params;
        if self.effects.contains(&Effect::Slits) || self.runs(Stage::PhaseField) {
            1
        } else if self.has_interface() {
            params.interface_order()
        } else {
            params.order()
        }
    }

    /// The method by which the error is estimated on the same cloud; `None` where a coarser cloud is compared.
    pub(crate) fn finer(&self) -> Option<MethodParams> {
        // A higher order knows no more of interfaces from labels.
        let serves = !self.runs(Stage::TimeSteps) && !self.runs(Stage::PhaseField);
        self.method.params.finer(self.dimension).filter(|_| serves)
    }

    /// The same plan without what a coarser companion solve does not need.
    pub(crate) fn companion(&self) -> Self {
        let mut plan = self.clone();
        plan.stages.retain(|stage| !stage.is_derived());
        plan
    }
}
