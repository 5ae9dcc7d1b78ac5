use super::BoundaryNode;
use crate::error::GeometryError;
use crate::vector::{is_finite, norm};

/// How far from one a normal's length may be.
const UNIT_TOLERANCE: f64 = 1e-9;

pub(super) fn check<const D: usize>(
    points: &[[f64; D]],
    boundary: &[BoundaryNode<D>],
    spacing: &[f64],
) -> Result<(), GeometryError> {
    let n = points.len();
    if n >= u32::MAX as usize {
        return Err(GeometryError::cloud(format!("{n} nodes, more than 32-bit indices can tell apart")));
    }
    if spacing.len() != n {
        return Err(GeometryError::cloud(format!("{} spacings for {n} nodes", spacing.len())));
    }
    if let Some(i) = points.iter().position(|p| !is_finite(p)) {
        return Err(GeometryError::cloud(format!("node {i} at {:?} is not finite", points[i])));
    }
    if let Some(i) = spacing.iter().position(|h| !(h.is_finite() && *h > 0.0)) {
        return Err(GeometryError::cloud(format!("the spacing {} of node {i} is not positive", spacing[i])));
    }
    let mut seen = vec![false; n];
    for b in boundary {
        let i = b.node as usize;
        if i >= n {
            return Err(GeometryError::cloud(format!("boundary node {i} of {n} nodes")));
        }
        if std::mem::replace(&mut seen[i], true) {
            return Err(GeometryError::cloud(format!("node {i} is named twice as a boundary node")));
        }
        if b.touches.is_empty() {
            return Err(GeometryError::cloud(format!("boundary node {i} touches no face")));
        }
        for t in &b.touches {
            let length = norm(&t.normal);
            if length.is_nan() || (length - 1.0).abs() > UNIT_TOLERANCE {
                return Err(GeometryError::cloud(format!("a normal of node {i} has length {length}, not 1")));
            }
        }
    }
    Ok(())
}

/// The inverse of a permutation of `0..n`.
pub(super) fn inverse_permutation(order: &[u32], n: usize) -> Result<Vec<u32>, GeometryError> {
    if order.len() != n {
        return Err(GeometryError::cloud(format!("an order of {} entries for {n} nodes", order.len())));
    }
    let mut inverse = vec![u32::MAX; n];
    for (k, &i) in order.iter().enumerate() {
        match inverse.get_mut(i as usize) {
            Some(slot) if *slot == u32::MAX => *slot = k as u32,
            Some(_) => return Err(GeometryError::cloud(format!("the order names node {i} twice"))),
            None => return Err(GeometryError::cloud(format!("the order names node {i} of {n}"))),
        }
    }
    Ok(inverse)
}
