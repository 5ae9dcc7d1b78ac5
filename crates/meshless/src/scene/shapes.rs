//! Shapes of domains, holes and regions.

use super::error::SceneError;
use super::reader::{Table, Value};
use super::spec::{BoundsSpec, ShapeSpec, SurfaceSpec};

/// Keys that say a shape; a table has at most one of them.
pub(super) const SHAPE_KEYS: [&str; 10] = [
    "box",
    "sphere",
    "cylinder",
    "polygon",
    "stl",
    "half_space",
    "level_set",
    "union",
    "intersection",
    "difference",
];

/// The keys of a table that has a shape: its own and those of shapes.
pub(super) fn keys_with_shape(own: &[&'static str]) -> Vec<&'static str> {
    own.iter().copied().chain(SHAPE_KEYS).collect()
}

/// The one shape of a table; `None`, if it has none.
pub(super) fn optional_shape(table: &Table<'_>) -> Result<Option<ShapeSpec>, SceneError> {
    let given: Vec<&str> = SHAPE_KEYS.into_iter().filter(|key| table.has(key)).collect();
    match given[..] {
        [] => Ok(None),
        [key] => shape(key, &table.require(key)?).map(Some),
        [first, second, ..] => {
            let message = format!("there is already the shape `{first}`");
            Err(table
                .require(second)?
                .error(message, "combine shapes with `union`, `intersection` or `difference`"))
        }
    }
}

/// The one shape of a table that must have one.
pub(super) fn required_shape(table: &Table<'_>) -> Result<ShapeSpec, SceneError> {
    optional_shape(table)?.ok_or_else(|| {
        table.place.error("the shape is missing", format!("give one of {}", SHAPE_KEYS.join(", ")))
    })
}

fn shape(key: &str, value: &Value<'_>) -> Result<ShapeSpec, SceneError> {
    match key {
        "box" => bounds(value).map(ShapeSpec::Box),
        "sphere" => sphere(&value.subtable(&["center", "radius"])?),
        "cylinder" => cylinder(&value.subtable(&["point", "axis", "radius", "length"])?),
        "polygon" => polygon(value),
        "stl" => surface(value),
        "half_space" => half_space(&value.subtable(&["point", "normal"])?),
        "level_set" => value.expression().map(ShapeSpec::LevelSet),
        "union" => parts(value).map(ShapeSpec::Union),
        "intersection" => parts(value).map(ShapeSpec::Intersection),
        _ => parts(value).map(ShapeSpec::Difference),
    }
}

/// A table of `min` and `max` with `min < max` along every axis.
pub(super) fn bounds(value: &Value<'_>) -> Result<BoundsSpec, SceneError> {
    let table = value.subtable(&["min", "max"])?;
    let (min, max) = (table.require("min")?.vector()?, table.require("max")?);
    let place = &max.place;
    let max = max.vector()?;
    if let Some(axis) = (0..min.len()).find(|&axis| min[axis] >= max[axis]) {
        let message =
            format!("`max` ({}) is not above `min` ({}) along axis {}", max[axis], min[axis], axis + 1);
        return Err(place.error(message, ""));
    }
    Ok(BoundsSpec { min, max })
}

fn sphere(table: &Table<'_>) -> Result<ShapeSpec, SceneError> {
    let center = table.require("center")?.vector()?;
    Ok(ShapeSpec::Sphere { center, radius: table.require("radius")?.positive()? })
}

fn cylinder(table: &Table<'_>) -> Result<ShapeSpec, SceneError> {
    needs_dimension(table.dimension, 3, "cylinder", |message, help| table.place.error(message, help))?;
    Ok(ShapeSpec::Cylinder {
        point: table.require("point")?.vector()?,
        axis: table.require("axis")?.direction()?,
        radius: table.require("radius")?.positive()?,
        length: table.get("length").map(|length| length.positive()).transpose()?,
    })
}

fn half_space(table: &Table<'_>) -> Result<ShapeSpec, SceneError> {
    let point = table.require("point")?.vector()?;
    Ok(ShapeSpec::HalfSpace { point, normal: table.require("normal")?.direction()? })
}

/// The vertices of a polygon or a polyline, each another than the one before it.
pub(super) fn vertices(items: &[Value<'_>]) -> Result<Vec<[f64; 2]>, SceneError> {
    let mut vertices: Vec<[f64; 2]> = Vec::with_capacity(items.len());
    for item in items {
        let vertex = item.vector()?;
        let vertex = [vertex[0], vertex[1]];
        if vertices.last() == Some(&vertex) {
            return Err(item.error("the vertex repeats the one before it", ""));
        }
        vertices.push(vertex);
    }
    Ok(vertices)
}

fn polygon(value: &Value<'_>) -> Result<ShapeSpec, SceneError> {
    needs_dimension(value.dimension, 2, "polygon", |message, help| value.error(message, help))?;
    let items = value.items()?;
    if items.len() < 3 {
        return Err(value.error(format!("a polygon has at least 3 vertices, not {}", items.len()), ""));
    }
    let vertices = vertices(&items)?;
    if vertices.first() == vertices.last() {
        let help = "a polygon closes by itself";
        return Err(items[items.len() - 1].error("the last vertex repeats the first one", help));
    }
    Ok(ShapeSpec::Polygon(vertices))
}

/// A file, or a table of it and how it is read.
fn surface(value: &Value<'_>) -> Result<ShapeSpec, SceneError> {
    needs_dimension(value.dimension, 3, "surface of triangles", |message, help| value.error(message, help))?;
    if value.as_text().is_some() {
        return Ok(ShapeSpec::Surface(SurfaceSpec::new(value.name()?, value.place.clone())));
    }
    let help = "give a file, or { file = \"part.stl\", scale = 0.001, crease = 30, smooth = true }";
    let table = value.subtable(&["file", "scale", "crease", "smooth"]).map_err(|e| {
        if e.message.starts_with("expected a table") {
            value.expected("a file's name or a table", help)
        } else {
            e
        }
    })?;
    let file = table.require("file")?;
    let mut spec = SurfaceSpec::new(file.name()?, file.place.clone());
    if let Some(scale) = table.get("scale") {
        spec.params.scale = scale.positive()?;
    }
    if let Some(crease) = table.get("crease") {
        spec.params.crease = crease.positive()?;
        if spec.params.crease >= 180.0 {
            return Err(crease.error("expected an angle between 0 and 180 degrees", ""));
        }
    }
    if let Some(smooth) = table.get("smooth") {
        spec.params.smooth = smooth.boolean()?;
    }
    Ok(ShapeSpec::Surface(spec))
}

fn needs_dimension(
    dimension: usize,
    needed: usize,
    shape: &str,
    error: impl FnOnce(String, &'static str) -> SceneError,
) -> Result<(), SceneError> {
    if dimension == needed {
        return Ok(());
    }
    let message = format!("a {shape} needs dimension = {needed}, the scene has {dimension}");
    Err(error(message, "use `sphere`, `box` or `level_set`"))
}

/// At least two shapes, each a table of its own.
fn parts(value: &Value<'_>) -> Result<Vec<ShapeSpec>, SceneError> {
    let items = value.items()?;
    if items.len() < 2 {
        let message = format!("expected at least 2 shapes, found {}", items.len());
        return Err(
            value.error(message, "write an array of tables such as [{ sphere = { … } }, { box = { … } }]")
        );
    }
    let part = |item: Value<'_>| {
        let table = item.table()?;
        table.allow(&SHAPE_KEYS)?;
        required_shape(&table)
    };
    items.into_iter().map(part).collect()
}
