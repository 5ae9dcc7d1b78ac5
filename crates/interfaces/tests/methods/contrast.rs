//! Accuracy at high contrast, by the solution and not by the residual.

use meshless_geometry::{Domain, Layout, Shape};
use meshless_interfaces::Condition;
use meshless_interfaces::gfdm::GfdmParams;
use proptest::prelude::*;

use crate::support::{Setup, grid, max_difference, relative_l2, unit};

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Interfaces at the middles between nodes: the nodal values are those of resistances in series.
    #[test]
    fn layers_in_one_dimension_are_resistances_in_series(
        n in 8..60_usize, layers in proptest::collection::vec((1..6_usize, -12.0..12.0), 2..9),
        ends in (-2.0..2.0, -2.0..2.0),
    ) {
        // Layers are repeated until the interval is full; every one is a region.
        let mut label_of = Vec::new();
        let mut eta = Vec::new();
        for (count, exponent) in layers.iter().cycle() {
            if label_of.len() > n {
                break;
            }
            label_of.extend(std::iter::repeat_n(eta.len(), *count));
            eta.push(10_f64.powf(*exponent));
        }
        label_of.truncate(n + 1);
        let regions = *label_of.last().unwrap() + 1;
        let end_of = |label: usize| (label_of.iter().rposition(|&l| l == label).unwrap() as f64 + 0.5) / n as f64;
        let shapes = (0..regions - 1).map(|l| Some(Shape::cuboid([-1.0], [end_of(l)]).unwrap())).chain([None]);
        let setup = Setup::<1>::new(unit(), grid(n, |_| true)).regions(shapes.collect(), &eta[..regions]).conditions(
            move |face, _| Condition::Dirichlet(if face.0 == 0 { ends.0 } else { ends.1 }),
        );
        prop_assert!(setup.labels.iter().zip(&label_of).all(|(&a, &b)| usize::from(a) == b));
        // Half an interval on either side of the middle; sums of positive numbers are accurate.
        let resistance: Vec<f64> = setup.eta.windows(2).map(|e| 0.5 / e[0] + 0.5 / e[1]).collect();
        let total: f64 = resistance.iter().sum();
        let mut below = 0.0;
        let mut exact = vec![ends.0];
        for (k, r) in resistance.iter().enumerate() {
            below += r;
            let above: f64 = resistance[k + 1..].iter().sum();
            exact.push((ends.0 * above + ends.1 * below) / total);
        }
        let error = max_difference(&setup.solve(GfdmParams::conservative()), &exact);
        prop_assert!(error < 1e-9, "{error:e}");
    }
}

/// A disc in a disc: u = 0 at the rim, a source in the middle.
fn disc_in_disc(eta: f64, spacing: f64, seed: u64) -> Setup<2> {
    let domain = Domain::from_shape(Shape::ball([0.0; 2], 1.0).unwrap(), None).unwrap();
    let disc = Shape::ball([0.0; 2], 0.5).unwrap();
    Setup::generated(domain, Layout::Irregular, spacing, seed)
        .regions(vec![Some(disc), None], &[eta, 1.0])
        .source(|label, _| if label == 0 { 1.0 } else { 0.0 })
}

#[test]
fn the_error_does_not_depend_on_the_contrast() {
    let exact = |eta: f64| {
        move |label: u16, x: &[f64; 2]| {
            let r = x[0].hypot(x[1]);
            if label == 0 { 0.125 * 2_f64.ln() + (0.25 - r * r) / (4.0 * eta) } else { -0.125 * r.ln() }
        }
    };
    for params in [GfdmParams::conservative(), GfdmParams::hybrid()] {
        let error = |eta: f64| {
            let setup = disc_in_disc(eta, 0.06, 4);
            relative_l2(&setup.solve(params), &setup.nodal(exact(eta)))
        };
        let reference = error(1e2);
        assert!(reference < 2e-2, "{reference:e}");
        for eta in [1e6, 1e10, 1e12] {
            let error = error(eta);
            assert!(error < 1.05 * reference, "{error:e} at {eta:e}, {reference:e} at 1e2");
        }
    }
}

/// What a change of eta from 1e10 to 1e12 may change: parts in 1e10.
#[test]
fn nothing_but_round_off_is_left_of_a_contrast_beyond_1e10() {
    let discs = |eta: f64| {
        let centers = [[0.25, 0.25], [0.75, 0.3], [0.5, 0.72]];
        let shape = Shape::union(centers.iter().map(|&c| Shape::ball(c, 0.15).unwrap()).collect()).unwrap();
        Setup::<2>::generated(unit(), Layout::Irregular, 0.05, 2)
            .regions(vec![Some(shape), None], &[eta, 1.0])
            .source(|label, x| if label == 0 { x[0] } else { 0.0 })
            .conditions(|_, x| Condition::Dirichlet(x[1]))
    };
    for params in [GfdmParams::conservative(), GfdmParams::hybrid()] {
        let [a, b] = [1e10, 1e12].map(|eta| discs(eta).try_solve(params).unwrap());
        assert_eq!((a.floating_constants, b.floating_constants), (3, 3), "each disc floats by itself");
        let difference = max_difference(&a.u, &b.u);
        assert!(difference < 1e-9, "{difference:e}");
    }
}

/// Rings of 1, 1e10 c, 1e-6, 1e5 c from outside to inside: a floating ring round a soft one round a floating disc.
#[test]
fn nested_rings_float_one_in_the_other() {
    let rings = |c: f64| {
        let shapes = [0.15, 0.27, 0.39].map(|r| Some(Shape::ball([0.5, 0.5], r).unwrap()));
        Setup::<2>::generated(unit(), Layout::Irregular, 0.03, 7)
            .regions(shapes.into_iter().chain([None]).collect(), &[1e5 * c, 1e-6, 1e10 * c, 1.0])
            .source(|label, _| if label == 0 { 1e-6 } else { f64::from(label == 2) })
            .conditions(|_, x| Condition::Dirichlet(x[0]))
    };
    let [a, b] = [1.0, 1e2].map(|c| rings(c).try_solve(GfdmParams::conservative()).unwrap());
    assert!(a.floating_constants >= 2, "{}", a.floating_constants);
    let difference = max_difference(&a.u, &b.u);
    assert!(difference < 1e-9, "{difference:e}");
    // The level of the disc over that of the ring: the flux 1e-6 A through 1e-6 between two cylinders.
    let setup = rings(1.0);
    let mean = |label: u16| {
        let values: Vec<f64> = (0..a.u.len()).filter(|&i| setup.labels[i] == label).map(|i| a.u[i]).collect();
        values.iter().sum::<f64>() / values.len() as f64
    };
    let exact = 0.5 * 0.15_f64.powi(2) * (0.27_f64 / 0.15).ln();
    let step = mean(0) - mean(2);
    assert!((step - exact).abs() < 0.1 * exact, "{step} instead of {exact}");
}

/// A stiff body that only a heat transfer coefficient of order 1 holds floats as well.
#[test]
fn bodies_held_by_robin_conditions_alone_keep_their_level() {
    for eta in [1e-3, 1.0, 1e6, 1e10, 1e12] {
        let setup = Setup::<1>::new(unit(), grid(200, |_| true))
            .regions(vec![None], &[eta])
            .source(|_, _| 1.0)
            .conditions(|face, _| Condition::Robin {
                a: 1.0,
                b: 1.0,
                g: if face.0 == 0 { 0.0 } else { 2.0 },
            });
        // u = eta d + d x - x^2 / (2 eta) has u = eta u' at 0; u + eta u' = 2 at 1 gives d.
        let d = (3.0 + 0.5 / eta) / (1.0 + 2.0 * eta);
        let exact = setup.nodal(|_, x| eta * d + d * x[0] - x[0] * x[0] / (2.0 * eta));
        let error = max_difference(&setup.solve(GfdmParams::conservative()), &exact);
        let size = exact.iter().fold(0.0_f64, |m, u| m.max(u.abs()));
        assert!(error < 1e-9 * size, "{error:e} of {size:e} at {eta:e}");
    }
}
