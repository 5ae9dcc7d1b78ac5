//! Expressions in a scene.

use std::ops::Range;
use std::sync::Arc;

use meshless_expr::{Expr, ParseError};

use super::error::SceneError;
use super::reader::Value;
use super::source::{Place, Source};

/// Variables of an expression of position: as many as the scene has dimensions.
const VARIABLES: [&str; 3] = ["x", "y", "z"];

/// The variable that comes after them where data may change with time.
const TIME: &str = "t";

/// What an expression may depend on.
#[derive(Debug, Clone, Copy)]
struct Variables {
    dimension: usize,
    time: bool,
}

/// An expression of position, or a number, with its place in the file.
#[derive(Debug, Clone)]
pub struct ExprField {
    /// As the scene has it.
    pub text: String,
    /// Parsed; its variables are the coordinates. Finite where it is constant.
    pub expr: Expr,
    /// The value in the file.
    pub place: Place,
}

impl ExprField {
    /// A positive expression that an option of the command line gives in place of the scene's; errors about it show the
    /// option and its text.
    pub(crate) fn from_command_line(option: &str, text: &str, dimension: usize) -> Result<Self, SceneError> {
        let place = Place::new(&Arc::new(Source::new("command line", text)), option, 0..text.len());
        parse(text, &place, Variables { dimension, time: false })?.check_positive()
    }

    /// A number that the scene leaves open; errors about it show `place`.
    pub(super) fn constant(value: f64, place: &Place) -> Self {
        Self { text: value.to_string(), expr: Expr::constant(value), place: place.clone() }
    }

    /// Whether the value changes with time, in a scene of that dimension.
    pub(crate) fn varies_in_time(&self, dimension: usize) -> bool {
        self.expr.depends_on(dimension)
    }

    /// How fast it changes at one time; `None` where it does not depend on it.
    pub(super) fn rate_at_time(&self, dimension: usize, t: f64) -> Option<Self> {
        let rate = || self.expr.derivative(dimension).with_value(dimension, t);
        self.varies_in_time(dimension).then(|| Self { expr: rate(), ..self.clone() })
    }

    /// The field at one time.
    pub(super) fn at_time(&self, dimension: usize, t: f64) -> Self {
        Self { expr: self.expr.with_value(dimension, t), ..self.clone() }
    }

    /// The value, if the expression is constant and therefore finite.
    pub fn as_constant(&self) -> Option<f64> {
        self.expr.as_constant()
    }

    /// Positive where it is constant.
    pub(super) fn check_positive(self) -> Result<Self, SceneError> {
        match self.as_constant() {
            Some(value) if value <= 0.0 => {
                Err(self.place.error(format!("expected a positive value, found {value}"), ""))
            }
            _ => Ok(self),
        }
    }
}

impl Value<'_> {
    /// A number, or an expression of position in quotes.
    pub(super) fn expression(&self) -> Result<ExprField, SceneError> {
        self.expression_of(Variables { dimension: self.dimension, time: false })
    }

    /// The same, which may also depend on `t` in a scene with `[time]`.
    pub(super) fn data_expression(&self) -> Result<ExprField, SceneError> {
        self.expression_of(Variables { dimension: self.dimension, time: self.unsteady })
    }

    /// The product of two expressions that are parts of this value.
    pub(super) fn product(&self, a: &ExprField, b: &ExprField) -> Result<ExprField, SceneError> {
        let factor = |field: &ExprField| match field.as_constant() {
            Some(value) => format!("({value:e})"),
            None => format!("({})", field.text),
        };
        let text = format!("{}*{}", factor(a), factor(b));
        parse(&text, &self.place, Variables { dimension: self.dimension, time: self.unsteady })
    }

    fn expression_of(&self, variables: Variables) -> Result<ExprField, SceneError> {
        if let Some(number) = self.as_number() {
            let text = self.place.text().to_owned();
            return Ok(ExprField { text, expr: Expr::constant(number?), place: self.place.clone() });
        }
        let Some(text) = self.as_text() else {
            let help = "write a number, or an expression in quotes";
            return Err(self.expected("a number or an expression", help));
        };
        parse(text, &self.place, variables)
    }
}

fn parse(text: &str, place: &Place, variables: Variables) -> Result<ExprField, SceneError> {
    let names: Vec<&str> =
        VARIABLES[..variables.dimension].iter().copied().chain(variables.time.then_some(TIME)).collect();
    let expr = Expr::parse(text, &names).map_err(|error| {
        let ParseError { span, message, help } = error;
        let place = match content_offset(place.text(), text) {
            _ if place.text() == text => place.at(span),
            Some(offset) => place.at(shift(&span, place.span.start + offset)),
            None => place.clone(),
        };
        place.error(message, help.unwrap_or_default())
    })?;
    if let Some(value) = expr.as_constant().filter(|value| !value.is_finite()) {
        return Err(place.error(format!("expected a finite value, found {value}"), ""));
    }
    Ok(ExprField { text: text.to_owned(), expr, place: place.clone() })
}

fn shift(span: &Range<usize>, by: usize) -> Range<usize> {
    span.start + by..span.end + by
}

/// Where the content of a quoted string starts, if the string stands in the file as it is, without escapes.
fn content_offset(quoted: &str, content: &str) -> Option<usize> {
    let quote = ["\"\"\"", "'''", "\"", "'"].into_iter().find(|quote| quoted.starts_with(quote))?;
    let inner = quoted.strip_prefix(quote)?.strip_suffix(quote)?;
    // A line break right after three quotes does not belong to the string.
    let skipped = if quote.len() == 1 || inner == content {
        0
    } else {
        inner.strip_prefix("\r\n").map_or(1, |_| 2).min(inner.len())
    };
    (inner.get(skipped..)? == content).then_some(quote.len() + skipped)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_content_of_strings_is_found() {
        assert_eq!(content_offset("\"x + 1\"", "x + 1"), Some(1));
        assert_eq!(content_offset("'x + 1'", "x + 1"), Some(1));
        assert_eq!(content_offset("\"\"\"x\"\"\"", "x"), Some(3));
        assert_eq!(content_offset("'''\nx'''", "x"), Some(4));
        assert_eq!(content_offset("'''\r\nx'''", "x"), Some(5));
        assert_eq!(content_offset("\"\\u0078\"", "x"), None);
        assert_eq!(content_offset("\"\"", ""), Some(1));
    }

    #[test]
    fn errors_about_the_command_line_show_its_text() {
        let ask = |text| ExprField::from_command_line("--spacing", text, 2);
        let error = ask("-0.1").expect_err("not positive").to_string();
        assert_eq!(
            error,
            "command line:1:1: --spacing: expected a positive value, found -0.1\n    1 | -0.1\n      | ^^^^"
        );
        let error = ask("0.1*(x+").expect_err("not closed").to_string();
        assert!(error.starts_with("command line:1:8: --spacing: "), "{error}");
        assert!(ask("0.1 + z").is_err() && ask("0.1 + y").is_ok());
    }
}
