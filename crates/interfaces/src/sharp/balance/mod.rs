//! Balances of heat over cells in place of collocation, where a stencil crosses an interface.
//!
//! The row "the value of a node is what others predict" balances nothing: what leaves a heated body is what the fits happen to make of it.
//! The row of a node here is `-sum F = int f` over the part of its region that is nearer to it than to any other node of that
//! region, with one flux F for each face that both cells beside it share.

mod curve;
mod faces;
mod facet;
mod flux;
mod plane;
mod space;

use std::collections::BTreeMap;

use meshless_geometry::gauss;

use super::maker::{Maker, Row};
use super::params::Conservation;
use crate::{InterfaceFlux, MethodError, parallel};
use faces::{Beyond, Face, Faces};
use flux::Flux;

/// Exchange over the conductance of one spacing from which on it holds a value. With 1 the flux of ISO 10211 case 4 is 3.7 % off for 1.8 %.
const HOLDS: f64 = 30.0;

/// Points along the way from a node to its cell's surface at which a source is asked for.
const SOURCE_POINTS: usize = 5;

/// Puts balances in place of the rows of the nodes that are to have one, where a cell and its fluxes can be made. Returns the fluxes
/// through interfaces.
pub(super) fn replace<const D: usize>(
    maker: &Maker<'_, D>,
    rows: &mut [Row],
) -> Result<Vec<InterfaceFlux>, MethodError> {
    let mut wanted = vec![false; maker.problem.cloud.len()];
    for row in rows.iter() {
        wanted[row.node] = match maker.params.conservation {
            Conservation::None => false,
            // Functions of a vertex are exact there, and fluxes beside it singular; those of an edge end where that does.
            Conservation::Crossing => match row.vertex.map(|vertex| maker.vertices.get(vertex)) {
                Some(vertex) if !vertex.is_edge() => vertex.is_narrow(),
                _ => row.crosses || maker.vertices.leaves_much(&maker.problem.cloud.points()[row.node]),
            },
            Conservation::All => true,
        } && !holds(maker, row.node);
    }
    // In time a row has a mass that belongs to its collocation.
    if !maker.may_balance() || !wanted.contains(&true) {
        return Ok(Vec::new());
    }
    let faces = Faces::find(maker, &wanted)?;
    let fluxes = maker.fluxes(&faces.all)?;
    let made = parallel::map(rows.len(), |k| balance(maker, &rows[k], &faces, &fluxes));
    for (row, made) in rows.iter_mut().zip(made) {
        if let Some(made) = made {
            *row = made;
        }
    }
    Ok(if has_edges(maker) { through_interfaces(maker, &faces, &fluxes) } else { Vec::new() })
}

/// Whether a wall exchanges so much with what is outside that it all but prescribes the value of a node. The balance of such a node would
/// be that of its wall alone, in which its own value is one of many: where an interface is near, such rows have solutions of high frequency.
fn holds<const D: usize>(maker: &Maker<'_, D>, i: usize) -> bool {
    let way = maker.problem.cloud.spacing()[i] / maker.problem.eta[i];
    maker.boundary_rows[i].iter().any(|row| row.exchange * way > HOLDS)
}

/// Whether slopes are infinite at edges in space, along which their integrals find no size. In the plane those stay: beside a vertex without
/// functions what they leave over says how far the solution is off.
fn has_edges<const D: usize>(maker: &Maker<'_, D>) -> bool {
    D == 3 && !maker.vertices.corners.is_empty()
}

/// The flux through the interface of every two regions, where the fluxes of all of its faces are known.
fn through_interfaces<const D: usize>(
    maker: &Maker<'_, D>,
    faces: &Faces<D>,
    fluxes: &[Option<Flux>],
) -> Vec<InterfaceFlux> {
    #[derive(Default)]
    struct Sum {
        area: f64,
        values: BTreeMap<u32, f64>,
        constants: BTreeMap<u32, f64>,
        known: [f64; 2],
    }
    let mut sums: BTreeMap<[u16; 2], Sum> = BTreeMap::new();
    for (face, flux) in faces.all.iter().zip(fluxes) {
        let Beyond::Node(other) = face.beyond else { continue };
        let [first, second] = [face.node, other].map(|j| maker.problem.labels[j as usize]);
        let Some(flux) = flux.as_ref().filter(|_| first != second) else { continue };
        let sign = if first < second { 1.0 } else { -1.0 };
        let sum = sums.entry([first.min(second), first.max(second)]).or_default();
        sum.area += face.area;
        flux.values.iter().for_each(|(j, factor)| *sum.values.entry(*j).or_default() += sign * factor);
        flux.constants.iter().for_each(|(c, factor)| *sum.constants.entry(*c).or_default() += sign * factor);
        for side in [0, 1] {
            sum.known[if first < second { side } else { 1 - side }] += sign * flux.known[side];
        }
    }
    let flux = |(between, sum): ([u16; 2], Sum)| InterfaceFlux {
        between,
        area: sum.area,
        values: sum.values.into_iter().collect(),
        constants: sum.constants.into_iter().collect(),
        known: sum.known,
    };
    sums.into_iter().map(flux).collect()
}

/// The balance over the cell of a node; `None` where there is none.
fn balance<const D: usize>(
    maker: &Maker<'_, D>,
    row: &Row,
    faces: &Faces<D>,
    fluxes: &[Option<Flux>],
) -> Option<Row> {
    let own = &faces.of_node[row.node];
    if own.is_empty() {
        return None;
    }
    let mut entries: BTreeMap<u32, f64> = BTreeMap::new();
    let mut constants: BTreeMap<u32, f64> = BTreeMap::new();
    let (mut row_sum, mut rhs) = (0.0, source(maker, row.node, own, &faces.all)?);
    for &(place, is_first) in own {
        let flux = fluxes[place].as_ref()?;
        let sign = if is_first { -1.0 } else { 1.0 };
        flux.values.iter().for_each(|(j, factor)| *entries.entry(*j).or_default() += sign * factor);
        flux.constants.iter().for_each(|(c, factor)| *constants.entry(*c).or_default() += sign * factor);
        row_sum += sign * flux.sum;
        rhs -= sign * flux.known[usize::from(!is_first)];
    }
    let diagonal = entries.remove(&(row.node as u32)).unwrap_or(0.0);
    if !(diagonal > 0.0 && rhs.is_finite()) {
        return None;
    }
    let (neighbors, coefficients) = entries.into_iter().unzip();
    Some(Row {
        neighbors,
        coefficients,
        row_sum,
        constants: constants.into_iter().collect(),
        rhs,
        balanced: true,
        ..row.clone()
    })
}

/// `int f` over a cell: with `g(x) = int_0^1 f(x_i + t (x - x_i)) t^(D-1) dt` the divergence of `g (x - x_i)` is f. `None` where f is
/// no number somewhere in between, and where the cell has no volume.
fn source<const D: usize>(
    maker: &Maker<'_, D>,
    i: usize,
    own: &[(usize, bool)],
    faces: &[Face<D>],
) -> Option<f64> {
    let center = &maker.problem.cloud.points()[i];
    let field = maker.problem.materials[maker.problem.labels[i] as usize].source.as_ref();
    let constant = field.map_or(Some(0.0), crate::Field::as_constant);
    let rule = gauss(SOURCE_POINTS);
    let (mut volume, mut total) = (0.0, 0.0);
    for &(place, is_first) in own {
        let sign = if is_first { 1.0 } else { -1.0 };
        for point in &faces[place].points {
            let offset: [f64; D] = std::array::from_fn(|k| point.at[k] - center[k]);
            let height = sign * point.weight * (0..D).map(|k| offset[k] * point.normal[k]).sum::<f64>();
            volume += height / D as f64;
            if let (Some(field), None) = (field, constant) {
                let sum = rule.iter().map(|(t, weight)| {
                    let x = std::array::from_fn(|k| center[k] + t * offset[k]);
                    weight * t.powi(D as i32 - 1) * field.at(&x)
                });
                total += height * sum.sum::<f64>();
            }
        }
    }
    total += constant.unwrap_or(0.0) * volume;
    (volume > 0.0 && total.is_finite()).then_some(total)
}
