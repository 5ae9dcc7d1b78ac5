//! `[[regions]]` and `[[interfaces]]`.

use std::collections::HashSet;

use super::error::SceneError;
use super::expression::ExprField;
use super::free_space;
use super::reader::{Table, Value};
use super::shapes::{SHAPE_KEYS, keys_with_shape, optional_shape};
use super::source::Place;
use super::spec::{InterfaceSpec, PointValues, RegionSpec};

/// Most regions of a scene; nodes carry the index of theirs in 16 bits.
const MAX_REGIONS: usize = u16::MAX as usize;

pub(super) fn regions(root: &Table<'_>) -> Result<Vec<RegionSpec>, SceneError> {
    const HELP: &str = "give at least the background: [[regions]] with `name` and `diffusivity`";
    let value = root.get("regions").ok_or_else(|| root.missing("regions", HELP))?;
    let tables = root.tables("regions")?;
    if tables.is_empty() || tables.len() > MAX_REGIONS {
        let message = format!("expected 1 to {MAX_REGIONS} regions, found {}", tables.len());
        return Err(value.error(message, HELP));
    }
    let last = tables.len() - 1;
    let from_file = root.get("points").and_then(|v| v.table().ok()).is_some_and(|t| t.has("file"));
    let any_shape = tables.iter().any(|t| SHAPE_KEYS.into_iter().any(|key| t.has(key)));
    let labelled = from_file && last > 0 && !any_shape;
    let open = free_space::is_open(root);
    let mut labels = HashSet::new();
    let mut regions = Vec::with_capacity(tables.len());
    let mut names = HashSet::new();
    for (index, table) in tables.into_iter().enumerate() {
        let shape = SHAPE_KEYS.into_iter().find_map(|key| table.get(key));
        let spec = region(&table, open)?;
        if labelled {
            let label = spec.label.as_ref().unwrap_or(&spec.name);
            if !labels.insert(label.clone()) {
                let message = format!("there is already a region with the label \"{label}\"");
                return Err(spec.place.error(message, "labels must differ"));
            }
        } else {
            if let Some(value) = table.get("label") {
                let help = "give [points] a `file` with a label in each line, and no region a shape";
                return Err(value.error("labels are for regions that points from a file tell", help));
            }
            check_geometry(&spec, index == last, shape)?;
        }
        if !names.insert(spec.name.clone()) {
            let message = format!("there is already a region \"{}\"", spec.name);
            return Err(table.require("name")?.error(message, "names must differ"));
        }
        regions.push(spec);
    }
    Ok(regions)
}

fn region(table: &Table<'_>, open: bool) -> Result<RegionSpec, SceneError> {
    table.allow(&keys_with_shape(&[
        "name",
        "label",
        "diffusivity",
        "source",
        "capacity",
        "velocity",
        "reaction",
        "vorticity",
        "exact",
    ]))?;
    let data = |key: &str| table.get(key).map(|value| value.data_expression()).transpose();
    Ok(RegionSpec {
        name: table.require("name")?.name()?,
        label: table.get("label").map(|value| label(&value)).transpose()?,
        geometry: optional_shape(table)?,
        diffusivity: table.require("diffusivity")?.data_expression()?.check_positive()?,
        source: data("source")?,
        capacity: data("capacity")?.map(ExprField::check_positive).transpose()?,
        velocity: velocity(table)?,
        reaction: data("reaction")?,
        exact: data("exact")?,
        vorticity: vorticity(table, open)?,
        place: table.place.clone(),
    })
}

/// An expression for each axis.
fn velocity(table: &Table<'_>) -> Result<Vec<ExprField>, SceneError> {
    let Some(value) = table.get("velocity") else { return Ok(Vec::new()) };
    let axes = value.dimension;
    let help = format!("give {axes} numbers or expressions in brackets, one for each axis");
    let components = value.items().map_err(|_| value.expected("an array", &help))?;
    if components.len() != axes {
        return Err(value.error(format!("expected {axes} components, found {}", components.len()), help));
    }
    components.iter().map(Value::data_expression).collect()
}

/// An expression in the plane, one for each direction in space.
fn vorticity(table: &Table<'_>, open: bool) -> Result<Vec<ExprField>, SceneError> {
    let Some(value) = table.get("vorticity") else { return Ok(Vec::new()) };
    if !open {
        let help = "give the domain as `free_space`, or remove the key";
        return Err(value.error("a vorticity is for free space", help));
    }
    match value.dimension {
        1 => Err(value.error("there is no curl in one dimension", "remove the key")),
        2 => Ok(vec![value.data_expression()?]),
        _ => {
            let components = value.items()?;
            if components.len() != 3 {
                let message = format!("expected 3 components, found {}", components.len());
                return Err(value.error(message, "give an expression for each direction"));
            }
            components.iter().map(Value::data_expression).collect()
        }
    }
}

/// A number or a text.
fn label(value: &Value<'_>) -> Result<String, SceneError> {
    match value.as_number() {
        Some(number) => Ok(number?.to_string()),
        None if value.as_text().is_some() => value.name(),
        None => Err(value.expected("a number or a text", "")),
    }
}

/// The last region is the background, and only it.
fn check_geometry(region: &RegionSpec, last: bool, shape: Option<Value<'_>>) -> Result<(), SceneError> {
    match (&region.geometry, last) {
        (None, false) => {
            let message = "only the last region, the background, can be without a shape";
            Err(region.place.error(message, "give it a shape, or move it to the end"))
        }
        (Some(_), true) => {
            let place = shape.map_or_else(|| region.place.clone(), |value| value.place);
            let message = "the last region is the background and has no shape";
            Err(place.error(message, "remove the shape, or add a region without one at the end"))
        }
        _ => Ok(()),
    }
}

pub(super) fn interfaces(root: &Table<'_>, regions: &[RegionSpec]) -> Result<Vec<InterfaceSpec>, SceneError> {
    let mut interfaces = Vec::new();
    let mut pairs = HashSet::new();
    for table in root.tables("interfaces")? {
        table.allow(&[
            "between",
            "resistance",
            "partition",
            "jump",
            "flux_jump",
            "flux_jump_at",
            "dirichlet",
        ])?;
        let value = table.require("between")?;
        let between = pair(&value, regions)?;
        if !pairs.insert([between[0].min(between[1]), between[0].max(between[1])]) {
            return Err(value.error("there is already an entry for these two regions", "merge the entries"));
        }
        interfaces.push(InterfaceSpec {
            between,
            resistance: resistance(&table)?,
            partition: table.get("partition").map(|value| partition(&value)).transpose()?,
            jump: table.get("jump").map(|value| value.data_expression()).transpose()?,
            flux_jump: table.get("flux_jump").map(|value| value.data_expression()).transpose()?,
            flux_jump_at: flux_jump_at(&table)?,
            rates: [None, None],
            dirichlet: dirichlet(&table)?,
            place: table.place,
        });
    }
    Ok(interfaces)
}

/// An expression of position that is not negative where it is constant.
fn resistance(table: &Table<'_>) -> Result<Option<ExprField>, SceneError> {
    let Some(value) = table.get("resistance") else { return Ok(None) };
    let field = value.expression()?;
    match field.as_constant() {
        Some(given) if given < 0.0 => {
            let help = "u rises by the resistance times the flux `eta du/dn`; a negative one would drive heat by itself";
            Err(value.error(format!("expected a resistance that is not negative, found {given}"), help))
        }
        _ => Ok(Some(field)),
    }
}

/// Two positive numbers.
fn partition(value: &Value<'_>) -> Result<([f64; 2], Place), SceneError> {
    const HELP: &str =
        "give the two coefficients in the order of `between`: u_A / K_A and u_B / K_B are what is equal";
    let items = value.items().map_err(|_| value.expected("an array of two positive numbers", HELP))?;
    let [first, second] = &items[..] else {
        return Err(value.error(format!("expected 2 coefficients, found {}", items.len()), HELP));
    };
    Ok(([first.positive()?, second.positive()?], value.place.clone()))
}

/// u on the interface, in place of jumps.
fn dirichlet(table: &Table<'_>) -> Result<Option<ExprField>, SceneError> {
    let Some(value) = table.get("dirichlet") else { return Ok(None) };
    if ["jump", "flux_jump", "flux_jump_at", "resistance", "partition"].iter().any(|key| table.has(key)) {
        let help = "u is prescribed on both sides, and the flux jumps by what that takes: remove the jumps";
        return Err(value.error("an interface has either `dirichlet` or jumps", help));
    }
    value.data_expression().map(Some)
}

/// The flux jump at points.
fn flux_jump_at(table: &Table<'_>) -> Result<Option<PointValues>, SceneError> {
    let Some(value) = table.get("flux_jump_at") else { return Ok(None) };
    if table.has("flux_jump") {
        return Err(value.error("there is already a `flux_jump`", "give an expression or values at points"));
    }
    let solid = value.dimension == 3;
    if value.dimension == 1 {
        return Err(value.error("an interface in 1-D is one point", "use `flux_jump`"));
    }
    let keys: &[&str] = if solid { &["points", "values", "triangles"] } else { &["points", "values"] };
    let table = value.subtable(keys)?;
    let points = table.require("points")?;
    let points = points.items()?.iter().map(Value::vector).collect::<Result<Vec<_>, _>>()?;
    let given = table.require("values")?;
    let values = given.items()?.iter().map(Value::number).collect::<Result<Vec<_>, _>>()?;
    if points.len() != values.len() || points.len() < 3 {
        let message = format!("{} values at {} points", values.len(), points.len());
        return Err(given.error(message, "give at least 3 points, and a value for each"));
    }
    let mut triangles = Vec::new();
    if solid {
        for item in table.require("triangles")?.items()? {
            let corners = item.items()?;
            let [a, b, c] = &corners[..] else {
                return Err(item.error(format!("expected 3 indices, found {}", corners.len()), ""));
            };
            let index = |v: &Value<'_>| v.integer(0, points.len() as u64 - 1).map(|k| k as u32);
            triangles.push([index(a)?, index(b)?, index(c)?]);
        }
    }
    Ok(Some(PointValues { points, values, triangles }))
}

/// Indices of two different regions.
fn pair(value: &Value<'_>, regions: &[RegionSpec]) -> Result<[usize; 2], SceneError> {
    let names = value.items().map_err(|_| value.expected("an array of two region names", ""))?;
    let [first, second] = &names[..] else {
        return Err(value.error(format!("expected 2 region names, found {}", names.len()), ""));
    };
    let index = |name: &Value<'_>| {
        let known: Vec<(&str, usize)> = regions.iter().map(|r| r.name.as_str()).zip(0..).collect();
        name.one_of(&known)
    };
    let between = [index(first)?, index(second)?];
    if between[0] == between[1] {
        return Err(second.error("an interface is between two different regions", ""));
    }
    Ok(between)
}
