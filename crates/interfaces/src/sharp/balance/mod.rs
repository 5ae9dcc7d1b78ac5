//! Balances of heat over cells in place of collocation, where a stencil crosses an interface.
//!
//! The row "the value of a node is what others predict" balances nothing: what leaves a heated body is what the fits happen to make of it.
//! The row of a node here is `-sum F = int f` over the part of its region that is nearer to it than to any other node of that
//! region, with one flux F for each face that both cells beside it share.

mod curve;
mod faces;
mod flux;

use std::collections::BTreeMap;

use meshless_geometry::gauss;

use super::maker::{Maker, Row, Scratch};
use super::params::Conservation;
use crate::{MethodError, parallel};
use faces::{Face, Faces};
use flux::Flux;

/// Points along the way from a node to its cell's surface at which a source is asked for.
const SOURCE_POINTS: usize = 5;

/// Puts balances in place of the rows of the nodes that are to have one, where a cell and its fluxes can be made. Returns how many
/// were.
pub(super) fn replace<const D: usize>(maker: &Maker<'_, D>, rows: &mut [Row]) -> Result<usize, MethodError> {
    let mut wanted = vec![false; maker.problem.cloud.len()];
    for row in rows.iter() {
        wanted[row.node] = match maker.params.conservation {
            Conservation::None => false,
            // Functions of a vertex are exact there, and fluxes beside it singular.
            Conservation::Crossing => match row.vertex {
                Some(vertex) => maker.vertices.get(vertex).is_narrow(),
                None => row.crosses || maker.vertices.leaves_much(&maker.problem.cloud.points()[row.node]),
            },
            Conservation::All => true,
        };
    }
    // In time a row has a mass that belongs to its collocation.
    if D != 2 || maker.rates.is_some() || !wanted.contains(&true) {
        return Ok(0);
    }
    let faces = Faces::find(maker, &wanted)?;
    let fluxes = parallel::try_map_with(faces.all.len(), Scratch::default, |scratch, k| {
        maker.flux(&faces.all[k], scratch)
    })?;
    let made = parallel::map(rows.len(), |k| balance(maker, &rows[k], &faces, &fluxes));
    let mut count = 0;
    for (row, made) in rows.iter_mut().zip(made) {
        if let Some(made) = made {
            *row = made;
            count += 1;
        }
    }
    Ok(count)
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
