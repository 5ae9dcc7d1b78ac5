//! What a scene calls for.

use std::fmt;

use meshless_interfaces::Obstacle;

use crate::Error;
use crate::build;
use crate::scene::{ConditionSpec, ExprField, RegionSpec, Scene};

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
        matches!(self, Self::DiffusivityJump { .. } | Self::ValueJump | Self::FluxJump)
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
        note(
            !any(|c| matches!(c, ConditionSpec::Dirichlet(_) | ConditionSpec::Robin { .. })),
            Effect::PureNeumann,
        );
        note(scene.time.is_some(), Effect::Time);
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

    /// Whether there are corners that functions can serve: those of a steady scene in the plane.
    pub(super) fn has_corners(&self, scene: &Scene) -> bool {
        scene.dimension == 2 && scene.time.is_none() && self.has(|e| matches!(e, Effect::Corners { .. }))
    }

    /// Whether the sharp method has functions for some of the corners, or edges in space, of a steady scene.
    pub(super) fn has_corner_functions(&self, scene: &Scene) -> bool {
        scene.time.is_none() && (self.has_corners(scene) || self.servable)
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
        } else if scene.time.is_some() && self.has(singular) {
            Some(
                "corners at interfaces lose heat where fits meet them, and have functions of their own in steady scenes only: \
                 balances everywhere",
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
