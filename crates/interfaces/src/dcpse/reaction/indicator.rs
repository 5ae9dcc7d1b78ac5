//! Smoothed indicators of the regions (section 4.3).

use meshless_neighbors::CellList;
use meshless_stencils::{DcPse, Functional};

use super::super::operators;
use super::params::Smoothing;
use crate::parallel;
use crate::{MethodError, Problem};

/// The Green's function is cut off at so many widths: what is lost is 3e-4 of its mass in one dimension.
const CUT_OFF: f64 = 4.0;

/// Share of the largest stable step of explicit diffusion that is taken.
const STEP: f64 = 0.5;

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
            Smoothing::Diffusion => diffuse(problem, width)?,
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
fn beyond<const D: usize>(problem: &Problem<'_, D>) -> Vec<Option<(u16, f64)>> {
    let share = |i: usize| {
        let (x, h, own) = (&problem.cloud.points()[i], problem.cloud.spacing()[i], problem.labels[i]);
        let mut others: Vec<u16> =
            problem.supports.lists.of(i).iter().map(|&j| problem.labels[j as usize]).collect();
        others.sort_unstable();
        others.dedup();
        let distance = |other: u16| {
            let foot = problem.regions.project(own, other, x, h).ok()?;
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

/// Explicit steps of `du/dt = lap u` up to the time `w^2 / 2`; the normal derivative vanishes on the boundary.
fn diffuse<const D: usize>(problem: &Problem<'_, D>, width: f64) -> Result<Vec<Vec<Share<D>>>, MethodError> {
    let n = problem.cloud.len();
    let interior = |i: usize| !problem.cloud.is_boundary(i);
    // Degree 2: steps of first order in space, of which every one is nearly an average.
    let laplacian = operators::compute(problem, 2, |_| Functional::Laplacian, interior, |_, _| true)?;
    let spacing = problem.cloud.spacing();
    // In units of the spacing of each node, so that the width follows it.
    let rate =
        |i: usize| laplacian.row(problem, i).1.iter().map(|c| c.abs()).sum::<f64>() * spacing[i] * spacing[i];
    let stiffest = (0..n).filter(|&i| interior(i)).map(rate).fold(1.0_f64, f64::max);
    let steps = (0.5 * width * width * stiffest / STEP).ceil();
    let step = 0.5 * width * width / steps;
    let regions = problem.materials.len();
    let mut fields = Vec::with_capacity(regions);
    let beyond = beyond(problem);
    for region in 0..regions as u16 {
        let start = |(&label, other): (&u16, &Option<(u16, f64)>)| match *other {
            Some((_, share)) if label == region => 1.0 - share,
            Some((other, share)) if other == region => share,
            _ => f64::from(u8::from(label == region)),
        };
        let mut u: Vec<f64> = problem.labels.iter().zip(&beyond).map(start).collect();
        for _ in 0..steps as usize {
            let mut next = parallel::map(n, |i| {
                let (neighbors, row) = laplacian.row(problem, i);
                let change: f64 = neighbors.iter().zip(row).map(|(&j, c)| c * (u[j as usize] - u[i])).sum();
                u[i] + step * spacing[i] * spacing[i] * change
            });
            for node in problem.cloud.boundary() {
                let b = node.node as usize;
                next[b] = mirrored(problem, b, &next);
            }
            u = next;
        }
        fields.push(u);
    }
    let partial = |axis: usize| DcPse::<D>::derivative(std::array::from_fn(|k| u8::from(k == axis)), 2);
    let operators: [DcPse<D>; D] = std::array::from_fn(partial);
    let most = problem.supports.lists.max_count();
    parallel::try_map_with(
        n,
        || (operators.each_ref().map(|o| o.scratch(most)), Vec::new(), Vec::new()),
        |(scratch, offsets, row), i| {
            let mixed = fields.iter().filter(|u| u[i].abs() > 1e-12).count() > 1;
            if !mixed {
                return Ok(Vec::new());
            }
            let points = problem.cloud.points();
            let neighbors = problem.supports.lists.of(i);
            offsets.clear();
            offsets.extend(
                neighbors
                    .iter()
                    .map(|&j| -> [f64; D] { std::array::from_fn(|k| points[j as usize][k] - points[i][k]) }),
            );
            row.resize(neighbors.len() + 1, 0.0);
            let mut shares: Vec<Share<D>> =
                (0..regions).map(|r| (r as u16, fields[r][i], [0.0; D])).collect();
            for (axis, (operator, scratch)) in operators.iter().zip(scratch).enumerate() {
                operator
                    .stencil(offsets, 0.5 * problem.supports.radius[i], scratch, row)
                    .map_err(|source| MethodError::stencil(i, &points[i], source))?;
                for (r, share) in shares.iter_mut().enumerate() {
                    let values = neighbors.iter().map(|&j| fields[r][j as usize]);
                    share.2[axis] =
                        row[0] * fields[r][i] + row[1..].iter().zip(values).map(|(c, u)| c * u).sum::<f64>();
                }
            }
            Ok(shares)
        },
    )
}

/// The mean of the inner neighbours, near ones first: no flux goes through the boundary.
fn mirrored<const D: usize>(problem: &Problem<'_, D>, b: usize, u: &[f64]) -> f64 {
    let points = problem.cloud.points();
    let h = problem.cloud.spacing()[b];
    let (mut sum, mut mass) = (0.0, 0.0);
    for &j in problem.supports.lists.of(b) {
        if !problem.cloud.is_boundary(j as usize) {
            let squared: f64 = (0..D).map(|k| (points[j as usize][k] - points[b][k]).powi(2)).sum();
            let weight = (-squared / (h * h)).exp();
            sum += weight * u[j as usize];
            mass += weight;
        }
    }
    if mass > 0.0 { sum / mass } else { u[b] }
}
