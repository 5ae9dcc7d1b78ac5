//! Shapes, domain, regions and spacing of a scene.

use std::sync::Arc;

use meshless_expr::Expr;
use meshless_geometry::{Aabb, Domain, GeometryError, Layout, LevelSet, RegionMap, Shape, Spacing};

use super::surfaces::surface;
use crate::Error;
use crate::scene::{BoundsSpec, DomainSpec, ExprField, GapSpec, LayoutName, Place, Scene, ShapeSpec};

/// Places along each axis at which a level set is tried, in the middles of as many cells but for this: singular points, where it
/// does not matter, have round coordinates.
const LEVELS_PER_AXIS: [usize; 3] = [4096, 64, 16];
const OFF_MIDDLE: f64 = 0.5137;

/// A level set with the derivatives of its expression.
struct ExprLevelSet<const D: usize> {
    value: Expr,
    partials: [Expr; D],
}

impl<const D: usize> LevelSet<D> for ExprLevelSet<D> {
    fn value(&self, x: &[f64; D]) -> f64 {
        self.value.eval(x)
    }

    fn gradient(&self, x: &[f64; D]) -> [f64; D] {
        std::array::from_fn(|k| self.partials[k].eval(x))
    }
}

/// The domain with its holes.
pub(crate) fn domain<const D: usize>(scene: &Scene) -> Result<Domain<D>, Error> {
    let DomainSpec { shape: spec, bounds, place } = &scene.domain;
    let bounds = bounds.as_ref().map(aabb).transpose().map_err(|e| located(place, e))?;
    let outer = shape::<D>(spec, place)?;
    if let Some(bounds) = &bounds {
        check_level(spec, &outer, bounds, &|_| true, place)?;
    }
    let mut domain = Domain::from_shape(outer, bounds).map_err(|e| located(place, e))?;
    for hole in &scene.holes {
        let cut = shape::<D>(&hole.shape, &hole.place)?;
        check_level(&hole.shape, &cut, &domain.bounds(), &|x| domain.contains(x, 0.0), &hole.place)?;
        domain = domain.with_hole(&hole.name, cut).map_err(|e| located(&hole.place, e))?;
    }
    Ok(domain)
}

/// The regions, in the order of the scene.
pub(crate) fn regions<const D: usize>(scene: &Scene) -> Result<RegionMap<D>, Error> {
    let shapes = scene
        .regions
        .iter()
        .map(|r| r.geometry.as_ref().map(|s| shape::<D>(s, &r.place)).transpose())
        .collect::<Result<Vec<_>, _>>()?;
    RegionMap::new(shapes).map_err(|e| located(&scene.regions[0].place, e))
}

/// Whether the level sets of the regions are numbers in the domain.
pub(super) fn check_level_sets<const D: usize>(scene: &Scene, domain: &Domain<D>) -> Result<(), Error> {
    for region in &scene.regions {
        if let Some(spec) = region.geometry.as_ref().filter(|spec| has_level_set(spec)) {
            let made = shape::<D>(spec, &region.place)?;
            check_level(spec, &made, &domain.bounds(), &|x| domain.contains(x, 0.0), &region.place)?;
        }
    }
    Ok(())
}

/// A level that is no number at a place would leave the place out without a word.
fn check_level<const D: usize>(
    spec: &ShapeSpec,
    shape: &Shape<D>,
    bounds: &Aabb<D>,
    counts: &dyn Fn(&[f64; D]) -> bool,
    place: &Place,
) -> Result<(), Error> {
    if !has_level_set(spec) {
        return Ok(());
    }
    let (count, lengths) = (LEVELS_PER_AXIS[D - 1], bounds.lengths());
    let at = |index: usize| -> [f64; D] {
        std::array::from_fn(|k| {
            let along = ((index / count.pow(k as u32)) % count) as f64 + OFF_MIDDLE;
            bounds.min[k] + lengths[k] * along / count as f64
        })
    };
    let bad = |x: &[f64; D]| shape.level(x).is_nan() && counts(x);
    let Some(x) = (0..count.pow(D as u32)).map(at).find(bad) else { return Ok(()) };
    let place = if let ShapeSpec::LevelSet(field) = spec { &field.place } else { place };
    let help =
        "a level set must be a number wherever it is evaluated; `if(c, a, b)` guards a root or a logarithm";
    Err(place.error(format!("the level set gives NaN at {x:?}"), help).into())
}

fn has_level_set(spec: &ShapeSpec) -> bool {
    match spec {
        ShapeSpec::LevelSet(_) => true,
        ShapeSpec::Union(parts) | ShapeSpec::Intersection(parts) | ShapeSpec::Difference(parts) => {
            parts.iter().any(has_level_set)
        }
        _ => false,
    }
}

/// The spacing of the cloud.
pub(crate) fn spacing<const D: usize>(scene: &Scene) -> Spacing<D> {
    let expr = &scene.points.spacing.expr;
    match expr.as_constant() {
        Some(spacing) => Spacing::Uniform(spacing),
        None => {
            let expr = expr.clone();
            Spacing::Graded(Arc::new(move |x: &[f64; D]| expr.eval(x)))
        }
    }
}

/// The layout of the cloud.
pub(crate) fn layout(scene: &Scene) -> Layout {
    match scene.points.layout {
        LayoutName::Grid => Layout::Grid,
        LayoutName::Jittered => Layout::Jittered,
        LayoutName::Scattered => Layout::Scattered,
        LayoutName::Irregular => Layout::Irregular,
    }
}

/// An error of the generation of a cloud, at the spacing that asked for it.
pub(crate) fn explain_cloud(scene: &Scene, error: GeometryError) -> Error {
    match error {
        GeometryError::InvalidSpacing { .. }
        | GeometryError::VanishingSpacing { .. }
        | GeometryError::TooManyNodes { .. }
        | GeometryError::GradedLattice { .. } => {
            scene.error_at(&scene.points.spacing, error.to_string(), "").into()
        }
        GeometryError::SpacingTooLarge { .. } => {
            Error::TooCoarse(Box::new(scene.error_at(&scene.points.spacing, error.to_string(), "")))
        }
        error => located(&scene.domain.place, error),
    }
}

/// The same scene with the spacing multiplied.
pub(crate) fn with_spacing_times(scene: &Scene, factor: f64) -> Scene {
    let mut coarse = scene.clone();
    if let Some(file) = &mut coarse.points.file {
        // The points that are left are as far apart as they are.
        file.thin *= factor;
        return coarse;
    }
    if let Some(gaps) = &mut coarse.points.gaps {
        // What goes on in gaps is to be seen at both spacings.
        *gaps = GapSpec { least: factor * gaps.least, across: gaps.across / factor };
    }
    if let Some(corners) = &mut coarse.points.corners {
        corners.across /= factor;
    }
    coarse.points.adapted.times *= factor;
    coarse.points.adapted.wanted_times *= factor;
    let ExprField { text, expr, .. } = &scene.points.spacing;
    let variables = &["x", "y", "z"][..scene.dimension];
    coarse.points.spacing.expr = match expr.as_constant() {
        Some(spacing) => Expr::constant(spacing * factor),
        // Text that has parsed once parses within parentheses, too.
        None => Expr::parse(&format!("{factor}*({text})"), variables).unwrap_or_else(|_| expr.clone()),
    };
    coarse
}

fn located(place: &Place, error: GeometryError) -> Error {
    place.error(error.to_string(), "").into()
}

fn vector<const D: usize>(values: &[f64]) -> [f64; D] {
    // The reader has checked the length.
    std::array::from_fn(|k| values[k])
}

fn aabb<const D: usize>(spec: &BoundsSpec) -> Result<Aabb<D>, GeometryError> {
    Aabb::new(vector(&spec.min), vector(&spec.max))
}

/// A shape of the table at `place`.
fn shape<const D: usize>(spec: &ShapeSpec, place: &Place) -> Result<Shape<D>, Error> {
    let all = |parts: &[ShapeSpec]| parts.iter().map(|s| shape::<D>(s, place)).collect::<Result<Vec<_>, _>>();
    let made = match spec {
        ShapeSpec::Box(bounds) => Shape::cuboid(vector(&bounds.min), vector(&bounds.max)),
        ShapeSpec::Sphere { center, radius } => Shape::ball(vector(center), *radius),
        ShapeSpec::Cylinder { point, axis, radius, length } => {
            Shape::cylinder(vector(point), vector(axis), *radius, *length)
        }
        ShapeSpec::Polygon(vertices) => Shape::polygon(vertices.iter().map(|v| vector(v)).collect()),
        ShapeSpec::Surface(spec) => Shape::surface(surface(spec)?),
        ShapeSpec::HalfSpace { point, normal } => Shape::half_space(vector(point), vector(normal)),
        ShapeSpec::LevelSet(field) => Ok(Shape::level_set(Arc::new(ExprLevelSet::<D> {
            value: field.expr.clone(),
            partials: std::array::from_fn(|k| field.expr.derivative(k)),
        }))),
        ShapeSpec::Union(parts) => Shape::union(all(parts)?),
        ShapeSpec::Intersection(parts) => Shape::intersection(all(parts)?),
        ShapeSpec::Difference(parts) => {
            let mut parts = all(parts)?.into_iter();
            // The reader has checked that there is a first.
            let first = parts.next().map_or_else(|| Shape::union(Vec::new()), Ok);
            first.map(|first| parts.fold(first, Shape::difference))
        }
    };
    made.map_err(|e| located(place, e))
}
