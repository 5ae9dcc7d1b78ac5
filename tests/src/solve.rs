//! Scenes to solutions in one call, for tests and sweeps.

use meshless::plan::{Plan, Stage};
use meshless::scene::{MethodName, Scene};
use meshless::{Error, Silent, Solution, execute};

/// Solves the text of a scene with a method, without the error estimate.
pub fn solve_with(text: &str, method: MethodName) -> Result<Solution, Error> {
    let mut scene = Scene::parse(text, "gallery.toml")?;
    scene.method.name = method;
    solve_scene(&scene)
}

/// Solves a scene without the error estimate.
pub fn solve_scene(scene: &Scene) -> Result<Solution, Error> {
    let mut plan = Plan::new(scene)?;
    plan.stages.retain(|s| *s != Stage::Estimate);
    execute(scene, &plan, &mut Silent)
}
