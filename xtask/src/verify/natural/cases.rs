//! The problems, and how well they must be solved.

use meshless_tests::natural::plates;

use crate::verify::options::Effort;

/// A scene for a parameter, a spacing and a seed.
pub(super) type Scene = fn(f64, f64, u64) -> String;

/// A problem.
#[derive(Debug)]
pub(super) struct Case {
    pub(super) case: &'static str,
    pub(super) title: &'static str,
    pub(super) about: &'static str,
    pub(super) scene: Scene,
    /// What the references call the conditions of the scene, in its order; empty for those that they do not know.
    pub(super) conditions: &'static [&'static str],
    /// What the case varies, mostly a diffusivity; the first are those of the quick sweep.
    pub(super) parameters: &'static [f64],
    /// How many of them the quick sweep has.
    pub(super) quick: usize,
    /// Spacing of rung 0.
    pub(super) coarsest: f64,
    pub(super) bounds: &'static [Bound],
}

/// How well a problem must be solved.
#[derive(Debug)]
pub(super) struct Bound {
    /// The order of the sharp method; the plan's choice where there is none.
    pub(super) order: Option<usize>,
    /// Rung of the ladder.
    pub(super) level: usize,
    /// The parameter that it is about; all where there is none.
    pub(super) parameter: Option<f64>,
    /// Largest error of a probe, over the root mean square of u in its region.
    pub(super) values: f64,
    /// Largest error of a flux, over the largest flux.
    pub(super) flux: f64,
}

const fn plan(level: usize, values: f64, flux: f64) -> Bound {
    Bound { order: None, level, parameter: None, values, flux }
}

const fn of_order(order: usize, level: usize, values: f64, flux: f64) -> Bound {
    Bound { order: Some(order), ..plan(level, values, flux) }
}

/// What a chip with straight sides must be solved to.
const CHIP: [Bound; 2] = [plan(1, 1e-2, 1e-3), plan(2, 1e-3, 1e-4)];

/// Contrasts of heated parts; the first of them are those of the quick sweep.
const CONTRASTS: [f64; 5] = [10.0, 1e-2, 1e4, 1e-4, 1e10];

const HEATED: Case = Case {
    case: "",
    title: "",
    about: "",
    scene: plates::heated_box,
    conditions: &["outer"],
    parameters: &CONTRASTS,
    quick: 1,
    coarsest: 0.1,
    bounds: &CHIP,
};

pub(super) const CASES: [Case; 8] = [
    Case {
        case: "heated-box",
        title: "Heated square chip",
        about: "10 is made in each unit of area of a chip of 0.6 x 0.6 in a plate of diffusivity 1 whose sides are at 0: 3.6 leaves. \
                The diffusivity of the chip is the parameter; where it is small the values inside are as large as its inverse, \
                and those outside do not depend on it.",
        parameters: &[10.0, 1e-10, 1e-2, 1e4, 1e-4, 1e10],
        quick: 2,
        bounds: &[
            plan(1, 1e-2, 1e-3),
            plan(2, 1e-3, 1e-4),
            Bound { parameter: Some(10.0), ..of_order(6, 2, 1e-6, 1e-6) },
        ],
        ..HEATED
    },
    Case {
        case: "heated-triangle",
        title: "Heated triangle",
        about: "Equilateral: corners of 60 degrees.",
        scene: plates::heated_triangle,
        ..HEATED
    },
    Case {
        case: "heated-12-gon",
        title: "Heated 12-gon",
        about: "Corners of 150 degrees, three spacings apart on the first cloud and six on the second.",
        scene: plates::heated_12_gon,
        ..HEATED
    },
    Case {
        case: "heated-l",
        title: "Heated L",
        about: "A chip with a re-entrant corner.",
        scene: plates::heated_l,
        ..HEATED
    },
    Case {
        case: "heated-lens",
        title: "Heated lens",
        about: "What two discs have in common: two corners between arcs.",
        scene: plates::heated_lens,
        ..HEATED
    },
    Case {
        case: "touching-edge",
        title: "Boxes that share half an edge",
        about: "One is heated, the other conducts three times as well: two points where three materials meet.",
        scene: plates::touching_edge,
        ..HEATED
    },
    Case {
        case: "touching-corner",
        title: "Boxes that touch in a corner",
        about: "u goes like r^0.39 there.",
        scene: plates::touching_corner,
        parameters: &[10.0, 0.1],
        ..HEATED
    },
    Case {
        case: "box-on-wall",
        title: "Heated box on a wall",
        about: "The wall is insulated: the interface meets it at a right angle.",
        scene: plates::box_on_wall,
        conditions: &["", "outer"],
        ..HEATED
    },
];

impl Case {
    /// Spacing of a rung.
    pub(super) fn spacing(&self, level: usize) -> f64 {
        self.coarsest * 0.5_f64.powi(level as i32)
    }

    /// The parameters of a sweep.
    pub(super) fn parameters(&self, effort: Effort) -> &'static [f64] {
        if effort == Effort::Quick { &self.parameters[..self.quick] } else { self.parameters }
    }

    /// The rungs of a sweep, for the plan's choice.
    pub(super) fn levels(&self, effort: Effort) -> std::ops::Range<usize> {
        match effort {
            Effort::Quick => 1..2,
            Effort::Default => 0..3,
            Effort::Full => 0..4,
        }
    }
}
