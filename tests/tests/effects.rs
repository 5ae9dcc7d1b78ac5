//! Effects beside diffusion: orders of chosen solutions, closed forms, balances, bounds, and what bad input is told.

use meshless::cost::{CostParams, cost};
use meshless::plan::{Effect, Plan};
use meshless::report::Report;
use meshless::scene::{MethodName, Scene};
use meshless::{Error, Silent, execute};
use meshless_tests::effects::{
    ARRAY_WITH_CONTACT, Effects, NAFEMS_T3, array_with_contact, chip_behind_a_film, chosen, disc_with_film,
    nafems_t3, stream, two_layers,
};
use meshless_tests::order::observed;

fn solved(text: &str, method: MethodName, order: Option<usize>) -> Result<meshless::Solution, Error> {
    let mut scene = Scene::parse(text, "effects.toml")?;
    (scene.method.name, scene.method.order) = (method, order);
    execute(&scene, &Plan::new(&scene)?, &mut Silent)
}

fn report(text: &str, method: MethodName) -> Report {
    solved(text, method, None).expect("it can be solved").report
}

fn l2(report: &Report) -> f64 {
    report.errors.as_ref().expect("the scene has an exact solution").l2
}

/// The order of a ladder of spacings, and the last error.
fn ladder(
    effects: &Effects,
    dimension: usize,
    method: MethodName,
    order: Option<usize>,
    spacings: &[f64],
) -> (f64, f64) {
    let error = |&h: &f64| {
        let solution = solved(&chosen(dimension, effects, h, 1), method, order).expect("it can be solved");
        (h, l2(&solution.report))
    };
    let rungs: Vec<(f64, f64)> = spacings.iter().map(error).collect();
    (observed(&rungs), rungs[rungs.len() - 1].1)
}

/// Every effect by itself.
fn alone() -> [Effects; 4] {
    [
        Effects { resistance: 0.2, ..Effects::NONE },
        Effects { partition: [1.0, 2.5], ..Effects::NONE },
        Effects { velocity: true, ..Effects::NONE },
        Effects { reaction: true, ..Effects::NONE },
    ]
}

#[test]
fn fits_keep_their_order_with_every_effect() {
    for effects in alone().into_iter().chain([Effects::ALL]) {
        let (order, last) = ladder(&effects, 2, MethodName::Sharp, Some(4), &[0.1, 0.05, 0.025]);
        assert!(order > 3.5 && last < 1e-6, "{effects:?}: order {order}, {last:e}");
    }
    let (order, last) = ladder(&Effects::ALL, 2, MethodName::Sharp, Some(6), &[0.1, 0.07, 0.05]);
    assert!(order > 5.0 && last < 1e-5, "order {order}, {last:e}");
    let (order, last) = ladder(&Effects::ALL, 1, MethodName::Sharp, Some(4), &[0.1, 0.05, 0.025]);
    assert!(order > 3.0 && last < 1e-4, "order {order}, {last:e}");
    let (order, last) = ladder(&Effects::ALL, 3, MethodName::Sharp, Some(4), &[0.3, 0.2]);
    assert!(order > 2.5 && last < 2e-2, "order {order}, {last:e}");
}

#[test]
fn balances_converge_with_every_effect() {
    for effects in alone().into_iter().chain([Effects::ALL]) {
        for method in [MethodName::GfdmConservative, MethodName::GfdmHybrid] {
            let (order, last) = ladder(&effects, 2, method, None, &[0.1, 0.05, 0.025]);
            assert!(order > 0.8 && last < 3e-2, "{effects:?}, {method:?}: order {order}, {last:e}");
        }
    }
}

#[test]
fn contrasts_do_not_matter() {
    for contrast in [1e-6, 1e6] {
        // A stream through what hardly conducts is a matter of its Péclet number.
        let effects = Effects { contrast, velocity: contrast > 1.0, ..Effects::ALL };
        let solution =
            solved(&chosen(2, &effects, 0.07, 1), MethodName::Sharp, Some(6)).expect("it can be solved");
        let fits = l2(&solution.report);
        // What reacts has no constant of its own, so that fluxes of the size of the contrast cost digits.
        let bound = if contrast > 1.0 { 5e-3 } else { 1e-6 };
        assert!(fits < bound, "{contrast:e}: {fits:e}");
    }
}

#[test]
fn capacities_in_time() {
    let effects = Effects { time: true, resistance: 0.2, ..Effects::NONE };
    for dimension in [1, 2] {
        let spacings: &[f64] = if dimension == 1 { &[0.1, 0.05, 0.025] } else { &[0.2, 0.1] };
        let (order, last) = ladder(&effects, dimension, MethodName::Sharp, Some(4), spacings);
        assert!(order > 2.5 && last < 1e-3, "{dimension}-D: order {order}, {last:e}");
        let (order, last) = ladder(&effects, dimension, MethodName::GfdmConservative, None, spacings);
        // On the line the error is that of the place of one node beside the interface: it scatters.
        assert!((dimension == 1 || order > 0.8) && last < 6e-2, "{dimension}-D: order {order}, {last:e}");
    }
}

/// The exchange of stored heat is balanced to round-off over the cells, whatever the capacities.
#[test]
fn heat_is_balanced_in_time() {
    let text = "title = \"Warming\"\ndimension = 2\n[domain]\nbox = { min = [0, 0], max = [1, 1] }\n[points]\nspacing = 0.1\n\
                [[regions]]\nname = \"core\"\nbox = { min = [0.3, 0.3], max = [0.7, 0.7] }\ndiffusivity = 5\ncapacity = 20\nsource = 3\n\
                [[regions]]\nname = \"shell\"\ndiffusivity = 1\ncapacity = \"1 + x\"\nreaction = 0.5\nvelocity = [2, \"1\"]\n\
                [[interfaces]]\nbetween = [\"core\", \"shell\"]\nresistance = 0.1\n\
                [[boundaries]]\nface = \"left\"\nconvection = { h = 2, ambient = 5 }\n[[boundaries]]\nface = \"all\"\ndirichlet = 0\n\
                [time]\nend = 0.3\n";
    let found = report(text, MethodName::GfdmConservative);
    let balance = found.balance.as_ref().expect("every report has a balance");
    assert!(balance.stored.is_some_and(|stored| stored.abs() > 0.1), "{balance:?}");
    assert!(balance.reacted.is_some_and(|part| part > 0.0) && balance.carried.is_some(), "{balance:?}");
    assert!(balance.relative < 1e-10, "{balance:?}");
}

#[test]
fn a_bar_whose_end_swings() {
    let value = |method| report(&nafems_t3(0.002), method).probes[0].value.expect("the point is inside");
    let (fits, balances) = (value(MethodName::Sharp), value(MethodName::GfdmConservative));
    assert!((fits - NAFEMS_T3).abs() < 1e-4, "{fits}");
    assert!((balances - NAFEMS_T3).abs() < 0.05, "{balances}");
}

#[test]
fn films_from_none_to_perfect_insulation() {
    for resistance in [0.0, 1e-6, 0.1, 10.0, 1e6, 1e12] {
        let found = report(&disc_with_film(resistance, 0.05, 1), MethodName::Auto);
        assert_eq!(found.method, "sharp");
        assert!(l2(&found) < 2e-4, "{resistance:e}: {:e}", l2(&found));
        let conserving = report(&disc_with_film(resistance, 0.05, 1), MethodName::GfdmConservative);
        assert!(l2(&conserving) < 2e-2, "{resistance:e}: {:e}", l2(&conserving));
    }
}

/// Whatever is linear in each layer is exact: for layers of very different materials, films of any resistance, and partition.
#[test]
fn layers_with_films_are_exact() {
    for dimension in [1, 2, 3] {
        for (eta, resistance, partition) in [
            ([1.0, 1.0], 1.0, [1.0, 1.0]),
            ([1e6, 1.0], 1e-3, [1.0, 1.0]),
            ([1.0, 1e-4], 1e5, [1.0, 4.0]),
            ([2.0, 3.0], 1e12, [1.0, 1.0]),
            ([2.0, 3.0], 0.0, [3.0, 0.5]),
        ] {
            for method in [MethodName::Sharp, MethodName::GfdmConservative] {
                let text =
                    two_layers(dimension, eta, resistance, partition, if dimension == 3 { 0.2 } else { 0.1 });
                let error = l2(&report(&text, method));
                // Balances see the interface half-way between nodes.
                let bound = if method == MethodName::Sharp { 1e-8 } else { 1e-1 };
                assert!(
                    error < bound,
                    "{dimension}-D, {eta:?}, {resistance:e}, {partition:?}, {method:?}: {error:e}"
                );
            }
        }
    }
}

/// All that is made leaves, and two methods of different kinds agree within what they say.
#[test]
fn a_heated_chip_behind_a_film() {
    for resistance in [1e-3, 0.1, 10.0] {
        let text = chip_behind_a_film(resistance, 0.025, 1);
        let [balances, fits] = [MethodName::Auto, MethodName::Sharp].map(|method| report(&text, method));
        assert_eq!(balances.method, "gfdm-conservative");
        for found in [&balances, &fits] {
            let balance = found.balance.as_ref().expect("every report has a balance");
            let leaves: f64 = balance.into.iter().map(|part| part.flux).sum();
            assert!((leaves + 3.6).abs() < 3.6e-3, "{resistance:e}, {}: {balance:?}", found.method);
            assert!(found.corners.iter().any(|corner| (corner.exponent - 2.0 / 3.0).abs() < 1e-9));
        }
        for (a, b) in balances.probes.iter().zip(&fits.probes) {
            let apart = (a.value.expect("inside") - b.value.expect("inside")).abs();
            let told = a.estimate.expect("an estimate") + b.estimate.expect("an estimate");
            assert!(apart <= told, "{resistance:e}: {a:?} {b:?}");
        }
    }
}

#[test]
fn an_array_of_cylinders_with_contact() {
    for (conductance, effective) in ARRAY_WITH_CONTACT {
        let found = report(&array_with_contact(conductance, 0.05, 1), MethodName::Auto);
        let flux = |face: &str| {
            let fluxes = found.fluxes.as_ref().expect("fluxes are asked for");
            let of_face =
                fluxes.boundaries.iter().find(|flux| flux.face == face).expect("a flux for each face");
            (of_face.flux, of_face.estimate)
        };
        for face in ["left", "right"] {
            let (flux, estimate) = flux(face);
            let error = (flux.abs() - effective).abs();
            assert!(error < 1e-3 * effective, "h a = {conductance}, {face}: {flux}, {estimate:?}");
            assert!(estimate.is_some_and(|estimate| error < 10.0 * estimate), "{flux} ± {estimate:?}");
        }
    }
}

/// From a cell Péclet number of 0.1 to 1000: no oscillation and no value beyond those on the boundary.
#[test]
fn streams_do_not_oscillate() {
    for dimension in [1, 2] {
        for cell in [0.1, 1.0, 10.0, 1000.0] {
            let spacing = 0.05;
            let solution =
                solved(&stream(dimension, cell / spacing, spacing, 1), MethodName::GfdmConservative, None)
                    .expect("it can be solved");
            let bounds = &solution.report.extrema;
            assert!(bounds.min > -1e-12 && bounds.max < 1.0 + 1e-12, "{dimension}-D, {cell}: {bounds:?}");
            if cell <= 0.1 {
                assert!(l2(&solution.report) < 1e-2, "{dimension}-D, {cell}: {:e}", l2(&solution.report));
            }
        }
    }
}

#[test]
fn the_plan_takes_upwind_balances_where_a_cell_does_not_resolve_the_stream() {
    let plan = |peclet: f64| {
        let scene = Scene::parse(&stream(2, peclet, 0.05, 1), "stream.toml").expect("a good scene");
        Plan::new(&scene).expect("a good scene")
    };
    assert_eq!(plan(10.0).method.name, MethodName::GfdmClassical);
    assert_eq!(plan(1000.0).method.name, MethodName::GfdmConservative);
    let told = plan(1000.0).effects.into_iter().find(|e| matches!(e, Effect::Advection { .. }));
    assert!(told.is_some_and(|effect| effect.to_string().contains("5.000e1")), "{told:?}");
}

/// What is compared is what can be solved.
#[test]
fn methods_that_do_not_know_an_effect_are_not_compared() {
    let scene = Scene::parse(&disc_with_film(0.1, 0.2, 1), "film.toml").expect("a good scene");
    let found = cost(&scene, &CostParams::default(), &mut |_| {}).expect("it can be compared");
    let unknown = |why: &String| why.contains("does not know");
    assert!(!found.runs.is_empty() && !found.runs.iter().any(|run| run.why.as_ref().is_some_and(unknown)));
}

/// Without an effect a plan has no word of it but that it is absent.
#[test]
fn what_is_absent_is_not_planned() {
    let scene = Scene::parse(&chosen(2, &Effects::NONE, 0.1, 1), "plain.toml").expect("a good scene");
    let plan = Plan::new(&scene).expect("a good scene");
    for name in ["capacity", "advection", "reaction", "contact resistance", "partition"] {
        assert!(plan.effects.iter().all(|effect| effect.name() != name), "{name}");
    }
    for name in ["contact", "advection", "reaction"] {
        assert!(plan.skipped.iter().any(|skipped| skipped.what == name), "{name}");
    }
}

fn told(text: &str) -> String {
    match Scene::parse(text, "bad.toml") {
        Err(error) => error.to_string(),
        Ok(scene) => match Plan::new(&scene).and_then(|plan| execute(&scene, &plan, &mut Silent).map(|_| ()))
        {
            Err(error) => error.to_string(),
            Ok(()) => "solved".to_owned(),
        },
    }
}

#[test]
fn mistakes_are_told_with_line_and_remedy() {
    let plate = |region: &str, interface: &str, boundary: &str, rest: &str| {
        format!(
            "title = \"Bad\"\ndimension = 2\n[domain]\nbox = {{ min = [0, 0], max = [1, 1] }}\n[points]\nspacing = 0.1\n\
             [[regions]]\nname = \"core\"\nsphere = {{ center = [0.5, 0.5], radius = 0.3 }}\ndiffusivity = 2\n{region}\n\
             [[regions]]\nname = \"plate\"\ndiffusivity = 1\n\
             [[interfaces]]\nbetween = [\"core\", \"plate\"]\n{interface}\n\
             [[boundaries]]\nface = \"all\"\n{boundary}\n{rest}"
        )
    };
    let cold = "dirichlet = 0";
    let cases = [
        (plate("", "resistance = -1", cold, ""), "not negative"),
        (plate("", "resistance = \"x - 0.5\"", cold, ""), "must not be negative"),
        (plate("", "partition = [1, 0]", cold, ""), "positive"),
        (plate("", "partition = [1]", cold, ""), "expected 2 coefficients"),
        (plate("", "resistance = 1\ndirichlet = 3", cold, ""), "either `dirichlet` or jumps"),
        (plate("velocity = [1]", "", cold, ""), "expected 2 components"),
        (plate("velocity = 1", "", cold, ""), "array"),
        (plate("velocity = [\"1/(x-x)\", 0]", "", cold, ""), "finite"),
        (plate("capacity = 0", "", cold, "[time]\nend = 1\n"), "positive"),
        (plate("capacity = \"x - 0.5\"", "", cold, "[time]\nend = 1\n"), "the capacity is"),
        (plate("reaction = \"log(-1)\"", "", cold, ""), "finite"),
        (plate("", "", "convection = { h = -2, ambient = 1 }", ""), "not negative"),
        (plate("", "", "convection = { h = 2 }", ""), "ambient"),
        (
            plate("", "resistance = 1", cold, "[method]\nname = \"particle-difference\"\n"),
            "contact resistance",
        ),
        (
            plate("reaction = 1", "", cold, "[method]\nname = \"immersed-interface\"\n"),
            "take one of gfdm-classical",
        ),
    ];
    let free = "title = \"Open\"\ndimension = 2\n[domain]\nfree_space = { min = [-1, -1], max = [1, 1] }\n[points]\nspacing = 0.1\n\
                [[regions]]\nname = \"all\"\ndiffusivity = 1\nsource = \"exp(-40*(x^2 + y^2))\"\nreaction = 3\n";
    let free = (free.to_owned(), "\"free-space\" does not know the effect \"reaction\"");
    let loose = (plate("", "partition = [1, 2]", "neumann = 0", ""), "nothing fixes u");
    for (text, expected) in cases.into_iter().chain([free, loose]) {
        let message = told(&text);
        assert!(message.contains(expected), "{text}\n---\n{message}");
        assert!(message.contains("bad.toml:") || message.contains("interface point"), "{message}");
    }
}
