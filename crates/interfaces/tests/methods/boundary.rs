//! Conditions on curved boundaries, by cells and by stencils.

use meshless_geometry::{Domain, Layout, Shape};
use meshless_interfaces::Condition;
use meshless_interfaces::gfdm::GfdmParams;

use crate::support::{Setup, relative_l2};

fn methods() -> [(&'static str, GfdmParams); 3] {
    [
        ("classical", GfdmParams::classical()),
        ("hybrid", GfdmParams::hybrid()),
        ("conservative", GfdmParams::conservative()),
    ]
}

fn ball<const D: usize>(radius: f64) -> Domain<D> {
    Domain::from_shape(Shape::ball([0.0; D], radius).unwrap(), None).unwrap()
}

/// An annulus with u = 0 on the hole and `eta du/dn = 1` on the rim: `u = ln(r / 0.4)`.
fn annulus(spacing: f64) -> Setup<2> {
    let domain = ball(1.0).with_hole("hole", Shape::ball([0.0; 2], 0.4).unwrap()).unwrap();
    let hole = domain.face("hole").unwrap();
    Setup::generated(domain, Layout::Irregular, spacing, 3).conditions(move |face, _| {
        if face == hole { Condition::Dirichlet(0.0) } else { Condition::Flux(1.0) }
    })
}

#[test]
fn the_flux_through_a_curved_face_converges() {
    let exact = 2.0 * std::f64::consts::PI;
    let error = |spacing: f64| {
        let rows = annulus(spacing).discretize(GfdmParams::conservative());
        let total: f64 = rows.rhs.iter().sum();
        (total - exact).abs()
    };
    let [coarse, fine] = [0.1, 0.05].map(error);
    // Chords instead of arcs: second order.
    assert!(fine < coarse / 3.0 && fine < 2e-2, "{coarse:e}, {fine:e}");
}

#[test]
fn the_solution_in_an_annulus_converges() {
    for (name, params) in methods() {
        let [coarse, fine] = [0.1, 0.025].map(|spacing| {
            let setup = annulus(spacing);
            relative_l2(&setup.solve(params), &setup.nodal(|_, x| (x[0].hypot(x[1]) / 0.4).ln()))
        });
        assert!(fine < coarse / 3.5 && fine < 1e-2, "{name}: {coarse:e}, {fine:e}");
    }
}

/// `-lap u = 2 D` and `u + eta du/dn = 0` on a ball: `u = 3 - r^2`.
fn robin_error<const D: usize>(spacing: f64, params: GfdmParams) -> f64 {
    let setup = Setup::<D>::generated(ball(1.0), Layout::Irregular, spacing, 8)
        .source(|_, _| 2.0 * D as f64)
        .conditions(|_, _| Condition::Robin { a: 1.0, b: 1.0, g: 0.0 });
    relative_l2(&setup.solve(params), &setup.nodal(|_, x| 3.0 - x.iter().map(|c| c * c).sum::<f64>()))
}

#[test]
fn robin_conditions_on_curved_boundaries_converge() {
    for (name, params) in methods() {
        let [coarse, fine] = [0.1, 0.05].map(|spacing| robin_error::<2>(spacing, params));
        let exact = fine < 1e-9; // stencils of degree 2 know this solution
        assert!(exact || (fine < 0.6 * coarse && fine < 1e-2), "{name} in 2-D: {coarse:e}, {fine:e}");
        let [coarse, fine] = [0.3, 0.15].map(|spacing| robin_error::<3>(spacing, params));
        assert!(fine < 1e-9 || (fine < 0.6 * coarse && fine < 3e-2), "{name} in 3-D: {coarse:e}, {fine:e}");
    }
}

#[test]
fn problems_whose_parts_do_not_fit_are_refused() {
    let sound = annulus(0.2);
    let refusal = |setup: &Setup<2>| setup.try_solve(GfdmParams::hybrid()).unwrap_err().to_string();
    let mut setup = sound.clone();
    setup.eta[7] = 0.0;
    assert!(refusal(&setup).contains("diffusivity 0 at node 7"), "{}", refusal(&setup));
    setup.eta[7] = f64::NAN;
    assert!(refusal(&setup).contains("diffusivity NaN at node 7"), "{}", refusal(&setup));
    setup.eta.pop();
    assert!(refusal(&setup).contains("diffusivities for"), "{}", refusal(&setup));
    let setup = sound.clone().source(|_, x| (x[0] - 10.0).sqrt());
    assert!(refusal(&setup).contains("the source at node 0"), "{}", refusal(&setup));
    let mut setup = sound;
    setup.labels.clear();
    assert!(refusal(&setup).contains("0 labels for"), "{}", refusal(&setup));
}
