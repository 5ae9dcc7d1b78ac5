//! `[[slits]]`, right and wrong.

use super::{PLATE, check_all, wrong};
use crate::scene::{ConditionSpec, ExprField, Scene, SlitConditionSpec};

const SLIT: &str = "[[slits]]\nname = 'cut'\npolyline = [[0.2, 0.2], [0.4, 0.2]]\n";

fn with(slit: &str) -> Scene {
    let text = PLATE.replace("[output]", &format!("{SLIT}{slit}\n[output]"));
    Scene::parse(&text, "scene.toml").unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn every_condition_is_read() {
    let slit = |text: &str| with(text).slits.swap_remove(0);
    let given = slit("dirichlet = 'x'\nenrichment = 0.3");
    assert_eq!((given.name.as_str(), given.polyline.len(), given.enrichment), ("cut", 2, Some(0.3)));
    assert!(matches!(given.condition, SlitConditionSpec::OnEachSide(ConditionSpec::Dirichlet(_))));
    assert!(matches!(slit("flux = 2").condition, SlitConditionSpec::OnEachSide(ConditionSpec::Flux(_))));
    let robin = slit("robin = { a = 1, b = 2, g = 3 }").condition;
    assert!(matches!(robin, SlitConditionSpec::OnEachSide(ConditionSpec::Robin { .. })));
    match slit("jump = 1\nflux_jump = 'y'").condition {
        SlitConditionSpec::Jump { jump, flux_jump } => {
            assert_eq!(jump.as_ref().and_then(ExprField::as_constant), Some(1.0));
            assert!(flux_jump.is_some());
        }
        other => panic!("{other:?}"),
    }
    assert!(with("flux_jump = 1").at_time(0.0).slits.len() == 1);
}

#[test]
fn what_is_wrong_is_said_at_its_place() {
    let text = PLATE.replace("[output]", &format!("{SLIT}flux = 1\n[output]"));
    check_all(
        &text,
        &[
            wrong("flux = 1", "flux = 1\njump = «2»", "slits[0].jump", "already the condition `flux`", ""),
            wrong("flux = 1", "flux = 1\nenrichment = «-1»", "slits[0].enrichment", "not below 0", ""),
            wrong("flux = 1", "«neumann» = 1", "slits[0].neumann", "unknown key", ""),
            wrong(
                "[[0.2, 0.2], [0.4, 0.2]]",
                "«[[0.2, 0.2]]»",
                "slits[0].polyline",
                "at least 2 vertices",
                "",
            ),
            wrong("[0.4, 0.2]]", "«[0.2, 0.2]»]", "slits[0].polyline[1]", "repeats the one before", ""),
        ],
    );
}
