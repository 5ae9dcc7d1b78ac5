//! The scene file: what is there, read strictly.
//!
//! A scene says geometry, materials, sources, boundary and interface conditions, and what to report; it never says
//! which effects to simulate. [`Scene::parse`] turns TOML into plain data, or into a [`SceneError`] that names file,
//! line, column and key, shows the place, and says what to do. Nothing is evaluated here beyond constant
//! expressions: every [`ExprField`] keeps its place, so that a NaN met later can be reported with [`Place::error`].
//!
//! What a file can do is bounded: its length, the depth of its tables and the size of its expressions are limited,
//! and the only other files that it names are tables of numbers (points, particles) and surfaces of triangles, the latter
//! read when they are first needed.

mod accuracy;
mod boundaries;
mod domain;
mod error;
mod expression;
mod fields;
mod free_space;
mod method;
mod options;
mod points_file;
mod reader;
mod regions;
mod root;
mod shapes;
mod slits;
mod source;
mod spec;
#[cfg(test)]
mod tests;
mod time;

use std::path::Path;
use std::sync::Arc;

pub use accuracy::{AccuracyOf, AccuracySpec};
pub use error::SceneError;
pub use expression::ExprField;
pub use free_space::{FreeSpaceSpec, GreenName, ParticlesSpec, SpreadName};
pub use method::MethodNameError;
pub use options::{
    ConservationName, GhostsName, InterfacesName, KernelName, MethodOptions, ReactionName, SigmaName,
    WedgeName, WeightName,
};
pub(crate) use points_file::FilePoints;
pub use points_file::PointsFileSpec;
pub use source::{MAX_FILE_BYTES, Place};
pub(crate) use spec::{Adapted, Features, Wanted};
pub use spec::{
    BoundarySpec, BoundsSpec, ConditionSpec, CornerSpec, DomainSpec, GapSpec, HoleSpec, InterfaceSpec,
    LayoutName, MethodName, MethodSpec, OutputSpec, PointValues, PointsSpec, RegionSpec, ShapeSpec,
    SlitConditionSpec, SlitSpec, SolverName, SurfaceSpec,
};

pub use time::TimeSpec;
pub(crate) use time::Varying;

use source::Source;

/// What is said elsewhere than in the file about how far apart nodes are, so that the file need not say it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Given {
    /// Nothing.
    #[default]
    Nothing,
    /// A spacing, which takes the place of what is in the scene that is read.
    Spacing,
    /// An error to reach, which refines what is in the scene that is read.
    Tolerance,
}

/// A scene file as data; every invariant that can be checked without evaluating a field holds.
#[derive(Debug, Clone)]
pub struct Scene {
    /// What it shows.
    pub title: String,
    /// 1, 2 or 3; the length of every vector in the scene.
    pub dimension: usize,
    /// The domain without its holes.
    pub domain: DomainSpec,
    /// How nodes are placed.
    pub points: PointsSpec,
    /// What is cut out of the domain; names are distinct, and none is that of another face.
    pub holes: Vec<HoleSpec>,
    /// Materials; a point belongs to the first region that contains it. At least one; names are distinct, and the
    /// last region, and only it, is without geometry.
    pub regions: Vec<RegionSpec>,
    /// What holds across interfaces beside that u and its flux go on, at most one entry for each pair of regions.
    pub interfaces: Vec<InterfaceSpec>,
    /// Interfaces that end inside the domain; names are distinct, and 2-D only.
    pub slits: Vec<SlitSpec>,
    /// Conditions, at least one unless the domain is free space; see [`BoundarySpec`] for which one holds where several match.
    pub boundaries: Vec<BoundarySpec>,
    /// The error to reach; a scene without one is solved at its spacing.
    pub accuracy: Option<AccuracySpec>,
    /// What the scene overrides of the plan's choices.
    pub method: MethodSpec,
    /// Where the domain is all of space: how the problem is solved there. There are no conditions, holes, interfaces,
    /// slits or steps in time then, and the domain is the box outside of which the source vanishes.
    pub free_space: Option<FreeSpaceSpec>,
    /// How u changes with time; a steady scene has none.
    pub time: Option<TimeSpec>,
    /// Points whose values are reported, each of `dimension` coordinates.
    pub probes: Vec<Vec<f64>>,
    /// What to write besides the report.
    pub output: OutputSpec,
}

impl Scene {
    /// Reads a scene from its text; `file_name` is only what errors call it.
    ///
    /// # Errors
    ///
    /// The first thing that is wrong with the text: syntax, an unknown, missing or contradictory key, a wrong type,
    /// a value out of its range, or an expression that does not parse.
    pub fn parse(text: &str, file_name: &str) -> Result<Self, SceneError> {
        root::scene(&Arc::new(Source::new(file_name, text)), Given::Nothing)
    }

    /// Reads a scene file.
    ///
    /// # Errors
    ///
    /// As [`Scene::parse`]; also where the file cannot be read, is not UTF-8, or is longer than [`MAX_FILE_BYTES`].
    pub fn read(path: impl AsRef<Path>) -> Result<Self, SceneError> {
        Self::read_given(path, Given::Nothing)
    }

    /// The same where the spacing, or an error to reach, is given elsewhere: `[points]` may then be absent, and
    /// [`Overrides`](crate::Overrides) put it in.
    ///
    /// # Errors
    ///
    /// As [`Scene::read`].
    pub fn read_given(path: impl AsRef<Path>, given: Given) -> Result<Self, SceneError> {
        let source = Source::read(path.as_ref())?;
        root::scene(&Arc::new(source), given)
    }

    /// An error about an expression of this scene, found while evaluating it.
    pub fn error_at(
        &self,
        field: &ExprField,
        message: impl Into<String>,
        help: impl Into<String>,
    ) -> SceneError {
        field.place.error(message, help)
    }

    /// An error about the boundary conditions as a whole, such as a face that none of them covers.
    pub fn error_at_boundaries(&self, message: impl Into<String>, help: impl Into<String>) -> SceneError {
        let place = self.boundaries.first().map_or(&self.domain.place, |b| &b.place);
        let mut error = place.error(message, help);
        error.key = "boundaries".to_owned();
        error
    }

    /// The same scene with the order that was chosen for it.
    pub(crate) fn with_order(&self, order: Option<usize>) -> Self {
        let mut scene = self.clone();
        scene.method.order = order;
        scene
    }

    /// Whether the regions have no shapes, but points from a file that say in which of them they are.
    pub fn is_labelled(&self) -> bool {
        self.points.file.is_some() && self.regions.len() > 1 && self.regions[0].geometry.is_none()
    }

    /// Names of the faces that a boundary condition can be given for, `all` excepted.
    pub fn faces(&self) -> Vec<&str> {
        let outer = self.domain.faces(self.dimension).iter().copied();
        outer.chain(self.holes.iter().map(|hole| hole.name.as_str())).collect()
    }
}
