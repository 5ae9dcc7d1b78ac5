//! Scenes with effects beside diffusion: films and partition coefficients at interfaces, velocities, reactions, capacities.

use std::f64::consts::PI;
use std::fmt::Write as _;

/// What a chosen solution is to have beside diffusion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Effects {
    /// Diffusivity inside over that outside.
    pub contrast: f64,
    /// Resistance of the interface.
    pub resistance: f64,
    /// Partition coefficients inside and outside.
    pub partition: [f64; 2],
    /// Whether there is a velocity.
    pub velocity: bool,
    /// Whether there is a reaction.
    pub reaction: bool,
    /// Whether it is in time, with a capacity on either side.
    pub time: bool,
}

impl Effects {
    /// Nothing but diffusion with a contrast of 10.
    pub const NONE: Self = Self {
        contrast: 10.0,
        resistance: 0.0,
        partition: [1.0; 2],
        velocity: false,
        reaction: false,
        time: false,
    };

    /// All of them, steady.
    pub const ALL: Self =
        Self { resistance: 0.2, partition: [1.0, 2.5], velocity: true, reaction: true, ..Self::NONE };
}

/// A solution that is chosen: expression, gradient, minus the Laplacian.
struct Chosen {
    u: &'static str,
    gradient: [&'static str; 3],
    minus_laplacian: &'static str,
}

const INSIDE: [Chosen; 3] = [
    Chosen { u: "sin(2*x) + 0.3", gradient: ["2*cos(2*x)", "0", "0"], minus_laplacian: "4*sin(2*x)" },
    Chosen {
        u: "sin(x + 2*y) + 0.3",
        gradient: ["cos(x + 2*y)", "2*cos(x + 2*y)", "0"],
        minus_laplacian: "5*sin(x + 2*y)",
    },
    Chosen {
        u: "sin(x + y) + 0.5*z^2",
        gradient: ["cos(x + y)", "cos(x + y)", "z"],
        minus_laplacian: "2*sin(x + y) - 1",
    },
];

const OUTSIDE: [Chosen; 3] = [
    Chosen { u: "cos(2*x)", gradient: ["-2*sin(2*x)", "0", "0"], minus_laplacian: "4*cos(2*x)" },
    Chosen {
        u: "cos(2*x - y)",
        gradient: ["-2*sin(2*x - y)", "sin(2*x - y)", "0"],
        minus_laplacian: "5*cos(2*x - y)",
    },
    Chosen {
        u: "cos(x + y - z)",
        gradient: ["-sin(x + y - z)", "-sin(x + y - z)", "sin(x + y - z)"],
        minus_laplacian: "3*cos(x + y - z)",
    },
];

/// Without sources and sinks, and another one inside than outside.
const VELOCITY: [[&[&str]; 2]; 3] = [
    [&["1.5"], &["-0.5"]],
    [&["1 + y", "0.5 - x"], &["y", "1 - x"]],
    [&["1 + y", "0.5 - x", "0.3"], &["y", "1 - x", "0.2"]],
];

const CENTER: [f64; 3] = [0.05, 0.02, -0.03];
const RADIUS: f64 = 0.5;
const CAPACITIES: [&str; 2] = ["3 + x", "0.5"];
const REACTIONS: [&str; 2] = ["2 + x", "0.7"];
const END: f64 = 0.2;

/// A ball in a box, on either side a solution that is chosen; sources, jumps and values on the boundary are what it calls for.
pub fn chosen(dimension: usize, effects: &Effects, spacing: f64, seed: u64) -> String {
    let sides = [&INSIDE[dimension - 1], &OUTSIDE[dimension - 1]];
    let eta = [effects.contrast, 1.0];
    let decay = if effects.time { "exp(-t)*" } else { "" };
    let (min, max) = (vec![-1.0; dimension], vec![1.0; dimension]);
    let mut text = format!(
        "title = \"Chosen solution with effects\"\ndimension = {dimension}\n[domain]\nbox = {{ min = {min:?}, max = {max:?} }}\n\
         [points]\nspacing = {spacing:?}\nlayout = \"irregular\"\nseed = {seed}\n"
    );
    for (k, name) in ["inside", "outside"].into_iter().enumerate() {
        let Chosen { u, gradient, minus_laplacian } = sides[k];
        let mut source = format!("{:e}*({minus_laplacian})", eta[k]);
        let _ = write!(text, "[[regions]]\nname = \"{name}\"\ndiffusivity = {:e}\n", eta[k]);
        if k == 0 {
            let _ = writeln!(text, "sphere = {{ center = {:?}, radius = {RADIUS} }}", &CENTER[..dimension]);
        }
        if effects.velocity {
            let velocity = VELOCITY[dimension - 1][k];
            let _ = writeln!(text, "velocity = {velocity:?}");
            for (v, slope) in velocity.iter().zip(gradient) {
                source += &format!(" + ({v})*({slope})");
            }
        }
        if effects.reaction {
            let _ = writeln!(text, "reaction = \"{}\"", REACTIONS[k]);
            source += &format!(" + ({})*({u})", REACTIONS[k]);
        }
        if effects.time {
            let _ = writeln!(text, "capacity = \"{}\"", CAPACITIES[k]);
            source += &format!(" - ({})*({u})", CAPACITIES[k]);
        }
        let _ = write!(text, "source = \"{decay}({source})\"\nexact = \"{decay}({u})\"\n");
    }
    let normal = |k: usize| format!("({}-({:?}))/{RADIUS}", ["x", "y", "z"][k], CENTER[k]);
    let flux = |k: usize| {
        let terms = (0..dimension).map(|axis| format!("{}*({})", normal(axis), sides[k].gradient[axis]));
        format!("{:e}*({})", eta[k], terms.collect::<Vec<_>>().join(" + "))
    };
    let ([a, b], resistance) = (effects.partition, effects.resistance);
    let _ = write!(
        text,
        "[[interfaces]]\nbetween = [\"inside\", \"outside\"]\n\
         jump = \"{decay}(({})/{b:?} - ({})/{a:?} - {resistance:e}*({}))\"\n\
         flux_jump = \"{decay}({} - {})\"\n",
        sides[1].u,
        sides[0].u,
        flux(0),
        flux(1),
        flux(0)
    );
    if resistance != 0.0 {
        let _ = writeln!(text, "resistance = {resistance:e}");
    }
    if effects.partition != [1.0; 2] {
        let _ = writeln!(text, "partition = [{a:?}, {b:?}]");
    }
    let _ = write!(text, "[[boundaries]]\nface = \"all\"\ndirichlet = \"{decay}({})\"\n", sides[1].u);
    if effects.time {
        let inside = (0..dimension).map(|k| format!("({}-({:?}))^2", ["x", "y", "z"][k], CENTER[k]));
        let level = inside.collect::<Vec<_>>().join(" + ");
        let radius = RADIUS * RADIUS;
        let tolerance = if dimension == 1 { 1e-7 } else { 1e-5 };
        let _ = write!(
            text,
            "[time]\nend = {END}\ntolerance = {tolerance:e}\ninitial = \"if({level} < {radius}, {}, {})\"\n",
            sides[0].u, sides[1].u
        );
    }
    text
}

/// A conducting disc with a film round it in a plate whose slope is 1 far away; the solution in closed form. `parameter` is the resistance.
pub fn disc_with_film(parameter: f64, spacing: f64, seed: u64) -> String {
    let (radius, eta) = (0.3, 10.0);
    // `A r cos t` inside and `(r + C / r) cos t` outside.
    let slope = 2.0 * radius / (radius * (1.0 + eta) + parameter * eta);
    let dipole = radius * radius * (1.0 - eta * slope);
    let outside = format!("(1 + {dipole:?}/(x^2 + y^2))*x");
    format!(
        "title = \"Disc with a film\"\ndimension = 2\n[domain]\nbox = {{ min = [-1, -1], max = [1, 1] }}\n\
         [points]\nspacing = {spacing:?}\nlayout = \"irregular\"\nseed = {seed}\n\
         [[regions]]\nname = \"disc\"\nsphere = {{ center = [0, 0], radius = {radius} }}\ndiffusivity = {eta}\n\
         exact = \"{slope:?}*x\"\n\
         [[regions]]\nname = \"plate\"\ndiffusivity = 1\nexact = \"{outside}\"\n\
         [[interfaces]]\nbetween = [\"disc\", \"plate\"]\nresistance = {parameter:e}\n\
         [[boundaries]]\nface = \"all\"\ndirichlet = \"{outside}\"\n"
    )
}

/// A square chip that makes 3.6 in all, in a plate whose sides are at 0, with a film round it of this resistance: a problem given by its data. Near its
/// corners, `u ~ r^(2/3)` outside, hardly anything flows through the film.
pub fn chip_behind_a_film(resistance: f64, spacing: f64, seed: u64) -> String {
    format!(
        "title = \"Heated chip behind a film\"\ndimension = 2\n[domain]\nbox = {{ min = [0, 0], max = [1, 1] }}\n\
         [points]\nspacing = {spacing:?}\nlayout = \"irregular\"\nseed = {seed}\n\
         [[regions]]\nname = \"chip\"\nbox = {{ min = [0.2, 0.2], max = [0.8, 0.8] }}\ndiffusivity = 10\nsource = 10\n\
         [[regions]]\nname = \"plate\"\ndiffusivity = 1\n\
         [[interfaces]]\nbetween = [\"chip\", \"plate\"]\nresistance = {resistance:e}\n\
         [[boundaries]]\nface = \"all\"\ndirichlet = 0\n[[probes]]\nat = [0.5, 0.5]\n[[probes]]\nat = [0.1, 0.5]\n"
    )
}

/// Conductivity of a square array of cylinders, conductivity ratio 10 and fraction 0.5, with a contact conductance h on their surfaces: `h a`
/// and the effective conductivity, by the multipole series.
pub const ARRAY_WITH_CONTACT: [(f64, f64); 2] = [(0.1, 0.412_370_237_471), (1.0, 0.953_467_055_150)];

/// A quarter of its cell with 1 and 0 on two sides: the flux through either is half of the effective conductivity times the unit height of the
/// cell, over half of its width. `parameter` is `h a`.
pub fn array_with_contact(parameter: f64, spacing: f64, seed: u64) -> String {
    let radius = (0.5 / PI).sqrt();
    let resistance = radius / parameter;
    format!(
        "title = \"Array of cylinders with contact resistance\"\ndimension = 2\n\
         [domain]\nbox = {{ min = [0, 0], max = [0.5, 0.5] }}\n\
         [points]\nspacing = {spacing:?}\nlayout = \"irregular\"\nseed = {seed}\n\
         [[regions]]\nname = \"cylinder\"\nsphere = {{ center = [0, 0], radius = {radius:?} }}\ndiffusivity = 10\n\
         [[regions]]\nname = \"matrix\"\ndiffusivity = 1\n\
         [[interfaces]]\nbetween = [\"cylinder\", \"matrix\"]\nresistance = {resistance:?}\n\
         [[boundaries]]\nface = \"left\"\ndirichlet = 0\n\
         [[boundaries]]\nface = \"right\"\ndirichlet = 1\n\
         [[boundaries]]\nface = \"all\"\nneumann = 0\n[output]\nfluxes = true\n"
    )
}

/// NAFEMS T3: a bar whose end swings; the value at 0.08 m after 32 s by the series (`tests/references/nafems_t3.py`). The benchmark's target is
/// 36.60.
pub const NAFEMS_T3: f64 = 36.603_115_95;

/// Its scene.
pub fn nafems_t3(spacing: f64) -> String {
    format!(
        "title = \"NAFEMS T3\"\ndimension = 1\n[domain]\nbox = {{ min = [0], max = [0.1] }}\n\
         [points]\nspacing = {spacing:?}\n\
         [[regions]]\nname = \"bar\"\ndiffusivity = 35\ncapacity = \"7200*440.5\"\n\
         [[boundaries]]\nface = \"left\"\ndirichlet = 0\n\
         [[boundaries]]\nface = \"right\"\ndirichlet = \"100*sin(pi*t/40)\"\n\
         [time]\nend = 32\ntolerance = 1e-6\n[[probes]]\nat = [0.08]\n"
    )
}

/// A stream through a wall layer: `u = (exp(P x) - 1) / (exp(P) - 1)` on the unit interval or square, all of it within `1 / P` of the outlet.
/// The Péclet number of a cell is `P` times the spacing.
pub fn stream(dimension: usize, peclet: f64, spacing: f64, seed: u64) -> String {
    let (min, max) = (vec![0.0; dimension], vec![1.0; dimension]);
    let velocity: Vec<f64> = (0..dimension).map(|k| if k == 0 { peclet } else { 0.0 }).collect();
    let exact = format!("(exp({peclet:?}*(x - 1)) - exp(-{peclet:?}))/(1 - exp(-{peclet:?}))");
    let sides = if dimension > 1 { "[[boundaries]]\nface = \"all\"\nneumann = 0\n" } else { "" };
    format!(
        "title = \"A stream and its layer\"\ndimension = {dimension}\n\
         [domain]\nbox = {{ min = {min:?}, max = {max:?} }}\n\
         [points]\nspacing = {spacing:?}\nlayout = \"irregular\"\nseed = {seed}\n\
         [[regions]]\nname = \"all\"\ndiffusivity = 1\nvelocity = {velocity:?}\nexact = \"{exact}\"\n\
         [[boundaries]]\nface = \"left\"\ndirichlet = 0\n[[boundaries]]\nface = \"right\"\ndirichlet = 1\n{sides}"
    )
}

/// Two layers between 0 and 1 with a film in between, as long as 0.5 each: u rises in the film by `resistance q`. In closed form, in any
/// dimension: what a wall of two plates is.
pub fn two_layers(
    dimension: usize,
    eta: [f64; 2],
    resistance: f64,
    partition: [f64; 2],
    spacing: f64,
) -> String {
    let (min, max) = (vec![0.0; dimension], vec![1.0; dimension]);
    let [a, b] = eta;
    let [k, l] = partition;
    // `u_A = q x / a` and `u_B = 1 - q (1 - x) / b`: `u_B / l - u_A / k = R q` at 0.5.
    let flux = (1.0 / l) / (0.5 / (a * k) + 0.5 / (b * l) + resistance);
    let sides = if dimension > 1 { "[[boundaries]]\nface = \"all\"\nneumann = 0\n" } else { "" };
    let mut first_max = max.clone();
    first_max[0] = 0.5;
    format!(
        "title = \"Two layers with a film\"\ndimension = {dimension}\n\
         [domain]\nbox = {{ min = {min:?}, max = {max:?} }}\n[points]\nspacing = {spacing:?}\n\
         [[regions]]\nname = \"first\"\nbox = {{ min = {min:?}, max = {first_max:?} }}\ndiffusivity = {a:e}\n\
         exact = \"{:e}*x\"\n\
         [[regions]]\nname = \"second\"\ndiffusivity = {b:e}\nexact = \"1 - {:e}*(1 - x)\"\n\
         [[interfaces]]\nbetween = [\"first\", \"second\"]\nresistance = {resistance:e}\npartition = [{k:?}, {l:?}]\n\
         [[boundaries]]\nface = \"left\"\ndirichlet = 0\n[[boundaries]]\nface = \"right\"\ndirichlet = 1\n{sides}",
        flux / a,
        flux / b
    )
}
