//! Smoothed indicators of the regions (section 4.3).

use meshless_neighbors::CellList;

use super::params::Smoothing;
use super::{diffusion, profile};
use crate::parallel;
use crate::{MethodError, Problem};

/// The Green's function is cut off at so many widths: what is lost is 3e-4 of its mass in one dimension.
pub(super) const CUT_OFF: f64 = 4.0;

/// A region, its share of a node, and the gradient of the share.
pub type Share<const D: usize> = (u16, f64, [f64; D]);

/// Smoothed indicators near interfaces: for nodes near more than one region, the share of every region and its gradient.
#[derive(Debug, Clone)]
pub struct Indicators<const D: usize> {
    /// For every node, `(region, chi, grad chi)`, by region; empty where only the node's own region is near.
    shares: Vec<Vec<Share<D>>>,
}

impl<const D: usize> Indicators<D> {
    /// Smooths the indicators of all regions; the width is a standard deviation in units of the spacing.
    ///
    /// # Errors
    /// [`MethodError::Stencil`] where supports are too small for the Laplacian or first derivatives.
    pub fn new(problem: &Problem<'_, D>, smoothing: Smoothing, width: f64) -> Result<Self, MethodError> {
        let shares = match smoothing {
            Smoothing::Convolution => convolve(problem, width)?,
            Smoothing::Diffusion => diffusion::shares(problem, width)?,
            Smoothing::Distance => profile::shares(problem, width)?,
        };
        Ok(Self { shares })
    }

    /// For every region near node i its index, its share of the node, and the gradient of the share; the shares sum to
    /// one. Empty where only the node's own region is near.
    pub fn at(&self, i: usize) -> &[Share<D>] {
        &self.shares[i]
    }
}

/// The share of another region in the volume of every node: what lies beyond an interface that is nearer than half a
/// spacing. The label of a node alone leaves the interface anywhere between two nodes, an error of first order.
pub(super) fn beyond<const D: usize>(problem: &Problem<'_, D>) -> Vec<Option<(u16, f64)>> {
    let share = |i: usize| {
        let (x, h, own) = (&problem.cloud.points()[i], problem.cloud.spacing()[i], problem.labels[i]);
        let mut others: Vec<u16> =
            problem.supports.lists.of(i).iter().map(|&j| problem.labels[j as usize]).collect();
        others.sort_unstable();
        others.dedup();
        let distance = |other: u16| {
            let foot = problem.regions.project_within(problem.domain, own, other, x, h).ok()?;
            Some((other, 0.5 - foot.distance.abs() / h))
        };
        let nearest =
            others.into_iter().filter(|&o| o != own).filter_map(distance).max_by(|a, b| a.1.total_cmp(&b.1));
        nearest.filter(|(_, share)| *share > 0.0)
    };
    parallel::map(problem.cloud.len(), share)
}

/// `sum_q chi_q G(x - x_q) / sum_q G(x - x_q)`: the sum over the regions is one.
fn convolve<const D: usize>(problem: &Problem<'_, D>, width: f64) -> Result<Vec<Vec<Share<D>>>, MethodError> {
    let (points, spacing) = (problem.cloud.points(), problem.cloud.spacing());
    let largest = spacing.iter().fold(0.0_f64, |a, &b| a.max(b));
    let index = CellList::new(points, CUT_OFF * width * largest)?;
    let beyond = beyond(problem);
    let at = |found: &mut Vec<u32>, i: usize| {
        let (x, w) = (&points[i], width * spacing[i]);
        found.clear();
        index.within(x, CUT_OFF * w, found);
        if found.iter().all(|&j| problem.labels[j as usize] == problem.labels[i]) {
            return Vec::new();
        }
        // In the order of the nodes, whatever the order in which the cells are searched.
        found.sort_unstable();
        let mut sums: Vec<Share<D>> = Vec::new();
        let (mut mass, mut slope) = (0.0, [0.0; D]);
        for &j in found.iter() {
            let j = j as usize;
            let offset: [f64; D] = std::array::from_fn(|k| x[k] - points[j][k]);
            let squared = offset.iter().map(|c| c * c).sum::<f64>();
            let g = spacing[j].powi(D as i32) * (-0.5 * squared / (w * w)).exp();
            let derivative = offset.map(|c| -g * c / (w * w));
            mass += g;
            (0..D).for_each(|k| slope[k] += derivative[k]);
            let (other, share) = beyond[j].unwrap_or((problem.labels[j], 0.0));
            for (region, share) in [(problem.labels[j], 1.0 - share), (other, share)] {
                let place = sums.iter().position(|s| s.0 == region).unwrap_or_else(|| {
                    sums.push((region, 0.0, [0.0; D]));
                    sums.len() - 1
                });
                sums[place].1 += share * g;
                (0..D).for_each(|k| sums[place].2[k] += share * derivative[k]);
            }
        }
        for (_, share, gradient) in &mut sums {
            *share /= mass;
            for k in 0..D {
                gradient[k] = (gradient[k] - *share * slope[k]) / mass;
            }
        }
        sums.sort_by_key(|s| s.0);
        sums
    };
    Ok(parallel::map_with(points.len(), Vec::new, at))
}
