//! The tree that the parser builds.

use std::sync::Arc;

use crate::ops::{Binary, Unary, select};

/// One operation; operands are shared, so a derivative costs no copy of what it is taken of.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Node {
    Constant(f64),
    Variable(usize),
    Unary(Unary, Arc<Node>),
    Binary(Binary, Arc<Node>, Arc<Node>),
    If(Arc<Node>, Arc<Node>, Arc<Node>),
}

impl Node {
    pub(crate) fn constant(&self) -> Option<f64> {
        if let Self::Constant(value) = self { Some(*value) } else { None }
    }

    pub(crate) fn is(&self, value: f64) -> bool {
        self.constant() == Some(value)
    }

    /// `op a`, folded where the operand is constant and the result finite.
    ///
    /// A result that is not finite keeps its tree, so that it can be shown as it was written.
    pub(crate) fn unary(op: Unary, a: Arc<Self>) -> Arc<Self> {
        if let Some(value) = a.constant().map(|a| op.apply(a)).filter(|value| value.is_finite()) {
            return Arc::new(Self::Constant(value));
        }
        Arc::new(Self::Unary(op, a))
    }

    /// `a op b`, folded likewise.
    pub(crate) fn binary(op: Binary, a: Arc<Self>, b: Arc<Self>) -> Arc<Self> {
        if let (Some(x), Some(y)) = (a.constant(), b.constant()) {
            let value = op.apply(x, y);
            if value.is_finite() {
                return Arc::new(Self::Constant(value));
            }
        }
        Arc::new(Self::Binary(op, a, b))
    }

    /// `if(condition, a, b)`, folded where the condition is constant.
    pub(crate) fn select(condition: Arc<Self>, a: Arc<Self>, b: Arc<Self>) -> Arc<Self> {
        match condition.constant() {
            Some(value) if !value.is_nan() => {
                if select(value, 1.0, 0.0) == 1.0 {
                    a
                } else {
                    b
                }
            }
            _ => Arc::new(Self::If(condition, a, b)),
        }
    }
}
