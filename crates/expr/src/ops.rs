//! The functions and operators: their names and what they compute for one value.

/// Functions of one argument, and the sign.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Unary {
    Neg,
    Sqrt,
    Exp,
    Log,
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Sinh,
    Cosh,
    Tanh,
    Abs,
}

/// Operators and functions of two arguments.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Binary {
    Add,
    Sub,
    Mul,
    Div,
    Pow,
    Less,
    LessEqual,
    Greater,
    GreaterEqual,
    Equal,
    NotEqual,
    Min,
    Max,
    Atan2,
}

/// Functions of one argument by name.
pub(crate) const UNARY_FUNCTIONS: [(&str, Unary); 13] = [
    ("sqrt", Unary::Sqrt),
    ("exp", Unary::Exp),
    ("log", Unary::Log),
    ("sin", Unary::Sin),
    ("cos", Unary::Cos),
    ("tan", Unary::Tan),
    ("asin", Unary::Asin),
    ("acos", Unary::Acos),
    ("atan", Unary::Atan),
    ("sinh", Unary::Sinh),
    ("cosh", Unary::Cosh),
    ("tanh", Unary::Tanh),
    ("abs", Unary::Abs),
];

/// Functions of two arguments by name.
pub(crate) const BINARY_FUNCTIONS: [(&str, Binary); 3] =
    [("atan2", Binary::Atan2), ("min", Binary::Min), ("max", Binary::Max)];

/// Integer exponents up to this magnitude are evaluated by multiplication: within a few rounding errors of the
/// correctly rounded power (one for each of at most 2 log2(64) products), and an order of magnitude faster.
pub(crate) const MAX_MULTIPLIED_POWER: i32 = 64;

impl Unary {
    /// The name as written in an expression.
    pub(crate) fn name(self) -> &'static str {
        UNARY_FUNCTIONS.iter().find(|(_, function)| *function == self).map_or("-", |(name, _)| name)
    }

    #[inline]
    pub(crate) fn apply(self, a: f64) -> f64 {
        match self {
            Self::Neg => -a,
            Self::Sqrt => a.sqrt(),
            Self::Exp => a.exp(),
            Self::Log => a.ln(),
            Self::Sin => a.sin(),
            Self::Cos => a.cos(),
            Self::Tan => a.tan(),
            Self::Asin => a.asin(),
            Self::Acos => a.acos(),
            Self::Atan => a.atan(),
            Self::Sinh => a.sinh(),
            Self::Cosh => a.cosh(),
            Self::Tanh => a.tanh(),
            Self::Abs => a.abs(),
        }
    }
}

impl Binary {
    /// The symbol or name as written in an expression.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Add => "+",
            Self::Sub => "-",
            Self::Mul => "*",
            Self::Div => "/",
            Self::Pow => "^",
            Self::Less => "<",
            Self::LessEqual => "<=",
            Self::Greater => ">",
            Self::GreaterEqual => ">=",
            Self::Equal => "==",
            Self::NotEqual => "!=",
            Self::Min => "min",
            Self::Max => "max",
            Self::Atan2 => "atan2",
        }
    }

    pub(crate) fn is_comparison(self) -> bool {
        matches!(
            self,
            Self::Less | Self::LessEqual | Self::Greater | Self::GreaterEqual | Self::Equal | Self::NotEqual
        )
    }

    #[inline]
    pub(crate) fn apply(self, a: f64, b: f64) -> f64 {
        match self {
            Self::Add => a + b,
            Self::Sub => a - b,
            Self::Mul => a * b,
            Self::Div => a / b,
            Self::Pow => pow(a, b),
            Self::Less => truth(a, b, a < b),
            Self::LessEqual => truth(a, b, a <= b),
            Self::Greater => truth(a, b, a > b),
            Self::GreaterEqual => truth(a, b, a >= b),
            Self::Equal => truth(a, b, a == b),
            Self::NotEqual => truth(a, b, a != b),
            Self::Min => min(a, b),
            Self::Max => max(a, b),
            Self::Atan2 => a.atan2(b),
        }
    }
}

/// 1 or 0, or NaN where either operand is one.
#[inline]
pub(crate) fn truth(a: f64, b: f64, holds: bool) -> f64 {
    if a.is_nan() || b.is_nan() { f64::NAN } else { f64::from(u8::from(holds)) }
}

/// The smaller value; unlike `f64::min`, NaN where either is one.
#[inline]
pub(crate) fn min(a: f64, b: f64) -> f64 {
    if a < b || a.is_nan() { a } else { b }
}

/// The larger value; unlike `f64::max`, NaN where either is one.
#[inline]
pub(crate) fn max(a: f64, b: f64) -> f64 {
    if a > b || a.is_nan() { a } else { b }
}

/// `if(c, a, b)`; NaN where the condition is.
#[inline]
pub(crate) fn select(c: f64, a: f64, b: f64) -> f64 {
    if c.is_nan() {
        f64::NAN
    } else if c != 0.0 {
        a
    } else {
        b
    }
}

/// `(a - b)^2`, with the bits of the difference times itself.
#[inline]
pub(crate) fn squared_difference(a: f64, b: f64) -> f64 {
    let difference = a - b;
    difference * difference
}

/// `a^b`, by multiplication for small integer exponents; NaN where either is one (IEEE `pow` gives NaN^0 = 1).
#[inline]
pub(crate) fn pow(a: f64, b: f64) -> f64 {
    match multiplied_power(b) {
        Some(n) => powi(a, n),
        None if a.is_nan() || b.is_nan() => f64::NAN,
        None => a.powf(b),
    }
}

/// The exponent as an integer, if it is one that is evaluated by multiplication.
#[inline]
pub(crate) fn multiplied_power(b: f64) -> Option<i32> {
    let n = b as i32;
    (f64::from(n) == b && n.abs() <= MAX_MULTIPLIED_POWER).then_some(n)
}

/// `a^n` by repeated squaring.
#[inline]
pub(crate) fn powi(a: f64, n: i32) -> f64 {
    match n {
        0 if a.is_nan() => return a,
        // As the loop multiplies, without its branches.
        1 => return a,
        2 => return a * a,
        3 => return a * (a * a),
        _ => {}
    }
    let mut power = 1.0;
    let mut square = a;
    let mut rest = n.unsigned_abs();
    while rest > 0 {
        if rest & 1 == 1 {
            power *= square;
        }
        rest >>= 1;
        if rest > 0 {
            square *= square;
        }
    }
    if n < 0 { 1.0 / power } else { power }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nan_is_never_hidden() {
        let nan = f64::NAN;
        for op in [Binary::Min, Binary::Max, Binary::Pow, Binary::Less, Binary::NotEqual, Binary::Atan2] {
            assert!(op.apply(nan, 0.0).is_nan(), "{op:?}");
            assert!(op.apply(1.0, nan).is_nan(), "{op:?}");
        }
        assert!(select(nan, 1.0, 2.0).is_nan());
        assert_eq!(select(1.0, 1.0, nan), 1.0);
        assert_eq!(select(0.0, nan, 2.0), 2.0);
    }

    #[test]
    fn integer_powers_agree_with_the_library() {
        for n in -MAX_MULTIPLIED_POWER..=MAX_MULTIPLIED_POWER {
            for a in [-1.7, -0.3, 0.9, 1.1, 2.0] {
                let reference = f64::powf(a, f64::from(n));
                // Each of at most n products loses half a unit in the last place; the error of the base grows n-fold.
                let allowed = f64::from(n.abs() + 1) * f64::EPSILON * reference.abs();
                assert!((powi(a, n) - reference).abs() <= allowed, "{a}^{n}");
            }
        }
        assert_eq!(pow(0.0, 0.0), 1.0);
        assert_eq!(pow(2.0, -1.0), 0.5);
        assert!(pow(-1.0, 0.5).is_nan());
    }
}
