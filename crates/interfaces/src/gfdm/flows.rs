//! Fluxes of a solution as balances over cells have them: through every piece of the boundary, and between regions.
//!
//! Where u is prescribed at a node, what enters there is what the balance of its cell lacks, its reaction. So where all nodes have balances
//! what enters and arises is what is stored and leaves, to round-off; with stencils among them what is left over is what these leave.

use meshless_cells::FaceKind;
use meshless_geometry::FaceId;

use super::conservative::{BalanceScratch, CellBalance, CellRow, Crossing, NEGLIGIBLE_FACE};
use super::source::{CellPart, Parts};
use crate::{Condition, MethodError, Problem, SystemSolution, parallel};

/// What enters through a piece of the boundary.
#[derive(Debug, Clone, PartialEq)]
pub struct CellWall<const D: usize> {
    /// Its face, and its centroid.
    pub face: FaceId,
    /// See above.
    pub at: [f64; D],
    /// The region inside.
    pub region: u16,
    /// What enters.
    pub flux: f64,
    /// Length or area; 1 on the line.
    pub area: f64,
}

/// What leaves a cell for one of another region.
#[derive(Debug, Clone, PartialEq)]
pub struct CellSeam {
    /// From which region, and into which.
    pub between: [u16; 2],
    /// What leaves by conduction.
    pub flux: f64,
    /// Length or area of the face; 1 on the line.
    pub area: f64,
}

/// What the part of a cell in one region holds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CellContent {
    /// The region.
    pub region: u16,
    /// The region of the node whose cell it is.
    pub cell: u16,
    /// What arises: the integral of the source.
    pub arises: f64,
    /// What is stored, by unit of time; zero in steady problems.
    pub stored: f64,
    /// What the reaction takes up, and what the velocity carries away: the integrals of `reaction u` and of `velocity . grad u`.
    pub taken: [f64; 2],
}

/// The fluxes of a solution, and what the cells hold that they are of.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct CellFlows<const D: usize> {
    /// Through the boundary.
    pub walls: Vec<CellWall<D>>,
    /// Between regions, each pair of cells from either side.
    pub seams: Vec<CellSeam>,
    /// The parts of all cells by regions.
    pub parts: Vec<CellContent>,
}

/// What one cell has before its neighbours have given what belongs in its balance.
struct Found<const D: usize> {
    walls: Vec<CellWall<D>>,
    seams: Vec<CellSeam>,
    parts: Parts,
    /// What leaves through all faces but those whose flux is the reaction of a prescribed value.
    leaves: f64,
    /// What the velocity carries away of that.
    carried: f64,
    /// Places among the walls through which the reaction enters.
    held: Vec<usize>,
}

/// Those of all cells.
pub(super) fn cell_flows<const D: usize>(
    problem: &Problem<'_, D>,
    solution: &SystemSolution,
) -> Result<CellFlows<D>, MethodError> {
    let balance = CellBalance::new(problem)?;
    let known = problem.dirichlet();
    let mut cells = parallel::try_map_with(
        problem.cloud.len(),
        || balance.scratch(),
        |scratch, i| balance.flows(i, known[i].is_some(), &solution.u, scratch),
    )?;
    for i in 0..cells.len() {
        for (j, part) in std::mem::take(&mut cells[i].parts.given) {
            cells[j as usize].parts.kept.push(part);
        }
    }
    let mut all = CellFlows::default();
    for (i, cell) in cells.into_iter().enumerate() {
        let rate = solution.rates.as_ref().map_or(0.0, |rates| rates[i]);
        cell.finish((solution.u[i], rate), &mut all);
    }
    Ok(all)
}

impl<const D: usize> Found<D> {
    /// Adds the flows of a cell whose parts are complete, of a node with this value and rate of change.
    fn finish(self, (u, rate): (f64, f64), all: &mut CellFlows<D>) {
        let Self { mut walls, mut seams, parts, leaves, carried, held } = self;
        let content = |part: &CellPart| CellContent {
            region: part.region,
            cell: part.cell,
            arises: part.source,
            stored: rate * part.capacity,
            taken: [part.reaction * u, 0.0],
        };
        let mut contents: Vec<CellContent> = parts.kept.iter().map(content).collect();
        let gone: f64 = contents.iter().map(|part| part.stored + part.taken[0] - part.arises).sum();
        let area: f64 = held.iter().map(|&k| walls[k].area).sum();
        held.iter().for_each(|&k| walls[k].flux = (leaves + gone) * walls[k].area / area);
        if let Some(own) = contents.iter_mut().find(|part| part.region == part.cell) {
            own.taken[1] = carried;
        }
        all.walls.append(&mut walls);
        all.seams.append(&mut seams);
        all.parts.append(&mut contents);
    }
}

impl<const D: usize> CellBalance<'_, D> {
    /// What leaves the cell of node i, and what it holds.
    fn flows(
        &self,
        i: usize,
        prescribed: bool,
        u: &[f64],
        scratch: &mut BalanceScratch<'_, D>,
    ) -> Result<Found<D>, MethodError> {
        let problem = self.problem;
        let cell = self.cell(i, scratch)?;
        let parts = self.parts(i, &cell, &|_| true, scratch)?;
        let (walls, seams, held) = (Vec::new(), Vec::new(), Vec::new());
        let mut found = Found { walls, seams, parts, leaves: 0.0, carried: 0.0, held };
        let negligible = NEGLIGIBLE_FACE * cell.faces.iter().fold(0.0_f64, |a, f| a.max(f.area));
        for face in cell.faces.iter().filter(|f| f.area > negligible) {
            match face.kind {
                FaceKind::Neighbor(j) => {
                    let Crossing { conducts, partition, given, in_row } = self.crossing(i, j, face);
                    let drop = match partition[0] == partition[1] {
                        true => (u[i] - u[j as usize]) / partition[0],
                        false => u[i] / partition[0] - u[j as usize] / partition[1],
                    };
                    let (leaves, flux) = (in_row[0] * drop - in_row[1], conducts * drop - given);
                    found.leaves += leaves;
                    found.carried += leaves - flux;
                    let between = [i, j as usize].map(|k| problem.labels[k]);
                    if between[0] != between[1] {
                        found.seams.push(CellSeam { between, flux, area: face.area });
                    }
                }
                FaceKind::Boundary(id) => {
                    let (face_id, at) = (FaceId(id), face.centroid);
                    let condition = problem.boundary.condition(face_id, &at);
                    let flux = if prescribed && matches!(condition, Some(Condition::Dirichlet(_))) {
                        found.held.push(found.walls.len());
                        0.0
                    } else {
                        let mut row = CellRow::default();
                        self.boundary_face(i, face_id, face, &mut row)?;
                        row.rhs - row.row_sum * u[i]
                    };
                    found.leaves -= flux;
                    let region = problem.labels[i];
                    found.walls.push(CellWall { face: face_id, at, region, flux, area: face.area });
                }
            }
        }
        Ok(found)
    }
}
