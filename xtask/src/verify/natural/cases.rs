//! The problems, and how well they must be solved.

use meshless_tests::natural::{corners, desk, plates};

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
    /// Whether u is known at points, or everywhere.
    pub(super) probes: bool,
    /// What the case varies, mostly a diffusivity; the first are those of the quick sweep.
    pub(super) parameters: &'static [f64],
    /// How many of them the quick sweep has.
    pub(super) quick: usize,
    /// Spacing of rung 0.
    pub(super) coarsest: f64,
    /// In three dimensions.
    pub(super) space: bool,
    /// Whether the methods that are compared can solve it.
    pub(super) compared: bool,
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
    /// Where it is known to be missed.
    pub(super) missed: Option<Missed>,
}

/// Errors up to which a bound is known to be missed, and why.
#[derive(Debug)]
pub(super) struct Missed {
    pub(super) values: f64,
    pub(super) flux: f64,
    pub(super) why: &'static str,
}

const fn plan(level: usize, values: f64, flux: f64) -> Bound {
    Bound { order: None, level, parameter: None, values, flux, missed: None }
}

const fn of_order(order: usize, level: usize, values: f64, flux: f64) -> Bound {
    Bound { order: Some(order), ..plan(level, values, flux) }
}

const fn missed(bound: Bound, values: f64, flux: f64, why: &'static str) -> Bound {
    Bound { missed: Some(Missed { values, flux, why }), ..bound }
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
    probes: true,
    parameters: &CONTRASTS,
    quick: 1,
    coarsest: 0.1,
    space: false,
    compared: true,
    bounds: &CHIP,
};

pub(super) const CASES: [Case; 21] = [
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
        parameters: &[0.1],
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
    Case {
        case: "l-shape",
        title: "L-shape, closed form",
        about: "u = r^(2/3) cos(2 t/3), of which the values on the boundary are given. About 1,500 nodes.",
        scene: corners::l_shape,
        conditions: &[],
        parameters: &[1.0],
        coarsest: 0.0894,
        bounds: &[plan(1, 1e-5, 0.0), of_order(8, 1, 1e-8, 0.0)],
        ..HEATED
    },
    Case {
        case: "kellogg",
        title: "Kellogg's quadrants",
        about: "u = r^0.1 mu(t), diffusivities of 161 and 1 in the quadrants of a square.",
        scene: corners::kellogg,
        conditions: &[],
        parameters: &[1.0],
        bounds: &[
            plan(1, 1e-4, 0.0),
            missed(
                plan(2, 1e-6, 0.0),
                2e-5,
                0.0,
                "largest error of order 4 beyond the zone of the functions; 8e-7 in L2, and order 8 has 7e-10",
            ),
            of_order(8, 1, 1e-6, 0.0),
        ],
        ..HEATED
    },
    Case {
        case: "mixed",
        title: "A side at 0 beside an insulated one",
        about: "u = r^(1/2) sin(t/2): the condition changes in the middle of a straight side.",
        scene: corners::mixed,
        conditions: &[],
        parameters: &[1.0],
        bounds: &[plan(1, 1e-4, 0.0), of_order(8, 1, 1e-7, 0.0)],
        ..HEATED
    },
    Case {
        case: "l-domain",
        title: "L-shape, source 1",
        about: "Sides at 0: 3 is made and leaves.",
        scene: desk::l_domain,
        parameters: &[1.0],
        bounds: &[plan(1, 1e-3, 1e-3), of_order(6, 2, 1e-6, 1e-6)],
        ..HEATED
    },
    Case {
        case: "iso-10211-1",
        title: "ISO 10211, case 1",
        about: "Two values meet in a corner of a column; 0.1 K is allowed, the series has any digits.",
        scene: desk::iso_10211_1,
        conditions: &[],
        parameters: &[1.0],
        coarsest: 0.4,
        bounds: &[plan(1, 1e-3, 0.0), plan(2, 1e-4, 0.0)],
        ..HEATED
    },
    Case {
        case: "tolerance",
        title: "Heated chip between two values",
        about: "u = x on the left and on the right, nothing passes the other sides.",
        scene: desk::tolerance,
        conditions: &[],
        parameters: &[10.0],
        ..HEATED
    },
    Case {
        case: "die",
        title: "Die on a spreader",
        about: "Half of the section of a die of 10 mm on copper that is cooled from below: 60.74 at the top, 2.5 W/mm in and out. The die \
                is 0.5 mm thick: two spacings on the second cloud, too few for corner functions, four on the third.",
        scene: desk::die,
        conditions: &["bottom", ""],
        parameters: &[0.15],
        coarsest: 0.5,
        bounds: &[plan(1, 1e-2, 1e-4), plan(2, 1e-5, 1e-5)],
        ..HEATED
    },
    Case {
        case: "quarter-cell",
        title: "Square array of fibres",
        about: "Fibres that conduct 1e10 times as well, fractions 0.3 and 0.7; the parameter is the fraction.",
        scene: desk::quarter_cell,
        conditions: &["left", "right", ""],
        parameters: &[0.7, 0.3],
        coarsest: 0.05,
        bounds: &[plan(1, 1e-2, 1e-2), plan(2, 1e-3, 1e-3)],
        ..HEATED
    },
    Case {
        case: "heated-cube",
        title: "Heated cube",
        about: "5.12 is made in a cube of 0.8 and leaves.",
        scene: desk::heated_cube,
        parameters: &SOLIDS,
        quick: 0,
        coarsest: 0.24,
        space: true,
        bounds: &[plan(1, 3e-2, 1e-3)],
        ..HEATED
    },
    Case {
        case: "heated-cylinder",
        title: "Heated cylinder",
        about: "With ends: curved edges.",
        scene: desk::heated_cylinder,
        parameters: &SOLIDS,
        quick: 0,
        coarsest: 0.24,
        space: true,
        bounds: &[plan(1, 1e-1, 1e-2)],
        ..HEATED
    },
    Case {
        case: "die-3d",
        title: "Die on a spreader, in space",
        about: "A quarter of it: 12.5 W in and out.",
        scene: desk::die_3d,
        conditions: &["bottom", ""],
        parameters: &[0.15],
        quick: 0,
        coarsest: 0.5,
        space: true,
        bounds: &[
            missed(plan(0, 1e-2, 1e-2), 1.5e-2, 1e-2, "the die is one spacing thick"),
            plan(1, 5e-3, 1e-3),
        ],
        ..HEATED
    },
    Case {
        case: "iso-10211-4",
        title: "ISO 10211, case 4",
        about: "An iron bar through an insulation layer: 0.540 W, of which a quarter is solved for, within 1 %; 0.805 at the outer surface, within 0.005.",
        scene: desk::iso_10211_4,
        conditions: &["outside", "", "inside"],
        parameters: &[50.0],
        quick: 0,
        coarsest: 0.025,
        space: true,
        bounds: &[missed(
            plan(1, 6e-3, 1e-2),
            5e-2,
            2e-2,
            "half of the bar is two spacings thick, too few for functions of its edges, and where bar, layer and air meet the flux depends on u",
        )],
        ..HEATED
    },
    Case {
        case: "spheres",
        title: "Cubic array of spheres",
        about: "Ten times the diffusivity of the matrix; the parameter is the fraction of volume.",
        scene: desk::spheres,
        probes: false,
        conditions: &["left", "right", ""],
        parameters: &[0.3, 0.1],
        quick: 0,
        coarsest: 0.08,
        space: true,
        bounds: &[plan(1, 1e-3, 1e-3)],
        ..HEATED
    },
];

/// Diffusivities of heated solids.
const SOLIDS: [f64; 3] = [10.0, 1e4, 1e-2];

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
            Effort::Default => 0..if self.space { 2 } else { 3 },
            Effort::Full => 0..if self.space { 3 } else { 4 },
        }
    }
}
