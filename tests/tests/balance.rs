//! What enters and arises is what leaves and is stored; where it is not, the estimate says so.

use std::f64::consts::PI;

use meshless::plan::Plan;
use meshless::report::{BalanceReport, Report};
use meshless::scene::{MethodName, Scene};
use meshless::{Error, Silent, execute};

fn solved(text: &str, method: MethodName) -> Result<Report, Error> {
    let mut scene = Scene::parse(text, "balance.toml")?;
    scene.method.name = method;
    Ok(execute(&scene, &Plan::new(&scene)?, &mut Silent)?.report)
}

fn balance(report: &Report) -> &BalanceReport {
    report.balance.as_ref().expect("every report has a balance")
}

fn close(found: f64, exact: f64, bound: f64) {
    assert!((found - exact).abs() <= bound * exact.abs().max(1.0), "{found:.15e} is not {exact:.15e}");
}

/// A plate or a cube with a source, alike on all sides.
fn heated(dimension: usize, spacing: f64, source: &str) -> String {
    format!(
        "title = \"Heated\"\ndimension = {dimension}\n[domain]\nbox = {{ min = {:?}, max = {:?} }}\n\
         [points]\nspacing = {spacing}\n[[regions]]\nname = \"all\"\ndiffusivity = 2\nsource = \"{source}\"\n\
         [[boundaries]]\nface = \"all\"\ndirichlet = 0\n",
        vec![0.0; dimension],
        vec![1.0; dimension]
    )
}

/// Integrals of sources know nothing of the solution.
#[test]
fn sources_are_integrated_to_round_off() {
    let exp = 1.0_f64.exp() - 1.0;
    for (dimension, spacing) in [(1, 0.05), (2, 0.1), (3, 0.2)] {
        let report =
            solved(&heated(dimension, spacing, "3"), MethodName::GfdmClassical).expect("it is solved");
        close(balance(&report).sources.total, 3.0, 1e-12);
        let report =
            solved(&heated(dimension, spacing, "exp(x)"), MethodName::GfdmClassical).expect("it is solved");
        close(balance(&report).sources.total, exp, 1e-12);
        assert!(balance(&report).relative < 0.1, "{report:?}");
    }
}

/// Quadratic solutions are exact for fits of any degree here: what is left over then is the quadrature's.
#[test]
fn quadratics_leave_nothing_over() {
    let domains = [
        "box = { min = [-1, -0.7], max = [0.8, 0.9] }",
        "sphere = { center = [0.1, 0], radius = 1 }",
        "polygon = [[-1, -1], [1, -0.8], [0.2, 1]]",
        "level_set = \"x^2 + 2*y^2 - 1\"\nbounds = { min = [-1.2, -1], max = [1.2, 1] }",
    ];
    for domain in domains {
        let text = format!(
            "title = \"Quadratic\"\ndimension = 2\n[domain]\n{domain}\n[points]\nspacing = 0.12\n\
             [[regions]]\nname = \"all\"\ndiffusivity = 1\nsource = -6\nexact = \"x^2 + 2*y^2 + x*y\"\n\
             [[boundaries]]\nface = \"all\"\ndirichlet = \"x^2 + 2*y^2 + x*y\"\n"
        );
        let report = solved(&text, MethodName::Sharp).expect("it is solved");
        let found = balance(&report);
        assert!(found.relative < 1e-9, "{domain}: {found:?}");
        assert_eq!(report.estimate.raised_by, None);
    }
}

/// An annulus of two materials with a source in one of them, and what leaves known in closed form.
#[test]
fn an_annulus_with_a_source() {
    let text = "title = \"Annulus\"\ndimension = 2\n[domain]\nsphere = { center = [0, 0], radius = 1 }\n\
                [points]\nspacing = 0.06\n[[holes]]\nname = \"core\"\nsphere = { center = [0, 0], radius = 0.4 }\n\
                [[regions]]\nname = \"inner\"\nsphere = { center = [0, 0], radius = 0.7 }\ndiffusivity = 5\nsource = 3\n\
                [[regions]]\nname = \"outside\"\ndiffusivity = 0.5\n\
                [[boundaries]]\nface = \"core\"\nflux = 0.5\n[[boundaries]]\nface = \"outer\"\ndirichlet = 0\n";
    let report = solved(text, MethodName::Auto).expect("it is solved");
    let found = balance(&report);
    let (made, given) = (3.0 * PI * (0.49 - 0.16), 0.5 * PI * 0.8);
    close(found.sources.total, made, 1e-12);
    close(found.into[0].flux, given, 1e-12);
    close(found.into[1].flux, -made - given, 2e-3);
    close(found.regions["inner"].interfaces, -made - given, 2e-3);
    assert!(found.relative < 2e-3 && report.estimate.raised_by.is_none(), "{report:?}");
}

/// A jump of the flux is a source on the interface.
#[test]
fn jumps_of_the_flux_count_as_sources() {
    let text = "title = \"Jump\"\ndimension = 2\n[domain]\nbox = { min = [0, 0], max = [2, 1] }\n[points]\nspacing = 0.1\n\
                [[regions]]\nname = \"a\"\nbox = { min = [0, 0], max = [0.83, 1] }\ndiffusivity = 4\n\
                [[regions]]\nname = \"b\"\ndiffusivity = 0.5\n\
                [[interfaces]]\nbetween = [\"a\", \"b\"]\nflux_jump = -0.7\n\
                [[boundaries]]\nface = \"left\"\ndirichlet = 1\n[[boundaries]]\nface = \"right\"\ndirichlet = 0\n\
                [[boundaries]]\nface = \"all\"\nneumann = 0\n";
    for text in [text.to_owned(), text.replace("[\"a\", \"b\"]", "[\"b\", \"a\"]")] {
        let report = solved(&text, MethodName::Sharp).expect("it is solved");
        let found = balance(&report);
        close(found.sources.flux_jumps, 0.7, 1e-12);
        assert!(found.relative < 1e-9, "{found:?}");
        assert!(found.regions.values().all(|region| region.relative < 1e-9), "{found:?}");
    }
}

/// What does not leave is stored.
#[test]
fn heat_that_is_stored() {
    let text = "title = \"Bar\"\ndimension = 2\n[domain]\nbox = { min = [0, 0], max = [1, 0.5] }\n[points]\nspacing = 0.05\n\
                [[regions]]\nname = \"bar\"\ndiffusivity = 1\nsource = 2\n[time]\nend = 0.1\n\
                [[boundaries]]\nface = \"left\"\ndirichlet = 0\n[[boundaries]]\nface = \"all\"\nneumann = 0\n";
    for method in [MethodName::Auto, MethodName::Sharp] {
        let report = solved(text, method).expect("it is solved");
        let found = balance(&report);
        assert!(found.stored.is_some_and(|stored| stored > 0.4), "{found:?}");
        assert!(found.relative < 1e-2 && report.estimate.raised_by.is_none(), "{method:?}: {report:?}");
    }
}

/// Scenes by their data only: what is made is known, so what leaves is.
fn natural() -> Vec<(String, f64)> {
    let chip = |dimension: usize, half: f64, spacing: f64, eta: f64| {
        let all = |x: f64| format!("{:?}", vec![x; dimension]);
        format!(
            "title = \"Heated box in a box\"\ndimension = {dimension}\n[domain]\nbox = {{ min = {}, max = {} }}\n\
             [points]\nspacing = {spacing}\n[[regions]]\nname = \"chip\"\nbox = {{ min = {}, max = {} }}\n\
             diffusivity = {eta}\nsource = 10\n[[regions]]\nname = \"plate\"\ndiffusivity = 1\n\
             [[boundaries]]\nface = \"all\"\ndirichlet = 0\n",
            all(-1.0),
            all(1.0),
            all(-half),
            all(half)
        )
    };
    vec![(chip(2, 0.3, 0.05, 10.0), 3.6), (chip(2, 0.3, 0.05, 1e-10), 3.6), (chip(3, 0.4, 0.2, 10.0), 5.12)]
}

/// Either what leaves is what is made, or the estimate says by how much it is not.
#[test]
fn an_answer_that_is_wrong_says_so() {
    for (text, made) in natural() {
        let report = solved(&text, MethodName::Sharp).expect("it is solved");
        let found = balance(&report);
        close(found.sources.total, made, 1e-12);
        close(found.left_over, made + found.into[0].flux, 1e-9);
        // The fluxes on both sides are parts of the balance.
        let wrong = (found.left_over / made).abs().min(1.0);
        let estimate = report.estimate.l2.expect("an estimate");
        assert!(wrong < 1e-2 || estimate > 0.25 * wrong, "{wrong:.1e}, {estimate:.1e}: {report:?}");
    }
}

/// Balances over all cells close to what the solver leaves, whatever the corners; against the sources as they are given, to how well cells cut
/// by interfaces are known. By the sources at the nodes that is 1 to 8 %.
#[test]
fn conservative_methods_leave_nothing_over() {
    for (text, _) in natural().into_iter().filter(|(text, _)| !text.contains("1e-10")) {
        let report = solved(&text, MethodName::GfdmConservative).expect("it is solved");
        let found = balance(&report);
        assert!(
            found.relative < 1e-3 && report.estimate.raised_by.as_deref() != Some("balance"),
            "{report:?}"
        );
        assert!(report.matrix.column_sum < 1e-12, "{:?}", report.matrix);
        assert!(found.regions.values().all(|region| region.relative < 1e-3), "{found:?}");
    }
}

/// What two solutions that make the same mistake agree about is no reason to stop.
#[test]
fn no_tolerance_is_met_by_what_is_left_over() {
    let (text, made) = natural().swap_remove(0);
    let text = text.replace("[points]\nspacing = 0.05\n", "[accuracy]\ntolerance = 0.02\nmax_nodes = 3000\n");
    match solved(&text, MethodName::Sharp) {
        Ok(report) => assert!((balance(&report).into[0].flux / made + 1.0).abs() < 0.02, "{report:?}"),
        Err(error) => assert!(error.to_string().contains("was not reached"), "{error}"),
    }
}

/// Smooth solutions of low order are not blamed for fluxes that are less accurate than they are.
#[test]
fn smooth_solutions_keep_their_estimates() {
    let exact = "sin(2*x)*exp(y)";
    let text = format!(
        "title = \"Smooth\"\ndimension = 2\n[domain]\nbox = {{ min = [0, 0], max = [1, 1] }}\n[points]\nspacing = 0.05\n\
         [[regions]]\nname = \"all\"\ndiffusivity = 1\nsource = \"3*{exact}\"\nexact = \"{exact}\"\n\
         [[boundaries]]\nface = \"all\"\ndirichlet = \"{exact}\"\n"
    );
    for method in [MethodName::GfdmClassical, MethodName::GfdmHybrid, MethodName::Sharp] {
        let report = solved(&text, method).expect("it is solved");
        assert_eq!(report.estimate.raised_by, None, "{method:?}: {report:?}");
    }
}

/// A void has no heat of its own: it is as warm as what is round it, whatever cells its walls cut.
#[test]
fn a_void_in_a_heated_plate_is_no_warmer_than_the_plate() {
    for eta in [1e-3, 1e-6, 1e-10] {
        for (method, time) in [
            (MethodName::GfdmConservative, ""),
            (MethodName::GfdmHybrid, ""),
            (MethodName::GfdmConservative, "[time]\nend = 3\n"),
        ] {
            let text = format!(
                "title = \"Void\"\ndimension = 2\n[domain]\nbox = {{ min = [0, 0], max = [1, 1] }}\n[points]\nspacing = 0.05\n\
                 [[regions]]\nname = \"void\"\nbox = {{ min = [0.3, 0.3], max = [0.7, 0.7] }}\ndiffusivity = {eta:e}\n\
                 [[regions]]\nname = \"plate\"\ndiffusivity = 1\nsource = 1\n\
                 [[boundaries]]\nface = \"all\"\ndirichlet = 0\n{time}"
            );
            let report = solved(&text, method).expect("it is solved");
            // An insulated square in the plate: 0.0397 at its corners, by fits with functions of corners.
            assert!(report.extrema.max < 0.042, "{eta:e} {method:?} {time}: {:?}", report.extrema);
            close(balance(&report).sources.total, 0.84, 1e-3);
            assert!(balance(&report).relative < 1e-3, "{eta:e} {method:?} {time}: {:?}", report.balance);
        }
    }
}
