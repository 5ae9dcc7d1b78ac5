//! The change of unknowns `u_i = sum_K sigma_K C_K + s_i w_i`.

use super::bordered::Bordered;
use super::clusters::Cluster;
use crate::csr::for_each_row;
use crate::difference::DifferenceMatrix;
use crate::error::MatrixError;

/// A cluster that a group belongs to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChainLink {
    /// Index of the cluster.
    pub cluster: u32,
    /// Factor `sigma` of the cluster's constant in this group.
    pub factor: f64,
}

/// The unknowns of a group of nodes.
#[derive(Debug, Clone, PartialEq)]
pub struct GroupUnknowns {
    /// Scale `s` of the nodes' own unknowns `w`; positive.
    pub scale: f64,
    /// The clusters round the group, the outermost first.
    pub chain: Vec<ChainLink>,
}

impl GroupUnknowns {
    fn factor(&self, cluster: u32) -> f64 {
        self.chain.iter().find(|link| link.cluster == cluster).map_or(0.0, |link| link.factor)
    }
}

/// The change of unknowns `u_i = sum_{K in chain(i)} sigma_K C_K + s_i w_i`.
///
/// A stiff region that nothing but soft surroundings holds has a constant `C` that the large coefficients do not
/// see. In the nodal values it drowns: they determine it only up to rounding times contrast. As an unknown
/// of its own, with coefficients formed from differences, it stays as accurate as everything else.
#[derive(Debug, Clone, PartialEq)]
pub struct Split {
    group: Vec<u32>,
    groups: Vec<GroupUnknowns>,
    pinned: Vec<u32>,
}

impl Split {
    /// `group[i]` is the group of node `i`; `pinned[K]` is a node of cluster `K` where `w = 0`. It must belong to `K`
    /// and to no cluster inside it: the last link of its chain is `K`.
    ///
    /// # Errors
    /// A group that does not exist, a scale or factor that is not finite and positive, a pin that is not in its
    /// cluster.
    pub fn new(group: Vec<u32>, groups: Vec<GroupUnknowns>, pinned: Vec<u32>) -> Result<Self, MatrixError> {
        if let Some(node) = group.iter().position(|&g| g as usize >= groups.len()) {
            return Err(MatrixError::NoSuchGroup { node, group: group[node] as usize, groups: groups.len() });
        }
        for (g, unknowns) in groups.iter().enumerate() {
            let numbers = unknowns.chain.iter().map(|link| link.factor).chain([unknowns.scale]);
            if let Some(value) = numbers.into_iter().find(|&v| !(v > 0.0 && v.is_finite())) {
                return Err(MatrixError::BadNumber { what: "scale or factor of the group", node: g, value });
            }
            if let Some(link) = unknowns.chain.iter().find(|link| link.cluster as usize >= pinned.len()) {
                return Err(MatrixError::NoPin { cluster: link.cluster as usize, reason: "none was given" });
            }
        }
        for (cluster, &node) in pinned.iter().enumerate() {
            let innermost = group.get(node as usize).and_then(|&g| groups[g as usize].chain.last());
            if innermost.is_none_or(|link| link.cluster as usize != cluster) {
                let reason = "the node given is not in it, or in a cluster inside it";
                return Err(MatrixError::NoPin { cluster, reason });
            }
        }
        Ok(Self { group, groups, pinned })
    }

    /// No cluster: `u = w`.
    #[must_use]
    pub fn trivial(n: usize) -> Self {
        let groups = vec![GroupUnknowns { scale: 1.0, chain: Vec::new() }];
        Self { group: vec![0; n], groups, pinned: Vec::new() }
    }

    /// The split that [`clusters`](crate::clusters) ask for. `component[i]` is the component of node `i` of the
    /// matrix (after elimination: of the unknown), of which there are `components`. The node pinned in a cluster
    /// is the first whose equation stays within the cluster's own components; failing that, the first.
    ///
    /// # Errors
    /// A component that does not exist, or a cluster without a node in its own components.
    pub fn from_clusters(
        matrix: &DifferenceMatrix,
        component: &[u32],
        components: usize,
        clusters: &[Cluster],
    ) -> Result<Self, MatrixError> {
        MatrixError::check_length("components of nodes", component.len(), matrix.n())?;
        let mut groups = vec![GroupUnknowns { scale: 1.0, chain: Vec::new() }; components];
        let mut owner = vec![None; components];
        for (c, cluster) in clusters.iter().enumerate() {
            for &k in cluster.members.iter().filter(|&&k| (k as usize) < components) {
                groups[k as usize].chain.push(ChainLink { cluster: c as u32, factor: cluster.factor });
            }
            for (&k, &scale) in
                cluster.own.iter().zip(&cluster.scales).filter(|(k, _)| (**k as usize) < components)
            {
                groups[k as usize].scale = scale;
                owner[k as usize] = Some(c);
            }
        }
        let owner_of = |i: usize| owner.get(component[i] as usize).copied().flatten();
        let mut first = vec![None; clusters.len()];
        let mut inner = vec![None; clusters.len()];
        for i in 0..matrix.n() {
            if let Some(c) = owner_of(i) {
                first[c].get_or_insert(i as u32);
                if matrix.row(i).0.iter().all(|&j| owner_of(j as usize) == Some(c)) {
                    inner[c].get_or_insert(i as u32);
                }
            }
        }
        let pinned = inner.iter().zip(&first).enumerate().map(|(cluster, (inner, first))| {
            inner
                .or(*first)
                .ok_or(MatrixError::NoPin { cluster, reason: "no node lies in its own components" })
        });
        Self::new(component.to_vec(), groups, pinned.collect::<Result<_, _>>()?)
    }

    /// The same with these scales of the groups, also of those that are in no cluster.
    ///
    /// # Errors
    /// A length that does not match, and scales that are not finite and positive.
    pub fn with_group_scales(mut self, scales: &[f64]) -> Result<Self, MatrixError> {
        MatrixError::check_length("scales of the groups", scales.len(), self.groups.len())?;
        self.groups.iter_mut().zip(scales).for_each(|(group, &scale)| group.scale = scale);
        Self::new(self.group, self.groups, self.pinned)
    }

    /// The same for some of the nodes, in the order of `nodes`: those that are left where values are prescribed at the others.
    ///
    /// # Errors
    /// [`MatrixError::RowOutOfRange`], and [`MatrixError::NoPin`] where the pinned node of a cluster is not among them.
    pub fn restricted(&self, nodes: &[u32]) -> Result<Self, MatrixError> {
        let mut place = vec![None; self.group.len()];
        for (k, &node) in (0..).zip(nodes) {
            let (row, nrows) = (node as usize, self.group.len());
            *place.get_mut(row).ok_or(MatrixError::RowOutOfRange { row, nrows })? = Some(k);
        }
        let pin = |(cluster, &p): (usize, &u32)| {
            place[p as usize]
                .ok_or(MatrixError::NoPin { cluster, reason: "its node is not among the unknowns" })
        };
        let pinned = self.pinned.iter().enumerate().map(pin).collect::<Result<_, _>>()?;
        Self::new(nodes.iter().map(|&node| self.group[node as usize]).collect(), self.groups.clone(), pinned)
    }

    /// Number of clusters, and so of extra unknowns.
    #[must_use]
    pub fn extra(&self) -> usize {
        self.pinned.len()
    }

    /// The pinned node of each cluster.
    #[must_use]
    pub fn pinned(&self) -> &[u32] {
        &self.pinned
    }

    /// Scale of node `i`.
    #[must_use]
    pub fn scale(&self, i: usize) -> f64 {
        self.unknowns(i).scale
    }

    pub(super) fn scales(&self) -> Vec<f64> {
        (0..self.group.len()).map(|i| self.scale(i)).collect()
    }

    fn unknowns(&self, i: usize) -> &GroupUnknowns {
        &self.groups[self.group[i] as usize]
    }

    /// The same equations in the unknowns `w` and `C`.
    ///
    /// Row `i` gives `C_K` the coefficient `sum_j a_ij (sigma_K(j) - sigma_K(i)) + r_i sigma_K(i)`, where `sigma_K` is 0
    /// outside the cluster, with only the terms added in which the two differ: it is exactly zero where the row
    /// lies in the cluster and its sum is zero, and no sum of large numbers that cancel otherwise.
    ///
    /// # Errors
    /// [`MatrixError::Length`], or an overflow of a scaled coefficient.
    pub fn apply(&self, matrix: &DifferenceMatrix, rhs: &[f64]) -> Result<Bordered, MatrixError> {
        Bordered::new(self.scaled(matrix)?, self.columns(matrix), self.pinned.clone(), rhs.to_vec())?
            .with_split(self.clone())
    }

    /// The same for a pure Neumann problem: `lambda` times `column` is added to the equations, as the last extra
    /// unknown, and `w = 0` at node `pinned`, which must be another one than those of the clusters.
    ///
    /// # Errors
    /// Those of [`Split::apply`], and a pin that is taken or out of range.
    pub fn apply_neumann(
        &self,
        matrix: &DifferenceMatrix,
        rhs: &[f64],
        column: &[f64],
        pinned: usize,
    ) -> Result<Bordered, MatrixError> {
        MatrixError::check_length("column of the incompatibility", column.len(), matrix.n())?;
        MatrixError::check_finite("column of the incompatibility", column)?;
        let mut columns = self.columns(matrix);
        let entries = column.iter().enumerate().filter(|(_, v)| **v != 0.0);
        columns.push(entries.map(|(i, &v)| (i as u32, v)).collect());
        let mut pins = self.pinned.clone();
        pins.push(pinned as u32);
        Bordered::new(self.scaled(matrix)?, columns, pins, rhs.to_vec())?.with_split(self.clone())
    }

    /// The equations as they act on `w`, again in difference form: `a_ij s_j` and the row sum
    /// `r_i s_i + sum_j a_ij (s_j - s_i)`, of which only terms between different scales are left.
    fn scaled(&self, matrix: &DifferenceMatrix) -> Result<DifferenceMatrix, MatrixError> {
        MatrixError::check_length("groups of nodes", self.group.len(), matrix.n())?;
        DifferenceMatrix::from_rows(matrix.n(), |i, row| {
            let scale = self.scale(i);
            row.add_to_row_sum(matrix.row_sum(i) * scale);
            let (columns, values) = matrix.row(i);
            for (&j, a) in columns.iter().zip(values) {
                let other = self.scale(j as usize);
                row.push(j as usize, a * other);
                if other != scale {
                    row.add_to_row_sum(a * (other - scale));
                }
            }
        })
    }

    /// Coefficients of each `C_K`, those that are not zero, by row.
    fn columns(&self, matrix: &DifferenceMatrix) -> Vec<Vec<(u32, f64)>> {
        let mut columns = vec![Vec::new(); self.extra()];
        if columns.is_empty() {
            return columns;
        }
        let mut seen: Vec<u32> = Vec::new();
        for i in 0..matrix.n() {
            let (neighbors, values) = matrix.row(i);
            let own = self.unknowns(i);
            seen.clear();
            seen.extend(own.chain.iter().map(|link| link.cluster));
            for &j in neighbors {
                if self.group[j as usize] != self.group[i] {
                    seen.extend(self.unknowns(j as usize).chain.iter().map(|link| link.cluster));
                }
            }
            seen.sort_unstable();
            seen.dedup();
            for &cluster in &seen {
                let here = own.factor(cluster);
                let mut sum = matrix.row_sum(i) * here;
                for (&j, a) in neighbors.iter().zip(values) {
                    let there = self.unknowns(j as usize).factor(cluster);
                    if there != here {
                        sum += a * (there - here);
                    }
                }
                if sum != 0.0 {
                    columns[cluster as usize].push((i as u32, sum));
                }
            }
        }
        columns
    }

    /// `w` and `C` from `u`: the pinned nodes tell the constants.
    ///
    /// # Errors
    /// [`MatrixError::Length`].
    pub fn unknowns_of(&self, u: &[f64]) -> Result<(Vec<f64>, Vec<f64>), MatrixError> {
        MatrixError::check_length("values", u.len(), self.group.len())?;
        let mut w = u.to_vec();
        let constants = self.take_constants(&mut w);
        w.iter_mut().enumerate().for_each(|(i, w)| *w /= self.scale(i));
        Ok((w, constants))
    }

    /// Takes the constants out of nodal values, which become `s w`, and gives them.
    pub(super) fn take_constants(&self, u: &mut [f64]) -> Vec<f64> {
        let mut constants = vec![0.0; self.extra()];
        let level = |g: &GroupUnknowns, constants: &[f64]| -> f64 {
            g.chain.iter().map(|link| link.factor * constants[link.cluster as usize]).sum()
        };
        // The constants of a chain from the outermost on.
        let mut order: Vec<usize> = (0..self.extra()).collect();
        order.sort_by_key(|&k| self.unknowns(self.pinned[k] as usize).chain.len());
        for k in order {
            let (node, own) = (self.pinned[k] as usize, self.unknowns(self.pinned[k] as usize));
            constants[k] = (u[node] - level(own, &constants)) / own.factor(k as u32);
        }
        let levels: Vec<f64> = self.groups.iter().map(|g| level(g, &constants)).collect();
        for_each_row(u, |i, u| *u -= levels[self.group[i] as usize]);
        constants
    }

    /// `u` from `w` and `C`. Further extra unknowns, such as `lambda`, are ignored.
    ///
    /// # Errors
    /// [`MatrixError::Length`].
    pub fn recover(&self, w: &[f64], extra: &[f64]) -> Result<Vec<f64>, MatrixError> {
        MatrixError::check_length("solution", w.len(), self.group.len())?;
        if extra.len() < self.extra() {
            let (found, expected) = (extra.len(), self.extra());
            return Err(MatrixError::Length { what: "extra unknowns", found, expected });
        }
        let constant = |g: &GroupUnknowns| -> f64 {
            g.chain.iter().map(|link| link.factor * extra[link.cluster as usize]).sum()
        };
        let constants: Vec<f64> = self.groups.iter().map(constant).collect();
        let value = |(w, &g): (&f64, &u32)| constants[g as usize] + self.groups[g as usize].scale * w;
        Ok(w.iter().zip(&self.group).map(value).collect())
    }
}
