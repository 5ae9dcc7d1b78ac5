//! What people write in their first scenes, and what must not go wrong in silence.

use meshless::plan::Plan;
use meshless::report::Report;
use meshless::scene::{MethodName, Scene};
use meshless::{Error, Silent, execute};

fn solve(text: &str, method: MethodName) -> Result<Report, Error> {
    let mut scene = Scene::parse(text, "first.toml")?;
    scene.method.name = method;
    Ok(execute(&scene, &Plan::new(&scene)?, &mut Silent)?.report)
}

/// Two layers of diffusivities 10 and 1 in a strip of length 4, through which a flux of 1 flows, the lower one by its shape.
fn layers(lower: &str) -> String {
    format!(
        "title = \"Layers\"\ndimension = 2\n[domain]\nbox = {{ min = [0.0, 0.0], max = [4.0, 1.0] }}\n\
         [points]\nspacing = 0.1\n\
         [[regions]]\nname = \"lower\"\n{lower}\ndiffusivity = 10\nexact = \"x + y/10\"\n\
         [[regions]]\nname = \"upper\"\ndiffusivity = 1\nexact = \"x + y - 0.37*0.9\"\n\
         [[boundaries]]\nface = \"bottom\"\nflux = -1\n[[boundaries]]\nface = \"top\"\nflux = 1\n\
         [[boundaries]]\nface = \"all\"\ndirichlet = \"if(y < 0.37, x + y/10, x + y - 0.37*0.9)\"\n"
    )
}

/// A shape that ends where the domain does has no interface along the boundary, and none beyond it.
#[test]
fn shapes_may_end_at_the_boundary_or_beyond_it() {
    let shapes = [
        "box = { min = [0.0, 0.0], max = [4.0, 0.37] }",
        "polygon = [[0.0, 0.0], [4.0, 0.0], [4.0, 0.37], [0.0, 0.37]]",
        "box = { min = [-0.03, -0.03], max = [4.03, 0.37] }",
        "half_space = { point = [0.0, 0.37], normal = [0.0, 1.0] }",
    ];
    for method in [MethodName::Auto, MethodName::ParticleDifference, MethodName::ImmersedInterface] {
        for shape in shapes {
            let report = solve(&layers(shape), method).expect("it is solved");
            let error = report.errors.as_ref().expect("exact").l2;
            assert!(error < 1e-9, "{method:?}, {shape}: {error:e}");
            assert!(
                report.thin_layer.is_none() && report.fallback.is_none(),
                "{method:?}, {shape}: {report:?}"
            );
        }
    }
}

#[test]
fn stacked_cylinders_may_fill_a_cylinder() {
    let text = "title = \"Stack\"\ndimension = 3\n\
                [domain]\ncylinder = { point = [0, 0, 0.5], axis = [0, 0, 1], radius = 1, length = 1 }\n\
                [points]\nspacing = 0.15\n\
                [[regions]]\nname = \"lower\"\n\
                cylinder = { point = [0, 0, 0.25], axis = [0, 0, 1], radius = 1, length = 0.5 }\n\
                diffusivity = 10\nexact = \"z*2/11\"\n\
                [[regions]]\nname = \"upper\"\ndiffusivity = 1\nexact = \"1 - 20/11*(1 - z)\"\n\
                [[boundaries]]\nface = \"outer\"\nwhere = \"z < 1e-9\"\ndirichlet = 0\n\
                [[boundaries]]\nface = \"outer\"\nwhere = \"z > 1 - 1e-9\"\ndirichlet = 1\n\
                [[boundaries]]\nface = \"outer\"\nneumann = 0\n";
    let error = solve(text, MethodName::Auto).expect("it is solved").errors.expect("exact").l2;
    assert!(error < 1e-9, "{error:e}");
}

/// Round a hole that the shape of a region ends at.
#[test]
fn a_ring_round_a_hole_has_one_interface() {
    let text = |ring: &str| {
        format!(
            "title = \"Cable\"\ndimension = 2\n[domain]\nsphere = {{ center = [0, 0], radius = 1 }}\n\
             [points]\nspacing = 0.08\n[[holes]]\nname = \"core\"\nsphere = {{ center = [0, 0], radius = 0.2 }}\n\
             [[regions]]\nname = \"inner\"\n{ring}\ndiffusivity = 4\n\
             [[regions]]\nname = \"outside\"\ndiffusivity = 1\n\
             [[boundaries]]\nface = \"core\"\ndirichlet = 1\n[[boundaries]]\nface = \"all\"\ndirichlet = 0\n\
             [[probes]]\nat = [0.35, 0.1]\n"
        )
    };
    let disc = "sphere = { center = [0, 0], radius = 0.5 }";
    let ring = format!("difference = [{{ {disc} }}, {{ sphere = {{ center = [0, 0], radius = 0.2 }} }}]");
    let [a, b] = [disc, &ring].map(|shape| solve(&text(shape), MethodName::Auto).expect("it is solved"));
    assert!(b.thin_layer.is_none(), "{:?}", b.thin_layer);
    assert_eq!(a.probes[0].value, b.probes[0].value);
}

/// Two stiff discs, each a region of its own, with a gap of a fortieth of the spacing between them.
#[test]
fn a_gap_between_two_regions_is_seen_or_said() {
    let text = "title = \"Gap\"\ndimension = 2\n[domain]\nbox = { min = [-1, -1], max = [1, 1] }\n\
                [points]\nspacing = 0.08\n\
                [[regions]]\nname = \"left\"\nsphere = { center = [-0.4, 0], radius = 0.399 }\ndiffusivity = 1e6\n\
                [[regions]]\nname = \"right\"\nsphere = { center = [0.4, 0], radius = 0.399 }\ndiffusivity = 1e6\n\
                [[regions]]\nname = \"gap\"\ndiffusivity = 1\n\
                [[boundaries]]\nface = \"left\"\ndirichlet = 0\n[[boundaries]]\nface = \"right\"\ndirichlet = 1\n\
                [[boundaries]]\nface = \"all\"\nneumann = 0\n";
    for method in [MethodName::GfdmHybrid, MethodName::GfdmConservative] {
        let report = solve(text, method).expect("it is solved");
        let layer = report.thin_layer.expect("a layer");
        assert!(layer.region == "gap" && !layer.seen && layer.thickness < 0.08, "{layer:?}");
        assert_eq!(report.estimate.l2, None);
    }
}

#[test]
fn a_diffusivity_that_jumps_within_a_region_is_refused() {
    let text = "title = \"Jump\"\ndimension = 2\n[domain]\nbox = { min = [0, 0], max = [1, 1] }\n\
                [points]\nspacing = 0.1\n[[regions]]\nname = \"plate\"\ndiffusivity = \"if(x < 0.52, 1, 30)\"\n\
                [[boundaries]]\nface = \"left\"\ndirichlet = 0\n[[boundaries]]\nface = \"right\"\ndirichlet = 1\n\
                [[boundaries]]\nface = \"all\"\nneumann = 0\n";
    for method in [MethodName::Auto, MethodName::Sharp, MethodName::ParticleDifference] {
        let error = solve(text, method).expect_err("no interface").to_string();
        assert!(error.contains("first.toml:9:15: regions[0].diffusivity"), "{error}");
        assert!(error.contains("jumps from 1.000e0 to 3.000e1 near [0.5"), "{error}");
    }
    // Balances take it as it is, and what is steep and not a jump is no business of this.
    assert!(solve(text, MethodName::GfdmConservative).is_ok());
    for smooth in ["1e4^x", "1 + 1e3*x", "if(x < 0.5, 1, 1 + 40*(x - 0.5))", "2 + tanh(100*(x - 0.52))"] {
        let text = text.replace("if(x < 0.52, 1, 30)", smooth);
        assert!(solve(&text, MethodName::Auto).is_ok(), "{smooth}");
    }
}

/// Data on y = 0 are those of y = 0, not of y = -0, where the angle has the other sign.
#[test]
fn a_zero_has_no_sign() {
    let text = "title = \"Angle\"\ndimension = 2\n[domain]\nbox = { min = [-1, 0], max = [1, 1] }\n\
                [points]\nspacing = 0.1\n[[holes]]\nname = \"axle\"\nsphere = { center = [0, 0], radius = 0.3 }\n\
                [[regions]]\nname = \"plate\"\ndiffusivity = 1\n\
                [[boundaries]]\nface = \"all\"\ndirichlet = \"atan2(y, x)\"\n[[probes]]\nat = [-0.8, 0.1]\n";
    let report = solve(text, MethodName::Auto).expect("it is solved");
    assert!(report.extrema.min == 0.0 && report.extrema.min.is_sign_positive(), "{:?}", report.extrema);
    assert!(
        (report.probes[0].value.expect("inside") - f64::atan2(0.1, -0.8)).abs() < 1e-2,
        "{:?}",
        report.probes
    );
}

#[test]
fn level_sets_that_are_no_numbers_are_refused_where_they_are() {
    let text = "title = \"Root\"\ndimension = 2\n[domain]\nDOMAIN\n[points]\nspacing = 0.1\n\
                HOLE[[regions]]\nname = \"disc\"\nREGION\ndiffusivity = 2\n\
                [[regions]]\nname = \"plate\"\ndiffusivity = 1\n[[boundaries]]\nface = \"all\"\ndirichlet = \"x\"\n";
    let square = "box = { min = [-1, -1], max = [1, 1] }";
    let disc = "sphere = { center = [0, 0], radius = 0.4 }";
    let root = "level_set = \"sqrt(x) - 0.5\"";
    let hole = format!("[[holes]]\nname = \"hole\"\n{root}\n");
    let bounded =
        "level_set = \"max(x^2 + y^2 - 0.8, log(y) - 9)\"\nbounds = { min = [-1, -1], max = [1, 1] }";
    for (domain, hole, region, key) in [
        (square, "", root, "regions[0].level_set"),
        (square, hole.as_str(), disc, "holes[0].level_set"),
        (bounded, "", disc, "domain.level_set"),
    ] {
        let text = text.replace("DOMAIN", domain).replace("HOLE", hole).replace("REGION", region);
        let error = solve(&text, MethodName::Auto).expect_err("no number").to_string();
        assert!(error.contains(key) && error.contains("gives NaN at ["), "{error}");
    }
    // Where the domain is not, it may be what it likes.
    let half = "box = { min = [0, -1], max = [1, 1] }";
    let text = text.replace("DOMAIN", half).replace("HOLE", "").replace("REGION", root);
    assert!(solve(&text, MethodName::Auto).is_ok());
}

/// Where nothing fixes the constant of u, probes have that of the nodes: current through a disc of three layers.
#[test]
fn probes_have_the_constant_of_the_nodes() {
    let text = "title = \"Head\"\ndimension = 2\n[domain]\nsphere = { center = [0, 0], radius = 0.09 }\n\
                [points]\nspacing = 0.003\n\
                [[regions]]\nname = \"brain\"\nsphere = { center = [0, 0], radius = 0.08 }\ndiffusivity = 0.33\n\
                [[regions]]\nname = \"skull\"\nsphere = { center = [0, 0], radius = 0.085 }\ndiffusivity = 0.0042\n\
                [[regions]]\nname = \"scalp\"\ndiffusivity = 0.33\n\
                [[boundaries]]\nface = \"outer\"\nflux = \"x/0.09\"\n\
                [[probes]]\nat = [0.05, 0]\n[[probes]]\nat = [-0.05, 0]\n[[probes]]\nat = [0.0, 0.0]\n";
    for method in [MethodName::Sharp, MethodName::GfdmHybrid] {
        let report = solve(text, method).expect("it is solved");
        let [a, b, c] = [0, 1, 2].map(|i| report.probes[i].value.expect("inside") / report.extrema.max);
        assert!((a + b).abs() < 0.05 && c.abs() < 0.05 && a > 0.08, "{method:?}: {a:.3} {b:.3} {c:.3}");
    }
}

/// What a condition, a hole or a `where` says must reach a node.
#[test]
fn conditions_that_no_node_gets_are_refused() {
    let text = |boundaries: &str| {
        format!(
            "title = \"Electrodes\"\ndimension = 2\n[domain]\nbox = {{ min = [0, 0], max = [1, 1] }}\n\
             [points]\nspacing = 0.1\n[[regions]]\nname = \"water\"\ndiffusivity = 1\n\
             [[boundaries]]\nface = \"bottom\"\ndirichlet = 1\n{boundaries}\n\
             [[boundaries]]\nface = \"all\"\nneumann = 0\n"
        )
    };
    let electrode =
        |place: &str| format!("[[boundaries]]\nface = \"top\"\nwhere = \"{place}\"\ndirichlet = 0\n");
    let hole = "[[holes]]\nname = \"pipe\"\nsphere = { center = [3, 3], radius = 0.2 }\n";
    let covered =
        "[[boundaries]]\nface = \"all\"\ndirichlet = 2\n[[boundaries]]\nface = \"top\"\ndirichlet = 0\n";
    for (boundaries, place, message) in [
        (electrode("abs(x - 0.55) < 0.004"), "first.toml:13:", "no boundary node gets this condition"),
        (electrode("x > 7"), "boundaries[1]", "no boundary node gets this condition"),
        (covered.to_owned(), "boundaries[2]", "no boundary node gets this condition"),
        (hole.to_owned(), "holes[0]", "no node lies on the surface of the hole \"pipe\""),
        (electrode("log(x - 0.5) < 0"), "boundaries[1].where", "gives NaN at ["),
    ] {
        let error = solve(&text(&boundaries), MethodName::Auto).expect_err("it is not there").to_string();
        assert!(error.contains(place) && error.contains(message), "{error}");
    }
    for fine in [electrode("abs(x - 0.55) < 0.1"), String::new()] {
        let outcome = solve(&text(&fine), MethodName::Auto);
        assert!(outcome.is_ok(), "{:?}", outcome.err());
    }
}

#[test]
fn sizes_beyond_arithmetic_are_refused_and_values_beyond_it_have_no_estimate() {
    let text = |spacing: f64, u: f64| {
        format!(
            "title = \"Sizes\"\ndimension = 2\n[domain]\nbox = {{ min = [0, 0], max = [{0:e}, {0:e}] }}\n\
             [points]\nspacing = {spacing:e}\n[[regions]]\nname = \"a\"\ndiffusivity = 1\n\
             [[boundaries]]\nface = \"all\"\ndirichlet = {u:e}\n",
            10.0 * spacing
        )
    };
    for spacing in [1e-201, 1e149] {
        let error = solve(&text(spacing, 1.0), MethodName::Auto).expect_err("no such lengths").to_string();
        assert!(error.contains("points.spacing") && error.contains("another unit"), "{error}");
    }
    let report = solve(&text(1e-9, 1e300), MethodName::Auto).expect("it is solved");
    assert_eq!(report.estimate.l2, None);
    let words =
        solve(&text(1e-9, 1.0).replace("1e-9\n", "\"1e-9 mm\"\n"), MethodName::Auto).expect_err("a unit");
    assert!(words.to_string().contains("numbers have no units"), "{words}");
}

/// Stiff discs that touch each other, or a wall where u is prescribed: the estimate was up to twenty times too small.
#[test]
fn stiff_regions_that_touch_are_said_and_have_no_estimate() {
    let text = |shape: &str, eta: f64, left: &str| {
        format!(
            "title = \"Touching\"\ndimension = 2\n[domain]\nbox = {{ min = [-1, -1], max = [1, 1] }}\n\
             [points]\nspacing = 0.08\n[[regions]]\nname = \"discs\"\n{shape}\ndiffusivity = {eta}\n\
             [[regions]]\nname = \"gap\"\ndiffusivity = 1\n[[boundaries]]\nface = \"left\"\n{left} = 0\n\
             [[boundaries]]\nface = \"right\"\ndirichlet = 1\n[[boundaries]]\nface = \"all\"\nneumann = 0\n"
        )
    };
    let pair = "union = [{ sphere = { center = [-0.4, 0], radius = 0.4 } }, { sphere = { center = [0.4, 0], radius = 0.4 } }]";
    let wall = "sphere = { center = [-0.6, 0], radius = 0.4 }";
    for (shape, other) in [(pair, "discs"), (wall, "boundary")] {
        for method in [MethodName::Auto, MethodName::GfdmHybrid] {
            let report = solve(&text(shape, 1e6, "dirichlet"), method).expect("it is solved");
            assert_eq!(report.contacts.len(), 1, "{:?}", report.contacts);
            assert!(report.contacts[0].between.contains(&other.to_owned()), "{:?}", report.contacts);
            assert!(report.estimate.l2.is_none() && report.estimate.why_not.is_some());
        }
        let error =
            solve(&(text(shape, 1e6, "dirichlet") + "[accuracy]\ntolerance = 1e-2\n"), MethodName::Auto);
        let error = error.expect_err("no estimate").to_string();
        assert!(error.contains("accuracy.tolerance") && error.contains("leave a gap"), "{error}");
    }
    // Nothing flows through the tip: insulators, a wall that insulates, and what is not much stiffer.
    for (shape, eta, left) in [(pair, 1e-6, "dirichlet"), (wall, 1e6, "neumann"), (pair, 3.0, "dirichlet")] {
        let report = solve(&text(shape, eta, left), MethodName::Auto).expect("it is solved");
        assert!(report.contacts.is_empty() && report.estimate.l2.is_some(), "{:?}", report.contacts);
    }
}

/// On a face of several pieces a `where` that holds on one of them says nothing of the others, at the edge between them either.
#[test]
fn the_order_of_conditions_on_a_cylinder_does_not_matter_at_its_rim() {
    let caps = "[[boundaries]]\nface = \"outer\"\nwhere = \"z < 1e-9\"\nneumann = 0\n\
                [[boundaries]]\nface = \"outer\"\nwhere = \"z > 1 - 1e-9\"\nneumann = 0\n\
                [[boundaries]]\nface = \"outer\"\ndirichlet = 0\n";
    let mantle = "[[boundaries]]\nface = \"outer\"\nwhere = \"x^2 + y^2 > 1 - 1e-9\"\ndirichlet = 0\n\
                  [[boundaries]]\nface = \"outer\"\nneumann = 0\n";
    let errors = [caps, mantle].map(|boundaries| {
        let text = format!(
            "title = \"Rod\"\ndimension = 3\n\
             [domain]\ncylinder = {{ point = [0, 0, 0.5], axis = [0, 0, 1], radius = 1, length = 1 }}\n\
             [points]\nspacing = 0.15\n[[regions]]\nname = \"core\"\n\
             cylinder = {{ point = [0, 0, 0.5], axis = [0, 0, 1], radius = 0.5 }}\ndiffusivity = 10\nsource = 4\n\
             exact = \"(0.25 - x^2 - y^2)/10 + 0.5*log(2)\"\n\
             [[regions]]\nname = \"clad\"\ndiffusivity = 1\nexact = \"-0.25*log(x^2 + y^2)\"\n{boundaries}"
        );
        solve(&text, MethodName::Auto).expect("it is solved").errors.expect("exact").l2
    });
    assert!(errors[0] < 2e-2 && (errors[0] / errors[1] - 1.0).abs() < 1e-6, "{errors:?}");
}

/// A ball of charge that samples do not add up to is not one that its spectrum says all about.
#[test]
fn what_samples_of_a_source_miss_is_part_of_the_estimate() {
    let text = "title = \"Ball of charge\"\ndimension = 3\n\
                [domain]\nfree_space = { min = [-1, -1, -1], max = [1, 1, 1] }\n\
                [[regions]]\nname = \"space\"\ndiffusivity = 1\nsource = \"if(x^2 + y^2 + z^2 < 0.25, 1, 0)\"\n\
                [accuracy]\ntolerance = 1e-2\n[[probes]]\nat = [0.0, 0.0, 0.0]\n";
    let report = solve(text, MethodName::Auto).expect("it is solved");
    let error = (report.probes[0].value.expect("inside") / 0.125 - 1.0).abs();
    assert!(error < 1e-2, "{error:.1e}, {:?}", report.estimate);
}
