//! Surfaces of triangles: distances, normals, and clouds in them.

use std::sync::Arc;

use approx::assert_relative_eq;
use meshless_geometry::{
    CloudParams, Domain, Layout, Shape, Spacing, SurfaceParams, TriangleSurface, generate, quality,
};
use proptest::prelude::*;

type Soup = Vec<[[f64; 3]; 3]>;

/// A box of twelve triangles.
fn block(min: [f64; 3], max: [f64; 3]) -> Soup {
    let mut soup = Vec::new();
    for axis in 0..3 {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        for (upper, ends) in [(false, min), (true, max)] {
            let corner = |a: bool, b: bool| {
                let mut x = [0.0; 3];
                x[axis] = ends[axis];
                x[u] = if a { max[u] } else { min[u] };
                x[v] = if b { max[v] } else { min[v] };
                x
            };
            let square = [corner(false, false), corner(true, false), corner(true, true), corner(false, true)];
            for [a, b, c] in [[0, 1, 2], [0, 2, 3]] {
                soup.push(if upper {
                    [square[a], square[b], square[c]]
                } else {
                    [square[a], square[c], square[b]]
                });
            }
        }
    }
    soup
}

/// An octahedron divided `times` times, its vertices on the unit sphere.
fn sphere(times: usize) -> Soup {
    let mut soup: Soup = Vec::new();
    for octant in 0..8 {
        let sign = |k: usize| if octant >> k & 1 == 0 { 1.0 } else { -1.0 };
        let t = [[sign(0), 0.0, 0.0], [0.0, sign(1), 0.0], [0.0, 0.0, sign(2)]];
        soup.push(if sign(0) * sign(1) * sign(2) > 0.0 { t } else { [t[1], t[0], t[2]] });
    }
    for _ in 0..times {
        let middle = |a: &[f64; 3], b: &[f64; 3]| {
            let m: [f64; 3] = std::array::from_fn(|k| a[k] + b[k]);
            let r = m.iter().map(|c| c * c).sum::<f64>().sqrt();
            m.map(|c| c / r)
        };
        soup = soup
            .iter()
            .flat_map(|[a, b, c]| {
                let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
                [[*a, ab, ca], [ab, *b, bc], [ca, bc, *c], [ab, bc, ca]]
            })
            .collect();
    }
    soup
}

fn surface(soup: &Soup) -> TriangleSurface {
    TriangleSurface::new(soup, &SurfaceParams::default()).expect("a closed surface")
}

fn shape(soup: &Soup) -> Shape<3> {
    Shape::surface(Arc::new(surface(soup))).expect("three dimensions")
}

fn params(spacing: f64) -> CloudParams<3> {
    CloudParams { spacing: Spacing::Uniform(spacing), layout: Layout::Irregular, seed: 1, max_nodes: 200_000 }
}

/// Two boxes that make an L, without the face between them.
fn angle() -> Soup {
    let outline: [[f64; 2]; 6] = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];
    let at = |i: usize, z: f64| [outline[i % 6][0], outline[i % 6][1], z];
    let mut soup = Vec::new();
    for i in 0..6 {
        soup.push([at(i, 0.0), at(i + 1, 0.0), at(i + 1, 1.0)]);
        soup.push([at(i, 0.0), at(i + 1, 1.0), at(i, 1.0)]);
    }
    for [a, b, c] in [[0, 1, 3], [1, 2, 3], [0, 3, 5], [3, 4, 5]] {
        soup.push([at(a, 1.0), at(b, 1.0), at(c, 1.0)]);
        soup.push([at(a, 0.0), at(c, 0.0), at(b, 0.0)]);
    }
    soup
}

#[test]
fn distances_are_those_of_the_box_that_it_is() {
    let exact: Shape<3> = Shape::cuboid([-1.0, 0.0, 0.5], [1.0, 3.0, 2.0]).unwrap();
    let triangles = shape(&block([-1.0, 0.0, 0.5], [1.0, 3.0, 2.0]));
    proptest!(|(x in prop::array::uniform3(-4.0..5.0_f64))| {
        prop_assert!((exact.level(&x) - triangles.level(&x)).abs() < 1e-13);
        let (p, q) = (exact.project(&x, 100.0).unwrap(), triangles.project(&x, 100.0).unwrap());
        prop_assert!((p.distance - q.distance).abs() < 1e-13);
        let to_foot = x.iter().zip(&q.point).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
        prop_assert!((to_foot - q.distance.abs()).abs() < 1e-13);
    });
}

#[test]
fn signs_hold_at_edges_that_point_inwards() {
    let l = shape(&angle());
    proptest!(|(x in prop::array::uniform3(-0.5..2.5_f64))| {
        let inside = x[2] > 0.0 && x[2] < 1.0 && x[0] > 0.0 && x[1] > 0.0
            && x[0] < 2.0 && x[1] < 2.0 && (x[0] < 1.0 || x[1] < 1.0);
        prop_assert_eq!(l.level(&x) < 0.0, inside, "{:?} {}", x, l.level(&x));
    });
}

#[test]
fn the_order_and_the_orientation_of_triangles_do_not_matter() {
    let soup = sphere(2);
    let inside_out: Soup = soup.iter().rev().map(|t| [t[1], t[0], t[2]]).collect();
    let (a, b) = (surface(&soup), surface(&inside_out));
    assert_relative_eq!(a.volume(), b.volume(), max_relative = 1e-12);
    let (a, b) = (shape(&soup), shape(&inside_out));
    proptest!(|(x in prop::array::uniform3(-1.5..1.5_f64))| {
        prop_assert!((a.level(&x) - b.level(&x)).abs() < 1e-14);
    });
}

#[test]
fn a_triangulated_ball_comes_nearer_to_the_ball_with_every_division() {
    let ball: Shape<3> = Shape::ball([0.0; 3], 1.0).unwrap();
    let mut last = f64::INFINITY;
    for times in 2..5 {
        let soup = sphere(times);
        let flat = SurfaceParams { smooth: false, ..SurfaceParams::default() };
        let flat: Shape<3> = Shape::surface(Arc::new(TriangleSurface::new(&soup, &flat).unwrap())).unwrap();
        let smooth = shape(&soup);
        let (mut worst, mut normal, mut interpolated) = (0.0_f64, 0.0_f64, 0.0_f64);
        for i in 0..2000 {
            let z = -1.0 + (f64::from(i) + 0.5) / 1000.0;
            let (r, phi) = ((1.0 - z * z).sqrt(), 2.4 * f64::from(i));
            let x = [1.1 * r * phi.cos(), 1.1 * r * phi.sin(), 1.1 * z];
            worst = worst.max((flat.level(&x) - ball.level(&x)).abs());
            let off = |p: &Shape<3>| {
                let n = p.project(&x.map(|c| c / 1.1), 1.0).unwrap().normal;
                let d = x.iter().zip(&n).map(|(a, b)| (a / 1.1 - b).powi(2)).sum::<f64>();
                d.sqrt()
            };
            (normal, interpolated) = (normal.max(off(&flat)), interpolated.max(off(&smooth)));
        }
        // Chords are off by the square of their length, so a quarter each time.
        assert!(worst < 0.3 * last && interpolated < 0.4 * normal, "{worst} {last} {normal} {interpolated}");
        last = worst;
    }
}

#[test]
fn corners_and_edges_of_a_block_have_the_normals_of_the_box() {
    let (min, max) = ([0.0; 3], [1.0, 0.6, 0.8]);
    let domain = Domain::from_shape(shape(&block(min, max)), None).unwrap();
    let cloud = generate(&domain, &params(0.1)).unwrap();
    let boxed = generate(&Domain::boxed(min, max).unwrap(), &params(0.1)).unwrap();
    for (touches, expected) in [(3, 8), (2, 4 * (9 + 5 + 7))] {
        for cloud in [&cloud, &boxed] {
            let count = cloud.boundary().iter().filter(|b| b.touches.len() == touches).count();
            assert_eq!(count, expected, "nodes with {touches} normals");
        }
    }
    let share = cloud.len() as f64 / boxed.len() as f64;
    assert!((share - 1.0).abs() < 0.05, "{share}");
    let q = quality(&cloud, &domain);
    assert!(q.relative_separation > 0.49, "{q:?}");
    for b in cloud.boundary() {
        let x = cloud.points()[b.node as usize];
        for t in &b.touches {
            let axis = (0..3).find(|&k| t.normal[k].abs() == 1.0).expect("a normal of a box");
            let end = if t.normal[axis] > 0.0 { max[axis] } else { min[axis] };
            assert_relative_eq!(x[axis], end, epsilon = 1e-12);
        }
    }
}

#[test]
fn holes_and_cuts_of_triangles() {
    // A ball of triangles that a corner of the box cuts, and one inside.
    let moved = |by: f64, radius: f64| -> Soup {
        sphere(3).iter().map(|t| t.map(|v| v.map(|c| by + radius * c))).collect()
    };
    let domain = Domain::boxed([0.0; 3], [1.0; 3])
        .unwrap()
        .with_hole("corner", shape(&moved(0.0, 0.4)))
        .unwrap()
        .with_hole("void", shape(&moved(0.7, 0.15)))
        .unwrap();
    let cloud = generate(&domain, &params(0.07)).unwrap();
    let exact = Domain::boxed([0.0; 3], [1.0; 3])
        .unwrap()
        .with_hole("corner", Shape::ball([0.0; 3], 0.4).unwrap())
        .unwrap()
        .with_hole("void", Shape::ball([0.7; 3], 0.15).unwrap())
        .unwrap();
    let reference = generate(&exact, &params(0.07)).unwrap();
    for name in ["corner", "void"] {
        let on = |cloud: &meshless_geometry::Cloud<3>| {
            let face = domain.face(name).expect("named above");
            cloud.boundary().iter().filter(|b| b.touches.iter().any(|t| t.face == face)).count() as f64
        };
        let share = on(&cloud) / on(&reference);
        assert!((share - 1.0).abs() < 0.1, "{name}: {share}");
    }
    for b in cloud.boundary() {
        let level = domain.level(&cloud.points()[b.node as usize]);
        assert!(level.abs() < 1e-9 && !b.touches.is_empty(), "{level}");
    }
}

#[test]
fn surfaces_that_are_not_closed_are_refused_with_the_edge() {
    let says = |soup: &Soup, expected: &str| {
        let message = TriangleSurface::new(soup, &SurfaceParams::default()).unwrap_err().to_string();
        assert!(message.contains(expected), "{message}");
    };
    let whole = block([0.0; 3], [1.0; 3]);
    let mut open = whole.clone();
    open.remove(5);
    says(&open, "the surface is open there (and 2 more such edges)");
    let mut turned = whole.clone();
    turned[3].swap(0, 1);
    says(&turned, "two triangles whose outsides differ (and 2 more such edges)");
    let mut doubled = whole.clone();
    doubled.push([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.5, -1.0, 0.5]]);
    says(&doubled, "belongs to 3 triangles");
    says(&whole[..1].to_vec(), "enclose nothing");
    says(&vec![[[f64::NAN; 3]; 3]; 4], "triangle 1 has a coordinate that is not finite");
    let flat: Soup = whole.iter().map(|t| t.map(|v| [v[0], v[1], 0.0])).collect();
    says(&flat, "invalid");
}

#[test]
fn triangles_without_extent_are_left_out_and_counted() {
    let mut soup = block([0.0; 3], [1.0; 3]);
    // An edge that a file has divided by a vertex a rounding error away from its end.
    soup.push([[0.0; 3], [1e-9, 0.0, 0.0], [1.0, 0.0, 0.0]]);
    soup.push([[0.5; 3]; 3]);
    let surface = surface(&soup);
    assert_eq!((surface.degenerate(), surface.triangles().len(), surface.vertices().len()), (2, 12, 9));
    assert_relative_eq!(surface.volume(), 1.0, max_relative = 1e-12);
}
