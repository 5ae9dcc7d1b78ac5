//! A variable that has become a number.

use std::sync::Arc;

use crate::node::Node;
use crate::simplify::constant;

/// The tree with `value` in place of the variable; what has become constant is folded, as the parser folds.
pub(crate) fn substitute(node: &Arc<Node>, variable: usize, value: f64) -> Arc<Node> {
    let inner = |a: &Arc<Node>| substitute(a, variable, value);
    match &**node {
        Node::Variable(index) if *index == variable => constant(value),
        Node::Constant(_) | Node::Variable(_) => node.clone(),
        Node::Unary(op, a) => Node::unary(*op, inner(a)),
        Node::Binary(op, a, b) => Node::binary(*op, inner(a), inner(b)),
        Node::If(c, a, b) => Node::select(inner(c), inner(a), inner(b)),
    }
}
