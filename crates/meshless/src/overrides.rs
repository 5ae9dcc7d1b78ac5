//! What the command line changes in a scene.

use thiserror::Error;

use crate::scene::{AccuracySpec, ExprField, MethodName, Scene, SceneError};

/// Values that take the place of the scene's.
#[derive(Debug, Clone, Copy, Default)]
pub struct Overrides<'a> {
    /// Name of the method.
    pub method: Option<&'a str>,
    /// Polynomial degree of the stencils.
    pub order: Option<usize>,
    /// Spacing: a number or an expression of position.
    pub spacing: Option<&'a str>,
    /// Relative L2 error to reach.
    pub tolerance: Option<f64>,
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
    #[error("--order {order}: the orders of this method are 2 to {highest}")]
    Order {
        /// What was given.
        order: usize,
        /// The highest order that the method has.
        highest: usize,
    },
    /// Not a spacing, or not a tolerance.
    #[error(transparent)]
    Value(#[from] SceneError),
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
            let highest = match scene.method.name {
                MethodName::Sharp => 16,
                MethodName::FreeSpace => 20,
                _ => 8,
            };
            if !(2..=highest).contains(&order) {
                return Err(OverrideError::Order { order, highest });
            }
            scene.method.order = Some(order);
        }
        if let Some(text) = self.spacing {
            if let Some(file) = &scene.points.file {
                let help = "leave the option out; a `spacing` beside `file` in the scene says how far apart they are";
                return Err(file.place.error("the points come from a file", help).into());
            }
            scene.points.spacing = ExprField::from_command_line("--spacing", text, scene.dimension)?;
        }
        if let (Some(_), Some(file)) = (self.tolerance, &scene.points.file) {
            let help = "leave `--tolerance` out; the report has an estimate of the error";
            return Err(file.place.error("points from a file cannot be refined", help).into());
        }
        if let Some(tolerance) = self.tolerance {
            let spec = AccuracySpec::from_command_line(tolerance, scene.dimension, scene.accuracy.as_ref())?;
            scene.accuracy = Some(spec);
        }
        Ok(())
    }
}
