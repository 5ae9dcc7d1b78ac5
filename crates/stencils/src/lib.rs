//! Local least-squares stencils for derivatives on scattered points
