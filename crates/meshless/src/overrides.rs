//! What the command line changes in a scene.

use meshless_expr::Expr;
use thiserror::Error;

use crate::scene::{ExprField, MethodName, Scene};

/// Values that take the place of the scene's.
#[derive(Debug, Clone, Copy, Default)]
pub struct Overrides<'a> {
    /// Name of the method.
    pub method: Option<&'a str>,
    /// Polynomial degree of the stencils.
    pub order: Option<usize>,
    /// Spacing: a number or an expression of position.
    pub spacing: Option<&'a str>,
}

/// Why an override cannot be used.
#[derive(Debug, Error)]
pub enum OverrideError {
    /// No such method.
    #[error("--method {name}: {reason}")]
    Method {
        /// What was given.
        name: String,
        /// Why not.
        reason: String,
    },
    /// Not an order that stencils can have.
    #[error("--order {0}: the stencils reproduce polynomials of degree 2 to 8")]
    Order(usize),
    /// Not a spacing.
    #[error("--spacing {text}: {reason}")]
    Spacing {
        /// What was given.
        text: String,
        /// Why not.
        reason: String,
    },
}

impl Overrides<'_> {
    /// Changes the scene.
    pub fn apply(&self, scene: &mut Scene) -> Result<(), OverrideError> {
        if let Some(name) = self.method {
            scene.method.name = MethodName::parse(name).map_err(|reason| OverrideError::Method {
                name: name.to_owned(),
                reason: format!("{reason}; {}", reason.help()),
            })?;
        }
        if let Some(order) = self.order {
            if !(2..=8).contains(&order) {
                return Err(OverrideError::Order(order));
            }
            scene.method.order = Some(order);
        }
        if let Some(text) = self.spacing {
            scene.points.spacing = spacing(text, scene.dimension)?;
        }
        Ok(())
    }
}

fn spacing(text: &str, dimension: usize) -> Result<ExprField, OverrideError> {
    let refuse = |reason: String| OverrideError::Spacing { text: text.to_owned(), reason };
    let expr = Expr::parse(text, &["x", "y", "z"][..dimension]).map_err(|e| refuse(e.to_string()))?;
    if expr.as_constant().is_some_and(|s| !(s > 0.0 && s.is_finite())) {
        return Err(refuse("must be positive and finite".to_owned()));
    }
    Ok(ExprField::from_command_line(text, expr))
}
