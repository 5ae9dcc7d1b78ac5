//! Problems made by hand: a domain, a cloud, regions by shapes, conditions by a closure.

use std::sync::Arc;

use meshless_geometry::{
    BoundaryNode, Cloud, CloudParams, Domain, FaceId, Layout, RegionMap, Shape, Spacing, Touch, generate,
};
use meshless_interfaces::gfdm::{Gfdm, GfdmParams};
use meshless_interfaces::{
    BoundaryData, Condition, Discretization, Field, InterfaceLaw, Material, Method, MethodError, Problem,
    SlitInterface, Supports, SystemSolution, solve,
};
use meshless_neighbors::{Distance, NeighborLists, Radius, within_radius};

/// Interaction radius in spacings.
pub(crate) const SUPPORT: f64 = 2.5;

type ConditionFn<const D: usize> = Arc<dyn Fn(FaceId, &[f64; D]) -> Condition + Send + Sync>;

/// Everything that a [`Problem`] borrows.
#[derive(Clone)]
pub(crate) struct Setup<const D: usize> {
    pub(crate) domain: Domain<D>,
    pub(crate) cloud: Cloud<D>,
    pub(crate) labels: Vec<u16>,
    pub(crate) eta: Vec<f64>,
    radius: Vec<f64>,
    lists: NeighborLists,
    regions: RegionMap<D>,
    materials: Vec<Material<D>>,
    source: Option<Vec<f64>>,
    condition: ConditionFn<D>,
    conditions: Vec<Vec<Condition>>,
    pub(crate) laws: Vec<InterfaceLaw<D>>,
    pub(crate) slits: Vec<SlitInterface<D>>,
}

impl<const D: usize> BoundaryData<D> for Setup<D> {
    fn condition(&self, face: FaceId, point: &[f64; D]) -> Option<Condition> {
        Some((self.condition)(face, point))
    }
}

impl<const D: usize> Setup<D> {
    /// One region with diffusivity 1, no source, u = 0 on the boundary.
    pub(crate) fn new(domain: Domain<D>, cloud: Cloud<D>) -> Self {
        let radius: Vec<f64> = cloud.spacing().iter().map(|s| SUPPORT * s).collect();
        let lists = within_radius(cloud.points(), Radius::PerPoint(&radius), Distance::D2).unwrap();
        let n = cloud.len();
        Self {
            domain,
            cloud,
            labels: vec![0; n],
            eta: vec![1.0; n],
            radius,
            lists,
            regions: RegionMap::new(vec![None]).unwrap(),
            materials: Vec::new(),
            source: None,
            condition: Arc::new(|_, _| Condition::Dirichlet(0.0)),
            conditions: Vec::new(),
            laws: Vec::new(),
            slits: Vec::new(),
        }
        .regions(vec![None], &[1.0])
        .conditions(|_, _| Condition::Dirichlet(0.0))
    }

    /// A generated cloud.
    pub(crate) fn generated(domain: Domain<D>, layout: Layout, spacing: f64, seed: u64) -> Self {
        let params = CloudParams { spacing: Spacing::Uniform(spacing), layout, seed, max_nodes: 100_000 };
        let cloud = generate(&domain, &params).unwrap();
        Self::new(domain, cloud)
    }

    /// Another radius of interaction, in spacings.
    pub(crate) fn with_support(mut self, support: f64) -> Self {
        self.radius = self.cloud.spacing().iter().map(|s| support * s).collect();
        self.lists =
            within_radius(self.cloud.points(), Radius::PerPoint(&self.radius), Distance::D2).unwrap();
        self
    }

    /// Regions by shapes, the background last, each with a constant diffusivity.
    pub(crate) fn regions(mut self, shapes: Vec<Option<Shape<D>>>, eta: &[f64]) -> Self {
        self.regions = RegionMap::new(shapes).unwrap();
        self.labels = self.regions.labels(&self.cloud);
        self.eta = self.labels.iter().map(|&l| eta[l as usize]).collect();
        let material = |&eta: &f64| Material::new(Field::Constant(eta));
        self.materials = eta.iter().map(material).collect();
        self
    }

    /// A source by region and position.
    pub(crate) fn source(mut self, f: impl Fn(u16, &[f64; D]) -> f64) -> Self {
        self.source = Some(self.labels.iter().zip(self.cloud.points()).map(|(&l, x)| f(l, x)).collect());
        self
    }

    /// Sources of the regions, at the nodes and anywhere else.
    pub(crate) fn sources(mut self, fields: Vec<Field<D>>) -> Self {
        let nodes = self.labels.iter().zip(self.cloud.points());
        self.source = Some(nodes.map(|(&l, x)| fields[l as usize].at(x)).collect());
        self.materials.iter_mut().zip(fields).for_each(|(m, f)| m.source = Some(f));
        self
    }

    /// Conditions by face and position.
    pub(crate) fn conditions(
        mut self,
        f: impl Fn(FaceId, &[f64; D]) -> Condition + Send + Sync + 'static,
    ) -> Self {
        self.conditions = (self.cloud.boundary().iter())
            .map(|b| b.touches.iter().map(|t| f(t.face, &self.cloud.points()[b.node as usize])).collect())
            .collect();
        self.condition = Arc::new(f);
        self
    }

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
            boundary: self,
            laws: &self.laws,
            law_rates: &[],
            slits: &self.slits,
        }
    }

    pub(crate) fn discretize(&self, params: GfdmParams) -> Discretization {
        Gfdm { params }.discretize(&self.problem()).unwrap()
    }

    pub(crate) fn try_solve(&self, params: GfdmParams) -> Result<SystemSolution, MethodError> {
        let problem = self.problem();
        solve(&problem, &Gfdm { params }.discretize(&problem)?, &Default::default())
    }

    /// The solution by any method.
    pub(crate) fn solve_by(&self, method: &impl Method<D>) -> Vec<f64> {
        let problem = self.problem();
        solve(&problem, &method.discretize(&problem).unwrap(), &Default::default()).unwrap().u
    }

    /// Other diffusivities of the regions, with the same values at the nodes.
    pub(crate) fn set_diffusivities(&mut self, fields: Vec<Field<D>>) {
        self.materials.iter_mut().zip(fields).for_each(|(m, f)| m.diffusivity = f);
    }

    pub(crate) fn solve(&self, params: GfdmParams) -> Vec<f64> {
        self.try_solve(params).unwrap().u
    }

    /// Values of a function of region and position at the nodes.
    pub(crate) fn nodal(&self, f: impl Fn(u16, &[f64; D]) -> f64) -> Vec<f64> {
        self.labels.iter().zip(self.cloud.points()).map(|(&l, x)| f(l, x)).collect()
    }
}

/// The box `[0, 1]^D`, or part of it where `max` is less.
pub(crate) fn unit<const D: usize>() -> Domain<D> {
    Domain::boxed([0.0; D], [1.0; D]).unwrap()
}

/// Outward normal of a face of a box: the axis and its sign.
pub(crate) fn box_normal<const D: usize>(face: FaceId) -> [f64; D] {
    let mut normal = [0.0; D];
    normal[face.0 as usize / 2] = if face.0.is_multiple_of(2) { -1.0 } else { 1.0 };
    normal
}

/// The condition of one kind (0 Dirichlet, 1 Neumann, 2 flux, 3 Robin) that value and normal derivative satisfy.
pub(crate) fn condition_of_kind(kind: u8, u: f64, derivative: f64, eta: f64) -> Condition {
    match kind {
        0 => Condition::Dirichlet(u),
        1 => Condition::Neumann(derivative),
        2 => Condition::Flux(eta * derivative),
        _ => Condition::Robin { a: 1.3, b: 0.7, g: 1.3 * u + 0.7 * eta * derivative },
    }
}

/// A regular grid of `n` intervals along every axis of the unit box, of which only the nodes that pass are kept.
pub(crate) fn grid<const D: usize>(n: usize, keep: impl Fn(&[usize; D]) -> bool) -> Cloud<D> {
    let (mut points, mut boundary) = (Vec::new(), Vec::new());
    for k in 0..(n + 1).pow(D as u32) {
        let index: [usize; D] = std::array::from_fn(|axis| k / (n + 1).pow(axis as u32) % (n + 1));
        if !keep(&index) {
            continue;
        }
        let mut touches = Vec::new();
        for axis in 0..D {
            for (at, face) in [(0, 2 * axis), (n, 2 * axis + 1)] {
                if index[axis] == at {
                    let face = FaceId(face as u16);
                    touches.push(Touch { face, normal: box_normal(face) });
                }
            }
        }
        if !touches.is_empty() {
            boundary.push(BoundaryNode { node: points.len() as u32, touches });
        }
        points.push(index.map(|i| i as f64 / n as f64));
    }
    let spacing = vec![1.0 / n as f64; points.len()];
    Cloud::from_parts(points, boundary, spacing).unwrap()
}

pub(crate) fn dot<const D: usize>(a: &[f64; D], b: &[f64; D]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

pub(crate) fn max_difference(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    assert!(a.iter().chain(b).all(|x| x.is_finite()));
    a.iter().zip(b).fold(0.0, |m, (a, b)| m.max((a - b).abs()))
}

/// Root mean square of the difference, relative to that of `exact`.
pub(crate) fn relative_l2(u: &[f64], exact: &[f64]) -> f64 {
    assert_eq!(u.len(), exact.len());
    let sum = |f: &dyn Fn(usize) -> f64| (0..u.len()).map(|i| f(i).powi(2)).sum::<f64>();
    (sum(&|i| u[i] - exact[i]) / sum(&|i| exact[i])).sqrt()
}
