//! Clouds of particular domains.

use std::sync::Arc;

use meshless_geometry::{
    Aabb, BoundaryNode, Cloud, CloudParams, Domain, FaceId, GeometryError, Layout, Shape, Spacing, Touch,
    estimate_nodes, generate, quality,
};

fn params<const D: usize>(spacing: f64, layout: Layout) -> CloudParams<D> {
    CloudParams { spacing: Spacing::Uniform(spacing), layout, seed: 7, max_nodes: 200_000 }
}

fn on_face<const D: usize>(cloud: &Cloud<D>, face: FaceId) -> Vec<[f64; D]> {
    let touching = cloud.boundary().iter().filter(|b| b.touches.iter().any(|t| t.face == face));
    touching.map(|b| cloud.points()[b.node as usize]).collect()
}

fn distance<const D: usize>(a: &[f64; D], b: &[f64; D]) -> f64 {
    (0..D).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt()
}

/// Nodes that are deeper inside than three spacings, over their number if each had the volume `s^D`.
fn density<const D: usize>(domain: &Domain<D>, layout: Layout, spacing: f64) -> f64 {
    let cloud = generate(domain, &params(spacing, layout)).expect("a cloud");
    // A depth half-way between lattice planes, where counting is fair to lattices too.
    let depth = 2.5 * spacing;
    let inner: f64 = domain.bounds().lengths().iter().map(|l| l - 2.0 * depth).product();
    let inside = cloud.points().iter().filter(|x| domain.level(x) < -depth).count();
    inside as f64 * spacing.powi(D as i32) / inner
}

#[test]
fn a_spacing_means_the_same_density_in_every_layout() {
    for layout in [Layout::Grid, Layout::Jittered, Layout::Irregular] {
        let line = density(&Domain::boxed([0.0], [1.0]).unwrap(), layout, 0.005);
        let square = density(&Domain::boxed([0.0; 2], [1.0; 2]).unwrap(), layout, 0.0125);
        let cube = density(&Domain::boxed([0.0; 3], [1.0; 3]).unwrap(), layout, 0.05);
        for density in [line, square, cube] {
            assert!((density - 1.0).abs() < 0.1, "{layout:?}: {line} {square} {cube}");
        }
    }
}

#[test]
fn grids_of_boxes_are_grids() {
    let domain = Domain::boxed([0.0, 1.0], [1.0, 3.0]).unwrap();
    let cloud = generate(&domain, &params(0.1, Layout::Grid)).unwrap();
    assert_eq!(cloud.len(), 11 * 21);
    assert_eq!(cloud.boundary().len(), 2 * (11 + 21) - 4);
    for x in cloud.points() {
        let t = [x[0] / 0.1, (x[1] - 1.0) / 0.1];
        assert!(t.iter().all(|v| (v - v.round()).abs() < 1e-12), "{x:?}");
    }
    let q = quality(&cloud, &domain);
    assert!((q.separation - 0.1).abs() < 1e-12);
    assert!((q.mesh_ratio - 2.0_f64.sqrt()).abs() < 0.05);
}

#[test]
fn corners_touch_every_face_that_meets_there() {
    for layout in [Layout::Grid, Layout::Irregular] {
        let domain = Domain::boxed([0.0; 3], [1.0; 3]).unwrap();
        assert_eq!(domain.faces(), ["left", "right", "bottom", "top", "back", "front"]);
        let cloud = generate(&domain, &params(0.125, layout)).unwrap();
        let count = |n: usize| cloud.boundary().iter().filter(|b| b.touches.len() == n).count();
        // Eight corners; seven nodes inside of each of twelve edges.
        assert_eq!((count(3), count(2)), (8, 84));
        for b in cloud.boundary() {
            let x = cloud.points()[b.node as usize];
            for t in &b.touches {
                let (axis, upper) = domain.box_plane(t.face).unwrap();
                assert_eq!(x[axis], if upper { 1.0 } else { 0.0 });
                assert_eq!(t.normal[axis], if upper { 1.0 } else { -1.0 });
            }
        }
    }
}

#[test]
fn curves_are_sampled_evenly() {
    let outline = |domain: &Domain<2>, face: u16, length: f64, center: [f64; 2]| {
        let cloud = generate(domain, &params(0.05, Layout::Irregular)).unwrap();
        let mut nodes = on_face(&cloud, FaceId(face));
        let angle = |x: &[f64; 2]| (x[1] - center[1]).atan2(x[0] - center[0]);
        nodes.sort_by(|a, b| angle(a).total_cmp(&angle(b)));
        assert_eq!(nodes.len(), (length / 0.05).round() as usize);
        for i in 0..nodes.len() {
            let gap = distance(&nodes[i], &nodes[(i + 1) % nodes.len()]) / 0.05;
            assert!((0.9..1.1).contains(&gap), "gap {gap} at {:?}", nodes[i]);
        }
    };
    let tau = std::f64::consts::TAU;
    outline(&Domain::from_shape(Shape::ball([0.3, 0.2], 1.0).unwrap(), None).unwrap(), 0, tau, [0.3, 0.2]);
    let hole = Shape::ball([0.5, 0.5], 0.25).unwrap();
    let plate = Domain::boxed([0.0; 2], [1.0; 2]).unwrap().with_hole("hole", hole).unwrap();
    outline(&plate, 4, 0.25 * tau, [0.5, 0.5]);
    // Half axes 1 and 1/2; Ramanujan's formula gives the perimeter to 1e-5.
    let level = Arc::new(|x: &[f64; 2]| x[0] * x[0] + 4.0 * x[1] * x[1] - 1.0);
    let bounds = Aabb::new([-1.5; 2], [1.5; 2]).unwrap();
    let ellipse = Domain::from_shape(Shape::level_set(level), Some(bounds)).unwrap();
    outline(&ellipse, 0, 4.844_22, [0.0, 0.0]);
}

#[test]
fn polygon_vertices_have_two_normals() {
    let triangle = vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
    let domain = Domain::from_shape(Shape::polygon(triangle.clone()).unwrap(), None).unwrap();
    for layout in [Layout::Jittered, Layout::Irregular] {
        let cloud = generate(&domain, &params(0.05, layout)).unwrap();
        let corners: Vec<_> = cloud.boundary().iter().filter(|b| b.touches.len() == 2).collect();
        assert_eq!(corners.len(), 3);
        for v in &triangle {
            let found = corners.iter().find(|b| cloud.points()[b.node as usize] == *v);
            assert!(found.is_some_and(|b| b.touches.iter().all(|t| t.face == FaceId(0))), "{v:?}");
        }
    }
}

#[test]
fn shapes_that_trim_each_other_meet_in_corner_nodes() {
    // A hole over the corner of a square: it meets left and bottom at 0.3 from the corner.
    let domain = Domain::boxed([0.0; 2], [1.0; 2])
        .unwrap()
        .with_hole("bite", Shape::ball([0.0, 0.0], 0.3).unwrap())
        .unwrap();
    for layout in [Layout::Grid, Layout::Irregular] {
        let cloud = generate(&domain, &params(0.04, layout)).unwrap();
        for (face, x) in [("left", [0.0, 0.3]), ("bottom", [0.3, 0.0])] {
            let b = cloud
                .boundary()
                .iter()
                .find(|b| distance(&cloud.points()[b.node as usize], &x) < 1e-12)
                .expect("a node where the surfaces meet");
            let faces: Vec<_> = b.touches.iter().map(|t| t.face).collect();
            assert_eq!(faces, [domain.face(face).unwrap(), domain.face("bite").unwrap()]);
        }
        assert!(cloud.points().iter().all(|x| x[0].hypot(x[1]) > 0.3 - 1e-12));
    }
}

#[test]
fn flush_surfaces_bound_nothing() {
    // The notch shares a part of the bottom, which is no boundary there.
    let domain = Domain::boxed([0.0; 2], [1.0; 2])
        .unwrap()
        .with_hole("notch", Shape::cuboid([0.3, 0.0], [0.6, 0.5]).unwrap())
        .unwrap();
    for layout in [Layout::Grid, Layout::Irregular] {
        let cloud = generate(&domain, &params(0.05, layout)).unwrap();
        let flush = cloud.points().iter().filter(|x| x[1] < 0.49 && x[0] > 0.301 && x[0] < 0.599).count();
        assert_eq!(flush, 0);
        assert_eq!(cloud.boundary().iter().filter(|b| b.touches.len() == 2).count(), 8);
    }
}

#[test]
fn parts_that_are_not_connected_are_all_found() {
    let discs =
        |x: &[f64; 2]| ((x[0] - 1.0).powi(2) + x[1] * x[1] - 0.25).min((x[0] + 1.0).hypot(x[1]) - 0.3);
    let bounds = Aabb::new([-2.0, -1.0], [2.0, 1.0]).unwrap();
    let domain = Domain::from_shape(Shape::level_set(Arc::new(discs)), Some(bounds)).unwrap();
    let cloud = generate(&domain, &params(0.05, Layout::Irregular)).unwrap();
    let left = cloud.points().iter().filter(|x| x[0] < 0.0).count() as f64;
    let right = cloud.points().iter().filter(|x| x[0] > 0.0).count() as f64;
    // Areas plus half a layer of boundary nodes.
    let expected = |r: f64| std::f64::consts::PI * (r / 0.05) * (r / 0.05 + 1.0);
    assert!((left / expected(0.3) - 1.0).abs() < 0.1, "{left}");
    assert!((right / expected(0.5) - 1.0).abs() < 0.1, "{right}");
}

#[test]
fn edges_of_solids_are_sampled() {
    // A cylinder in a cube cuts circles out of two faces.
    let rod = Shape::cylinder([0.5; 3], [0.0, 0.0, 1.0], 0.25, None).unwrap();
    let domain = Domain::boxed([0.0; 3], [1.0; 3]).unwrap().with_hole("bore", rod).unwrap();
    let cloud = generate(&domain, &params(0.08, Layout::Irregular)).unwrap();
    let bore = domain.face("bore").unwrap();
    for z in ["back", "front"] {
        let face = domain.face(z).unwrap();
        let rim = cloud
            .boundary()
            .iter()
            .filter(|b| [face, bore].iter().all(|f| b.touches.iter().any(|t| t.face == *f)));
        assert_eq!(rim.count(), (0.25 * std::f64::consts::TAU / 0.08).round() as usize);
    }
    let q = quality(&cloud, &domain);
    assert!(q.relative_separation > 0.75 && q.relative_fill < 1.35, "{q:?}");
}

#[test]
fn requests_that_cannot_be_met_are_refused_with_figures() {
    let square = Domain::boxed([0.0; 2], [1.0; 2]).unwrap();
    let ask = |spacing: f64| generate(&square, &params(spacing, Layout::Irregular));
    assert!(matches!(ask(0.0), Err(GeometryError::InvalidSpacing { spacing: 0.0, .. })));
    assert!(matches!(ask(f64::NAN), Err(GeometryError::InvalidSpacing { .. })));
    assert!(matches!(ask(2.0), Err(GeometryError::SpacingTooLarge { .. })));
    let Err(GeometryError::TooManyNodes { estimate, limit, factor }) = ask(1e-5) else {
        panic!("1e10 nodes")
    };
    assert!((estimate / 1e10 - 1.0).abs() < 1e-3);
    assert_eq!(limit, 200_000);
    assert!(estimate_nodes(&square, &Spacing::Uniform(1e-5 * factor)).unwrap() <= 200_000.0);
    assert!(ask(1e-5 * factor).is_ok());
    let nan = Spacing::Graded(Arc::new(|x: &[f64; 2]| if x[0] > 0.5 { f64::NAN } else { 0.1 }));
    let graded = |layout| CloudParams { spacing: nan.clone(), layout, seed: 1, max_nodes: 1000 };
    let Err(GeometryError::InvalidSpacing { at, .. }) = generate(&square, &graded(Layout::Irregular)) else {
        panic!("NaN was accepted")
    };
    assert!(at[0] > 0.5);
    let smooth =
        CloudParams { spacing: Spacing::Graded(Arc::new(|_: &[f64; 2]| 0.1)), ..graded(Layout::Grid) };
    assert!(matches!(generate(&square, &smooth), Err(GeometryError::GradedLattice { layout: "grid" })));
}

#[test]
fn parts_of_a_cloud_are_checked() {
    let touch = |normal| BoundaryNode { node: 0, touches: vec![Touch { face: FaceId(0), normal }] };
    let make = |points: Vec<[f64; 2]>, boundary, spacing| Cloud::from_parts(points, boundary, spacing);
    assert!(make(vec![[0.0, 0.0]], vec![touch([1.0, 0.0])], vec![0.1]).is_ok());
    assert!(make(vec![[0.0, f64::NAN]], vec![], vec![0.1]).is_err());
    assert!(make(vec![[0.0, 0.0]], vec![touch([1.0, 0.1])], vec![0.1]).is_err());
    assert!(make(vec![[0.0, 0.0]], vec![touch([1.0, 0.0]), touch([1.0, 0.0])], vec![0.1]).is_err());
    assert!(make(vec![[0.0, 0.0]], vec![], vec![0.0]).is_err());
    assert!(make(vec![], vec![touch([1.0, 0.0])], vec![]).is_err());
}

#[test]
fn reordered_clouds_keep_their_boundary() {
    let domain = Domain::boxed([0.0; 2], [1.0; 2]).unwrap();
    let cloud = generate(&domain, &params(0.1, Layout::Irregular)).unwrap();
    let order: Vec<u32> = (0..cloud.len() as u32).rev().collect();
    let reversed = cloud.permuted(&order).unwrap();
    for i in 0..cloud.len() {
        let j = cloud.len() - 1 - i;
        assert_eq!(cloud.points()[i], reversed.points()[j]);
        assert_eq!(cloud.boundary_of(i).map(|b| &b.touches), reversed.boundary_of(j).map(|b| &b.touches));
    }
    assert_eq!(reversed.permuted(&order).unwrap(), cloud);
    assert!(cloud.permuted(&order[1..]).is_err());
}

/// Spacings that fall by orders of magnitude towards a point: the counts are those of the integral of `1/h^D`, by hand.
#[test]
fn spacings_that_fall_to_a_point_are_counted() {
    let square = Domain::boxed([-1.0; 2], [1.0; 2]).unwrap();
    // Over the disc of radius 1 the integral of 1 / (e + 0.1 r)^2 is 200 pi (ln(1 + 0.1/e) - 1 + e / (e + 0.1)); the corners add
    // 100 (4 int_0^(pi/4) 2 ln(1 / cos t) dt) to it, for small e.
    let corners = 100.0 * 8.0 * 0.086_413_724_851;
    for (least, at) in [(1e-3, [0.0, 0.0]), (1e-5, [0.0, 0.0]), (1e-6, [0.0, 0.0]), (1e-6, [0.31, -0.17])] {
        let spacing = Spacing::Graded(Arc::new(move |x: &[f64; 2]| {
            least + 0.1 * ((x[0] - at[0]).powi(2) + (x[1] - at[1]).powi(2)).sqrt()
        }));
        let counted = estimate_nodes(&square, &spacing).unwrap();
        let disc = 200.0 * std::f64::consts::PI * ((1.0 + 0.1 / least).ln() - 1.0 + least / (least + 0.1));
        if at == [0.0, 0.0] {
            // And half a layer on the boundary: 8 int_0^1 dt / (2 * 0.1 sqrt(1 + t^2)).
            let layer = 40.0 * 1.0_f64.asinh();
            let expected = disc + corners + layer;
            assert!((counted / expected - 1.0).abs() < 0.01, "{least}: {counted} for {expected}");
        } else {
            assert!((counted / disc - 1.0).abs() < 0.1, "{counted} for about {disc}");
        }
        let params = CloudParams { spacing, layout: Layout::Irregular, seed: 1, max_nodes: 200_000 };
        let made = generate(&square, &params).unwrap().len() as f64;
        assert!((counted / made - 1.0).abs() < 0.3, "{least} at {at:?}: {counted} for {made}");
    }
    let cube = Domain::boxed([-1.0; 3], [1.0; 3]).unwrap();
    let spacing = Spacing::Graded(Arc::new(|x: &[f64; 3]| {
        1e-4 + 0.25 * (x[0] * x[0] + x[1] * x[1] + x[2] * x[2]).sqrt()
    }));
    let counted = estimate_nodes(&cube, &spacing).unwrap();
    let params = CloudParams { spacing, layout: Layout::Irregular, seed: 1, max_nodes: 200_000 };
    let made = generate(&cube, &params).unwrap().len() as f64;
    assert!((counted / made - 1.0).abs() < 0.3, "{counted} for {made}");
}

#[test]
fn spacings_that_fall_to_zero_are_refused_with_the_place() {
    let disc = Domain::from_shape(Shape::ball([0.0; 2], 1.0).unwrap(), None).unwrap();
    let square = Domain::boxed([-1.0; 2], [1.0; 2]).unwrap();
    type Case<'a> = (&'a Domain<2>, fn(&[f64; 2]) -> f64, [f64; 2]);
    let cases: [Case<'_>; 3] = [
        (&disc, |x| 0.1 + 0.1 * x[0], [-1.0, 0.0]),
        (&square, |x| 0.1 * (x[0] - 0.3).hypot(x[1] + 0.2), [0.3, -0.2]),
        (&square, |x| 0.1 * (x[0] - 1.0).hypot(x[1] + 0.2), [1.0, -0.2]),
    ];
    for (domain, spacing, place) in cases {
        let spacing = Spacing::Graded(Arc::new(spacing));
        let Err(GeometryError::VanishingSpacing { at, spacing: least }) = estimate_nodes(domain, &spacing)
        else {
            panic!("a spacing of zero at {place:?} was accepted")
        };
        assert!((at[0] - place[0]).hypot(at[1] - place[1]) < 1e-5, "{at:?} for {place:?}");
        assert!(least < 1e-11);
    }
}
