//! What a scene calls for.

use std::fmt;

use meshless_interfaces::Obstacle;

use crate::Error;
use crate::build;
use crate::scene::{ConditionSpec, ExprField, InterfaceSpec, RegionSpec, Scene};

/// Order below which powers of the distance from a corner count, where the scene names none: that of the sharp method by default.
const LEAST_ORDER: usize = 4;

/// Exponents of corners from here on leave less than a method of second order does elsewhere.
const SMOOTH: f64 = 1.0;

/// The order of the methods that balance every cell.
const BALANCE_ORDER: usize = 2;

/// Something that a scene has and that costs something.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Effect {
    /// The diffusivity differs between regions; the ratio of the largest to the smallest, as far as sampled.
    DiffusivityJump {
        /// Largest over smallest diffusivity.
        contrast: f64,
    },
    /// The diffusivity varies within a region.
    VariableDiffusivity,
    /// u jumps across an interface.
    ValueJump,
    /// The flux jumps across an interface.
    FluxJump,
    /// u is prescribed on an interface, and the flux jumps by what that takes.
    PrescribedInterface,
    /// There is a source.
    Source,
    /// A velocity with a curl, in free space.
    Vorticity,
    /// A prescribed normal derivative.
    Neumann,
    /// A prescribed flux.
    Flux,
    /// A mixed condition.
    Robin,
    /// Nothing fixes the constant of u.
    PureNeumann,
    /// u changes with time.
    Time,
    /// A factor of du/dt that is not 1.
    Capacity,
    /// A velocity carries u along; the largest Péclet number of a cell `|v| h / eta`, as far as sampled.
    Advection {
        /// The Péclet number.
        peclet: f64,
    },
    /// A term in u itself.
    Reaction,
    /// An interface resists the flux through it, and u differs on its sides.
    ContactResistance,
    /// u over partition coefficients goes on across an interface, and not u.
    Partition,
    /// Interfaces end inside the domain.
    Slits,
    /// The domain has holes.
    Holes,
    /// The boundary is not a box.
    CurvedBoundary,
    /// Surfaces of triangles from files.
    Triangles {
        /// How many.
        count: usize,
        /// How many more had no extent and are left out.
        degenerate: usize,
    },
    /// The spacing depends on position.
    GradedCloud,
    /// Vertices of interfaces and of the boundary, and in space edges, at which the solution is singular.
    Corners {
        /// How many.
        count: usize,
        /// The smallest exponent: `u ~ r^exponent`.
        exponent: f64,
    },
}

impl Effect {
    /// Whether something jumps at an interface.
    pub fn is_at_interface(&self) -> bool {
        matches!(
            self,
            Self::DiffusivityJump { .. }
                | Self::ValueJump
                | Self::FluxJump
                | Self::ContactResistance
                | Self::Partition
        )
    }

    /// The name used in reports.
    pub fn name(&self) -> &'static str {
        match self {
            Self::DiffusivityJump { .. } => "diffusivity jump",
            Self::VariableDiffusivity => "variable diffusivity",
            Self::ValueJump => "value jump",
            Self::FluxJump => "flux jump",
            Self::PrescribedInterface => "prescribed interface",
            Self::Source => "source",
            Self::Vorticity => "vorticity",
            Self::Neumann => "neumann boundary",
            Self::Flux => "flux boundary",
            Self::Robin => "robin boundary",
            Self::PureNeumann => "pure neumann",
            Self::Time => "time",
            Self::Capacity => "capacity",
            Self::Advection { .. } => "advection",
            Self::Reaction => "reaction",
            Self::ContactResistance => "contact resistance",
            Self::Partition => "partition",
            Self::Slits => "slits",
            Self::Holes => "holes",
            Self::CurvedBoundary => "curved boundary",
            Self::Triangles { .. } => "triangulated surface",
            Self::GradedCloud => "graded cloud",
            Self::Corners { .. } => "corners",
        }
    }
}

impl fmt::Display for Effect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::DiffusivityJump { contrast } => write!(f, "{} ({contrast:.3e})", self.name()),
            Self::Advection { peclet } => write!(f, "{} (Péclet number of a cell {peclet:.3e})", self.name()),
            Self::Corners { count, exponent } => write!(f, "{} ({count}, u ~ r^{exponent:.3})", self.name()),
            Self::Triangles { count, degenerate: 0 } => write!(f, "{} ({count} triangles)", self.name()),
            Self::Triangles { count, degenerate } => {
                write!(f, "{} ({count} triangles, {degenerate} without extent left out)", self.name())
            }
            _ => f.write_str(self.name()),
        }
    }
}

/// What was found out about a scene without building anything.
#[derive(Debug, Clone)]
pub(super) struct Survey {
    pub(super) effects: Vec<Effect>,
    /// Whether all regions have one and the same constant diffusivity.
    pub(super) uniform: bool,
    /// Largest over smallest diffusivity, as far as sampled.
    pub(super) contrast: f64,
    /// Whether the sharp method has functions for any of the corners.
    servable: bool,
    /// Whether regions have surfaces of triangles with edges.
    creased: bool,
}

impl Survey {
    pub(super) fn of(scene: &Scene) -> Result<Self, Error> {
        let constants: Vec<Option<f64>> =
            scene.regions.iter().map(|r| r.diffusivity.expr.as_constant()).collect();
        let uniform = constants[0].is_some() && constants.iter().all(|&c| c == constants[0]);
        let contrast = if uniform { 1.0 } else { build::sampled_contrast(&scene.at_time(0.0))? };
        let mut effects = Vec::new();
        let mut note = |present: bool, effect: Effect| {
            if present {
                effects.push(effect);
            }
        };
        note(!uniform && scene.regions.len() > 1, Effect::DiffusivityJump { contrast });
        note(constants.iter().any(Option::is_none), Effect::VariableDiffusivity);
        note(scene.interfaces.iter().any(|i| nonzero(i.jump.as_ref())), Effect::ValueJump);
        let flux_jumps =
            scene.interfaces.iter().any(|i| nonzero(i.flux_jump.as_ref()) || i.flux_jump_at.is_some());
        let prescribed = scene.interfaces.iter().any(|i| i.dirichlet.is_some());
        note(flux_jumps || prescribed, Effect::FluxJump);
        note(prescribed, Effect::PrescribedInterface);
        note(scene.regions.iter().any(|r| nonzero(r.source.as_ref())), Effect::Source);
        let turns = |r: &RegionSpec| r.vorticity.iter().any(|c| nonzero(Some(c)));
        note(scene.regions.iter().any(turns), Effect::Vorticity);
        let any = |test: fn(&ConditionSpec) -> bool| scene.boundaries.iter().any(|b| test(&b.condition));
        note(any(|c| matches!(c, ConditionSpec::Neumann(_))), Effect::Neumann);
        note(any(|c| matches!(c, ConditionSpec::Flux(_))), Effect::Flux);
        note(any(|c| matches!(c, ConditionSpec::Robin { .. })), Effect::Robin);
        let reacts = scene.regions.iter().any(|r| nonzero(r.reaction.as_ref()));
        note(
            !reacts && !any(|c| matches!(c, ConditionSpec::Dirichlet(_) | ConditionSpec::Robin { .. })),
            Effect::PureNeumann,
        );
        note(scene.time.is_some(), Effect::Time);
        let stores = |r: &RegionSpec| r.capacity.as_ref().is_some_and(|c| c.expr.as_constant() != Some(1.0));
        note(scene.time.is_some() && scene.regions.iter().any(stores), Effect::Capacity);
        let moves = |r: &RegionSpec| r.velocity.iter().any(|component| nonzero(Some(component)));
        if scene.regions.iter().any(moves) {
            note(true, Effect::Advection { peclet: build::sampled_peclet(&scene.at_time(0.0))? });
        }
        note(scene.regions.iter().any(|r| nonzero(r.reaction.as_ref())), Effect::Reaction);
        note(scene.interfaces.iter().any(|i| nonzero(i.resistance.as_ref())), Effect::ContactResistance);
        let parts = |i: &InterfaceSpec| i.partition.as_ref().is_some_and(|([a, b], _)| a != b);
        note(scene.interfaces.iter().any(parts), Effect::Partition);
        note(!scene.slits.is_empty(), Effect::Slits);
        note(!scene.holes.is_empty(), Effect::Holes);
        note(build::is_curved(scene), Effect::CurvedBoundary);
        let [count, degenerate] = build::triangle_counts(scene)?;
        note(count > 0, Effect::Triangles { count, degenerate });
        let corners =
            build::singular_corners(&scene.at_time(0.0), scene.method.order.unwrap_or(LEAST_ORDER))?;
        let adapts = scene.points.corners.is_some() && !corners.is_empty();
        note(
            scene.points.spacing.expr.as_constant().is_none() || scene.points.gaps.is_some() || adapts,
            Effect::GradedCloud,
        );
        if let Some(exponent) = corners.iter().map(|corner| corner.exponent).min_by(f64::total_cmp) {
            effects.push(Effect::Corners { count: corners.len(), exponent });
        }
        let servable = corners.iter().any(|corner| corner.obstacle == Some(Obstacle::Method));
        let creased = build::has_creased_regions(scene)?;
        Ok(Self { effects, uniform, contrast, servable, creased })
    }

    pub(super) fn has(&self, test: fn(&Effect) -> bool) -> bool {
        self.effects.iter().any(test)
    }

    /// Whether the equation is that of steady diffusion: functions of corners solve no other, and balances of fits are of no other.
    pub(super) fn is_steady_diffusion(&self, scene: &Scene) -> bool {
        scene.time.is_none() && !self.has(|e| matches!(e, Effect::Advection { .. } | Effect::Reaction))
    }

    /// Whether there are corners that functions can serve: those of steady diffusion in the plane.
    pub(super) fn has_corners(&self, scene: &Scene) -> bool {
        scene.dimension == 2
            && self.is_steady_diffusion(scene)
            && self.has(|e| matches!(e, Effect::Corners { .. }))
    }

    /// Whether the sharp method has functions for some of the corners, or edges in space, of a steady scene.
    pub(super) fn has_corner_functions(&self, scene: &Scene) -> bool {
        self.is_steady_diffusion(scene) && (self.has_corners(scene) || self.servable)
    }

    /// Why fits would lose heat at the interfaces of a scene of no order in particular, so that it takes balances everywhere; `None` where they
    /// do not.
    pub(super) fn needs_balances(&self, scene: &Scene) -> Option<&'static str> {
        let singular = |e: &Effect| matches!(e, Effect::Corners { exponent, .. } if *exponent < SMOOTH);
        let any_order = scene.method.order.is_none_or(|order| order <= BALANCE_ORDER);
        if !any_order || !self.has_interface() || scene.is_labelled() {
            None
        } else if self.creased {
            Some(
                "fits lose heat at edges of interfaces of triangles, for which they have no functions: balances everywhere",
            )
        } else if !self.is_steady_diffusion(scene) && self.has(singular) {
            Some(
                "corners at interfaces lose heat where fits meet them, and have functions of their own in steady diffusion only: \
                 balances everywhere",
            )
        } else if self.has(|e| matches!(e, Effect::ContactResistance | Effect::Partition))
            && self.has(singular)
        {
            Some(
                "corners at which u differs on both sides of an interface have no functions: balances everywhere",
            )
        } else {
            None
        }
    }

    /// Whether anything happens at an interface at all.
    pub(super) fn has_interface(&self) -> bool {
        self.has(Effect::is_at_interface)
    }
}

/// Whether a field is given and is not the constant zero.
pub(super) fn nonzero(field: Option<&ExprField>) -> bool {
    field.is_some_and(|f| f.expr.as_constant() != Some(0.0))
}
