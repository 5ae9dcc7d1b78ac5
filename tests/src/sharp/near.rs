//! Two discs close to each other in a field along the line of their centres: in the gap the field is as large as it is thin.

use super::{dirichlet, head, region};

const RADIUS: f64 = 0.3;

/// Images whose strength is below this do not count: what methods are compared with is good to 1e-8.
const NEGLIGIBLE: f64 = 3e-9;

/// Two discs of diffusivity `inside` in 1, at a distance of `gap`, and a slope of 1 along x far away.
///
/// In complex notation a disc at c answers to a field F by `-b conj F(c + a^2/(z - c))`, with `b = (k - 1)/(k + 1)`
/// (Milne-Thomson's circle theorem for two media), and has `(1 - b) F` inside. A dipole `p/(z - s)` is answered by one of
/// strength `b p a^2/(s - c)^2` at `c + a^2/(s - c)` and a constant; to and fro between the discs this makes a series.
pub fn two_discs(inside: f64, gap: f64, spacing: f64, seed: u64) -> String {
    let reflection = (inside - 1.0) / (inside + 1.0);
    let center = RADIUS + 0.5 * gap;
    let dipoles = dipoles(reflection, center);
    let constants = dipoles.iter().map(|&(p, s)| reflection * p / (s + center)).sum::<f64>();
    let constant = (reflection * center + constants) / (1.0 - reflection);
    // Dipoles in the right disc, mirrored those in the left one.
    let sum = |sign: f64| -> String {
        let term = |&(p, s): &(f64, f64)| {
            let x = format!("(x{:+.12})", -sign * s);
            format!("{p:.10e}*{x}/({x}^2 + y^2)")
        };
        dipoles.iter().map(term).collect::<Vec<String>>().join(" + ")
    };
    let outside = format!("x + {} + {}", sum(1.0), sum(-1.0));
    let within = |sign: f64| format!("{:e}*(x + {} + {:e})", 1.0 - reflection, sum(sign), -sign * constant);
    let disc = |x: f64| format!("sphere = {{ center = [{x:?}, 0.0], radius = {RADIUS:?} }}");
    head(&format!("Two discs at a distance of {gap:e}"), 2, spacing, seed)
        + &region("left", &disc(-center), inside, "", &within(1.0))
        + &region("right", &disc(center), inside, "", &within(-1.0))
        + &region("outside", "", 1.0, "", &outside)
        + &dirichlet(&outside)
}

/// Strengths and places of the dipoles in the disc on the right.
fn dipoles(reflection: f64, center: f64) -> Vec<(f64, f64)> {
    let square = RADIUS * RADIUS;
    let mut all = vec![(-reflection * square, center)];
    while let Some(&(p, s)) = all.last() {
        // That of the left disc at -s, seen from the right one.
        let away = s + center;
        let next = (reflection * p * square / (away * away), center - square / away);
        if next.0.abs() < NEGLIGIBLE {
            break;
        }
        all.push(next);
    }
    all
}
