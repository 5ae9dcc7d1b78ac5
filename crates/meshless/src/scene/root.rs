//! The file as a whole, and its short sections.

use std::sync::Arc;

use toml::de::DeTable;

use super::accuracy::{AccuracyOf, AccuracySpec};
use super::error::SceneError;
use super::reader::Table;
use super::source::{MAX_FILE_BYTES, Place, Source};
use super::spec::OutputSpec;
use super::{Given, Scene, accuracy, boundaries, domain, free_space, method, regions, slits, time};

const KEYS: [&str; 15] = [
    "title",
    "dimension",
    "domain",
    "points",
    "holes",
    "regions",
    "interfaces",
    "slits",
    "boundaries",
    "accuracy",
    "particles",
    "method",
    "time",
    "probes",
    "output",
];

pub(super) fn scene(source: &Arc<Source>, given: Given) -> Result<Scene, SceneError> {
    if source.text.len() > MAX_FILE_BYTES {
        return Err(source.too_long(source.text.len() as u64));
    }
    let parsed = DeTable::parse(&source.text).map_err(|error| not_toml(source, &error))?;
    let root = Table::root(source, parsed.get_ref());
    root.allow(&KEYS)?;
    let open = free_space::is_open(&root);
    let dimension = root.require("dimension")?.integer(1, 3)? as usize;
    let unsteady = root.has("time");
    let root = root.with_dimension(dimension).with_time(unsteady);
    let domain = domain::domain(&root)?;
    let accuracy = accuracy::accuracy(&root)?;
    let points = domain::points(&root, &domain, accuracy.as_ref(), given)?;
    let holes = domain::holes(&root)?;
    let regions = regions::regions(&root)?;
    Ok(Scene {
        title: root.require("title")?.text()?.to_owned(),
        dimension,
        interfaces: regions::interfaces(&root, &regions)?,
        slits: slits::slits(&root)?,
        boundaries: if open { Vec::new() } else { boundaries::boundaries(&root, &domain, &holes)? },
        free_space: free_space::free_space(&root)?,
        method: method::method(&root)?,
        time: time::time(&root)?,
        probes: probes(&root)?,
        output: output(&root, accuracy.as_ref())?,
        accuracy,
        domain,
        points,
        holes,
        regions,
    })
}

/// A syntax error: the parser knows the bytes, not the key.
fn not_toml(source: &Arc<Source>, error: &toml::de::Error) -> SceneError {
    let place = Place::new(source, "", error.span().unwrap_or(0..0));
    let message = match error.message() {
        "duplicate key" => format!("duplicate key `{}`", place.text().escape_debug()),
        other => format!("not valid TOML: {}", other.replace('\n', ", ")),
    };
    place.error(message, "")
}

fn probes(root: &Table<'_>) -> Result<Vec<Vec<f64>>, SceneError> {
    let probe = |table: Table<'_>| {
        table.allow(&["at"])?;
        table.require("at")?.vector()
    };
    root.tables("probes")?.into_iter().map(probe).collect()
}

fn output(root: &Table<'_>, accuracy: Option<&AccuracySpec>) -> Result<OutputSpec, SceneError> {
    // What a tolerance is about is reported.
    let judged = accuracy.is_some_and(|spec| spec.of == AccuracyOf::Fluxes);
    let Some(value) = root.get("output") else {
        return Ok(OutputSpec { fluxes: judged, ..OutputSpec::default() });
    };
    let table = value.subtable(&["vtu", "plot", "csv", "fluxes", "estimate"])?;
    let flag = |key: &str, default: bool| table.get(key).map_or(Ok(default), |value| value.boolean());
    let estimate = flag("estimate", true)?;
    if let (false, Some(_), Some(key)) = (estimate, accuracy, table.get("estimate")) {
        return Err(key.error("a tolerance is reached by estimates", "remove the key, or [accuracy]"));
    }
    Ok(OutputSpec {
        vtu: flag("vtu", false)?,
        plot: flag("plot", false)?,
        csv: flag("csv", false)?,
        fluxes: flag("fluxes", false)? || judged,
        estimate,
    })
}
