//! Scenes in free space, from text to report.

use meshless::plan::{Plan, Stage};
use meshless::report::Report;
use meshless::scene::Scene;
use meshless::{Error, Silent, execute};

const CHARGE: &str = include_str!("../../examples/charge.toml");
const RING: &str = include_str!("../../examples/vortex_ring.toml");

fn solve(scene: &Scene) -> Report {
    let plan = Plan::new(scene).expect("a plan");
    execute(scene, &plan, &mut Silent).expect("a solution").report
}

fn parse(text: &str) -> Scene {
    Scene::parse(text, "scene.toml").expect("a scene")
}

fn relative(report: &Report) -> f64 {
    report.errors.as_ref().expect("an exact solution").l2
}

#[test]
fn a_charge_has_its_potential_and_a_plan_without_a_system() {
    let scene = parse(CHARGE);
    let plan = Plan::new(&scene).expect("a plan");
    assert_eq!(plan.solver_name(), "fft");
    assert!(plan.runs(Stage::Source) && !plan.runs(Stage::Neighbors) && !plan.runs(Stage::Assembly));
    assert_eq!(plan.predicted.unknowns, 110.0 * 110.0);
    let report = solve(&scene);
    let error = relative(&report);
    assert!(error < 1e-9, "{error:e}");
    assert!(report.errors.as_ref().is_some_and(|e| e.gradient_linf < 1e-8));
    // The estimate is about the error, and no less than a tenth of it.
    let estimate = report.estimate.l2.expect("an estimate");
    assert!(estimate < 1e-7 && estimate > 0.1 * error, "{estimate:e} for {error:e}");
    // At the centre, which is no point of the mesh, and outside of the box.
    let value = |k: usize| report.probes[k].value.expect("a value");
    assert!((value(0) / (-10.0_f64).exp() - 1.0).abs() < 1e-9, "{}", value(0));
    assert!(value(1).abs() < 1e-9 * value(0), "{:e}", value(1));
}

#[test]
fn orders_kernels_and_tolerances_are_obeyed() {
    let with = |section: &str| relative(&solve(&parse(&format!("{CHARGE}\n{section}"))));
    let [second, sixth] =
        ["order = 2", "order = 6"].map(|o| with(&format!("[method]\nname = \"free-space\"\n{o}")));
    assert!(second > 1e-3 && sixth < 1e-2 * second, "{second:e} {sixth:e}");
    for kernel in ["spectral", "truncated"] {
        assert!(with(&format!("[method]\nkernel = \"{kernel}\"\n")) < 1e-9);
    }
    let wider = with("[method]\norder = 6\nsigma = 2\n");
    assert!(sixth < 0.2 * wider);
    let coarse = CHARGE.replace("spacing = 0.02", "spacing = 0.2");
    for tolerance in [1e-3, 1e-7] {
        let report = solve(&parse(&format!("{coarse}\n[accuracy]\ntolerance = {tolerance:e}\n")));
        assert!(relative(&report) < 2.0 * tolerance, "{tolerance:e}: {:e}", relative(&report));
    }
}

#[test]
fn the_diffusivity_divides_and_a_cut_source_has_no_estimate() {
    let twice = solve(&parse(&CHARGE.replace("diffusivity = 1", "diffusivity = 2")));
    let once = solve(&parse(CHARGE));
    let value = |r: &Report| r.probes[0].value.expect("a value");
    assert!((value(&twice) / value(&once) - 0.5).abs() < 1e-12);
    let cut = solve(&parse(&CHARGE.replace("-1.1, -1.1", "-0.3, -1.1")));
    assert!(cut.estimate.l2.is_none());
    assert!(cut.estimate.why_not.is_some_and(|why| why.contains("edge of the box")));
}

#[test]
fn particles_come_from_a_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let text = r#"
title = "Two charges"
dimension = 3
[domain]
free_space = { min = [-1.0, -1.0, -1.0], max = [1.0, 1.0, 1.0] }
[points]
spacing = 0.1
[[regions]]
name = "space"
diffusivity = 1
[particles]
file = "charges.csv"
[[probes]]
at = [0.0, 3.0, 0.0]
"#;
    let path = folder.path().join("scene.toml");
    std::fs::write(&path, text).expect("written");
    let scene = Scene::read(&path).expect("a scene");
    let plan = Plan::new(&scene).expect("a plan");
    let missing = execute(&scene, &plan, &mut Silent).expect_err("no file");
    assert!(missing.is_input() && missing.to_string().contains("charges.csv"));
    std::fs::write(folder.path().join("charges.csv"), "x,y,z,strength\n0.31,0.02,0.1,1.0\n-0.3, 0, 0, 2\n")
        .expect("written");
    let report = solve(&scene);
    let distance = |x: f64, y: f64, z: f64| (x * x + (3.0 - y) * (3.0 - y) + z * z).sqrt();
    let exact =
        (1.0 / distance(0.31, 0.02, 0.1) + 2.0 / distance(-0.3, 0.0, 0.0)) / (4.0 * std::f64::consts::PI);
    let value = report.probes[0].value.expect("a value");
    // Moments up to 4 are kept, and the fifth is small from afar.
    assert!((value / exact - 1.0).abs() < 1e-6, "{value} for {exact}");
    // The field is read back at the particles by the weights that they were deposited with.
    std::fs::write(&path, text.to_owned() + "[output]\ncsv = true\n").expect("written");
    let with_file = Scene::read(&path).expect("a scene");
    let plan = Plan::new(&with_file).expect("a plan");
    let solution = execute(&with_file, &plan, &mut Silent).expect("a solution");
    let particles = solution.particles.as_ref().expect("particles");
    assert_eq!(particles.strengths, [1.0, 2.0]);
    // Each is in the field of the other one, and in its own, which is that of a ball of about a cell.
    let between = 1.0 / (4.0 * std::f64::consts::PI * distance_of(&particles.positions));
    let own = |i: usize| (particles.u[i] - between * particles.strengths[1 - i]) / particles.strengths[i];
    assert!((own(0) / own(1) - 1.0).abs() < 0.05 && own(0) > between, "{} {} {between}", own(0), own(1));
    // Forces between them are opposite, up to what each does to itself where it does not lie as the other one.
    let gradient = particles.gradient.as_ref().expect("a gradient");
    assert!(gradient[0][0] < 0.0 && gradient[1][0] > 0.0, "{gradient:?}");
    let files = meshless::write_outputs(&plan, &solution, folder.path(), "two").expect("files");
    assert_eq!(files.len(), 2);
    let table = std::fs::read_to_string(folder.path().join("two-particles.csv")).expect("a file");
    let lines: Vec<&str> = table.lines().collect();
    assert_eq!(lines[0], "x,y,z,strength,u,gradient_x,gradient_y,gradient_z");
    let numbers: Vec<f64> = lines[2].split(',').map(|cell| cell.parse().expect("a number")).collect();
    assert_eq!(numbers[..5], [-0.3, 0.0, 0.0, 2.0, particles.u[1]]);
    assert_eq!(lines.len(), 3);
    std::fs::write(folder.path().join("charges.csv"), "0.31,0.02,1.0\n").expect("written");
    let wrong = execute(&scene, &plan, &mut Silent).expect_err("three numbers");
    assert!(wrong.to_string().contains("line 1"), "{wrong}");
}

/// How far two points are apart.
fn distance_of(points: &[[f64; 3]]) -> f64 {
    (0..3).map(|a| (points[0][a] - points[1][a]).powi(2)).sum::<f64>().sqrt()
}

#[test]
fn a_vorticity_with_a_divergence_is_told_how_much_of_it() {
    let with = |spacing: &str, components: &str| {
        let start = RING.find("vorticity = [").expect("a vorticity");
        let end = start + RING[start..].find("]\n").expect("its end") + 2;
        let text = format!("{}vorticity = {components}\n{}", &RING[..start], &RING[end..]);
        let text = text.replace("0.8", "1.05");
        solve(&parse(&text.replace("spacing = 0.05", spacing)))
    };
    // A ring is a curl, however coarse the mesh.
    for spacing in ["spacing = 0.2", "spacing = 0.1", "spacing = 0.05"] {
        let ring = solve(&parse(&RING.replace("spacing = 0.05", spacing)));
        let why = ring.estimate.why_not.unwrap_or_default();
        assert!(!why.contains("divergence"), "{spacing}: {why}");
    }
    // Of a blob along one direction a third of the squares is a gradient, in a box whose sides are equal.
    let blob = "exp(-40*(x^2 + y^2 + z^2))";
    let along = with("spacing = 0.05", &format!("[0, 0, \"{blob}\"]"));
    assert!(along.estimate.l2.is_none());
    let why = along.estimate.why_not.expect("a reason");
    assert!(why.contains("has a divergence: 5.8e-1 of it is a gradient"), "{why}");
    let whole = with("spacing = 0.05", &format!("[\"x*{blob}\", \"y*{blob}\", \"z*{blob}\"]"));
    let why = whole.estimate.why_not.expect("a reason");
    assert!(why.contains("1.0e0 of it is a gradient"), "{why}");
    // A little of it is found, too.
    let little = with("spacing = 0.05", &format!("[\"-y*{blob}\", \"x*{blob}\", \"1e-5*{blob}\"]"));
    let why = little.estimate.why_not.expect("a reason");
    assert!(["e-4 of it", "e-5 of it"].iter().any(|part| why.contains(part)), "{why}");
}

#[test]
fn what_free_space_does_not_have_is_refused() {
    let said = |text: &str| Scene::parse(text, "scene.toml").expect_err("refused").to_string();
    let with = |section: &str| said(&format!("{CHARGE}\n{section}"));
    assert!(with("[[boundaries]]\nface = \"all\"\ndirichlet = 0\n").contains("free space"));
    assert!(with("[time]\nend = 1.0\n").contains("free space"));
    assert!(with("[method]\nname = \"gfdm-hybrid\"\n").contains("bounded domains"));
    assert!(with("[method]\norder = 5\n").contains("even order"));
    assert!(with("[method]\nkernel = \"spectral\"\nsigma = 2\n").contains("only Gaussian"));
    let bounded = CHARGE.replace("free_space", "box") + "\n[[boundaries]]\nface = \"all\"\ndirichlet = 0\n";
    assert!(said(&format!("{bounded}\n[method]\nname = \"free-space\"\n")).contains("bounded"));
    assert!(said(&format!("{bounded}\n[particles]\nfile = \"a.csv\"\n")).contains("free space"));
    let plan = |text: String| match Plan::new(&parse(&text)) {
        Err(Error::Scene(error)) => error.to_string(),
        other => panic!("{other:?}"),
    };
    assert!(plan(CHARGE.replace("diffusivity = 1", "diffusivity = \"1 + x^2\"")).contains("one constant"));
    assert!(plan(CHARGE.replace("spacing = 0.02", "spacing = \"0.02 + x^2\"")).contains("one number"));
    assert!(plan(CHARGE.replace("spacing = 0.02", "spacing = 1e-5")).contains("points"));
}

/// The charge of the example as a vorticity, with its potential as the stream function.
fn vortex(also: &str) -> Scene {
    let text = CHARGE.replace("source =", &format!("{also}vorticity =")).replace("exact =", "# exact =");
    parse(&text.replace("plot = true", "vtu = true\ncsv = true"))
}

/// `exp(-10/(1 - r^2))` and its derivatives.
fn bump([x, y]: [f64; 2]) -> [f64; 3] {
    let u = 1.0 - x * x - y * y;
    let f = if u > 0.0 { (-10.0 / u).exp() } else { 0.0 };
    [f, -20.0 * x / (u * u) * f, -20.0 * y / (u * u) * f]
}

#[test]
fn a_vorticity_has_a_velocity_and_only_that_is_transformed() {
    let scene = vortex("");
    let plan = Plan::new(&scene).expect("a plan");
    let transforms = plan.transforms().expect("free space");
    assert_eq!(transforms, [vec!["vorticity"], vec!["velocity x", "velocity y"]]);
    assert!(plan.to_string().contains("forward: vorticity; back: velocity x, velocity y\n"), "{plan}");
    assert!(plan.runs(Stage::Velocity) && plan.runs(Stage::Csv) && !plan.runs(Stage::Gradient));
    let solution = execute(&scene, &plan, &mut Silent).expect("a solution");
    let velocity = solution.field.velocity.as_ref().expect("a velocity");
    let (mut worst, mut largest) = (0.0_f64, 0.0_f64);
    for (p, v) in solution.field.points.iter().zip(velocity) {
        let [_, slope_x, slope_y] = bump([p[0], p[1]]);
        worst = worst.max((v[0] - slope_y).hypot(v[1] + slope_x));
        largest = largest.max(slope_x.hypot(slope_y));
    }
    assert!(worst < 1e-8 * largest, "{:e}", worst / largest);
    let speed = solution.report.speed.as_ref().expect("a speed");
    assert!((speed.max / largest - 1.0).abs() < 1e-8);
    // Files have the same numbers.
    let folder = tempfile::tempdir().expect("a folder");
    let files = meshless::write_outputs(&plan, &solution, folder.path(), "vortex").expect("files");
    assert_eq!(files.len(), 2);
    let text = std::fs::read_to_string(folder.path().join("vortex.csv")).expect("a file");
    assert_eq!(text.lines().next(), Some("x,y,u,velocity_x,velocity_y"));
    assert_eq!(text.lines().count(), 1 + 110 * 110);
    let line = text.lines().nth(1 + 6000).expect("a line");
    let numbers: Vec<f64> = line.split(',').map(|cell| cell.parse().expect("a number")).collect();
    assert_eq!(numbers[3..], velocity[6000][..2]);
    let vtu = std::fs::read(folder.path().join("vortex.vtu")).expect("a file");
    assert!(String::from_utf8_lossy(&vtu).contains("velocity"));
}

#[test]
fn a_source_adds_its_gradient_to_the_velocity() {
    let mut scene = vortex("source = \"exp(-20*((x - 0.2)^2 + y^2)*2)\"\n");
    scene.probes = vec![vec![0.31, -0.17], vec![1.4, 0.3]];
    let plan = Plan::new(&scene).expect("a plan");
    let [forward, back] = plan.transforms().expect("free space");
    assert_eq!(forward, ["vorticity", "source"]);
    assert_eq!(back, ["velocity x", "velocity y", "u", "gradient x", "gradient y"]);
    let report = execute(&scene, &plan, &mut Silent).expect("a solution").report;
    for probe in &report.probes {
        let (x, y) = (probe.at[0], probe.at[1]);
        // A Gaussian charge of width s has within r what `1 - exp(-r^2 / 2 s^2)` of it is.
        let (r2, s2) = ((x - 0.2) * (x - 0.2) + y * y, 1.0 / 80.0);
        let away = s2 * (1.0 - (-r2 / (2.0 * s2)).exp()) / r2;
        let [_, slope_x, slope_y] = bump([x, y]);
        let v = probe.velocity.as_ref().expect("a velocity");
        let error = (v[0] - slope_y - away * (x - 0.2)).hypot(v[1] + slope_x - away * y);
        assert!(error < 1e-11, "{:?}: {error:e}", probe.at);
    }
}

#[test]
fn a_ring_blows_through_itself() {
    let scene = parse(RING);
    let plan = Plan::new(&scene).expect("a plan");
    assert_eq!(plan.transforms().expect("free space")[0].len(), 3);
    let solution = execute(&scene, &plan, &mut Silent).expect("a solution");
    let velocity = solution.field.velocity.as_ref().expect("a velocity");
    // The law of Biot and Savart on the axis, by sums over the same source: v_z = int r^2 g / 2 (r^2 + (z - h)^2)^(3/2).
    let on_axis = |h: f64| {
        let n = 400;
        let step = [1.05 / f64::from(n), 1.6 / f64::from(n)];
        let mut sum = 0.0;
        for i in 0..n {
            for k in 0..n {
                let (r, z) = ((f64::from(i) + 0.5) * step[0], (f64::from(k) + 0.5) * step[1] - 0.8);
                let around = r * (-50.0 * ((r * r - 0.25).powi(2) + z * z)).exp();
                sum += around * r * r / (2.0 * (r * r + (z - h).powi(2)).powf(1.5));
            }
        }
        sum * step[0] * step[1]
    };
    let error = |report: &Report| {
        report.probes.iter().fold(0.0_f64, |worst, probe| {
            let v = probe.velocity.as_ref().expect("a velocity");
            assert!(v[0].abs() + v[1].abs() < 1e-12, "{v:?}");
            worst.max((v[2] / on_axis(probe.at[2]) - 1.0).abs())
        })
    };
    // In the middle, the integrand of the sum above is not smooth.
    let middle = error(&solution.report);
    assert!(middle < 1e-5, "{middle:e}");
    let mut above = parse(RING);
    above.probes = vec![vec![0.0, 0.0, 1.0], vec![0.0, 0.0, 3.0]];
    let above = error(&solve(&above));
    assert!(above < 1e-6, "{above:e}");
    // Sums over all points and transforms know the same velocity.
    let at = 42 * 42 * 17 + 42 * 9 + 30;
    let mut there = parse(RING);
    there.probes = vec![solution.field.points[at].to_vec()];
    let probe = solve(&there).probes.remove(0).velocity.expect("a velocity");
    let error = (0..3).fold(0.0_f64, |m, a| m.max((probe[a] - velocity[at][a]).abs()));
    // What the mesh does not hold is at its highest wave numbers, where velocities are some tens of times larger relative to potentials.
    let estimate = solution.report.estimate.l2.expect("an estimate");
    let limit = 100.0 * estimate * solution.report.speed.expect("a speed").max;
    assert!(error < limit, "{error:e} {limit:e} {estimate:e}");
}

#[test]
fn vorticities_that_cannot_be_are_refused() {
    let said = |text: &str| Scene::parse(text, "scene.toml").expect_err("refused").to_string();
    let with =
        |text: &str| CHARGE.replace("diffusivity = 1", &format!("diffusivity = 1\nvorticity = {text}"));
    assert!(said(&with("[\"x\", \"y\"]")).contains("vorticity"));
    let in_space = |text: &str| {
        let start = RING.find("vorticity = [").expect("a vorticity");
        let end = start + RING[start..].find("]\n").expect("its end") + 2;
        format!("{}vorticity = {text}\n{}", &RING[..start], &RING[end..])
    };
    assert!(said(&in_space("[\"x\", \"y\"]")).contains("expected 3 components, found 2"));
    assert!(said(&in_space("\"x\"")).contains("vorticity"));
    assert!(said(&in_space("[\"x\", \"y\", \"w\"]")).contains("`w`"));
    let line = with("1").replace("dimension = 2", "dimension = 1");
    let line = line.replace("[-1.1, -1.1]", "[-1.1]").replace("[1.1, 1.1]", "[1.1]");
    assert!(said(&line.replace("y^2", "0")).contains("no curl in one dimension"));
    let bounded =
        with("1").replace("free_space", "box") + "\n[[boundaries]]\nface = \"all\"\ndirichlet = 0\n";
    assert!(said(&bounded).contains("a vorticity is for free space"));
    let scene = parse(&in_space("[\"log(x)\", 0, 0]"));
    let plan = Plan::new(&scene).expect("a plan");
    let error = execute(&scene, &plan, &mut Silent).expect_err("no logarithm").to_string();
    assert!(error.contains("NaN") && error.contains("log(x)"), "{error}");
}
