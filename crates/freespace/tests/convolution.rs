//! Convolution on small meshes: against the direct sum over pairs of points, and what must not change it.

use meshless_freespace::{
    Boundary, Centring, FreeSpaceError, Gaussian, Kernel, Mesh, Output, Plan, PlanParams, Radial, Spectral,
    Workspace,
};
use proptest::prelude::*;

/// Round-off of sums of some hundred numbers, and of transforms of that length, with a factor of ten to spare.
const ROUND_OFF: f64 = 1e-12;

/// What must not depend on the kernel.
const KERNELS: [Kernel; 3] =
    [Kernel::Gaussian { order: 6, smoothing: None }, Kernel::Spectral, Kernel::Truncated];

/// Numbers between -1 and 1 that look random.
fn noise(count: usize, seed: u64) -> Vec<f64> {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    (0..count)
        .map(|_| {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        })
        .collect()
}

fn distance<const D: usize>(p: [f64; D], q: [f64; D]) -> f64 {
    (0..D).map(|a| (p[a] - q[a]).powi(2)).sum::<f64>().sqrt()
}

fn direct<const D: usize>(mesh: &Mesh<D>, kernel: &dyn Radial, source: &[f64]) -> Vec<f64> {
    (0..mesh.len())
        .map(|i| {
            let pairs = source.iter().enumerate();
            let sum: f64 = pairs.map(|(j, f)| f * kernel.value(distance(mesh.point(i), mesh.point(j)))).sum();
            sum * mesh.cell_volume()
        })
        .collect()
}

/// Largest difference over largest magnitude.
fn difference(a: &[f64], b: &[f64]) -> f64 {
    let scale = b.iter().fold(f64::MIN_POSITIVE, |s, v| s.max(v.abs()));
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).fold(0.0_f64, |m, (x, y)| m.max((x - y).abs())) / scale
}

fn mesh<const D: usize>(cells: [usize; D], spacing: [f64; D], centring: Centring) -> Mesh<D> {
    Mesh::new([-0.3; D], spacing, cells, centring).expect("a mesh")
}

fn coarsest<const D: usize>(mesh: &Mesh<D>) -> f64 {
    mesh.spacing().into_iter().fold(0.0, f64::max)
}

fn check_direct<const D: usize>(cells: [usize; D], spacing: [f64; D], centring: Centring, order: usize) {
    let mesh = mesh(cells, spacing, centring);
    let source = noise(mesh.len(), 3);
    let smoothing = Some(1.25);
    let plan: Plan<D> = Plan::new(&mesh, Kernel::Gaussian { order, smoothing }).expect("a plan");
    let kernel = Gaussian::<D>::new(order, 1.25 * coarsest(&mesh)).expect("a kernel");
    let phi = plan.potential(&source).expect("a potential");
    let error = difference(&phi, &direct(&mesh, &kernel, &source));
    assert!(error < ROUND_OFF, "{cells:?} {spacing:?} order {order}: {error:e}");
    let plan: Plan<D> = Plan::new(&mesh, Kernel::Spectral).expect("a plan");
    let kernel = Spectral::<D>::new(coarsest(&mesh) / std::f64::consts::PI).expect("a kernel");
    let phi = plan.potential(&source).expect("a potential");
    assert!(difference(&phi, &direct(&mesh, &kernel, &source)) < ROUND_OFF, "{cells:?} spectral");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn is_the_direct_sum_in_one_dimension(n in 1_usize..40, h in 0.1..2.0, half in 1_usize..=10) {
        check_direct([n], [h], Centring::Cell, 2 * half);
    }

    #[test]
    fn is_the_direct_sum_in_two_dimensions(
        n in [1_usize..20, 1_usize..20], h in [0.1..2.0, 0.1..2.0], half in 1_usize..=10, node: bool,
    ) {
        let centring = if node { Centring::Node } else { Centring::Cell };
        check_direct(n, h, centring, 2 * half);
        check_direct(n, [h[0]; 2], centring, 2 * half);
    }

    #[test]
    fn is_the_direct_sum_in_three_dimensions(
        n in [1_usize..9, 1_usize..9, 1_usize..9], h in [0.1..2.0, 0.1..2.0, 0.1..2.0], half in 1_usize..=10,
    ) {
        check_direct(n, h, Centring::Cell, 2 * half);
        check_direct(n, [h[0]; 3], Centring::Node, 2 * half);
    }

    #[test]
    fn is_linear_self_adjoint_and_moves_with_its_source(
        seed in 0_u64..1000, shift in [0_usize..5, 0_usize..4], which in 0_usize..3,
    ) {
        let mesh = mesh([14, 11], [0.1, 0.15], Centring::Cell);
        let plan: Plan<2> = Plan::new(&mesh, KERNELS[which]).expect("a plan");
        let (f, g) = (noise(mesh.len(), seed), noise(mesh.len(), seed + 7));
        let [of_f, of_g] = [&f, &g].map(|s| plan.potential(s).expect("a potential"));
        let sum: Vec<f64> = f.iter().zip(&g).map(|(f, g)| 2.0 * f - 3.0 * g).collect();
        let of_sum: Vec<f64> = of_f.iter().zip(&of_g).map(|(f, g)| 2.0 * f - 3.0 * g).collect();
        prop_assert!(difference(&plan.potential(&sum).expect("a potential"), &of_sum) < ROUND_OFF);

        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let scale = (dot(&f, &f) * dot(&of_g, &of_g)).sqrt();
        prop_assert!((dot(&f, &of_g) - dot(&g, &of_f)).abs() < ROUND_OFF * scale);

        // A source in one corner of the mesh, moved by whole cells.
        let small = |offset: [usize; 2]| {
            let mut moved = vec![0.0; mesh.len()];
            for j in 0..6 {
                for i in 0..8 {
                    moved[(i + offset[0]) + 14 * (j + offset[1])] = f[i + 8 * j];
                }
            }
            plan.potential(&moved).expect("a potential")
        };
        let (here, there) = (small([0, 0]), small(shift));
        let scale = here.iter().fold(0.0_f64, |s, v| s.max(v.abs()));
        for j in 0..11 - shift[1] {
            for i in 0..14 - shift[0] {
                let moved = there[i + shift[0] + 14 * (j + shift[1])];
                prop_assert!((here[i + 14 * j] - moved).abs() < ROUND_OFF * scale);
            }
        }
    }

    #[test]
    fn is_linear_and_self_adjoint_in_space(seed in 0_u64..1000, which in 0_usize..3) {
        let mesh = mesh([6, 7, 5], [0.1, 0.12, 0.2], Centring::Node);
        let plan: Plan<3> = Plan::new(&mesh, KERNELS[which]).expect("a plan");
        let (f, g) = (noise(mesh.len(), seed), noise(mesh.len(), seed + 7));
        let [of_f, of_g] = [&f, &g].map(|s| plan.potential(s).expect("a potential"));
        let sum: Vec<f64> = f.iter().zip(&g).map(|(f, g)| 0.5 * f + 4.0 * g).collect();
        let of_sum: Vec<f64> = of_f.iter().zip(&of_g).map(|(f, g)| 0.5 * f + 4.0 * g).collect();
        prop_assert!(difference(&plan.potential(&sum).expect("a potential"), &of_sum) < ROUND_OFF);
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let scale = (dot(&f, &f) * dot(&of_g, &of_g)).sqrt();
        prop_assert!((dot(&f, &of_g) - dot(&g, &of_f)).abs() < ROUND_OFF * scale);
    }

    #[test]
    fn mirrored_sources_have_mirrored_potentials(seed in 0_u64..1000, axis in 0_usize..3, which in 0_usize..3) {
        let mesh = mesh([7, 6, 5], [0.1, 0.12, 0.2], Centring::Cell);
        let plan: Plan<3> = Plan::new(&mesh, KERNELS[which]).expect("a plan");
        let mirror = |values: &[f64]| -> Vec<f64> {
            (0..mesh.len()).map(|index| {
                let mut i = mesh.indices(index);
                i[axis] = mesh.points()[axis] - 1 - i[axis];
                values[i[0] + 7 * (i[1] + 6 * i[2])]
            }).collect()
        };
        let source = noise(mesh.len(), seed);
        let phi = plan.potential(&mirror(&source)).expect("a potential");
        prop_assert!(difference(&phi, &mirror(&plan.potential(&source).expect("a potential"))) < ROUND_OFF);
    }
}

fn blob<const D: usize>(mesh: &Mesh<D>, width: f64, centre: [f64; D]) -> Vec<f64> {
    mesh.sample(|p| (-distance(p, centre).powi(2) / (2.0 * width * width)).exp())
}

#[test]
fn gradients_are_the_derivatives_of_potentials() {
    // A Gaussian of width s has the potential erf(r / s sqrt 2) / 4 pi r times its total.
    let mesh = Mesh::of_box([-1.0; 3], [1.0, 1.2, 0.9], [36, 40, 33], Centring::Cell).expect("a mesh");
    let (width, centre) = (0.11, [0.05, 0.1, -0.02]);
    let source = blob(&mesh, width, centre);
    let plan: Plan<3> = Plan::new(&mesh, Kernel::Truncated).expect("a plan");
    let wanted = [
        Output::Gradient { source: 0, axis: 0 },
        Output::Gradient { source: 0, axis: 1 },
        Output::Gradient { source: 0, axis: 2 },
        Output::Potential { source: 0 },
    ];
    let mut outputs = Vec::new();
    plan.solve(&[&source], &wanted, &mut Workspace::default(), &mut outputs).expect("fields");
    let total = (std::f64::consts::TAU.sqrt() * width).powi(3);
    let enclosed = |r: f64| {
        let x = r / width;
        libm::erf(x / 2.0_f64.sqrt()) - (2.0 / std::f64::consts::PI).sqrt() * x * (-x * x / 2.0).exp()
    };
    for axis in 0..3 {
        let exact = mesh.sample(|p| {
            let r = distance(p, centre);
            -total * enclosed(r) * (p[axis] - centre[axis]) / (4.0 * std::f64::consts::PI * r.powi(3))
        });
        // The source is 1e-11 of its height at the faces.
        assert!(
            difference(&outputs[axis], &exact) < 1e-8,
            "{axis}: {:e}",
            difference(&outputs[axis], &exact)
        );
    }
    let exact = mesh.sample(|p| {
        let r = distance(p, centre);
        total * libm::erf(r / width / 2.0_f64.sqrt()) / (4.0 * std::f64::consts::PI * r)
    });
    assert!(difference(&outputs[3], &exact) < 1e-9, "{:e}", difference(&outputs[3], &exact));
    let alone = plan.potential(&source).expect("a potential");
    assert_eq!(alone, outputs[3], "what else is asked for does not matter");
}

#[test]
fn the_curl_turns_and_the_velocity_adds_the_gradient() {
    let mesh = Mesh::of_box([-1.0; 3], [1.0; 3], [20, 18, 16], Centring::Node).expect("a mesh");
    let sources: Vec<Vec<f64>> =
        (0..4).map(|s| blob(&mesh, 0.15, [0.1 * f64::from(s) - 0.2, 0.1, 0.02 * f64::from(s)])).collect();
    let sources: Vec<&[f64]> = sources.iter().map(Vec::as_slice).collect();
    let plan: Plan<3> = Plan::new(&mesh, Kernel::gaussian(8)).expect("a plan");
    let gradient = |source, axis| Output::Gradient { source, axis };
    let mut wanted: Vec<Output> = (0..3).map(|axis| Output::Velocity { axis }).collect();
    wanted.extend((0..3).map(|axis| Output::Curl { axis }));
    wanted.extend((0..4).flat_map(|s| (0..3).map(move |a| gradient(s, a))));
    let mut out = Vec::new();
    plan.solve(&sources, &wanted, &mut Workspace::default(), &mut out).expect("fields");
    let of = |source: usize, axis: usize| &out[6 + 3 * source + axis];
    for axis in 0..3 {
        let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
        let curl: Vec<f64> = of(last, next).iter().zip(of(next, last)).map(|(a, b)| a - b).collect();
        assert!(difference(&out[3 + axis], &curl) < ROUND_OFF);
        let velocity: Vec<f64> = curl.iter().zip(of(3, axis)).map(|(c, g)| c - g).collect();
        assert!(difference(&out[axis], &velocity) < ROUND_OFF);
    }
}

#[test]
fn the_number_of_threads_changes_no_bit() {
    fn check<const D: usize>(cells: [usize; D], params: PlanParams<D>) {
        let mesh = Mesh::of_box([-1.0; D], [1.0; D], cells, Centring::Cell).expect("a mesh");
        let source = noise(mesh.len(), 5);
        let solve = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
            pool.install(|| {
                let plan: Plan<D> = Plan::new(&mesh, params).expect("a plan");
                let wanted = [Output::Potential { source: 0 }, Output::Gradient { source: 0, axis: 1 }];
                let mut outputs = Vec::new();
                plan.solve(&[&source], &wanted, &mut Workspace::default(), &mut outputs).expect("fields");
                outputs
            })
        };
        let one = solve(1);
        assert!([2, 3, 7].into_iter().all(|threads| solve(threads) == one), "{params:?}");
    }
    for kernel in KERNELS {
        check([23, 18, 14], kernel.into());
        // Squares, of which half is sampled, and enough of them for polynomials in place of the kernel.
        check([300, 300], kernel.into());
    }
    let boundaries = [Boundary::Periodic, Boundary::OPEN, Boundary::EVEN];
    check([12, 15, 10], PlanParams { boundaries, remove_mean: true, ..PlanParams::default() });
}

#[test]
fn single_precision_is_as_good_as_its_numbers() {
    let mesh = Mesh::of_box([-1.0; 2], [1.0; 2], [48, 40], Centring::Cell).expect("a mesh");
    let source = blob(&mesh, 0.15, [0.0, 0.1]);
    let double: Plan<2> = Plan::new(&mesh, Kernel::gaussian(10)).expect("a plan");
    let single: Plan<2, f32> = Plan::new(&mesh, Kernel::gaussian(10)).expect("a plan");
    let rounded: Vec<f32> = source.iter().map(|&v| v as f32).collect();
    let phi: Vec<f64> = single.potential(&rounded).expect("a potential").into_iter().map(f64::from).collect();
    let error = difference(&phi, &double.potential(&source).expect("a potential"));
    assert!(error < 1e-5 && error > 1e-9, "{error:e}");
}

#[test]
fn mistakes_are_errors_that_say_what_was_wrong() {
    let said = |error: Result<Vec<f64>, FreeSpaceError>| error.expect_err("a mistake").to_string();
    let mesh = Mesh::of_box([0.0; 2], [1.0; 2], [8, 8], Centring::Cell).expect("a mesh");
    let plan: Plan<2> = Plan::new(&mesh, Kernel::gaussian(4)).expect("a plan");
    let mut source = vec![0.0; 64];
    assert!(said(plan.potential(&source[1..])).contains("63 values"));
    source[9] = f64::NAN;
    assert!(said(plan.potential(&source)).contains("value 9 of the source"));
    source[9] = 1.0;
    let solve = |wanted: Output| {
        let error = plan.solve(&[&source], &[wanted], &mut Workspace::default(), &mut Vec::new());
        error.expect_err("a mistake").to_string()
    };
    assert!(solve(Output::Gradient { source: 0, axis: 2 }).contains("2 directions"));
    assert!(solve(Output::Potential { source: 1 }).contains("2 sources, 1 are given"));
    assert!(solve(Output::Velocity { axis: 0 }).contains("2 sources"));
    assert_eq!(
        Mesh::<2>::of_box([0.0; 2], [1.0; 2], [8, 0], Centring::Cell),
        Err(FreeSpaceError::NoCells { axis: 1 })
    );
    assert!(Mesh::<2>::of_box([0.0; 2], [1.0, 0.0], [8, 8], Centring::Cell).is_err());
    assert!(Mesh::<3>::of_box([0.0; 3], [1.0; 3], [usize::MAX / 2; 3], Centring::Cell).is_err());
    let phi = [Output::Potential { source: 0 }];
    let nowhere = [0.0, f64::NAN];
    let shifted = plan.solve_shifted(&[&source], &phi, nowhere, &mut Workspace::default(), &mut Vec::new());
    assert!(matches!(shifted, Err(FreeSpaceError::Invalid { what: "shift", .. })), "{shifted:?}");
    assert!(mesh.edge_ratio(&[0.0, f64::NAN]).is_nan());
    for spacing in [1e-120, 1e120] {
        assert!(Mesh::<3>::new([0.0; 3], [spacing; 3], [8; 3], Centring::Cell).is_err());
    }
    let limited = PlanParams { memory_mb: Some(10), ..PlanParams::default() };
    let large = Mesh::of_box([0.0; 3], [1.0; 3], [128; 3], Centring::Cell).expect("a mesh");
    assert!(matches!(Plan::<3>::new(&large, limited), Err(FreeSpaceError::Memory { available: 10, .. })));
    assert!((mesh.edge_ratio(&source) - 0.0).abs() < 1e-15 && mesh.edge_ratio(&vec![2.0; 64]) == 1.0);
}

/// Outputs that are asked for together share transforms; asked for alone, each has its own.
#[test]
fn outputs_together_are_those_alone() {
    fn check<const D: usize>(cells: [usize; D]) {
        let mesh = mesh(cells, [0.1; D], Centring::Node);
        let source = noise(mesh.len(), 8);
        let plan: Plan<D> = Plan::new(&mesh, Kernel::gaussian(6)).expect("a plan");
        let mut wanted = vec![Output::PotentialError { source: 0 }, Output::Potential { source: 0 }];
        for axis in 0..D {
            wanted.push(Output::Gradient { source: 0, axis });
            wanted.push(Output::GradientError { source: 0, axis });
        }
        let mut shift = [0.0; D];
        for moved in [0.0, 0.37] {
            shift[D - 1] = moved;
            let (mut workspace, mut together, mut alone) = (Workspace::default(), Vec::new(), Vec::new());
            plan.solve_shifted(&[&source], &wanted, shift, &mut workspace, &mut together).expect("fields");
            for (output, field) in wanted.iter().zip(&together) {
                plan.solve_shifted(&[&source], &[*output], shift, &mut workspace, &mut alone)
                    .expect("a field");
                assert!(difference(field, &alone[0]) < ROUND_OFF, "{output:?}");
            }
        }
    }
    check([23]);
    check([40, 9]);
    check([7, 1, 12]);
    check([5, 6, 9]);
}

/// Places of a cell share transforms; each alone has its own.
#[test]
fn shifts_together_are_those_alone() {
    fn check<const D: usize>(cells: [usize; D], centring: Centring) {
        let mesh = mesh(cells, std::array::from_fn(|a| 0.1 + 0.02 * a as f64), centring);
        let source = noise(mesh.len(), 11);
        let plan: Plan<D> = Plan::new(&mesh, Kernel::gaussian(6)).expect("a plan");
        let outputs = [Output::Potential { source: 0 }, Output::Gradient { source: 0, axis: D - 1 }];
        let places = (0..1 << D).map(|i| std::array::from_fn(|a| if i >> a & 1 == 1 { 0.25 } else { -0.25 }));
        let wanted: Vec<(Output, [f64; D])> =
            places.flat_map(|place| outputs.map(|output| (output, place))).collect();
        let (mut workspace, mut together, mut alone) = (Workspace::default(), Vec::new(), Vec::new());
        plan.solve_at(&[&source], &wanted, &mut workspace, &mut together).expect("fields");
        for ((output, place), field) in wanted.iter().zip(&together) {
            plan.solve_shifted(&[&source], &[*output], *place, &mut workspace, &mut alone).expect("a field");
            assert!(difference(field, &alone[0]) < ROUND_OFF, "{output:?} {place:?}");
        }
    }
    check([21], Centring::Cell);
    check([17, 12], Centring::Node);
    check([6, 7, 5], Centring::Cell);
}

/// A field that the mesh holds is known between its points, too.
#[test]
fn shifts_evaluate_between_the_points() {
    let mesh = Mesh::of_box([-1.0; 3], [1.0; 3], [24; 3], Centring::Cell).expect("a mesh");
    let source = blob(&mesh, 0.17, [0.02, 0.0, -0.03]);
    let plan: Plan<3> = Plan::new(&mesh, Kernel::gaussian(8)).expect("a plan");
    let wanted = [
        (Output::Potential { source: 0 }, [1.0, 0.0, 0.0]),
        (Output::Potential { source: 0 }, [0.0, -1.0, 2.0]),
    ];
    let mut fields = Vec::new();
    plan.solve_at(&[&source], &wanted, &mut Workspace::default(), &mut fields).expect("fields");
    let phi = plan.potential(&source).expect("a potential");
    for (field, (_, shift)) in fields.iter().zip(wanted) {
        for point in 0..mesh.len() {
            let i = mesh.indices(point);
            let moved: [i64; 3] = std::array::from_fn(|a| i[a] as i64 + shift[a] as i64);
            if moved.iter().all(|i| (0..24).contains(i)) {
                let there = phi[mesh.index(moved.map(|i| i as usize))];
                assert!((field[point] - there).abs() < 1e-12 * phi[mesh.index([12; 3])]);
            }
        }
    }
}

#[test]
fn sums_that_overflow_are_refused() {
    let mesh = Mesh::of_box([0.0; 2], [1.0; 2], [8, 8], Centring::Cell).expect("a mesh");
    let plan: Plan<2> = Plan::new(&mesh, Kernel::gaussian(4)).expect("a plan");
    assert_eq!(plan.potential(&[1e308; 64]), Err(FreeSpaceError::Overflow));
}
