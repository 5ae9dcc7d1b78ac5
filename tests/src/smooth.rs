//! Smooth problems in a box without any interface: what stencils alone reach.

/// `u = exp(x) (cos y) (...)` in the unit box with variable diffusivity; `robin` puts a mixed condition on the right.
pub fn smooth(dimension: usize, spacing: f64, robin: bool) -> String {
    let (exact, source, corner) = match dimension {
        1 => ("sin(2*x)", "4*(1 + x)*sin(2*x) - 2*cos(2*x)", "[1.0]"),
        2 => ("sin(2*x)*cos(y)", "5*(1 + x)*sin(2*x)*cos(y) - 2*cos(2*x)*cos(y)", "[1.0, 1.0]"),
        _ => (
            "sin(2*x)*cos(y)*exp(z)",
            "4*(1 + x)*sin(2*x)*cos(y)*exp(z) - 2*cos(2*x)*cos(y)*exp(z)",
            "[1.0, 1.0, 1.0]",
        ),
    };
    let zeros = vec!["0.0"; dimension].join(", ");
    let tail = exact.replace("sin(2*x)", "");
    // At x = 1: u + eta du/dx with eta = 2.
    let robin = if robin {
        format!(
            "[[boundaries]]\nface = \"right\"\nrobin = {{ a = \"1\", b = \"1\", g = \"(sin(2) + 4*cos(2)){tail}\" }}\n\n"
        )
    } else {
        String::new()
    };
    format!(
        "title = \"smooth\"\ndimension = {dimension}\n\n[domain]\nbox = {{ min = [{zeros}], max = {corner} }}\n\n\
         [points]\nspacing = {spacing:?}\nlayout = \"irregular\"\nseed = 5\n\n\
         [[regions]]\nname = \"all\"\ndiffusivity = \"1 + x\"\nsource = \"{source}\"\nexact = \"{exact}\"\n\n\
         {robin}[[boundaries]]\nface = \"all\"\ndirichlet = \"{exact}\"\n"
    )
}
