//! Particular clouds: grids, lines, strong grading, clouds that must be refused, any number of threads.

use meshless_neighbors::{
    CellList, Distance, NeighborError, NeighborLists, Radius, nearest, require_neighbors, within_radius,
};

fn grid<const D: usize>(side: usize) -> Vec<[f64; D]> {
    let point = |i: usize| std::array::from_fn(|k| (i / side.pow(k as u32) % side) as f64);
    (0..side.pow(D as u32)).map(point).collect()
}

/// Numbers in [0, 1), the same on every machine.
fn noise(i: usize) -> f64 {
    let mut x = (i as u64 + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    x = (x ^ (x >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    ((x ^ (x >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
}

#[test]
fn grids_have_the_neighbours_of_grids() {
    let lists = within_radius(&grid::<3>(12), Radius::Uniform(1.0), Distance::D2).unwrap();
    assert_eq!((lists.min_count(), lists.max_count()), (3, 6));
    let inner = 5 + 12 * (5 + 12 * 5);
    assert_eq!(
        lists.of(inner),
        [inner - 144, inner - 12, inner - 1, inner + 1, inner + 12, inner + 144].map(|j| j as u32)
    );
    // Ties at the last distance: the lower indices are listed, in the order of distance and index.
    let lists = nearest(&grid::<2>(40), 6).unwrap();
    let inner = 20 + 40 * 20;
    let expected = [inner - 40, inner - 1, inner + 1, inner + 40, inner - 41, inner - 39];
    assert_eq!(lists.of(inner as usize), expected.map(|j: i32| j as u32));
    assert_eq!(lists.of(0), [1, 40, 41, 2, 80, 42]);
}

#[test]
fn flat_and_distant_clouds() {
    let line: Vec<[f64; 3]> = (0..500).map(|i| [1e6, f64::from(i) * 1e-3, -1e6]).collect();
    let lists = within_radius(&line, Radius::Uniform(1.5e-3), Distance::D1).unwrap();
    assert_eq!((lists.of(0), lists.of(250)), (&[1][..], &[249, 251][..]));
    assert_eq!(nearest(&line, 2).unwrap().of(250), [249, 251]);
}

#[test]
fn spacings_may_vary_by_twelve_orders() {
    let points: Vec<[f64; 1]> = (0..40).map(|k| [0.5_f64.powi(k)]).collect();
    let mut radii: Vec<f64> = points.iter().map(|x| 0.6 * x[0]).collect();
    radii[39] = 1.1 * points[39][0];
    let lists = within_radius(&points, Radius::PerPoint(&radii), Distance::D1).unwrap();
    assert_eq!((lists.of(0), lists.of(20), lists.of(39)), (&[1][..], &[21][..], &[38][..]));
    // 1.5 from 1 to 1/4, within 1.32 (1 + 1/4); 1.75 from 1 to 1/8, beyond 1.32 (1 + 1/8).
    let radii: Vec<f64> = points.iter().map(|x| 1.32 * x[0]).collect();
    let lists = within_radius(&points, Radius::PerPoint(&radii), Distance::D2).unwrap();
    assert!(lists.is_symmetric());
    assert_eq!(lists.of(20), [18, 19, 21, 22]);
}

#[test]
fn any_number_of_threads_gives_the_same_lists() {
    let points: Vec<[f64; 2]> = (0..20_000).map(|i| [noise(2 * i).powi(3), noise(2 * i + 1)]).collect();
    let radii: Vec<f64> = points.iter().map(|x| 0.01 + 0.04 * x[0]).collect();
    let on = |threads: usize| -> Vec<NeighborLists> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let of = |distance| within_radius(&points, Radius::PerPoint(&radii), distance).unwrap();
            vec![of(Distance::D1), of(Distance::D2), nearest(&points, 10).unwrap()]
        })
    };
    assert_eq!(on(1), on(3));
}

#[test]
fn bad_clouds_are_refused_with_the_node() {
    let mut points = grid::<2>(10);
    points[17] = [f64::NAN, 0.0];
    let not_finite = |e| matches!(e, Some(NeighborError::NotFinite { index: 17, .. }));
    assert!(not_finite(within_radius(&points, Radius::Uniform(1.0), Distance::D1).err()));
    assert!(not_finite(nearest(&points, 3).err()), "the k-d tree would take it in silence");
    assert!(not_finite(CellList::new(&points, 1.0).err()));

    let mut points = grid::<2>(10);
    points[17] = points[55];
    let duplicate = Some(NeighborError::Duplicate { first: 17, second: 55, position: vec![5.0, 5.0] });
    assert_eq!(within_radius(&points, Radius::Uniform(1.5), Distance::D1).err(), duplicate);
    assert_eq!(nearest(&points, 3).err(), duplicate);

    let points = grid::<2>(3);
    for radius in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-200] {
        let error = within_radius(&points, Radius::Uniform(radius), Distance::D1).unwrap_err();
        assert!(matches!(error, NeighborError::InvalidRadius { index: 0, .. }), "{error}");
    }
    let mut radii = vec![1.0; 9];
    radii[4] = -1.0;
    let error = within_radius(&points, Radius::PerPoint(&radii), Distance::D2).unwrap_err();
    assert_eq!(error, NeighborError::InvalidRadius { index: 4, radius: -1.0 });
    let error = within_radius(&points, Radius::PerPoint(&radii[1..]), Distance::D2).unwrap_err();
    assert_eq!(error, NeighborError::LengthMismatch { radii: 8, points: 9 });
}

#[test]
fn lonely_points_are_told_what_radius_they_need() {
    let points = [[0.0], [1.0], [2.0], [5.0]];
    let few = |index, position: f64, radius, found, asked, sufficient| {
        let position = vec![position];
        NeighborError::TooFewNeighbors { index, position, radius, found, asked, sufficient }
    };
    let error = within_radius(&points, Radius::Uniform(1.0), Distance::D1).unwrap_err();
    assert_eq!(error, few(3, 5.0, 1.0, 0, 1, 3.0));
    let radii = [1.0, 1.0, 2.0, 1.0];
    let error = within_radius(&points, Radius::PerPoint(&radii), Distance::D2).unwrap_err();
    assert_eq!(error, few(3, 5.0, 1.0, 0, 1, 4.0), "(2 + 4) / 2 = 3");
    let lists = within_radius(&points, Radius::Uniform(3.0), Distance::D1).unwrap();
    assert!(require_neighbors(&lists, 1, &points, Radius::Uniform(3.0), Distance::D1).is_ok());
    let error = require_neighbors(&lists, 2, &points, Radius::Uniform(3.0), Distance::D1).unwrap_err();
    assert_eq!(error, few(3, 5.0, 3.0, 1, 2, 4.0));
    for asked in [4, 5] {
        let error =
            require_neighbors(&lists, asked, &points, Radius::Uniform(3.0), Distance::D1).unwrap_err();
        assert_eq!(error, NeighborError::TooFewPoints { asked, points: 4 });
        assert_eq!(nearest(&points, asked).unwrap_err(), error);
    }
}

#[test]
fn few_points() {
    assert_eq!(within_radius::<2>(&[], Radius::Uniform(1.0), Distance::D1).unwrap().len(), 0);
    let error = within_radius(&[[0.0]], Radius::Uniform(1.0), Distance::D1).unwrap_err();
    assert_eq!(error, NeighborError::TooFewPoints { asked: 1, points: 1 });
    assert_eq!(nearest(&[[0.0], [1.0]], 1).unwrap().of(1), [0]);
}
