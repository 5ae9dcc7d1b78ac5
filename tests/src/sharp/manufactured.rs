//! Solutions that are chosen on both sides of an interface, with the jumps of u and of the flux that this calls for.

use super::region;

/// A chosen solution: the expression, its gradient, and minus its Laplacian.
#[derive(Debug, Clone, Copy)]
pub(super) struct Chosen {
    pub(super) u: &'static str,
    pub(super) gradient: &'static [&'static str],
    pub(super) minus_laplacian: &'static str,
}

/// In the plane, inside.
pub(super) const INSIDE: Chosen = Chosen {
    u: "sin(2*x)*exp(y)",
    gradient: &["2*cos(2*x)*exp(y)", "sin(2*x)*exp(y)"],
    minus_laplacian: "3*sin(2*x)*exp(y)",
};

/// In the plane, in a second inclusion.
pub(super) const BESIDE: Chosen =
    Chosen { u: "x^2 - y^2 + 0.3*x^3", gradient: &["2*x + 0.9*x^2", "-2*y"], minus_laplacian: "-1.8*x" };

/// In the plane, outside.
pub(super) const OUTSIDE: Chosen =
    Chosen { u: "cos(x + y)", gradient: &["-sin(x + y)", "-sin(x + y)"], minus_laplacian: "2*cos(x + y)" };

/// In space, inside.
pub(super) const INSIDE_3D: Chosen = Chosen {
    u: "sin(x)*exp(y)*cos(z)",
    gradient: &["cos(x)*exp(y)*cos(z)", "sin(x)*exp(y)*cos(z)", "-sin(x)*exp(y)*sin(z)"],
    minus_laplacian: "sin(x)*exp(y)*cos(z)",
};

/// In space, outside.
pub(super) const OUTSIDE_3D: Chosen = Chosen {
    u: "cos(x + y - z)",
    gradient: &["-sin(x + y - z)", "-sin(x + y - z)", "sin(x + y - z)"],
    minus_laplacian: "3*cos(x + y - z)",
};

impl Chosen {
    pub(super) fn region(&self, name: &str, geometry: &str, eta: f64) -> String {
        region(name, geometry, eta, &format!("{eta:e}*({})", self.minus_laplacian), self.u)
    }
}

/// The interface between `name`, of diffusivity `eta`, and `outside`, of diffusivity 1; `normal` has the length `length`.
pub(super) fn jumps(
    name: &str,
    (inside, eta): (&Chosen, f64),
    outside: &Chosen,
    normal: &[String],
    length: &str,
) -> String {
    let terms: Vec<String> = (normal.iter().zip(inside.gradient).zip(outside.gradient))
        .map(|((n, i), o)| format!("({n})*(({o}) - {eta:e}*({i}))"))
        .collect();
    format!(
        "[[interfaces]]\nbetween = [\"{name}\", \"outside\"]\njump = \"({}) - ({})\"\nflux_jump = \"({})/({length})\"\n\n",
        outside.u,
        inside.u,
        terms.join(" + "),
    )
}
