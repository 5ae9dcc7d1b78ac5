//! Whatever the numbers, pictures are well-formed or refused.

mod common;

use common::xml_fault;
use meshless_output::{Axis, Chart, FieldPicture, OutputError, Probe, Profile, Series, Stroke};
use proptest::prelude::*;

fn wild() -> impl Strategy<Value = f64> {
    prop_oneof![
        6 => -2.0..2.0,
        2 => (-320.0..308.0).prop_map(|e| 10_f64.powf(e)),
        1 => prop::sample::select(vec![
            f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 0.0, -0.0, 1.0, f64::MAX, f64::MIN, 5e-324,
        ]),
    ]
}

fn stroke() -> impl Strategy<Value = Stroke> {
    prop::sample::select(vec![Stroke::LineAndMarkers, Stroke::Line, Stroke::Markers, Stroke::Curve])
}

fn series() -> impl Strategy<Value = Series> {
    (any::<String>(), prop::collection::vec((wild(), wild()), 0..9), stroke())
        .prop_map(|(name, points, stroke)| Series { name, points, stroke })
}

fn axis() -> impl Strategy<Value = Axis> {
    (any::<String>(), any::<bool>())
        .prop_map(|(label, log)| if log { Axis::log(label) } else { Axis::linear(label) })
}

prop_compose! {
    fn field()(nx in 2_usize..9, ny in 2_usize..9)(
        nx in Just(nx),
        ny in Just(ny),
        title in any::<String>(),
        values in prop_oneof![
            prop::collection::vec(wild(), nx * ny),
            wild().prop_map(move |v| vec![v; nx * ny]),
        ],
        labels in prop::option::of(prop::collection::vec(0_u16..3, nx * ny)),
        mask in prop::option::of(prop::collection::vec(wild(), nx * ny)),
        interfaces in prop::collection::vec(prop::collection::vec(wild(), nx * ny), 0..3),
        contours in 0_usize..20,
        log in any::<bool>(),
        nodes in prop::collection::vec([wild(), wild()], 0..5),
        probe in (any::<String>(), [-1.0..2.0, 0.0..1.0]),
    ) -> FieldPicture {
        let probes = vec![Probe { name: probe.0, at: probe.1 }];
        FieldPicture {
            labels, mask, interfaces, contours, log, nodes, probes,
            ..FieldPicture::new(title, [-1.0, 0.0], [2.0, 1.0], nx, ny, values)
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn fields_are_well_formed(picture in field(), width in 200_u32..900) {
        let svg = picture.to_svg(width).unwrap();
        prop_assert_eq!(xml_fault(&svg), None);
    }

    #[test]
    fn charts_are_well_formed(
        title: String, x in axis(), y in axis(), series in prop::collection::vec(series(), 0..10),
        reference_slopes in prop::collection::vec(wild(), 0..3),
        width in 200_u32..900, height in 200_u32..900,
    ) {
        let svg = Chart { title, x, y, series, reference_slopes }.to_svg(width, height).unwrap();
        prop_assert_eq!(xml_fault(&svg), None);
    }
}

#[test]
fn the_check_finds_faults() {
    assert_eq!(xml_fault("<a b=\"1\"><c/>x &amp; y</a>\n"), None);
    for fault in [
        "<a>",
        "<a></b>",
        "<a b=1/>",
        "<a>&</a>",
        "<a b=\"<\"/>",
        "<a b=\"1\" b=\"2\"/>",
        "<a d=\"NaN\"/>",
        "<a>\u{1}</a>",
        "<a",
    ] {
        assert!(xml_fault(fault).is_some(), "{fault:?} passes");
    }
}

#[test]
fn empty_pictures_say_so() {
    assert!(Chart::default().to_svg(300, 200).unwrap().contains("no data"));
    assert!(Profile::default().to_svg(300, 200).unwrap().contains("no data"));
    let points = vec![(0.0, 1.0), (1.0, -1.0), (f64::NAN, 1.0)];
    let chart = Chart { series: vec![Series::new("s", points)], ..Chart::default() };
    assert!(chart.to_svg(300, 200).unwrap().contains("no data"));
    let field = FieldPicture::new("", [0.0; 2], [1.0; 2], 3, 3, vec![f64::NAN; 9]);
    assert!(field.to_svg(300).unwrap().contains("no data"));
}

#[test]
fn wrong_input_is_named() {
    let field = FieldPicture::new("", [0.0; 2], [1.0; 2], 3, 3, vec![0.0; 9]);
    let short = FieldPicture { mask: Some(vec![0.0; 8]), ..field.clone() };
    let error = short.to_svg(300).unwrap_err();
    assert_eq!(error.to_string(), "`mask` has 8 entries, but 9 are needed");
    assert!(matches!(FieldPicture { nx: 1, ..field.clone() }.to_svg(300), Err(OutputError::Grid { .. })));
    assert!(matches!(
        FieldPicture { max: [0.0, 1.0], ..field.clone() }.to_svg(300),
        Err(OutputError::Grid { .. })
    ));
    assert!(matches!(field.to_svg(20), Err(OutputError::Size { width: 20, .. })));
    assert!(matches!(Chart::default().to_svg(300, 0), Err(OutputError::Size { .. })));
}

#[test]
fn a_gap_breaks_the_line() {
    let paths = |y: f64| {
        let points = vec![(1.0, 1.0), (2.0, 1.0), (3.0, y), (4.0, 1.0), (5.0, 2.0)];
        let series = vec![Series { points, stroke: Stroke::Line, ..Series::default() }];
        let chart = Chart { series, ..Chart::default() };
        chart.to_svg(400, 300).unwrap().matches("stroke-width=\"16\"").count()
    };
    assert_eq!((paths(1.0), paths(0.0), paths(f64::INFINITY)), (1, 2, 2));
}

#[test]
fn reference_lines_are_drawn_on_two_logarithmic_axes_only() {
    let series = vec![Series::new("s", vec![(0.1, 0.1), (1.0, 10.0)])];
    let chart = Chart { series, reference_slopes: vec![2.0], ..Chart::default() };
    assert!(chart.to_svg(400, 300).unwrap().contains("slope 2"));
    let linear = Chart { x: Axis::linear("x"), ..chart };
    assert!(!linear.to_svg(400, 300).unwrap().contains("slope"));
}

#[test]
fn a_large_field_makes_a_small_file() {
    let n = 200;
    let at = |k: usize| k as f64 / (n - 1) as f64;
    let values = (0..n * n).map(|k| (9.0 * at(k % n)).sin() * (8.0 * at(k / n)).cos() + at(k % n)).collect();
    let picture = FieldPicture { contours: 14, ..FieldPicture::new("u", [0.0; 2], [1.0; 2], n, n, values) };
    let svg = picture.to_svg(640).unwrap();
    assert!(svg.len() < 400_000, "{} bytes", svg.len());
    assert!(svg.matches("fill-rule=\"evenodd\"").count() >= 2 * 10);
}
