//! Diffusion in time: orders in time and space, data that change, stopped runs.

use std::time::Duration;

use meshless::plan::{Plan, Stage};
use meshless::scene::{MethodName, Scene};
use meshless::{Checkpoint, Error, Progress, Silent, Solution, execute, execute_from};
use meshless_tests::order::{observed, over_clouds};
use meshless_tests::solve::{solve_scene, solve_with};
use meshless_tests::unsteady::{Growing, ball, composite, driven, growing, slab};

fn l2(solution: &Solution) -> f64 {
    solution.report.errors.as_ref().expect("the scene has an exact solution").l2
}

fn solved(text: &str) -> Solution {
    solve_scene(&Scene::parse(text, "gallery.toml").expect("it parses")).expect("it can be solved")
}

/// Space is exact here, so all of the error is that of the steps.
/// A square with a source, in time, to its steady end: by hp-FEM u is 0.6718 in it (`tests/references/natural.csv`), and all of the heat leaves.
#[test]
fn a_heated_chip_in_time_keeps_its_heat() {
    let text = "title = \"Chip\"\ndimension = 2\n[domain]\nbox = { min = [-1, -1], max = [1, 1] }\n[points]\nspacing = 0.1\n\
        [[regions]]\nname = \"chip\"\nbox = { min = [-0.3, -0.3], max = [0.3, 0.3] }\ndiffusivity = 10\nsource = 10\n\
        [[regions]]\nname = \"plate\"\ndiffusivity = 1\n[[boundaries]]\nface = \"all\"\ndirichlet = 0\n\
        [time]\nend = 3\ninitial = \"0\"\ntolerance = 1e-3\n[[probes]]\nat = [0.05, 0.1]\n[output]\nfluxes = true\n";
    let scene = Scene::parse(text, "chip.toml").expect("a scene");
    let report =
        execute(&scene, &Plan::new(&scene).expect("a plan"), &mut Silent).expect("it is solved").report;
    let fluxes = report.fluxes.expect("asked for");
    assert!((fluxes.boundaries[0].flux / -3.6 - 1.0).abs() < 2e-3, "{fluxes:?}");
    assert!((fluxes.interfaces[0].flux / -3.6 - 1.0).abs() < 2e-3, "{fluxes:?}");
    let error = (report.probes[0].value.expect("inside") / 0.671_822 - 1.0).abs();
    assert!(error < 3e-2 && report.estimate.l2.is_some_and(|estimate| estimate > 0.3 * error), "{error}");
}

#[test]
fn the_error_falls_with_the_square_of_the_number_of_steps() {
    let run = |tolerance| {
        let solution = solved(&driven(tolerance));
        let steps = solution.report.time.as_ref().expect("it is unsteady").steps;
        (1.0 / steps as f64, l2(&solution))
    };
    let ladder = [1e-2, 1e-3, 1e-4, 1e-5].map(run);
    let order = observed(&ladder);
    assert!((1.8..2.4).contains(&order), "order {order}: {ladder:?}");
    for ((_, error), tolerance) in ladder.iter().zip([1e-2, 1e-3, 1e-4, 1e-5]) {
        assert!(*error < tolerance, "{error:e} for a tolerance of {tolerance:e}");
    }
}

#[test]
fn the_order_in_space_is_kept() {
    let ladder = |spacings: &[f64], text: &dyn Fn(f64) -> String| -> Vec<(f64, f64)> {
        spacings.iter().map(|&h| (h, l2(&solved(&text(h))))).collect()
    };
    for (least, ladder) in [
        (1.7, ladder(&[0.05, 0.025, 0.0125], &|h| slab(1, h, 1e-6))),
        (1.6, ladder(&[0.1, 0.05, 0.025], &|h| slab(2, h, 1e-5))),
        (1.6, ladder(&[0.25, 0.18, 0.125], &|h| ball(h, 1e-4))),
    ] {
        let order = observed(&ladder);
        assert!(order > least, "order {order}: {ladder:?}");
    }
}

/// Whatever makes the rows: they are stepped alike.
#[test]
fn every_method_of_a_bounded_domain_steps_through_time() {
    let within = [
        ("gfdm-classical", 0.01, 0.2),
        ("gfdm-positive", 0.01, 0.2),
        ("gfdm-hybrid", 0.01, 0.03),
        ("gfdm-conservative", 0.01, 0.03),
    ];
    for (name, homogeneous, contact) in within {
        let method = MethodName::parse(name).expect("a method");
        for (text, bound) in [(slab(2, 0.05, 1e-4), homogeneous), (composite(2, 0.05, 10.0, 1e-4), contact)] {
            let solution = solve_with(&text, method).expect(name);
            assert!(l2(&solution) < bound, "{name}: {:e}", l2(&solution));
        }
    }
}

/// Orders by theory, over three clouds a spacing. Immersed interfaces: ghosts and operators of second order. The others
/// are of first order: particle differences take the second derivative across an interface, which jumps in time, to be continuous, and
/// surface reaction smears the kink over a width; both leave errors of their rows that do not fall with the spacing, in a
/// layer as thick as it.
#[test]
fn the_order_at_a_contact_is_that_of_theory() {
    for (name, order) in [
        ("immersed-interface", 2.0),
        ("particle-difference", 1.0),
        ("particle-difference-extended", 1.0),
        ("surface-reaction", 1.0),
    ] {
        let method = MethodName::parse(name).expect("a method");
        let clouds = |h: f64| {
            let seeded = |seed| composite(2, h, 10.0, 1e-4).replace("seed = 1", &format!("seed = {seed}"));
            let errors = (1..=3).map(|seed| l2(&solve_with(&seeded(seed), method).expect(name)));
            (h, errors.collect::<Vec<f64>>())
        };
        let ladder = [0.1, 0.05, 0.025].map(clouds);
        let (found, deviation) = over_clouds(&ladder);
        assert!(deviation < 0.25, "{name}: order {found} ± {deviation}, {ladder:?}");
        assert!(found > order - 2.0 * deviation, "{name}: order {found} ± {deviation}, {ladder:?}");
    }
}

#[test]
fn two_materials_in_contact() {
    for contrast in [1e-2, 10.0, 1e6] {
        for (dimension, spacings) in [(1, &[0.04, 0.02, 0.01][..]), (2, &[0.1, 0.05, 0.025])] {
            let run = |&h: &f64| (h, l2(&solved(&composite(dimension, h, contrast, 1e-5))));
            let ladder: Vec<(f64, f64)> = spacings.iter().map(run).collect();
            let order = observed(&ladder);
            assert!(
                order > 0.9 && ladder[2].1 < 0.03,
                "{dimension}-D, contrast {contrast:e}: order {order}, {ladder:?}"
            );
        }
    }
}

const EVERY_METHOD: [MethodName; 9] = [
    MethodName::GfdmClassical,
    MethodName::GfdmConservative,
    MethodName::GfdmHybrid,
    MethodName::GfdmPositive,
    MethodName::ImmersedInterface,
    MethodName::ParticleDifference,
    MethodName::ParticleDifferenceExtended,
    MethodName::Sharp,
    MethodName::SurfaceReaction,
];

#[test]
fn every_method_steps() {
    for method in EVERY_METHOD {
        let error = l2(&solve_with(&slab(2, 0.05, 1e-4), method).expect("it can be solved"));
        assert!(error < 1e-2, "{method:?}: {error:e}");
    }
}

/// Sources, jumps and conditions of every kind that depend on t, for a field of the fitting space times a linear function of t: exact in
/// space and in time.
#[test]
fn data_that_change_are_exact_for_every_method() {
    use MethodName::*;
    let jumps = |square| Growing { second: Some(10.0), jump: 0.3, square };
    let table = [
        // One operator for all: nothing may jump.
        (GfdmClassical, Growing { second: None, jump: 0.0, square: 1.0 }),
        (GfdmConservative, jumps(0.0)),
        (GfdmHybrid, jumps(0.0)),
        (GfdmPositive, jumps(0.0)),
        (ImmersedInterface, jumps(1.0)),
        // The second derivative across the interface is taken to be continuous in time.
        (ParticleDifference, jumps(0.0)),
        (ParticleDifferenceExtended, jumps(0.0)),
        (Sharp, jumps(1.0)),
        // A kink by a source alone is exact, one by diffusivities is smeared; u does not jump.
        (SurfaceReaction, Growing { second: Some(1.0), jump: 0.0, square: 0.0 }),
    ];
    assert!(EVERY_METHOD.iter().all(|method| table.iter().any(|(name, _)| name == method)));
    let errors = table.map(|(method, case)| {
        let solution = solve_with(&growing(case), method).unwrap_or_else(|e| panic!("{method:?}: {e}"));
        (method, l2(&solution))
    });
    assert!(errors.iter().all(|(_, error)| *error < 1e-9), "{errors:?}");
}

/// An insulated square that is heated for a short while only: u is what was put in, all over the square. Steps that have become long in the
/// calm before it pass over it, and no stage of theirs sees it.
#[test]
fn what_happens_for_a_short_while_is_not_missed() {
    let box_ = "[domain]\nbox = { min = [0.0, 0.0], max = [1.0, 1.0] }\n\n[points]\nspacing = 0.2\n\n";
    let pulse = "if(abs(t - 0.503) < 0.002, 50, 0)";
    let bell = "exp(-((t - 0.7)/0.01)^2)/0.01/sqrt(pi)";
    for (source, flux, heat) in [(pulse, "0", 0.2), (bell, "0", 1.0), ("0", bell, 1.0), (pulse, bell, 1.2)] {
        for initial in [0.0, 3.0] {
            let text = format!(
                "title = \"pulse\"\ndimension = 2\n{box_}[[regions]]\nname = \"square\"\ndiffusivity = 1\nsource = \"{source}\"\n\
                 exact = {}\n\n[[boundaries]]\nface = \"left\"\nflux = \"{flux}\"\n\n[[boundaries]]\nface = \"all\"\nflux = 0\n\n\
                 [time]\nend = 2\ntolerance = 1e-3\ninitial = {initial}\n[method]\nname = \"gfdm-conservative\"\n",
                initial + heat
            );
            assert!(l2(&solved(&text)) < 3e-3, "{source}, {flux}, {initial}: {:e}", l2(&solved(&text)));
        }
    }
}

/// A disc in a square whose second part has this diffusivity.
fn disc(spacing: f64, contrast: f64, tolerance: f64) -> String {
    composite(2, spacing, contrast, tolerance)
        .replace("level_set = \"x - 0.4\"", "level_set = \"sqrt((x - 0.47)^2 + (y - 0.52)^2) - 0.27\"")
}

/// A stiff disc whose diffusivity is smeared over its rim: those rows have a mode that grows, which must not pass for a solution.
#[test]
fn what_grows_by_itself_is_said() {
    let text = disc(0.09, 1e-6, 1e-3);
    let error = solve_with(&text, MethodName::GfdmClassical).expect_err("it grows").to_string();
    assert!(error.contains("grows by itself") && error.contains("gfdm-conservative"), "{error}");
    solve_with(&text, MethodName::GfdmConservative).expect("balances let nothing grow");
}

/// The condition at a node of the insulated side gives the node hardly any weight there, so that its value is some hundred times those
/// of its neighbours: that is no growth.
#[test]
fn what_follows_from_others_does_not_grow() {
    let text = disc(0.11, 10.0, 1e-5).replace("seed = 1", "seed = 1\nlayout = \"scattered\"");
    solve_with(&text, MethodName::ParticleDifference).expect("all eigenvalues have the right sign");
}

/// Stops when a time has been reached.
struct Until(f64);

impl Progress for Until {
    fn stage(&mut self, _stage: Stage) {}

    fn proceed(&mut self, t: f64, _end: f64) -> bool {
        t < self.0
    }
}

#[test]
fn a_stopped_run_goes_on_to_the_same_result() {
    let folder = tempfile::tempdir().expect("a folder");
    let text = slab(2, 0.1, 1e-4).replace("end = 0.4", "end = 0.4\noutput = [0.1, 0.2]");
    let scene = Scene::parse(&text, "slab.toml").expect("it parses");
    let mut plan = Plan::new(&scene).expect("it can be planned");
    plan.stages.retain(|s| *s != Stage::Estimate);
    let checkpoint = Checkpoint { path: folder.path().join("run.ckpt"), every: Duration::ZERO };
    let through = execute_from(&scene, &plan, None, &mut Silent).expect("it can be solved");
    for stop in [0.05, 0.15, 0.3] {
        let stopped = execute_from(&scene, &plan, Some(&checkpoint), &mut Until(stop));
        assert!(matches!(stopped, Err(Error::Stopped { t }) if t >= stop), "{stop}");
    }
    let resumed = execute_from(&scene, &plan, Some(&checkpoint), &mut Silent).expect("it can be solved");
    let bits = |u: &[f64]| u.iter().map(|x| x.to_bits()).collect::<Vec<u64>>();
    assert_eq!(bits(&resumed.field.u), bits(&through.field.u));
    assert_eq!(resumed.frames, through.frames);
    assert_eq!(through.frames.iter().map(|f| f.t).collect::<Vec<_>>(), [0.1, 0.2]);
    let (one, two) = (resumed.report.time.expect("unsteady"), through.report.time.expect("unsteady"));
    assert_eq!((one.steps, one.rejected), (two.steps, two.rejected));

    let other = Scene::parse(&text.replace("end = 0.4", "end = 0.5"), "slab.toml").expect("it parses");
    let refused = execute_from(&other, &plan, Some(&checkpoint), &mut Silent);
    assert!(matches!(&refused, Err(e @ Error::Checkpoint { .. }) if e.to_string().contains("another scene")));
    std::fs::write(&checkpoint.path, "meshless checkpoint 2\n").expect("written");
    assert!(matches!(
        execute_from(&scene, &plan, Some(&checkpoint), &mut Silent),
        Err(Error::Checkpoint { .. })
    ));
}

#[test]
fn runs_of_every_method_go_on_bit_for_bit() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut scene = Scene::parse(&composite(2, 0.1, 10.0, 1e-3), "contact.toml").expect("it parses");
    let end = scene.time.as_ref().expect("it is unsteady").end;
    for method in EVERY_METHOD {
        scene.method.name = method;
        let mut plan = Plan::new(&scene).expect("it can be planned");
        plan.stages.retain(|s| *s != Stage::Estimate);
        let path = folder.path().join(format!("{}.ckpt", method.as_str()));
        let checkpoint = Checkpoint { path, every: Duration::ZERO };
        let through = execute_from(&scene, &plan, None, &mut Silent).expect("it can be solved");
        let stopped = execute_from(&scene, &plan, Some(&checkpoint), &mut Until(0.4 * end));
        assert!(matches!(stopped, Err(Error::Stopped { .. })), "{method:?}");
        let resumed = execute_from(&scene, &plan, Some(&checkpoint), &mut Silent).expect("it can be solved");
        let bits = |u: &[f64]| u.iter().map(|x| x.to_bits()).collect::<Vec<u64>>();
        assert_eq!(bits(&resumed.field.u), bits(&through.field.u), "{method:?}");
    }
}

#[test]
fn a_steady_scene_builds_no_steps_and_an_unsteady_one_says_so() {
    let unsteady = Scene::parse(&slab(1, 0.1, 1e-3), "slab.toml").expect("it parses");
    assert!(Plan::new(&unsteady).expect("a plan").runs(Stage::TimeSteps));
    let steady = slab(1, 0.1, 1e-3).replace("exp(-2.9608813203268074*t)*", "");
    let steady = Scene::parse(steady.split("[time]").next().expect("text"), "slab.toml").expect("it parses");
    let plan = Plan::new(&steady).expect("a plan");
    assert!(!plan.runs(Stage::TimeSteps) && plan.skipped.iter().any(|s| s.what == "time"));
}

#[test]
fn what_is_wrong_with_time_is_said_with_its_place() {
    let text = slab(1, 0.1, 1e-3);
    for (from, to, message) in [
        ("end = 0.4", "end = -1", "time.end"),
        ("end = 0.4", "", "time.end: the key is missing"),
        ("tolerance = 0.001", "tolerance = 0", "time.tolerance"),
        ("end = 0.4", "end = 0.4\noutput = [0.3, 0.2]", "expected a time between 0.3 and 0.4, found 0.2"),
        ("spacing = 0.1", "spacing = \"0.1 + t\"", "`t`"),
        ("initial = \"sin(pi*x)\"", "initial = \"t\"", "`t`"),
        ("initial = \"sin(pi*x)\"", "start = 1", "unknown key"),
    ] {
        let error = Scene::parse(&text.replace(from, to), "slab.toml").expect_err(to).to_string();
        assert!(error.contains(message), "{to}: {error}");
    }
    let singular = text.replace("initial = \"sin(pi*x)\"", "initial = \"log(x - 0.5)\"");
    let error = solve_scene(&Scene::parse(&singular, "slab.toml").expect("it parses")).expect_err("singular");
    assert!(error.to_string().contains("the initial value is"), "{error}");
}
