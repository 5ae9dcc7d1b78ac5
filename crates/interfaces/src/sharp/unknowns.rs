//! The change of unknowns `u = sum_K sigma_K C_K + s w`, found from the graph of the regions.

use meshless_sparse::{DifferenceMatrix, Split};

use crate::system::FloatingParts;
use crate::{MethodError, Problem};

/// Scale and constants of every connected part of a region.
#[derive(Debug)]
pub(super) struct Unknowns {
    parts: FloatingParts,
    /// Part of every node.
    pub(super) part: Vec<u32>,
    /// Scale `s` of every part.
    pub(super) scale: Vec<f64>,
    /// Label of every part.
    pub(super) label: Vec<u16>,
    /// The constants of every part: cluster, factor.
    pub(super) chain: Vec<Vec<(u32, f64)>>,
}

impl Unknowns {
    pub(super) fn find<const D: usize>(problem: &Problem<'_, D>) -> Result<Self, MethodError> {
        let parts = FloatingParts::find(problem)?;
        let count = parts.graph.components().len();
        let part = (0..problem.cloud.len() as u32).map(|i| parts.graph.component_of(i)).collect();
        let label = parts.graph.components().iter().map(|c| c.label).collect();
        let mut scale = vec![1.0; count];
        let mut chain = vec![Vec::new(); count];
        for (k, cluster) in (0..).zip(&parts.clusters) {
            // Members beyond the parts stand for what is outside of the domain.
            for &member in cluster.members.iter().filter(|&&m| (m as usize) < count) {
                chain[member as usize].push((k, cluster.factor));
            }
            for (&own, &s) in cluster.own.iter().zip(&cluster.scales).filter(|(m, _)| (**m as usize) < count)
            {
                scale[own as usize] = s;
            }
        }
        Ok(Self { parts, part, scale, label, chain })
    }

    /// Constants that are unknowns of their own.
    pub(super) fn constants(&self) -> usize {
        self.parts.clusters.len()
    }

    /// The change of unknowns for a matrix whose rows act on `w`, over all nodes.
    pub(super) fn split(&self, rows: &DifferenceMatrix) -> Result<Split, MethodError> {
        Ok(Split::from_clusters(rows, &self.part, self.scale.len(), &self.parts.clusters)?)
    }
}
