//! All expressions of a scene, in one list: whoever has to see each of them – scenes in time, for one – walks it.

use super::Scene;
use super::expression::ExprField;
use super::spec::{ConditionSpec, SlitConditionSpec};

/// What an expression decides.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Role {
    /// The matrix of the linear system.
    Matrix,
    /// Its right-hand side only.
    Data,
    /// Nothing: it is compared with the solution.
    Exact,
}

/// The walk over the expressions of a scene and over those of a condition, once for references and once for mutable ones.
macro_rules! walk {
    ($all:ident, $of_condition:ident, $($mutable:tt)?) => {
        /// Calls `visit` with every expression that may change with time, in a fixed order.
        pub(crate) fn $all<'a>(
            scene: &'a $($mutable)? Scene,
            visit: &mut dyn FnMut(Role, &'a $($mutable)? ExprField),
        ) {
            for region in & $($mutable)? scene.regions {
                visit(Role::Matrix, & $($mutable)? region.diffusivity);
                if let Some(field) = & $($mutable)? region.capacity {
                    visit(Role::Matrix, field);
                }
                for field in & $($mutable)? region.velocity {
                    visit(Role::Matrix, field);
                }
                if let Some(field) = & $($mutable)? region.reaction {
                    visit(Role::Matrix, field);
                }
                if let Some(field) = & $($mutable)? region.source {
                    visit(Role::Data, field);
                }
                if let Some(field) = & $($mutable)? region.exact {
                    visit(Role::Exact, field);
                }
            }
            for interface in & $($mutable)? scene.interfaces {
                if let Some(field) = & $($mutable)? interface.jump {
                    visit(Role::Data, field);
                }
                if let Some(field) = & $($mutable)? interface.flux_jump {
                    visit(Role::Data, field);
                }
            }
            for slit in & $($mutable)? scene.slits {
                match & $($mutable)? slit.condition {
                    SlitConditionSpec::Jump { jump, flux_jump } => {
                        for field in [jump, flux_jump].into_iter().flatten() {
                            visit(Role::Data, field);
                        }
                    }
                    SlitConditionSpec::OnEachSide(condition) => $of_condition(condition, visit),
                }
            }
            for boundary in & $($mutable)? scene.boundaries {
                $of_condition(& $($mutable)? boundary.condition, visit);
            }
        }

        fn $of_condition<'a>(
            condition: &'a $($mutable)? ConditionSpec,
            visit: &mut dyn FnMut(Role, &'a $($mutable)? ExprField),
        ) {
            match condition {
                ConditionSpec::Dirichlet(field) | ConditionSpec::Neumann(field) | ConditionSpec::Flux(field) => {
                    visit(Role::Data, field);
                }
                ConditionSpec::Robin { a, b, g } => {
                    visit(Role::Matrix, a);
                    visit(Role::Matrix, b);
                    visit(Role::Data, g);
                }
            }
        }
    };
}

walk!(each, of_condition,);
walk!(each_mut, of_condition_mut, mut);
