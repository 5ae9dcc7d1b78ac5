//! Problems that are given by their data alone: no solution is prescribed, so that nothing is smooth but what nature makes so.
//!
//! Every scene takes a parameter (mostly a diffusivity), a spacing and a seed. Its probes are the points at which
//! [`references`] knows the solution.

pub mod adaptive;
pub mod corners;
pub mod desk;
pub mod plates;
pub mod references;

use std::fmt::Write as _;

/// Head of a scene: title, domain as the lines of its table, nodes.
fn head(title: &str, dimension: usize, domain: &str, spacing: f64, seed: u64) -> String {
    format!(
        "title = \"{title}\"\ndimension = {dimension}\n\n[domain]\n{domain}\n\n\
         [points]\nspacing = {spacing:?}\nlayout = \"irregular\"\nseed = {seed}\n\n"
    )
}

/// A region; the background where `shape` is empty, no source where it is 0.
fn region(name: &str, shape: &str, diffusivity: f64, source: f64) -> String {
    let source = if source == 0.0 { String::new() } else { format!("source = {source:?}\n") };
    format!("[[regions]]\nname = \"{name}\"\n{shape}\ndiffusivity = {diffusivity:e}\n{source}\n")
}

/// A condition: a face and what holds there.
fn condition(face: &str, what: &str) -> String {
    format!("[[boundaries]]\nface = \"{face}\"\n{what}\n\n")
}

/// The probes at which references are known.
fn probes(case: &str, parameter: f64) -> String {
    let mut text = String::new();
    for at in
        references::of(case, parameter).filter(|f| f.quantity == references::Quantity::Value).map(|f| &f.at)
    {
        // Writing to a string cannot fail.
        let _ = write!(text, "[[probes]]\nat = {at:?}\n\n");
    }
    text
}
