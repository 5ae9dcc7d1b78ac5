use super::manifold::onto;
use super::patch::{Patch, independent};
use crate::cells::{Cell, for_each_cell};
use crate::cloud::{Spacing, Touch, too_many};
use crate::domain::{Domain, FaceId};
use crate::error::GeometryError;
use crate::shape::Shape;
use crate::spatial_hash::SpatialHash;
use crate::vector::{axpy, scale};

/// How far from a surface a point still lies on it: a length relative to the domain's diameter.
const ON_PATCH: f64 = 1e-9;

/// How far behind a patch the domain is looked for, relative to the spacing.
const PROBE_DEPTH: f64 = 1e-4;

/// How far beside an edge the two patches that meet in it are looked at, relative to the spacing.
const PROBE_ASIDE: f64 = 1e-2;

/// Nodes while they are being placed. Those on the boundary come first.
pub(crate) struct Sampler<'a, const D: usize> {
    pub(crate) domain: &'a Domain<D>,
    pub(crate) spacing: &'a Spacing<D>,
    pub(crate) patches: Vec<Patch<'a, D>>,
    /// The domain's curved faces.
    pub(crate) curved: Vec<(FaceId, &'a Shape<D>, bool)>,
    pub(crate) nodes: SpatialHash<D>,
    /// Touches of the boundary nodes.
    pub(crate) touches: Vec<Vec<Touch<D>>>,
    /// When a point is on a surface, a length.
    pub(crate) tolerance: f64,
    limit: usize,
}

/// A cell near the boundary and the patches near it.
pub(crate) struct BoundaryCell<const D: usize> {
    pub(crate) cell: Cell<D>,
    pub(crate) near: Vec<usize>,
}

impl<'a, const D: usize> Sampler<'a, D> {
    pub(crate) fn new(domain: &'a Domain<D>, spacing: &'a Spacing<D>, limit: usize) -> Self {
        Self {
            domain,
            spacing,
            patches: super::patches(domain),
            curved: domain.curved_faces(),
            nodes: SpatialHash::new(),
            touches: Vec::new(),
            tolerance: ON_PATCH * domain.bounds().diameter(),
            limit,
        }
    }

    /// Adds a node; an error once there are too many.
    pub(crate) fn push(&mut self, x: [f64; D], spacing: f64) -> Result<u32, GeometryError> {
        if self.nodes.len() >= self.limit {
            // The estimate fell short; what remains to be placed is unknown.
            return Err(too_many::<D>(1.5 * self.limit as f64, self.limit));
        }
        Ok(self.nodes.insert(x, spacing))
    }

    /// Adds a boundary node, with a touch of every patch that bounds the domain there. Points where none does (the
    /// bottom of a notch that is flush with a face) are passed over: `false`.
    pub(crate) fn push_boundary(&mut self, x: [f64; D], spacing: f64) -> Result<bool, GeometryError> {
        let touches = self.touches_at(&x);
        if touches.is_empty() {
            return Ok(false);
        }
        self.push(x, spacing)?;
        self.touches.push(touches);
        Ok(true)
    }

    pub(crate) fn touches_at(&self, x: &[f64; D]) -> Vec<Touch<D>> {
        let mut found: Vec<Touch<D>> = Vec::new();
        let mut normals = Vec::new();
        let holding: Vec<usize> =
            (0..self.patches.len()).filter(|&k| self.patches[k].holds(x, self.tolerance)).collect();
        for &k in &holding {
            if !self.bounds_domain(k, &holding, x) {
                continue;
            }
            let patch = &self.patches[k];
            normals.clear();
            patch.normals(x, self.tolerance, &mut normals);
            for &normal in &normals {
                if !found.iter().any(|t| t.face == patch.face && !independent(&t.normal, &normal)) {
                    found.push(Touch { face: patch.face, normal });
                }
            }
        }
        found
    }

    /// Whether the point lies on the boundary of the domain, to rounding.
    pub(crate) fn on_boundary(&self, x: &[f64; D]) -> bool {
        self.domain.distance_estimate(x).abs() <= self.tolerance
    }

    /// Whether a common point of these patches is a boundary point of the domain; without patches, whether the point
    /// lies in the domain.
    pub(crate) fn on_all(&self, subset: &[usize], x: &[f64; D]) -> bool {
        if subset.is_empty() {
            return self.domain.contains(x, self.tolerance);
        }
        subset.iter().all(|&k| self.patches[k].holds(x, self.tolerance))
            && self.on_boundary(x)
            && subset.iter().all(|&k| self.bounds_domain(k, subset, x))
    }

    /// Whether the domain lies on the inner side of patch `k` at `x` or, where other patches `meeting` it there may
    /// hide that, right beside it. Patches of two shapes that are flush have nothing between them and bound nothing.
    fn bounds_domain(&self, k: usize, meeting: &[usize], x: &[f64; D]) -> bool {
        let Ok(h) = self.spacing.at(x) else { return false };
        let patch = &self.patches[k];
        let inside = |p: &[f64; D]| {
            patch
                .mean_normal(p, self.tolerance)
                .is_none_or(|n| self.domain.level(&axpy(p, -PROBE_DEPTH * h, &n)) < 0.0)
        };
        if meeting.len() <= 1 || patch.polygon().is_some() {
            return inside(x);
        }
        let others: Vec<[f64; D]> = meeting
            .iter()
            .filter(|&&j| j != k)
            .filter_map(|&j| self.patches[j].mean_normal(x, self.tolerance))
            .collect();
        let all = others.iter().fold([0.0; D], |sum, n| axpy(&sum, -1.0, n));
        let beside = others.iter().flat_map(|n| [scale(-1.0, n), *n]);
        [[0.0; D], all].into_iter().chain(beside).any(|direction| {
            onto(&[patch], &axpy(x, PROBE_ASIDE * h, &direction), h)
                .is_some_and(|p| patch.holds(&p, self.tolerance) && inside(&p))
        })
    }

    pub(crate) fn pick(&self, subset: &[usize]) -> Vec<&Patch<'a, D>> {
        subset.iter().map(|&k| &self.patches[k]).collect()
    }

    /// Whether sampling may leave this set of patches out because a lattice covers it.
    pub(crate) fn covered_by_lattice(&self, subset: &[usize]) -> bool {
        subset.iter().all(|&k| self.patches[k].on_box)
    }

    /// The cells of about one spacing near which there are patches.
    pub(crate) fn boundary_cells(&self, lattice: bool) -> Result<Vec<BoundaryCell<D>>, GeometryError> {
        let mut cells = Vec::new();
        let bounds = self.domain.bounds();
        for_each_cell(
            &bounds,
            self.spacing,
            1.0,
            |cell| {
                let reach = 2.0 * cell.half_diagonal();
                self.patches.iter().any(|p| p.distance(&cell.center) <= reach)
            },
            |cell| {
                let reach = 2.0 * cell.half_diagonal();
                let near: Vec<usize> = (0..self.patches.len())
                    .filter(|&k| self.patches[k].distance(&cell.center) <= reach)
                    .collect();
                let covered = lattice && self.covered_by_lattice(&near);
                if !near.is_empty() && !covered {
                    cells.push(BoundaryCell { cell: *cell, near });
                }
                if cells.len() > 64 * self.limit.max(1000) {
                    return Err(too_many::<D>(2.0 * self.limit as f64, self.limit));
                }
                Ok(())
            },
        )?;
        Ok(cells)
    }
}

/// Calls `visit` with every choice of `k` of the `items`, in lexicographic order.
pub(crate) fn for_each_subset(
    items: &[usize],
    k: usize,
    visit: &mut impl FnMut(&[usize]) -> Result<(), GeometryError>,
) -> Result<(), GeometryError> {
    fn recurse(
        items: &[usize],
        k: usize,
        chosen: &mut Vec<usize>,
        visit: &mut impl FnMut(&[usize]) -> Result<(), GeometryError>,
    ) -> Result<(), GeometryError> {
        if chosen.len() == k {
            return visit(chosen);
        }
        for (i, &item) in items.iter().enumerate() {
            chosen.push(item);
            recurse(&items[i + 1..], k, chosen, visit)?;
            chosen.pop();
        }
        Ok(())
    }
    recurse(items, k, &mut Vec::with_capacity(k), visit)
}
