//! Which methods a scene can be solved by, to be compared.

use crate::plan::{Effect, Plan};
use crate::scene::{FreeSpaceSpec, GreenName, MethodName, MethodSpec, Scene};

/// A method at an order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Candidate {
    pub(super) name: MethodName,
    /// The method's own choice, if absent.
    pub(super) order: Option<usize>,
    /// In free space, a kernel.
    pub(super) kernel: Option<GreenName>,
}

const fn of(name: MethodName, order: Option<usize>) -> Candidate {
    Candidate { name, order, kernel: None }
}

const FREE_SPACE: [Candidate; 4] = [
    of(MethodName::FreeSpace, Some(4)),
    of(MethodName::FreeSpace, Some(10)),
    Candidate { name: MethodName::FreeSpace, order: None, kernel: Some(GreenName::Spectral) },
    Candidate { name: MethodName::FreeSpace, order: None, kernel: Some(GreenName::Truncated) },
];

/// Orders of the sharp method by dimension.
const SHARP: [&[usize]; 3] = [&[4, 6, 8], &[4, 6, 8], &[4, 6]];

/// The same in time: beyond them masses are of a lower order near interfaces.
const SHARP_IN_TIME: [usize; 2] = [4, 6];

/// Orders of plain stencils where nothing jumps.
const STENCILS: [usize; 3] = [2, 4, 6];

/// All that serve the scene, or the named ones of them. A method that was named is tried, whatever the scene has.
pub(super) fn candidates(scene: &Scene, plan: &Plan, only: &[MethodName]) -> Vec<Candidate> {
    let all = all(scene, plan);
    if only.is_empty() {
        return all;
    }
    let of_name = |name: &MethodName| {
        let found: Vec<Candidate> = all.iter().filter(|c| c.name == *name).copied().collect();
        if found.is_empty() { vec![of(*name, None)] } else { found }
    };
    only.iter().flat_map(of_name).collect()
}

fn all(scene: &Scene, plan: &Plan) -> Vec<Candidate> {
    use MethodName::{
        GfdmClassical, GfdmConservative, GfdmHybrid, ImmersedInterface, ParticleDifference, Sharp,
    };
    if scene.free_space.is_some() {
        return FREE_SPACE.to_vec();
    }
    if plan.effects.contains(&Effect::Slits) {
        return vec![of(ParticleDifference, None)];
    }
    let mut all: Vec<Candidate> = if plan.has_interface() {
        [GfdmHybrid, GfdmConservative, ParticleDifference, ImmersedInterface]
            .map(|name| of(name, None))
            .to_vec()
    } else {
        STENCILS.iter().map(|&order| of(GfdmClassical, Some(order))).collect()
    };
    let orders = if scene.time.is_some() { &SHARP_IN_TIME[..] } else { SHARP[scene.dimension - 1] };
    all.extend(orders.iter().map(|&order| of(Sharp, Some(order))));
    all.retain(|candidate| plan.is_known_to(candidate.name));
    all
}

impl Candidate {
    /// The scene with this method, without the options that another one has been given.
    pub(super) fn in_scene(&self, scene: &Scene) -> Scene {
        let mut scene = scene.clone();
        let options = if scene.method.name == self.name { scene.method.options } else { Default::default() };
        scene.method = MethodSpec { name: self.name, order: self.order, options, ..scene.method };
        scene.accuracy = None;
        if let Some(spec) = scene.free_space.as_mut() {
            *spec = FreeSpaceSpec { kernel: self.kernel, sigma: None, ..spec.clone() };
        }
        scene
    }
}
