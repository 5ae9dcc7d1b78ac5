//! Points from a file of comma-separated values, with the region of each where the file says it.
//!
//! Each line has the coordinates of a point and, where the scene's regions have no shapes, a number or a name that tells
//! its region. Empty lines and what follows a `#` are skipped; a first line of what is left that does not begin with a number is
//! taken for the names of the columns.

use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::Arc;

use super::error::SceneError;
use super::source::{Place, Source};
use super::spec::RegionSpec;

/// Longest file of points, in bytes: room for ten million of them.
const MAX_BYTES: u64 = 1 << 29;

/// Points from a file in place of a generated cloud.
#[derive(Debug, Clone)]
pub struct PointsFileSpec {
    /// The file, relative to the scene.
    pub path: PathBuf,
    /// Whether the scene says how far apart the points are; if not, that is told from their number.
    pub spaced: bool,
    /// 1 takes all points; more takes about every `thin^D`-th, for coarser solutions to compare with.
    pub(crate) thin: f64,
    /// The value in the scene.
    pub place: Place,
}

/// What a file holds.
#[derive(Debug, Clone)]
pub(crate) struct FilePoints<const D: usize> {
    pub(crate) points: Vec<[f64; D]>,
    /// The region of each point, where the file tells.
    pub(crate) labels: Option<Vec<u16>>,
    /// Where the line of each point begins and ends.
    lines: Vec<[usize; 2]>,
    source: Arc<Source>,
}

impl PointsFileSpec {
    /// The file and what stands in it.
    pub(crate) fn text(&self) -> Result<(PathBuf, String), SceneError> {
        self.place.read_text_beside(&self.path, MAX_BYTES)
    }

    /// Reads the file; `regions` are those that it labels its points with, none where it has coordinates only.
    pub(crate) fn read<const D: usize>(
        &self,
        regions: Option<&[RegionSpec]>,
    ) -> Result<FilePoints<D>, SceneError> {
        let (path, text) = self.text()?;
        let source = Arc::new(Source::new(&path.display().to_string(), &text));
        let names = regions.map(Names::new);
        let mut file = FilePoints { points: Vec::new(), labels: None, lines: Vec::new(), source };
        let mut labels = Vec::new();
        let (mut start, mut first) = (0, true);
        for line in text.split_inclusive('\n') {
            let content = line.split('#').next().unwrap_or_default().trim_end();
            if !content.trim().is_empty() {
                match file.row(content, start, names.as_ref()) {
                    Ok((point, label)) => {
                        file.points.push(point);
                        file.lines.push([start, start + content.len()]);
                        labels.extend(label);
                    }
                    Err(_) if first && !begins_with_number(content) => {}
                    Err(error) => return Err(error),
                }
                first = false;
            }
            start += line.len();
        }
        if file.points.is_empty() {
            let help = format!("each line has {}", columns(D, names.is_some()));
            return Err(self.place.error(format!("{} has no points", path.display()), help));
        }
        file.labels = names.is_some().then_some(labels);
        file.check_distinct()?;
        Ok(file)
    }
}

impl<const D: usize> FilePoints<D> {
    /// An error about point number `i`.
    pub(crate) fn error(&self, i: usize, message: impl Into<String>, help: &str) -> SceneError {
        let [from, to] = self.lines[i];
        Place::new(&self.source, "", from..to).error(message, help)
    }

    /// One line, whose bytes begin at `start`.
    fn row(
        &self,
        line: &str,
        start: usize,
        names: Option<&Names>,
    ) -> Result<([f64; D], Option<u16>), SceneError> {
        let mut cells = Vec::with_capacity(D + 1);
        let mut from = start;
        for cell in line.split(',') {
            let text = cell.trim();
            let begin = from + (cell.len() - cell.trim_start().len());
            cells.push((text, begin..begin + text.len()));
            from += cell.len() + 1;
        }
        let wrong = |span: std::ops::Range<usize>, message: String, help: String| {
            Err(Place::new(&self.source, "", span).error(message, help))
        };
        let wanted = D + usize::from(names.is_some());
        if cells.len() != wanted {
            let message = format!("expected {wanted} values, found {}", cells.len());
            let help = format!("each line has {}", columns(D, names.is_some()));
            return wrong(start..start + line.len(), message, help);
        }
        let mut point = [0.0; D];
        for (coordinate, (text, span)) in point.iter_mut().zip(&cells) {
            *coordinate = match text.parse::<f64>() {
                Ok(value) if value.is_finite() => value,
                _ => {
                    let message = format!("expected a finite number, found \"{}\"", text.escape_debug());
                    return wrong(span.clone(), message, String::new());
                }
            };
        }
        let Some(names) = names else { return Ok((point, None)) };
        let (text, span) = &cells[D];
        match names.find(text) {
            Some(region) => Ok((point, Some(region))),
            None => {
                let message = format!("no region has the label \"{}\"", text.escape_debug());
                let help = format!(
                    "the labels are {}; a region's is its `label`, or else its name",
                    names.all.join(", ")
                );
                wrong(span.clone(), message, help)
            }
        }
    }

    fn check_distinct(&self) -> Result<(), SceneError> {
        let mut seen = HashMap::with_capacity(self.points.len());
        for (i, x) in self.points.iter().enumerate() {
            // 0 and -0 are the same place.
            if let Some(first) = seen.insert(x.map(|c| (c + 0.0).to_bits()), i) {
                let (line, _) = Place::new(&self.source, "", self.lines[first][0]..0).position();
                let message = format!("the point is that of line {line} again");
                return Err(self.error(i, message, "points must differ: remove one of them"));
            }
        }
        Ok(())
    }
}

/// The labels of regions. Numbers may be written in any way: 1, 1.0.
struct Names {
    all: Vec<String>,
    by_text: HashMap<String, u16>,
    by_value: HashMap<u64, u16>,
}

impl Names {
    fn new(regions: &[RegionSpec]) -> Self {
        let all: Vec<String> = regions.iter().map(|r| r.label.as_ref().unwrap_or(&r.name).clone()).collect();
        let numbers = all.iter().zip(0..).filter_map(|(text, k)| Some((value(text)?, k)));
        let by_value = numbers.collect();
        Self { by_text: all.iter().cloned().zip(0..).collect(), by_value, all }
    }

    fn find(&self, text: &str) -> Option<u16> {
        self.by_text.get(text).or_else(|| self.by_value.get(&value(text)?)).copied()
    }
}

/// What tells one number from another.
fn value(text: &str) -> Option<u64> {
    text.parse::<f64>().ok().filter(|v| v.is_finite()).map(|v| (v + 0.0).to_bits())
}

fn begins_with_number(line: &str) -> bool {
    line.split(',').next().is_some_and(|cell| cell.trim().parse::<f64>().is_ok())
}

/// What a line has, in words.
fn columns(dimension: usize, labelled: bool) -> String {
    let coordinates = ["x", "x, y", "x, y, z"][dimension - 1];
    let label = if labelled { ", region" } else { "" };
    format!("{coordinates}{label}")
}
