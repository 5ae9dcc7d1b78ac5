//! Boundary conditions of a scene, at nodes and anywhere on the boundary.

use meshless_geometry::{BoundaryNode, Cloud, Domain, FaceId, Touch};
use meshless_interfaces::{BoundaryData, Condition, Field};

use super::fields::{field, not_finite};
use crate::Error;
use crate::scene::{BoundarySpec, ConditionSpec, ExprField, Scene};

/// How far from an edge between pieces of the boundary the data on either are told, in spacings.
const BESIDE: f64 = 1e-5;

/// The same for which condition holds: farther than what a `where` such as `y < 1e-6` allows for rounding.
const ENTRY_BESIDE: f64 = 0.02;

/// How far on both sides of a piece it is looked whether it is one, over the least of what the steps along it come away from the others.
const ACROSS: f64 = 0.1;

/// Other pieces at a node of which each may lie either way: more never meet but in the tips of cones.
const MOST_PIECES: usize = 6;

/// The conditions in the order of the scene: the first whose face and `where` match counts.
pub(crate) struct Boundary<const D: usize> {
    entries: Vec<Entry<D>>,
}

struct Entry<const D: usize> {
    /// `None` for "all".
    face: Option<FaceId>,
    place: Option<Field<D>>,
    kind: Kind<D>,
}

enum Kind<const D: usize> {
    Dirichlet(Field<D>),
    Neumann(Field<D>),
    Flux(Field<D>),
    Robin { a: Field<D>, b: Field<D>, g: Field<D> },
}

impl<const D: usize> Boundary<D> {
    pub(crate) fn new(scene: &Scene, domain: &Domain<D>) -> Self {
        let entries = scene
            .boundaries
            .iter()
            .map(|spec| Entry {
                face: domain.face(&spec.face),
                place: spec.where_.as_ref().map(|w| field(&w.expr)),
                kind: match &spec.condition {
                    ConditionSpec::Dirichlet(e) => Kind::Dirichlet(field(&e.expr)),
                    ConditionSpec::Neumann(e) => Kind::Neumann(field(&e.expr)),
                    ConditionSpec::Flux(e) => Kind::Flux(field(&e.expr)),
                    ConditionSpec::Robin { a, b, g } => {
                        Kind::Robin { a: field(&a.expr), b: field(&b.expr), g: field(&g.expr) }
                    }
                },
            })
            .collect();
        Self { entries }
    }

    /// Which entry of the scene holds on a face at a point.
    pub(crate) fn entry(&self, face: FaceId, x: &[f64; D]) -> Option<usize> {
        self.entries.iter().position(|entry| {
            entry.face.is_none_or(|f| f == face)
                && entry.place.as_ref().is_none_or(|place| holds(place.at(x)))
        })
    }

    /// The `where` of every entry for a face must be a number.
    fn check_places(&self, scene: &Scene, face: FaceId, x: &[f64; D]) -> Result<(), Error> {
        for (entry, spec) in self.entries.iter().zip(&scene.boundaries) {
            if let (Some(place), Some(where_)) = (&entry.place, &spec.where_)
                && entry.face.is_none_or(|f| f == face)
                && place.at(x).is_nan()
            {
                return Err(not_finite(scene, where_, f64::NAN, x));
            }
        }
        Ok(())
    }

    /// Every entry must be the condition of a node, but those that catch what others leave; every hole must have nodes.
    ///
    /// # Errors
    /// What no node hears of: an electrode narrower than the spacing, a part that an entry before covers, a `where` or a hole that
    /// is elsewhere.
    pub(crate) fn check_is_met(
        &self,
        scene: &Scene,
        domain: &Domain<D>,
        cloud: &Cloud<D>,
    ) -> Result<(), Error> {
        let mut met = vec![false; self.entries.len()];
        let mut faces = vec![false; scene.faces().len()];
        for node in cloud.boundary() {
            for touch in &node.touches {
                faces[touch.face.0 as usize] = true;
                if let Some(index) =
                    self.entry(touch.face, &beside_edges(domain, cloud, node, touch, ENTRY_BESIDE))
                {
                    met[index] = true;
                }
            }
        }
        let outer = faces.len() - scene.holes.len();
        if let Some(hole) = scene.holes.iter().zip(&faces[outer..]).find_map(|(h, &met)| (!met).then_some(h))
        {
            let message = format!("no node lies on the surface of the hole \"{}\"", hole.name);
            let help = "it is outside of the domain, or smaller than the spacing: remove it, move it, or use a smaller \
                        spacing";
            return Err(Error::TooCoarse(Box::new(hole.place.error(message, help))));
        }
        let catches = |spec: &BoundarySpec| spec.face == "all" && spec.where_.is_none();
        let idle = scene.boundaries.iter().zip(&met).find(|&(spec, &met)| !met && !catches(spec));
        let Some((spec, _)) = idle else { return Ok(()) };
        let message = "no boundary node gets this condition";
        let help = "the entries before it cover all of it, its `where` is nowhere true, or it is narrower than the \
                    spacing: put it first, correct it, or use a smaller spacing there";
        Err(Error::TooCoarse(Box::new(spec.place.error(message, help))))
    }

    /// What an entry of the scene says at a point.
    pub(crate) fn of_entry(&self, index: usize, x: &[f64; D]) -> Condition {
        self.entries[index].kind.at(x)
    }

    /// The conditions of every boundary node, one for each of its faces, checked.
    pub(crate) fn at_nodes(
        &self,
        scene: &Scene,
        domain: &Domain<D>,
        cloud: &Cloud<D>,
    ) -> Result<Vec<Vec<Condition>>, Error> {
        let mut all = Vec::with_capacity(cloud.boundary().len());
        for node in cloud.boundary() {
            let x = &cloud.points()[node.node as usize];
            let mut conditions = Vec::with_capacity(node.touches.len());
            for touch in &node.touches {
                let told = &beside_edges(domain, cloud, node, touch, ENTRY_BESIDE);
                let place = &beside_edges(domain, cloud, node, touch, BESIDE);
                self.check_places(scene, touch.face, told)?;
                let index = self
                    .entry(touch.face, told)
                    .or_else(|| self.entry(touch.face, place))
                    .ok_or_else(|| missing_condition(scene, cloud, node.node as usize, x))?;
                let condition = self.entries[index].kind.beside(x, place);
                check(scene, &scene.boundaries[index], &condition, x)?;
                conditions.push(condition);
            }
            all.push(conditions);
        }
        Ok(all)
    }
}

/// Where a node is, as its place on one of several pieces of the boundary is told: a little away from the edge between them. A
/// `where` that holds on the one piece alone, or data that jump at the edge, then say nothing of the others. A piece goes on against the
/// normal of another one, at a re-entrant edge along it.
fn beside_edges<const D: usize>(
    domain: &Domain<D>,
    cloud: &Cloud<D>,
    node: &BoundaryNode<D>,
    touch: &Touch<D>,
    distance: f64,
) -> [f64; D] {
    let i = node.node as usize;
    let at = cloud.points()[i];
    let reach = distance * cloud.spacing()[i];
    let others = node.touches.iter().filter(|other| other.normal != touch.normal);
    let steps: Vec<[f64; D]> = others
        .map(|other| {
            let along: f64 = (0..D).map(|k| other.normal[k] * touch.normal[k]).sum();
            std::array::from_fn(|k| -reach * (other.normal[k] - along * touch.normal[k]))
        })
        .collect();
    if steps.is_empty() {
        return at;
    }
    let shortest = steps.iter().map(|s| s.iter().map(|s| s * s).sum::<f64>()).fold(f64::INFINITY, f64::min);
    let depth = ACROSS * shortest / reach;
    let place = |signs: usize| {
        let mut x = at;
        for (which, step) in steps.iter().enumerate() {
            let sign = if (signs >> which) & 1 == 0 { 1.0 } else { -1.0 };
            x.iter_mut().zip(step).for_each(|(x, s)| *x += sign * s);
        }
        x
    };
    let is_on_piece = |x: &[f64; D]| {
        let inside = |t: f64| domain.contains(&std::array::from_fn(|k| x[k] + t * touch.normal[k]), 0.0);
        inside(-depth) && !inside(depth)
    };
    let most = 1 << steps.len().min(MOST_PIECES);
    let x = (0..most).map(place).find(is_on_piece).unwrap_or_else(|| place(0));
    // Curved pieces do not go on along their tangents.
    let foot = domain.project_to_face(touch.face, &x).ok().filter(|foot| foot.distance.abs() <= reach);
    foot.map_or(x, |foot| foot.point)
}

impl<const D: usize> BoundaryData<D> for Boundary<D> {
    fn condition(&self, face: FaceId, point: &[f64; D]) -> Option<Condition> {
        self.entry(face, point).map(|index| self.entries[index].kind.at(point))
    }
}

impl<const D: usize> Kind<D> {
    fn at(&self, x: &[f64; D]) -> Condition {
        self.with(|f| f.at(x))
    }

    /// What holds at an edge, told at a place `beside` it on one piece of the boundary: fluxes, which have as many values there as
    /// pieces meet, are continued linearly from that piece to the edge.
    fn beside(&self, x: &[f64; D], beside: &[f64; D]) -> Condition {
        if x == beside || matches!(self, Self::Dirichlet(_)) {
            return self.at(x);
        }
        let further = std::array::from_fn(|k| 2.0 * beside[k] - x[k]);
        self.with(|f| 2.0 * f.at(beside) - f.at(&further))
    }

    fn with(&self, value: impl Fn(&Field<D>) -> f64) -> Condition {
        match self {
            Self::Dirichlet(f) => Condition::Dirichlet(value(f)),
            Self::Neumann(f) => Condition::Neumann(value(f)),
            Self::Flux(f) => Condition::Flux(value(f)),
            Self::Robin { a, b, g } => Condition::Robin { a: value(a), b: value(b), g: value(g) },
        }
    }
}

/// Whether a `where` that has this value matches; one that is not a number does not.
fn holds(value: f64) -> bool {
    value.is_finite() && value != 0.0
}

/// Values must be finite, and a Robin condition must have a flux term and not feed the field.
fn check<const D: usize>(
    scene: &Scene,
    spec: &BoundarySpec,
    condition: &Condition,
    x: &[f64; D],
) -> Result<(), Error> {
    let finite = |value: f64, spec: &ExprField| {
        if value.is_finite() { Ok(()) } else { Err(not_finite(scene, spec, value, x)) }
    };
    match (condition, &spec.condition) {
        (Condition::Dirichlet(v), ConditionSpec::Dirichlet(e))
        | (Condition::Neumann(v), ConditionSpec::Neumann(e))
        | (Condition::Flux(v), ConditionSpec::Flux(e)) => finite(*v, e),
        (&Condition::Robin { a, b, g }, ConditionSpec::Robin { a: a_spec, b: b_spec, g: g_spec }) => {
            finite(a, a_spec)?;
            finite(b, b_spec)?;
            finite(g, g_spec)?;
            if b == 0.0 {
                let message = format!("b vanishes at {x:?}, so the condition has no flux term");
                return Err(scene.error_at(b_spec, message, "prescribe u with `dirichlet` there").into());
            }
            if a / b < 0.0 {
                let message = format!(
                    "a/b is negative at {x:?}: such a boundary feeds the field and has no unique solution in general"
                );
                return Err(scene
                    .error_at(a_spec, message, "a and b of `a u + b eta du/dn = g` must have the same sign")
                    .into());
            }
            Ok(())
        }
        _ => Ok(()),
    }
}

/// A boundary node for which no entry of the scene matches.
pub(crate) fn missing_condition<const D: usize>(
    scene: &Scene,
    cloud: &Cloud<D>,
    node: usize,
    x: &[f64],
) -> Error {
    let names = scene.faces();
    let touches = cloud.boundary_of(node).map_or(&[][..], |b| &b.touches);
    let faces: Vec<&str> = touches.iter().filter_map(|t| names.get(t.face.0 as usize).copied()).collect();
    // Adding zero turns -0.0 into 0.0.
    let place: Vec<f64> = x.iter().map(|c| c + 0.0).collect();
    let message = format!("no boundary condition holds at {place:?} (face {})", faces.join(", "));
    scene
        .error_at_boundaries(
            message,
            "add a [[boundaries]] entry for that face, or one with face = \"all\" at the end",
        )
        .into()
}
