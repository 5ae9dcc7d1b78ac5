//! The language as documented: values, and errors with their bytes.

use meshless_expr::{Expr, MAX_HEIGHT, MAX_LENGTH, MAX_NESTING};

#[track_caller]
fn value(text: &str) -> f64 {
    Expr::parse(text, &["x", "y", "t"]).unwrap_or_else(|e| panic!("{text}: {e}")).eval(&[3.0, 4.0, 0.5])
}

#[test]
fn precedence_is_that_of_mathematics() {
    for (text, expected) in [
        ("-x^2", -9.0),
        ("(-x)^2", 9.0),
        ("2^3^2", 512.0),
        ("(2^3)^2", 64.0),
        ("2^-1", 0.5),
        ("2^-x^2", 1.0 / 512.0),
        ("-2^-2", -0.25),
        ("1e-3*x", 0.003),
        ("1 - 2 - 3", -4.0),
        ("8/4/2", 1.0),
        ("8/4*2", 4.0),
        ("-x*y", -12.0),
        ("x - -y", 7.0),
        ("--x", 3.0),
        ("+x", 3.0),
        ("2*-x", -6.0),
        ("1 + 2 < 4", 1.0),
        ("(x < y) == (1 < 2)", 1.0),
        ("pi", std::f64::consts::PI),
        ("t*2", 1.0),
    ] {
        assert_eq!(value(text), expected, "{text}");
    }
}

#[test]
fn functions_have_their_usual_meaning() {
    for (text, expected) in [
        ("sqrt(y)", 2.0),
        ("exp(1)", std::f64::consts::E),
        ("log(exp(2))", 2.0),
        ("sin(pi/2)", 1.0),
        ("cos(pi)", -1.0),
        ("tan(pi/4)", f64::tan(std::f64::consts::FRAC_PI_4)),
        ("asin(1)", std::f64::consts::FRAC_PI_2),
        ("acos(-1)", std::f64::consts::PI),
        ("atan(1)", std::f64::consts::FRAC_PI_4),
        ("atan2(1, -1)", 3.0 * std::f64::consts::FRAC_PI_4),
        ("sinh(0)", 0.0),
        ("cosh(0)", 1.0),
        ("tanh(0)", 0.0),
        ("abs(-x)", 3.0),
        ("min(x, y)", 3.0),
        ("max(x, y, 7, 5)", 7.0),
        ("if(x > y, 1, 2)", 2.0),
        ("if(0.5, 1, 2)", 1.0),
        ("x >= 3", 1.0),
        ("x != 3", 0.0),
        ("x <= 2.9", 0.0),
    ] {
        assert_eq!(value(text), expected, "{text}");
    }
}

#[test]
fn only_the_branch_that_is_taken_matters() {
    let e = Expr::parse("if(x < 0, 1, sqrt(x))", &["x"]).expect("valid");
    assert_eq!(e.eval(&[-4.0]), 1.0);
    let mut out = [0.0; 2];
    e.eval_points(&[[-4.0], [4.0]], &[], &mut out);
    assert_eq!(out, [1.0, 2.0]);
    assert_eq!(e.derivative(0).eval(&[-4.0]), 0.0);
}

/// A value used twice by one operation must not free its register twice.
#[test]
fn repeated_subexpressions_are_computed_once_and_kept() {
    let e =
        Expr::parse("sin(x)*sin(x) + (cos(x) + tan(x))*(cos(x) - tan(x)) - exp(x)", &["x"]).expect("valid");
    let x: f64 = 0.3;
    let direct = x.sin() * x.sin() + (x.cos() + x.tan()) * (x.cos() - x.tan()) - x.exp();
    assert_eq!(e.eval(&[x]), direct);
    let e = Expr::parse("(x - 1)^2*(x - 1) + (1 - x)^2 + (x - 1)^3", &["x"]).expect("valid");
    let d: f64 = x - 1.0;
    assert_eq!(e.eval(&[x]), d * d * d + d * d + d * (d * d));
}

#[test]
fn a_nan_is_never_hidden() {
    for text in
        ["sqrt(-x) < 1", "min(sqrt(-x), 1)", "max(1, log(-x))", "log(-x)^0", "if(log(-x), 1, 2)", "0*log(-x)"]
    {
        assert!(value(text).is_nan(), "{text}");
    }
}

#[test]
fn constants_are_recognised() {
    let parse = |text| Expr::parse(text, &["x"]).expect("valid");
    assert_eq!(parse("2*(3 + 4)^2").as_constant(), Some(98.0));
    assert_eq!(parse("2*x").as_constant(), None);
    assert_eq!(parse("if(1 < 2, 5, x)").as_constant(), Some(5.0));
    assert_eq!(parse("1/0").as_constant(), Some(f64::INFINITY));
    assert!(parse("log(-1)").as_constant().is_some_and(f64::is_nan));
    assert_eq!(Expr::constant(2.5).as_constant(), Some(2.5));
    assert!(parse("2*x").depends_on(0));
    assert!(!parse("2").depends_on(0));
}

#[test]
fn derivatives_are_tidy() {
    for (text, expected) in [
        ("x^2", "2*x"),
        ("x^3", "3*x^2"),
        ("3*x + 4*y", "3"),
        ("x*y", "y"),
        ("sin(2*x)", "2*cos(2*x)"),
        ("exp(-x)", "-exp(-x)"),
        ("1/x", "-(1/x/x)"),
        ("sqrt(x)", "1/(2*sqrt(x))"),
        ("x < 1", "0"),
        ("if(x < 1, x, 2*x)", "if(x < 1, 1, 2)"),
        ("max(x, y)", "if(x > y, 1, 0)"),
        ("abs(x)", "(x > 0) - (x < 0)"),
        ("y^2", "0"),
        ("x^y", "y*x^(y - 1)"),
        ("2^x", "0.6931471805599453*2^x"),
    ] {
        let e = Expr::parse(text, &["x", "y"]).expect(text);
        assert_eq!(e.derivative(0).to_string(), expected, "d/dx {text}");
    }
}

#[test]
fn display_keeps_the_grouping() {
    for text in [
        "x - (y - 1)",
        "(x - y) - 1",
        "-x^2",
        "(-x)^2",
        "2^-x",
        "(x^2)^3",
        "x^2^3",
        "-(x + y)",
        "(x < y) < 1",
    ] {
        let e = Expr::parse(text, &["x", "y"]).expect(text);
        let again = Expr::parse(&e.to_string(), &["x", "y"]).expect(text);
        assert_eq!(e.eval(&[0.7, 1.3]), again.eval(&[0.7, 1.3]), "{text} became {e}");
    }
    assert_eq!(Expr::constant(f64::INFINITY).to_string(), "1/0");
    assert_eq!(Expr::constant(1e300).to_string(), "1e300");
}

#[test]
fn errors_point_at_what_is_wrong() {
    for (text, span, message, help) in [
        ("", 0..0, "empty", ""),
        ("   ", 0..3, "empty", ""),
        ("1 +", 3..3, "ends where an operand", ""),
        ("(1 + 2", 0..1, "never closed", ""),
        ("1 + 2)", 5..6, "closes nothing", ""),
        ("2x", 1..2, "expected an operator, found `x`", "`*`"),
        ("2 (x)", 2..3, "expected an operator, found `(`", "`*`"),
        ("1,5", 1..2, "unexpected `,`", "`.`"),
        ("x(3)", 0..1, "not a function", "x*("),
        ("sin x", 0..3, "no arguments", "sin(…)"),
        ("sin()", 0..5, "takes one argument, found 0", ""),
        ("sin(x, y)", 0..9, "takes one argument, found 2", ""),
        ("atan2(x)", 0..8, "takes two arguments, found 1", ""),
        ("1 + if(x, y)", 4..12, "three arguments", ""),
        ("if(x, 1, 2, 3)", 0..14, "found 4", ""),
        ("max(x)", 0..6, "two or more", ""),
        ("sprt(x)", 0..4, "unknown name `sprt`", "`sqrt`"),
        ("ln(x)", 0..2, "unknown name `ln`", "`log`"),
        ("1 + volt", 4..8, "unknown name `volt`", "x, y"),
        ("z + 1", 0..1, "unknown name `z`", "x, y"),
        ("0 < x < 1", 2..7, "do not chain", "(a < b)*(b < c)"),
        ("x = 1", 2..3, "unexpected character `=`", "`==`"),
        ("x ** 2", 2..4, "unknown operator", "`^`"),
        ("x && y", 2..3, "unexpected character `&`", "product"),
        ("1 + * 2", 4..5, "expected an operand, found `*`", ""),
        ("(x, y)", 2..3, "expected `)`, found `,`", ""),
        ("é", 0..2, "unexpected character", "ASCII"),
        ("1e999", 0..5, "too large", ""),
    ] {
        let error = Expr::parse(text, &["x", "y"]).expect_err(text);
        assert_eq!(error.span, span, "{text}: {error}");
        assert!(error.message.contains(message), "{text}: {error}");
        assert!(error.help.clone().unwrap_or_default().contains(help), "{text}: {:?}", error.help);
    }
}

/// The limits hold on a thread with the two MiB of stack that test and worker threads have.
#[test]
fn hostile_texts_cannot_exhaust_the_stack() {
    let too_deep = "(".repeat(MAX_LENGTH);
    assert!(Expr::parse(&too_deep, &["x"]).expect_err("too deep").message.contains("nested"));
    assert!(Expr::parse(&"-".repeat(MAX_LENGTH), &["x"]).expect_err("too deep").message.contains("nested"));
    assert!(
        Expr::parse(&"x^".repeat(MAX_LENGTH / 2), &["x"]).expect_err("too deep").message.contains("nested")
    );
    assert!(
        Expr::parse(&"sin(".repeat(MAX_LENGTH / 4), &["x"]).expect_err("too deep").message.contains("nested")
    );
    let too_long = format!("x{}", "+x".repeat(MAX_HEIGHT));
    assert!(Expr::parse(&too_long, &["x"]).expect_err("too high").message.contains("chain"));
    assert!(
        Expr::parse(&" ".repeat(MAX_LENGTH + 1), &["x"]).expect_err("too long").message.contains("bytes")
    );

    for worst in [
        format!("x{}", "/x".repeat(MAX_HEIGHT - 1)),
        format!("{}x{}", "(".repeat(MAX_NESTING - 1), ")".repeat(MAX_NESTING - 1)),
        format!("{}x{}", "abs(".repeat(MAX_NESTING - 1), ")".repeat(MAX_NESTING - 1)),
        format!("{}x", "x^".repeat(MAX_NESTING - 1)),
    ] {
        let e = Expr::parse(&worst, &["x"]).expect("within the limits");
        let second = e.derivative(0).derivative(0);
        assert!(!second.eval(&[1.0]).is_infinite());
        assert!(!e.derivative(0).to_string().is_empty());
    }
}
