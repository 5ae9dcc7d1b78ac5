//! Sources whose potential is known.

use meshless_freespace::{Centring, Mesh, Output};

/// Steepness of the bumps (Hejlesen and Walther 2016, eq. 29).
const C: f64 = 10.0;

/// `f = exp(-c/(1 - q^2))`, `f'/q` and `f''`, all zero from q = 1 on.
fn bump(q2: f64) -> [f64; 3] {
    let u = 1.0 - q2;
    if u <= 0.0 {
        return [0.0; 3];
    }
    let f = (-C / u).exp();
    let slope = -2.0 * C / (u * u);
    [f, slope * f, f * (slope * slope * q2 + slope - 8.0 * C * q2 / u.powi(3))]
}

/// A bump of the stream function in the plane.
#[derive(Debug, Clone, Copy)]
pub(super) struct Field {
    pub(super) height: f64,
    pub(super) centre: [f64; 2],
    pub(super) radius: f64,
}

/// A bump of height 1.
pub(super) fn bump_at(centre: [f64; 2], radius: f64) -> Field {
    Field { height: 1.0, centre, radius }
}

impl Field {
    /// Offset from the centre over the radius, and the bump there.
    fn at(&self, p: [f64; 2]) -> ([f64; 2], [f64; 3]) {
        let q: [f64; 2] = std::array::from_fn(|a| (p[a] - self.centre[a]) / self.radius);
        (q, bump(q[0] * q[0] + q[1] * q[1]))
    }
}

/// Minus the Laplacian of a sum of bumps.
pub(super) fn vorticity(bumps: &[Field], p: [f64; 2]) -> f64 {
    let of = |b: &Field| {
        let [_, slope, second] = b.at(p).1;
        -b.height * (second + slope) / (b.radius * b.radius)
    };
    bumps.iter().map(of).sum()
}

/// Its curl.
pub(super) fn velocity(bumps: &[Field], p: [f64; 2]) -> [f64; 2] {
    bumps.iter().fold([0.0; 2], |sum, b| {
        let (q, [_, slope, _]) = b.at(p);
        let rate = b.height * slope / b.radius;
        [sum[0] + rate * q[1], sum[1] - rate * q[0]]
    })
}

/// The source whose potential is a bump of a radius in space.
pub(super) fn ball_source(radius: f64) -> impl Fn([f64; 3]) -> f64 {
    move |p| {
        let [_, slope, second] = bump(p.iter().map(|x| x * x).sum::<f64>() / (radius * radius));
        -(second + 2.0 * slope) / (radius * radius)
    }
}

/// The gradient of that potential.
pub(super) fn ball_gradient(radius: f64) -> impl Fn([f64; 3]) -> [f64; 3] {
    move |p| {
        let [_, slope, _] = bump(p.iter().map(|x| x * x).sum::<f64>() / (radius * radius));
        p.map(|x| slope * x / (radius * radius))
    }
}

/// Sources, what is asked for, and the fields that should come out.
#[derive(Debug)]
pub(super) struct Problem<const D: usize> {
    pub(super) mesh: Mesh<D>,
    pub(super) sources: Vec<Vec<f64>>,
    pub(super) wanted: Vec<Output>,
    pub(super) exact: Vec<Vec<f64>>,
}

/// Meshes are made of positive numbers here.
fn mesh<const D: usize>(min: [f64; D], max: [f64; D], cells: [usize; D]) -> Result<Mesh<D>, String> {
    Mesh::of_box(min, max, cells, Centring::Cell).map_err(|e| e.to_string())
}

/// The velocity of a circular patch of vorticity whose stream function is a bump of radius 1, section 3.1 in 2-D.
pub(super) fn patch(n: usize) -> Result<Problem<2>, String> {
    let mesh = mesh([-1.0; 2], [1.0; 2], [n; 2])?;
    let at = |[x, y]: [f64; 2]| bump(x * x + y * y);
    Ok(Problem {
        sources: vec![mesh.sample(|p| -(at(p)[2] + at(p)[1]))],
        wanted: (0..2).map(|axis| Output::Curl { axis }).collect(),
        exact: vec![mesh.sample(|p| at(p)[1] * p[1]), mesh.sample(|p| -at(p)[1] * p[0])],
        mesh,
    })
}

/// Radius of the torus and of its core.
pub(super) const RADIUS: f64 = 0.5;

/// Vorticity round the axis of the torus, velocity away from it and along it, and the distance from it. The azimuthal vector potential is a
/// bump, section 3.1 in 3-D.
fn torus_at([x, y, z]: [f64; 3]) -> [f64; 4] {
    let r = x.hypot(y);
    let square = RADIUS * RADIUS;
    let [f, slope, second] = bump(((r - RADIUS).powi(2) + z * z) / square);
    let outward = slope * (r - RADIUS) / square;
    let vorticity = -((second + slope) / square + outward / r - f / (r * r));
    [vorticity, -slope * z / square, outward + f / r, r]
}

/// The vorticity of the torus.
pub(super) fn torus_vorticity(p: [f64; 3]) -> [f64; 3] {
    let [around, _, _, r] = torus_at(p);
    [-p[1] * around / r, p[0] * around / r, 0.0]
}

/// Its velocity.
pub(super) fn torus_velocity(p: [f64; 3]) -> [f64; 3] {
    let [_, away, along, r] = torus_at(p);
    [p[0] * away / r, p[1] * away / r, along]
}

/// The velocity of a torus of vorticity.
pub(super) fn torus(n: usize) -> Result<Problem<3>, String> {
    let mesh =
        mesh([-2.0 * RADIUS, -2.0 * RADIUS, -RADIUS], [2.0 * RADIUS, 2.0 * RADIUS, RADIUS], [n, n, n / 2])?;
    let components = |of: fn([f64; 3]) -> [f64; 3]| (0..3).map(|a| mesh.sample(|p| of(p)[a])).collect();
    Ok(Problem {
        sources: components(torus_vorticity),
        wanted: (0..3).map(|axis| Output::Curl { axis }).collect(),
        exact: components(torus_velocity),
        mesh,
    })
}

/// The potential `prod exp(10 (1 - 1/(1 - xi^2)))` on the unit box, for comparison with another code.
pub(super) fn product<const D: usize>(n: usize) -> Result<Problem<D>, String> {
    let mesh = mesh([0.0; D], [1.0; D], [n; D])?;
    let factors = |p: [f64; D]| p.map(|x| bump((2.0 * x - 1.0).powi(2)).map(|v| v * C.exp()));
    let potential = |p: [f64; D]| factors(p).iter().map(|f| f[0]).product::<f64>();
    let source = |p: [f64; D]| {
        let factors = factors(p);
        // d^2/dx^2 = 4 d^2/dxi^2
        let second = |a: usize| {
            let others = (0..D).filter(|b| *b != a).map(|b| factors[b][0]).product::<f64>();
            -4.0 * factors[a][2] * others
        };
        (0..D).map(second).sum::<f64>()
    };
    Ok(Problem {
        sources: vec![mesh.sample(source)],
        wanted: vec![Output::Potential { source: 0 }],
        exact: vec![mesh.sample(potential)],
        mesh,
    })
}
