//! Observed orders, by least squares over a ladder of spacings.

use meshless::scene::MethodName;
use meshless_tests::kraus;
use meshless_tests::order::observed;
use meshless_tests::smooth::smooth;
use meshless_tests::solve::solve_with;

fn ladder(spacings: &[f64], method: MethodName, text: impl Fn(f64) -> String) -> Vec<(f64, f64)> {
    spacings
        .iter()
        .map(|&h| {
            (
                h,
                solve_with(&text(h), method)
                    .expect("the scene can be solved")
                    .report
                    .errors
                    .expect("the scene can be solved")
                    .l2,
            )
        })
        .collect()
}

#[test]
fn the_classical_method_is_of_second_order_where_nothing_jumps() {
    for (dimension, spacings) in
        [(1, &[0.05, 0.025, 0.0125][..]), (2, &[0.1, 0.05, 0.025]), (3, &[0.2, 0.1, 0.07])]
    {
        for robin in [false, true] {
            let ladder = ladder(spacings, MethodName::GfdmClassical, |h| smooth(dimension, h, robin));
            let order = observed(&ladder);
            assert!(order > 1.7, "{dimension}-D, robin {robin}: order {order}, {ladder:?}");
        }
    }
}

#[test]
fn the_conservative_hybrid_is_of_first_order_whatever_the_jump() {
    for jump in [1e2, 1e6, 1e10] {
        let cases: [(&str, &dyn Fn(f64) -> String); 3] = [
            ("two-strip", &|h| kraus::two_strip(jump, h, 1)),
            ("curved", &|h| kraus::curved(1.0, jump, h, 1)),
            ("interior", &|h| kraus::interior(jump, h, 1)),
        ];
        for (name, case) in cases {
            let ladder = ladder(&[0.2, 0.1, 0.05], MethodName::GfdmHybrid, case);
            let order = observed(&ladder);
            assert!(order >= 0.9, "{name} at {jump:e}: order {order}, {ladder:?}");
        }
    }
}
