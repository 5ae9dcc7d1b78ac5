//! How levels are made and used.

use crate::solver::SolveError;

/// How often coarse levels are visited.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum CycleKind {
    /// Once.
    V,
    /// Twice.
    #[default]
    W,
    /// By two steps of a Krylov method (Notay and Vassilevski, Numer. Linear Algebra Appl. 15, 2008): a preconditioner
    /// that is not linear, for flexible methods only.
    K,
}

/// What removes the errors that coarse levels cannot see.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum SmootherKind {
    /// Damped Jacobi.
    Jacobi,
    /// Gauss-Seidel within blocks of rows of a fixed size, Jacobi between them: forward before the coarse correction,
    /// backward after it.
    #[default]
    GaussSeidel,
    /// Gauss-Seidel by colours: rows of one colour do not see each other. Forward before, backward after.
    ColoredGaussSeidel,
    /// A Chebyshev polynomial of `D^-1 A` of second degree (Adams, Brezina, Hu and Tuminaro, J. Comput. Phys. 188, 2003): for
    /// matrices with eigenvalues near the real axis.
    Chebyshev,
    /// Incomplete factors on the pattern of the matrix, of overlapping diagonal blocks of a fixed size.
    Ilu0,
}

/// How bonds are measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum StrengthKind {
    /// By the entries of both ends.
    #[default]
    Symmetric,
    /// By how a point source spreads in two steps of relaxation (Olson, Schroder and Tuminaro, Numer. Linear Algebra Appl. 17,
    /// 2010). Ruge and Stüben's coarsening has a measure of its own.
    Evolution,
}

/// How the next level is made.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Coarsening {
    /// Aggregates of strong neighbours, prolongation smoothed by a Jacobi step.
    #[default]
    SmoothedAggregation,
    /// Pairs of pairs, prolongation constant on each (Notay, Electron. Trans. Numer. Anal. 37, 2010); meant for the K cycle.
    PairwiseAggregation,
    /// A subset of the unknowns after Ruge and Stüben, with direct interpolation from strong neighbours.
    RugeStuebenDirect,
    /// The same with extended interpolation (De Sterck, Falgout, Nolting and Yang, Numer. Linear Algebra Appl. 15, 2008), from
    /// strong neighbours of strong neighbours, too.
    RugeStuebenExtended,
}

/// How prolongation is made from aggregates.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum ProlongationKind {
    /// One damped Jacobi step.
    #[default]
    Jacobi,
    /// That, and a few steps of a Krylov method that reduce the energy of its columns on the same pattern (Olson, Schroder and
    /// Tuminaro, SIAM J. Sci. Comput. 33, 2011).
    EnergyMinimizing,
}

/// What prolongation reproduces exactly: the error that a smoother reduces least.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Candidate {
    /// The constant. Aggregates do not cross weak bonds, so at a high contrast it is one constant for each region.
    Constant,
    /// What a few sweeps of Gauss-Seidel leave of it: it falls off towards what holds the solution.
    #[default]
    Relaxed,
}

/// How residuals come to the coarse level.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Restriction {
    /// By the transpose of the prolongation.
    #[default]
    Transpose,
    /// By a restriction that is smoothed, or minimised, with the transpose of the matrix (Sala and Tuminaro, SIAM J. Sci. Comput. 31,
    /// 2008); for smoothed aggregation.
    Own,
}

/// How to make and use levels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MultigridParams {
    /// How often coarse levels are visited.
    pub cycle: CycleKind,
    /// The smoother.
    pub smoother: SmootherKind,
    /// Its sweeps before and after each coarse correction, at least 1.
    pub sweeps: usize,
    /// How the next level is made.
    pub coarsening: Coarsening,
    /// How bonds are measured.
    pub strength: StrengthKind,
    /// A bond is strong from this part of the strongest of its nodes on; between 0 and 1.
    pub threshold: f64,
    /// How prolongation is made from aggregates that are smoothed.
    pub prolongation: ProlongationKind,
    /// What prolongation reproduces exactly.
    pub candidate: Candidate,
    /// How residuals come to the coarse level.
    pub restriction: Restriction,
    /// Rows whose other entries add up to more than this many diagonals keep an unknown of their own on every level, where they
    /// are few; at least 1, infinity for none. Sums over such rows make coarse rows that no smoother copes with.
    pub keep: f64,
    /// Whether unknowns in an order without any sense are renumbered: aggregates and sweeps follow the order.
    pub renumber: bool,
    /// Unknowns up to which a level is solved directly, at least 1.
    pub coarsest: usize,
}

impl Default for MultigridParams {
    fn default() -> Self {
        Self {
            cycle: CycleKind::W,
            smoother: SmootherKind::GaussSeidel,
            sweeps: 2,
            coarsening: Coarsening::SmoothedAggregation,
            strength: StrengthKind::Symmetric,
            threshold: 0.25,
            prolongation: ProlongationKind::Jacobi,
            candidate: Candidate::Relaxed,
            restriction: Restriction::Transpose,
            keep: f64::INFINITY,
            renumber: true,
            coarsest: 400,
        }
    }
}

impl MultigridParams {
    pub(crate) fn check(&self) -> Result<(), SolveError> {
        let bad = |what, value, expected| Err(SolveError::BadParameter { what, value, expected });
        if !(0.0..1.0).contains(&self.threshold) {
            return bad("the threshold of strength", self.threshold, "it must lie in [0, 1)");
        }
        if self.keep.is_nan() || self.keep < 1.0 {
            return bad("the size of rows that are kept", self.keep, "it must be at least 1");
        }
        if self.sweeps == 0 {
            return bad("the number of sweeps", 0.0, "it must be at least 1");
        }
        if self.coarsest == 0 {
            return bad("the size of the coarsest level", 0.0, "it must be at least 1");
        }
        Ok(())
    }
}

/// The sizes of a hierarchy.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct HierarchyInfo {
    /// Unknowns and entries of every level, the finest first.
    pub levels: Vec<(usize, usize)>,
    /// Bytes of everything that was set up, without the finest matrix, which belongs to the solver.
    pub bytes: usize,
}

impl HierarchyInfo {
    /// Entries of all levels over those of the finest one.
    #[must_use]
    pub fn operator_complexity(&self) -> f64 {
        let entries: usize = self.levels.iter().map(|l| l.1).sum();
        entries as f64 / self.levels.first().map_or(1, |l| l.1.max(1)) as f64
    }

    /// Unknowns of all levels over those of the finest one.
    #[must_use]
    pub fn grid_complexity(&self) -> f64 {
        let unknowns: usize = self.levels.iter().map(|l| l.0).sum();
        unknowns as f64 / self.levels.first().map_or(1, |l| l.0.max(1)) as f64
    }
}
