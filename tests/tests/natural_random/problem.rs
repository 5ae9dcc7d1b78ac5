//! Random problems that are given by their data: shapes that touch, overlap, or end at the wall, contrasts of ten orders, sources,
//! conditions of all kinds; and what an answer to them must not do: be further off than it says.

use std::fmt::Write as _;

use meshless::plan::Plan;
use meshless::report::Report;
use meshless::scene::{MethodName, Scene};
use meshless::{Error, Silent, Solution, execute};
use proptest::prelude::*;
use proptest::sample::select;

/// A problem on the unit box.
#[derive(Debug, Clone)]
pub(crate) struct Natural {
    /// 1, 2 or 3.
    pub(crate) dimension: usize,
    /// The shape, the decimal exponent of the diffusivity and the source of each part; where two overlap the first counts.
    pub(crate) parts: Vec<(String, i32, f64)>,
    /// Source of the rest, whose diffusivity is 1.
    pub(crate) source: f64,
    /// What holds on each face; u is fixed by the first one.
    pub(crate) conditions: Vec<String>,
    /// Seed of the cloud.
    pub(crate) seed: u64,
}

const FACES: [&str; 6] = ["left", "right", "bottom", "top", "back", "front"];

/// Spacings by dimension: some 30, 130 and 350 nodes.
const SPACING: [f64; 3] = [0.04, 0.09, 0.15];

/// Points at which answers are compared: on no lattice.
const PROBES: [[f64; 3]; 7] = [
    [0.137, 0.211, 0.342],
    [0.713, 0.163, 0.571],
    [0.291, 0.687, 0.143],
    [0.839, 0.787, 0.853],
    [0.519, 0.447, 0.483],
    [0.367, 0.387, 0.719],
    [0.637, 0.561, 0.259],
];

impl Natural {
    /// The scene at so many times its spacing.
    pub(crate) fn text(&self, coarser: f64) -> String {
        let d = self.dimension;
        let row = |x: &str| vec![x; d].join(", ");
        let mut text = format!(
            "title = \"random\"\ndimension = {d}\n\n[domain]\nbox = {{ min = [{}], max = [{}] }}\n\n\
             [points]\nspacing = {:?}\nseed = {}\n\n",
            row("0.0"),
            row("1.0"),
            SPACING[d - 1] * coarser,
            self.seed,
        );
        let source = |f: f64| if f == 0.0 { String::new() } else { format!("source = {f:?}\n") };
        // Writing to a string cannot fail.
        for (k, (shape, exponent, f)) in self.parts.iter().enumerate() {
            let _ = write!(
                text,
                "[[regions]]\nname = \"part {k}\"\n{shape}\ndiffusivity = 1e{exponent}\n{}\n",
                source(*f)
            );
        }
        let _ = write!(text, "[[regions]]\nname = \"rest\"\ndiffusivity = 1\n{}\n", source(self.source));
        for (face, condition) in FACES.iter().zip(&self.conditions) {
            let _ = write!(text, "[[boundaries]]\nface = \"{face}\"\n{condition}\n\n");
        }
        for probe in PROBES {
            let _ = write!(text, "[[probes]]\nat = {:?}\n\n", &probe[..d]);
        }
        text
    }
}

/// Tenths, as shapes are told: what has the same coordinates touches.
fn tenths(k: i32) -> f64 {
    f64::from(k) / 10.0
}

fn point(coordinates: &[i32]) -> String {
    format!("{:?}", coordinates.iter().map(|&k| tenths(k)).collect::<Vec<_>>())
}

fn cuboid(dimension: usize) -> impl Strategy<Value = String> {
    prop::collection::vec((0..8_i32, 2..7_i32), dimension).prop_map(|sides| {
        let low: Vec<i32> = sides.iter().map(|s| s.0).collect();
        let high: Vec<i32> = sides.iter().map(|s| (s.0 + s.1).min(10)).collect();
        format!("box = {{ min = {}, max = {} }}", point(&low), point(&high))
    })
}

fn ball(dimension: usize) -> impl Strategy<Value = String> {
    (prop::collection::vec(1..10_i32, dimension), 15..35_i32).prop_map(|(center, radius)| {
        format!("sphere = {{ center = {}, radius = {:?} }}", point(&center), tenths(radius) / 10.0)
    })
}

fn polygon() -> impl Strategy<Value = String> {
    (3..9_usize, 2..9_i32, 2..9_i32, 18..35_i32, 0..12_i32).prop_map(|(n, x, y, radius, turn)| {
        let angle = |k: usize| (k as f64 / n as f64 + f64::from(turn) / 12.0) * std::f64::consts::TAU;
        let radius = tenths(radius) / 10.0;
        let vertex = |k| [tenths(x) + radius * angle(k).cos(), tenths(y) + radius * angle(k).sin()];
        format!("polygon = {:?}", (0..n).map(vertex).collect::<Vec<_>>())
    })
}

fn shape(dimension: usize) -> BoxedStrategy<String> {
    let union =
        (cuboid(dimension), cuboid(dimension)).prop_map(|(a, b)| format!("union = [{{ {a} }}, {{ {b} }}]"));
    match dimension {
        1 => cuboid(1).boxed(),
        2 => prop_oneof![4 => cuboid(2), 2 => ball(2), 3 => polygon(), 2 => union].boxed(),
        _ => prop_oneof![3 => cuboid(3), 1 => ball(3), 1 => union].boxed(),
    }
}

fn fixes() -> impl Strategy<Value = String> {
    select(vec!["dirichlet = 0", "dirichlet = 1", "dirichlet = \"x\"", "robin = { a = 2, b = 1, g = 2 }"])
        .prop_map(str::to_owned)
}

fn condition() -> impl Strategy<Value = String> {
    let others = select(vec!["neumann = 0", "neumann = 0", "flux = 0.5", "flux = \"x - 0.5\""])
        .prop_map(str::to_owned);
    prop_oneof![fixes(), others]
}

fn of_dimension(dimension: usize) -> impl Strategy<Value = Natural> {
    let sources = || select(vec![0.0, 0.0, 1.0, 10.0]);
    let part = (shape(dimension), -4..7_i32, sources());
    (
        prop::collection::vec(part, 1..4),
        sources(),
        fixes(),
        prop::collection::vec(condition(), 2 * dimension - 1),
        1..1000_u64,
    )
        .prop_map(move |(parts, source, first, others, seed)| Natural {
            dimension,
            parts,
            source,
            conditions: std::iter::once(first).chain(others).collect(),
            seed,
        })
}

/// Problems on the line, in the plane and in space; most of them in the plane.
pub(crate) fn natural() -> impl Strategy<Value = Natural> {
    prop_oneof![2 => of_dimension(1), 7 => of_dimension(2), 1 => of_dimension(3)]
}

/// How far an answer is off, and what it said.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Verdict {
    /// Root mean square of the difference to the finer cloud at the probes, over that of its u.
    pub(crate) difference: f64,
    /// The estimate of the answer and that of the finer cloud, together.
    pub(crate) told: f64,
    /// What is left over of the balance, relative, where the report has one.
    pub(crate) left_over: Option<f64>,
    /// The estimate of the answer.
    pub(crate) estimate: f64,
    /// The largest difference of a probe, over what both answers tell of it.
    pub(crate) probe: f64,
}

/// How many times the estimates a difference may be: they are good to a factor of three either way, and a coarse cloud is
/// not where they are at their best.
const FACTOR: f64 = 10.0;

/// Differences below this are round-off at contrasts of ten orders.
const ROUND_OFF: f64 = 1e-8;

impl Verdict {
    /// How many times more than allowed the answer is off; up to 1 is right.
    pub(crate) fn excess(&self) -> f64 {
        let difference = self.difference / (FACTOR * self.told + ROUND_OFF);
        let balance = self.left_over.map_or(0.0, |left| left / (FACTOR * self.estimate + ROUND_OFF));
        let probe = self.probe / FACTOR;
        // Not a number is as wrong as can be.
        let all = [difference, balance, probe];
        if all.iter().any(|x| x.is_nan()) { f64::INFINITY } else { all.into_iter().fold(0.0, f64::max) }
    }
}

fn solved(text: &str, method: MethodName) -> Result<Solution, Error> {
    let mut scene = Scene::parse(text, "random.toml")?;
    scene.method.name = method;
    execute(&scene, &Plan::new(&scene)?, &mut Silent)
}

/// The relative part of the balance that is left over, as the report prints it.
fn left_over(report: &Report) -> Option<f64> {
    serde_json::to_value(report).ok()?.get("balance")?.get("relative")?.as_f64()
}

/// Judges the plan's answer by conservative balances on a cloud of half the spacing. `None` where the answer was refused, or
/// claims nothing, or where there is nothing to compare with.
pub(crate) fn judge(problem: &Natural) -> Option<Verdict> {
    let answer = solved(&problem.text(1.0), MethodName::Auto).ok()?.report;
    let estimate = answer.estimate.l2?;
    let finer = solved(&problem.text(0.5), MethodName::GfdmConservative).ok()?;
    let u = &finer.field.u;
    let scale = (u.iter().map(|u| u * u).sum::<f64>() / u.len() as f64).sqrt();
    let (mut sum, mut count, mut probe) = (0.0, 0.0, 0.0_f64);
    // What the balances are compared with is another cloud of a method of first order at interfaces: one number may agree by chance.
    let reference = finer.report.estimate.l2? * scale;
    for (a, b) in answer.probes.iter().zip(&finer.report.probes) {
        let told = a.estimate? + b.estimate?.max(reference);
        let (a, b) = a.value.zip(b.value)?;
        sum += (a - b).powi(2);
        count += 1.0;
        let ratio = (a - b).abs() / (told + ROUND_OFF * scale);
        probe = if ratio.is_nan() { ratio } else { probe.max(ratio) };
    }
    Some(Verdict {
        difference: (sum / count).sqrt() / scale.max(f64::MIN_POSITIVE),
        told: estimate + reference / scale.max(f64::MIN_POSITIVE),
        left_over: left_over(&answer),
        estimate,
        probe,
    })
}
