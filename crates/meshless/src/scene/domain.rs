//! `[domain]`, `[points]` and `[[holes]]`.

use std::collections::HashSet;
use std::path::PathBuf;

use meshless_interfaces::thin_layers;

use super::Given;
use super::accuracy::{AccuracySpec, first_spacing};
use super::error::SceneError;
use super::expression::ExprField;
use super::free_space::{FREE_SPACE, is_open};
use super::points_file::PointsFileSpec;
use super::reader::{Table, Value};
use super::shapes::{bounds, keys_with_shape, required_shape};
use super::spec::{
    ALL_FACES, Adapted, BOX_FACES, CornerSpec, DomainSpec, GapSpec, HoleSpec, LayoutName, OUTER_FACE,
    PointsSpec, ShapeSpec,
};

/// Seed of the random numbers, unless the scene gives one.
const DEFAULT_SEED: u64 = 1;

/// The key of `[points]` that has gaps refined.
const GAPS: &str = "refine_gaps_to";

/// The key of `[points]` that has the cloud adapt.
const ADAPT: &str = "adapt";

/// Spacings on the way from a corner to what is next to it: with fewer, corner functions have too few nodes.
const ACROSS: f64 = 8.0;

pub(super) fn domain(root: &Table<'_>) -> Result<DomainSpec, SceneError> {
    let table = root.require("domain")?.table()?;
    if let Some(value) = table.get(FREE_SPACE) {
        table.allow(&[FREE_SPACE])?;
        return Ok(DomainSpec { shape: ShapeSpec::Box(bounds(&value)?), bounds: None, place: table.place });
    }
    table.allow(&keys_with_shape(&["bounds", FREE_SPACE]))?;
    let shape = required_shape(&table)?;
    let bounds = match table.get("bounds") {
        None if shape.is_bounded() => None,
        None => {
            let help = "the shape does not end by itself: give a box that holds it, \
                        bounds = { min = […], max = […] }";
            return Err(table.missing("bounds", help));
        }
        Some(value) if shape.is_bounded() => {
            return Err(value.error("the shape ends by itself and needs no bounds", "remove the key"));
        }
        Some(value) => Some(bounds(&value)?),
    };
    Ok(DomainSpec { shape, bounds, place: table.place })
}

/// What to do where nothing says how far apart the nodes are.
const NO_SPACING: &str =
    "give `spacing` in [points], or the error to reach: [accuracy] with `tolerance`, or --tolerance";

/// The same where an error is given, and the size of the domain is not known before its file is read.
const NO_SIZE: &str =
    "a tolerance begins at a spacing, and the size of this domain is not known: give one in [points]";

/// Spacings whose volumes, and stencils of which, are far from the ends of double precision.
const LENGTHS: (f64, f64) = (1e-60, 1e60);

/// The spacing that stands in for one that is put in afterwards.
const STAND_IN: f64 = 1.0;

/// With `[accuracy]`, or where the spacing or an error is given elsewhere, the spacing, or all of `[points]`, may be absent.
pub(super) fn points(
    root: &Table<'_>,
    domain: &DomainSpec,
    accuracy: Option<&AccuracySpec>,
    given: Given,
) -> Result<PointsSpec, SceneError> {
    const LAYOUTS: [(&str, LayoutName); 4] = [
        ("grid", LayoutName::Grid),
        ("jittered", LayoutName::Jittered),
        ("scattered", LayoutName::Scattered),
        ("irregular", LayoutName::Irregular),
    ];
    let place = accuracy.map_or(&domain.place, |spec| &spec.place);
    let refined = accuracy.is_some() || given == Given::Tolerance;
    let first = || match first_spacing(domain, root.dimension) {
        Some(spacing) if refined || given == Given::Spacing => Some((spacing, place)),
        None if given == Given::Spacing => Some((STAND_IN, place)),
        _ => None,
    };
    let help = if refined { NO_SIZE } else { NO_SPACING };
    let Some(table) = root.get("points").map(Value::table).transpose()? else {
        return match first() {
            Some((spacing, place)) => Ok(PointsSpec {
                spacing: ExprField::constant(spacing, place),
                layout: LayoutName::Irregular,
                seed: DEFAULT_SEED,
                file: None,
                gaps: None,
                corners: adapts(root, refined).then_some(CornerSpec { across: ACROSS }),
                adapted: Adapted::default(),
                place: place.clone(),
            }),
            None => Err(root.missing("points", help)),
        };
    };
    table.allow(&["spacing", "layout", "seed", "file", GAPS, ADAPT])?;
    if let Some(value) = table.get("file") {
        return points_of_file(&table, &value, accuracy);
    }
    let layout = match table.get("layout") {
        Some(value) => value.one_of(&LAYOUTS)?,
        None => LayoutName::Irregular,
    };
    Ok(PointsSpec {
        file: None,
        gaps: gaps(&table, layout, is_open(root))?,
        corners: adapted(&table, layout, root, refined)?,
        adapted: Adapted::default(),
        spacing: match (table.get("spacing"), first()) {
            (Some(value), _) => in_range(value.expression()?.check_positive()?)?,
            (None, Some((spacing, place))) => ExprField::constant(spacing, place),
            (None, None) => return Err(table.missing("spacing", help)),
        },
        layout,
        seed: match table.get("seed") {
            Some(value) => value.integer(0, u64::MAX)?,
            None => DEFAULT_SEED,
        },
        place: table.place,
    })
}

/// A spacing whose powers are numbers, if it is constant.
fn in_range(spacing: ExprField) -> Result<ExprField, SceneError> {
    match spacing.expr.as_constant() {
        Some(h) if !(LENGTHS.0..=LENGTHS.1).contains(&h) => {
            let message =
                format!("lengths from {:e} to {:e} can be computed with, found {h:e}", LENGTHS.0, LENGTHS.1);
            Err(spacing.place.error(message, "take another unit of length"))
        }
        _ => Ok(spacing),
    }
}

/// How far gaps are refined.
fn gaps(table: &Table<'_>, layout: LayoutName, open: bool) -> Result<Option<GapSpec>, SceneError> {
    let Some(value) = table.get(GAPS) else { return Ok(None) };
    if layout != LayoutName::Irregular {
        let help = "take the layout \"irregular\", or leave the key out";
        return Err(value.error("only irregular clouds can be refined in gaps", help));
    }
    if open {
        return Err(value.error("in free space nothing has a gap", "leave the key out"));
    }
    Ok(Some(GapSpec { least: value.positive()?, across: thin_layers::RESOLVED }))
}

/// Whether the cloud of a scene adapts where it says nothing of that: steady ones that ask for a tolerance.
fn adapts(root: &Table<'_>, refined: bool) -> bool {
    refined && !root.has("time") && !is_open(root)
}

/// Whether the cloud adapts.
fn adapted(
    table: &Table<'_>,
    layout: LayoutName,
    root: &Table<'_>,
    refined: bool,
) -> Result<Option<CornerSpec>, SceneError> {
    let adapted = Some(CornerSpec { across: ACROSS });
    let Some(value) = table.get(ADAPT) else {
        let is_irregular = layout == LayoutName::Irregular;
        return Ok(adapted.filter(|_| is_irregular && adapts(root, refined)));
    };
    if !value.boolean()? {
        return Ok(None);
    }
    if layout != LayoutName::Irregular {
        let help = "take the layout \"irregular\", or leave the key out";
        return Err(value.error("only irregular clouds can adapt", help));
    }
    if is_open(root) {
        let help = "grade the cloud by an expression as `spacing`, or leave the key out";
        return Err(value.error("clouds adapt within a domain only", help));
    }
    Ok(adapted)
}

/// Points from a file; how far apart they are can be left to their number.
fn points_of_file(
    table: &Table<'_>,
    file: &Value<'_>,
    accuracy: Option<&AccuracySpec>,
) -> Result<PointsSpec, SceneError> {
    if let Some(spec) = accuracy {
        let message = "points from a file cannot be refined until a tolerance is reached";
        return Err(spec.place.error(message, "remove the section, and judge by the reported estimate"));
    }
    for key in ["layout", "seed", GAPS, ADAPT] {
        if let Some(value) = table.get(key) {
            return Err(value.error(format!("points from a file have no {key}"), "remove the key"));
        }
    }
    let spacing = table.get("spacing").map(|value| value.expression()?.check_positive()).transpose()?;
    let spaced = spacing.is_some();
    let place = file.place.clone();
    let unit = ExprField::constant(1.0, &place);
    Ok(PointsSpec {
        spacing: spacing.unwrap_or(unit),
        layout: LayoutName::Irregular,
        seed: DEFAULT_SEED,
        gaps: None,
        corners: None,
        adapted: Adapted::default(),
        file: Some(PointsFileSpec { path: PathBuf::from(file.text()?), spaced, thin: 1.0, place }),
        place: table.place.clone(),
    })
}

pub(super) fn holes(root: &Table<'_>) -> Result<Vec<HoleSpec>, SceneError> {
    let mut holes = Vec::new();
    let mut names = HashSet::new();
    for table in root.tables("holes")? {
        table.allow(&keys_with_shape(&["name"]))?;
        let value = table.require("name")?;
        let name = value.name()?;
        if BOX_FACES.contains(&name.as_str()) || [OUTER_FACE, ALL_FACES].contains(&name.as_str()) {
            let help = "the hole's surface is a face of that name, so it needs one of its own";
            return Err(value.error(format!("\"{name}\" is the name of a face"), help));
        }
        if !names.insert(name.clone()) {
            return Err(value.error(format!("there is already a hole \"{name}\""), "names must differ"));
        }
        holes.push(HoleSpec { name, shape: required_shape(&table)?, place: table.place });
    }
    Ok(holes)
}
