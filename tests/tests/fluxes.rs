//! Totals of the flux against closed forms.

use std::f64::consts::PI;

use meshless::plan::{Plan, Stage};
use meshless::report::FluxReport;
use meshless::scene::{MethodName, Scene};
use meshless::{Error, Silent, execute};

fn fluxes(text: &str, method: MethodName) -> Result<FluxReport, Error> {
    let mut scene = Scene::parse(&(text.to_owned() + "[output]\nfluxes = true\n"), "fluxes.toml")?;
    scene.method.name = method;
    let mut plan = Plan::new(&scene)?;
    plan.stages.retain(|stage| *stage != Stage::Estimate);
    Ok(execute(&scene, &plan, &mut Silent)?.report.fluxes.unwrap_or_default())
}

/// Both boundaries and the interface carry the same flux, within a share of it.
fn carries(text: &str, exact: f64, bounds: &[(MethodName, f64)]) {
    for &(method, bound) in bounds {
        let found = fluxes(text, method).expect("it is solved");
        let [into, out] = [0, 1].map(|k| found.boundaries[k].flux / exact - [1.0, -1.0][k]);
        let between = found.interfaces[0].flux.abs() / exact - 1.0;
        for error in [into, out, between] {
            assert!(error.abs() < bound, "{method:?}: {error:.2e}, {found:?}");
        }
        assert!(found.left_over < 2.0 * bound, "{method:?}: {found:?}");
    }
}

const ENDS: &str =
    "[[boundaries]]\nface = \"left\"\ndirichlet = 1\n[[boundaries]]\nface = \"right\"\ndirichlet = 0\n";

/// Two layers one behind the other.
#[test]
fn a_composite_slab_in_every_dimension() {
    for (dimension, spacing) in [(1, 0.1), (2, 0.1), (3, 0.2)] {
        let corner = |first: f64, others: f64| {
            let all: Vec<f64> = (0..dimension).map(|k| if k == 0 { first } else { others }).collect();
            format!("{all:?}")
        };
        let sides = if dimension == 1 { "" } else { "[[boundaries]]\nface = \"all\"\nneumann = 0\n" };
        let text = format!(
            "title = \"Slab\"\ndimension = {dimension}\n[domain]\nbox = {{ min = {}, max = {} }}\n\
             [points]\nspacing = {spacing}\n\
             [[regions]]\nname = \"a\"\nbox = {{ min = {}, max = {} }}\ndiffusivity = 4\n\
             [[regions]]\nname = \"b\"\ndiffusivity = 0.5\n{ENDS}{sides}",
            corner(0.0, 0.0),
            corner(2.0, 1.0),
            corner(0.0, 0.0),
            corner(0.83, 1.0),
        );
        let exact = 1.0 / (0.83 / 4.0 + 1.17 / 0.5);
        carries(&text, exact, &[(MethodName::Sharp, 1e-9)]);
    }
}

/// Two layers side by side: the flux jumps along the faces.
#[test]
fn layers_side_by_side() {
    let text = format!(
        "title = \"Strips\"\ndimension = 2\n[domain]\nbox = {{ min = [0, 0], max = [2, 1] }}\n[points]\nspacing = 0.1\n\
         [[regions]]\nname = \"a\"\nbox = {{ min = [0, 0], max = [2, 0.37] }}\ndiffusivity = 10\n\
         [[regions]]\nname = \"b\"\ndiffusivity = 1\n{ENDS}[[boundaries]]\nface = \"all\"\nneumann = 0\n"
    );
    let found = fluxes(&text, MethodName::Auto).expect("it is solved");
    let exact = (3.7 + 0.63) / 2.0;
    assert!((found.boundaries[0].flux / exact - 1.0).abs() < 1e-6, "{found:?}");
    assert!((found.boundaries[0].area - 1.0).abs() < 1e-12 && (found.boundaries[2].area - 4.0).abs() < 1e-12);
    assert!(found.boundaries[2].flux == 0.0 && found.interfaces[0].flux.abs() < 1e-9, "{found:?}");
}

#[test]
fn a_coaxial_cable_and_a_shell() {
    let text = |dimension: usize, center: &str, spacing: f64, inner: &str| {
        format!(
            "title = \"Shell\"\ndimension = {dimension}\n[domain]\nsphere = {{ center = {center}, radius = 1 }}\n\
             [points]\nspacing = {spacing}\n[[holes]]\nname = \"core\"\nsphere = {{ center = {center}, radius = 0.4 }}\n\
             [[regions]]\nname = \"inner\"\n{inner}\ndiffusivity = 5\n[[regions]]\nname = \"outside\"\ndiffusivity = 0.5\n\
             [[boundaries]]\nface = \"core\"\ndirichlet = 1\n[[boundaries]]\nface = \"outer\"\ndirichlet = 0\n"
        )
    };
    let exact = 2.0 * PI / ((0.7_f64 / 0.4).ln() / 5.0 - 0.7_f64.ln() / 0.5);
    for inner in ["sphere = { center = [0, 0], radius = 0.7 }", "level_set = \"x^2 + y^2 - 0.49\""] {
        carries(&text(2, "[0, 0]", 0.06, inner), exact, &[(MethodName::Sharp, 3e-3)]);
    }
    let exact = 4.0 * PI / ((1.0 / 0.4 - 1.0 / 0.7) / 5.0 + (1.0 / 0.7 - 1.0) / 0.5);
    let inner = "sphere = { center = [0, 0, 0], radius = 0.7 }";
    carries(&text(3, "[0, 0, 0]", 0.15, inner), exact, &[(MethodName::Sharp, 3e-2)]);
}

/// A square array of discs: with diffusivities exchanged the effective ones are inverse to each other (Keller 1964).
#[test]
fn effective_diffusivities_of_an_array_and_its_inverse() {
    let effective = |eta: f64| {
        let text = format!(
            "title = \"Cell\"\ndimension = 2\n[domain]\nbox = {{ min = [0, 0], max = [1, 1] }}\n[points]\nspacing = 0.04\n\
             [[regions]]\nname = \"fibre\"\nsphere = {{ center = [0.5, 0.5], radius = 0.35 }}\ndiffusivity = {eta}\n\
             [[regions]]\nname = \"matrix\"\ndiffusivity = 1\n{ENDS}[[boundaries]]\nface = \"all\"\nneumann = 0\n"
        );
        fluxes(&text, MethodName::Auto).expect("it is solved").boundaries[0].flux
    };
    let product = effective(20.0) * effective(0.05);
    assert!((product - 1.0).abs() < 2e-3, "{product}");
}

/// Fits to nodal values of first order would be off by up to 40 % at an interface.
#[test]
fn methods_without_gradients_up_to_interfaces_are_refused() {
    let text = |other: f64| {
        format!(
            "title = \"Slab\"\ndimension = 1\n[domain]\nbox = {{ min = [0], max = [1] }}\n[points]\nspacing = 0.1\n\
             [[regions]]\nname = \"a\"\nbox = {{ min = [0], max = [0.5] }}\ndiffusivity = 2\n\
             [[regions]]\nname = \"b\"\ndiffusivity = {other}\n{ENDS}"
        )
    };
    // The plan takes none of them where fluxes are asked for, whatever else would do.
    for rest in ["[accuracy]\ntolerance = 0.03\n", "[time]\nend = 10\n"] {
        let scene =
            Scene::parse(&(text(1.0) + rest + "[output]\nfluxes = true\n"), "fluxes.toml").expect("a scene");
        assert_eq!(Plan::new(&scene).expect("a plan").method.name, MethodName::Sharp, "{rest}");
    }
    let found =
        fluxes(&(text(1.0) + "[time]\nend = 10\n"), MethodName::Auto).expect("the plan takes another one");
    assert!((found.boundaries[0].flux - 4.0 / 3.0).abs() < 1e-3, "{found:?}");
    let error = fluxes(&text(1.0), MethodName::GfdmHybrid).expect_err("no gradients").to_string();
    assert!(error.contains("output.fluxes") && error.contains("\"sharp\""), "{error}");
    let found = fluxes(&text(2.0), MethodName::GfdmClassical).expect("nothing jumps");
    assert!(
        (found.boundaries[0].flux - 2.0).abs() < 1e-9 && (found.interfaces[0].flux + 2.0).abs() < 1e-9,
        "{found:?}"
    );
}

/// Where a condition says what the flux is, that is it; where there are sources, nothing need balance.
#[test]
fn prescribed_fluxes_are_counted_as_they_are() {
    let text = "title = \"Plate\"\ndimension = 2\n[domain]\nbox = { min = [0, 0], max = [1, 2] }\n[points]\nspacing = 0.1\n\
                [[regions]]\nname = \"plate\"\ndiffusivity = 3\nsource = 4\n\
                [[boundaries]]\nface = \"left\"\nwhere = \"y < 1\"\nflux = \"2*y\"\n\
                [[boundaries]]\nface = \"right\"\nrobin = { a = 6, b = 1, g = 0 }\n\
                [[boundaries]]\nface = \"all\"\nneumann = 0\n";
    let found = fluxes(text, MethodName::Auto).expect("it is solved");
    assert!((found.boundaries[0].flux - 1.0).abs() < 1e-9 && found.left_over < 0.02, "{found:?}");
    // What enters on the left and arises inside leaves on the right, as far as stencils of second order know.
    assert!((found.boundaries[1].flux + 9.0).abs() < 0.2, "{found:?}");
    let open = "title = \"Open\"\ndimension = 2\n[domain]\nfree_space = { min = [-1, -1], max = [1, 1] }\n\
                [points]\nspacing = 0.1\n[[regions]]\nname = \"space\"\ndiffusivity = 1\nsource = \"exp(-50*(x^2 + y^2))\"\n";
    let error = fluxes(open, MethodName::Auto).expect_err("there is no boundary").to_string();
    assert!(error.contains("remove `output.fluxes`"), "{error}");
}
