//! `[[slits]]`: interfaces that end inside the domain.

use std::collections::HashSet;

use super::boundaries::robin;
use super::error::SceneError;
use super::reader::Table;
use super::shapes::vertices;
use super::spec::{ConditionSpec, SlitConditionSpec, SlitSpec};

/// Conditions that hold on each side of a slit; a slit has at most one of them.
const ON_EACH_SIDE: [&str; 3] = ["dirichlet", "flux", "robin"];
/// What relates its sides to each other.
const ACROSS: [&str; 2] = ["jump", "flux_jump"];

pub(super) fn slits(root: &Table<'_>) -> Result<Vec<SlitSpec>, SceneError> {
    let mut slits = Vec::new();
    let mut names = HashSet::new();
    for table in root.tables("slits")? {
        table.allow(&[
            "name",
            "polyline",
            "dirichlet",
            "flux",
            "robin",
            "jump",
            "flux_jump",
            "enrichment",
        ])?;
        if root.dimension != 2 {
            let message = format!("a slit needs dimension = 2, the scene has {}", root.dimension);
            return Err(table.place.error(message, "cut a thin hole out of the domain instead"));
        }
        let value = table.require("name")?;
        let name = value.name()?;
        if !names.insert(name.clone()) {
            return Err(value.error(format!("there is already a slit \"{name}\""), "names must differ"));
        }
        slits.push(SlitSpec {
            name,
            polyline: polyline(&table)?,
            condition: condition(&table)?,
            enrichment: table.get("enrichment").map(|value| value.not_negative()).transpose()?,
            place: table.place,
        });
    }
    Ok(slits)
}

fn polyline(table: &Table<'_>) -> Result<Vec<[f64; 2]>, SceneError> {
    let value = table.require("polyline")?;
    let items = value.items()?;
    if items.len() < 2 {
        return Err(value.error(format!("a slit has at least 2 vertices, not {}", items.len()), ""));
    }
    vertices(&items)
}

fn condition(table: &Table<'_>) -> Result<SlitConditionSpec, SceneError> {
    let given: Vec<&str> = ON_EACH_SIDE.into_iter().chain(ACROSS).filter(|key| table.has(key)).collect();
    let data = |key: &str| table.get(key).map(|value| value.data_expression()).transpose();
    match given[..] {
        [] => {
            let help =
                "give what holds on each side (dirichlet, flux or robin), or what jumps (jump, flux_jump)";
            Err(table.place.error("the condition is missing", help))
        }
        ["jump" | "flux_jump"] | ["jump", "flux_jump"] => {
            Ok(SlitConditionSpec::Jump { jump: data("jump")?, flux_jump: data("flux_jump")? })
        }
        ["robin"] => Ok(SlitConditionSpec::OnEachSide(robin(&table.require("robin")?)?)),
        ["dirichlet"] => {
            let field = table.require("dirichlet")?.data_expression()?;
            Ok(SlitConditionSpec::OnEachSide(ConditionSpec::Dirichlet(field)))
        }
        [key] => {
            let field = table.require(key)?.data_expression()?;
            Ok(SlitConditionSpec::OnEachSide(ConditionSpec::Flux(field)))
        }
        [first, second, ..] => {
            let message = format!("there is already the condition `{first}`");
            Err(table.require(second)?.error(message, "a slit has one kind of condition"))
        }
    }
}
