//! Problems that change with time and whose solution is known.

/// `u = exp(-pi^2 eta t) sin(pi x)` on the unit interval or square, u = 0 at both ends, insulated on the other sides.
pub fn slab(dimension: usize, spacing: f64, tolerance: f64) -> String {
    let eta = 0.3;
    let rate = eta * std::f64::consts::PI.powi(2);
    format!(
        "title = \"Slab\"\ndimension = {dimension}\n{}[points]\nspacing = {spacing}\nseed = 1\n\n\
         [[regions]]\nname = \"slab\"\ndiffusivity = {eta}\nexact = \"exp(-{rate}*t)*sin(pi*x)\"\n\n{}\
         [time]\nend = 0.4\ntolerance = {tolerance}\ninitial = \"sin(pi*x)\"\n\n",
        unit_box(dimension),
        ends_at_zero(dimension)
    )
}

/// A ball of radius 1 that cools from `sin(pi r)/r` by its surface at 0: `u = exp(-pi^2 t) sin(pi r)/r`.
pub fn ball(spacing: f64, tolerance: f64) -> String {
    let shape = "if(x^2 + y^2 + z^2 < 1e-12, pi, sin(pi*sqrt(x^2 + y^2 + z^2))/sqrt(x^2 + y^2 + z^2))";
    format!(
        "title = \"Ball\"\ndimension = 3\n[domain]\nsphere = {{ center = [0.0, 0.0, 0.0], radius = 1.0 }}\n\n\
         [points]\nspacing = {spacing}\nseed = 1\n\n\
         [[regions]]\nname = \"ball\"\ndiffusivity = 1\nexact = \"exp(-pi^2*t)*{shape}\"\n\n\
         [[boundaries]]\nface = \"all\"\ndirichlet = 0\n\n\
         [time]\nend = 0.1\ntolerance = {tolerance}\ninitial = \"{shape}\"\n"
    )
}

/// Two materials in contact at x = 0.4: the slowest mode of a slab whose ends are kept at 0.
///
/// With `k_i = sqrt(rate/eta_i)`, u is `sin(k_1 x)` on the left and `B sin(k_2 (1 - x))` on the right, times
/// `exp(-rate t)`; continuity of u and of the flux at the contact determine B and the rate.
pub fn composite(dimension: usize, spacing: f64, contrast: f64, tolerance: f64) -> String {
    let (a, eta) = (0.4, [1.0, contrast]);
    let rate = composite_rate(a, eta);
    let k = eta.map(|eta| (rate / eta).sqrt());
    let b = (k[0] * a).sin() / (k[1] * (1.0 - a)).sin();
    let (left, right) = (format!("sin({}*x)", k[0]), format!("{b}*sin({}*(1 - x))", k[1]));
    format!(
        "title = \"Composite slab\"\ndimension = {dimension}\n{}[points]\nspacing = {spacing}\nseed = 1\n\n\
         [[regions]]\nname = \"left\"\nlevel_set = \"x - {a}\"\ndiffusivity = 1\nexact = \"exp(-{rate}*t)*{left}\"\n\n\
         [[regions]]\nname = \"right\"\ndiffusivity = {contrast:e}\nexact = \"exp(-{rate}*t)*{right}\"\n\n{}\
         [time]\nend = {}\ntolerance = {tolerance}\ninitial = \"if(x < {a}, {left}, {right})\"\n\n",
        unit_box(dimension),
        ends_at_zero(dimension),
        1.0 / rate,
    )
}

/// A slab at 0 whose left end is put to 1 at t = 0.1: `u = 1 - x - sum_n 2/(n pi) exp(-(n pi)^2 eta (t - 0.1)) sin(n pi x)`.
pub fn switched(dimension: usize, spacing: f64, tolerance: f64) -> String {
    use std::f64::consts::PI;
    let eta = 0.3;
    let mode = |n: u32| {
        let k = f64::from(n) * PI;
        format!(" - {}*exp(-{}*(t - 0.1))*sin({k}*x)", 2.0 / k, k * k * eta)
    };
    let exact = (1..=8).map(mode).fold("1 - x".to_owned(), |text, mode| text + &mode);
    let ends = ends_at_zero(dimension).replacen("dirichlet = 0", "dirichlet = \"if(t < 0.1, 0, 1)\"", 1);
    format!(
        "title = \"Switched\"\ndimension = {dimension}\n{}[points]\nspacing = {spacing}\nseed = 1\n\n\
         [[regions]]\nname = \"slab\"\ndiffusivity = {eta}\nexact = \"{exact}\"\n\n{ends}\
         [time]\nend = 0.4\ntolerance = {tolerance}\n\n",
        unit_box(dimension),
    )
}

/// Another quadratic polynomial on each side of a slanted plane, each with its own factor in time: u and its flux jump by what
/// depends on time and place. Exact in space for fits of degree 2.
pub fn driven_contact(tolerance: f64) -> String {
    let first = "cos(3*t)*(x^2 + 2*x + y)";
    let second = "(1 + sin(2*t))*(x*y - y^2)";
    let side = "x + 0.5*y - 0.72";
    let (nx, ny) = (1.0 / 1.25_f64.sqrt(), 0.5 / 1.25_f64.sqrt());
    let both = |a: &str, b: &str| format!("if({side} < 0, {a}, {b})");
    format!(
        "title = \"Driven contact\"\ndimension = 2\n{}[points]\nspacing = 0.1\nseed = 1\n\n\
         [[regions]]\nname = \"first\"\nlevel_set = \"{side}\"\ndiffusivity = 1\n\
         source = \"-3*sin(3*t)*(x^2 + 2*x + y) - 2*cos(3*t)\"\nexact = \"{first}\"\n\n\
         [[regions]]\nname = \"second\"\ndiffusivity = 10\n\
         source = \"2*cos(2*t)*(x*y - y^2) + 20*(1 + sin(2*t))\"\nexact = \"{second}\"\n\n\
         [[interfaces]]\nbetween = [\"first\", \"second\"]\njump = \"{second} - {first}\"\n\
         flux_jump = \"10*(1 + sin(2*t))*({nx}*y + {ny}*(x - 2*y)) - cos(3*t)*({nx}*(2*x + 2) + {ny})\"\n\n\
         [[boundaries]]\nface = \"top\"\nneumann = \"{}\"\n\n\
         [[boundaries]]\nface = \"all\"\ndirichlet = \"{}\"\n\n\
         [time]\nend = 1.0\ntolerance = {tolerance}\ninitial = \"{}\"\n\n",
        unit_box(2),
        both("cos(3*t)", "(1 + sin(2*t))*(x - 2*y)"),
        both(first, second),
        both("x^2 + 2*x + y", "x*y - y^2"),
    )
}

/// What `growing` asks of a method.
#[derive(Debug, Clone, Copy)]
pub struct Growing {
    /// The second region has another diffusivity; `None` for one region.
    pub second: Option<f64>,
    /// Jump of u at the interface.
    pub jump: f64,
    /// Factor of the square of x in the first region.
    pub square: f64,
}

/// A field that is polynomial in space, linear or quadratic in the first region and linear in the second, times `1 + t`: sources,
/// jumps and conditions of every kind depend on t. On a grid with the interface halfway between two columns of nodes.
pub fn growing(Growing { second, jump, square }: Growing) -> String {
    let at = 0.45;
    let slope = 0.7;
    let first = format!("(1 + 2*x + 0.5*y + {square}*x^2)");
    let beyond = format!("({} + 0.5*y + {slope}*(x - {at}))", 1.0 + 2.0 * at + square * at * at + jump);
    let eta = second.unwrap_or(1.0);
    let value = match second {
        Some(_) => format!("if(x < {at}, {first}, {beyond})"),
        None => first.clone(),
    };
    // At the right end: u, and eta times its slope there.
    let (end, flux) = match second {
        Some(_) => (beyond.clone(), eta * slope),
        None => (first.clone(), 2.0 + 2.0 * square),
    };
    let regions = format!(
        "[[regions]]\nname = \"first\"\n{}diffusivity = 1\nsource = \"{first} - 2*{square}*(1 + t)\"\n\
         exact = \"(1 + t)*{first}\"\n\n{}",
        if second.is_some() { format!("level_set = \"x - {at}\"\n") } else { String::new() },
        match second {
            None => String::new(),
            Some(_) => format!(
                "[[regions]]\nname = \"second\"\ndiffusivity = {eta}\nsource = \"{beyond}\"\n\
                 exact = \"(1 + t)*{beyond}\"\n\n[[interfaces]]\nbetween = [\"first\", \"second\"]\n{}\
                 flux_jump = \"{}*(1 + t)\"\n\n",
                if jump == 0.0 { String::new() } else { format!("jump = \"{jump}*(1 + t)\"\n") },
                eta * slope - 2.0 - 2.0 * square * at,
            ),
        }
    );
    format!(
        "title = \"Growing\"\ndimension = 2\n{}[points]\nspacing = 0.1\nlayout = \"grid\"\n\n{regions}\
         [[boundaries]]\nface = \"right\"\nrobin = {{ a = 1, b = 1, g = \"(1 + t)*({end} + {flux})\" }}\n\n\
         [[boundaries]]\nface = \"top\"\nneumann = \"0.5*(1 + t)\"\n\n\
         [[boundaries]]\nface = \"bottom\"\nflux = \"if(x < {at}, -0.5, {})*(1 + t)\"\n\n\
         [[boundaries]]\nface = \"left\"\ndirichlet = \"(1 + t)*{first}\"\n\n\
         [time]\nend = 1.0\ntolerance = 1e-3\ninitial = \"{value}\"\n\n",
        unit_box(2),
        -0.5 * eta,
    )
}

/// The smallest positive rate at which `eta_1 k_1 cot(k_1 a) + eta_2 k_2 cot(k_2 (1 - a))` vanishes, by bisection: the
/// sum falls from infinity to minus infinity between 0 and the first pole of either term.
fn composite_rate(a: f64, eta: [f64; 2]) -> f64 {
    let lengths = [a, 1.0 - a];
    let excess = |rate: f64| -> f64 {
        (0..2)
            .map(|i| {
                let k = (rate / eta[i]).sqrt();
                eta[i] * k / (k * lengths[i]).tan()
            })
            .sum()
    };
    let pole = |i: usize| eta[i] * (std::f64::consts::PI / lengths[i]).powi(2);
    root(excess, 0.0, pole(0).min(pole(1)))
}

/// The root between two poles of a function that falls, by bisection.
fn root(excess: impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if excess(middle) > 0.0 { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// A stiff core between two layers whose ends are kept at 0, at x = 0.3 and 0.7: the slowest mode. Nothing but the layers holds
/// the core, so that it floats where it is stiff enough.
///
/// With `k_i = sqrt(rate/eta_i)`, u is `sin(k_2 x)` on the left and `B cos(k_1 (x - 1/2))` in the core, times `exp(-rate t)`.
pub fn sandwich(dimension: usize, spacing: f64, contrast: f64, tolerance: f64) -> String {
    let (a, b) = (0.3, 0.2);
    let excess = |rate: f64| {
        let (core, layer) = ((rate / contrast).sqrt(), rate.sqrt());
        layer / (layer * a).tan() - contrast * core * (core * b).tan()
    };
    let poles = [(std::f64::consts::PI / a).powi(2), contrast * (std::f64::consts::FRAC_PI_2 / b).powi(2)];
    let rate = root(excess, 0.0, poles[0].min(poles[1]));
    let (core, layer) = ((rate / contrast).sqrt(), rate.sqrt());
    let top = (layer * a).sin() / (core * b).cos();
    let (side, middle) = (format!("sin({layer}*min(x, 1 - x))"), format!("{top}*cos({core}*(x - 0.5))"));
    format!(
        "title = \"Sandwich\"\ndimension = {dimension}\n{}[points]\nspacing = {spacing}\nseed = 1\n\n\
         [[regions]]\nname = \"core\"\nlevel_set = \"abs(x - 0.5) - {b}\"\ndiffusivity = {contrast:e}\n\
         exact = \"exp(-{rate}*t)*{middle}\"\n\n\
         [[regions]]\nname = \"layers\"\ndiffusivity = 1\nexact = \"exp(-{rate}*t)*{side}\"\n\n{}\
         [time]\nend = {}\ntolerance = {tolerance}\ninitial = \"if(abs(x - 0.5) < {b}, {middle}, {side})\"\n\n",
        unit_box(dimension),
        ends_at_zero(dimension),
        1.0 / rate,
    )
}

/// `u = cos(3 t) (x^2 + 2 x + y)`: exact in space for stencils of degree 2. Source, boundary values, Robin data and the
/// diffusivity depend on time.
pub fn driven(tolerance: f64) -> String {
    let eta = "(1 + 0.5*sin(t))";
    format!(
        "title = \"Driven\"\ndimension = 2\n[domain]\nbox = {{ min = [0.0, 0.0], max = [1.0, 1.0] }}\n\n\
         [points]\nspacing = 0.1\nseed = 1\n\n\
         [[regions]]\nname = \"square\"\ndiffusivity = \"{eta}\"\n\
         source = \"-3*sin(3*t)*(x^2 + 2*x + y) - 2*{eta}*cos(3*t)\"\nexact = \"cos(3*t)*(x^2 + 2*x + y)\"\n\n\
         [[boundaries]]\nface = \"right\"\nrobin = {{ a = 1, b = 1, g = \"cos(3*t)*(3 + y) + {eta}*cos(3*t)*4\" }}\n\n\
         [[boundaries]]\nface = \"top\"\nneumann = \"cos(3*t)\"\n\n\
         [[boundaries]]\nface = \"all\"\ndirichlet = \"cos(3*t)*(x^2 + 2*x + y)\"\n\n\
         [method]\nname = \"gfdm-classical\"\n\n\
         [time]\nend = 1.0\ntolerance = {tolerance}\ninitial = \"x^2 + 2*x + y\"\n\n"
    )
}

fn unit_box(dimension: usize) -> String {
    let corner = |x: &str| vec![x; dimension].join(", ");
    format!("[domain]\nbox = {{ min = [{}], max = [{}] }}\n\n", corner("0.0"), corner("1.0"))
}

fn ends_at_zero(dimension: usize) -> String {
    let mut text = "[[boundaries]]\nface = \"left\"\ndirichlet = 0\n\n[[boundaries]]\nface = \"right\"\ndirichlet = 0\n\n"
        .to_owned();
    if dimension > 1 {
        text += "[[boundaries]]\nface = \"all\"\nneumann = 0\n\n";
    }
    text
}
