//! Problems with smooth solutions on both sides of interfaces that no node lies on, for methods of high order.

mod ball;
mod circle;
mod graded;
mod manufactured;
mod near;
mod quadrants;
mod rings;
mod shapes;

pub use ball::ball_mode;
pub use circle::circle_mode;
pub use graded::graded;
pub use near::two_discs;
pub use quadrants::quadrants;
pub use rings::rings;
pub use shapes::{ellipse, pair, star, torus};

/// Head of a scene on `[-1, 1]^D`, irregular nodes.
fn head(title: &str, dimension: usize, spacing: f64, seed: u64) -> String {
    let corner = |x: f64| vec![format!("{x:?}"); dimension].join(", ");
    format!(
        "title = \"{title}\"\ndimension = {dimension}\n\n[domain]\nbox = {{ min = [{}], max = [{}] }}\n\n\
         [points]\nspacing = {spacing:?}\nlayout = \"irregular\"\nseed = {seed}\n\n",
        corner(-1.0),
        corner(1.0),
    )
}

/// A region; no source where `source` is empty, the background where `geometry` is.
fn region(name: &str, geometry: &str, diffusivity: f64, source: &str, exact: &str) -> String {
    let source = if source.is_empty() { String::new() } else { format!("source = \"{source}\"\n") };
    format!(
        "[[regions]]\nname = \"{name}\"\n{geometry}\ndiffusivity = \"{diffusivity:e}\"\n{source}exact = \"{exact}\"\n\n"
    )
}

fn dirichlet(exact: &str) -> String {
    format!("[[boundaries]]\nface = \"all\"\ndirichlet = \"{exact}\"\n")
}
