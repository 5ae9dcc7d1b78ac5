//! What the command line changes in a scene.

use thiserror::Error;

use crate::scene::{ExprField, MethodName, Scene, SceneError};

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
    #[error(transparent)]
    Spacing(#[from] SceneError),
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
            scene.points.spacing = ExprField::from_command_line("--spacing", text, scene.dimension)?;
        }
        Ok(())
    }
}
