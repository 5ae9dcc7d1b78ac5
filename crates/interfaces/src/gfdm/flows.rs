//! Fluxes of a solution as balances over cells have them: through every piece of the boundary, and between regions.
//!
//! Where u is prescribed at a node, what enters there is what the balance of its cell lacks, its reaction. So where all nodes have balances
//! what enters and arises is what is stored and leaves, to round-off; with stencils among them what is left over is what these leave.

use meshless_cells::FaceKind;
use meshless_geometry::FaceId;

use super::conservative::{BalanceScratch, CellBalance, CellRow, Crossing, NEGLIGIBLE_FACE};
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

/// Those of all cells.
pub(super) fn cell_flows<const D: usize>(
    problem: &Problem<'_, D>,
    solution: &SystemSolution,
) -> Result<CellFlows<D>, MethodError> {
    let balance = CellBalance::new(problem)?.sharing(|_| true)?;
    let known = problem.dirichlet();
    let cells = parallel::try_map_with(
        problem.cloud.len(),
        || balance.scratch(),
        |scratch, i| balance.flows(i, known[i].is_some(), solution, scratch),
    )?;
    let mut all = CellFlows::default();
    for mut cell in cells {
        all.walls.append(&mut cell.walls);
        all.seams.append(&mut cell.seams);
        all.parts.append(&mut cell.parts);
    }
    Ok(all)
}

impl<const D: usize> CellBalance<'_, D> {
    /// The fluxes of one cell.
    fn flows(
        &self,
        i: usize,
        prescribed: bool,
        solution: &SystemSolution,
        scratch: &mut BalanceScratch<'_, D>,
    ) -> Result<CellFlows<D>, MethodError> {
        let (problem, u) = (self.problem, &solution.u);
        let cell = self.cell(i, scratch)?;
        let rate = solution.rates.as_ref().map_or(0.0, |rates| rates[i]);
        let content = |part: super::source::CellPart| CellContent {
            region: part.region,
            cell: part.cell,
            arises: part.source,
            stored: rate * part.capacity,
            taken: [part.reaction * u[i], 0.0],
        };
        let parts: Vec<CellContent> = self.parts(i, &cell, scratch)?.into_iter().map(content).collect();
        let mut lacks: f64 = parts.iter().map(|part| part.stored + part.taken[0] - part.arises).sum();
        let mut carried = 0.0;
        let mut flows = CellFlows { parts, ..CellFlows::default() };
        // Pieces of the boundary through which the reaction enters.
        let mut held: Vec<usize> = Vec::new();
        let negligible = NEGLIGIBLE_FACE * cell.faces.iter().fold(0.0_f64, |a, f| a.max(f.area));
        for face in cell.faces.iter().filter(|f| f.area > negligible) {
            let mut row = CellRow { entries: Vec::new(), row_sum: 0.0, rhs: 0.0, volume: 0.0, capacity: 0.0 };
            match face.kind {
                FaceKind::Neighbor(j) => {
                    let Crossing { conducts, partition, given, in_row } = self.crossing(i, j, face);
                    let drop = match partition[0] == partition[1] {
                        true => (u[i] - u[j as usize]) / partition[0],
                        false => u[i] / partition[0] - u[j as usize] / partition[1],
                    };
                    let leaves = in_row[0] * drop - in_row[1];
                    let flux = conducts * drop - given;
                    lacks += leaves;
                    carried += leaves - flux;
                    let between = [i, j as usize].map(|k| problem.labels[k]);
                    if between[0] != between[1] {
                        flows.seams.push(CellSeam { between, flux, area: face.area });
                    }
                }
                FaceKind::Boundary(id) => {
                    let (face_id, at) = (FaceId(id), face.centroid);
                    let condition = problem.boundary.condition(face_id, &at);
                    let flux = if prescribed && matches!(condition, Some(Condition::Dirichlet(_))) {
                        held.push(flows.walls.len());
                        0.0
                    } else {
                        self.boundary_face(i, face_id, face, &mut row)?;
                        row.rhs - row.row_sum * u[i]
                    };
                    lacks -= flux;
                    let region = problem.labels[i];
                    flows.walls.push(CellWall { face: face_id, at, region, flux, area: face.area });
                }
            }
        }
        let area: f64 = held.iter().map(|&k| flows.walls[k].area).sum();
        held.iter().for_each(|&k| flows.walls[k].flux = lacks * flows.walls[k].area / area);
        if let Some(own) = flows.parts.iter_mut().find(|part| part.region == part.cell) {
            own.taken[1] = carried;
        }
        Ok(flows)
    }
}
