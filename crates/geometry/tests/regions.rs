//! Labels, interfaces and the region graph in known configurations.

use meshless_geometry::{
    Aabb, Cloud, CloudParams, Domain, FaceId, Layout, ProjectionError, RegionGraph, RegionMap, Shape,
    Spacing, generate,
};

fn square_grid() -> (Domain<2>, Cloud<2>) {
    let domain = Domain::boxed([-1.0; 2], [1.0; 2]).expect("a square");
    let params =
        CloudParams { spacing: Spacing::Uniform(0.1), layout: Layout::Grid, seed: 0, max_nodes: 1000 };
    let cloud = generate(&domain, &params).expect("a grid");
    (domain, cloud)
}

/// Neighbours along the axes.
fn pairs(cloud: &Cloud<2>) -> Vec<(u32, u32)> {
    let x = cloud.points();
    let mut found = Vec::new();
    for i in 0..x.len() {
        for j in i + 1..x.len() {
            if (x[i][0] - x[j][0]).hypot(x[i][1] - x[j][1]) < 0.11 {
                found.push((i as u32, j as u32));
            }
        }
    }
    found
}

fn ball(x: f64, y: f64, r: f64) -> Shape<2> {
    Shape::ball([x, y], r).expect("a positive radius")
}

#[test]
fn the_region_named_first_wins_and_owns_the_interface() {
    let map = RegionMap::new(vec![Some(ball(0.0, 0.0, 0.3)), Some(ball(0.2, 0.0, 0.3)), None]).unwrap();
    assert_eq!(map.len(), 3);
    assert_eq!(map.label(&[0.1, 0.0], 0.1), 0);
    assert_eq!(map.label(&[0.4, 0.0], 0.1), 1);
    assert_eq!(map.label(&[0.9, 0.0], 0.1), 2);
    // On the interface, and off it by rounding on either side.
    for r in [0.3, 0.3 - 1e-12, 0.3 + 1e-12] {
        assert_eq!(map.label(&[-r, 0.0], 0.1), 0);
    }
    // Off by more than the tie.
    assert_eq!(map.label(&[-0.3 - 1e-9, 0.0], 0.1), 2);
}

#[test]
fn lists_without_a_background_are_refused() {
    assert!(RegionMap::<2>::new(vec![]).is_err());
    assert!(RegionMap::new(vec![Some(ball(0.0, 0.0, 0.3))]).is_err());
    assert!(RegionMap::new(vec![None, Some(ball(0.0, 0.0, 0.3)), None]).is_err());
}

#[test]
fn interfaces_are_projected_onto_with_normals_from_a_to_b() {
    let map = RegionMap::new(vec![Some(ball(0.0, 0.0, 0.3)), Some(ball(0.0, 0.0, 0.6)), None]).unwrap();
    let p = map.project(0, 1, &[0.32, 0.0], 0.1).unwrap();
    assert!((p.point[0] - 0.3).abs() < 1e-14 && (p.normal[0] - 1.0).abs() < 1e-14);
    assert!((p.distance - 0.02).abs() < 1e-14);
    let q = map.project(1, 0, &[0.32, 0.0], 0.1).unwrap();
    assert!((q.normal[0] + 1.0).abs() < 1e-14 && (q.distance + 0.02).abs() < 1e-14);
    let r = map.project(1, 2, &[0.0, 0.55], 0.1).unwrap();
    assert!((r.point[1] - 0.6).abs() < 1e-14 && (r.normal[1] - 1.0).abs() < 1e-14);
    // The rings 0 and 2 do not meet; the surface of 0 is out of reach from far away.
    assert!(matches!(map.project(0, 2, &[0.32, 0.0], 0.1), Err(ProjectionError::NotAnInterface { .. })));
    assert!(matches!(map.project(0, 1, &[0.9, 0.0], 0.1), Err(ProjectionError::OutOfReach { .. })));
    assert!(map.project(1, 1, &[0.3, 0.0], 0.1).is_err());
    assert!(map.project(2, 3, &[0.3, 0.0], 0.1).is_err());
}

#[test]
fn interfaces_covered_by_another_region_are_searched_beside_it() {
    // Region 0 covers the right part of the surface of region 1.
    let map = RegionMap::new(vec![Some(ball(0.5, 0.0, 0.2)), Some(ball(0.0, 0.0, 0.5)), None]).unwrap();
    let x = [0.48, 0.15];
    let p = map.project(1, 2, &x, 0.3).unwrap();
    assert!((p.point[0].hypot(p.point[1]) - 0.5).abs() < 1e-12);
    assert!((p.point[0] - 0.5).hypot(p.point[1]) > 0.2);
    assert!((p.distance.abs() - (p.point[0] - x[0]).hypot(p.point[1] - x[1])).abs() < 1e-12);
}

#[test]
fn nested_rings_form_a_chain() {
    let (_, cloud) = square_grid();
    let map = RegionMap::new(vec![Some(ball(0.0, 0.0, 0.25)), Some(ball(0.0, 0.0, 0.65)), None]).unwrap();
    let graph = RegionGraph::new(&cloud, &map.labels(&cloud), &pairs(&cloud)).unwrap();
    let labels: Vec<u16> = graph.components().iter().map(|c| c.label).collect();
    assert_eq!(graph.components().len(), 3);
    assert_eq!(graph.components().iter().map(|c| c.nodes).sum::<usize>(), cloud.len());
    let find = |label: u16| labels.iter().position(|&l| l == label).unwrap() as u32;
    let (core, ring, rest) = (find(0), find(1), find(2));
    assert_eq!(graph.touching(core), [ring]);
    assert_eq!(graph.touching(rest), [ring]);
    assert_eq!(graph.touching(ring).len(), 2);
    assert_eq!(graph.contact_pairs(core, rest), 0);
    // The core holds the 21 nodes with i^2 + j^2 <= 6; 20 pairs cross its outline.
    assert_eq!(graph.components()[core as usize].nodes, 21);
    assert_eq!(graph.contact_pairs(core, ring), 20);
    assert_eq!(graph.contact_pairs(ring, core), 20);
    assert_eq!(graph.faces_of(rest), [FaceId(0), FaceId(1), FaceId(2), FaceId(3)]);
    assert!(graph.faces_of(ring).is_empty() && graph.faces_of(core).is_empty());
}

#[test]
fn separate_discs_of_one_region_are_two_components() {
    let (_, cloud) = square_grid();
    let discs = Shape::union(vec![ball(-0.6, 0.0, 0.25), ball(0.85, 0.0, 0.25)]).unwrap();
    let map = RegionMap::new(vec![Some(discs), None]).unwrap();
    let labels = map.labels(&cloud);
    let adjacent = pairs(&cloud);
    let graph = RegionGraph::new(&cloud, &labels, &adjacent).unwrap();
    let discs: Vec<u32> =
        (0..graph.components().len() as u32).filter(|&c| graph.components()[c as usize].label == 0).collect();
    assert_eq!((graph.components().len(), discs.len()), (3, 2));
    let right = discs.iter().copied().find(|&c| !graph.faces_of(c).is_empty()).unwrap();
    assert_eq!(graph.faces_of(right), [FaceId(1)]);
    for c in &discs {
        let node = graph.components()[*c as usize].representative;
        assert_eq!((graph.component_of(node), labels[node as usize]), (*c, 0));
        assert_eq!(graph.touching(*c).len(), 1);
    }
    // The order and orientation of the pairs do not matter.
    let reversed: Vec<_> = adjacent.iter().rev().map(|&(i, j)| (j, i)).collect();
    assert_eq!(RegionGraph::new(&cloud, &labels, &reversed).unwrap().components(), graph.components());
}

#[test]
fn inconsistent_input_is_refused() {
    let (_, cloud) = square_grid();
    let labels = vec![0; cloud.len()];
    assert!(RegionGraph::new(&cloud, &labels[1..], &[]).is_err());
    assert!(RegionGraph::new(&cloud, &labels, &[(0, cloud.len() as u32)]).is_err());
}

#[test]
fn faces_on_the_plane_of_a_half_space_belong_to_what_is_behind_them() {
    let boxed = |min, max| Shape::Box(Aabb::new(min, max).unwrap());
    let step = Shape::union(vec![boxed([0.0, 0.0], [2.0, 1.0]), boxed([0.0, 0.5], [0.6, 1.4])]).unwrap();
    let domain = Domain::from_shape(step, None).unwrap();
    let above: Shape<2> = Shape::half_space([0.0, 1.0], [0.0, -1.0]).unwrap();
    let map = RegionMap::new(vec![Some(above), None]).unwrap();
    let params = CloudParams {
        spacing: Spacing::Uniform(0.1),
        layout: Layout::Irregular,
        seed: 1,
        max_nodes: 100_000,
    };
    let cloud = generate(&domain, &params).unwrap();
    let labels = map.labels_within(&domain, &cloud);
    let mut on_plane = 0;
    for (i, x) in cloud.points().iter().enumerate() {
        let beside = x[0] > 0.6 + 1e-9;
        on_plane += usize::from(beside && (x[1] - 1.0).abs() < 1e-12);
        assert_eq!(labels[i], u16::from(beside || x[1] < 1.0 - 1e-9), "{x:?}");
    }
    assert!(on_plane > 10);
}

#[test]
fn boxes_that_begin_at_the_boundary_have_an_interface_for_all_nodes_within_reach() {
    let domain = Domain::boxed([-1.0; 2], [1.0; 2]).unwrap();
    let inner = Shape::Box(Aabb::new([-1.0, -0.4], [0.0, 0.4]).unwrap());
    let map = RegionMap::new(vec![Some(inner), None]).unwrap();
    // Nearer to the boundary than to the interface, even from half the reach away.
    for y in [0.15, 0.2, 0.25, 0.3, 0.39, 0.45] {
        let foot = map.project_within(&domain, 0, 1, &[-1.0, y], 0.3).unwrap();
        assert!((foot.point[1] - 0.4).abs() < 1e-12 && foot.normal == [0.0, 1.0], "{y}: {foot:?}");
        assert!((foot.distance - (y - 0.4)).abs() < 1e-12);
    }
}
