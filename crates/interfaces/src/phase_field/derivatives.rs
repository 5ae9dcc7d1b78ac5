//! First and second derivatives by DC-PSE operators at the nodes near interfaces.

use meshless_geometry::Cloud;
use meshless_neighbors::NeighborLists;
use meshless_stencils::{FitParams, Functional, LocalFit};

use super::surface::Expansion;
use crate::MethodError;
use crate::parallel;

/// Degree for which the operators are exact: second order for second derivatives.
const DEGREE: usize = 3;

/// Nodes from which an interface is at most so many widths away take part: tanh of that is 0.9999 of its limit.
const BAND: f64 = 5.0;

/// Operators at the nodes of the band.
pub(super) struct Derivatives<'a, const D: usize> {
    lists: &'a NeighborLists,
    /// Nodes of the band, in order.
    band: Vec<u32>,
    rows: Vec<Rows>,
}

/// Operators at a node on the differences `u_j - u_i`: one row of the neighbours for each derivative.
struct Rows {
    /// Where the node's own support does not do, the supports of its neighbours.
    enlarged: Option<Vec<u32>>,
    values: Vec<f64>,
}

/// Gradient and Hessian.
#[derive(Debug, Clone, Copy)]
pub(super) struct Local<const D: usize> {
    pub(super) gradient: [f64; D],
    pub(super) hessian: [[f64; D]; D],
}

impl<const D: usize> Local<D> {
    /// The second derivative along the gradient, and the length of the gradient.
    pub(super) fn along_gradient(&self) -> (f64, f64) {
        let g = &self.gradient;
        let squared: f64 = g.iter().map(|c| c * c).sum();
        let product: f64 = (0..D)
            .flat_map(|a| (0..D).map(move |b| (a, b)))
            .fold(0.0, |sum, (a, b)| sum + g[a] * self.hessian[a][b] * g[b]);
        (if squared > f64::MIN_POSITIVE { product / squared } else { 0.0 }, squared.sqrt())
    }
}

impl<'a, const D: usize> Derivatives<'a, D> {
    pub(super) fn new(
        cloud: &Cloud<D>,
        lists: &'a NeighborLists,
        labels: &[u16],
        width: f64,
    ) -> Result<Self, MethodError> {
        let band = band(cloud, lists, labels, BAND * width);
        let fit =
            LocalFit::<D>::new(FitParams { degree: DEGREE, through_centre: true, ..FitParams::default() });
        let points = cloud.points();
        let most = lists.max_count();
        let over = |scratch: &mut _, i: usize, neighbors: &[u32]| -> Result<Vec<f64>, MethodError> {
            let mut offsets = Vec::with_capacity(neighbors.len());
            let mut reach = 0.0_f64;
            for &j in neighbors {
                let offset: [f64; D] = std::array::from_fn(|k| points[j as usize][k] - points[i][k]);
                reach = reach.max(offset.iter().map(|c| c * c).sum::<f64>().sqrt());
                offsets.push(offset);
            }
            // The kernel of DC-PSE, half as wide as the support.
            let weight = |s: &[f64; D]| (-2.0 * s.iter().map(|c| c * c).sum::<f64>() / (reach * reach)).exp();
            let weights: Vec<f64> = offsets.iter().map(weight).collect();
            let explain = |source| MethodError::stencil(i, &points[i], source);
            fit.factor(&offsets, &weights, reach, scratch).map_err(explain)?;
            let mut out = vec![0.0; neighbors.len() * functionals::<D>().count()];
            for (functional, row) in functionals::<D>().zip(out.chunks_exact_mut(neighbors.len())) {
                fit.coefficients(&functional, scratch, row).map_err(explain)?;
            }
            Ok(out)
        };
        // Supports are one-sided at the boundary, where those of a lattice may not do.
        let row = |scratch: &mut _, i: usize| match over(scratch, i, lists.of(i)) {
            Ok(values) => Ok(Rows { enlarged: None, values }),
            Err(_) => {
                let wide = twice(lists, i);
                over(scratch, i, &wide).map(|values| Rows { enlarged: Some(wide), values })
            }
        };
        let rows = parallel::try_map_with(
            band.len(),
            || fit.scratch(most),
            |scratch, k| row(scratch, band[k] as usize),
        )?;
        Ok(Self { lists, band, rows })
    }

    /// Nodes near interfaces.
    pub(super) fn band(&self) -> &[u32] {
        &self.band
    }

    /// Neighbours of node number `place` of the band.
    pub(super) fn neighbors(&self, place: usize) -> &[u32] {
        self.rows[place].enlarged.as_deref().unwrap_or_else(|| self.lists.of(self.band[place] as usize))
    }

    /// Gradient and Hessian of a nodal field at node number `place` of the band.
    pub(super) fn at(&self, place: usize, u: &[f64]) -> Local<D> {
        let (i, neighbors) = (self.band[place] as usize, self.neighbors(place));
        let mut local = Local { gradient: [0.0; D], hessian: [[0.0; D]; D] };
        for (functional, row) in functionals::<D>().zip(self.rows[place].values.chunks_exact(neighbors.len()))
        {
            let value: f64 = neighbors.iter().zip(row).map(|(&j, c)| c * (u[j as usize] - u[i])).sum();
            match functional {
                Functional::Second(a, b) => {
                    local.hessian[a][b] = value;
                    local.hessian[b][a] = value;
                }
                Functional::Partial(a) => local.gradient[a] = value,
                _ => {}
            }
        }
        local
    }

    /// Sum of the absolute coefficients of the Laplacian at a node of the band: what limits explicit steps.
    pub(super) fn stiffness(&self, place: usize) -> f64 {
        let n = self.neighbors(place).len();
        let diagonal =
            functionals::<D>().enumerate().filter(|(_, f)| matches!(f, Functional::Second(a, b) if a == b));
        let which: Vec<usize> = diagonal.map(|(k, _)| k).collect();
        (0..n).map(|p| which.iter().map(|k| self.rows[place].values[k * n + p]).sum::<f64>().abs()).sum()
    }

    /// The Taylor polynomials of second degree of a nodal field; constants outside of the band.
    pub(super) fn expand(&self, u: &[f64]) -> Vec<Expansion<D>> {
        let mut all: Vec<Expansion<D>> = u.iter().map(|&value| Expansion::constant(value)).collect();
        for (place, &i) in self.band.iter().enumerate() {
            let Local { gradient, hessian } = self.at(place, u);
            all[i as usize] = Expansion { value: u[i as usize], gradient, hessian };
        }
        all
    }
}

fn functionals<const D: usize>() -> impl Iterator<Item = Functional<D>> {
    let second = (0..D).flat_map(|a| (a..D).map(move |b| Functional::Second(a, b)));
    (0..D).map(Functional::Partial).chain(second)
}

/// Nodes that are at most `reach` spacings away from a node of another region, along paths of neighbours.
fn band<const D: usize>(cloud: &Cloud<D>, lists: &NeighborLists, labels: &[u16], reach: f64) -> Vec<u32> {
    let points = cloud.points();
    // The nearest node next to an interface, handed on from neighbour to neighbour.
    let mut seed: Vec<Option<u32>> = vec![None; labels.len()];
    let mut front: Vec<u32> = (0..labels.len() as u32)
        .filter(|&i| lists.of(i as usize).iter().any(|&j| labels[j as usize] != labels[i as usize]))
        .collect();
    front.iter().for_each(|&i| seed[i as usize] = Some(i));
    let distance = |a: u32, b: u32| {
        let (a, b) = (&points[a as usize], &points[b as usize]);
        (0..D).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>().sqrt()
    };
    while !front.is_empty() {
        let mut next = Vec::new();
        for &i in &front {
            let Some(origin) = seed[i as usize] else { continue };
            for &j in lists.of(i as usize) {
                let near = distance(origin, j) <= reach * cloud.spacing()[j as usize];
                if near && seed[j as usize].is_none() {
                    seed[j as usize] = Some(origin);
                    next.push(j);
                }
            }
        }
        front = next;
    }
    (0..labels.len() as u32).filter(|&i| seed[i as usize].is_some()).collect()
}

/// The neighbours of a node and theirs.
fn twice(lists: &NeighborLists, i: usize) -> Vec<u32> {
    let mut all: Vec<u32> = lists.of(i).iter().flat_map(|&j| lists.of(j as usize)).copied().collect();
    all.extend_from_slice(lists.of(i));
    all.sort_unstable();
    all.dedup();
    all.retain(|&j| j as usize != i);
    all
}
