//! The problems of Y.-C. Yoon and J.-H. Song, "Interface Immersed Particle Difference Method for weak discontinuity in
//! elliptic boundary value problems" (2021), section 3, and a ball in three dimensions.
//!
//! The paper's equation is `div(kappa grad u) = f`; scenes have `-div(kappa grad u) = f`.

mod ball;
mod circle;
mod cylinder;
mod points;
mod slit;
mod wedges;

pub use ball::ball;
pub use circle::circle;
pub use cylinder::{cylinder, cylinder_prescribed};
pub use points::{circle_by_points, cylinder_by_points};
pub use slit::{SlitSetup, crack, slit};
pub use wedges::{corner_45, corner_90};

/// Nodes along an edge of the square in the paper: 20, 40 and 80, which makes 400, 1600 and 6400; and 160.
pub const NODES: [usize; 4] = [20, 40, 80, 160];

/// Layout of the cloud.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Regularity {
    /// The paper's.
    Grid,
    /// Scattered, with a seed.
    Irregular(u64),
}

/// Head of a scene on a square of edge 2 with `nodes` nodes an edge.
fn head(title: &str, min: [f64; 2], nodes: usize, regularity: Regularity) -> String {
    let spacing = 2.0 / (nodes - 1) as f64;
    let [x, y] = min;
    format!(
        "title = \"{title}\"\ndimension = 2\n\n\
         [domain]\nbox = {{ min = [{x:?}, {y:?}], max = [{:?}, {:?}] }}\n\n{}",
        x + 2.0,
        y + 2.0,
        points(spacing, regularity),
    )
}

fn points(spacing: f64, regularity: Regularity) -> String {
    let (layout, seed) = match regularity {
        Regularity::Grid => ("grid", 1),
        Regularity::Irregular(seed) => ("irregular", seed),
    };
    format!("[points]\nspacing = {spacing:?}\nlayout = \"{layout}\"\nseed = {seed}\n\n")
}

fn dirichlet(exact: &str) -> String {
    format!("[[boundaries]]\nface = \"all\"\ndirichlet = \"{exact}\"\n")
}
