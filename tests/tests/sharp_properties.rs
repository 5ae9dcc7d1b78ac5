//! The sharp method on random materials: solutions that are polynomials in every region are exact, whatever floats.

use meshless::interfaces::sharp::Form;
use meshless::plan::{MethodParams, Plan, Stage};
use meshless::scene::{MethodName, Scene};
use meshless::{Silent, Solution, execute};

use meshless_tests::sharp::{circle_mode, ellipse, rings};
use proptest::prelude::*;

fn plan(scene: &Scene, form: Form) -> Plan {
    let mut plan = Plan::new(scene).expect("a plan");
    plan.stages.retain(|s| *s != Stage::Estimate);
    if let MethodParams::Sharp(params) = &mut plan.method.params {
        params.form = form;
    }
    plan
}

fn solve(text: &str, order: usize, form: Form) -> Solution {
    let mut scene = Scene::parse(text, "random.toml").expect("a scene");
    scene.method.name = MethodName::Sharp;
    scene.method.order = Some(order);
    execute(&scene, &plan(&scene, form), &mut Silent).expect("a solution")
}

fn l2(text: &str, form: Form) -> f64 {
    solve(text, 4, form).report.errors.expect("an exact solution").l2
}

/// Strips of equal width between u = 1 on the left and u = 0 on the right, no flux through bottom and top.
fn strips(etas: &[f64]) -> String {
    let width = 2.0 / etas.len() as f64;
    let flux = 1.0 / etas.iter().map(|eta| width / eta).sum::<f64>();
    let mut text =
        "title = \"Strips\"\ndimension = 2\n[domain]\nbox = { min = [-1.0, -1.0], max = [1.0, 1.0] }\n\
                    [points]\nspacing = 0.13\nlayout = \"irregular\"\nseed = 3\n"
            .to_owned();
    let mut at_left = 1.0;
    for (k, eta) in etas.iter().enumerate() {
        let left = -1.0 + width * k as f64;
        let geometry = if k + 1 < etas.len() {
            format!("level_set = \"x - ({:?})\"", left + width)
        } else {
            String::new()
        };
        text += &format!(
            "[[regions]]\nname = \"strip{k}\"\n{geometry}\ndiffusivity = \"{eta:e}\"\nexact = \"{at_left:e} - {:e}*(x - ({left:?}))\"\n",
            flux / eta
        );
        at_left -= width * flux / eta;
    }
    for (face, condition) in
        [("left", "dirichlet = \"1\""), ("right", "dirichlet = \"0\""), ("all", "neumann = \"0\"")]
    {
        text += &format!("[[boundaries]]\nface = \"{face}\"\n{condition}\n");
    }
    text
}

fn diffusivity() -> impl Strategy<Value = f64> {
    (-6.0..6.0_f64).prop_map(|exponent| 10.0_f64.powf(exponent))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 12, ..ProptestConfig::default() })]

    #[test]
    fn chains_of_nested_regions_are_exact(etas in [diffusivity(), diffusivity(), diffusivity()]) {
        // Round-off grows with the number of stencils and with what is left of the constants: measured up to 1e-12.
        let error = l2(&rings(etas, 0.15, 1), Form::Harmonic);
        prop_assert!(error < 1e-9, "{etas:?}: {error:e}");
    }

    #[test]
    fn rows_of_strips_are_exact(etas in prop::collection::vec(diffusivity(), 2..5)) {
        let error = l2(&strips(&etas), Form::Harmonic);
        prop_assert!(error < 1e-9, "{etas:?}: {error:e}");
    }
}

#[test]
fn both_forms_are_exact_for_polynomials_and_agree_elsewhere() {
    for contrast in [1e-8, 1e8] {
        let error = l2(&rings([1.0, contrast, 3.0], 0.15, 2), Form::General);
        assert!(error < 1e-9, "{contrast:e}: {error:e}");
    }
    // No source: both forms see the same data.
    for contrast in [1e-6, 1e6] {
        let text = circle_mode(contrast, 0.1, 1);
        let [harmonic, general] = [Form::Harmonic, Form::General].map(|form| l2(&text, form));
        assert!(harmonic < 1e-2 && (0.2..5.0).contains(&(general / harmonic)), "{harmonic:e} {general:e}");
    }
}

#[test]
fn the_estimate_is_near_the_error() {
    for (text, order) in
        [(circle_mode(1e6, 0.05, 1), 4), (ellipse(1e2, 0.1, 1), 4), (ellipse(1e2, 0.1, 1), 6)]
    {
        let mut scene = Scene::parse(&text, "gallery.toml").expect("a scene");
        scene.method.name = MethodName::Sharp;
        scene.method.order = Some(order);
        let report =
            execute(&scene, &Plan::new(&scene).expect("a plan"), &mut Silent).expect("a solution").report;
        let (error, estimate) = (report.errors.expect("exact").l2, report.estimate.l2.expect("an estimate"));
        assert!((0.2..5.0).contains(&(estimate / error)), "{}: {estimate:e} for {error:e}", scene.title);
    }
}

#[test]
fn probes_are_as_accurate_as_nodes() {
    let at = [[0.31, 0.32], [0.499, 0.02], [0.502, 0.02], [-0.9, 0.77]];
    let probes: String = at.iter().map(|[x, y]| format!("[[probes]]\nat = [{x}, {y}]\n")).collect();
    let inside = 10.0;
    let solution = solve(&(circle_mode(inside, 0.05, 1) + &probes), 6, Form::Harmonic);
    // The largest |u| is 2, about, at two corners.
    let limit = 3.0 * 2.0 * solution.report.errors.as_ref().expect("exact").linf;
    assert!(limit < 1e-3, "{limit}");
    let b = (1.0 - inside) / (1.0 + inside);
    for (probe, [x, y]) in solution.report.probes.iter().zip(at) {
        let (mode, square): (f64, f64) = (x * x * x - 3.0 * x * y * y, x * x + y * y);
        let beyond = b * (0.25 / square).powi(3);
        let exact = if square < 0.25 { (1.0 + b) * mode } else { mode * (1.0 + beyond) };
        let value = probe.value.expect("inside of the domain");
        assert!((value - exact).abs() < limit, "{value} {exact}");
    }
}

/// Fluxes, an exchange and a value, also where an interface meets them; then nothing but fluxes.
#[test]
fn conditions_on_the_flux() {
    let head = "title = \"Fluxes\"\ndimension = 2\n[domain]\nbox = { min = [0.0, 0.0], max = [1.0, 1.0] }\n\
                [points]\nspacing = 0.06\nlayout = \"irregular\"\nseed = 1\n\
                [[regions]]\nname = \"left\"\nlevel_set = \"x - 0.512\"\ndiffusivity = \"1e3\"\n\
                exact = \"exp(y)*sin(x - 0.512)/1e3\"\n\
                [[regions]]\nname = \"right\"\ndiffusivity = \"1\"\nexact = \"exp(y)*sin(x - 0.512)\"\n";
    let eta = "if(x < 0.512, 1e3, 1)";
    let mixed = format!(
        "[[boundaries]]\nface = \"left\"\nflux = \"-exp(y)*cos(x - 0.512)\"\n\
         [[boundaries]]\nface = \"right\"\nrobin = {{ a = \"2\", b = \"1\", g = \"exp(y)*(2*sin(x - 0.512) + cos(x - 0.512))\" }}\n\
         [[boundaries]]\nface = \"bottom\"\nneumann = \"-exp(y)*sin(x - 0.512)/{eta}\"\n\
         [[boundaries]]\nface = \"top\"\ndirichlet = \"exp(y)*sin(x - 0.512)/{eta}\"\n"
    );
    let fluxes = format!(
        "[[boundaries]]\nface = \"left\"\nflux = \"-exp(y)*cos(x - 0.512)\"\n\
         [[boundaries]]\nface = \"right\"\nflux = \"exp(y)*cos(x - 0.512)\"\n\
         [[boundaries]]\nface = \"bottom\"\nneumann = \"-exp(y)*sin(x - 0.512)/{eta}\"\n\
         [[boundaries]]\nface = \"top\"\nneumann = \"exp(y)*sin(x - 0.512)/{eta}\"\n"
    );
    for (conditions, limit) in [(mixed, 1e-6), (fluxes, 1e-5)] {
        let errors = solve(&format!("{head}{conditions}"), 6, Form::Harmonic).report.errors.expect("exact");
        assert!(errors.l2 < limit && errors.gradient_linf < 100.0 * limit, "{errors:?}");
    }
}

#[test]
fn the_line() {
    let text = "title = \"Line\"\ndimension = 1\n[domain]\nbox = { min = [0.0], max = [1.0] }\n\
                [points]\nspacing = 0.05\nlayout = \"irregular\"\nseed = 1\n\
                [[regions]]\nname = \"left\"\nlevel_set = \"x - 0.412\"\ndiffusivity = \"1e6\"\nsource = \"sin(x - 0.412)\"\n\
                exact = \"sin(x - 0.412)/1e6\"\n\
                [[regions]]\nname = \"right\"\ndiffusivity = \"1 + x\"\n\
                source = \"-(1 + 2*(x - 0.412))/1.412 - 2*(1 + x)/1.412\"\n\
                exact = \"(x - 0.412)/1.412 + (x - 0.412)^2/1.412\"\n\
                [[boundaries]]\nface = \"left\"\nflux = \"-cos(x - 0.412)\"\n\
                [[boundaries]]\nface = \"right\"\ndirichlet = \"(x - 0.412)/1.412 + (x - 0.412)^2/1.412\"\n";
    let errors = solve(text, 6, Form::Harmonic).report.errors.expect("exact");
    assert!(errors.l2 < 1e-8, "{errors:?}");
}
