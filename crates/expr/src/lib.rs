//! A small, strict expression language for fields of position and time.
//!
//! It is for the coefficients, sources and exact solutions that a user writes in a scene file: arithmetic only,
//! parsed once with errors that point at the offending bytes, differentiated symbolically, and evaluated over
//! many points at nearly the speed of compiled code.
//!
//! It is *not* for programs: there are no assignments, loops, strings or user functions, and it is no computer
//! algebra system. [`Expr::derivative`] simplifies zeros, ones and constants, nothing more.
//!
//! # The language
//!
//! - numbers (`2`, `.5`, `1e-3`), the constant `pi`, and the variables that the caller names;
//! - `+ - * /`, and `^`, which binds tighter than the sign and to the right: `-x^2` is `-(x^2)`, `2^3^2` is 512,
//!   and `2^-1` needs no parentheses;
//! - `< <= > >= == !=`, which give 1 or 0 and do not chain;
//! - `if(c, a, b)`, which is `a` where `c` is not zero; the branch that is not taken has no influence;
//! - `sqrt exp log sin cos tan asin acos atan sinh cosh tanh abs` of one argument, `atan2` of two,
//!   `min` and `max` of two or more.
//!
//! A NaN is never hidden: it passes through comparisons, `min`, `max`, `^` and the condition of `if`, so that
//! whoever evaluates an expression finds it in the result.
//!
//! ```
//! use meshless_expr::Expr;
//!
//! let eta = Expr::parse("(x - 1)^2 + (y - 1)^2 + 1", &["x", "y"])?;
//! assert_eq!(eta.eval(&[3.0, 1.0]), 5.0);
//!
//! let slope = eta.derivative(0);
//! assert_eq!(slope.to_string(), "2*(x - 1)");
//!
//! let mut values = [0.0; 2];
//! eta.eval_points(&[[1.0, 1.0], [2.0, 0.0]], &[], &mut values);
//! assert_eq!(values, [1.0, 3.0]);
//!
//! let error = Expr::parse("1 + sinh(u)", &["x", "y"]).unwrap_err();
//! assert_eq!(error.span, 9..10);
//! # Ok::<(), meshless_expr::ParseError>(())
//! ```

mod block;
mod derivative;
mod display;
mod error;
mod expr;
mod lexer;
mod node;
mod ops;
mod parser;
mod program;
mod simplify;
mod substitute;
mod suggest;

pub use error::ParseError;
pub use expr::Expr;
pub use parser::{MAX_HEIGHT, MAX_LENGTH, MAX_NESTING};
pub use suggest::nearest_name;
