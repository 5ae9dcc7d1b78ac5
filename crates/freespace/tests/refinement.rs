//! Patches against uniform fine meshes.

use meshless_freespace::{
    Centring, FreeSpaceError, Kernel, Mesh, Output, Patch, Plan, RefineParams, RefinedPlan, Superposition,
    Workspace,
};
use proptest::prelude::*;

fn difference(a: &[f64], b: &[f64]) -> f64 {
    let scale = b.iter().fold(f64::MIN_POSITIVE, |s, v| s.max(v.abs()));
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).fold(0.0_f64, |m, (x, y)| m.max((x - y).abs())) / scale
}

/// phi and its gradient on all meshes.
fn solve<const D: usize>(
    plan: &RefinedPlan<D>,
    source: impl Fn([f64; D]) -> f64 + Copy,
    wanted: &[Output],
) -> Vec<Vec<Vec<f64>>> {
    let sources: Vec<Vec<Vec<f64>>> =
        (0..plan.len()).map(|i| vec![plan.source_mesh(i).sample(source)]).collect();
    plan.solve(&sources, wanted).expect("fields")
}

/// The same on one fine mesh, at the points of another.
fn uniform<const D: usize>(
    fine: &Mesh<D>,
    at: &Mesh<D>,
    order: usize,
    source: impl Fn([f64; D]) -> f64,
    wanted: &[Output],
) -> Vec<Vec<f64>> {
    let plan: Plan<D> = Plan::new(fine, Kernel::Gaussian { order, smoothing: Some(2.0) }).expect("a plan");
    let mut out = Vec::new();
    plan.solve(&[&fine.sample(source)], wanted, &mut Workspace::default(), &mut out).expect("fields");
    let place = |p: [f64; D], a: usize| ((p[a] - fine.coordinate(a, 0)) / fine.spacing()[a]).round() as usize;
    out.iter()
        .map(|field| {
            (0..at.len()).map(|i| field[fine.index(std::array::from_fn(|a| place(at.point(i), a)))]).collect()
        })
        .collect()
}

/// Smooth to round-off on the meshes below.
fn blob<const D: usize>(p: [f64; D]) -> f64 {
    let square: f64 = p.iter().enumerate().map(|(a, x)| (x - 0.05 * a as f64).powi(2)).sum();
    (-square / (2.0 * 0.11 * 0.11)).exp()
}

fn wanted(axis: usize) -> [Output; 2] {
    [Output::Potential { source: 0 }, Output::Gradient { source: 0, axis }]
}

fn params(superposition: Superposition) -> RefineParams {
    RefineParams { order: 6, superposition, ..RefineParams::default() }
}

/// Whether the patches of `plan` have the uniform solution, up to `limit`.
fn check<const D: usize>(plan: &RefinedPlan<D>, cells: [usize; D], limit: f64) {
    for axis in 0..D {
        let found = solve(plan, blob, &wanted(axis));
        for index in 1..plan.len() {
            let base = plan.mesh(0);
            let ratio = (base.spacing()[0] / plan.mesh(index).spacing()[0]).round() as usize;
            let fine = Mesh::of_box(base.min(), base.max(), cells.map(|n| n * ratio), base.centring())
                .expect("a mesh");
            let expected = uniform(&fine, plan.mesh(index), 6, blob, &wanted(axis));
            for (found, expected) in found[index].iter().zip(&expected) {
                let error = difference(found, expected);
                assert!(error < limit, "mesh {index} axis {axis}: {error:e}");
            }
        }
    }
}

/// The base mesh holds the source to 1e-14, so that what the two meshes disagree on is round-off.
#[test]
fn a_patch_is_the_uniform_fine_mesh() {
    for centring in [Centring::Cell, Centring::Node] {
        let base = Mesh::of_box([-1.0; 2], [1.0; 2], [64; 2], centring).expect("a mesh");
        for ratio in [2, 3, 4] {
            let patch = Patch::covering(&base, [-0.5; 2], [0.5, 0.25], ratio);
            let plan = RefinedPlan::new(&base, &[patch], params(Superposition::Shift)).expect("a plan");
            check(&plan, [64; 2], 1e-12);
        }
    }
}

#[test]
fn patches_in_space_and_bordering_patches() {
    let base = Mesh::of_box([-0.9; 3], [0.9; 3], [40; 3], Centring::Cell).expect("a mesh");
    let halves = [
        Patch::covering(&base, [-0.3, -0.3, -0.3], [0.0, 0.3, 0.3], 2),
        Patch::covering(&base, [0.0, -0.3, -0.3], [0.3, 0.3, 0.3], 2),
    ];
    let shift = RefineParams { tolerance: 1e-13, ..params(Superposition::Shift) };
    check(&RefinedPlan::new(&base, &halves, shift).expect("a plan"), [40; 3], 1e-10);
}

#[test]
fn nested_patches_and_interpolation() {
    let base = Mesh::of_box([-1.0; 2], [1.0; 2], [64; 2], Centring::Cell).expect("a mesh");
    let outer = Patch::covering(&base, [-0.6; 2], [0.6; 2], 2);
    let inner = Patch { parent: Some(0), first: [20, 24], cells: [36, 30], ratio: 2 };
    for (superposition, limit) in [
        (Superposition::Shift, 1e-11),
        (Superposition::Lagrange(14), 1e-6),
        (Superposition::Lagrange(8), 1e-4),
        (Superposition::M6Star, 1e-3),
    ] {
        let plan = RefinedPlan::new(&base, &[outer, inner], params(superposition)).expect("a plan");
        assert_eq!(plan.patches_of(1).collect::<Vec<_>>(), [2]);
        check(&plan, [64; 2], limit);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(6))]

    /// A source inside of one patch, wherever the patch is.
    #[test]
    fn a_source_inside_of_a_patch(first in [18_usize..22, 18_usize..22], cells in [20_usize..24, 20_usize..24]) {
        let base = Mesh::of_box([-1.0; 2], [1.0; 2], [64; 2], Centring::Cell).expect("a mesh");
        let patch = Patch { parent: None, first, cells, ratio: 2 };
        let plan = RefinedPlan::new(&base, &[patch], params(Superposition::Shift)).expect("a plan");
        check(&plan, [64; 2], 1e-12);
    }
}

#[test]
fn patches_that_cannot_be_are_refused() {
    let base = Mesh::of_box([-1.0; 2], [1.0; 2], [16; 2], Centring::Cell).expect("a mesh");
    let said = |patches: &[Patch<2>]| match RefinedPlan::new(&base, patches, RefineParams::default()) {
        Err(FreeSpaceError::Patch { what, .. }) => what,
        other => panic!("{other:?}"),
    };
    let good = Patch { parent: None, first: [6; 2], cells: [4; 2], ratio: 2 };
    assert!(said(&[Patch { ratio: 1, ..good }]).contains("ratio is 1"));
    assert!(said(&[Patch { first: [6, 14], ..good }]).contains("direction 1, which has 16"));
    assert!(said(&[Patch { first: [1, 6], ..good }]).contains("too close"));
    assert!(said(&[Patch { parent: Some(0), ..good }]).contains("does not come before"));
    assert!(said(&[Patch { cells: [0, 4], ..good }]).contains("covers"));
}
