//! Constructors that drop zeros and ones; used for derivatives only.
//!
//! What a user wrote is left alone: `0*log(x)` is NaN for negative x, and that has to show.

use std::sync::Arc;

use crate::node::Node;
use crate::ops::{Binary, Unary};

pub(crate) fn constant(value: f64) -> Arc<Node> {
    Arc::new(Node::Constant(value))
}

pub(crate) fn neg(a: Arc<Node>) -> Arc<Node> {
    match &*a {
        Node::Unary(Unary::Neg, inner) => inner.clone(),
        _ => Node::unary(Unary::Neg, a),
    }
}

pub(crate) fn add(a: Arc<Node>, b: Arc<Node>) -> Arc<Node> {
    match (&*a, &*b) {
        _ if a.is(0.0) => b,
        _ if b.is(0.0) => a,
        (_, Node::Unary(Unary::Neg, b)) => sub(a, b.clone()),
        _ => Node::binary(Binary::Add, a, b),
    }
}

pub(crate) fn sub(a: Arc<Node>, b: Arc<Node>) -> Arc<Node> {
    match &*b {
        _ if b.is(0.0) => a,
        _ if a.is(0.0) => neg(b),
        Node::Unary(Unary::Neg, b) => add(a, b.clone()),
        _ => Node::binary(Binary::Sub, a, b),
    }
}

/// Constants move to the front and merge: `2*(3*x)` is `6*x`.
pub(crate) fn mul(a: Arc<Node>, b: Arc<Node>) -> Arc<Node> {
    match (&*a, &*b) {
        _ if a.is(0.0) || b.is(0.0) => constant(0.0),
        _ if a.is(1.0) => b,
        _ if b.is(1.0) => a,
        _ if a.is(-1.0) => neg(b),
        _ if b.is(-1.0) => neg(a),
        (Node::Constant(x), Node::Binary(Binary::Mul, left, right)) => match left.constant() {
            Some(y) if (x * y).is_finite() => mul(constant(x * y), right.clone()),
            _ => Node::binary(Binary::Mul, a, b),
        },
        (Node::Constant(_), _) => Node::binary(Binary::Mul, a, b),
        (_, Node::Constant(_)) => mul(b, a),
        (Node::Unary(Unary::Neg, a), _) => neg(mul(a.clone(), b)),
        (_, Node::Unary(Unary::Neg, b)) => neg(mul(a, b.clone())),
        _ => Node::binary(Binary::Mul, a, b),
    }
}

pub(crate) fn div(a: Arc<Node>, b: Arc<Node>) -> Arc<Node> {
    match &*a {
        _ if a.is(0.0) => a,
        _ if b.is(1.0) => a,
        Node::Unary(Unary::Neg, a) => neg(div(a.clone(), b)),
        _ => Node::binary(Binary::Div, a, b),
    }
}

pub(crate) fn pow(a: Arc<Node>, b: Arc<Node>) -> Arc<Node> {
    if b.is(1.0) {
        a
    } else if b.is(0.0) {
        constant(1.0)
    } else {
        Node::binary(Binary::Pow, a, b)
    }
}

pub(crate) fn square(a: Arc<Node>) -> Arc<Node> {
    pow(a, constant(2.0))
}

pub(crate) fn select(c: Arc<Node>, a: Arc<Node>, b: Arc<Node>) -> Arc<Node> {
    if a.constant().is_some_and(|value| b.is(value)) { a } else { Node::select(c, a, b) }
}
