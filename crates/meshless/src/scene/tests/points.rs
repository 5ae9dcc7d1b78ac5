//! Jumps of the flux given at points of an interface.

use super::{PLATE, check_all, wrong};
use crate::scene::Scene;

const GIVEN: &str = "flux_jump_at = { points = [[1.5, 1], [1, 1.5], [0.5, 1]], values = [1, 2, 3] }";

#[test]
fn values_at_points_are_read() {
    let scene = Scene::parse(&PLATE.replace("flux_jump = \"0.2\"", GIVEN), "scene.toml").unwrap();
    let given = scene.interfaces[0].flux_jump_at.as_ref().unwrap();
    assert_eq!((given.points.len(), given.values[1], given.triangles.len()), (3, 2.0, 0));
}

#[test]
fn what_is_wrong_is_said_at_its_place() {
    let text = PLATE.replace("flux_jump = \"0.2\"", GIVEN);
    check_all(
        &text,
        &[
            wrong("[1, 2, 3]", "«[1, 2]»", "interfaces[0].flux_jump_at.values", "2 values at 3 points", ""),
            wrong("[1, 2, 3]", "[1, «\"x\"», 3]", "interfaces[0].flux_jump_at.values[1]", "a number", ""),
            wrong(
                ", values = [1, 2, 3]",
                ", «heights» = 1",
                "interfaces[0].flux_jump_at.heights",
                "unknown",
                "",
            ),
            wrong(
                "flux_jump_at = { points",
                "flux_jump = 1\nflux_jump_at = «{ points = [[1.5, 1], [1, 1.5], [0.5, 1]], values = [1, 2, 3] }»\n#",
                "interfaces[0].flux_jump_at",
                "already a `flux_jump`",
                "",
            ),
        ],
    );
}
