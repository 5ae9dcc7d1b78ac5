//! Elliptic interface problems on point clouds: scene, plan, solution
