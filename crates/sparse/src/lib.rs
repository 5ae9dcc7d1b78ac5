//! Sparse systems in difference form: assembly, direct and Krylov solvers, preconditioners
