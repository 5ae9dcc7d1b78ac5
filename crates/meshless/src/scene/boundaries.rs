//! `[[boundaries]]`.

use super::error::SceneError;
use super::expression::ExprField;
use super::reader::{Table, Value};
use super::spec::{ALL_FACES, BoundarySpec, ConditionSpec, DomainSpec, HoleSpec};

/// Keys that say a condition; an entry has exactly one of them.
const CONDITIONS: [&str; 5] = ["dirichlet", "neumann", "flux", "robin", "convection"];

pub(super) fn boundaries(
    root: &Table<'_>,
    domain: &DomainSpec,
    holes: &[HoleSpec],
) -> Result<Vec<BoundarySpec>, SceneError> {
    const HELP: &str = "give conditions for every face: [[boundaries]] with `face` and one of dirichlet, \
                        neumann, flux, robin, convection";
    let outer = domain.faces(root.dimension).iter().copied();
    let faces: Vec<(&str, ())> = outer
        .chain(holes.iter().map(|hole| hole.name.as_str()))
        .chain([ALL_FACES])
        .map(|f| (f, ()))
        .collect();
    let value = root.get("boundaries").ok_or_else(|| root.missing("boundaries", HELP))?;
    let tables = root.tables("boundaries")?;
    if tables.is_empty() {
        return Err(value.error("there are no boundary conditions", HELP));
    }
    tables.into_iter().map(|table| boundary(table, &faces)).collect()
}

fn boundary(table: Table<'_>, faces: &[(&str, ())]) -> Result<BoundarySpec, SceneError> {
    table.allow(&["face", "where", "dirichlet", "neumann", "flux", "robin", "convection"])?;
    let face = table.require("face")?;
    face.one_of(faces)?;
    Ok(BoundarySpec {
        face: face.text()?.to_owned(),
        where_: table.get("where").map(|value| value.expression()).transpose()?,
        condition: condition(&table)?,
        place: table.place,
    })
}

fn condition(table: &Table<'_>) -> Result<ConditionSpec, SceneError> {
    let given: Vec<&str> = CONDITIONS.into_iter().filter(|key| table.has(key)).collect();
    match given[..] {
        [] => Err(table
            .place
            .error("the condition is missing", format!("give one of {}", CONDITIONS.join(", ")))),
        [first, second, ..] => {
            let message = format!("there is already the condition `{first}`");
            Err(table.require(second)?.error(message, "a mixed condition is written with `robin`"))
        }
        ["robin"] => robin(&table.require("robin")?),
        ["convection"] => convection(&table.require("convection")?),
        [key] => {
            let field = table.require(key)?.data_expression()?;
            Ok(match key {
                "dirichlet" => ConditionSpec::Dirichlet(field),
                "neumann" => ConditionSpec::Neumann(field),
                _ => ConditionSpec::Flux(field),
            })
        }
    }
}

pub(super) fn robin(value: &Value<'_>) -> Result<ConditionSpec, SceneError> {
    let table = value.subtable(&["a", "b", "g"])?;
    let field = |key: &str| table.require(key)?.data_expression();
    let (a, b, g) = (field("a")?, field("b")?, field("g")?);
    if b.as_constant() == Some(0.0) {
        let message = "b is zero, so the condition `a u + b eta du/dn = g` has no flux term";
        return Err(b.place.error(message, "prescribe u with `dirichlet`"));
    }
    Ok(ConditionSpec::Robin { a, b, g })
}

/// Exchange with surroundings that have a value of their own, `eta du/dn = h (ambient - u)`.
fn convection(value: &Value<'_>) -> Result<ConditionSpec, SceneError> {
    let table = value.subtable(&["h", "ambient"])?;
    let (h, ambient) = (table.require("h")?.data_expression()?, table.require("ambient")?.data_expression()?);
    if let Some(given) = h.as_constant().filter(|h| *h < 0.0) {
        let help = "eta du/dn = h (ambient - u): a negative h would take heat out of what is colder";
        return Err(h
            .place
            .error(format!("expected a coefficient that is not negative, found {given}"), help));
    }
    let (b, g) = (ExprField::constant(1.0, &value.place), value.product(&h, &ambient)?);
    Ok(ConditionSpec::Robin { a: h, b, g })
}
