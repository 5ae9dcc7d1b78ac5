//! Clouds that resolve the layers and gaps between interfaces.

use super::{RegionMap, ThinLayer};
use crate::cloud::{Cloud, CloudParams, Size, Sizes, Spacing, check_size, generate};
use crate::domain::Domain;
use crate::error::GeometryError;
use crate::spatial_hash::SpatialHash;

/// Clouds that are tried at most. A finer cloud sees more of a layer: where it is thinnest is found in a few.
const CLOUDS: usize = 12;

/// Room for layers that are a little thinner between the places where they are measured.
const ROOM: f64 = 1.25;

/// How far from each other places are at which a spacing is asked for, in units of it.
const APART: f64 = 0.5;

/// A spacing that is met to this is met.
const MET: f64 = 1.02;

/// What is asked for in layers and gaps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GapParams {
    /// Spacings that go on the way through a layer at least.
    pub across: f64,
    /// The smallest spacing, a length: thinner layers stay as they are resolved by it.
    pub least: f64,
}

impl<const D: usize> RegionMap<D> {
    /// A cloud as [`generate`] makes it, with smaller spacings in and near layers that the spacing asked for does not resolve
    /// ([`thin_layers`](Self::thin_layers)). Away from these the spacing grows by a quarter of the distance.
    ///
    /// # Errors
    /// Those of [`generate`]; [`GeometryError::GradedLattice`] where there is something to refine and the layout is regular.
    pub fn generate(
        &self,
        domain: &Domain<D>,
        params: &CloudParams<D>,
        gaps: &GapParams,
    ) -> Result<Cloud<D>, GeometryError> {
        // Cells see nearly all that nodes will see, without clouds that are thrown away.
        check_size(domain, &params.spacing, params.max_nodes)?;
        let mut refined = self.foresee_gaps(domain, params, gaps)?;
        let mut cloud = generate(domain, &CloudParams { spacing: refined.spacing(), ..params.clone() })?;
        for _ in 1..CLOUDS {
            if !refined.resolve(&self.thin_layers(&cloud, domain, gaps.across), gaps)? {
                break;
            }
            cloud = generate(domain, &CloudParams { spacing: refined.spacing(), ..params.clone() })?;
        }
        Ok(cloud)
    }
}

/// A spacing, and what layers ask for.
#[derive(Debug)]
pub(super) struct Refined<'a, const D: usize> {
    given: &'a Spacing<D>,
    places: Vec<Size<D>>,
    sizes: Sizes<D>,
}

impl<'a, const D: usize> Refined<'a, D> {
    pub(super) fn new(given: &'a Spacing<D>) -> Self {
        Self { given, places: Vec::new(), sizes: Sizes::default() }
    }

    /// Whether nothing was asked for.
    pub(super) fn is_plain(&self) -> bool {
        self.places.is_empty()
    }

    /// Takes up what layers ask for; whether that is less than what there was.
    ///
    /// # Errors
    /// Those of [`Spacing::at`].
    pub(super) fn resolve(
        &mut self,
        layers: &[ThinLayer<D>],
        gaps: &GapParams,
    ) -> Result<bool, GeometryError> {
        let before = self.places.len();
        let mut new = SpatialHash::new();
        for layer in layers {
            let size = (layer.thickness / (ROOM * gaps.across)).max(gaps.least);
            let given = self.at(&layer.at)?;
            if given > MET * size && !new.conflicts(&layer.at, size, APART) {
                new.insert(layer.at, size);
                self.places.push(Size::at(layer.at, size));
            }
        }
        self.sizes = Sizes::new(self.places.clone());
        Ok(self.places.len() > before)
    }

    /// The spacing at a point.
    ///
    /// # Errors
    /// Those of [`Spacing::at`].
    pub(super) fn at(&self, x: &[f64; D]) -> Result<f64, GeometryError> {
        Ok(self.sizes.at(x, self.given.at(x)?))
    }

    /// The same as a function.
    pub(super) fn spacing(&self) -> Spacing<D> {
        self.given.clone().at_most(self.places.clone())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cloud::{Layout, quality};
    use crate::shape::Shape;

    const GAPS: GapParams = GapParams { across: 2.0, least: 1e-4 };

    fn params<const D: usize>(spacing: f64) -> CloudParams<D> {
        CloudParams {
            spacing: Spacing::Uniform(spacing),
            layout: Layout::Irregular,
            seed: 1,
            max_nodes: 100_000,
        }
    }

    fn disc(x: f64, radius: f64) -> Option<Shape<2>> {
        Some(Shape::ball([x, 0.0], radius).expect("a disc"))
    }

    #[test]
    fn nothing_is_refined_where_nothing_is_thin() {
        let domain = Domain::boxed([-1.0, -1.0], [1.0, 1.0]).expect("a box");
        let regions = RegionMap::new(vec![disc(0.0, 0.5), None]).expect("regions");
        let cloud = regions.generate(&domain, &params(0.1), &GAPS).expect("a cloud");
        assert_eq!(cloud, generate(&domain, &params(0.1)).expect("a cloud"));
        let plain = check_size(&domain, &params(0.1).spacing, 100_000).expect("a number");
        assert_eq!(regions.foresee_nodes(&domain, &params(0.1), &GAPS), Ok(plain));
        assert!(regions.foresee_nodes(&domain, &params(0.001), &GAPS).is_err());
    }

    #[test]
    fn gaps_and_films_have_their_nodes() {
        let domain = Domain::boxed([-1.0, -1.0], [1.0, 1.0]).expect("a box");
        for (regions, thickness) in [
            (vec![disc(-0.305, 0.3), disc(0.305, 0.3), None], 0.01),
            (vec![disc(0.0, 0.5), disc(0.0, 0.52), None], 0.02),
            (vec![disc(0.0, 0.5), disc(0.02, 0.55), None], 0.03),
        ] {
            let regions = RegionMap::new(regions).expect("regions");
            let cloud = regions.generate(&domain, &params(0.1), &GAPS).expect("a cloud");
            assert_eq!(regions.thin_layers(&cloud, &domain, GAPS.across), Vec::new(), "{thickness}");
            let least = cloud.spacing().iter().fold(f64::INFINITY, |a, &b| a.min(b));
            assert!((thickness / 3.0..=thickness / 2.0).contains(&least), "{thickness}: {least}");
            assert!(cloud.len() < 10_000, "{thickness}: {}", cloud.len());
            let foreseen = regions.foresee_nodes(&domain, &params(0.1), &GAPS).expect("a number");
            let ratio = foreseen / cloud.len() as f64;
            assert!((0.75..1.33).contains(&ratio), "{thickness}: {foreseen} for {}", cloud.len());
            assert!(quality(&cloud, &domain).relative_separation > 0.7);
        }
    }

    #[test]
    fn the_least_spacing_is_a_limit() {
        let domain = Domain::boxed([-1.0, -1.0], [1.0, 1.0]).expect("a box");
        let regions = RegionMap::new(vec![disc(0.0, 0.5), disc(0.0, 0.502), None]).expect("regions");
        let gaps = GapParams { across: 2.0, least: 0.02 };
        let cloud = regions.generate(&domain, &params(0.1), &gaps).expect("a cloud");
        let least = cloud.spacing().iter().fold(f64::INFINITY, |a, &b| a.min(b));
        assert!((0.02..0.025).contains(&least), "{least}");
    }

    #[test]
    fn a_shell_in_space() {
        let domain = Domain::boxed([-1.0; 3], [1.0; 3]).expect("a box");
        let ball = |radius: f64| Some(Shape::ball([0.0; 3], radius).expect("a ball"));
        let regions = RegionMap::new(vec![ball(0.5), ball(0.65), None]).expect("regions");
        let cloud = regions.generate(&domain, &params(0.2), &GAPS).expect("a cloud");
        assert_eq!(regions.thin_layers(&cloud, &domain, GAPS.across), Vec::new());
        assert!(cloud.len() < 20_000, "{}", cloud.len());
        let ratio =
            regions.foresee_nodes(&domain, &params(0.2), &GAPS).expect("a number") / cloud.len() as f64;
        assert!((0.75..1.33).contains(&ratio), "{ratio}");
    }
}
