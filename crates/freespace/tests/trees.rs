//! Trees of patches to a tolerance against closed forms.

use std::f64::consts::PI;

use meshless_freespace::{
    Centring, FreeSpaceError, Mesh, Output, RefineParams, RefinedPlan, TreeParams, suggest_tree,
};

/// phi on all meshes.
fn solve<const D: usize>(plan: &RefinedPlan<D>, source: impl Fn([f64; D]) -> f64) -> Vec<Vec<Vec<f64>>> {
    let sampled = (0..plan.len()).map(|i| vec![plan.source_mesh(i).sample(&source)]);
    plan.solve(&sampled.collect::<Vec<_>>(), &[Output::Potential { source: 0 }]).expect("fields")
}

const EULER: f64 = 0.577_215_664_901_532_9;

/// `sum (-1)^(k+1) x^k / (k k!)`, beyond by the continued fraction of E1.
fn ein(x: f64) -> f64 {
    if x < 2.0 {
        let terms = (1..40).scan(-1.0, |power, k| {
            *power *= -x / f64::from(k);
            Some(*power / f64::from(k))
        });
        return terms.sum();
    }
    let fraction = (1..60).rev().fold(x, |rest, k| x + f64::from(k) / (1.0 + f64::from(k) / rest));
    (-x).exp() / fraction + x.ln() + EULER
}

/// Charges of 1, -0.7 and 0.4 with Gaussian profiles of three widths, and their potential in the plane.
const THREE: [(f64, f64, [f64; 2]); 3] =
    [(1.0, 0.12, [0.0, 0.1]), (-0.7, 0.045, [-0.3, -0.2]), (0.4, 0.016, [0.25, 0.3])];

/// `r^2 / 2 w^2` of each.
fn three(p: [f64; 2]) -> [f64; 3] {
    THREE.map(|(_, width, [a, b])| ((p[0] - a).powi(2) + (p[1] - b).powi(2)) / (2.0 * width * width))
}

fn three_charges(p: [f64; 2]) -> f64 {
    let of = |(x, (charge, width, _)): (f64, (f64, f64, [f64; 2]))| charge * (-x).exp() / (width * width);
    three(p).into_iter().zip(THREE).map(of).sum::<f64>() / (2.0 * PI)
}

fn their_potential(p: [f64; 2]) -> f64 {
    let of = |(x, (charge, width, _)): (f64, (f64, f64, [f64; 2]))| {
        charge * ((2.0 * width * width).ln() - EULER + ein(x))
    };
    -three(p).into_iter().zip(THREE).map(of).sum::<f64>() / (4.0 * PI)
}

/// Trees of as many levels as three widths of a source need: the tolerance holds for the true error at every point that counts, with a
/// small part of the points that one mesh would need.
#[test]
fn the_estimate_chooses_a_tree_to_a_tolerance() {
    let base = Mesh::of_box([-1.0; 2], [1.0; 2], [256; 2], Centring::Cell).expect("a mesh");
    for (tolerance, order, most) in [(1e-2, 4, 0.5), (1e-4, 4, 0.1), (1e-6, 6, 0.1)] {
        let refine = RefineParams { order, ..TreeParams::default().refine };
        let params = TreeParams { tolerance, refine, ..TreeParams::default() };
        let tree = suggest_tree(&base, three_charges, params).expect("a tree");
        let plan = RefinedPlan::new(&base, &tree, refine).expect("a plan");
        let fields = solve(&plan, three_charges);
        let worst = largest_error(&plan, &fields, their_potential);
        let finest = (0..plan.len()).map(|i| plan.mesh(i).spacing()[0]).fold(f64::INFINITY, f64::min);
        let sampled: usize = (0..plan.len()).map(|i| plan.source_mesh(i).len()).sum();
        let part = sampled as f64 * (finest / 2.0).powi(2);
        assert!(worst < tolerance, "{tolerance:e}: {worst:e}");
        assert!(part < most, "{tolerance:e}: {part} of the points of one mesh");
    }
}

/// `u = q / (4 pi r) erf(r / (sqrt 2 w))` of Gaussian charges of two widths in space, by a tree to a tolerance.
#[test]
fn a_tree_in_space_meets_its_tolerance() {
    const CHARGES: [(f64, f64, [f64; 3]); 2] =
        [(1.0, 0.17, [-0.1, 0.0, 0.05]), (0.1, 0.085, [0.3, 0.2, -0.1])];
    let distance = |p: [f64; 3], at: [f64; 3]| (0..3).map(|a| (p[a] - at[a]).powi(2)).sum::<f64>().sqrt();
    let source = |p: [f64; 3]| -> f64 {
        let of = |(charge, w, at): (f64, f64, [f64; 3])| {
            charge * (-distance(p, at).powi(2) / (2.0 * w * w)).exp() / (2.0 * PI * w * w).powf(1.5)
        };
        CHARGES.into_iter().map(of).sum()
    };
    let potential = |p: [f64; 3]| -> f64 {
        let of = |(charge, w, at): (f64, f64, [f64; 3])| {
            let r = distance(p, at).max(1e-9);
            charge * erf(r / (2.0_f64.sqrt() * w)) / (4.0 * PI * r)
        };
        CHARGES.into_iter().map(of).sum()
    };
    let base = Mesh::of_box([-1.0; 3], [1.0; 3], [44; 3], Centring::Cell).expect("a mesh");
    let refine = RefineParams { order: 4, ..TreeParams::default().refine };
    let params = TreeParams { tolerance: 1e-2, refine, ..TreeParams::default() };
    let tree = suggest_tree(&base, source, params).expect("a tree");
    assert!(!tree.is_empty());
    let plan = RefinedPlan::new(&base, &tree, refine).expect("a plan");
    let fields = solve(&plan, source);
    let worst = largest_error(&plan, &fields, potential);
    assert!(worst < 1e-2, "{worst:e}");
}

/// The largest error where a mesh is the finest one, over the largest magnitude.
fn largest_error<const D: usize>(
    plan: &RefinedPlan<D>,
    fields: &[Vec<Vec<f64>>],
    exact: impl Fn([f64; D]) -> f64,
) -> f64 {
    let (mut worst, mut largest) = (0.0_f64, 0.0_f64);
    for (index, field) in fields.iter().enumerate() {
        let mesh = plan.mesh(index);
        let finer: Vec<&Mesh<D>> = plan.patches_of(index).map(|i| plan.mesh(i)).collect();
        let inside = |p: [f64; D], m: &Mesh<D>| (0..D).all(|a| p[a] > m.min()[a] && p[a] < m.max()[a]);
        for (point, value) in field[0].iter().enumerate() {
            let p = mesh.point(point);
            let exact = exact(p);
            largest = largest.max(exact.abs());
            if !finer.iter().any(|m| inside(p, m)) {
                worst = worst.max((value - exact).abs());
            }
        }
    }
    worst / largest
}

/// The error function by its series and, from 3 on, its continued fraction; to 1e-12.
fn erf(x: f64) -> f64 {
    if x > 3.0 {
        let fraction = (1..60).rev().fold(x, |below, k| x + 0.5 * f64::from(k) / below);
        return 1.0 - (-x * x).exp() / (PI.sqrt() * fraction);
    }
    let mut term = x;
    let mut sum = x;
    for k in 1..80 {
        term *= -x * x / f64::from(k);
        sum += term / f64::from(2 * k + 1);
    }
    2.0 / PI.sqrt() * sum
}

#[test]
fn trees_that_cannot_be_are_refused() {
    let base = Mesh::of_box([-1.0; 2], [1.0; 2], [64; 2], Centring::Cell).expect("a mesh");
    let said = suggest_tree(&base, three_charges, TreeParams::default());
    assert!(matches!(said, Err(FreeSpaceError::Tolerance { .. })), "{said:?}");
    let base = Mesh::of_box([-1.0; 2], [1.0; 2], [256; 2], Centring::Cell).expect("a mesh");
    let said = suggest_tree(&base, three_charges, TreeParams { levels: 1, ..TreeParams::default() });
    assert!(matches!(said, Err(FreeSpaceError::Levels { levels: 1, .. })), "{said:?}");
    let nothing = suggest_tree(&base, |_| 0.0, TreeParams::default());
    assert_eq!(nothing, Ok(Vec::new()));
    let said = suggest_tree(&base, |p| three_charges([p[0] - 0.7, p[1]]), TreeParams::default());
    assert!(matches!(said, Err(FreeSpaceError::Edge { edge, .. }) if edge > 1e-3), "{said:?}");
}

/// Bad input is an error that says which, never a panic and never a loop.
/// The spectrum of the samples of a disc is that of a smooth source in phi; how much charge is at its rim samples do not know.
#[test]
fn a_source_that_ends_abruptly_is_not_resolved() {
    let base = Mesh::of_box([-1.0; 2], [1.0; 2], [64; 2], Centring::Cell).expect("a mesh");
    let disc = |p: [f64; 2]| f64::from(u8::from(p[0].hypot(p[1]) < 0.4));
    let tree = suggest_tree(&base, disc, TreeParams { tolerance: 1e-4, ..TreeParams::default() });
    assert!(matches!(tree, Err(FreeSpaceError::Tolerance { error, .. }) if error > 1e-4), "{tree:?}");
}

#[test]
fn trees_of_bad_input_are_refused() {
    let base = Mesh::of_box([-1.0; 2], [1.0; 2], [64; 2], Centring::Cell).expect("a mesh");
    let wide = |p: [f64; 2]| (-(p[0] * p[0] + p[1] * p[1]) / 0.02).exp();
    let good = TreeParams { tolerance: 1e-5, ..TreeParams::default() };
    let refined = suggest_tree(&base, wide, good).expect("a tree");
    assert!(!refined.is_empty());
    for tolerance in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let said = suggest_tree(&base, wide, TreeParams { tolerance, ..good });
        assert!(matches!(said, Err(FreeSpaceError::Invalid { .. })), "{tolerance}: {said:?}");
    }
    for ratio in [0, 1] {
        let said = suggest_tree(&base, wide, TreeParams { ratio, ..good });
        assert!(matches!(said, Err(FreeSpaceError::Invalid { .. })), "{ratio}: {said:?}");
    }
    assert!(suggest_tree(&base, wide, TreeParams { ratio: usize::MAX, ..good }).is_err());
    let none = suggest_tree(&base, wide, TreeParams { levels: 0, ..good });
    assert!(matches!(none, Err(FreeSpaceError::Levels { levels: 0, .. })), "{none:?}");
    for smoothing in [0.0, f64::NAN, f64::INFINITY] {
        let refine = RefineParams { smoothing: Some(smoothing), ..good.refine };
        assert!(suggest_tree(&base, wide, TreeParams { refine, ..good }).is_err(), "{smoothing}");
    }
    let refine = RefineParams { order: 5, ..good.refine };
    let said = suggest_tree(&base, wide, TreeParams { refine, ..good });
    assert_eq!(said, Err(FreeSpaceError::Order { order: 5 }));
    let holed = |p: [f64; 2]| if p[0].abs() < 0.02 { f64::NAN } else { wide(p) };
    let said = suggest_tree(&base, holed, good);
    assert!(matches!(said, Err(FreeSpaceError::NotFinite { .. })), "{said:?}");
}
