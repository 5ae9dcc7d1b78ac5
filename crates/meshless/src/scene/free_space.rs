//! Scenes in free space: `domain.free_space`, `[particles]`, and the options of the method.

use std::path::PathBuf;

use super::error::SceneError;
use super::reader::{Table, Value};
use super::source::Place;
use super::spec::{MethodName, MethodSpec};

/// The key of `[domain]`.
pub(super) const FREE_SPACE: &str = "free_space";

/// Sections that say nothing in free space.
const BOUNDED: [(&str, &str); 5] = [
    ("boundaries", "free space has no boundary: remove the section"),
    ("holes", "free space has no boundary: remove the section, or give a bounded domain"),
    ("interfaces", "the coefficient is the same everywhere: remove the section, or give a bounded domain"),
    ("slits", "the coefficient is the same everywhere: remove the section, or give a bounded domain"),
    ("time", "scenes in free space are steady: remove the section, or give a bounded domain"),
];

/// Highest order of Gaussian kernels.
const MAX_ORDER: u64 = 20;

/// Green's functions.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum GreenName {
    /// `gaussian`
    Gaussian,
    /// `spectral`
    Spectral,
    /// `truncated`
    Truncated,
}

/// How particles are spread over the mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SpreadName {
    /// `m4-prime`
    M4Prime,
    /// `m6-star`
    M6Star,
}

/// Particles that carry a part of the source.
#[derive(Debug, Clone)]
pub struct ParticlesSpec {
    /// A file of comma-separated numbers: as many coordinates as there are dimensions, and the strength.
    pub file: PathBuf,
    /// How they are spread.
    pub spread: SpreadName,
    /// The value in the file.
    pub place: Place,
}

/// How a problem in free space is solved.
#[derive(Debug, Clone)]
pub struct FreeSpaceSpec {
    /// The Green's function; the best one for the source, if absent.
    pub kernel: Option<GreenName>,
    /// Smoothing radius of a Gaussian kernel over the spacing.
    pub sigma: Option<f64>,
    /// Particles besides the source of the regions.
    pub particles: Option<ParticlesSpec>,
}

/// Whether the domain is free space.
pub(super) fn is_open(root: &Table<'_>) -> bool {
    root.get("domain").and_then(|value| value.table().ok()).is_some_and(|table| table.has(FREE_SPACE))
}

pub(super) fn free_space(root: &Table<'_>) -> Result<Option<FreeSpaceSpec>, SceneError> {
    const KERNELS: [(&str, GreenName); 3] = [
        ("gaussian", GreenName::Gaussian),
        ("spectral", GreenName::Spectral),
        ("truncated", GreenName::Truncated),
    ];
    if !is_open(root) {
        return match root.get("particles") {
            Some(value) => {
                let help = "give the domain as `free_space`, or remove the section";
                Err(value.error("particles are for free space", help))
            }
            None => Ok(None),
        };
    }
    for (key, help) in BOUNDED {
        if let Some(value) = root.get(key) {
            return Err(value.error(format!("the domain is free space, where [{key}] says nothing"), help));
        }
    }
    if let Some(value) = root.get("points").and_then(|v| v.table().ok()).and_then(|t| t.get("file")) {
        let help = "give `spacing`; particles that carry a source have a section [particles]";
        return Err(value.error("in free space points make a regular mesh", help));
    }
    let method = root.get("method").map(Value::table).transpose()?;
    let method = |key: &str| method.as_ref().and_then(|table| table.get(key));
    let kernel = method("kernel").map(|value| value.one_of(&KERNELS)).transpose()?;
    for key in ["order", "sigma"] {
        if let (Some(value), Some(GreenName::Spectral | GreenName::Truncated)) = (method(key), kernel) {
            return Err(
                value.error(format!("only Gaussian kernels have the option `{key}`"), "remove the key")
            );
        }
    }
    Ok(Some(FreeSpaceSpec {
        kernel,
        sigma: method("sigma").map(|value| value.positive()).transpose()?,
        particles: root.get("particles").map(|value| particles(&value)).transpose()?,
    }))
}

fn particles(value: &Value<'_>) -> Result<ParticlesSpec, SceneError> {
    const SPREADS: [(&str, SpreadName); 2] =
        [("m4-prime", SpreadName::M4Prime), ("m6-star", SpreadName::M6Star)];
    let table = value.subtable(&["file", "spread"])?;
    let file = table.require("file")?;
    Ok(ParticlesSpec {
        file: PathBuf::from(file.text()?),
        spread: table.get("spread").map_or(Ok(SpreadName::M6Star), |value| value.one_of(&SPREADS))?,
        place: file.place.clone(),
    })
}

/// The method of a scene that names none.
pub(super) fn default_method(root: &Table<'_>) -> MethodSpec {
    let name = if is_open(root) { MethodName::FreeSpace } else { MethodName::Auto };
    MethodSpec { name, ..MethodSpec::default() }
}

/// The method that a scene names, if it goes with the domain.
pub(super) fn checked(name: MethodName, open: bool, value: &Value<'_>) -> Result<MethodName, SceneError> {
    match (name, open) {
        (MethodName::Auto | MethodName::FreeSpace, true) => Ok(MethodName::FreeSpace),
        (MethodName::FreeSpace, false) => {
            let help = "give the domain as `free_space = { min = […], max = […] }`, or take another method";
            Err(value.error("the method \"free-space\" is for free space, and the domain is bounded", help))
        }
        (_, true) => {
            let message = format!("the method \"{}\" is for bounded domains", name.as_str());
            Err(value.error(message, "the method in free space is \"free-space\""))
        }
        _ => Ok(name),
    }
}

/// An even order.
pub(super) fn order(value: &Value<'_>) -> Result<usize, SceneError> {
    let order = value.integer(2, MAX_ORDER)? as usize;
    if order.is_multiple_of(2) {
        Ok(order)
    } else {
        let message = format!("expected an even order, found {order}");
        Err(value.error(message, "the orders of the method \"free-space\" are 2, 4, 6, … 20"))
    }
}
