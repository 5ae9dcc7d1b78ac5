//! Periods and mirrors, against closed forms and against free space with images.

use meshless_freespace::{
    Boundary, Centring, Face, FreeSpaceError, Kernel, Mesh, Output, Plan, PlanParams, Workspace,
};
use std::f64::consts::TAU;

/// Largest difference over largest magnitude.
fn difference(a: &[f64], b: &[f64]) -> f64 {
    let scale = b.iter().fold(f64::MIN_POSITIVE, |s, v| s.max(v.abs()));
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).fold(0.0_f64, |m, (x, y)| m.max((x - y).abs())) / scale
}

fn plan<const D: usize>(mesh: &Mesh<D>, kernel: Kernel, boundaries: [Boundary; D]) -> Plan<D> {
    Plan::new(mesh, PlanParams { kernel, boundaries, ..PlanParams::default() }).expect("a plan")
}

/// Waves are multiplied by the inverse of their Laplacian.
#[test]
fn waves_between_mirrors_and_in_periods() {
    let faces = |lower, upper| Boundary::Faces { lower, upper };
    for (centring, boundary, wave) in [
        (Centring::Cell, Boundary::Periodic, (|x: f64| (2.0 * TAU * x).sin()) as fn(f64) -> f64),
        (Centring::Node, Boundary::Periodic, |x| (2.0 * TAU * x).sin()),
        (Centring::Cell, Boundary::EVEN, |x| (2.0 * TAU * x).cos()),
        (Centring::Node, Boundary::EVEN, |x| (2.0 * TAU * x).cos()),
        (Centring::Cell, Boundary::ODD, |x| (2.0 * TAU * x).sin()),
        (Centring::Node, Boundary::ODD, |x| (2.0 * TAU * x).sin()),
        (Centring::Cell, faces(Face::Even, Face::Odd), |x| (2.25 * TAU * x).cos()),
        (Centring::Node, faces(Face::Odd, Face::Even), |x| (2.25 * TAU * x).sin()),
    ] {
        let k =
            if matches!(boundary, Boundary::Faces { lower, upper } if lower != upper) { 2.25 } else { 2.0 };
        let mesh = Mesh::of_box([0.0; 3], [1.0; 3], [14, 12, 15], centring).expect("a mesh");
        for axis in 0..3 {
            let mut boundaries = [Boundary::Periodic; 3];
            boundaries[axis] = boundary;
            let source = mesh.sample(|p| wave(p[axis]));
            let exact: Vec<f64> = source.iter().map(|v| v / (k * TAU).powi(2)).collect();
            let phi = plan(&mesh, Kernel::Spectral, boundaries).potential(&source).expect("a potential");
            let error = difference(&phi, &exact);
            assert!(error < 1e-12, "{centring:?} {boundary:?} {axis}: {error:e}");
        }
    }
}

/// Between two periodic directions and an open one, a layer of charge has the field of its images.
#[test]
fn a_wave_beside_free_space_decays() {
    let (width, k) = (0.08, TAU);
    // A layer with a Gaussian profile that varies like cos(k x): phi'' = k^2 phi - f across it.
    for open in 0..2 {
        let cells = [40; 2];
        let (mut min, mut max) = ([0.0; 2], [1.0; 2]);
        (min[open], max[open]) = (-0.6, 0.6);
        let mesh = Mesh::of_box(min, max, cells, Centring::Cell).expect("a mesh");
        let profile = |z: f64| (-z * z / (2.0 * width * width)).exp();
        let source = mesh.sample(|p| profile(p[open]) * (k * p[1 - open]).cos());
        // The convolution of exp(-k |z|)/2k with the profile.
        let across = |z: f64| {
            let part = |z: f64| {
                let a = width * k;
                (k * z).exp() * libm::erfc((a + z / width) / 2.0_f64.sqrt())
            };
            (TAU.sqrt() * width / (4.0 * k)) * (width * width * k * k / 2.0).exp() * (part(z) + part(-z))
        };
        let exact = mesh.sample(|p| across(p[open]) * (k * p[1 - open]).cos());
        for kernel in
            [Kernel::Truncated, Kernel::Spectral, Kernel::Gaussian { order: 20, smoothing: Some(1.25) }]
        {
            let mut boundaries = [Boundary::Periodic; 2];
            boundaries[open] = Boundary::OPEN;
            let phi = plan(&mesh, kernel, boundaries).potential(&source).expect("a potential");
            let error = difference(&phi, &exact);
            let limit = if matches!(kernel, Kernel::Gaussian { .. }) { 1e-6 } else { 1e-10 };
            assert!(error < limit, "{kernel:?} open {open}: {error:e}");
        }
    }
}

/// A line of charge along a period is the problem in the plane across it.
#[test]
fn a_period_in_space_is_a_plane() {
    let across = Mesh::of_box([-1.0; 2], [1.0; 2], [24, 28], Centring::Cell).expect("a mesh");
    let blob = |x: f64, y: f64| (-((x - 0.1).powi(2) + y * y) / 0.05).exp();
    let flat = plan(&across, Kernel::Truncated, [Boundary::OPEN; 2]);
    let expected = flat.potential(&across.sample(|p| blob(p[0], p[1]))).expect("a potential");
    let mesh = Mesh::of_box([-1.0; 3], [1.0; 3], [24, 28, 6], Centring::Cell).expect("a mesh");
    let boundaries = [Boundary::OPEN, Boundary::OPEN, Boundary::Periodic];
    let source = mesh.sample(|p| blob(p[0], p[1]));
    let phi = plan(&mesh, Kernel::Truncated, boundaries).potential(&source).expect("a potential");
    let layer = across.len();
    assert!((0..6).all(|k| difference(&phi[k * layer..(k + 1) * layer], &expected) < 1e-11));
    // Modulated along the period, it is screened: -lap phi = f at the points, by the transform of phi itself.
    let modulated = mesh.sample(|p| blob(p[0], p[1]) * (TAU * p[2] / 2.0).cos());
    let phi = plan(&mesh, Kernel::Truncated, boundaries).potential(&modulated).expect("a potential");
    let fine = Mesh::of_box([-1.0; 3], [1.0; 3], [24, 28, 12], Centring::Cell).expect("a mesh");
    // The same with mirrors over half of the period.
    let half = Mesh::of_box([-1.0, -1.0, 0.0], [1.0; 3], [24, 28, 3], Centring::Cell).expect("a mesh");
    let mirrored = plan(&half, Kernel::Truncated, [Boundary::OPEN, Boundary::OPEN, Boundary::EVEN]);
    let source = half.sample(|p| blob(p[0], p[1]) * (TAU * p[2] / 2.0).cos());
    let upper = mirrored.potential(&source).expect("a potential");
    assert!(difference(&upper, &phi[3 * layer..]) < 1e-11);
    assert_eq!(fine.len(), 2 * mesh.len());
}

/// One mirror beside free space is free space with an image.
#[test]
fn a_mirror_is_an_image() {
    for (sign, face) in [(1.0, Face::Even), (-1.0, Face::Odd)] {
        for axis in 0..2 {
            let blob = |p: [f64; 2]| (-((p[0] - 0.4).powi(2) + (p[1] - 0.5).powi(2)) / 0.02).exp();
            let half = Mesh::of_box([0.0; 2], [1.0; 2], [20, 20], Centring::Cell).expect("a mesh");
            let mut boundaries = [Boundary::OPEN; 2];
            boundaries[axis] = Boundary::Faces { lower: face, upper: Face::Open };
            let wanted = [Output::Potential { source: 0 }, Output::Gradient { source: 0, axis }];
            let mut out = Vec::new();
            let kernel = Kernel::gaussian(8);
            plan(&half, kernel, boundaries)
                .solve(&[&half.sample(blob)], &wanted, &mut Workspace::default(), &mut out)
                .expect("fields");
            let (mut min, mut cells) = ([0.0; 2], [20; 2]);
            (min[axis], cells[axis]) = (-1.0, 40);
            let whole = Mesh::of_box(min, [1.0; 2], cells, Centring::Cell).expect("a mesh");
            let with_image = |mut p: [f64; 2]| {
                if p[axis] > 0.0 {
                    return blob(p);
                }
                p[axis] = -p[axis];
                sign * blob(p)
            };
            let mut both = Vec::new();
            plan(&whole, kernel, [Boundary::OPEN; 2])
                .solve(&[&whole.sample(with_image)], &wanted, &mut Workspace::default(), &mut both)
                .expect("fields");
            for (half_field, whole_field) in out.iter().zip(&both) {
                let upper: Vec<f64> = (0..half.len())
                    .map(|point| {
                        let mut i = half.indices(point);
                        i[axis] += 20;
                        whole_field[whole.index(i)]
                    })
                    .collect();
                assert!(difference(half_field, &upper) < 1e-12, "{face:?} {axis}");
            }
        }
    }
}

#[test]
fn a_period_has_no_mean() {
    let mesh = Mesh::of_box([0.0; 2], [1.0; 2], [8, 8], Centring::Cell).expect("a mesh");
    let periodic = PlanParams { boundaries: [Boundary::Periodic; 2], ..PlanParams::default() };
    let strict: Plan<2> = Plan::new(&mesh, periodic).expect("a plan");
    let source = mesh.sample(|p| 1.0 + (TAU * p[0]).sin());
    assert!(matches!(strict.potential(&source), Err(FreeSpaceError::Mean { mean }) if mean > 0.4));
    let lenient: Plan<2> = Plan::new(&mesh, PlanParams { remove_mean: true, ..periodic }).expect("a plan");
    let without = strict.potential(&mesh.sample(|p| (TAU * p[0]).sin())).expect("a potential");
    assert!(difference(&lenient.potential(&source).expect("a potential"), &without) < 1e-13);
    // Zero at a face determines the constant.
    let odd = PlanParams { boundaries: [Boundary::ODD, Boundary::EVEN], ..PlanParams::default() };
    let odd: Plan<2> = Plan::new(&mesh, odd).expect("a plan");
    assert!(odd.potential(&source).is_ok());
}
