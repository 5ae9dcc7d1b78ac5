//! Invariants of neighbour lists, against searches by brute force.

use meshless_neighbors::{CellList, Distance, NeighborError, NeighborLists, Radius, nearest, within_radius};
use proptest::prelude::*;

fn squared<const D: usize>(a: &[f64; D], b: &[f64; D]) -> f64 {
    (0..D).map(|k| (a[k] - b[k]).powi(2)).sum()
}

fn reach(radii: &[f64], i: usize, j: usize, distance: Distance) -> f64 {
    match distance {
        Distance::D1 => radii[i],
        Distance::D2 => 0.5 * (radii[i] + radii[j]),
    }
}

fn by_brute_force<const D: usize>(points: &[[f64; D]], radii: &[f64], distance: Distance) -> Vec<Vec<u32>> {
    let near = |i: usize, j: usize| squared(&points[i], &points[j]) <= reach(radii, i, j, distance).powi(2);
    let list = |i| (0..points.len()).filter(|&j| j != i && near(i, j)).map(|j| j as u32).collect();
    (0..points.len()).map(list).collect()
}

/// Compares with brute force, which also says whether a point must have been reported as having no neighbour.
fn agrees<const D: usize>(
    points: &[[f64; D]],
    radii: &[f64],
    distance: Distance,
) -> Result<(), TestCaseError> {
    let expected = by_brute_force(points, radii, distance);
    match within_radius(points, Radius::PerPoint(radii), distance) {
        Ok(lists) => {
            let found: Vec<Vec<u32>> = lists.iter().map(<[u32]>::to_vec).collect();
            prop_assert_eq!(found, expected);
            prop_assert!(distance == Distance::D1 || lists.is_symmetric());
        }
        Err(NeighborError::TooFewNeighbors { index, found: 0, asked: 1, sufficient, radius, .. }) => {
            prop_assert_eq!(Some(index), expected.iter().position(Vec::is_empty));
            prop_assert!(sufficient > radius);
            let mut wider = radii.to_vec();
            wider[index] = sufficient * (1.0 + 1e-12);
            prop_assert_eq!(by_brute_force(points, &wider, distance)[index].len(), 1);
        }
        Err(other) => return Err(TestCaseError::fail(other.to_string())),
    }
    Ok(())
}

/// Points in the unit cube, drawn together by `x^power` so that their density varies, and radii that vary as much.
fn cloud<const D: usize>() -> impl Strategy<Value = (Vec<[f64; D]>, Vec<f64>)> {
    let points = prop::collection::vec(prop::array::uniform::<_, D>(0.001..1.0_f64), 3..300);
    (points, 1..6_i32, 0.5..4.0_f64).prop_map(|(points, power, support)| {
        let spacing = support / (points.len() as f64).powf(1.0 / D as f64);
        let largest = |x: &[f64; D]| x.iter().copied().fold(0.0, f64::max);
        let radii = points.iter().map(|x| spacing * f64::from(power) * largest(x).powi(power - 1)).collect();
        (points.iter().map(|x| x.map(|c| c * largest(x).powi(power - 1))).collect(), radii)
    })
}

/// Whether no pair is so near to the limit that round-off decides.
fn is_clear_cut<const D: usize>(points: &[[f64; D]], radii: &[f64], distance: Distance) -> bool {
    (0..points.len()).all(|i| {
        (0..points.len()).all(|j| {
            let limit = reach(radii, i, j, distance);
            i == j || (squared(&points[i], &points[j]).sqrt() - limit).abs() > 1e-10 * (1.0 + limit)
        })
    })
}

fn rotated(x: &[f64; 2], angle: f64) -> [f64; 2] {
    let (sin, cos) = angle.sin_cos();
    [cos * x[0] - sin * x[1], sin * x[0] + cos * x[1]]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn radius_lists_equal_brute_force_1d((points, radii) in cloud::<1>()) {
        agrees(&points, &radii, Distance::D1)?;
        agrees(&points, &radii, Distance::D2)?;
    }

    #[test]
    fn radius_lists_equal_brute_force_2d((points, radii) in cloud::<2>()) {
        agrees(&points, &radii, Distance::D1)?;
        agrees(&points, &radii, Distance::D2)?;
    }

    #[test]
    fn radius_lists_equal_brute_force_3d((points, radii) in cloud::<3>()) {
        agrees(&points, &radii, Distance::D1)?;
        agrees(&points, &radii, Distance::D2)?;
    }

    #[test]
    fn radii_need_not_follow_the_density((points, _) in cloud::<2>(), seed in prop::collection::vec(-5.0..0.0_f64, 300)) {
        let radii: Vec<f64> = points.iter().zip(&seed).map(|(_, s)| 10_f64.powf(*s)).collect();
        agrees(&points, &radii, Distance::D1)?;
        agrees(&points, &radii, Distance::D2)?;
    }

    #[test]
    fn one_radius_is_the_same_as_equal_radii((points, _) in cloud::<3>(), radius in 0.2..2.0_f64) {
        let radii = vec![radius; points.len()];
        let uniform = within_radius(&points, Radius::Uniform(radius), Distance::D1).ok();
        prop_assert_eq!(&uniform, &within_radius(&points, Radius::PerPoint(&radii), Distance::D2).ok());
        if let Some(lists) = uniform {
            let found: Vec<Vec<u32>> = lists.iter().map(<[u32]>::to_vec).collect();
            prop_assert_eq!(found, by_brute_force(&points, &radii, Distance::D1));
        }
    }

    #[test]
    fn lists_do_not_depend_on_the_frame(
        (points, radii) in cloud::<2>(),
        shift in prop::array::uniform2(-3.0..3.0_f64),
        angle in 0.0..6.3_f64,
        scale in 0.1..10.0_f64,
    ) {
        for distance in [Distance::D1, Distance::D2] {
            prop_assume!(is_clear_cut(&points, &radii, distance));
            let lists = within_radius(&points, Radius::PerPoint(&radii), distance);
            let moved: Vec<[f64; 2]> = points
                .iter()
                .map(|x| { let y = rotated(x, angle); [scale * (y[0] + shift[0]), scale * (y[1] + shift[1])] })
                .collect();
            let scaled: Vec<f64> = radii.iter().map(|r| scale * r).collect();
            let of_moved = within_radius(&moved, Radius::PerPoint(&scaled), distance);
            prop_assert_eq!(lists.is_ok(), of_moved.is_ok());
            if let (Ok(lists), Ok(of_moved)) = (lists, of_moved) {
                prop_assert_eq!(lists, of_moved);
            }
        }
    }

    #[test]
    fn renumbering_points_renumbers_lists(
        (points, order) in cloud::<2>().prop_flat_map(|(points, _)| {
            let order: Vec<u32> = (0..points.len() as u32).collect();
            (Just(points), Just(order).prop_shuffle())
        }),
    ) {
        let renumbered: Vec<[f64; 2]> = order.iter().map(|&i| points[i as usize]).collect();
        let lists = within_radius(&points, Radius::Uniform(0.5), Distance::D1);
        let of_renumbered = within_radius(&renumbered, Radius::Uniform(0.5), Distance::D1);
        prop_assert_eq!(lists.is_ok(), of_renumbered.is_ok());
        if let (Ok(lists), Ok(of_renumbered)) = (lists, of_renumbered) {
            prop_assert_eq!(lists.permuted(&order).unwrap(), of_renumbered);
        }
        let nearest_of = nearest(&points, 2).unwrap().permuted(&order).unwrap();
        let sorted = |lists: &NeighborLists| -> Vec<Vec<u32>> {
            lists.iter().map(|list| { let mut list = list.to_vec(); list.sort_unstable(); list }).collect()
        };
        prop_assert_eq!(sorted(&nearest_of), sorted(&nearest(&renumbered, 2).unwrap()));
    }

    #[test]
    fn duplicates_are_found((mut points, radii) in cloud::<2>(), from in any::<prop::sample::Index>(), away in 0.0..1e-11_f64) {
        let (first, second) = (from.index(points.len()), points.len());
        let copy = [points[first][0] + away * radii[first], points[first][1]];
        points.push(copy);
        let mut radii = radii;
        radii.push(radii[first]);
        for distance in [Distance::D1, Distance::D2] {
            match within_radius(&points, Radius::PerPoint(&radii), distance) {
                Err(NeighborError::Duplicate { first: a, second: b, position }) => {
                    prop_assert_eq!((a, b), (first, second));
                    prop_assert_eq!(position, points[first].to_vec());
                }
                other => return Err(TestCaseError::fail(format!("{other:?}"))),
            }
        }
    }

    #[test]
    fn nearest_lists_are_ordered_as_by_brute_force((points, _) in cloud::<3>(), k in 1_usize..40) {
        let k = k.min(points.len() - 1);
        let lists = nearest(&points, k).unwrap();
        let index = CellList::new(&points, 0.1).unwrap();
        for i in 0..points.len() {
            let mut all: Vec<u32> = (0..points.len() as u32).collect();
            let length = |j: u32| squared(&points[i], &points[j as usize]);
            all.sort_by(|&a, &b| length(a).total_cmp(&length(b)).then(a.cmp(&b)));
            prop_assert_eq!(all[0] as usize, i);
            prop_assert_eq!(lists.of(i), &all[1..=k]);
            prop_assert_eq!(index.nearest(&points[i], k, &mut Vec::new()).collect::<Vec<_>>(), &all[..k]);
        }
    }

    #[test]
    fn queries_around_any_position_equal_brute_force(
        (points, _) in cloud::<2>(),
        center in prop::array::uniform2(-1.0..2.0_f64),
        radius in 0.0..1.5_f64,
        hint in prop::option::of(1e-3..10.0_f64),
    ) {
        let list = CellList::new(&points, hint.unwrap_or(0.0)).unwrap();
        let mut found = Vec::new();
        list.within(&center, radius, &mut found);
        let inside = |j: &u32| squared(&points[*j as usize], &center) <= radius * radius;
        prop_assert_eq!(found, (0..points.len() as u32).filter(inside).collect::<Vec<_>>());
        let length = |j: &u32| squared(&points[*j as usize], &center);
        let nearest = (0..points.len() as u32).min_by(|a, b| length(a).total_cmp(&length(b)));
        prop_assert_eq!(list.nearest_one(&center), nearest);
    }
}
