//! Effects that some methods do not know: a scene that asks for both gets an error with its line, and the methods that do.

use super::effects::{Effect, Survey, nonzero};
use crate::methods::METHODS;
use crate::scene::{MethodName, Place, Scene, SceneError};

/// Effects that a method has to know, by the names of [`Effect::name`]; all methods know the others.
const ASKED: [&str; 5] = ["capacity", "advection", "reaction", "contact resistance", "partition"];

/// Whether a method knows all of some effects.
pub(super) fn all(name: MethodName, effects: &[Effect]) -> bool {
    unknown(name, effects).is_none()
}

/// Refuses a method that does not know an effect of the scene.
pub(super) fn check(name: MethodName, scene: &Scene, survey: &Survey) -> Result<(), SceneError> {
    let Some(effect) = unknown(name, &survey.effects) else { return Ok(()) };
    let message = format!("the method \"{}\" does not know the effect \"{effect}\"", name.as_str());
    let knowing: Vec<&str> =
        METHODS.iter().filter(|method| method.effects.contains(&effect)).map(|method| method.name).collect();
    let help = match (scene.free_space.is_some(), scene.method.name) {
        (true, _) => "remove it, or give the domain an end".to_owned(),
        // Something else in the scene leaves no choice of methods.
        (false, MethodName::Auto) => {
            format!("{} do: remove it, or what they do not know", knowing.join(", "))
        }
        (false, _) => format!("take one of {}, or leave the choice to the plan", knowing.join(", ")),
    };
    Err(place(effect, scene).error(message, help))
}

/// With partition coefficients a constant is no solution, so that u is not one up to a constant either where nothing fixes it.
pub(super) fn check_partition(scene: &Scene, survey: &Survey) -> Result<(), SceneError> {
    let partition = scene.interfaces.iter().find_map(|i| i.partition.as_ref().filter(|([a, b], _)| a != b));
    match partition {
        Some((_, place)) if survey.has(|e| matches!(e, Effect::PureNeumann)) && scene.time.is_none() => {
            let message =
                "nothing fixes u, and with partition coefficients it is not determined up to a constant";
            Err(place.error(message, "prescribe u somewhere, or let it exchange with surroundings"))
        }
        _ => Ok(()),
    }
}

fn unknown(name: MethodName, effects: &[Effect]) -> Option<&'static str> {
    let known = METHODS.iter().find(|method| method.name == name.as_str()).map_or(&[][..], |m| m.effects);
    let asked = effects.iter().map(Effect::name).filter(|effect| ASKED.contains(effect));
    asked.into_iter().find(|effect| !known.contains(effect))
}

/// Where a scene asks for an effect.
fn place<'a>(effect: &str, scene: &'a Scene) -> &'a Place {
    let regions = || scene.regions.iter();
    let interfaces = || scene.interfaces.iter();
    let found = match effect {
        "capacity" => regions().find_map(|r| r.capacity.as_ref()).map(|field| &field.place),
        "advection" => {
            regions().flat_map(|r| &r.velocity).find(|f| nonzero(Some(f))).map(|field| &field.place)
        }
        "reaction" => {
            regions().filter_map(|r| r.reaction.as_ref()).find(|f| nonzero(Some(f))).map(|field| &field.place)
        }
        "contact resistance" => interfaces().find_map(|i| i.resistance.as_ref()).map(|field| &field.place),
        _ => interfaces().find_map(|i| i.partition.as_ref()).map(|(_, place)| place),
    };
    found.unwrap_or(&scene.domain.place)
}
