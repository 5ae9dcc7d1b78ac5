//! Symbolic differentiation.
//!
//! Every rule names the derivative of each operand once, so that the result of a nested expression grows with the
//! square of its size at most.

use std::sync::Arc;

use crate::node::Node;
use crate::ops::{Binary, Unary};
use crate::simplify::{add, constant, div, mul, neg, pow, select, square, sub};

pub(crate) fn derivative(node: &Arc<Node>, variable: usize) -> Arc<Node> {
    match &**node {
        Node::Constant(_) => constant(0.0),
        Node::Variable(index) => constant(f64::from(u8::from(*index == variable))),
        Node::Unary(op, a) => {
            let da = derivative(a, variable);
            if da.is(0.0) { da } else { unary(*op, node, a, da) }
        }
        Node::Binary(op, _, _) if op.is_comparison() => constant(0.0),
        Node::Binary(op, a, b) => {
            let (da, db) = (derivative(a, variable), derivative(b, variable));
            if da.is(0.0) && db.is(0.0) { da } else { binary(*op, node, a, b, da, db) }
        }
        Node::If(c, a, b) => select(c.clone(), derivative(a, variable), derivative(b, variable)),
    }
}

fn unary(op: Unary, node: &Arc<Node>, a: &Arc<Node>, da: Arc<Node>) -> Arc<Node> {
    let one = || constant(1.0);
    let a = || a.clone();
    let value = || node.clone();
    match op {
        Unary::Neg => neg(da),
        Unary::Sqrt => div(da, mul(constant(2.0), value())),
        Unary::Exp => mul(da, value()),
        Unary::Log => div(da, a()),
        Unary::Sin => mul(da, Node::unary(Unary::Cos, a())),
        Unary::Cos => neg(mul(da, Node::unary(Unary::Sin, a()))),
        Unary::Tan => mul(da, add(one(), square(value()))),
        Unary::Asin => div(da, Node::unary(Unary::Sqrt, sub(one(), square(a())))),
        Unary::Acos => neg(div(da, Node::unary(Unary::Sqrt, sub(one(), square(a()))))),
        Unary::Atan => div(da, add(one(), square(a()))),
        Unary::Sinh => mul(da, Node::unary(Unary::Cosh, a())),
        Unary::Cosh => mul(da, Node::unary(Unary::Sinh, a())),
        // Not 1 - tanh^2, which cancels.
        Unary::Tanh => div(da, square(Node::unary(Unary::Cosh, a()))),
        Unary::Abs => mul(da, sign(a())),
    }
}

/// 1, 0 or -1; at the kink of |a| the mean of both slopes.
fn sign(a: Arc<Node>) -> Arc<Node> {
    sub(Node::binary(Binary::Greater, a.clone(), constant(0.0)), Node::binary(Binary::Less, a, constant(0.0)))
}

fn binary(
    op: Binary,
    node: &Arc<Node>,
    a: &Arc<Node>,
    b: &Arc<Node>,
    da: Arc<Node>,
    db: Arc<Node>,
) -> Arc<Node> {
    let (value, a, b) = (|| node.clone(), || a.clone(), || b.clone());
    match op {
        Binary::Add => add(da, db),
        Binary::Sub => sub(da, db),
        Binary::Mul => add(mul(da, b()), mul(a(), db)),
        // As da/b - (a/b) db/b the quotient neither overflows nor squares b.
        Binary::Div => div(sub(da, mul(value(), db)), b()),
        Binary::Pow if db.is(0.0) => mul(mul(b(), pow(a(), sub(b(), constant(1.0)))), da),
        Binary::Pow if da.is(0.0) => mul(mul(Node::unary(Unary::Log, a()), value()), db),
        Binary::Pow => mul(value(), add(mul(db, Node::unary(Unary::Log, a())), div(mul(b(), da), a()))),
        Binary::Min => select(Node::binary(Binary::Less, a(), b()), da, db),
        Binary::Max => select(Node::binary(Binary::Greater, a(), b()), da, db),
        // d atan2(a, b) = (b da - a db) / (a^2 + b^2), with atan2(a, b) the angle of the point (b, a).
        Binary::Atan2 => div(sub(mul(b(), da), mul(a(), db)), add(square(a()), square(b()))),
        Binary::Less
        | Binary::LessEqual
        | Binary::Greater
        | Binary::GreaterEqual
        | Binary::Equal
        | Binary::NotEqual => constant(0.0),
    }
}
