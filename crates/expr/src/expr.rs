//! The public type.

use std::fmt;
use std::sync::Arc;

use crate::block;
use crate::derivative::derivative;
use crate::display;
use crate::error::ParseError;
use crate::node::Node;
use crate::parser;
use crate::program::Program;
use crate::substitute::substitute;

/// A parsed expression in variables that are known by their index.
///
/// Its [`Display`](fmt::Display) form parses to an expression with the same values.
#[derive(Clone)]
pub struct Expr {
    root: Arc<Node>,
    names: Arc<[String]>,
    program: Arc<Program>,
}

impl Expr {
    /// Parses a text in which the given variables are known; variable `i` is `variables[i]`.
    ///
    /// # Errors
    ///
    /// The first thing that is wrong, with its bytes: a character or name that is not known, a missing or superfluous
    /// operand, a wrong number of arguments, or a text beyond [`MAX_LENGTH`](crate::MAX_LENGTH),
    /// [`MAX_NESTING`](crate::MAX_NESTING) or [`MAX_HEIGHT`](crate::MAX_HEIGHT).
    pub fn parse(text: &str, variables: &[&str]) -> Result<Self, ParseError> {
        let root = parser::parse(text, variables)?;
        Ok(Self::new(root, variables.iter().map(|name| (*name).to_owned()).collect()))
    }

    /// The same value everywhere.
    pub fn constant(value: f64) -> Self {
        Self::new(Arc::new(Node::Constant(value)), Arc::new([]))
    }

    fn new(root: Arc<Node>, names: Arc<[String]>) -> Self {
        let program = Arc::new(Program::new(&root));
        Self { root, names, program }
    }

    /// The value, if no variable occurs; it may be infinite or NaN, as of `1/0` or `log(-1)`.
    pub fn as_constant(&self) -> Option<f64> {
        self.program.last_variable().is_none().then(|| self.program.eval(&[]))
    }

    /// Whether the variable occurs (which does not mean that the value changes with it: `x - x`).
    pub fn depends_on(&self, variable: usize) -> bool {
        self.program.reads(variable)
    }

    /// Whether both are the same formula, or the same constant. Formulas that only have the same values are not.
    pub fn is_same(&self, other: &Self) -> bool {
        self.root == other.root || self.as_constant().is_some_and(|value| other.as_constant() == Some(value))
    }

    /// Value at one point: `values[i]` is that of variable `i`.
    ///
    /// # Panics
    ///
    /// If a variable occurs that has no value.
    pub fn eval(&self, values: &[f64]) -> f64 {
        self.program.eval(values)
    }

    /// Values at many points: variable `i` is coordinate `i` for `i < D`, else `extra[i - D]`, the same at all points.
    ///
    /// Gives the bits that [`eval`](Self::eval) gives. The points are taken in blocks with one loop for each
    /// operation; the scratch for that, a few KiB, is allocated once a call.
    ///
    /// # Panics
    ///
    /// If `out` and `points` differ in length, or a variable occurs that has no value.
    pub fn eval_points<const D: usize>(&self, points: &[[f64; D]], extra: &[f64], out: &mut [f64]) {
        assert_eq!(points.len(), out.len(), "one value for each point");
        let known = D + extra.len();
        assert!(
            self.program.last_variable().is_none_or(|last| last < known),
            "`{self}` has variables beyond the {known} that were given values"
        );
        block::run(&self.program, points, extra, out);
    }

    /// The expression with a number in place of a variable, which does not occur in it any more. The other variables keep
    /// their indices.
    ///
    /// ```
    /// let wave = meshless_expr::Expr::parse("sin(x - t)*t", &["x", "t"])?;
    /// let still = wave.with_value(1, 2.0);
    /// assert_eq!(still.eval(&[0.5]), wave.eval(&[0.5, 2.0]));
    /// # Ok::<(), meshless_expr::ParseError>(())
    /// ```
    #[must_use]
    pub fn with_value(&self, variable: usize, value: f64) -> Self {
        Self::new(substitute(&self.root, variable, value), self.names.clone())
    }

    /// Partial derivative, with zeros, ones and constants simplified away.
    ///
    /// `abs` has slope 0 where its argument is 0; `min`, `max` and `if` are differentiated piece by piece, so jumps
    /// between the pieces and comparisons contribute nothing.
    #[must_use]
    pub fn derivative(&self, variable: usize) -> Self {
        Self::new(derivative(&self.root, variable), self.names.clone())
    }
}

impl fmt::Display for Expr {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        display::write(f, &self.root, &self.names, 0)
    }
}

impl fmt::Debug for Expr {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Expr({self})")
    }
}
