use rayon::prelude::*;

use super::RegionMap;
use crate::cloud::{Cloud, Size, Sizes};
use crate::domain::Domain;
use crate::projection::Projection;
use crate::vector::{axpy, dot, norm, normalized};

/// How far beside an interface the regions on its two sides are read, in spacings.
pub(super) const BESIDE: f64 = 1e-5;

/// Thickness in spacings below which a strip along the boundary of the domain is none: a surface that runs along it.
const ALONG: f64 = 3.0 * BESIDE;

/// Steps in which the end of a layer is looked for, in spacings, and how often the last one is halved.
const STEP: f64 = 0.05;
const HALVINGS: usize = 16;

/// Thickness in spacings below which two interfaces touch.
pub(super) const CONTACT: f64 = 1e-4;

/// Steps towards where a layer is thinnest or thickest, how often each is halved until it is thinner or thicker there, and by
/// how much it must be. Towards a contact of smooth surfaces the thickness falls to a quarter by each, in a wedge to a half.
const DESCENTS: usize = 18;
const HALVED_STEPS: usize = 4;
const THINNER: f64 = 0.9;

/// The least step towards where it is thicker, in spacings.
const LEAST_STEP: f64 = 0.5;

/// Slope of the thickness that counts as none.
const LEVEL: f64 = 1e-3;

/// Least cosine of the angle between a way through a layer and the normal where it ends: beyond, two interfaces meet, and
/// no spacing resolves the tip between them.
const FACING: f64 = 0.8;

/// How much farther than its level says a surface may be: a level set need not be a distance.
const SLACK: f64 = 4.0;

/// Where a region is thin: between two interfaces that face each other, or between one and the boundary of the domain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThinLayer<const D: usize> {
    /// The middle of the shortest way through it, from the interface point nearest to a node.
    pub at: [f64; D],
    /// The length of this way.
    pub thickness: f64,
    /// The cloud's spacing there.
    pub spacing: f64,
    /// The region.
    pub region: u16,
}

impl<const D: usize> RegionMap<D> {
    /// Where regions are thinner than `least` spacings of the cloud, as seen from every node that an interface is as near
    /// to: layers, gaps and small inclusions, whether a node lies in them or not, also along the boundary of the domain. Tips
    /// where interfaces meet each other or the boundary at an angle, or touch, are not among them.
    pub fn thin_layers(&self, cloud: &Cloud<D>, domain: &Domain<D>, least: f64) -> Vec<ThinLayer<D>> {
        if self.len() == 1 {
            return Vec::new();
        }
        let at = |i: usize| self.thin_near(&cloud.points()[i], cloud.spacing()[i], domain, least);
        let mut layers: Vec<ThinLayer<D>> = (0..cloud.len()).into_par_iter().flat_map_iter(at).collect();
        let uniform = cloud.spacing().windows(2).all(|pair| pair[0] == pair[1]);
        if !layers.is_empty() && !uniform {
            // What is thin beside a node of a coarser part may be resolved by those that are nearer to it.
            let nodes = Sizes::new(
                cloud.points().iter().zip(cloud.spacing()).map(|(x, s)| Size::at(*x, *s)).collect(),
            );
            layers.retain_mut(|layer| {
                layer.spacing = nodes.nearest(&layer.at).map_or(layer.spacing, |size| size.spacing);
                layer.thickness < least * layer.spacing
            });
        }
        layers
    }

    pub(super) fn thin_near(
        &self,
        x: &[f64; D],
        spacing: f64,
        domain: &Domain<D>,
        least: f64,
    ) -> Vec<ThinLayer<D>> {
        let ways = self.ways_near(x, spacing, domain, least).into_iter();
        let layers = ways.filter(|(across, way)| !self.is_in_a_tip(across, way));
        layers
            .map(|(_, way)| ThinLayer {
                at: way.middle(),
                thickness: way.length,
                spacing,
                region: way.region,
            })
            .collect()
    }

    /// The ways through what is thin near a point, layers and tips.
    pub(super) fn ways_near<'a>(
        &self,
        x: &[f64; D],
        spacing: f64,
        domain: &'a Domain<D>,
        least: f64,
    ) -> Vec<(Across<'a, D>, Way<D>)> {
        let reach = least * spacing;
        let mut found = Vec::new();
        for label in 0..self.len() as u16 - 1 {
            let Some(shape) = self.shape(label) else { continue };
            if shape.level(x).abs() > SLACK * reach * norm(&shape.gradient(x)) {
                continue;
            }
            let Ok(foot) = shape.project(x, reach) else { continue };
            for sign in [-1.0, 1.0] {
                let across = Across { domain, surface: label, sign, spacing, least };
                let way = self.way(&across, &foot);
                found.extend(way.map(|way| (across, way)));
            }
        }
        found
    }

    /// The way through the layer that begins at a point of an interface.
    fn way(&self, across: &Across<'_, D>, foot: &Projection<D>) -> Option<Way<D>> {
        let direction = foot.normal.map(|n| across.sign * n);
        let at = |t: f64| axpy(&foot.point, t * across.spacing, &direction);
        // Nothing outside of the domain; what runs along its boundary is in it.
        let label = |t: f64| {
            let inside = across.domain.contains(&at(t), BESIDE * across.spacing);
            inside.then(|| self.label(&at(t), 0.0))
        };
        let region = label(BESIDE)?;
        // Along the boundary of the domain there is nothing on the far side but what rounding allows for.
        if label(-BESIDE).is_none_or(|other| other == region) || label(ALONG).is_none() {
            return None;
        }
        let steps = (across.least / STEP).ceil() as usize;
        let end = (1..=steps).map(|k| k as f64 * STEP).find(|&t| label(t) != Some(region))?;
        let (mut low, mut high) = ((end - STEP).max(BESIDE), end);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            *(if label(middle) == Some(region) { &mut low } else { &mut high }) = middle;
        }
        let far = at(high);
        let facing = match label(high) {
            Some(beyond) => self.project(region, beyond, &far, STEP * across.spacing).ok()?.normal,
            None => normalized(&across.domain.gradient(&far))?,
        };
        let length = high * across.spacing;
        (dot(&facing, &direction) >= FACING).then_some(Way {
            from: foot.point,
            direction,
            length,
            facing,
            region,
        })
    }

    /// Whether a way leads through a tip: thinner and thinner to one side until the two surfaces touch, where no spacing resolves
    /// what is between them, and to the other side as thick as is asked for.
    fn is_in_a_tip(&self, across: &Across<'_, D>, way: &Way<D>) -> bool {
        self.contact(across, way).is_some() && self.grows_thick(across, way)
    }

    /// The way beside where the two surfaces touch, to which ways that are thinner and thinner lead.
    pub(super) fn contact(&self, across: &Across<'_, D>, way: &Way<D>) -> Option<Way<D>> {
        let mut thin = *way;
        (0..DESCENTS).find_map(|_| {
            thin = self.thinner(across, &thin).unwrap_or(thin);
            (thin.length < CONTACT * across.spacing).then_some(thin)
        })
    }

    /// Whether a layer is as thick as is asked for where the way to where it is thicker leads.
    pub(super) fn grows_thick(&self, across: &Across<'_, D>, way: &Way<D>) -> bool {
        let Some(shape) = self.shape(across.surface) else { return false };
        let mut way = *way;
        for _ in 0..DESCENTS {
            let (slope, towards) = (way.slope(), way.thinner());
            let touches = way.length < CONTACT * across.spacing;
            if slope < LEVEL && !touches {
                return false;
            }
            let step =
                (way.length / slope).clamp(across.spacing * LEAST_STEP, 2.0 * across.least * across.spacing);
            let Some(direction) = normalized(&towards) else { return touches };
            let mut thicker = None;
            for halvings in 0..HALVED_STEPS {
                let x = axpy(&way.from, -step * 0.5_f64.powi(halvings as i32), &direction);
                let foot = shape.project(&x, 2.0 * across.least * across.spacing);
                let Some(next) = foot.ok().and_then(|foot| self.way(across, &foot)) else { return true };
                if next.length * THINNER > way.length {
                    thicker = Some(next);
                    break;
                }
            }
            let Some(next) = thicker else { return false };
            way = next;
        }
        false
    }

    /// A way where the layer is clearly thinner; `None` where it is not, or no layer any more.
    fn thinner(&self, across: &Across<'_, D>, way: &Way<D>) -> Option<Way<D>> {
        let shape = self.shape(across.surface)?;
        let (slope, direction) = (way.slope(), normalized(&way.thinner())?);
        if slope < LEVEL {
            return None;
        }
        let step = (way.length / slope).min(across.least * across.spacing);
        (0..HALVED_STEPS).find_map(|halvings| {
            let x = axpy(&way.from, step * 0.5_f64.powi(halvings as i32), &direction);
            let foot = shape.project(&x, across.least * across.spacing).ok()?;
            self.way(across, &foot).filter(|next| next.length < THINNER * way.length)
        })
    }
}

/// From which side of which surface a layer is looked through, and how far.
#[derive(Clone, Copy)]
pub(super) struct Across<'a, const D: usize> {
    pub(super) domain: &'a Domain<D>,
    surface: u16,
    /// 1 along the normal of the surface, -1 against it.
    sign: f64,
    pub(super) spacing: f64,
    /// In spacings.
    least: f64,
}

/// A way through a layer.
#[derive(Clone, Copy)]
pub(super) struct Way<const D: usize> {
    pub(super) from: [f64; D],
    pub(super) direction: [f64; D],
    pub(super) length: f64,
    /// The normal out of the layer where it ends.
    facing: [f64; D],
    /// What the layer is of.
    pub(super) region: u16,
}

impl<const D: usize> Way<D> {
    pub(super) fn middle(&self) -> [f64; D] {
        axpy(&self.from, 0.5 * self.length, &self.direction)
    }

    /// Where to the layer grows thinner, if its far side is a plane.
    fn thinner(&self) -> [f64; D] {
        axpy(&self.facing, -dot(&self.facing, &self.direction), &self.direction)
    }

    /// By how much it does on the way there, over the length of that way.
    pub(super) fn slope(&self) -> f64 {
        norm(&self.thinner()) / dot(&self.facing, &self.direction)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cloud::{CloudParams, Layout, Spacing, generate};
    use crate::shape::Shape;

    fn layers(shapes: Vec<Shape<2>>, spacing: f64) -> Vec<ThinLayer<2>> {
        let domain = Domain::boxed([-1.0, -1.0], [1.0, 1.0]).expect("a box");
        let params = CloudParams {
            spacing: Spacing::Uniform(spacing),
            layout: Layout::Irregular,
            seed: 1,
            max_nodes: 10_000,
        };
        let cloud = generate(&domain, &params).expect("a cloud");
        let shapes = shapes.into_iter().map(Some).chain([None]).collect();
        RegionMap::new(shapes).expect("regions").thin_layers(&cloud, &domain, 2.0)
    }

    #[test]
    fn films_and_gaps_are_found_whether_nodes_lie_in_them_or_not() {
        let disc = |x: f64, r: f64| Shape::ball([x, 0.0], r).expect("a disc");
        for thickness in [0.001, 0.01, 0.06] {
            let film = layers(vec![disc(0.0, 0.5), disc(0.0, 0.5 + thickness)], 0.05);
            assert!(film.len() > 50, "{thickness}: {}", film.len());
            for layer in &film {
                assert_eq!(layer.region, 1);
                assert!((layer.thickness - thickness).abs() < 5e-4, "{thickness}: {layer:?}");
                assert!((layer.at[0].hypot(layer.at[1]) - 0.5 - 0.5 * thickness).abs() < 5e-4, "{layer:?}");
            }
        }
        let gap = layers(vec![disc(-0.31, 0.3), disc(0.31, 0.3)], 0.05);
        let least = gap.iter().map(|l| l.thickness).fold(f64::INFINITY, f64::min);
        assert!((0.0199..0.025).contains(&least) && gap.iter().all(|l| l.region == 2), "{least}");
        assert!(layers(vec![disc(-0.4, 0.3), disc(0.4, 0.3)], 0.05).is_empty());
    }

    #[test]
    fn where_shapes_touch_there_is_no_layer() {
        let disc = |x: f64, r: f64| Shape::ball([x, 0.0], r).expect("a disc");
        assert_eq!(layers(vec![disc(-0.3, 0.3), disc(0.3, 0.3)], 0.05), Vec::new());
        // One within the other, touching from inside.
        assert_eq!(layers(vec![disc(-0.1, 0.5), disc(0.0, 0.6)], 0.05), Vec::new());
        // A gap of a thousandth of a spacing is one.
        let gap = layers(vec![disc(-0.300_025, 0.3), disc(0.300_025, 0.3)], 0.05);
        assert!(gap.len() > 5 && gap.iter().all(|l| l.region == 2 && l.thickness > 4.9e-5), "{gap:?}");
        // A lens that is thin everywhere is one, whose tips alone are thin is none.
        let lens = |distance: f64| {
            let disc = |x: f64| Shape::ball([x, 0.0], 0.5).expect("a disc");
            layers(vec![Shape::Intersection(vec![disc(-distance), disc(distance)])], 0.05)
        };
        assert!(lens(0.46).len() > 5, "{:?}", lens(0.46));
        assert_eq!(lens(0.3), Vec::new());
        // Boxes side by side, in a row and stacked, far from thin.
        let square = |x: f64, y: f64| Shape::cuboid([x, y], [x + 0.3, y + 0.3]).expect("a box");
        assert_eq!(layers(vec![square(-0.3, 0.0), square(0.0, 0.0), square(-0.3, -0.3)], 0.05), Vec::new());
        assert_eq!(layers(vec![square(-0.3, 0.0), square(0.0, -0.3)], 0.05), Vec::new());
    }

    #[test]
    fn what_lies_between_an_interface_and_the_boundary_is_a_layer() {
        for gap in [0.002, 0.03, 0.09] {
            let disc = Shape::ball([0.7 - gap, 0.0], 0.3).expect("a disc");
            let found = layers(vec![disc], 0.05);
            let least = found.iter().map(|l| l.thickness).fold(f64::INFINITY, f64::min);
            assert!((0.99 * gap..gap + 0.0015).contains(&least), "{gap}: {least}");
            assert!(
                found.iter().all(|l| l.region == 1 && l.at[0] > 0.88 && l.at[1].abs() < 0.3),
                "{found:?}"
            );
        }
        // The slab between a half-space and a face, and a slab of its own along it.
        let slab = |x: f64| Shape::half_space([x, 0.0], [1.0, 0.0]).expect("a half-space");
        assert!(layers(vec![slab(0.97)], 0.05).iter().all(|l| l.region == 1 && l.thickness < 0.0301));
        assert!(layers(vec![slab(-0.97)], 0.05).iter().all(|l| l.region == 0 && l.thickness < 0.0301));
        assert!([0.97, -0.97].iter().all(|&x| layers(vec![slab(x)], 0.05).len() > 40));
        // A shape that ends at the boundary runs along it, as does one round a hole.
        let polygon =
            Shape::polygon(vec![[-1.0, -1.0], [0.3, -1.0], [0.3, 1.0], [-1.0, 1.0]]).expect("a polygon");
        assert_eq!(layers(vec![polygon], 0.05), Vec::new());
        // Far enough away; touching; meeting it at an angle.
        assert_eq!(layers(vec![slab(0.85)], 0.05), Vec::new());
        assert_eq!(layers(vec![Shape::ball([0.7, 0.0], 0.3).expect("a disc")], 0.05), Vec::new());
        for slope in [0.3, 1.0, 10.0] {
            let wedge = Shape::half_space([0.5, -1.0], [slope, -1.0]).expect("a half-space");
            assert_eq!(layers(vec![wedge], 0.05), Vec::new(), "{slope}");
        }
    }

    #[test]
    fn a_tip_between_two_interfaces_is_no_layer() {
        let half = |normal| Shape::half_space([0.0, 0.0], normal).expect("a half-space");
        let wedge = Shape::Intersection(vec![half([0.0, -1.0]), half([-1.0, 1.0])]);
        assert_eq!(layers(vec![wedge], 0.05), Vec::new());
    }
}
