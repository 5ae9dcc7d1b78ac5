//! A plan in words.

use std::fmt;

use meshless_interfaces::thin_layers;
use meshless_sparse::{AUTO_RESTART, SolverKind};

use super::{AccuracyPlan, MethodParams, Plan, Stage};

impl Stage {
    /// The name used in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Points => "points",
            Self::Neighbors => "neighbour lists",
            Self::Regions => "regions",
            Self::PhaseField => "phase field",
            Self::Diffusivity => "nodal diffusivity",
            Self::Source => "source",
            Self::LaplacianStencils => "Laplacian stencils",
            Self::DiffusionStencils => "diffusion stencils",
            Self::ConstrainedStencils => "constrained stencils",
            Self::NodeSelection => "node selection",
            Self::CornerFunctions => "corner functions",
            Self::Cells => "Voronoi cells",
            Self::Assembly => "assembly",
            Self::FloatingConstants => "floating constants",
            Self::Solve => "solve",
            Self::TimeSteps => "time",
            Self::Velocity => "velocity",
            Self::Gradient => "gradient",
            Self::Errors => "errors",
            Self::Probes => "probes",
            Self::Fluxes => "fluxes",
            Self::Balance => "balance",
            Self::Estimate => "error estimate",
            Self::Diagnosis => "stencil diagnosis",
            Self::Refinement => "refinement",
            Self::Vtu => "vtu output",
            Self::Csv => "csv output",
            Self::Plot => "plot",
        }
    }
}

impl Plan {
    /// In free space, the fields that are transformed, and those that are transformed back; nothing else is.
    pub fn transforms(&self) -> Option<[Vec<String>; 2]> {
        match &self.method.params {
            MethodParams::FreeSpace(params) => Some(params.transforms.names(self.dimension)),
            _ => None,
        }
    }

    /// What the error is estimated from, in words; `None` where it is not.
    pub fn estimate_name(&self) -> Option<String> {
        let compares =
            self.runs(Stage::Estimate) && !matches!(self.method.params, MethodParams::FreeSpace(_));
        let coarser = || "from a cloud of twice the spacing".to_owned();
        compares.then(|| match self.finer() {
            Some(MethodParams::Sharp(finer)) => format!("from fits of degree {}", finer.degree()),
            _ => coarser(),
        })
    }

    /// The linear solver in words.
    pub fn solver_name(&self) -> String {
        if matches!(self.method.params, MethodParams::FreeSpace(_)) {
            return "fft".to_owned();
        }
        let preconditioner = self.solver.preconditioner.name();
        match self.solver.kind {
            SolverKind::BiCgStab { l } => format!("bicgstab({l}) + {preconditioner}"),
            SolverKind::Gmres { restart } => format!("gmres({restart}) + {preconditioner}"),
            SolverKind::Multigrid => format!("gmres({AUTO_RESTART}) + {preconditioner}"),
            _ => "direct".to_owned(),
        }
    }
}

impl fmt::Display for Plan {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "dimension   {}", self.dimension)?;
        let effects: Vec<String> = self.effects.iter().map(ToString::to_string).collect();
        writeln!(
            f,
            "effects     {}",
            if effects.is_empty() { "none".to_owned() } else { effects.join(", ") }
        )?;
        writeln!(f, "method      {} ({})", self.method.name.as_str(), self.method.why)?;
        if let Some(fallback) = self.fallback {
            writeln!(
                f,
                "fallback    {}, where the nodes do not resolve a gap or a layer, or the solver gives up",
                fallback.as_str()
            )?;
        }
        if let Some(least) = self.refine_gaps_to {
            writeln!(
                f,
                "gaps        refined where they are thinner than {:.0} spacings, to spacings of {least:.2e} at least",
                thin_layers::RESOLVED
            )?;
        }
        if self.adapts {
            writeln!(
                f,
                "cloud       finer round the corners, and growing by a quarter of the distance from there"
            )?;
        }
        if self.adapts_to_data {
            writeln!(
                f,
                "cloud       finer where sources, diffusivities or conditions vary below the spacing"
            )?;
        }
        writeln!(f, "solver      {}", self.solver_name())?;
        if let Some([forward, back]) = self.transforms() {
            writeln!(f, "transforms  forward: {}; back: {}", forward.join(", "), back.join(", "))?;
        }
        if let Some(accuracy) = &self.accuracy {
            let AccuracyPlan { tolerance, of, max_nodes } = accuracy;
            let of = of.as_str();
            writeln!(f, "accuracy    relative error {tolerance:.1e} of {of}, at most {max_nodes:.0} nodes")?;
        }
        let stages: Vec<&str> = self.stages.iter().map(|s| s.name()).collect();
        writeln!(f, "stages      {}", stages.join(" -> "))?;
        for skipped in &self.skipped {
            writeln!(f, "skipped     {}: {}", skipped.what, skipped.why)?;
        }
        let p = &self.predicted;
        write!(
            f,
            "predicted   {:.0} unknowns, {}{:.2} s on one core{}, {:.0} MB",
            p.unknowns,
            p.steps.map_or_else(String::new, |time| format!("about {:.0} steps in time, ", time.steps)),
            p.seconds,
            self.estimate_name().map_or_else(String::new, |name| {
                format!(" ({:.2} s of it the error estimate, {name})", p.estimate_seconds)
            }),
            p.memory_mb
        )
    }
}
