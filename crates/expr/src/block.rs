//! A program run over blocks of points: one short loop an instruction, which the compiler vectorises.

use crate::ops::{Binary, Unary, max, min, multiplied_power, powi, select, squared_difference, truth};
use crate::program::{Operand, Operation, Program};

/// Points a block: registers of 4 KiB, of which a first-level cache holds the few that are in use.
const BLOCK: usize = 512;

/// The values of one operand over a block.
#[derive(Clone, Copy)]
enum Lane<'a> {
    Same(f64),
    Each(&'a [f64]),
}

pub(crate) fn run<const D: usize>(program: &Program, points: &[[f64; D]], extra: &[f64], out: &mut [f64]) {
    let block = BLOCK.min(points.len());
    let mut coordinates: [Vec<f64>; D] =
        std::array::from_fn(|axis| vec![0.0; if program.reads(axis) { block } else { 0 }]);
    let mut registers = vec![vec![0.0; block]; program.registers];
    for (points, out) in points.chunks(BLOCK).zip(out.chunks_mut(BLOCK)) {
        let n = points.len();
        for (axis, coordinate) in coordinates.iter_mut().enumerate() {
            for (value, point) in coordinate.iter_mut().zip(points) {
                *value = point[axis];
            }
        }
        for (index, instruction) in program.code.iter().enumerate() {
            // The target is none of the operands, so it can leave its place while they are read.
            let mut target = std::mem::take(&mut registers[instruction.target]);
            let last = index + 1 == program.code.len();
            let values = if last { &mut *out } else { &mut target[..n] };
            execute(instruction.operation, values, |operand| {
                lane(operand, n, &coordinates, extra, &registers)
            });
            registers[instruction.target] = target;
        }
        if program.code.is_empty() {
            copy(lane(program.result, n, &coordinates, extra, &registers), out);
        }
    }
}

fn lane<'a, const D: usize>(
    operand: Operand,
    n: usize,
    coordinates: &'a [Vec<f64>; D],
    extra: &[f64],
    registers: &'a [Vec<f64>],
) -> Lane<'a> {
    match operand {
        Operand::Constant(value) => Lane::Same(value),
        Operand::Variable(index) if index < D => Lane::Each(&coordinates[index][..n]),
        Operand::Variable(index) => Lane::Same(extra[index - D]),
        Operand::Register(index) => Lane::Each(&registers[index][..n]),
    }
}

fn execute<'a>(operation: Operation, out: &mut [f64], lane: impl Fn(Operand) -> Lane<'a>) {
    match operation {
        Operation::Unary(op, a) => unary(op, lane(a), out),
        Operation::Binary(op, a, b) => binary(op, lane(a), lane(b), out),
        Operation::SquaredDifference(a, b) => zip(lane(a), lane(b), out, squared_difference),
        Operation::Select(c, a, b) => choose(lane(c), lane(a), lane(b), out),
    }
}

/// One loop for each function that is a machine instruction; the others cost a call a value anyhow.
fn unary(op: Unary, a: Lane<'_>, out: &mut [f64]) {
    match op {
        Unary::Neg => map(a, out, |a| -a),
        Unary::Abs => map(a, out, f64::abs),
        Unary::Sqrt => map(a, out, f64::sqrt),
        Unary::Exp => map(a, out, f64::exp),
        Unary::Sin => map(a, out, f64::sin),
        Unary::Cos => map(a, out, f64::cos),
        _ => map(a, out, |a| op.apply(a)),
    }
}

fn binary(op: Binary, a: Lane<'_>, b: Lane<'_>, out: &mut [f64]) {
    match op {
        Binary::Add => zip(a, b, out, |a, b| a + b),
        Binary::Sub => zip(a, b, out, |a, b| a - b),
        Binary::Mul => zip(a, b, out, |a, b| a * b),
        Binary::Div => zip(a, b, out, |a, b| a / b),
        Binary::Pow => power(a, b, out),
        Binary::Less => zip(a, b, out, |a, b| truth(a, b, a < b)),
        Binary::LessEqual => zip(a, b, out, |a, b| truth(a, b, a <= b)),
        Binary::Greater => zip(a, b, out, |a, b| truth(a, b, a > b)),
        Binary::GreaterEqual => zip(a, b, out, |a, b| truth(a, b, a >= b)),
        Binary::Equal => zip(a, b, out, |a, b| truth(a, b, a == b)),
        Binary::NotEqual => zip(a, b, out, |a, b| truth(a, b, a != b)),
        Binary::Min => zip(a, b, out, min),
        Binary::Max => zip(a, b, out, max),
        Binary::Atan2 => zip(a, b, out, f64::atan2),
    }
}

/// Small constant exponents as products, in the order in which `powi` multiplies, so that the bits agree.
fn power(a: Lane<'_>, b: Lane<'_>, out: &mut [f64]) {
    let exponent = if let Lane::Same(b) = b { multiplied_power(b) } else { None };
    match exponent {
        Some(2) => map(a, out, |a| a * a),
        Some(3) => map(a, out, |a| a * (a * a)),
        Some(4) => map(a, out, |a| (a * a) * (a * a)),
        Some(n) => map(a, out, |a| powi(a, n)),
        None => zip(a, b, out, |a, b| Binary::Pow.apply(a, b)),
    }
}

#[inline]
fn map(a: Lane<'_>, out: &mut [f64], f: impl Fn(f64) -> f64) {
    match a {
        Lane::Same(a) => out.fill(f(a)),
        Lane::Each(a) => {
            for (out, a) in out.iter_mut().zip(a) {
                *out = f(*a);
            }
        }
    }
}

#[inline]
fn zip(a: Lane<'_>, b: Lane<'_>, out: &mut [f64], f: impl Fn(f64, f64) -> f64) {
    match (a, b) {
        (Lane::Same(a), Lane::Same(b)) => out.fill(f(a, b)),
        (Lane::Same(a), b) => map(b, out, |b| f(a, b)),
        (a, Lane::Same(b)) => map(a, out, |a| f(a, b)),
        (Lane::Each(a), Lane::Each(b)) => {
            for ((out, a), b) in out.iter_mut().zip(a).zip(b) {
                *out = f(*a, *b);
            }
        }
    }
}

fn choose(c: Lane<'_>, a: Lane<'_>, b: Lane<'_>, out: &mut [f64]) {
    let at = |lane: Lane<'_>, i: usize| match lane {
        Lane::Same(value) => value,
        Lane::Each(values) => values[i],
    };
    for i in 0..out.len() {
        out[i] = select(at(c, i), at(a, i), at(b, i));
    }
}

fn copy(a: Lane<'_>, out: &mut [f64]) {
    map(a, out, |a| a);
}
