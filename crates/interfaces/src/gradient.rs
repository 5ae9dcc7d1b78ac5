//! Gradients of a nodal field, every node in its own region.

use meshless_stencils::{Functional, Weight};

use crate::local::{NodeFit, NodeScratch, enlarged_support};
use crate::parallel;
use crate::{MethodError, Problem};

/// Degree of the fit where enough nodes of the region are near.
const DEGREE: usize = 2;

/// Nodes of the same region that a fit should have for each of its monomials.
const NODES_PER_MONOMIAL: f64 = 1.3;

/// The gradient at every node by a weighted least-squares fit to the nodes of its own region; never an average over
/// an interface.
///
/// Degree 2 where the region has enough nodes in the support, a larger support where not, degree 1 where that does
/// not help. A node that has no neighbour of its own region at all gets the gradient zero.
pub(crate) fn recover<const D: usize>(
    problem: &Problem<'_, D>,
    u: &[f64],
) -> Result<Vec<[f64; D]>, MethodError> {
    let fits = [NodeFit::new(DEGREE, Weight::Exponential), NodeFit::new(1, Weight::Exponential)];
    let most = problem.supports.lists.max_count();
    parallel::try_map_with(
        u.len(),
        || (fits.each_ref().map(|f| f.scratch(most)), Vec::with_capacity(most), vec![0.0; most]),
        |(scratch, own, coefficients), i| {
            own.clear();
            own.extend(own_region(problem, i, problem.supports.lists.of(i)));
            if let Some(gradient) =
                fit_gradient(problem, &fits[0], DEGREE, i, own, &mut scratch[0], coefficients, u)
            {
                return Ok(gradient);
            }
            let wide: Vec<u32> = own_region(problem, i, &enlarged_support(problem, i)).collect();
            if wide.is_empty() {
                return Ok([0.0; D]);
            }
            for (fit, degree) in fits.iter().zip([DEGREE, 1]) {
                let mut scratch = fit.scratch(wide.len());
                let mut coefficients = vec![0.0; wide.len()];
                if let Some(gradient) =
                    fit_gradient(problem, fit, degree, i, &wide, &mut scratch, &mut coefficients, u)
                {
                    return Ok(gradient);
                }
            }
            Ok(along_the_nearest(problem, i, &wide, u))
        },
    )
}

fn own_region<'a, const D: usize>(
    problem: &'a Problem<'_, D>,
    i: usize,
    neighbors: &'a [u32],
) -> impl Iterator<Item = u32> + 'a {
    neighbors.iter().copied().filter(move |&j| problem.labels[j as usize] == problem.labels[i])
}

fn fit_gradient<const D: usize>(
    problem: &Problem<'_, D>,
    fit: &NodeFit<D>,
    degree: usize,
    i: usize,
    neighbors: &[u32],
    scratch: &mut NodeScratch<D>,
    coefficients: &mut Vec<f64>,
    u: &[f64],
) -> Option<[f64; D]> {
    let monomials = (1..=D).fold(1.0, |count, k| count * (degree + k) as f64 / k as f64);
    if ((neighbors.len() + 1) as f64) < NODES_PER_MONOMIAL * monomials {
        return None;
    }
    coefficients.resize(neighbors.len(), 0.0);
    fit.factor(problem, i, neighbors, scratch).ok()?;
    let mut gradient = [0.0; D];
    for (axis, component) in gradient.iter_mut().enumerate() {
        fit.coefficients(&Functional::Partial(axis), scratch, coefficients).ok()?;
        *component = coefficients.iter().zip(neighbors).map(|(c, &j)| c * (u[j as usize] - u[i])).sum();
    }
    gradient.iter().all(|g| g.is_finite()).then_some(gradient)
}

/// The slope towards the nearest node of the region: all that a row of nodes determines.
fn along_the_nearest<const D: usize>(
    problem: &Problem<'_, D>,
    i: usize,
    neighbors: &[u32],
    u: &[f64],
) -> [f64; D] {
    let points = problem.cloud.points();
    let squared = |j: u32| (0..D).map(|k| (points[j as usize][k] - points[i][k]).powi(2)).sum::<f64>();
    let nearest =
        neighbors.iter().copied().min_by(|&a, &b| squared(a).total_cmp(&squared(b)).then(a.cmp(&b)));
    nearest.map_or([0.0; D], |j| {
        let slope = (u[j as usize] - u[i]) / squared(j);
        std::array::from_fn(|k| slope * (points[j as usize][k] - points[i][k]))
    })
}
