//! Stiff parts that prescribed values hold at one level.
//!
//! In a part that conducts far better than all around it, u differs from what is prescribed by as little as the heat that its
//! neighbours bring makes of it: by their differences over the contrast. What a fit in nodal values leaves over is a part of *their*
//! differences, and times the diffusivity that would be the flux. As `u = c + s w` with the level `c` known and `s` the inverse of the
//! contrast, `w` is of the size of the neighbours' values, and the flux is as accurate as theirs.
//!
//! That holds only where nothing else drives a larger flux through the part: values that differ from place to place, a source, a
//! prescribed flux, a reaction, which turns the level itself into a source. Such a part keeps its nodal values.

use super::interface::InterfacePoints;
use crate::{Condition, Problem};

/// Least diffusivity of a part over what is around it. Below, nodal values cost its flux three digits at most, and are more accurate
/// where a source drives a flux through it: a ball in a medium of 100 had four times the error.
const LEAST_CONTRAST: f64 = 1e3;

/// How much larger than what its neighbours can bring the flux through a part may be that counts as held: it, times the residual of a
/// fit, is what they see of the part.
const DRIVEN: f64 = 100.0;

/// The levels and scales of parts.
pub(super) struct Held {
    /// The level of every part that is held, and its scale.
    pub(super) parts: Vec<Option<(f64, f64)>>,
}

/// What is known of a part.
#[derive(Clone, Copy)]
struct Part {
    /// Least and largest diffusivity.
    eta: [f64; 2],
    /// Least and largest prescribed value.
    values: Option<[f64; 2]>,
    /// What drives fluxes: sources times the square of the length of the domain, fluxes times the length.
    drive: f64,
}

impl Held {
    /// Finds them; `touching` lists what each part touches, `floats` tells which ones have constants to be solved for, and `scale` has
    /// the scales of these.
    pub(super) fn find<const D: usize>(
        problem: &Problem<'_, D>,
        part_of: &[u32],
        touching: &[Vec<u32>],
        interfaces: &InterfacePoints<D>,
        scale: &[f64],
        floats: impl Fn(usize) -> bool,
    ) -> Self {
        let mut held = vec![None; touching.len()];
        let (low, high) =
            problem.eta.iter().fold((f64::INFINITY, 0.0_f64), |(l, h), &e| (l.min(e), h.max(e)));
        if high <= LEAST_CONTRAST * low {
            return Self { parts: held };
        }
        let mut scale = scale.to_vec();
        let (parts, levels) = survey(problem, part_of, touching.len(), interfaces);
        // How far the values outside may differ.
        let differences = |p: usize| parts[p].drive / parts[p].eta[0];
        let span = |of: [f64; 2]| (of[1] - of[0]).max(0.0);
        let mut order: Vec<usize> =
            (0..parts.len()).filter(|&p| parts[p].values.is_some() && !floats(p)).collect();
        order.sort_by(|&a, &b| parts[a].eta[0].total_cmp(&parts[b].eta[0]));
        for own in order {
            let Some(values) = parts[own].values else { continue };
            let around = touching[own].iter().map(|&q| parts[q as usize].eta[1] * scale[q as usize]);
            let conductance = around.fold(0.0_f64, f64::max);
            if conductance == 0.0 || parts[own].eta[0] <= LEAST_CONTRAST * conductance {
                continue;
            }
            let others = (0..parts.len()).filter(|&q| q != own && parts[q].eta[1] < parts[own].eta[0]);
            let outside = others.map(differences).fold(span(levels), f64::max);
            let s = conductance / parts[own].eta[0];
            if span(values) <= s * outside && parts[own].drive <= DRIVEN * conductance * outside {
                held[own] = Some((0.5 * (values[0] + values[1]), s));
                scale[own] = s;
            }
        }
        Self { parts: held }
    }
}

/// What is known of every part, and the least and largest level that is given anywhere.
fn survey<const D: usize>(
    problem: &Problem<'_, D>,
    part_of: &[u32],
    count: usize,
    interfaces: &InterfacePoints<D>,
) -> (Vec<Part>, [f64; 2]) {
    let length = problem.domain.bounds().diameter();
    let mut parts = vec![Part { eta: [f64::INFINITY, 0.0], values: None, drive: 0.0 }; count];
    let mut levels = [f64::INFINITY, f64::NEG_INFINITY];
    for (i, (&part, &eta)) in part_of.iter().zip(problem.eta).enumerate() {
        let part = &mut parts[part as usize];
        part.eta = [part.eta[0].min(eta), part.eta[1].max(eta)];
        let source = problem.source.map_or(0.0, |f| f[i]);
        part.drive = part.drive.max(source.abs() * length * length);
    }
    for (node, value) in problem.dirichlet().into_iter().enumerate() {
        let Some(value) = value else { continue };
        widen(&mut levels, value);
        if problem.materials[problem.labels[node] as usize].reaction.is_some() {
            continue;
        }
        widen(parts[part_of[node] as usize].values.get_or_insert([f64::INFINITY, f64::NEG_INFINITY]), value);
    }
    for (node, conditions) in problem.cloud.boundary().iter().zip(problem.conditions) {
        let i = node.node as usize;
        let part = &mut parts[part_of[i] as usize];
        for condition in conditions.iter().filter(|c| !matches!(c, Condition::Dirichlet(_))) {
            let Some((exchange, flux)) = condition.as_flux(problem.eta[i]) else { continue };
            let level = part.values.map_or(0.0, |values| values[0]);
            part.drive = part.drive.max((flux - exchange * level).abs() * length);
            if exchange != 0.0 {
                widen(&mut levels, flux / exchange);
            }
        }
    }
    for point in &interfaces.points {
        let drives = point.law.flux.abs() * length;
        for side in &point.sides {
            let part = &mut parts[side.part as usize];
            part.drive = part.drive.max(drives).max(point.law.value.abs() * point.smallest());
        }
    }
    (parts, levels)
}

fn widen(range: &mut [f64; 2], value: f64) {
    *range = [range[0].min(value), range[1].max(value)];
}
