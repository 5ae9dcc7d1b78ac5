//! Layers, gaps and inclusions that the nodes do not resolve: solved all the same, or an error that says where and which
//! spacing resolves them.

use meshless::interfaces::MethodError;
use meshless::scene::{MethodName, Scene};
use meshless::{Error, Solution};
use meshless_tests::solve::solve_scene;

/// Regions of diffusivity 1 round `layer` of diffusivity `eta`, `u = -r^2` outside, `f = 2 D`.
fn scene(dimension: usize, spacing: f64, regions: &str) -> String {
    let corner = |x: &str| vec![x; dimension].join(", ");
    let square = ["x^2", "y^2", "z^2"][..dimension].join(" + ");
    format!(
        "title = \"Layer\"\ndimension = {dimension}\n[domain]\nbox = {{ min = [{}], max = [{}] }}\n\
         [points]\nspacing = {spacing:?}\nlayout = \"irregular\"\nseed = 1\n{regions}\
         [[regions]]\nname = \"outside\"\ndiffusivity = \"1\"\nsource = \"{}\"\nexact = \"-({square})\"\n\
         [[boundaries]]\nface = \"all\"\ndirichlet = \"-({square})\"\n",
        corner("-1.0"),
        corner("1.0"),
        2 * dimension,
    )
}

/// A shell of diffusivity `eta` between radius 0.5 and `0.5 + thickness`, and what it holds, of diffusivity 1.
fn shell(dimension: usize, thickness: f64, eta: f64) -> String {
    let center = vec!["0.0"; dimension].join(", ");
    let square = ["x^2", "y^2", "z^2"][..dimension].join(" + ");
    let outer = (0.5 + thickness).powi(2);
    let film = outer * (1.0 / eta - 1.0);
    let core = film + 0.25 * (1.0 - 1.0 / eta);
    let region = |name: &str, radius: f64, eta: f64, c: f64| {
        format!(
            "[[regions]]\nname = \"{name}\"\nsphere = {{ center = [{center}], radius = {radius:?} }}\n\
             diffusivity = \"{eta:e}\"\nsource = \"{}\"\nexact = \"{c:e} - ({square})/{eta:e}\"\n",
            2 * dimension
        )
    };
    region("core", 0.5, 1.0, core) + &region("film", 0.5 + thickness, eta, film)
}

fn solve(text: &str, order: usize) -> Result<Solution, Error> {
    let mut scene = Scene::parse(text, "layer.toml").expect("a scene");
    scene.method.name = MethodName::Sharp;
    scene.method.order = Some(order);
    solve_scene(&scene)
}

/// Where an error says that a layer is, and the spacing that it asks for.
fn located(error: &Error) -> Option<(&[f64], f64)> {
    match error {
        Error::Method(
            MethodError::ThinLayer { position, spacing, .. }
            | MethodError::Unresolved { position, spacing, .. },
        ) => Some((position, *spacing)),
        _ => None,
    }
}

fn radius(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// A layer is solved, and reported as thin, or the error says where it is and which spacing resolves it.
fn solved_or_located(text: &str, order: usize, thickness: f64, limit: f64, near: impl Fn(&[f64]) -> bool) {
    match solve(text, order) {
        Ok(solution) => {
            let layer = solution.report.thin_layer.expect("it is reported");
            assert!(near(&layer.at) && layer.thickness < 1.5 * thickness, "{layer:?}");
            let error = solution.report.errors.expect("exact").l2;
            assert!(error < limit, "order {order}, thickness {thickness}: {error:e}");
        }
        Err(error) => {
            let (at, spacing) =
                located(&error).unwrap_or_else(|| panic!("order {order}, {thickness}: {error}"));
            assert!(near(at), "order {order}, thickness {thickness}: {error}");
            // A gap between discs widens: what resolves it is said of the node that has no fit.
            assert!((0.1 * thickness..0.1).contains(&spacing), "order {order}, {thickness}: {error}");
        }
    }
}

#[test]
fn films_of_any_thickness_and_contrast() {
    for order in [4, 8] {
        for thickness in [0.001, 0.02, 0.06] {
            for eta in [1e-6, 1e6] {
                let near = |x: &[f64]| (0.45..0.6).contains(&radius(x));
                let text = scene(2, 0.05, &shell(2, thickness, eta));
                // A stiff film is one conductor: what nodes in it are too few to tell is 1 / eta.
                let limit = if eta < 1.0 { 1e-2 } else { 1e-3 };
                solved_or_located(&text, order, thickness, limit, near);
            }
        }
    }
}

#[test]
fn films_within_one_region_are_not_seen_through() {
    // A ring of the background inside and outside: across, neighbours are of one region.
    for thickness in [0.004, 0.02, 0.04] {
        let ring = format!(
            "[[regions]]\nname = \"ring\"\nlevel_set = \"abs(sqrt(x^2 + y^2) - 0.5) - {:e}\"\ndiffusivity = \"1e-6\"\n",
            0.5 * thickness
        );
        let text = scene(2, 0.05, &ring).replace("exact = ", "#");
        let error = solve(&text, 4).expect_err("the ring is not resolved");
        let (at, spacing) = located(&error).unwrap_or_else(|| panic!("{thickness}: {error}"));
        assert!((radius(at) - 0.5).abs() < 0.03 && spacing < thickness, "{thickness}: {error}");
        assert!(error.to_string().contains("region \"ring\" is "), "{error}");
    }
}

#[test]
fn a_slit_like_gap_in_an_inclusion() {
    for width in [0.002, 0.02] {
        let text = scene(
            2,
            0.05,
            &format!(
                "[[regions]]\nname = \"block\"\nlevel_set = \"max(max(abs(x) - 0.4, abs(y) - 0.4), {width:?} - 2*abs(x - 0.013))\"\n\
                 diffusivity = \"1e4\"\n"
            ),
        );
        let error = solve(&text.replace("exact = ", "#"), 4).expect_err("the gap is not resolved");
        let (at, _) = located(&error).unwrap_or_else(|| panic!("{width}: {error}"));
        assert!((at[0] - 0.013).abs() < 0.05 && at[1].abs() < 0.45, "{width}: {error}");
    }
}

#[test]
fn gaps_between_two_discs() {
    for gap in [0.0005, 0.01, 0.03] {
        for order in [4, 6, 8] {
            let text = meshless_tests::sharp::pair(1e2, 2.0 * gap, 1)
                .replace(&format!("spacing = {:?}", 2.0 * gap), "spacing = 0.05");
            let near = |x: &[f64]| x[0].abs() < 0.1 && x[1].abs() < 0.3;
            solved_or_located(&text, order, gap, 1e-3, near);
        }
    }
}

#[test]
fn a_shell_in_space_thinner_than_the_spacing() {
    for thickness in [0.02, 0.12] {
        let near = |x: &[f64]| (0.3..0.8).contains(&radius(x));
        solved_or_located(&scene(3, 0.2, &shell(3, thickness, 1e3)), 4, thickness, 1e-2, near);
    }
}

/// A disc of diffusivity `eta` at a distance of `gap` from the boundary on its right, `u = -r^2` about its center in both.
fn beside_the_boundary(gap: f64, eta: f64) -> String {
    let center = 0.5 - gap;
    let square = format!("((x - {center:?})^2 + y^2)");
    let inside = 0.25 * (1.0 / eta - 1.0);
    format!(
        "title = \"Strip\"\ndimension = 2\n[domain]\nbox = {{ min = [-1.0, -1.0], max = [1.0, 1.0] }}\n\
         [points]\nspacing = 0.05\nlayout = \"irregular\"\nseed = 1\n\
         [[regions]]\nname = \"disc\"\nsphere = {{ center = [{center:?}, 0.0], radius = 0.5 }}\n\
         diffusivity = \"{eta:e}\"\nsource = \"4\"\nexact = \"{inside:e} - {square}/{eta:e}\"\n\
         [[regions]]\nname = \"outside\"\ndiffusivity = \"1\"\nsource = \"4\"\nexact = \"-{square}\"\n\
         [[boundaries]]\nface = \"right\"\nneumann = \"-2*(x - {center:?})\"\n\
         [[boundaries]]\nface = \"all\"\ndirichlet = \"-{square}\"\n"
    )
}

#[test]
fn strips_between_an_interface_and_the_boundary() {
    for (gap, order, eta) in [(0.002, 4, 1e4), (0.02, 4, 1e-4), (0.02, 6, 1e4), (0.06, 4, 1e4)] {
        let near = |x: &[f64]| x[0] > 0.9 && x[1].abs() < 0.3;
        let text = beside_the_boundary(gap, eta);
        solved_or_located(&text, order, gap + 0.002, 1e-6, near);
        let report = solve(&refined(&text), order).expect("it is solved").report;
        assert_eq!(report.thin_layer, None);
        let error = report.errors.expect("exact").l2;
        assert!(error < 1e-9, "{gap}, {eta:e}: {error:e}");
    }
}

/// With `refine_gaps_to` in `[points]`.
fn refined(text: &str) -> String {
    text.replace("layout = ", "refine_gaps_to = 1e-4\nlayout = ")
}

#[test]
fn a_gap_in_which_the_field_is_large_is_refined() {
    for (inside, order) in [(10.0, 4), (1e4, 6)] {
        let text = meshless_tests::sharp::two_discs(inside, 0.01, 0.05, 1);
        let coarse = solve(&text, order).expect("it is solved").report;
        assert!(coarse.thin_layer.as_ref().is_some_and(|l| l.at[0].abs() < 0.01 && l.thickness < 0.02));
        let fine = solve(&refined(&text), order).expect("it is solved").report;
        assert_eq!(fine.thin_layer, None);
        let [coarse, fine] = [coarse, fine].map(|r| r.errors.expect("exact"));
        assert!(fine.l2 < 1e-3 && fine.gradient_linf < 1e-2, "{inside}: {fine:?}");
        assert!(fine.l2 < 0.1 * coarse.l2, "{inside}: {} refined {}", coarse.l2, fine.l2);
    }
}

#[test]
fn films_are_refined() {
    for (dimension, spacing, thickness) in [(2, 0.05, 0.01), (3, 0.25, 0.35)] {
        for eta in [1e-4, 1e4] {
            let text = scene(dimension, spacing, &shell(dimension, thickness, eta));
            let report = solve(&refined(&text), 4).expect("it is solved").report;
            assert_eq!(report.thin_layer, None);
            let error = report.errors.expect("exact").l2;
            assert!(error < 1e-9, "{dimension}-D, {eta:e}: {error:e}");
        }
    }
}

#[test]
fn rings_that_nodes_see_through_are_refined() {
    let ring = "[[regions]]\nname = \"ring\"\nlevel_set = \"abs(sqrt(x^2 + y^2) - 0.5) - 0.005\"\ndiffusivity = \"1e-3\"\n";
    let text = scene(2, 0.05, ring).replace("exact = ", "#");
    let mut plain = Scene::parse(&text, "ring.toml").expect("a scene");
    // What the plan chose goes on without: it says so, and names region, place and spacing.
    let why = solve_scene(&plain).expect("by the hybrid").report.fallback.expect("why");
    assert!(why.contains("\"ring\"") && why.contains("5.00e-3") && why.contains("refine_gaps_to"), "{why}");
    plain = Scene::parse(&refined(&text), "ring.toml").expect("a scene");
    let solution = solve_scene(&plain).expect("it is solved");
    assert_eq!((solution.report.fallback, solution.report.method.as_str()), (None, "sharp"));
}

#[test]
fn bars_of_almost_two_spacings_are_no_reason_to_stop() {
    // Corners, and ends of bars: neighbours see each other through what they cut off.
    for thickness in [0.09, 0.098] {
        for angle in [0.0, 0.3, 0.7] {
            let (c, s) = (f64::cos(angle), f64::sin(angle));
            let bar = format!(
                "[[regions]]\nname = \"bar\"\nlevel_set = \"max(abs({c:?}*x + {s:?}*y) - 0.4, abs({c:?}*y - {s:?}*x) - {:?})\"\n\
                 diffusivity = \"10\"\n",
                0.5 * thickness
            );
            let text = scene(2, 0.05, &bar).replace("exact = ", "#");
            if let Err(error) = solve(&text, 4) {
                panic!("{thickness}, {angle}: {error}");
            }
        }
    }
}

/// No third node may lie between two neighbours of a region: in the gap of half a spacing one always does, and a node there would be
/// left with a polynomial of its own.
#[test]
fn nodes_in_a_gap_belong_to_the_region_round_it() {
    let text = meshless_tests::sharp::pair(1e2, 0.025, 3);
    let errors = solve(&text, 6).expect("a solution").report.errors.expect("exact");
    assert!(errors.gradient_linf < 1e-8, "{:e}", errors.gradient_linf);
}
