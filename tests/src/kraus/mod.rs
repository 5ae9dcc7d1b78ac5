//! The benchmarks of H. Kraus, J. Kuhnert, A. Meister, P. Suchde, "A meshfree point collocation method for elliptic
//! interface problems" (2022), section 3: on `[-1, 1]^2`, clouds that know nothing of the interface.

mod curved;
mod interior;
mod three_strip;
mod two_strip;

pub use curved::curved;
pub use interior::interior;
pub use three_strip::three_strip;
pub use two_strip::two_strip;

/// Interaction radius in units of the spacing: 28 neighbours on average, as many as the paper's clouds have.
pub const SUPPORT: f64 = 3.0;

/// Head of a scene on `[-1, 1]^2`; `h` is the interaction radius.
fn head(title: &str, h: f64, seed: u64) -> String {
    format!(
        "title = \"{title}\"\n\
         dimension = 2\n\n\
         [domain]\n\
         box = {{ min = [-1.0, -1.0], max = [1.0, 1.0] }}\n\n\
         [points]\n\
         spacing = {spacing:?}\n\
         layout = \"irregular\"\n\
         seed = {seed}\n\n",
        spacing = h / SUPPORT,
    )
}

/// A region; `level_set` is `None` for the background, `source` where there is none.
fn region(
    name: &str,
    level_set: Option<&str>,
    diffusivity: f64,
    source: Option<&str>,
    exact: &str,
) -> String {
    let mut text = format!("[[regions]]\nname = \"{name}\"\n");
    if let Some(level_set) = level_set {
        text += &format!("level_set = \"{level_set}\"\n");
    }
    text += &format!("diffusivity = \"{diffusivity:e}\"\n");
    if let Some(source) = source {
        text += &format!("source = \"{source}\"\n");
    }
    text + &format!("exact = \"{exact}\"\n\n")
}

/// u = 2 on the left, u = 1 on the right, no flux through bottom and top.
const STRIP_BOUNDARIES: &str = "\
[[boundaries]]
face = \"left\"
dirichlet = \"2\"

[[boundaries]]
face = \"right\"
dirichlet = \"1\"

[[boundaries]]
face = \"bottom\"
neumann = \"0\"

[[boundaries]]
face = \"top\"
neumann = \"0\"
";
