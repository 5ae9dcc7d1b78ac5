//! An expression as text that parses to the same values.

use std::fmt::{Formatter, Result, Write};

use crate::node::Node;
use crate::ops::{Binary, Unary};
use crate::parser::binding_power;

/// Binding powers as in the parser: a sign stands above products and below powers.
const SIGN: u8 = 4;
const ATOM: u8 = 6;

/// Writes the node, in parentheses where it binds less than `least`.
pub(crate) fn write(f: &mut Formatter<'_>, node: &Node, names: &[String], least: u8) -> Result {
    let grouped = strength(node) < least;
    if grouped {
        f.write_char('(')?;
    }
    match node {
        Node::Constant(value) => number(f, *value)?,
        Node::Variable(index) => match names.get(*index) {
            Some(name) => f.write_str(name)?,
            None => write!(f, "v{index}")?,
        },
        Node::Unary(Unary::Neg, a) => {
            f.write_char('-')?;
            write(f, a, names, SIGN)?;
        }
        Node::Unary(op, a) => call(f, op.name(), &[a], names)?,
        Node::Binary(op @ (Binary::Min | Binary::Max | Binary::Atan2), a, b) => {
            call(f, op.name(), &[a, b], names)?;
        }
        Node::Binary(op, a, b) => infix(f, *op, a, b, names)?,
        Node::If(c, a, b) => call(f, "if", &[c, a, b], names)?,
    }
    if grouped { f.write_char(')') } else { Ok(()) }
}

fn strength(node: &Node) -> u8 {
    match node {
        Node::Constant(value) if value.is_finite() && value.is_sign_positive() => ATOM,
        Node::Constant(value) if value.is_finite() => SIGN,
        // Written as a quotient.
        Node::Constant(_) => binding_power(Binary::Div),
        Node::Unary(Unary::Neg, _) => SIGN,
        Node::Binary(Binary::Min | Binary::Max | Binary::Atan2, _, _) => ATOM,
        Node::Binary(op, _, _) => binding_power(*op),
        Node::Variable(_) | Node::Unary(..) | Node::If(..) => ATOM,
    }
}

fn infix(f: &mut Formatter<'_>, op: Binary, a: &Node, b: &Node, names: &[String]) -> Result {
    let power = binding_power(op);
    let (left, right) = match op {
        Binary::Pow => (ATOM, SIGN),
        Binary::Add | Binary::Sub | Binary::Mul | Binary::Div => (power, power + 1),
        // Comparisons do not chain.
        _ => (power + 1, power + 1),
    };
    write(f, a, names, left)?;
    match op {
        Binary::Mul | Binary::Div | Binary::Pow => f.write_str(op.name())?,
        _ => write!(f, " {} ", op.name())?,
    }
    write(f, b, names, right)
}

fn call(f: &mut Formatter<'_>, name: &str, arguments: &[&Node], names: &[String]) -> Result {
    write!(f, "{name}(")?;
    for (index, argument) in arguments.iter().enumerate() {
        if index > 0 {
            f.write_str(", ")?;
        }
        write(f, argument, names, 0)?;
    }
    f.write_char(')')
}

/// The shortest digits that read back to the same number; a quotient for what no literal can say.
fn number(f: &mut Formatter<'_>, value: f64) -> Result {
    if value.is_nan() {
        f.write_str("0/0")
    } else if value.is_infinite() {
        f.write_str(if value > 0.0 { "1/0" } else { "-1/0" })
    } else if value == std::f64::consts::PI {
        f.write_str("pi")
    } else if value.abs() < 1e16 && value.fract() == 0.0 {
        write!(f, "{value}")
    } else {
        write!(f, "{value:?}")
    }
}
