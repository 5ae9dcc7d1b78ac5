//! What accuracy costs in time, for one scene.

use meshless::cost::{CostParams, chart, cost, table};
use meshless::scene::{MethodName, Scene};
use meshless_tests::kraus;

fn params(methods: &[MethodName]) -> CostParams {
    CostParams { methods: methods.to_vec(), seconds: 60.0 }
}

#[test]
fn ladders_show_the_orders_of_their_methods() {
    let scene = Scene::parse(&kraus::interior(1e6, kraus::SUPPORT * 0.05, 1), "scene.toml").expect("a scene");
    let mut told = 0;
    let methods = [MethodName::GfdmHybrid, MethodName::Sharp];
    let report = cost(&scene, &params(&methods), &mut |_| told += 1).expect("a report");
    assert_eq!(report.reference, "the exact solution");
    assert_eq!((told, report.runs.len()), (20, 20), "the hybrid, and three orders of the sharp method");
    let errors = |method: &str, order: usize| -> Vec<(f64, f64)> {
        let of = report.runs.iter().filter(|r| r.method == method && r.order == order);
        of.map(|r| (r.spacing, r.error.expect("solved"))).collect()
    };
    let order = |rungs: &[(f64, f64)]| {
        let (first, last) = (rungs[0], rungs[rungs.len() - 1]);
        (first.1 / last.1).ln() / (first.0 / last.0).ln()
    };
    assert!(order(&errors("gfdm-hybrid", 2)) > 0.8);
    assert!(order(&errors("sharp", 4)) > 3.5);
    assert!(report.runs.iter().any(|r| r.best_buy && r.method == "sharp"));
    assert!(report.runs.iter().all(|r| r.seconds > 0.0 && r.unknowns > 0));
    assert_eq!(table(&report).lines().count(), 21);
    assert!(chart(&report).expect("a drawing").contains("sharp, order 4"));
}

#[test]
fn without_an_exact_solution_the_finest_one_serves() {
    let text = kraus::interior(1e2, kraus::SUPPORT * 0.08, 1);
    let closed = Scene::parse(&text, "scene.toml").expect("a scene");
    let mut open = closed.clone();
    open.regions.iter_mut().for_each(|region| region.exact = None);
    let methods = [MethodName::ParticleDifference];
    let (closed, open) = (
        cost(&closed, &params(&methods), &mut |_| {}).expect("a report"),
        cost(&open, &params(&methods), &mut |_| {}).expect("a report"),
    );
    assert!(open.reference.starts_with("sharp of order 8"), "{}", open.reference);
    assert!(open.reference_error.expect("an estimate") < 1e-8);
    for (a, b) in closed.runs.iter().zip(&open.runs) {
        let (a, b) = (a.error.expect("solved"), b.error.expect("solved"));
        // A few nodes beside the interface have no region in common with the reference.
        assert!((a - b).abs() <= 0.05 * a, "{a} against the closed form, {b} against the reference");
    }
}

#[test]
fn a_method_that_cannot_solve_the_scene_says_why_in_its_runs() {
    let scene = Scene::parse(include_str!("../../examples/crack.toml"), "crack.toml").expect("a scene");
    let both = [MethodName::ParticleDifferenceExtended, MethodName::ParticleDifference];
    let report = cost(&scene, &params(&both), &mut |_| {}).expect("a report");
    let refused = report.runs.iter().filter(|r| r.method == "particle-difference-extended");
    assert!(refused.clone().count() == 5 && refused.clone().all(|r| r.error.is_none() && r.why.is_some()));
    assert!(report.runs.iter().any(|r| r.method == "particle-difference" && r.error.is_some()));
}

#[test]
fn a_scene_with_time_is_compared_by_the_sharp_method_as_well() {
    let scene = Scene::parse(&meshless_tests::unsteady::composite(1, 0.1, 10.0, 1e-3), "contact.toml");
    let report = cost(&scene.expect("a scene"), &params(&[]), &mut |_| {}).expect("a report");
    for order in [4, 6] {
        let mut sharp = report.runs.iter().filter(|r| r.method == "sharp" && r.order == order);
        assert!(sharp.any(|r| r.error.is_some()), "order {order}");
    }
}
