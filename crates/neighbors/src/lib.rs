//! Neighbour lists of point clouds: fixed and variable radius, k nearest
