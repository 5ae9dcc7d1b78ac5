//! The conservative operator: balance of fluxes over the Voronoi cell of a node (Kraus et al. 2022, section 2.2.2).
//!
//! Rows are integrated over the cell, `-sum_j |Gamma_ij| eta_ij (u_j - u_i) / d_ij = |Omega_i| f_i + boundary fluxes`,
//! and not divided by its volume as in (20): so the part of the matrix that couples two conservative nodes is symmetric.
//!
//! With a velocity, fluxes are those of Scharfetter and Gummel (D. L. Scharfetter, H. K. Gummel, IEEE Trans. Electron Devices 16, 1969): of the
//! solution of the equation along the way between two nodes. `F_ij = t (B(-P) u_i - B(P) u_j)` with `P = |Gamma_ij| v_n / t` and
//! `B(x) = x / (exp(x) - 1)` is antisymmetric; less what the velocity carries of `u_i`, as the equation has `v . grad u` and not
//! `div(v u)`, `t B(P) (u_i - u_j)` is left: the maximum principle holds at every Péclet number.

use meshless_cells::{
    Cell, CellError, CellFace, CellScratch, Container, Cut, FaceKind, Interfaces, Plane, Walls, voronoi_cell,
    voronoi_parts,
};
use meshless_geometry::FaceId;
use meshless_neighbors::CellList;

use super::source::{CellPart, Parts};
use super::walls::{self, Flat, FlatInterfaces, Level, cuts};
use crate::equation::Contact;
use crate::{Condition, MethodError, Problem};

/// By how much the search for the neighbours that close a cell is widened, at least: a cell that is open reports little
/// more than what has been searched.
const SEARCH_GROWTH: f64 = 1.3;

/// Smallest face that counts, relative to the largest of its cell: below it a face is round-off of a degenerate
/// Voronoi vertex, and its flux would be noise.
pub(super) const NEGLIGIBLE_FACE: f64 = 1e-12;

/// Least cosine between the way from node to node and the normal of an interface by which the area of a face is told from it.
const LEAST_SEEN: f64 = 0.2;

/// Distance, relative to the size of the domain, up to which a point is on a flat boundary: round-off of coordinates.
const ON_BOUNDARY: f64 = 1e-9;

/// The balance of one cell.
#[derive(Debug, Clone, Default)]
pub(super) struct CellRow {
    /// Neighbours and transmissibilities `|Gamma_ij| eta_ij / d_ij`.
    pub(super) entries: Vec<(u32, f64)>,
    pub(super) row_sum: f64,
    pub(super) rhs: f64,
    pub(super) volume: f64,
    /// The integral of the capacity.
    pub(super) capacity: f64,
}

impl CellRow {
    /// Adds what a part of a cell holds.
    pub(super) fn add(&mut self, part: &CellPart) {
        self.row_sum += part.reaction;
        self.rhs += part.source;
        self.capacity += part.capacity;
    }
}

/// What a face says of the nodes on its sides: `q = conducts (u_i / K_i - u_j / K_j) - given` leaves by conduction.
#[derive(Debug, Clone, Copy)]
pub(super) struct Crossing {
    pub(super) conducts: f64,
    /// The partition coefficients of both sides.
    pub(super) partition: [f64; 2],
    /// What the law of an interface adds.
    pub(super) given: f64,
    /// What the row of the node has in place of `conducts`, and of `given`: with what the velocity carries.
    pub(super) in_row: [f64; 2],
}

/// Builds the cells and their balances.
pub(super) struct CellBalance<'a, const D: usize> {
    pub(super) problem: &'a Problem<'a, D>,
    planes: Vec<Plane<D>>,
    /// Faces that are curved somewhere.
    levels: Vec<(FaceId, Level<'a, D>)>,
    /// Faces that are flat, and end at edges.
    flat: Flat<'a, D>,
    pub(super) interfaces: FlatInterfaces<'a, D>,
    index: CellList<'a, D>,
    /// The interaction radius if it is the same at all nodes.
    uniform_radius: Option<f64>,
}

/// Memory of one thread.
pub(super) struct BalanceScratch<'b, const D: usize> {
    cell: CellScratch,
    cuts: Vec<Cut<'b, D>>,
    wall_cuts: Vec<Cut<'b, D>>,
    found: Vec<u32>,
    candidates: Vec<(u32, [f64; D])>,
}

impl<'a, const D: usize> CellBalance<'a, D> {
    pub(super) fn new(problem: &'a Problem<'a, D>) -> Result<Self, MethodError> {
        let mut planes = Vec::new();
        if let Some(bounds) = problem.domain.outer_box() {
            for axis in 0..D {
                for (side, offset) in [(-1.0, -bounds.min[axis]), (1.0, bounds.max[axis])] {
                    let mut normal = [0.0; D];
                    normal[axis] = side;
                    planes.push(Plane { normal, offset, face: planes.len() as u16 });
                }
            }
        }
        let (levels, flat) = walls::faces(problem.domain);
        let interfaces = walls::interfaces(problem);
        let radius = problem.supports.radius;
        let (least, most) = radius.iter().fold((f64::INFINITY, 0.0_f64), |(l, m), &h| (l.min(h), m.max(h)));
        let index = CellList::new(problem.cloud.points(), most)?;
        Ok(Self {
            problem,
            planes,
            levels,
            flat,
            interfaces,
            index,
            uniform_radius: (least == most).then_some(most),
        })
    }

    /// Memory for one thread.
    pub(super) fn scratch(&self) -> BalanceScratch<'_, D> {
        BalanceScratch {
            cell: CellScratch::default(),
            cuts: cuts(&self.levels),
            wall_cuts: cuts(&self.flat.levels),
            found: Vec::new(),
            candidates: Vec::new(),
        }
    }

    /// The cell of node i, clipped to the domain.
    pub(super) fn cell(&self, i: usize, scratch: &mut BalanceScratch<'_, D>) -> Result<Cell<D>, MethodError> {
        let x = &self.problem.cloud.points()[i];
        self.with_candidates(i, scratch, |candidates, searched, container, scratch| {
            voronoi_cell(x, candidates, searched, container, scratch)
        })
    }

    /// The volumes of the regions in the cell of node i, by planes of the interfaces; `None` where there are too many of them.
    pub(super) fn volumes(
        &self,
        i: usize,
        scratch: &mut BalanceScratch<'_, D>,
    ) -> Result<Option<Vec<(u16, f64)>>, MethodError> {
        let x = &self.problem.cloud.points()[i];
        let label = |x: &[f64; D]| self.problem.regions.label(x, 0.0);
        let interfaces = Interfaces { walls: &self.interfaces.walls, label: &label };
        self.with_candidates(i, scratch, |candidates, searched, container, scratch| {
            voronoi_parts(x, candidates, searched, container, &interfaces, scratch)
        })
    }

    /// Calls `make` with ever more nodes, until these are enough.
    fn with_candidates<T>(
        &self,
        i: usize,
        scratch: &mut BalanceScratch<'_, D>,
        make: impl Fn(&[(u32, [f64; D])], f64, &Container<'_, D>, &mut CellScratch) -> Result<T, CellError>,
    ) -> Result<T, MethodError> {
        let x = &self.problem.cloud.points()[i];
        let bounds = self.problem.domain.bounds();
        let BalanceScratch { cell, cuts, wall_cuts, found, candidates } = scratch;
        let flat = &self.flat;
        let walls = Walls { walls: &flat.walls, beyond: &*flat.beyond, cuts: wall_cuts };
        let walls = (!flat.walls.is_empty()).then_some(walls);
        let container = Container { min: bounds.min, max: bounds.max, planes: &self.planes, cuts, walls };
        let everything = (0..D).map(|k| (bounds.max[k] - bounds.min[k]).powi(2)).sum::<f64>().sqrt();
        let reach_of = |radius: f64| if radius < everything { radius } else { f64::INFINITY };
        let mut searched = reach_of(self.problem.supports.radius[i]);
        // Radii that differ leave holes in the lists: a node whose own radius is small is listed at its neighbours only.
        match self.uniform_radius {
            Some(_) => self.list(self.problem.supports.lists.of(i), candidates),
            None => self.search(i, searched, found, candidates),
        }
        loop {
            match make(candidates, searched, &container, cell) {
                Err(CellError::Incomplete { needed, .. }) if searched.is_finite() => {
                    searched = reach_of(needed.clamp(SEARCH_GROWTH * searched, 2.0 * searched));
                    self.search(i, searched, found, candidates);
                }
                other => return other.map_err(|e| MethodError::cell(i, x, e)),
            }
        }
    }

    /// All nodes within `radius` of node i as candidates.
    fn search(&self, i: usize, radius: f64, found: &mut Vec<u32>, candidates: &mut Vec<(u32, [f64; D])>) {
        found.clear();
        self.index.within(&self.problem.cloud.points()[i], radius, found);
        found.retain(|&j| j as usize != i);
        self.list(found, candidates);
    }

    fn list(&self, nodes: &[u32], candidates: &mut Vec<(u32, [f64; D])>) {
        let points = self.problem.cloud.points();
        candidates.clear();
        candidates.extend(nodes.iter().map(|&j| (j, points[j as usize])));
    }

    /// The balance over the cell of node i, and what belongs in those of its neighbours; see [`CellBalance::parts`].
    pub(super) fn row(
        &self,
        i: usize,
        balances: &(dyn Fn(usize) -> bool + Sync),
        scratch: &mut BalanceScratch<'_, D>,
    ) -> Result<(CellRow, Vec<(u32, CellPart)>), MethodError> {
        let cell = self.cell(i, scratch)?;
        let Parts { kept, given } = self.parts(i, &cell, balances, scratch)?;
        let entries = Vec::with_capacity(cell.faces.len());
        let mut row = CellRow { entries, row_sum: 0.0, rhs: 0.0, volume: cell.volume, capacity: 0.0 };
        kept.iter().for_each(|part| row.add(part));
        let negligible = NEGLIGIBLE_FACE * cell.faces.iter().fold(0.0_f64, |a, f| a.max(f.area));
        for face in cell.faces.iter().filter(|f| f.area > negligible) {
            match face.kind {
                FaceKind::Neighbor(j) => {
                    let Crossing { partition: [own, other], in_row: [conducts, given], .. } =
                        self.crossing(i, j, face);
                    row.entries.push((j, conducts / other));
                    if own != other {
                        row.row_sum += conducts * (1.0 / own - 1.0 / other);
                    }
                    row.rhs += given;
                }
                FaceKind::Boundary(id) => self.boundary_face(i, FaceId(id), face, &mut row)?,
            }
        }
        match row.entries.iter().map(|(_, t)| *t).chain([row.row_sum, row.rhs]).all(f64::is_finite) {
            true => Ok((row, given)),
            false => {
                let x = self.problem.cloud.points()[i];
                let what = format!(
                    "the balance of the cell at {x:?} is not finite: a velocity, a reaction, or the resistance or a jump of an interface \
                     is no number near there"
                );
                Err(MethodError::InvalidProblem { what })
            }
        }
    }

    /// Flux to a neighbour by the harmonic mean of the diffusivities, (20), with the law of an interface at the middle.
    ///
    /// With `q_i` the flux towards j on the near side, `q_j = q_i + b` that on the far side, `r = d / (2 eta)` the resistance of each half of
    /// the way and the law `(u_j - q_j r_j) / K_j - (u_i + q_i r_i) / K_i = a + R q`, elimination of the values at the middle leaves
    /// `q_i = (u_j / K_j - u_i / K_i - a - b (r_j / K_j + R')) / (r_i / K_i + r_j / K_j + R)`, in which `R' = R` if the q of the law is
    /// that of the far side, and 0 else.
    pub(super) fn crossing(&self, i: usize, j: u32, face: &CellFace<D>) -> Crossing {
        let problem = self.problem;
        let points = problem.cloud.points();
        let (here, there) = (problem.eta[i], problem.eta[j as usize]);
        let (from, to) = (points[i], points[j as usize]);
        let distance = (0..D).map(|k| (to[k] - from[k]).powi(2)).sum::<f64>().sqrt();
        let direction: [f64; D] = std::array::from_fn(|k| (to[k] - from[k]) / distance);
        let conducts = face.area * harmonic_mean(here, there) / distance;
        let labels = [i, j as usize].map(|k| problem.labels[k]);
        let carries = face.area * self.velocity(labels, &face.centroid, &direction);
        let joined = |given: f64| {
            let in_row = [conducts * bernoulli(carries / conducts), given];
            Crossing { conducts, partition: [1.0; 2], given, in_row }
        };
        let Some((law, sign)) =
            (labels[0] != labels[1]).then(|| problem.law_between(labels[0], labels[1])).flatten()
        else {
            return joined(0.0);
        };
        let middle: [f64; D] = std::array::from_fn(|k| 0.5 * (from[k] + to[k]));
        let reach = problem.supports.radius[i];
        // Off the interface by more than the support there is nothing to project on: the middle itself serves.
        let (foot, normal) = match problem.regions.project_within(
            problem.domain,
            law.between[0],
            law.between[1],
            &middle,
            reach,
        ) {
            Ok(projection) => (projection.point, projection.normal),
            Err(_) => (middle, direction.map(|x| sign * x)),
        };
        let Contact { value, flux, resistance, of_here, partition } = law.at(sign, &foot);
        // The staircase of cell faces has the area of the interface only as seen along its normal. Both sides lose
        // their part of the surface source, so its sign is that of going from A to B on either; and a film lets through what its own area does.
        let seen = sign * (0..D).map(|k| normal[k] * direction[k]).sum::<f64>();
        let of_flux = face.area * flux * seen * here / (here + there);
        if !law.is_imperfect() && law.value.is_none() {
            return joined(-of_flux);
        }
        let half = 0.5 * distance;
        let [near, far] = [half / (here * partition[0]), half / (there * partition[1])];
        let (conducts, given) = if law.is_imperfect() {
            let film = resistance / seen.max(LEAST_SEEN);
            let conducts = face.area / (near + far + film);
            (conducts, -conducts * (value + flux * seen * (far + if of_here { 0.0 } else { film })))
        } else {
            (conducts, -conducts * value - of_flux)
        };
        // The velocity carries u as it is on the near side: what jumps beyond it is nothing to the equation of the node.
        let carried = bernoulli(2.0 * carries * half / (face.area * here));
        Crossing { conducts, partition, given, in_row: [carried * conducts, carried * given] }
    }

    /// The velocity through a face between two regions: none through the wall of one in which nothing moves.
    fn velocity(&self, labels: [u16; 2], at: &[f64; D], direction: &[f64; D]) -> f64 {
        let [here, there] = labels.map(|label| &self.problem.materials[label as usize]);
        if here.velocity.is_none() || there.velocity.is_none() {
            return 0.0;
        }
        let (a, b) = (here.velocity_at(at), there.velocity_at(at));
        (0..D).map(|k| 0.5 * (a[k] + b[k]) * direction[k]).sum()
    }

    /// Flux through a piece of the boundary, (21).
    ///
    /// Conditions on the flux are taken at the centroid of the piece. Those that hold the value are taken at the foot
    /// of the node on it, where the node itself is if it lies on the boundary: the straight way from the node to the
    /// foot, of length d, has the resistance `d / eta`.
    pub(super) fn boundary_face(
        &self,
        i: usize,
        id: FaceId,
        face: &CellFace<D>,
        row: &mut CellRow,
    ) -> Result<(), MethodError> {
        let problem = self.problem;
        let x = problem.cloud.points()[i];
        let eta = problem.eta[i];
        let at = |point: &[f64; D]| {
            let none = || MethodError::NoCondition { node: i, position: x.to_vec() };
            problem.boundary.condition(id, point).ok_or_else(none)
        };
        let to_flux = |condition: &Condition| {
            let without_flux = || MethodError::RobinWithoutFlux { node: i, position: x.to_vec() };
            condition.as_flux(eta).ok_or_else(without_flux)
        };
        let height = (0..D).map(|k| face.normal[k] * (face.centroid[k] - x[k])).sum::<f64>();
        let mut foot: [f64; D] = std::array::from_fn(|k| x[k] + height * face.normal[k]);
        let mut way = height;
        // Round a re-entrant edge the foot is beside the piece, or the node behind its plane.
        if self.is_flat(id) && !self.is_on_boundary(&foot, height) {
            foot = face.centroid;
            way = (0..D).map(|k| (foot[k] - x[k]).powi(2)).sum::<f64>().sqrt();
        }
        match at(&face.centroid)? {
            Condition::Dirichlet(_) => {
                // A piece through the node itself belongs to a node whose value is prescribed.
                let (Condition::Dirichlet(value), true) = (at(&foot)?, way != 0.0) else { return Ok(()) };
                let conducts = face.area * eta / way.abs();
                let label = problem.labels[i];
                let carries = face.area * self.velocity([label; 2], &face.centroid, &face.normal);
                let conducts = conducts * bernoulli(carries / conducts);
                row.row_sum += conducts;
                row.rhs += conducts * value;
            }
            Condition::Robin { .. } => {
                let (a, g) = to_flux(&at(&foot)?)?;
                // The chord of a curved face may lie on the inner side of a node on the boundary.
                let resistance = if a > 0.0 { way.max(0.0) / eta } else { 0.0 };
                let area = face.area / (1.0 + a * resistance);
                row.row_sum += area * a;
                row.rhs += area * g;
            }
            condition => row.rhs += face.area * to_flux(&condition)?.1,
        }
        Ok(())
    }

    /// Whether a face of the domain is made of flat faces with edges.
    fn is_flat(&self, id: FaceId) -> bool {
        self.flat.levels.iter().any(|(face, _)| *face == id)
    }

    /// Whether the foot of a node on a flat face, at a height above the node, is on the boundary.
    fn is_on_boundary(&self, foot: &[f64; D], height: f64) -> bool {
        let domain = self.problem.domain;
        let size = domain.bounds().diameter();
        height >= -ON_BOUNDARY * size && domain.level(foot).abs() <= ON_BOUNDARY * size
    }
}

/// Harmonic mean, written so that it neither overflows nor loses the smaller of two very different numbers.
fn harmonic_mean(a: f64, b: f64) -> f64 {
    let (small, large) = if a < b { (a, b) } else { (b, a) };
    2.0 * small / (1.0 + small / large)
}

/// `x / (exp(x) - 1)`.
pub(super) fn bernoulli(x: f64) -> f64 {
    if x == 0.0 { 1.0 } else { x / x.exp_m1() }
}

#[cfg(test)]
mod tests {
    use super::{bernoulli, harmonic_mean};

    #[test]
    fn the_bernoulli_function_is_finite_everywhere() {
        assert_eq!(bernoulli(0.0), 1.0);
        assert!((bernoulli(1e-9) - 1.0).abs() < 1e-8);
        // What goes with the stream less what goes against it is the stream.
        for x in [1e-3, 1.0, 30.0, 700.0] {
            assert!((bernoulli(-x) - bernoulli(x) - x).abs() < 1e-12 * x.max(1.0), "{x}");
        }
        assert_eq!(bernoulli(1e4), 0.0);
        assert_eq!(bernoulli(-1e4), 1e4);
    }

    #[test]
    fn the_harmonic_mean_is_symmetric_and_keeps_to_the_smaller() {
        assert_eq!(harmonic_mean(3.0, 3.0), 3.0);
        assert_eq!(harmonic_mean(1e-10, 1e10), harmonic_mean(1e10, 1e-10));
        assert!((harmonic_mean(1e-10, 1e10) - 2e-10).abs() < 1e-25);
        assert!((harmonic_mean(2.0, 6.0) - 3.0).abs() < 1e-15);
    }
}
