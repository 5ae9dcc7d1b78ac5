//! A file from which a stopped run goes on, bit for bit.

use std::fmt::Write;
use std::path::PathBuf;
use std::time::Duration;

use meshless_output::write_text_atomically;
use meshless_time::{Past, Spell, State};

use super::Frame;
use crate::Error;
use crate::plan::Plan;
use crate::scene::Scene;

/// First line of the file.
const HEADER: &str = "meshless checkpoint 2";

/// Where a run leaves what it has reached, and how often.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Checkpoint {
    /// The file. If it exists the run goes on from it.
    pub path: PathBuf,
    /// Least time between two writes.
    pub every: Duration,
}

/// What a file holds.
pub(super) struct Kept {
    pub(super) state: State,
    pub(super) frames: Vec<Frame>,
}

impl Checkpoint {
    /// Reads the file, if there is one.
    pub(super) fn read(&self, scene: &Scene, plan: &Plan, nodes: usize) -> Result<Option<Kept>, Error> {
        let refuse = |reason: String| Error::Checkpoint { path: self.path.clone(), reason };
        let text = match std::fs::read_to_string(&self.path) {
            Ok(text) => text,
            Err(e) if e.kind() == std::io::ErrorKind::NotFound => return Ok(None),
            Err(e) => return Err(refuse(e.to_string())),
        };
        let mut lines = text.lines();
        if lines.next() != Some(HEADER) {
            return Err(refuse("it is no checkpoint of this version".to_owned()));
        }
        if lines.next() != Some(&digest(scene, plan)) {
            return Err(refuse(
                "it is of another scene or method; name another file, or remove it to start anew".to_owned(),
            ));
        }
        let kept = parse(&mut lines).filter(|kept| kept.state.u.len() == nodes);
        kept.map(Some).ok_or_else(|| refuse("it is damaged; remove it to start anew".to_owned()))
    }

    /// Writes the file; it is complete or as before.
    pub(super) fn write(
        &self,
        scene: &Scene,
        plan: &Plan,
        state: &State,
        frames: &[Frame],
    ) -> Result<(), Error> {
        let State { t, step, u, slope, scale, steps, rejected, past } = state;
        let mut text = format!("{HEADER}\n{}\n{steps} {rejected} {}\n", digest(scene, plan), frames.len());
        let mut line = |values: &mut dyn Iterator<Item = f64>| {
            for value in values {
                // Writing to a string cannot fail.
                let _ = write!(text, "{:016x} ", value.to_bits());
            }
            text.push('\n');
        };
        line(&mut [*t, *step, *scale, past.before, past.since].into_iter());
        line(&mut u.iter().copied());
        line(&mut slope.iter().copied());
        line(&mut past.disturbance.iter().copied());
        line(&mut past.spells.iter().flat_map(|spell| [spell.since, spell.step, spell.count]));
        for frame in frames {
            line(&mut std::iter::once(frame.t).chain(frame.u.iter().copied()));
        }
        text.push_str("end\n");
        Ok(write_text_atomically(&self.path, &text)?)
    }
}

/// What tells one run from another: the text of the scene, and what may have been put in its place.
fn digest(scene: &Scene, plan: &Plan) -> String {
    let place = &scene.points.place;
    // A file of points was read a moment ago.
    let points = scene.points.file.as_ref().and_then(|file| file.text().ok()).unwrap_or_default().1;
    let parts = format!("{}\n{}\n{:?}{points}", place.source_text(), scene.points.spacing.text, plan.method);
    // FNV-1a, 64 bit.
    let hash = parts
        .bytes()
        .fold(0xcbf2_9ce4_8422_2325_u64, |h, b| (h ^ u64::from(b)).wrapping_mul(0x0100_0000_01b3));
    format!("scene {hash:016x}")
}

fn parse<'a>(lines: &mut impl Iterator<Item = &'a str>) -> Option<Kept> {
    let counts: Vec<usize> = lines.next()?.split_whitespace().map_while(|n| n.parse().ok()).collect();
    let [steps, rejected, count] = counts[..] else { return None };
    let mut numbers = || -> Option<Vec<f64>> {
        let bits = |word: &str| u64::from_str_radix(word, 16).ok().map(f64::from_bits);
        lines.next()?.split_whitespace().map(bits).collect()
    };
    let [t, step, scale, before, since] = numbers()?[..] else { return None };
    let (u, slope, disturbance, spells) = (numbers()?, numbers()?, numbers()?, numbers()?);
    let spell = |&[since, step, count]: &[f64; 3]| Spell { since, step, count };
    let (spells, rest) = spells.as_chunks();
    let past = Past { disturbance, before, since, spells: spells.iter().map(spell).collect() };
    let mut frames = Vec::with_capacity(count);
    for _ in 0..count {
        let mut values = numbers()?;
        if values.len() != u.len() + 1 {
            return None;
        }
        frames.push(Frame { t: values.remove(0), u: values });
    }
    let complete = lines.next()? == "end"
        && slope.len() == u.len()
        && (past.disturbance.is_empty() || past.disturbance.len() == u.len())
        && rest.is_empty();
    let state = State { t, step, u, slope, scale, steps, rejected, past };
    complete.then_some(Kept { state, frames })
}
