//! What a scene does not call for is not built.

use meshless::interfaces::RowKind;
use meshless::plan::{Effect, Plan, Stage};
use meshless::scene::{MethodName, Scene};
use meshless::{Silent, execute};
use meshless_tests::small::Small;

fn plan(small: &Small) -> Plan {
    let scene = Scene::parse(&small.text(), "small.toml").expect("the scene can be solved");
    Plan::new(&scene).expect("the scene can be solved")
}

#[test]
fn a_plain_poisson_scene_has_nothing_but_stencils() {
    let plan = plan(&Small::default());
    assert_eq!(plan.effects, []);
    assert_eq!(plan.method.name, MethodName::GfdmClassical);
    assert_eq!(
        plan.stages,
        [
            Stage::Points,
            Stage::Neighbors,
            Stage::LaplacianStencils,
            Stage::Assembly,
            Stage::Solve,
            Stage::Balance,
            Stage::Estimate
        ]
    );
}

#[test]
fn every_effect_adds_its_own_stages_and_no_others() {
    let base = plan(&Small::default());
    let added = |small: Small| {
        let plan = plan(&small);
        plan.stages.into_iter().filter(|s| !base.stages.contains(s)).collect::<Vec<_>>()
    };
    // Where a source meets a right angle with u = 0 the solution has a logarithm.
    let corners = [Stage::Source, Stage::CornerFunctions];
    assert_eq!(added(Small { source: Some("1"), ..Small::default() }), corners);
    assert_eq!(added(Small { source: Some("0"), ..Small::default() }), []);
    assert_eq!(
        added(Small { outside: "1 + x", ..Small::default() }),
        [Stage::Diffusivity, Stage::DiffusionStencils]
    );
    assert_eq!(
        added(Small { extra: "[[probes]]\nat = [0.5, 0.5]\n\n", ..Small::default() }),
        [Stage::Probes]
    );
    assert_eq!(added(Small { extra: "[output]\nplot = true\n\n", ..Small::default() }), [Stage::Plot]);
    assert_eq!(
        added(Small { extra: "[output]\nvtu = true\n\n", ..Small::default() }),
        [Stage::Gradient, Stage::Diagnosis, Stage::Vtu]
    );
    let fits = [
        Stage::Regions,
        Stage::Diffusivity,
        Stage::DiffusionStencils,
        Stage::ConstrainedStencils,
        Stage::Cells,
    ]
    .to_vec();
    assert_eq!(added(Small { inside: Some("5"), ..Small::default() }), fits);
    let stiff = [&fits[..], &[Stage::FloatingConstants]].concat();
    assert_eq!(added(Small { inside: Some("1e6"), ..Small::default() }), stiff);
    let extra = "[method]\nname = \"gfdm-hybrid\"\n\n";
    assert_eq!(
        added(Small { inside: Some("5"), extra, ..Small::default() }),
        [Stage::Regions, Stage::Diffusivity, Stage::DiffusionStencils, Stage::NodeSelection, Stage::Cells]
    );
}

#[test]
fn two_regions_of_one_material_are_no_interface() {
    let plan = plan(&Small { inside: Some("1"), ..Small::default() });
    assert!(plan.effects.is_empty());
    assert!(plan.runs(Stage::LaplacianStencils));
    assert!(!plan.runs(Stage::Cells) && !plan.runs(Stage::Diffusivity));
}

#[test]
fn jumps_are_effects_and_call_for_fits_on_both_sides() {
    let text = |extra: &str| {
        let jump = "[[interfaces]]\nbetween = [\"inside\", \"outside\"]\nflux_jump = \"1\"\n\n";
        Small { inside: Some("1"), extra: jump, ..Small::default() }.text() + extra
    };
    let with = |extra: &str| {
        let scene = Scene::parse(&text(extra), "small.toml").expect("a scene");
        Plan::new(&scene).expect("a plan")
    };
    let plan = with("");
    assert_eq!(plan.effects, [Effect::FluxJump]);
    assert_eq!((plan.method.name, plan.fallback), (MethodName::Sharp, Some(MethodName::GfdmHybrid)));
    // Balances of the nodes beside the interface.
    assert!(plan.runs(Stage::ConstrainedStencils) && plan.runs(Stage::Cells));
    // An order that these fits do not have, or steps in time: balances.
    for extra in ["[method]\norder = 3\n", "[time]\nend = 1.0\n"] {
        let plan = with(extra);
        assert_eq!((plan.method.name, plan.fallback), (MethodName::GfdmHybrid, None));
        assert!(plan.runs(Stage::Cells));
    }
}

/// In time corners have no functions of their own, and fits lose heat there: balances do not.
#[test]
fn scenes_in_time_with_corners_take_balances() {
    let chosen = |text: &str| {
        let scene = Scene::parse(text, "small.toml").expect("a scene");
        Plan::new(&scene).expect("a plan").method.name
    };
    let time = "[time]\nend = 1\ninitial = \"0\"\n[output]\nfluxes = true\n";
    let disc = Small { inside: Some("7"), ..Small::default() }.text();
    let shape = "sphere = { center = [0.5, 0.5], radius = 0.3 }";
    assert!(disc.contains(shape), "{disc}");
    let square = disc.replace(shape, "box = { min = [0.3, 0.3], max = [0.7, 0.7] }");
    assert_eq!(chosen(&square), MethodName::Sharp);
    assert_eq!(chosen(&(disc + time)), MethodName::Sharp);
    assert_eq!(chosen(&(square.clone() + time)), MethodName::GfdmConservative);
    assert_eq!(chosen(&(square + time + "[accuracy]\ntolerance = 1e-2\n")), MethodName::GfdmConservative);
}

#[test]
fn clouds_adapt_to_corners_where_the_scene_asks_for_it() {
    let text = Small { inside: Some("7"), source: Some("1"), ..Small::default() }.text();
    let plan = |text: &str| Plan::new(&Scene::parse(text, "small.toml").expect("a scene")).expect("a plan");
    assert!(!plan(&text).adapts);
    let adapted = plan(&text.replace("[points]\n", "[points]\nadapt = true\n"));
    assert!(adapted.adapts && adapted.effects.contains(&Effect::GradedCloud));
    assert!(adapted.to_string().contains("cloud       finer round the corners"), "{adapted}");
    assert!(adapted.predicted.unknowns >= plan(&text).predicted.unknowns);
}

#[test]
fn gaps_are_refined_where_the_scene_asks_for_it() {
    let text = Small { inside: Some("7"), ..Small::default() }.text();
    let plan = |text: &str| Plan::new(&Scene::parse(text, "small.toml").expect("a scene")).expect("a plan");
    assert_eq!(plan(&text).refine_gaps_to, None);
    let plan = plan(&text.replace("[points]\n", "[points]\nrefine_gaps_to = 1e-3\n"));
    assert_eq!(plan.refine_gaps_to, Some(1e-3));
    assert!(plan.effects.contains(&Effect::GradedCloud));
    assert!(plan.to_string().contains("gaps        refined where they are thinner than 2 spacings"));
}

#[test]
fn skipped_stages_have_reasons_and_are_not_also_run() {
    for small in [Small::default(), Small { inside: Some("7"), source: Some("x"), ..Small::default() }] {
        let plan = plan(&small);
        for skipped in &plan.skipped {
            assert!(!skipped.why.is_empty(), "{}", skipped.what);
            assert!(plan.stages.iter().all(|s| s.name() != skipped.what), "{}", skipped.what);
        }
    }
}

#[test]
fn execution_builds_no_cell_where_the_plan_has_none() {
    let scene = Scene::parse(&Small::default().text(), "small.toml").expect("the scene can be solved");
    let solution = execute(&scene, &Plan::new(&scene).expect("the scene can be solved"), &mut Silent)
        .expect("the scene can be solved");
    assert_eq!(solution.report.nodes.conservative, 0);
    assert!(!solution.field.kind.contains(&RowKind::Conservative));
    assert!(solution.field.gradient.is_none());
}

#[test]
fn the_prediction_of_the_unknowns_is_close() {
    for (dimension, spacing) in [(1, "0.01"), (2, "0.02"), (3, "0.08")] {
        let small = Small { dimension, spacing, ..Small::default() };
        let scene = Scene::parse(&small.text(), "small.toml").expect("the scene can be solved");
        let plan = Plan::new(&scene).expect("the scene can be solved");
        let solution = execute(&scene, &plan, &mut Silent).expect("the scene can be solved");
        let ratio = plan.predicted.unknowns / solution.field.u.len() as f64;
        assert!((0.85..1.18).contains(&ratio), "{dimension}-D: {ratio}");
    }
}

/// Functions that solve the equation of a diffusivity that varies take 4.5 times the stencils in space; fluxes are those of the balance,
/// which every scene has.
#[test]
fn what_varies_and_fluxes_are_in_the_prediction_of_the_time() {
    let predicted = |eta: &str, fluxes: bool| {
        let text = format!(
            "title = \"Ball\"\ndimension = 3\n[domain]\nbox = {{ min = [0, 0, 0], max = [1, 1, 1] }}\n[points]\nspacing = 0.09\n\
             [[regions]]\nname = \"ball\"\nsphere = {{ center = [0.5, 0.5, 0.5], radius = 0.3 }}\ndiffusivity = \"10*({eta})\"\n\
             [[regions]]\nname = \"cube\"\ndiffusivity = \"{eta}\"\n[[boundaries]]\nface = \"all\"\ndirichlet = \"x\"\n\
             [output]\nfluxes = {fluxes}\n"
        );
        Plan::new(&Scene::parse(&text, "ball.toml").expect("a scene")).expect("a plan").predicted.seconds
    };
    let constant = predicted("1", false);
    let ratios = [predicted("1 + x", false), predicted("1", true)].map(|seconds| seconds / constant);
    assert!((2.0..6.0).contains(&ratios[0]) && ratios[1] == 1.0, "{ratios:?}");
}

#[test]
fn multigrid_of_the_sharp_method_smooths_by_incomplete_factors() {
    use meshless_sparse::{PreconditionerKind, Restriction, SmootherKind};
    let params = |method: &str| {
        let text = meshless_tests::kraus::interior(1e10, 0.3, 1)
            + &format!("[method]\nname = \"{method}\"\nsolver = \"multigrid\"\n");
        let scene = Scene::parse(&text, "gallery.toml").expect("a scene");
        match Plan::new(&scene).expect("a plan").solver.preconditioner {
            PreconditionerKind::Multigrid(params) => (params.smoother, params.restriction),
            other => panic!("{other:?}"),
        }
    };
    assert_eq!(params("sharp"), (SmootherKind::Ilu0, Restriction::Own));
    assert_eq!(params("gfdm-hybrid"), (SmootherKind::GaussSeidel, Restriction::Transpose));
}

#[test]
fn the_solver_fits_size_and_matrix() {
    let solver = |small: Small, method: &str| {
        let text = small.text() + "\n[method]\n" + method + "\n";
        let scene = Scene::parse(&text, "small.toml").expect("the scene can be solved");
        Plan::new(&scene).expect("the scene can be solved").solver_name()
    };
    let disc = |spacing| Small { inside: Some("1e6"), spacing, ..Small::default() };
    let ball = |spacing| Small { dimension: 3, ..disc(spacing) };
    let (multigrid, krylov) = ("gmres(60) + multigrid", "bicgstab(2) + ILU(0)");
    assert_eq!(solver(disc("0.01"), "name = \"auto\""), "direct");
    assert_eq!(solver(disc("0.01"), "solver = \"multigrid\""), multigrid);
    assert_eq!(solver(disc("0.004"), "name = \"auto\""), multigrid);
    assert_eq!(solver(ball("0.05"), "name = \"auto\""), multigrid);
    // Stencils that cross an interface without balances, at any contrast.
    let steep = |small: Small| Small { inside: Some("1e8"), ..small };
    assert_eq!(solver(steep(disc("0.004")), "name = \"gfdm-classical\""), multigrid);
    assert_eq!(solver(steep(ball("0.05")), "name = \"immersed-interface\""), multigrid);
    assert_eq!(solver(disc("0.004"), "name = \"gfdm-classical\""), multigrid);
    assert_eq!(solver(ball("0.05"), "name = \"immersed-interface\""), multigrid);
    let smooth = Small { dimension: 3, spacing: "0.05", ..Small::default() };
    assert_eq!(solver(smooth, "name = \"gfdm-classical\""), multigrid);
    assert_eq!(solver(ball("0.05"), "solver = \"bicgstab\""), krylov);
}

/// With and without contacts, conditions that switch, oscillate and exchange heat, one to three dimensions.
#[test]
fn the_prediction_of_the_steps_is_within_a_factor_of_three() {
    use meshless_tests::unsteady::{ball, composite, driven, sandwich, slab, switched};
    let shock = |text: String| text.replace("initial = ", "initial = 1 # ");
    let exchange = |text: String| {
        text.replacen("dirichlet = 0", "robin = { a = 2, b = 1, g = \"if(t < 0.1, 2, sin(20*t))\" }", 1)
    };
    let scenes = [
        slab(1, 0.05, 1e-4),
        slab(2, 0.1, 1e-3),
        slab(3, 0.2, 1e-3),
        ball(0.25, 1e-4),
        composite(2, 0.1, 10.0, 1e-4),
        composite(2, 0.1, 1e-6, 1e-3),
        shock(composite(2, 0.1, 1e6, 1e-4)),
        shock(sandwich(2, 0.1, 1e4, 1e-3)),
        switched(2, 0.1, 1e-4),
        driven(1e-4),
        exchange(composite(2, 0.1, 0.1, 1e-4)),
    ];
    for text in scenes {
        let scene = Scene::parse(&text, "small.toml").expect("the scene can be solved");
        let plan = Plan::new(&scene).expect("the scene can be solved");
        let foreseen = plan.predicted.steps.expect("it has steps in time");
        assert!(plan.to_string().contains(&format!("about {:.0} steps in time", foreseen.steps)), "{plan}");
        let solution = execute(&scene, &plan, &mut Silent).expect("the scene can be solved");
        let taken = solution.report.time.expect("it is unsteady");
        for (foreseen, taken) in [(foreseen.steps, taken.steps), (foreseen.matrices, taken.matrices)] {
            let ratio = foreseen / taken as f64;
            assert!((1.0 / 3.0..3.0).contains(&ratio), "{foreseen} for {taken}:\n{text}");
        }
    }
}

#[test]
fn the_prediction_counts_the_steps() {
    use meshless_tests::unsteady::slab;
    let plan = |text: &str| Plan::new(&Scene::parse(text, "slab.toml").expect("a scene")).expect("a plan");
    let (loose, tight) = (plan(&slab(2, 0.05, 1e-3)).predicted, plan(&slab(2, 0.05, 1e-5)).predicted);
    let text = slab(2, 0.05, 1e-3);
    let steady = plan(&text.split("[time]").next().expect("text").replace("*t", "")).predicted;
    let steps = |p: &meshless::plan::Predicted| p.steps.map_or(0.0, |time| time.steps);
    assert!(steady.steps.is_none() && steps(&tight) > 5.0 * steps(&loose));
    assert!(tight.seconds > 2.0 * loose.seconds && loose.seconds > steady.seconds);
    // A run that takes far too many is planned in no time.
    let endless = plan(&text.replace("dirichlet = 0", "dirichlet = \"sin(1e6*t)\"")).predicted;
    assert!(steps(&endless) > 1e5, "{endless:?}");
}
