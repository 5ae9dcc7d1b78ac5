//! The sharp method on random materials: solutions that are polynomials in every region are exact, whatever floats.

use meshless::interfaces::sharp::Form;
use meshless::plan::{MethodParams, Plan, Stage};
use meshless::scene::{MethodName, Scene};
use meshless::{Silent, Solution, execute};

use meshless_tests::kraus;
use meshless_tests::sharp::{circle_mode, ellipse, graded, rings};
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

/// Discs beside each other and within each other: centers on the x axis, radii, and the disc that each lies in.
const DISCS: [(f64, f64, Option<usize>); 6] = [
    (-0.5, 0.4, None),
    (0.5, 0.4, None),
    (-0.68, 0.14, Some(0)),
    (-0.3, 0.15, Some(0)),
    (0.32, 0.14, Some(1)),
    (0.7, 0.15, Some(1)),
];

/// A material: diffusivity, and the constant, the slopes and the curvature of its solution.
type Material = (f64, [f64; 4]);

/// Whether a disc is there: with what it lies in.
fn is_there(present: &[bool; 6], k: usize) -> bool {
    present[k] && DISCS[k].2.is_none_or(|parent| present[parent])
}

/// Largest over smallest diffusivity of what is there.
fn contrast(present: &[bool; 6], materials: &[Material; 7]) -> f64 {
    let etas = (0..7).filter(|&k| k == 6 || is_there(present, k)).map(|k| materials[k].0);
    let (low, high) = etas.fold((f64::INFINITY, 0.0_f64), |(l, h), eta| (l.min(eta), h.max(eta)));
    high / low
}

/// The same materials with jumps of u that are as large as u varies on the softer side of them.
fn with_small_jumps(mut materials: [Material; 7]) -> [Material; 7] {
    let softest = materials.iter().fold(f64::INFINITY, |least, m| least.min(m.0));
    // Those within others come after them.
    for k in 0..6 {
        let (eta, [around, ..]) = materials[DISCS[k].2.unwrap_or(6)];
        materials[k].1[0] = around + materials[k].1[0] * softest / eta.min(materials[k].0);
    }
    materials
}

/// A plate with some of the discs in it. The solution of each is a quadratic polynomial of its own, the steeper the softer it
/// is so that fluxes are of one size; u and its flux jump accordingly.
fn discs(present: &[bool; 6], materials: &[Material; 7], fluxes: bool) -> String {
    // Coefficients of 1, x, y, x^2, y^2 of u.
    let softest = materials.iter().fold(f64::INFINITY, |least, m| least.min(m.0));
    let u = |(eta, [constant, x, y, curvature]): Material| {
        let g = softest / eta;
        [constant, g * x, g * y, g * (curvature + 0.3), g * (curvature - 0.3)]
    };
    let text = |[c, x, y, xx, yy]: [f64; 5]| {
        format!("({c:e}) + ({x:e})*x + ({y:e})*y + ({xx:e})*x^2 + ({yy:e})*y^2")
    };
    let mut scene =
        "title = \"Discs\"\ndimension = 2\n[domain]\nbox = { min = [-1.0, -1.0], max = [1.0, 1.0] }\n\
                     [points]\nspacing = 0.08\nlayout = \"irregular\"\nseed = 5\n"
            .to_owned();
    let region = |name: &str, shape: &str, material: Material| {
        let [.., xx, yy] = u(material);
        format!(
            "[[regions]]\nname = \"{name}\"\n{shape}diffusivity = \"{:e}\"\nsource = \"{:e}\"\nexact = \"{}\"\n",
            material.0,
            -2.0 * material.0 * (xx + yy),
            text(u(material)),
        )
    };
    let is_there = |k: usize| is_there(present, k);
    // The innermost first: regions are taken in order.
    for k in (0..6).rev().filter(|&k| is_there(k)) {
        let (x, radius, _) = DISCS[k];
        let shape = format!("sphere = {{ center = [{x:?}, 0.0], radius = {radius:?} }}\n");
        scene += &region(&format!("disc {k}"), &shape, materials[k]);
    }
    scene += &region("plate", "", materials[6]);
    for k in (0..6).filter(|&k| is_there(k)) {
        let (x, radius, parent) = DISCS[k];
        let outer = parent.unwrap_or(6);
        let outer_name = parent.map_or_else(|| "plate".to_owned(), |parent| format!("disc {parent}"));
        let (inside, outside) = (u(materials[k]), u(materials[outer]));
        let flux: [f64; 5] =
            std::array::from_fn(|m| materials[outer].0 * outside[m] - materials[k].0 * inside[m]);
        scene += &format!(
            "[[interfaces]]\nbetween = [\"disc {k}\", \"{outer_name}\"]\njump = \"{}\"\n\
             flux_jump = \"((({:e}) + 2*({:e})*x)*(x - ({x:?})) + (({:e}) + 2*({:e})*y)*y)/{radius:?}\"\n",
            text(std::array::from_fn(|m| outside[m] - inside[m])),
            flux[1],
            flux[3],
            flux[2],
            flux[4],
        );
    }
    let (outside, eta) = (u(materials[6]), materials[6].0);
    if fluxes {
        for (face, sign) in [("bottom", -1.0), ("top", 1.0)] {
            let slope = sign * eta;
            scene += &format!(
                "[[boundaries]]\nface = \"{face}\"\nflux = \"{slope:e}*(({:e}) + 2*({:e})*y)\"\n",
                outside[2], outside[4]
            );
        }
    }
    scene + &format!("[[boundaries]]\nface = \"all\"\ndirichlet = \"{}\"\n", text(outside))
}

fn material() -> impl Strategy<Value = Material> {
    (diffusivity(), [-1.0..1.0_f64, -1.0..1.0, -1.0..1.0, -1.0..1.0])
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 12, ..ProptestConfig::default() })]

    #[test]
    fn chains_of_nested_regions_are_exact(etas in [diffusivity(), diffusivity(), diffusivity()]) {
        // Round-off grows with the number of stencils and with what is left of the constants: measured up to 1e-12.
        let error = l2(&rings(etas, 0.15, 1), Form::Trefftz);
        prop_assert!(error < 1e-9, "{etas:?}: {error:e}");
    }

    #[test]
    fn rows_of_strips_are_exact(etas in prop::collection::vec(diffusivity(), 2..5)) {
        let error = l2(&strips(&etas), Form::Trefftz);
        prop_assert!(error < 1e-9, "{etas:?}: {error:e}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 10, ..ProptestConfig::default() })]

    /// Whatever lies in what and is stiffer than what: contrasts from 1e-12 to 1e12. Where u jumps between stiff regions by as
    /// much as it varies in soft ones, the jump is known to 1e-16 of itself, which its flux is a large multiple of.
    #[test]
    fn random_graphs_of_regions_are_exact(
        present in prop::array::uniform6(prop::bool::weighted(0.7)),
        materials in prop::array::uniform7(material()),
        fluxes in any::<bool>(),
    ) {
        let rounding = f64::EPSILON * contrast(&present, &materials);
        for (materials, limit) in [(materials, 1e-9 + rounding), (with_small_jumps(materials), 1e-9)] {
            let error = l2(&discs(&present, &materials, fluxes), Form::Trefftz);
            prop_assert!(error < limit, "{present:?} {materials:?} {fluxes}: {error:e}");
        }
    }
}

/// Two stiff regions of about the same diffusivity, one within the other, in a soft plate: they float together.
#[test]
fn regions_that_float_together_are_joined_as_firmly_as_others() {
    let smooth = (1.0, [0.0; 4]);
    let outer = [-0.16, 0.73, 0.5, 0.05];
    let inner = [0.34, -0.85, 0.95, 0.08];
    let plate = (4.4e-6, [-0.56, 0.01, -0.52, -0.67]);
    for (stiff, softer, limit) in [(3.3e3, 2.7e3, 1e-6), (27.0, 69.0, 1e-8), (1e2, 3.6e-2, 1e-8)] {
        let mut materials = [smooth; 7];
        (materials[0], materials[3], materials[6]) = ((stiff, outer), (softer, inner), plate);
        let present = [true, false, false, true, false, false];
        for (materials, limit) in [(materials, limit), (with_small_jumps(materials), 1e-11)] {
            let error = l2(&discs(&present, &materials, true), Form::Trefftz);
            assert!(error < limit, "{stiff:e}, {softer:e}: {error:e}");
        }
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
        let [harmonic, general] = [Form::Trefftz, Form::General].map(|form| l2(&text, form));
        assert!(harmonic < 1e-2 && (0.2..5.0).contains(&(general / harmonic)), "{harmonic:e} {general:e}");
    }
}

/// Polynomials that solve the equation of a diffusivity that varies do as well as those of a constant one.
#[test]
fn a_diffusivity_that_varies_costs_no_accuracy() {
    let error = |contrast: f64, form| l2(&graded(contrast, 0.1, 1), form);
    let constant = error(1.0, Form::Trefftz);
    for contrast in [1e1, 1e4, 1e8, 1e12] {
        let [solved, rows] = [Form::Trefftz, Form::General].map(|form| error(contrast, form));
        assert!(solved < 30.0 * constant, "{contrast:e}: {solved:e}, {constant:e} where it is constant");
        assert!(solved < rows, "{contrast:e}: {solved:e}, {rows:e} with the equation in rows");
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
        let Solution { report, field, .. } =
            execute(&scene, &Plan::new(&scene).expect("a plan"), &mut Silent).expect("a solution");
        // Node by node: what it leaves of the error is small.
        let (exact, estimated) = (field.exact.expect("exact"), field.estimate.expect("one order more"));
        let norm = |values: &mut dyn Iterator<Item = f64>| values.map(|v| v * v).sum::<f64>().sqrt();
        let all = norm(&mut field.u.iter().zip(&exact).map(|(u, e)| u - e));
        let left = norm(&mut field.u.iter().zip(&exact).zip(&estimated).map(|((u, e), d)| u - e - d));
        assert!(left < 0.5 * all, "{}: {left:e} of {all:e}", scene.title);
        let (error, estimate) = (report.errors.expect("exact").l2, report.estimate.l2.expect("an estimate"));
        assert!((0.2..5.0).contains(&(estimate / error)), "{}: {estimate:e} for {error:e}", scene.title);
    }
}

#[test]
fn probes_are_as_accurate_as_nodes() {
    let at = [[0.31, 0.32], [0.499, 0.02], [0.502, 0.02], [-0.9, 0.77]];
    let probes: String = at.iter().map(|[x, y]| format!("[[probes]]\nat = [{x}, {y}]\n")).collect();
    let inside = 10.0;
    let solution = solve(&(circle_mode(inside, 0.05, 1) + &probes), 6, Form::Trefftz);
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
        let errors = solve(&format!("{head}{conditions}"), 6, Form::Trefftz).report.errors.expect("exact");
        assert!(errors.l2 < limit && errors.gradient_linf < 100.0 * limit, "{errors:?}");
    }
}

#[test]
fn the_highest_orders() {
    for order in [10, 12, 14, 16] {
        let error = solve(&kraus::interior(1e6, kraus::SUPPORT * 0.1, 1), order, Form::Trefftz)
            .report
            .errors
            .expect("exact");
        assert!(error.l2 < 1e-9 && error.gradient_linf < 1e-7, "order {order}: {error:?}");
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
    let errors = solve(text, 6, Form::Trefftz).report.errors.expect("exact");
    assert!(errors.l2 < 1e-8, "{errors:?}");
    for order in (4..=16).step_by(2) {
        let errors = solve(text, order, Form::Trefftz).report.errors.expect("exact");
        // Powers on 17 and 19 nodes of a line: their condition is what is left.
        let limit = match order {
            4 => 1e-5,
            6..=12 => 1e-8,
            _ => 1e-6,
        };
        assert!(errors.l2 < limit && errors.gradient_linf < 100.0 * limit, "order {order}: {errors:?}");
    }
}
