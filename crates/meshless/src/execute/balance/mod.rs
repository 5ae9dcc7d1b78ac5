//! The balance of a solution: what enters through the boundary and the interfaces, what arises inside, what is stored, and what of
//! all that is left over. An exact solution leaves nothing; so what is left over is an error, whatever an estimate says.
//!
//! Fluxes are integrals over the surfaces by Gauss points. Where a condition says what the flux is, that is it; where u is
//! prescribed, and at interfaces, it is that of the method's own polynomials, or of a fit to the nodes of one region; through interfaces with
//! edges, at which slopes are infinite, that of the method's own balances.

mod content;
mod pieces;
mod surfaces;

use std::collections::BTreeMap;

use meshless_interfaces::gfdm::{CellFlows, Selection};
use meshless_interfaces::{Condition, InterfaceFlow, Problem, Sample, Sampler, SystemSolution};

use super::samples::{by_fits, samples};
use super::{Boundary, Solved};
use crate::Error;
use crate::plan::{MethodParams, Plan};
use crate::report::{BalanceReport, BoundaryFlux, InterfaceFlux, RegionBalance, SourceReport};
use crate::scene::Scene;
use content::{Body, Content};
use surfaces::{Surfaces, Wall};

/// Degree of the fits that those of the second degree are compared with.
const OTHER_DEGREE: usize = 3;

/// Part of a flux by which the quadrature may be off: fluxes at interfaces are taken a little beside them.
const QUADRATURE: [f64; 3] = [1e-8, 1e-8, 1e-4];

/// How much of the area of an interface may be missing, as a share, where its flux is taken from a method's own balances: cells that are
/// cut more than once within an edge have none. The rest stands for it: a quadrature of slopes that are infinite at edges is off by more.
const MISSING_AREA: f64 = 1e-2;

/// Round-off of a slope, over the size of u and the distance of nodes.
const ROUND_OFF: f64 = 1e-12;

/// What a balance needs beside a solution: surfaces, contents of regions, what is stored.
pub(crate) struct Ledger<const D: usize> {
    surfaces: Surfaces<D>,
    sources: Vec<Content>,
    stored: Option<Vec<Content>>,
    bodies: Vec<Body<D>>,
    measures: Vec<f64>,
    names: Vec<String>,
    entries: Vec<String>,
    boundary: Boundary<D>,
    spacing: f64,
}

/// Fluxes of a solution over the surfaces.
pub(crate) struct Flows {
    pub(crate) boundaries: Vec<BoundaryFlux>,
    pub(crate) interfaces: Vec<InterfaceFlux>,
    /// Of the whole, and of every region.
    whole: Flow,
    regions: Vec<Flow>,
    /// What is stored as cells have it, where the fluxes are those of cells; and the sources, where nothing else tells the regions.
    stored: Option<Vec<Content>>,
    sources: Option<Vec<Content>>,
    /// What the reaction takes up and what the velocity carries away, region by region; `None` where the equation has neither.
    taken: Option<Vec<[Content; 2]>>,
}

/// What enters a region.
#[derive(Debug, Clone, Copy, Default)]
struct Flow {
    walls: f64,
    seams: f64,
    /// The integral of the flux's size.
    size: f64,
    /// What jumps of the flux on interfaces make, in the whole.
    jumps: f64,
    /// Round-off of all that.
    round_off: f64,
}

/// What is left over of the whole or of a region, over the sum of the sizes of the parts, and how far that is to be trusted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct LeftOver {
    pub(crate) absolute: f64,
    pub(crate) relative: f64,
    /// The same as a share: errors of integrals of sources and of what is stored, and round-off.
    pub(crate) doubt: f64,
}

impl<const D: usize> Ledger<D> {
    pub(crate) fn new(scene: &Scene, plan: &Plan, solved: &Solved<D>) -> Result<Self, Error> {
        let problem = solved.discrete.problem();
        let boundary = Boundary::new(scene, problem.domain);
        let shared = matches!(plan.method.params, MethodParams::Sharp(_)) && solved.system.rates.is_none();
        let surfaces = Surfaces::new(&problem, &boundary, shared)?;
        let measures = solved.discrete.measures();
        let bodies = Body::all(&problem, &surfaces, &measures);
        let own = |label: usize, values: &[f64]| of_region(&problem, &measures, label, values);
        let source =
            |(label, body): (usize, &Body<D>)| match (&problem.materials[label].source, problem.source) {
                (Some(field), Some(nodal)) => body.source(field, || own(label, nodal)),
                _ => Content::default(),
            };
        let stored = |rates: &Vec<f64>| -> Vec<Content> {
            let rates: Vec<f64> =
                rates.iter().enumerate().map(|(i, rate)| problem.capacity(i) * rate).collect();
            let rates = &rates;
            bodies.iter().enumerate().map(|(label, body)| body.nodal(&own(label, rates))).collect()
        };
        Ok(Self {
            sources: bodies.iter().enumerate().map(source).collect(),
            stored: solved.system.rates.as_ref().map(stored),
            bodies,
            measures,
            surfaces,
            boundary,
            names: scene.regions.iter().map(|region| region.name.clone()).collect(),
            entries: scene.boundaries.iter().map(|spec| spec.face.clone()).collect(),
            spacing: solved.spacing(),
        })
    }

    /// The fluxes of a solution by a method.
    pub(crate) fn flows(
        &self,
        method: &MethodParams,
        problem: &Problem<'_, D>,
        system: &SystemSolution,
    ) -> Result<Flows, Error> {
        if let Some(cells) = method.build().cell_flows(problem, system)? {
            return Ok(self.of_cells(problem, system, &cells));
        }
        let found = samples(method, problem, system, &self.places())?;
        let flows = self.summed(problem, (&system.u, &system.interface_flows), &found);
        Ok(Flows { taken: self.taken(method, problem, system)?, ..flows })
    }

    /// The same in another way, for a solution of which nodal values are all that is known; `None` for others.
    pub(crate) fn other_flows(
        &self,
        method: &MethodParams,
        problem: &Problem<'_, D>,
        system: &SystemSolution,
    ) -> Result<Option<Flows>, Error> {
        let cells = matches!(method, MethodParams::Gfdm(gfdm) if gfdm.selection != Selection::None);
        if cells || matches!(method, MethodParams::Sharp(_)) {
            return Ok(None);
        }
        let found = by_fits(&Sampler::of_degree(problem, &system.u, OTHER_DEGREE)?, &self.places())?;
        let flows = self.summed(problem, (&system.u, &[]), &found);
        Ok(Some(Flows { taken: self.taken(method, problem, system)?, ..flows }))
    }

    /// The integrals of `reaction u` and of `velocity . grad u` over the regions, from the nodes.
    fn taken(
        &self,
        method: &MethodParams,
        problem: &Problem<'_, D>,
        system: &SystemSolution,
    ) -> Result<Option<Vec<[Content; 2]>>, Error> {
        if !problem.has_lower_terms() {
            return Ok(None);
        }
        let gradients = method.build().gradient_of(problem, system)?;
        let reacted: Vec<f64> = system.u.iter().enumerate().map(|(i, u)| problem.reaction(i) * u).collect();
        let carried: Vec<f64> =
            gradients.iter().enumerate().map(|(i, slope)| dot(&problem.velocity(i), slope)).collect();
        let of = |label: usize, body: &Body<D>| {
            [&reacted, &carried].map(|values| body.nodal(&of_region(problem, &self.measures, label, values)))
        };
        Ok(Some(self.bodies.iter().enumerate().map(|(label, body)| of(label, body)).collect()))
    }

    /// Where the solution must be known: where no condition says what the flux is.
    fn places(&self) -> Vec<[f64; D]> {
        let walls = self.surfaces.walls.iter().filter(|wall| needs_sample(wall)).map(|wall| wall.within);
        walls.chain(self.surfaces.seams.iter().map(|seam| seam.from)).collect()
    }

    fn summed(
        &self,
        problem: &Problem<'_, D>,
        (u, through): (&[f64], &[InterfaceFlow]),
        samples: &[Option<Sample<D>>],
    ) -> Flows {
        let mut flows = self.nothing();
        let largest = u.iter().fold(0.0_f64, |m, u| m.max(u.abs()));
        let round_off = ROUND_OFF * largest / self.spacing;
        let mut samples = samples.iter();
        for wall in &self.surfaces.walls {
            let sample = if needs_sample(wall) { samples.next().copied().flatten() } else { None };
            let eta = problem.materials[wall.region as usize].diffusivity.at(&wall.within);
            let Some(flux) = entering(wall, eta, sample.as_ref()) else { continue };
            let (area, part) = (wall.element.area, wall.element.area * flux);
            let boundary = &mut flows.boundaries[wall.entry];
            boundary.flux += part;
            boundary.area += area;
            for flow in [&mut flows.whole, &mut flows.regions[wall.region as usize]] {
                flow.walls += part;
                flow.size += part.abs();
                flow.round_off += if sample.is_some() { area * eta * round_off } else { 0.0 };
            }
        }
        let known = self.whole_interfaces(through);
        for seam in &self.surfaces.seams {
            let Some(sample) = samples.next().copied().flatten() else { continue };
            let eta = problem.materials[sample.region as usize].diffusivity.at(&seam.from);
            let area = seam.element.area;
            let soft = area * eta * dot(&sample.gradient, &seam.element.normal);
            let jump = area * seam.jump;
            let sides = if seam.soft == 0 { [soft, soft + jump] } else { [soft - jump, soft] };
            let is_known = known.iter().any(|known| known.between == seam.between);
            for (k, sign) in [(0, 1.0), (1, -1.0)] {
                let flow = &mut flows.regions[seam.between[k] as usize];
                flow.seams += if is_known { 0.0 } else { sign * sides[k] };
                flow.size += sides[k].abs();
                flow.round_off += area * eta * round_off;
            }
            flows.whole.jumps -= jump;
            flows.whole.size += jump.abs();
            self.add_to_interface(&mut flows, seam.between, if is_known { 0.0 } else { soft }, area);
        }
        for InterfaceFlow { between, sides, .. } in known {
            let soft =
                self.surfaces.seams.iter().find(|seam| seam.between == between).map_or(0, |seam| seam.soft);
            for (k, sign) in [(0, 1.0), (1, -1.0)] {
                flows.regions[between[k] as usize].seams += sign * sides[k];
            }
            self.add_to_interface(&mut flows, between, sides[soft], 0.0);
        }
        flows
    }

    /// Fluxes through interfaces that a method has as a whole: those of almost all of an interface.
    fn whole_interfaces(&self, flows: &[InterfaceFlow]) -> Vec<InterfaceFlow> {
        let area = |between: [u16; 2]| -> f64 {
            let seams = self.surfaces.seams.iter().filter(|seam| seam.between == between);
            seams.map(|seam| seam.element.area).sum()
        };
        let whole = |flow: &InterfaceFlow| {
            let share = area(flow.between) / flow.area;
            let sides = flow.sides.map(|side| share * side);
            ((share - 1.0).abs() <= MISSING_AREA).then_some(InterfaceFlow { sides, ..*flow })
        };
        flows.iter().filter_map(whole).collect()
    }

    fn nothing(&self) -> Flows {
        let entries = self.entries.iter().enumerate();
        Flows {
            boundaries: entries
                .map(|(entry, face)| BoundaryFlux { face: face.clone(), entry, ..BoundaryFlux::default() })
                .collect(),
            interfaces: Vec::new(),
            whole: Flow::default(),
            regions: vec![Flow::default(); self.names.len()],
            stored: None,
            sources: None,
            taken: None,
        }
    }

    fn add_to_interface(&self, flows: &mut Flows, between: [u16; 2], flux: f64, area: f64) {
        let names = between.map(|region| self.names[region as usize].clone());
        match flows.interfaces.iter_mut().find(|known| known.between == names) {
            Some(known) => {
                known.flux += flux;
                known.area += area;
            }
            None => {
                flows.interfaces.push(InterfaceFlux { between: names.to_vec(), flux, area, estimate: None });
            }
        }
    }

    /// Fluxes as balances over cells have them, with sources and what is stored as these have them.
    fn of_cells(&self, problem: &Problem<'_, D>, system: &SystemSolution, cells: &CellFlows<D>) -> Flows {
        let mut flows = self.nothing();
        for wall in &cells.walls {
            let entry = self.boundary.entry(wall.face, &wall.at);
            if let Some(boundary) = entry.map(|entry| &mut flows.boundaries[entry]) {
                boundary.flux += wall.flux;
                boundary.area += wall.area;
            }
            for flow in [&mut flows.whole, &mut flows.regions[wall.region as usize]] {
                flow.walls += wall.flux;
                flow.size += wall.flux.abs();
            }
        }
        // A region conducts as its nodes do on average.
        let mut sums = vec![(0.0, 0.0); self.names.len()];
        for (eta, &label) in problem.eta.iter().zip(problem.labels) {
            let (sum, count) = &mut sums[label as usize];
            (*sum, *count) = (*sum + eta, *count + 1.0);
        }
        let conducts: Vec<f64> =
            sums.into_iter().map(|(sum, count): (f64, f64)| sum / count.max(1.0)).collect();
        let nothing = || vec![Content::default(); self.names.len()];
        let (mut sources, mut stored) = (nothing(), nothing());
        let mut taken = vec![[Content::default(); 2]; self.names.len()];
        let mut leaves = |from: u16, into: u16, flux: f64, area: f64| {
            let flow = &mut flows.regions[from as usize];
            flow.seams -= flux;
            flow.size += flux.abs();
            flows.whole.jumps -= flux;
            // Both sides are listed; the totals are those of the one that conducts less.
            let [here, there] = [from, into].map(|k| conducts[k as usize]);
            let first = from < into;
            if here < there || (here == there && first) {
                let between = [from.min(into), from.max(into)];
                self.add_to_interface(&mut flows, between, if first { -flux } else { flux }, area);
            }
        };
        for seam in &cells.seams {
            leaves(seam.between[0], seam.between[1], seam.flux, seam.area);
        }
        for part in &cells.parts {
            let (arises, stays) = (part.arises, part.stored + part.taken[0] + part.taken[1]);
            let region = part.region as usize;
            sources[region].add(part.arises);
            stored[region].add(part.stored);
            for (sum, part) in taken[region].iter_mut().zip(part.taken) {
                sum.add(part);
            }
            // What arises in the part of a cell beyond the interface comes in through that.
            if part.region != part.cell {
                leaves(part.region, part.cell, arises - stays, 0.0);
                leaves(part.cell, part.region, stays - arises, 0.0);
            }
        }
        flows.stored = system.rates.is_some().then_some(stored);
        // Cells may miss a part of the domain, and so of its sources: then what leaves is not what arises.
        flows.sources = (problem.regions.len() != problem.materials.len()).then_some(sources);
        flows.taken = problem.has_lower_terms().then_some(taken);
        flows
    }

    /// What is left over of the whole, and of every region.
    pub(crate) fn left_over(&self, flows: &Flows) -> (LeftOver, Vec<LeftOver>) {
        let all = |contents: &[Content]| {
            contents.iter().fold((Content::default(), 0.0), |(sum, size), c| {
                let value = sum.value + c.value;
                (Content { value, doubt: sum.doubt + c.doubt, size: 0.0 }, size + c.size)
            })
        };
        let over = |flow: &Flow, sources: &[Content], stored: Option<&[Content]>, taken: &[[Content; 2]]| {
            let ((source, made), (held, kept)) = (all(sources), all(stored.unwrap_or_default()));
            let (gone, used) = all(taken.as_flattened());
            let absolute = flow.walls + flow.seams + flow.jumps + source.value - held.value - gone.value;
            let size = flow.size + made + kept + used;
            let share = |value: f64| if size > 0.0 { value / size } else { 0.0 };
            let doubt =
                source.doubt + held.doubt + gone.doubt + flow.round_off + QUADRATURE[D - 1] * flow.size;
            // Where nothing flows, round-off is no share of anything.
            let relative = if absolute.abs() > flow.round_off { share(absolute.abs()) } else { 0.0 };
            LeftOver { absolute, relative, doubt: share(doubt) }
        };
        let (sources, held) = self.contents(flows);
        let taken = flows.taken.as_deref().unwrap_or_default();
        let of_region = |k: usize| if taken.is_empty() { taken } else { &taken[k..=k] };
        let regions =
            flows.regions.iter().enumerate().map(|(k, flow)| {
                over(flow, &sources[k..=k], held.map(|stored| &stored[k..=k]), of_region(k))
            });
        (over(&flows.whole, sources, held, taken), regions.collect())
    }

    /// Sources, and what is stored.
    fn contents<'a>(&'a self, flows: &'a Flows) -> (&'a [Content], Option<&'a [Content]>) {
        let stored = flows.stored.as_ref().or(self.stored.as_ref());
        (flows.sources.as_ref().unwrap_or(&self.sources), stored.map(Vec::as_slice))
    }

    /// The balance in figures.
    pub(crate) fn report(&self, flows: &Flows) -> BalanceReport {
        let (whole, regions) = self.left_over(flows);
        let jumps = flows.whole.jumps;
        let (sources, stored) = self.contents(flows);
        let named = self.names.iter().cloned().zip(sources);
        let taken = flows.taken.as_ref();
        let of_all = |k: usize| taken.map(|taken| taken.iter().map(|parts| parts[k].value).sum());
        BalanceReport {
            into: flows.boundaries.clone(),
            sources: SourceReport {
                total: sources.iter().map(|c| c.value).sum::<f64>() + jumps,
                regions: named.map(|(name, content)| (name, content.value)).collect(),
                flux_jumps: jumps,
            },
            stored: stored.map(|stored| stored.iter().map(|c| c.value).sum()),
            reacted: of_all(0),
            carried: of_all(1),
            left_over: whole.absolute,
            relative: whole.relative,
            regions: (self.names.iter().zip(&flows.regions).zip(regions).enumerate())
                .map(|(k, ((name, flow), left))| {
                    let balance = RegionBalance {
                        boundaries: flow.walls,
                        interfaces: flow.seams,
                        sources: sources[k].value,
                        stored: stored.map(|stored| stored[k].value),
                        reacted: taken.map(|taken| taken[k][0].value),
                        carried: taken.map(|taken| taken[k][1].value),
                        left_over: left.absolute,
                        relative: left.relative,
                    };
                    (name.clone(), balance)
                })
                .collect::<BTreeMap<_, _>>(),
        }
    }
}

/// Values at the nodes of a region, each after the measure of its node.
fn of_region<const D: usize>(
    problem: &Problem<'_, D>,
    measures: &[f64],
    label: usize,
    values: &[f64],
) -> Vec<(f64, f64)> {
    let all = problem.labels.iter().zip(measures).zip(values);
    all.filter(|((l, _), _)| **l as usize == label).map(|((_, m), v)| (*m, *v)).collect()
}

/// Whether the flux through a point of the boundary depends on the solution.
fn needs_sample<const D: usize>(wall: &Wall<D>) -> bool {
    matches!(wall.condition, Condition::Dirichlet(_) | Condition::Robin { .. })
}

/// `eta du/dn` with n out of the domain: what enters.
fn entering<const D: usize>(wall: &Wall<D>, eta: f64, sample: Option<&Sample<D>>) -> Option<f64> {
    match wall.condition {
        Condition::Dirichlet(_) => sample.map(|s| eta * dot(&s.gradient, &wall.element.normal)),
        Condition::Neumann(slope) => Some(eta * slope),
        Condition::Flux(flux) => Some(flux),
        Condition::Robin { a, b, g } => sample.map(|s| (g - a * s.value) / b),
    }
}

fn dot<const D: usize>(a: &[f64; D], b: &[f64; D]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
