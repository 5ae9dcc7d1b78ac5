//! Areas and lines against closed forms, and exact tilings.

use proptest::prelude::*;

use super::*;

fn sample(n: usize, f: impl Fn(f64, f64) -> f64) -> Vec<f64> {
    let at = |k: usize| 2.0 * k as f64 / (n - 1) as f64 - 1.0;
    (0..n * n).map(|k| f(at(k % n), at(k / n))).collect()
}

fn square(n: usize, values: &[f64]) -> Domain<'_> {
    Domain { nx: n, ny: n, values, labels: None, mask: None, interfaces: &[], cuts: &[] }
}

/// Area of the square (-1, 1)^2 in units of the areas of the grid of `n` nodes each way.
fn unit(n: usize) -> f64 {
    (0.5 * (n - 1) as f64).powi(2)
}

fn pieces_area(pieces: &Pieces) -> f64 {
    pieces.iter().map(|piece| area(&[piece.iter().map(|v| v.at).collect()])).sum()
}

/// Asserts that errors at grids of doubling fineness fall with order two.
fn assert_second_order(errors: [f64; 3]) {
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).abs().log2();
        assert!((1.7..2.4).contains(&order), "errors {errors:?}");
    }
}

#[test]
fn area_and_length_of_a_circle_converge_with_order_two() {
    let radius = 0.7;
    let exact = std::f64::consts::PI * radius * radius;
    let measure = |n: usize| {
        let values = sample(n, |x, y| x * x + y * y);
        let pieces = Pieces::new(&square(n, &values));
        let lines = level_lines(&pieces, radius * radius);
        assert_eq!(lines.len(), 1);
        assert!(lines[0].closed);
        let points = &lines[0].points;
        let length: f64 = (0..points.len())
            .map(|k| {
                let (a, b) = (points[k], points[(k + 1) % points.len()]);
                (a[0] - b[0]).hypot(a[1] - b[1])
            })
            .sum();
        let bands = bands(&pieces, &[radius * radius]);
        (area(&bands[0]) / unit(n) - exact, length / unit(n).sqrt() - std::f64::consts::TAU * radius)
    };
    let errors = [21, 41, 81].map(measure);
    assert_second_order(errors.map(|e| e.0));
    assert_second_order(errors.map(|e| e.1));
}

#[test]
fn a_mask_clips_with_order_two() {
    let exact = std::f64::consts::PI * 0.81;
    assert_second_order([21, 41, 81].map(|n| {
        let mask = sample(n, |x, y| x.hypot(y) - 0.9);
        let mut values = sample(n, |x, _| x);
        // Nothing is known outside.
        for (value, mask) in values.iter_mut().zip(&mask) {
            if *mask > 0.0 {
                *value = f64::NAN;
            }
        }
        let domain = Domain { mask: Some(&mask), ..square(n, &values) };
        let bands = bands(&Pieces::new(&domain), &[0.0]);
        let (left, right) = (area(&bands[0]) / unit(n), area(&bands[1]) / unit(n));
        // The line x = 0 is straight up to the border, although the field had to be continued there.
        assert!((left - right).abs() < 1e-12);
        left + right - exact
    }));
}

#[test]
fn a_jump_at_an_interface_stays_sharp() {
    let n = 41;
    let level = sample(n, |x, y| x.hypot(y) - 0.5);
    let values: Vec<f64> = level.iter().map(|&l| if l < 0.0 { 10.0 } else { 0.0 }).collect();
    let labels: Vec<u16> = level.iter().map(|&l| u16::from(l < 0.0)).collect();
    let interfaces = [level];
    let domain = Domain { labels: Some(&labels), interfaces: &interfaces, ..square(n, &values) };
    let levels: Vec<f64> = (1..10).map(f64::from).collect();
    let areas: Vec<f64> = bands(&Pieces::new(&domain), &levels).iter().map(|b| area(b) / unit(n)).collect();
    assert!(areas[1..9].iter().all(|&a| a == 0.0), "areas {areas:?}");
    assert!((areas[0] + areas[9] - 4.0).abs() < 1e-12);
    assert!((areas[9] - 0.25 * std::f64::consts::PI).abs() < 2e-3);
}

#[test]
fn the_mean_decides_at_a_saddle() {
    // High on the rising diagonal; the mean is 0.5.
    let values = [1.0, 0.0, 0.0, 1.0];
    let pieces = Pieces::new(&square(2, &values));
    for (level, joined) in [(0.25, true), (0.75, false)] {
        let lines = level_lines(&pieces, level);
        assert_eq!(lines.len(), 2);
        assert!(lines.iter().all(|line| !line.closed));
        let above = bands(&pieces, &[level]).remove(1);
        assert_eq!(above.len(), if joined { 1 } else { 2 });
    }
}

#[test]
fn holes_are_loops_of_their_own() {
    let values = sample(31, f64::hypot);
    let rings = bands(&Pieces::new(&square(31, &values)), &[0.3, 0.6]);
    assert_eq!(rings.iter().map(Vec::len).collect::<Vec<_>>(), [1, 2, 2]);
    let total: f64 = rings.iter().map(|loops| area(loops)).sum();
    assert!((total - 900.0).abs() < 1e-9);
}

/// Values that coincide with levels, and gaps.
fn value() -> impl Strategy<Value = f64> {
    prop_oneof![4 => -1.0..1.0, 2 => (-4..5_i32).prop_map(|k| 0.25 * f64::from(k)), 1 => Just(f64::NAN)]
}

fn grid_values(n: usize) -> impl Strategy<Value = Vec<f64>> {
    prop::collection::vec(value(), n * n)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn bands_tile_a_rectangle(mut values in grid_values(7)) {
        values.iter_mut().filter(|v| v.is_nan()).for_each(|v| *v = 0.5);
        let pieces = Pieces::new(&square(7, &values));
        prop_assert!((pieces_area(&pieces) - 36.0).abs() < 1e-12);
        let levels: Vec<f64> = (-4..5).map(|k| 0.25 * f64::from(k)).collect();
        let bands = bands(&pieces, &levels);
        let areas: Vec<f64> = bands.iter().map(|b| area(b)).collect();
        prop_assert!(areas.iter().all(|&a| a >= -1e-12), "{areas:?}");
        prop_assert!((areas.iter().sum::<f64>() - 36.0).abs() < 1e-11, "{areas:?}");
    }

    #[test]
    fn bands_tile_what_is_known(values in grid_values(7), mask in prop::option::of(prop::collection::vec(-1.0..0.5, 49))) {
        let domain = Domain { mask: mask.as_deref(), ..square(7, &values) };
        let pieces = Pieces::new(&domain);
        let bands = bands(&pieces, &[-0.5, 0.0, 0.25]);
        let sum: f64 = bands.iter().map(|b| area(b)).sum();
        prop_assert!((sum - pieces_area(&pieces)).abs() < 1e-11);
        let mut outline = Outline::default();
        pieces.iter().for_each(|piece| outline.add(piece.iter().map(|v| v.at)));
        prop_assert!((area(&outline.loops()) - sum).abs() < 1e-11);
    }

    #[test]
    fn regions_tile_the_rectangle(values in prop::collection::vec(-1.0..1.0, 49), labels in prop::collection::vec(0_u16..3, 49)) {
        let domain = Domain { labels: Some(&labels), ..square(7, &values) };
        // Where three regions meet in a cell, half-way points of pairs leave a gap about the centre, never an overlap.
        let area = pieces_area(&Pieces::new(&domain));
        prop_assert!(area <= 36.0 + 1e-12);
        let two: Vec<u16> = labels.iter().map(|l| l % 2).collect();
        let area = pieces_area(&Pieces::new(&Domain { labels: Some(&two), ..domain }));
        prop_assert!((area - 36.0).abs() < 1e-11, "area {area}");
    }

    #[test]
    fn lines_end_on_the_border_only(mut values in grid_values(7), level in prop_oneof![Just(0.0), -1.0..1.0]) {
        values.iter_mut().filter(|v| v.is_nan()).for_each(|v| *v = -0.25);
        for line in level_lines(&Pieces::new(&square(7, &values)), level) {
            let on_border = |p: &[f64; 2]| p.iter().any(|&x| x == 0.0 || x == 6.0);
            if !line.closed {
                prop_assert!(on_border(&line.points[0]) && on_border(&line.points[line.points.len() - 1]));
            }
        }
    }
}

#[test]
fn a_field_that_jumps_across_a_cut_is_not_smeared() {
    // One above and minus one below a line that ends in the middle; linear beyond, so that nothing jumps there.
    let n = 41;
    let field = |x: f64, y: f64| match () {
        () if x > 0.0 => y * 0.5,
        () if y >= 0.01 => 1.0 + y,
        () => y - 1.0,
    };
    let values = sample(n, field);
    let middle = 0.5 * (n - 1) as f64;
    let cut = vec![[-1.0, middle + 0.2], [middle, middle + 0.2]];
    let cuts = [cut];
    let domain = Domain { cuts: &cuts, ..square(n, &values) };
    let pieces = Pieces::new(&domain);
    assert!((pieces_area(&pieces) - 4.0 * unit(n)).abs() < 1e-9);
    // Left of the middle no piece has a value between the two sides.
    let smeared = |pieces: &Pieces| {
        let left = pieces.iter().filter(|p| p.iter().all(|v| v.at[0] < middle - 0.5));
        left.flatten().filter(|v| v.value.abs() < 0.9).count()
    };
    assert_eq!(smeared(&pieces), 0);
    let open = Pieces::new(&square(n, &values));
    let across = |pieces: &Pieces| {
        let left = pieces.iter().filter(|p| p.iter().all(|v| v.at[0] < middle - 0.5));
        left.filter(|p| p.iter().any(|v| v.value > 0.5) && p.iter().any(|v| v.value < -0.5)).count()
    };
    assert_eq!((across(&pieces), across(&open)), (0, 19));
}
