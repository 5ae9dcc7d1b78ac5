//! About how many nodes a cloud has whose layers are refined, without making it.

use rayon::prelude::*;

use super::RegionMap;
use super::gaps::{GapParams, Refined};
use crate::aabb::Aabb;
use crate::cloud::{CloudParams, check_size, half_layer, too_many};
use crate::domain::Domain;
use crate::error::GeometryError;

/// Times that layers are looked for at most, as when the cloud is made.
const LOOKS: usize = 12;

/// Longest edge of a cell, in spacings at its middle: of the size of what belongs to a node.
const EDGE: f64 = 1.5;

/// Halvings of the box at most: 1e12 cells along an edge.
const DEEPEST: usize = 40;

impl<const D: usize> RegionMap<D> {
    /// About how many nodes [`RegionMap::generate`] makes. The box of the domain is halved until cells are as large as what belongs
    /// to a node; layers are looked for from the middles of these.
    ///
    /// # Errors
    /// [`GeometryError::TooManyNodes`] with the spacing that would do, and [`GeometryError::InvalidSpacing`].
    pub fn foresee_nodes(
        &self,
        domain: &Domain<D>,
        params: &CloudParams<D>,
        gaps: &GapParams,
    ) -> Result<f64, GeometryError> {
        let plain = check_size(domain, &params.spacing, params.max_nodes)?;
        let refined = self.foresee_gaps(domain, params, gaps)?;
        if refined.is_plain() {
            return Ok(plain);
        }
        let inside = Cells { domain, refined: &refined, limit: params.max_nodes }.all()?.nodes;
        Ok(inside + half_layer(domain, &refined.spacing())?)
    }

    /// What layers ask for, as seen from the middles of cells.
    pub(super) fn foresee_gaps<'a>(
        &self,
        domain: &Domain<D>,
        params: &'a CloudParams<D>,
        gaps: &GapParams,
    ) -> Result<Refined<'a, D>, GeometryError> {
        let mut refined = Refined::new(&params.spacing);
        if self.len() == 1 {
            return Ok(refined);
        }
        for _ in 1..LOOKS {
            let cells = Cells { domain, refined: &refined, limit: params.max_nodes }.all()?;
            let near = |(x, spacing): &([f64; D], f64)| self.thin_near(x, *spacing, domain, gaps.across);
            let mut layers: Vec<_> = cells.middles.par_iter().flat_map_iter(near).collect();
            for layer in &mut layers {
                layer.spacing = refined.at(&layer.at)?;
            }
            layers.retain(|layer| layer.thickness < gaps.across * layer.spacing);
            if !refined.resolve(&layers, gaps)? {
                break;
            }
        }
        Ok(refined)
    }
}

/// The box of a domain in cells.
struct Cells<'a, const D: usize> {
    domain: &'a Domain<D>,
    refined: &'a Refined<'a, D>,
    limit: usize,
}

/// Middles of cells in the domain, with the spacing there, and about how many nodes there are in all.
#[derive(Default)]
struct Found<const D: usize> {
    middles: Vec<([f64; D], f64)>,
    nodes: f64,
}

impl<const D: usize> Cells<'_, D> {
    fn all(&self) -> Result<Found<D>, GeometryError> {
        let mut found = Found { middles: Vec::new(), nodes: 0.0 };
        self.below(self.domain.bounds(), 0, &mut found)?;
        Ok(found)
    }

    fn below(&self, cell: Aabb<D>, depth: usize, found: &mut Found<D>) -> Result<(), GeometryError> {
        let (middle, lengths) = (cell.center(), cell.lengths());
        let axis = (1..D).fold(0, |best, k| if lengths[k] > lengths[best] { k } else { best });
        let spacing = self.refined.at(&middle)?;
        if lengths[axis] <= EDGE * spacing || depth >= DEEPEST {
            if self.domain.level(&middle) <= 0.0 {
                found.middles.push((middle, spacing));
                found.nodes += cell.measure() * spacing.powi(-(D as i32));
                if found.nodes > self.limit as f64 {
                    return Err(too_many::<D>(found.nodes, self.limit));
                }
            }
            return Ok(());
        }
        let (mut low, mut high) = (cell, cell);
        low.max[axis] = middle[axis];
        high.min[axis] = middle[axis];
        self.below(low, depth + 1, found)?;
        self.below(high, depth + 1, found)
    }
}
