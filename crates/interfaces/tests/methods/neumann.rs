//! Problems in which only fluxes are prescribed.

use std::f64::consts::PI;

use meshless_geometry::{Layout, Shape};
use meshless_interfaces::gfdm::GfdmParams;
use meshless_interfaces::{Condition, MethodError};

use crate::support::{Setup, max_difference, relative_l2, unit};

fn methods() -> [GfdmParams; 3] {
    [GfdmParams::classical(), GfdmParams::hybrid(), GfdmParams::conservative()]
}

/// `u = cos(pi x) cos(pi y)`, whose normal derivative is zero on the unit square.
fn cosines(spacing: f64, excess: f64) -> Setup<2> {
    Setup::generated(unit(), Layout::Irregular, spacing, 6)
        .source(move |_, x| excess + 2.0 * PI * PI * (PI * x[0]).cos() * (PI * x[1]).cos())
        .conditions(|_, _| Condition::Neumann(0.0))
}

#[test]
fn the_solution_is_found_up_to_a_constant() {
    for params in methods() {
        let [coarse, fine] = [0.1, 0.05].map(|h| {
            let setup = cosines(h, 0.0);
            let solution = setup.try_solve(params).unwrap();
            assert!(solution.up_to_constant);
            let volumes = setup.discretize(params).volumes;
            let mean: f64 = solution.u.iter().zip(&volumes).map(|(u, v)| u * v).sum();
            assert!(mean.abs() < 1e-12, "weighted mean {mean:e}");
            let mut exact = setup.nodal(|_, x| (PI * x[0]).cos() * (PI * x[1]).cos());
            let shift =
                exact.iter().zip(&volumes).map(|(u, v)| u * v).sum::<f64>() / volumes.iter().sum::<f64>();
            exact.iter_mut().for_each(|u| *u -= shift);
            relative_l2(&solution.u, &exact)
        });
        assert!(fine < 3e-2 && fine < 0.7 * coarse, "{params:?}: {coarse:e}, {fine:e}");
    }
}

#[test]
fn data_that_do_not_balance_are_refused() {
    for params in methods() {
        let error = cosines(0.1, 2.0).try_solve(params).unwrap_err();
        assert!(matches!(error, MethodError::Incompatible { defect } if defect > 0.05), "{error}");
        assert!(error.to_string().contains("must balance"), "{error}");
    }
}

/// Only the surroundings hold the levels of the discs, here, too.
#[test]
fn stiff_discs_float_in_a_pure_neumann_problem() {
    let discs = |eta: f64| {
        let shape = [[0.3, 0.3], [0.7, 0.65]].map(|c| Shape::ball(c, 0.17).unwrap());
        Setup::<2>::generated(unit(), Layout::Irregular, 0.05, 2)
            .regions(vec![Some(Shape::union(shape.to_vec()).unwrap()), None], &[eta, 1.0])
            .conditions(|face, _| Condition::Flux([1.0, -1.0, 0.5, -0.5][face.0 as usize]))
    };
    let [a, b] = [1e10, 1e12].map(|eta| discs(eta).try_solve(GfdmParams::conservative()).unwrap());
    assert!(a.up_to_constant && a.floating_constants == 2, "{}", a.floating_constants);
    let difference = max_difference(&a.u, &b.u);
    assert!(difference < 1e-9, "{difference:e}");
}
