//! Whether `M du/dt + A u = 0` lets anything grow, by implicit steps of all sizes.

use meshless_geometry::{Layout, Shape};
use meshless_interfaces::particle_difference::{
    ParticleDifference, ParticleDifferenceExtended, ParticleDifferenceParams, Wedge,
};
use meshless_interfaces::{Condition, Discretization, Mass, Method, PreparedSystem, RowKind, SystemParams};

use crate::support::{Setup, unit};

/// Two materials in the unit box, of which the second has the diffusivity `contrast`, both ends kept at 0, all else insulated.
pub(crate) fn contact<const D: usize>(
    shape: Shape<D>,
    layout: Layout,
    spacing: f64,
    seed: u64,
    contrast: f64,
) -> Setup<D> {
    Setup::<D>::generated(unit(), layout, spacing, seed)
        .regions(vec![Some(shape), None], &[1.0, contrast])
        .conditions(|_, x| match x[0] > 1e-9 && x[0] < 1.0 - 1e-9 {
            true => Condition::Neumann(0.0),
            false => Condition::Dirichlet(0.0),
        })
}

/// The largest growth by the last of many implicit steps of one size, over all sizes from a fraction of the fastest decay on.
///
/// A mode that grows with a rate r is doubled at least by implicit steps between `0.5 / r` and `1.5 / r`; no rate is missed by
/// steps of which each is three times as long as the one before.
pub(crate) fn largest_growth<const D: usize>(
    setup: &Setup<D>,
    rows: &Discretization,
    spacing: f64,
    contrast: f64,
) -> f64 {
    let least = 0.02 * spacing * spacing / contrast.max(1.0);
    let longest = 10.0 / contrast.min(1.0);
    let mut c = least;
    let mut largest = 0.0_f64;
    while c < longest {
        largest = largest.max(growth(setup, rows, c));
        c *= 3.0;
    }
    largest
}

/// Growth in the root mean square by the last of many implicit steps of one size.
fn growth<const D: usize>(setup: &Setup<D>, rows: &Discretization, c: f64) -> f64 {
    let mass = Mass::of(&setup.problem(), rows).unwrap();
    let (shifted, constants) = mass.shifted(rows, c).unwrap();
    let n = rows.rows.n();
    let known: Vec<bool> =
        (0..n).map(|i| rows.kinds.get(i).is_some_and(|&k| k == RowKind::Dirichlet)).collect();
    let params = SystemParams { split_floating: false, ..SystemParams::default() };
    let system = match &constants {
        Some(constants) => PreparedSystem::with_constants(&shifted, constants, &known, &params),
        None => PreparedSystem::new(&setup.problem(), &shifted, &known, &params),
    };
    let Ok(system) = system else { return f64::INFINITY };
    let size = |u: &[f64]| u[..rows.kinds.len()].iter().map(|u| u * u).sum::<f64>().sqrt();
    let mut u: Vec<f64> =
        (0..n).map(|i| if known[i] { 0.0 } else { (i as f64 * 0.618).fract() - 0.5 }).collect();
    let mut last = 0.0;
    for _ in 0..20 {
        let before = size(&u);
        u.iter_mut().for_each(|u| *u /= before);
        let rhs: Vec<f64> = mass.times(&u).iter().map(|m| m / c).collect();
        u = system.solve(&rhs).unwrap().0;
        last = size(&u);
    }
    last
}

/// On clouds moved by half a spacing two nodes may almost coincide: with the weights of the method their rows have the wrong sign, and
/// something grows on two of these three clouds.
#[test]
fn nothing_grows_by_particle_differences() {
    let wall = Shape::half_space([0.4, 0.5], [1.0, 0.0]).unwrap();
    let params = ParticleDifferenceParams {
        wedge: Wedge::Varying,
        decaying: true,
        ..ParticleDifferenceParams::default()
    };
    let mut found = Vec::new();
    for contrast in [1e-6, 1e-2, 10.0, 1e6] {
        for layout in [Layout::Irregular, Layout::Jittered, Layout::Scattered] {
            for seed in 1..=3 {
                let setup = contact::<2>(wall.clone(), layout, 0.09, seed, contrast);
                let rows = ParticleDifference { params }.discretize(&setup.problem()).unwrap();
                let growth = largest_growth(&setup, &rows, 0.09, contrast);
                if growth > 1.5 {
                    found.push(format!("{contrast:e}, {layout:?}, seed {seed}: {growth}"));
                }
            }
        }
    }
    assert!(found.is_empty(), "{found:#?}");
}

/// With the jumps of the slope as unknowns, too, also where few nodes lie beyond a disc.
#[test]
fn nothing_grows_with_jumps_as_unknowns() {
    let shapes = [Shape::half_space([0.4, 0.5], [1.0, 0.0]).unwrap(), Shape::ball([0.5, 0.5], 0.25).unwrap()];
    let params = ParticleDifferenceParams {
        wedge: Wedge::Plane,
        decaying: true,
        ..ParticleDifferenceParams::default()
    };
    let mut found = Vec::new();
    for contrast in [1e-6, 1e-2, 0.1, 10.0, 100.0, 1e6] {
        for (layout, seeds) in [(Layout::Grid, 1..=1), (Layout::Irregular, 1..=3), (Layout::Scattered, 1..=3)]
        {
            for (shape, seed) in shapes.iter().flat_map(|shape| seeds.clone().map(move |seed| (shape, seed)))
            {
                let setup = contact::<2>(shape.clone(), layout, 0.09, seed, contrast);
                let rows = ParticleDifferenceExtended { params }.discretize(&setup.problem()).unwrap();
                let growth = largest_growth(&setup, &rows, 0.09, contrast);
                if growth > 1.5 {
                    found.push(format!("{contrast:e}, {layout:?}, {shape:?}, seed {seed}: {growth}"));
                }
            }
        }
    }
    assert!(found.is_empty(), "{found:#?}");
}

/// Rows of balances say themselves that nothing grows; those of strong forms do not.
#[test]
fn balances_bound_growth() {
    use meshless_interfaces::gfdm::GfdmParams;
    let wall = Shape::half_space([0.4, 0.5], [1.0, 0.0]).unwrap();
    let setup = contact::<2>(wall, Layout::Irregular, 0.09, 1, 1e6);
    let bound = |params| {
        let rows = setup.discretize(params);
        Mass::of(&setup.problem(), &rows).unwrap().growth_bound(&rows)
    };
    let balances = bound(GfdmParams::conservative()).unwrap();
    // Rates reach 1e6 over the square of the spacing, 1e8; rounding of them is what is left.
    assert!(balances.abs() < 1e-6, "{balances:e}");
    assert!(bound(GfdmParams::classical()).is_none_or(|rate| rate > 1.0));
}
