//! Problems that are given by their data, which once were answered wrongly: each by what is known of its solution.

use meshless::report::Report;
use meshless::scene::Scene;
use meshless_tests::solve::solve_scene;

fn scene(text: &str) -> Scene {
    Scene::parse(text, "natural.toml").expect("the scene is right")
}

fn report(scene: &Scene) -> Report {
    solve_scene(scene).expect("the scene can be solved").report
}

/// A triangle with u = x in it and nothing outside: its three jumps of the flux, by the sector seen from (0, -0.1).
fn triangle(seed: u32) -> String {
    format!(
        r#"
dimension = 2
[domain]
box = {{ min = [-1.0, -1.0], max = [1.0, 1.0] }}
[points]
spacing = 0.08
seed = {seed}
[[regions]]
name = "in"
polygon = [[-0.5, -0.5], [0.5, -0.3], [0.0, 0.5]]
diffusivity = 1
exact = "x"
[[regions]]
name = "out"
diffusivity = 1
exact = "0"
[[interfaces]]
between = ["in", "out"]
jump = "-x"
flux_jump = "if(atan2(y + 0.1, x) < -2.46685171136624, 0.894427190999916, if(atan2(y + 0.1, x) < -0.380506377112365, -0.196116135138184, if(atan2(y + 0.1, x) < pi/2, -0.847998304005088, 0.894427190999916)))"
[[boundaries]]
face = "all"
dirichlet = 0
"#
    )
}

#[test]
fn jumps_of_the_flux_are_those_of_the_sides_at_acute_corners() {
    for seed in 1..=6 {
        let text = triangle(seed);
        let error = report(&scene(&text)).errors.expect("exact").l2;
        assert!(error < 1e-12, "seed {seed}: {error:e}");
    }
}
