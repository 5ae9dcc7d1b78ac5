//! Surfaces of triangles as STL files: a sphere of any fineness, and the gear of the examples.

/// Triangles of a surface.
pub type Triangles = Vec<[[f64; 3]; 3]>;

/// A binary STL file.
pub fn binary(triangles: &Triangles) -> Vec<u8> {
    let mut bytes = vec![b' '; 80];
    bytes.extend((triangles.len() as u32).to_le_bytes());
    for triangle in triangles {
        bytes.extend([0; 12]);
        triangle.iter().flatten().for_each(|&c| bytes.extend((c as f32).to_le_bytes()));
        bytes.extend([0; 2]);
    }
    bytes
}

/// The same as ASCII.
pub fn ascii(triangles: &Triangles) -> String {
    let facet = |t: &[[f64; 3]; 3]| {
        let vertices: String = t.iter().map(|v| format!("vertex {} {} {}\n", v[0], v[1], v[2])).collect();
        format!("facet normal 0 0 0\nouter loop\n{vertices}endloop\nendfacet\n")
    };
    format!("solid part\n{}endsolid part\n", triangles.iter().map(facet).collect::<String>())
}

/// An octahedron whose triangles were divided by four `times` times, with vertices on the unit sphere.
pub fn sphere(times: usize) -> Triangles {
    let mut triangles: Triangles = (0..8)
        .map(|octant| {
            let sign = |k: usize| if octant >> k & 1 == 0 { 1.0 } else { -1.0 };
            let [a, b, c] = [[sign(0), 0.0, 0.0], [0.0, sign(1), 0.0], [0.0, 0.0, sign(2)]];
            if sign(0) * sign(1) * sign(2) > 0.0 { [a, b, c] } else { [b, a, c] }
        })
        .collect();
    let middle = |a: &[f64; 3], b: &[f64; 3]| {
        let sum: [f64; 3] = std::array::from_fn(|k| a[k] + b[k]);
        let length = sum.iter().map(|c| c * c).sum::<f64>().sqrt();
        sum.map(|c| c / length)
    };
    for _ in 0..times {
        triangles = triangles
            .iter()
            .flat_map(|[a, b, c]| {
                let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
                [[*a, ab, ca], [ab, *b, bc], [ca, bc, *c], [ab, bc, ca]]
            })
            .collect();
    }
    triangles
}

/// The gear of `examples/gear.stl`: twelve teeth between radii of 24 and 30, a bore of radius 10, 10 thick.
pub fn gear() -> Triangles {
    let outline: Vec<(f64, f64)> = (0..12)
        .flat_map(|tooth| {
            [(24.0, -10.0), (30.0, -5.0), (30.0, 5.0), (24.0, 10.0)]
                .map(|(radius, degrees)| (radius, f64::to_radians(30.0 * f64::from(tooth) + degrees)))
        })
        .collect();
    let n = outline.len();
    let at = |radius: f64, angle: f64, z: f64| [radius * angle.cos(), radius * angle.sin(), z];
    let outer = |i: usize, z: f64| at(outline[i % n].0, outline[i % n].1, z);
    let bore = |i: usize, z: f64| at(10.0, outline[i % n].1, z);
    let mut triangles = Vec::new();
    let mut square = |a, b, c, d| triangles.extend([[a, b, c], [a, c, d]]);
    for i in 0..n {
        square(outer(i, 0.0), outer(i + 1, 0.0), outer(i + 1, 10.0), outer(i, 10.0));
        square(bore(i + 1, 0.0), bore(i, 0.0), bore(i, 10.0), bore(i + 1, 10.0));
        square(bore(i, 10.0), outer(i, 10.0), outer(i + 1, 10.0), bore(i + 1, 10.0));
        square(bore(i + 1, 0.0), outer(i + 1, 0.0), outer(i, 0.0), bore(i, 0.0));
    }
    triangles
}

/// The unit ball with a Robin condition that knows the sphere's normal, from `shape` (such as `stl = "ball.stl"`).
pub fn heated_ball(shape: &str, spacing: f64) -> String {
    format!(
        "title = \"Ball\"\ndimension = 3\n[domain]\n{shape}\n[points]\nspacing = {spacing}\n\
         [[regions]]\nname = \"ball\"\ndiffusivity = 1\nsource = \"-exp(x) - exp(y)\"\nexact = \"exp(x) + exp(y)\"\n\
         [[boundaries]]\nface = \"outer\"\n\
         robin = {{ a = 1, b = 1, g = \"exp(x) + exp(y) + (x*exp(x) + y*exp(y))/sqrt(x^2 + y^2 + z^2)\" }}\n"
    )
}

/// A ball of radius 0.6 and diffusivity 1 in a cube of diffusivity 100, heated throughout, from `shape`; the flux is
/// continuous, or with `jump` it jumps by 3.
pub fn inclusion(shape: &str, spacing: f64, jump: bool) -> String {
    let (strength, flux) = if jump {
        // A source on the sphere: 3 = -100 du/dr of 0.0108/r.
        ("+ 0.36*0.99 - 0.0108/0.6 + 0.0108/sqrt(x^2 + y^2 + z^2 + 1e-30)", "flux_jump = -3\n")
    } else {
        ("+ 0.36*0.99", "")
    };
    let outer = format!("(x^2 + y^2 + z^2)/100 {strength}");
    let interface =
        if jump { format!("[[interfaces]]\nbetween = [\"ball\", \"cube\"]\n{flux}") } else { String::new() };
    format!(
        "title = \"Inclusion\"\ndimension = 3\n[domain]\nbox = {{ min = [-1, -1, -1], max = [1, 1, 1] }}\n\
         [points]\nspacing = {spacing}\n\
         [[regions]]\nname = \"ball\"\n{shape}\ndiffusivity = 1\nsource = -6\nexact = \"x^2 + y^2 + z^2\"\n\
         [[regions]]\nname = \"cube\"\ndiffusivity = 100\nsource = -6\nexact = \"{outer}\"\n{interface}\
         [[boundaries]]\nface = \"all\"\ndirichlet = \"{outer}\"\n[method]\nname = \"particle-difference\"\n"
    )
}
