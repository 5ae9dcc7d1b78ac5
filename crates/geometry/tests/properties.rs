//! Invariants of shapes and clouds for random parameters.

use std::sync::Arc;

use meshless_geometry::{
    Aabb, Cloud, CloudParams, Domain, Layout, LevelSet, RegionMap, Shape, Spacing, generate, quality,
};
use proptest::prelude::*;

fn distance<const D: usize>(a: &[f64; D], b: &[f64; D]) -> f64 {
    (0..D).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt()
}

fn norm<const D: usize>(a: &[f64; D]) -> f64 {
    distance(a, &[0.0; D])
}

fn rotate(x: [f64; 2], angle: f64, shift: [f64; 2]) -> [f64; 2] {
    let (s, c) = angle.sin_cos();
    [c * x[0] - s * x[1] + shift[0], s * x[0] + c * x[1] + shift[1]]
}

fn star(points: usize, inner: f64) -> Vec<[f64; 2]> {
    (0..2 * points)
        .map(|i| {
            let angle = i as f64 * std::f64::consts::PI / points as f64;
            let r = if i % 2 == 0 { 1.0 } else { inner };
            [r * angle.cos(), r * angle.sin()]
        })
        .collect()
}

fn check_projection<const D: usize>(shape: &Shape<D>, x: &[f64; D]) {
    let p = shape.project(x, 10.0).expect("it exists");
    let slope = norm(&shape.gradient(&p.point));
    assert!(shape.level(&p.point).abs() <= 1e-11 * slope.max(1.0), "{shape:?} {x:?} {p:?}");
    assert!((norm(&p.normal) - 1.0).abs() < 1e-12);
    assert!((p.distance.abs() - distance(x, &p.point)).abs() < 1e-11);
    assert!(p.distance * shape.level(x) >= -1e-14);
}

fn clouds_agree<const D: usize>(a: &Cloud<D>, b: &Cloud<D>) -> bool {
    a.points().iter().zip(b.points()).all(|(p, q)| (0..D).all(|i| p[i].to_bits() == q[i].to_bits())) && a == b
}

fn check_cloud<const D: usize>(domain: &Domain<D>, params: &CloudParams<D>) -> Cloud<D> {
    let cloud = generate(domain, params).expect("it exists");
    let q = quality(&cloud, domain);
    assert!(q.relative_separation > 0.75, "separation {q:?}");
    assert!(q.relative_fill < 1.35, "fill {q:?}");
    for (i, x) in cloud.points().iter().enumerate() {
        assert!(domain.contains(x, 1e-12), "node {i} at {x:?} lies outside");
        let surface = domain.level(x).abs() / norm(&domain.gradient(x));
        if cloud.is_boundary(i) {
            assert!(surface < 1e-9, "boundary node {i} at {x:?} is {surface} off");
        } else {
            assert!(
                surface > 0.3 * cloud.spacing()[i],
                "interior node {i} at {x:?} is {surface} from the boundary"
            );
        }
    }
    for b in cloud.boundary() {
        let x = &cloud.points()[b.node as usize];
        for t in &b.touches {
            let p = domain.project_to_face(t.face, x).expect("it exists");
            assert!(p.distance.abs() < 1e-9, "node at {x:?} is not on face {:?}", t.face);
        }
        if let [t] = b.touches[..] {
            let h = 1e-3 * cloud.spacing()[b.node as usize];
            let moved = |s: f64| std::array::from_fn(|i| x[i] + s * h * t.normal[i]);
            assert!(domain.level(&moved(1.0)) > 0.0 && domain.level(&moved(-1.0)) < 0.0, "normal at {x:?}");
        }
    }
    cloud
}

fn irregular<const D: usize>(spacing: f64, seed: u64) -> CloudParams<D> {
    CloudParams { spacing: Spacing::Uniform(spacing), layout: Layout::Irregular, seed, max_nodes: 100_000 }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]

    #[test]
    fn primitives_have_unit_gradients_that_match_differences(x in prop::array::uniform3(-2.0..2.0f64)) {
        let shapes = [
            Shape::ball([0.1, 0.2, -0.1], 0.7).unwrap(),
            Shape::cuboid([-0.5, -0.6, -0.7], [0.4, 0.8, 0.3]).unwrap(),
            Shape::cylinder([0.0, 0.1, 0.0], [1.0, 2.0, 3.0], 0.6, Some(1.1)).unwrap(),
            Shape::cylinder([0.0, 0.1, 0.0], [1.0, 2.0, 3.0], 0.6, None).unwrap(),
            Shape::half_space([0.1, 0.0, 0.0], [1.0, -2.0, 0.5]).unwrap(),
        ];
        for shape in &shapes {
            let g = shape.gradient(&x);
            prop_assert!((norm(&g) - 1.0).abs() < 1e-12);
            check_projection(shape, &x);
            // One-sided differences that agree tell that no edge is within reach.
            let step = 1e-6;
            for i in 0..3 {
                let moved = |s: f64| { let mut y = x; y[i] += s * step; shape.level(&y) };
                let (up, down) = (moved(1.0) - moved(0.0), moved(0.0) - moved(-1.0));
                if (up - down).abs() < 1e-10 {
                    prop_assert!(((up + down) / (2.0 * step) - g[i]).abs() < 1e-4);
                }
            }
        }
    }

    #[test]
    fn signed_distances_do_not_change_under_rigid_motions(
        x in prop::array::uniform2(-2.0..2.0f64),
        shift in prop::array::uniform2(-3.0..3.0f64),
        angle in 0.0..6.3f64,
        points in 3..8usize,
        inner in 0.3..0.9f64,
    ) {
        let vertices = star(points, inner);
        let moved: Vec<_> = vertices.iter().map(|v| rotate(*v, angle, shift)).collect();
        let (a, b) = (Shape::polygon(vertices).unwrap(), Shape::polygon(moved).unwrap());
        let y = rotate(x, angle, shift);
        prop_assert!((a.level(&x) - b.level(&y)).abs() < 1e-12);
        check_projection(&a, &x);
        let (p, q) = (a.project(&x, 10.0).unwrap(), b.project(&y, 10.0).unwrap());
        prop_assert!((p.distance - q.distance).abs() < 1e-12);
    }

    #[test]
    fn level_sets_that_are_no_distances_are_projected_onto(
        t in 0.0..std::f64::consts::TAU,
        offset in -0.2..0.6f64,
        steep in 0.5..8.0f64,
    ) {
        // The foot of c + offset * n is c as long as the centre of curvature is farther (at least 0.25 away here).
        let ellipse: Shape<2> = Shape::level_set(Arc::new(|x: &[f64; 2]| x[0] * x[0] + 4.0 * x[1] * x[1] - 1.0));
        let exponential: Shape<2> = Shape::level_set(Arc::new(move |x: &[f64; 2]| {
            (steep * (x[0] * x[0] + 4.0 * x[1] * x[1] - 1.0)).exp() - 1.0
        }));
        let c = [t.cos(), 0.5 * t.sin()];
        let g = [2.0 * c[0], 8.0 * c[1]];
        let n = [g[0] / norm(&g), g[1] / norm(&g)];
        let x = [c[0] + offset * n[0], c[1] + offset * n[1]];
        for shape in [ellipse, exponential] {
            let p = shape.project(&x, 2.0).unwrap();
            prop_assert!(distance(&p.point, &c) < 1e-8, "{:?} {:?}", p, c);
            prop_assert!(distance(&p.normal, &n) < 1e-7);
            prop_assert!((p.distance - offset).abs() < 1e-8);
        }
    }

    #[test]
    fn a_cubic_curve_is_projected_onto(a in -1.0..1.0f64, offset in -0.05..0.05f64) {
        let shape: Shape<2> = Shape::level_set(Arc::new(|x: &[f64; 2]| 2.0 * x[0].powi(3) - x[1]));
        let g = [6.0 * a * a, -1.0];
        let n = [g[0] / norm(&g), g[1] / norm(&g)];
        let c = [a, 2.0 * a.powi(3)];
        let p = shape.project(&[c[0] + offset * n[0], c[1] + offset * n[1]], 1.0).unwrap();
        prop_assert!(distance(&p.point, &c) < 1e-8);
    }

    #[test]
    fn differences_agree_with_exact_gradients(x in prop::array::uniform2(-1.5..1.5f64)) {
        let f = |x: &[f64; 2]| (x[0] * x[1]).sin() + x[0].exp();
        let g = f.gradient(&x);
        let exact = [x[1] * (x[0] * x[1]).cos() + x[0].exp(), x[0] * (x[0] * x[1]).cos()];
        prop_assert!(distance(&g, &exact) < 1e-9);
    }

    #[test]
    fn composites_are_projected_onto(x in prop::array::uniform2(-1.0..1.0f64)) {
        let two = Shape::union(vec![
            Shape::ball([-0.4, 0.0], 0.6).unwrap(),
            Shape::ball([0.4, 0.0], 0.6).unwrap(),
        ]).unwrap();
        let cut = Shape::cuboid([-0.9, -0.9], [0.9, 0.9]).unwrap().difference(Shape::ball([0.3, 0.2], 0.5).unwrap());
        for shape in [two, cut] {
            if let Ok(p) = shape.project(&x, 3.0) {
                prop_assert!(shape.level(&p.point).abs() < 1e-9);
                prop_assert!((norm(&p.normal) - 1.0).abs() < 1e-12);
            } else {
                prop_assert!(false, "no projection of {:?} onto {:?}", x, shape);
            }
        }
    }

    #[test]
    fn rounding_does_not_flip_labels(t in 0.0..std::f64::consts::TAU, noise in prop::array::uniform2(-1e-14..1e-14f64)) {
        let map = RegionMap::new(vec![Some(Shape::ball([0.2, 0.1], 0.7).unwrap()), None]).unwrap();
        let x = [0.2 + 0.7 * t.cos() + noise[0], 0.1 + 0.7 * t.sin() + noise[1]];
        prop_assert_eq!(map.label(&x, 0.05), 0);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 12, ..ProptestConfig::default() })]

    #[test]
    fn irregular_clouds_in_1d(seed: u64, spacing in 0.005..0.1f64) {
        let domain = Domain::boxed([-1.0], [2.0]).unwrap();
        let cloud = check_cloud(&domain, &irregular(spacing, seed));
        prop_assert!((cloud.len() as f64 - 1.0 - 3.0 / spacing).abs() <= 1.0);
    }

    #[test]
    fn irregular_clouds_in_2d(seed: u64, spacing in 0.03..0.1f64, r in 0.2..0.35f64) {
        let domain = Domain::boxed([0.0, 0.0], [1.3, 1.0]).unwrap()
            .with_hole("hole", Shape::ball([0.5, 0.5], r).unwrap()).unwrap();
        let params = irregular(spacing, seed);
        let cloud = check_cloud(&domain, &params);
        prop_assert!(clouds_agree(&cloud, &generate(&domain, &params).unwrap()));
    }

    #[test]
    fn irregular_clouds_in_an_ellipse(seed: u64, spacing in 0.03..0.1f64) {
        let level = Arc::new(|x: &[f64; 2]| x[0] * x[0] + 4.0 * x[1] * x[1] - 1.0);
        let bounds = Aabb::new([-1.2, -0.7], [1.1, 0.8]).unwrap();
        let domain = Domain::from_shape(Shape::level_set(level), Some(bounds)).unwrap();
        check_cloud(&domain, &irregular(spacing, seed));
    }

    #[test]
    fn irregular_clouds_in_3d(seed: u64, spacing in 0.09..0.2f64) {
        let ball = Domain::from_shape(Shape::ball([0.1, 0.2, 0.3], 0.8).unwrap(), None).unwrap();
        check_cloud(&ball, &irregular(spacing, seed));
        let cube = Domain::boxed([0.0; 3], [1.0; 3]).unwrap();
        check_cloud(&cube, &irregular(spacing, seed));
    }

    #[test]
    fn graded_clouds(seed: u64, slope in 0.05..0.3f64) {
        let spacing = Spacing::Graded(Arc::new(move |x: &[f64; 2]| 0.02 + slope * x[0].hypot(x[1])));
        let params = CloudParams { spacing, layout: Layout::Irregular, seed, max_nodes: 100_000 };
        check_cloud(&Domain::boxed([0.0, 0.0], [1.0, 1.0]).unwrap(), &params);
        let disc = Domain::from_shape(Shape::ball([0.5, 0.5], 0.5).unwrap(), None).unwrap();
        check_cloud(&disc, &params);
    }
}
