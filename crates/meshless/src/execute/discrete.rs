//! The discretised problem of a scene, with everything it borrows from.

use std::time::Instant;

use meshless_geometry::{Cloud, Domain, RegionMap};
use meshless_interfaces::phase_field::{PhaseFieldParams, regions_from_labels};
use meshless_interfaces::{
    BoundaryData, Condition, InterfaceLaw, Material, MethodError, Problem, SlitInterface, Supports,
};
use meshless_neighbors::{Distance, NeighborLists, Radius, within_radius};

use super::Progress;
use crate::Error;
use crate::build::{self, Boundary};
use crate::plan::{Plan, Stage};
use crate::report::Seconds;
use crate::scene::Scene;

/// Cloud, supports, coefficients and conditions of a scene.
pub(crate) struct Discrete<const D: usize> {
    pub(crate) domain: Domain<D>,
    pub(crate) regions: RegionMap<D>,
    pub(crate) cloud: Cloud<D>,
    pub(crate) labels: Vec<u16>,
    pub(crate) eta: Vec<f64>,
    radius: Vec<f64>,
    lists: NeighborLists,
    materials: Vec<Material<D>>,
    source: Option<Vec<f64>>,
    boundary: Boundary<D>,
    conditions: Vec<Vec<Condition>>,
    laws: Vec<InterfaceLaw<D>>,
    law_rates: Vec<InterfaceLaw<D>>,
    slits: Vec<SlitInterface<D>>,
}

/// A region that is too thin is a matter of the scene.
fn explain_phase_field(scene: &Scene, error: MethodError) -> Error {
    match error {
        MethodError::LostRegion { region, ref position } => {
            let spec = &scene.regions[region as usize];
            let message = format!(
                "the region \"{}\" is too thin near {position:?} for its interface to be found from labels",
                spec.name
            );
            let help =
                "a layer must be about two nodes thick: give more points, or the shapes of the regions";
            spec.place.error(message, help).into()
        }
        error => error.into(),
    }
}

/// The exact solution at the nodes.
pub(crate) struct Exact<const D: usize> {
    pub(crate) values: Vec<f64>,
    pub(crate) gradients: Vec<[f64; D]>,
}

impl<const D: usize> Discrete<D> {
    pub(super) fn build(
        scene: &Scene,
        plan: &Plan,
        progress: &mut dyn Progress,
        seconds: &mut Seconds,
    ) -> Result<Self, Error> {
        progress.stage(Stage::Points);
        let start = Instant::now();
        let domain = build::domain::<D>(scene)?;
        let build::Placed { cloud, mut regions, labels: given } =
            build::place(scene, plan.method.at_corners(scene), &domain)?;
        seconds.points = start.elapsed().as_secs_f64();

        progress.stage(Stage::Neighbors);
        let start = Instant::now();
        let radius: Vec<f64> = cloud.spacing().iter().map(|s| plan.method.support * s).collect();
        let lists = within_radius(cloud.points(), Radius::PerPoint(&radius), Distance::D2)?;
        seconds.neighbors = start.elapsed().as_secs_f64();

        let start = Instant::now();
        let labels = if plan.runs(Stage::Regions) {
            progress.stage(Stage::Regions);
            let labels = given.unwrap_or_else(|| regions.labels_within(&domain, &cloud));
            build::check_regions_are_met(scene, &labels)?;
            build::check_interfaces_touch(scene, &labels, &lists)?;
            labels
        } else {
            vec![0; cloud.len()]
        };
        if plan.runs(Stage::PhaseField) {
            progress.stage(Stage::PhaseField);
            let params = PhaseFieldParams::default();
            (regions, _) = regions_from_labels(&cloud, &lists, &labels, scene.regions.len(), &params)
                .map_err(|e| explain_phase_field(scene, e))?;
        }
        let materials = build::materials::<D>(scene);
        let eta = build::nodal_diffusivity(scene, &materials, cloud.points(), &labels)?;
        build::check_coefficients(scene, &materials, cloud.points(), &labels)?;
        if plan.method.params.needs_smooth_diffusivity() {
            build::check_diffusivity_is_smooth(scene, &materials, &regions, &cloud, &labels, &lists, &eta)?;
        }
        let source = plan
            .runs(Stage::Source)
            .then(|| build::nodal_source(scene, &materials, cloud.points(), &labels))
            .transpose()?;
        let boundary = Boundary::new(scene, &domain);
        let conditions = boundary.at_nodes(scene, &domain, &cloud)?;
        boundary.check_is_met(scene, &domain, &cloud)?;
        let (laws, law_rates) = (build::laws::<D>(scene), build::law_rates::<D>(scene));
        let slits = build::slits(scene, &domain)?;
        seconds.stencils = start.elapsed().as_secs_f64();
        Ok(Self {
            domain,
            regions,
            cloud,
            labels,
            eta,
            radius,
            lists,
            materials,
            source,
            boundary,
            conditions,
            laws,
            law_rates,
            slits,
        })
    }

    /// Makes the data anew, as the scene has them at another time; nodes and regions stay.
    pub(super) fn set_data(&mut self, scene: &Scene, plan: &Plan) -> Result<(), Error> {
        let (points, labels) = (self.cloud.points(), &self.labels);
        self.materials = build::materials::<D>(scene);
        self.eta = build::nodal_diffusivity(scene, &self.materials, points, labels)?;
        build::check_coefficients(scene, &self.materials, points, labels)?;
        self.source = plan
            .runs(Stage::Source)
            .then(|| build::nodal_source(scene, &self.materials, points, labels))
            .transpose()?;
        self.boundary = Boundary::new(scene, &self.domain);
        self.conditions = self.boundary.at_nodes(scene, &self.domain, &self.cloud)?;
        self.laws = build::laws::<D>(scene);
        self.law_rates = build::law_rates::<D>(scene);
        self.slits = build::slits(scene, &self.domain)?;
        Ok(())
    }

    /// The values that a scene prescribes at the nodes.
    pub(super) fn prescribed_at(&self, scene: &Scene) -> Result<Vec<Option<f64>>, Error> {
        let boundary = Boundary::new(scene, &self.domain);
        let conditions = boundary.at_nodes(scene, &self.domain, &self.cloud)?;
        Ok(Problem { conditions: &conditions, ..self.problem() }.dirichlet())
    }

    /// The problem as methods see it.
    pub(crate) fn problem(&self) -> Problem<'_, D> {
        Problem {
            cloud: &self.cloud,
            domain: &self.domain,
            supports: Supports { lists: &self.lists, radius: &self.radius },
            regions: &self.regions,
            labels: &self.labels,
            materials: &self.materials,
            eta: &self.eta,
            source: self.source.as_deref(),
            conditions: &self.conditions,
            boundary: &self.boundary as &dyn BoundaryData<D>,
            laws: &self.laws,
            law_rates: &self.law_rates,
            slits: &self.slits,
        }
    }

    /// Measure that belongs to each node: `spacing^D`, half of it on a face, a quarter on an edge, an eighth at a corner.
    pub(crate) fn measures(&self) -> Vec<f64> {
        let mut measures: Vec<f64> = self.cloud.spacing().iter().map(|s| s.powi(D as i32)).collect();
        for node in self.cloud.boundary() {
            measures[node.node as usize] *= 0.5_f64.powi(node.touches.len().min(D) as i32);
        }
        measures
    }

    /// The exact solution and its gradient at the nodes, each in its own region.
    pub(crate) fn exact(&self, scene: &Scene) -> Result<Exact<D>, Error> {
        build::exact(scene, self.cloud.points(), &self.labels)
    }

    /// An error of a method or of the solver, in terms of the scene where that is possible.
    pub(super) fn explain(&self, scene: &Scene, error: MethodError) -> Error {
        match error {
            MethodError::NoCondition { node, ref position } => {
                build::missing_condition(scene, &self.cloud, node, position)
            }
            error => {
                Error::Method(error.named(|place| Some(scene.regions.get(place as usize)?.name.clone())))
            }
        }
    }
}
