//! Invariants over random expressions and random texts.

use meshless_expr::Expr;
use proptest::prelude::*;

/// A random expression as fully parenthesised text, with a closure that evaluates it independently.
#[derive(Debug, Clone)]
enum Tree {
    Number(f64),
    Variable(usize),
    Call(&'static str, Box<Tree>),
    Infix(&'static str, Box<Tree>, Box<Tree>),
    If(Box<Tree>, Box<Tree>, Box<Tree>),
}

const NAMES: [&str; 3] = ["x", "y", "t"];

impl Tree {
    fn text(&self) -> String {
        match self {
            Self::Number(value) => format!("{value:?}"),
            Self::Variable(index) => NAMES[*index].to_owned(),
            Self::Call("-", a) => format!("(-{})", a.text()),
            Self::Call(name, a) => format!("{name}({})", a.text()),
            Self::Infix(name @ ("min" | "max" | "atan2"), a, b) => {
                format!("{name}({}, {})", a.text(), b.text())
            }
            Self::Infix(op, a, b) => format!("({} {op} {})", a.text(), b.text()),
            Self::If(c, a, b) => format!("if({} < 0.5, {}, {})", c.text(), a.text(), b.text()),
        }
    }

    fn value(&self, at: [f64; 3]) -> f64 {
        match self {
            Self::Number(value) => *value,
            Self::Variable(index) => at[*index],
            Self::Call(name, a) => {
                let a = a.value(at);
                match *name {
                    "-" => -a,
                    "sqrt" => a.sqrt(),
                    "exp" => a.exp(),
                    "log" => a.ln(),
                    "sin" => a.sin(),
                    "cos" => a.cos(),
                    "tan" => a.tan(),
                    "asin" => a.asin(),
                    "acos" => a.acos(),
                    "atan" => a.atan(),
                    "sinh" => a.sinh(),
                    "cosh" => a.cosh(),
                    "tanh" => a.tanh(),
                    "abs" => a.abs(),
                    _ => unreachable!(),
                }
            }
            Self::Infix(op, a, b) => {
                let (a, b) = (a.value(at), b.value(at));
                let hidden = a.is_nan() || b.is_nan();
                match *op {
                    "+" => a + b,
                    "-" => a - b,
                    "*" => a * b,
                    "/" => a / b,
                    _ if hidden => f64::NAN,
                    "^" => a.powf(b),
                    "min" => a.min(b),
                    "max" => a.max(b),
                    "atan2" => a.atan2(b),
                    "<" => f64::from(a < b),
                    ">=" => f64::from(a >= b),
                    _ => unreachable!(),
                }
            }
            Self::If(c, a, b) => {
                let c = c.value(at);
                if c.is_nan() {
                    f64::NAN
                } else if c < 0.5 {
                    a.value(at)
                } else {
                    b.value(at)
                }
            }
        }
    }
}

/// Trees of any function; `smooth` ones keep to where everything is differentiable and well scaled.
fn tree(smooth: bool) -> impl Strategy<Value = Tree> {
    let leaf = prop_oneof![
        (0.1..3.0f64).prop_map(Tree::Number),
        (0usize..3).prop_map(|n| Tree::Number(n as f64)),
        (0usize..3).prop_map(Tree::Variable),
    ];
    let calls: Vec<&str> = if smooth {
        vec!["-", "sin", "cos", "atan", "tanh", "abs"]
    } else {
        vec![
            "-", "sqrt", "exp", "log", "sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh", "tanh",
            "abs",
        ]
    };
    let infix: Vec<&str> = if smooth {
        vec!["+", "-", "*", "min", "max"]
    } else {
        vec!["+", "-", "*", "/", "^", "min", "max", "atan2", "<", ">="]
    };
    leaf.prop_recursive(5, 40, 3, move |inner| {
        let pair = (inner.clone(), inner.clone());
        prop_oneof![
            (prop::sample::select(calls.clone()), inner.clone()).prop_map(|(f, a)| Tree::Call(f, a.into())),
            (prop::sample::select(infix.clone()), pair).prop_map(|(op, (a, b))| Tree::Infix(
                op,
                a.into(),
                b.into()
            )),
            (inner.clone(), inner.clone(), inner).prop_map(|(c, a, b)| Tree::If(
                c.into(),
                a.into(),
                b.into()
            )),
        ]
    })
}

fn point() -> impl Strategy<Value = [f64; 3]> {
    [-2.0..2.0f64, -2.0..2.0f64, 0.0..1.0f64]
}

fn parse(text: &str) -> Expr {
    Expr::parse(text, &NAMES).unwrap_or_else(|e| panic!("{text}: {e}"))
}

fn same(a: f64, b: f64) -> bool {
    a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn values_are_those_of_direct_evaluation(tree in tree(false), at in point()) {
        let (value, direct) = (parse(&tree.text()).eval(&at), tree.value(at));
        // Only powers may differ, by the rounding of products, which a chaotic expression (tan of a large number)
        // can amplify: without powers the bits agree.
        if tree.text().contains('^') {
            let close = (value - direct).abs() <= 1e-9 * direct.abs().max(1.0);
            prop_assume!(close || direct.abs() < 1e6);
            prop_assert!(close || value.is_nan() && direct.is_nan() || value == direct, "{value} {direct}");
        } else {
            prop_assert!(same(value, direct) || value == direct, "{value} is not {direct}");
        }
    }

    #[test]
    fn blocks_of_points_give_the_bits_of_single_points(tree in tree(false), seed in point(), n in 0usize..1200) {
        let e = parse(&tree.text());
        let points: Vec<[f64; 2]> =
            (0..n).map(|i| [seed[0] + 0.01 * i as f64, seed[1] - 0.013 * i as f64]).collect();
        let mut out = vec![f64::NAN; n];
        e.eval_points(&points, &[seed[2]], &mut out);
        for (value, point) in out.iter().zip(&points) {
            prop_assert!(same(*value, e.eval(&[point[0], point[1], seed[2]])));
        }
    }

    #[test]
    fn printed_expressions_parse_to_the_same_values(tree in tree(false), at in point()) {
        let e = parse(&tree.text());
        prop_assert!(same(e.eval(&at), parse(&e.to_string()).eval(&at)), "{}", e);
        let slope = e.derivative(0);
        prop_assert!(same(slope.eval(&at), parse(&slope.to_string()).eval(&at)), "{}", slope);
    }

    #[test]
    fn derivatives_are_the_limit_of_differences(tree in tree(true), at in point(), variable in 0usize..3) {
        let e = parse(&tree.text());
        let slope = e.derivative(variable).eval(&at);
        let shifted = |by: f64| { let mut at = at; at[variable] += by; e.eval(&at) };
        let difference = |h: f64| (shifted(h) - shifted(-h)) / (2.0 * h);
        let (coarse, fine) = (difference(2e-5), difference(1e-5));
        let scale = shifted(0.0).abs() + slope.abs() + 1.0;
        // Where two step widths disagree there is a kink or a jump nearby.
        prop_assume!((coarse - fine).abs() <= 1e-6 * scale && scale < 1e3);
        // Round-off of the difference, eps/h = 2e-11, and its h^2 truncation stay far below.
        prop_assert!((slope - fine).abs() <= 1e-5 * scale, "{e}: {slope} is not {fine}");
    }

    #[test]
    fn no_text_panics(text in "\\PC{0,40}") {
        let _ = Expr::parse(&text, &NAMES);
    }

    #[test]
    fn no_text_of_the_right_alphabet_panics(text in "[-+*/^<>=!(),.0-9exyt pinsqrtabmdf]{0,60}") {
        match Expr::parse(&text, &NAMES) {
            Ok(e) => {
                let _ = e.derivative(0).derivative(1).eval(&[0.3, 0.4, 0.5]);
            }
            Err(error) => prop_assert!(text.get(error.span.clone()).is_some(), "{error}"),
        }
    }
}

/// Each elementary function by itself, with arguments inside its domain.
#[test]
fn every_function_has_its_derivative() {
    for text in [
        "sqrt(x)",
        "exp(x)",
        "log(x)",
        "sin(x)",
        "cos(x)",
        "tan(x)",
        "asin(x)",
        "acos(x)",
        "atan(x)",
        "sinh(x)",
        "cosh(x)",
        "tanh(x)",
        "abs(-x)",
        "x^5",
        "x^-2",
        "x^2.5",
        "2.5^x",
        "x^x",
        "y^x",
        "x^y",
        "1/x",
        "y/x",
        "x/y",
        "atan2(x, y)",
        "atan2(y, x)",
        "atan2(x, x^2)",
        "min(x, y)",
        "max(x, x^2)",
        "if(x < 0.5, x^2, x^3)",
        "x*sin(x*y)",
        "sqrt(1 + x^2)^3",
        "exp(-x^2)/(1 + x)",
        "-x + (x - 1)*(x + 1)",
    ] {
        let e = parse(text);
        for x in [0.2, 0.4, 0.6, 0.8] {
            let value = |x: f64| e.eval(&[x, 0.7, 0.0]);
            // Richardson: the error is of order h^4, some 1e-10 for these functions.
            let difference = |h: f64| (value(x + h) - value(x - h)) / (2.0 * h);
            let limit = (4.0 * difference(5e-4) - difference(1e-3)) / 3.0;
            let slope = e.derivative(0).eval(&[x, 0.7, 0.0]);
            assert!(
                (slope - limit).abs() <= 1e-8 * (1.0 + limit.abs()),
                "d/dx {text} at {x}: {slope}, not {limit}"
            );
        }
    }
}
