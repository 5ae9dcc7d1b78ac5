//! The tree as straight-line code over registers, each distinct subexpression computed once.

use std::collections::HashMap;
use std::sync::Arc;

use crate::node::Node;
use crate::ops::{Binary, Unary, select, squared_difference};

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Operand {
    Constant(f64),
    Variable(usize),
    /// While numbering: the instruction whose value it is; in the finished program: a register.
    Register(usize),
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Operation {
    Unary(Unary, Operand),
    Binary(Binary, Operand, Operand),
    /// `(a - b)^2`, of which distances are made: one pass over a block instead of two.
    SquaredDifference(Operand, Operand),
    Select(Operand, Operand, Operand),
}

#[derive(Debug, Clone, Copy)]
pub(crate) struct Instruction {
    pub(crate) operation: Operation,
    /// Register that receives the value; never one of the operands, so a block can be written while they are read.
    pub(crate) target: usize,
}

#[derive(Debug, Clone)]
pub(crate) struct Program {
    pub(crate) code: Vec<Instruction>,
    pub(crate) registers: usize,
    pub(crate) result: Operand,
}

impl Program {
    pub(crate) fn new(root: &Arc<Node>) -> Self {
        let mut numbering = Numbering::default();
        let result = numbering.visit(root);
        allocate(&numbering.operations, result)
    }

    /// Value at one point.
    pub(crate) fn eval(&self, values: &[f64]) -> f64 {
        /// Registers on the stack; few expressions need more than ten.
        const NEARBY: usize = 16;
        if self.registers <= NEARBY {
            self.eval_in(values, &mut [0.0; NEARBY])
        } else {
            self.eval_in(values, &mut vec![0.0; self.registers])
        }
    }

    fn eval_in(&self, values: &[f64], registers: &mut [f64]) -> f64 {
        let fetch = |operand: Operand, registers: &[f64]| match operand {
            Operand::Constant(value) => value,
            Operand::Variable(index) => values[index],
            Operand::Register(index) => registers[index],
        };
        for instruction in &self.code {
            registers[instruction.target] = match instruction.operation {
                Operation::Unary(op, a) => op.apply(fetch(a, registers)),
                Operation::Binary(op, a, b) => op.apply(fetch(a, registers), fetch(b, registers)),
                Operation::SquaredDifference(a, b) => {
                    squared_difference(fetch(a, registers), fetch(b, registers))
                }
                Operation::Select(c, a, b) => {
                    select(fetch(c, registers), fetch(a, registers), fetch(b, registers))
                }
            };
        }
        fetch(self.result, registers)
    }

    /// Whether any instruction reads the variable.
    pub(crate) fn reads(&self, variable: usize) -> bool {
        let wanted = Operand::Variable(variable);
        self.result == wanted || self.code.iter().any(|i| i.operation.operands().any(|o| o == wanted))
    }

    /// Greatest index of a variable that is read.
    pub(crate) fn last_variable(&self) -> Option<usize> {
        let operands = self.code.iter().flat_map(|i| i.operation.operands()).chain([self.result]);
        operands.filter_map(|o| if let Operand::Variable(index) = o { Some(index) } else { None }).max()
    }
}

impl Operation {
    fn operands(&self) -> impl Iterator<Item = Operand> + use<> {
        let operands = match *self {
            Self::Unary(_, a) => [Some(a), None, None],
            Self::Binary(_, a, b) | Self::SquaredDifference(a, b) => [Some(a), Some(b), None],
            Self::Select(c, a, b) => [Some(c), Some(a), Some(b)],
        };
        operands.into_iter().flatten()
    }

    fn map(self, f: impl Fn(Operand) -> Operand) -> Self {
        match self {
            Self::Unary(op, a) => Self::Unary(op, f(a)),
            Self::Binary(op, a, b) => Self::Binary(op, f(a), f(b)),
            Self::SquaredDifference(a, b) => Self::SquaredDifference(f(a), f(b)),
            Self::Select(c, a, b) => Self::Select(f(c), f(a), f(b)),
        }
    }
}

/// Identity of an operand: constants by their bits, so that 0 and -0 stay apart and a NaN equals itself.
#[derive(PartialEq, Eq, Hash)]
enum OperandKey {
    Constant(u64),
    Variable(usize),
    Register(usize),
}

#[derive(PartialEq, Eq, Hash)]
enum OperationKey {
    Unary(Unary, OperandKey),
    Binary(Binary, OperandKey, OperandKey),
    SquaredDifference(OperandKey, OperandKey),
    Select(OperandKey, OperandKey, OperandKey),
}

impl From<Operand> for OperandKey {
    fn from(operand: Operand) -> Self {
        match operand {
            Operand::Constant(value) => Self::Constant(value.to_bits()),
            Operand::Variable(index) => Self::Variable(index),
            Operand::Register(index) => Self::Register(index),
        }
    }
}

impl From<Operation> for OperationKey {
    fn from(operation: Operation) -> Self {
        match operation {
            Operation::Unary(op, a) => Self::Unary(op, a.into()),
            Operation::Binary(op, a, b) => Self::Binary(op, a.into(), b.into()),
            Operation::SquaredDifference(a, b) => Self::SquaredDifference(a.into(), b.into()),
            Operation::Select(c, a, b) => Self::Select(c.into(), a.into(), b.into()),
        }
    }
}

/// Value numbering: operations in order of evaluation, none twice.
#[derive(Default)]
struct Numbering {
    operations: Vec<Operation>,
    known: HashMap<OperationKey, usize>,
    /// Shared nodes that were visited, by address: they are not walked again.
    visited: HashMap<*const Node, Operand>,
}

impl Numbering {
    fn visit(&mut self, node: &Arc<Node>) -> Operand {
        let operation = match &**node {
            Node::Constant(value) => return Operand::Constant(*value),
            Node::Variable(index) => return Operand::Variable(*index),
            _ if self.visited.contains_key(&Arc::as_ptr(node)) => return self.visited[&Arc::as_ptr(node)],
            Node::Unary(op, a) => Operation::Unary(*op, self.visit(a)),
            Node::Binary(op, a, b) => match squared_operands(*op, a, b) {
                Some((a, b)) => Operation::SquaredDifference(self.visit(a), self.visit(b)),
                None => Operation::Binary(*op, self.visit(a), self.visit(b)),
            },
            Node::If(c, a, b) => Operation::Select(self.visit(c), self.visit(a), self.visit(b)),
        };
        let operations = &mut self.operations;
        let index = *self.known.entry(operation.into()).or_insert_with(|| {
            operations.push(operation);
            operations.len() - 1
        });
        let operand = Operand::Register(index);
        self.visited.insert(Arc::as_ptr(node), operand);
        operand
    }
}

/// The operands a and b of `(a - b)^2`.
fn squared_operands<'a>(
    op: Binary,
    base: &'a Node,
    exponent: &Node,
) -> Option<(&'a Arc<Node>, &'a Arc<Node>)> {
    match base {
        Node::Binary(Binary::Sub, a, b) if op == Binary::Pow && exponent.is(2.0) => Some((a, b)),
        _ => None,
    }
}

/// Gives every value a register, reused after the value's last use.
fn allocate(operations: &[Operation], result: Operand) -> Program {
    let mut last_use: Vec<usize> = (0..operations.len()).collect();
    for (index, operation) in operations.iter().enumerate() {
        for operand in operation.operands() {
            if let Operand::Register(value) = operand {
                last_use[value] = index;
            }
        }
    }
    if let Operand::Register(value) = result {
        last_use[value] = operations.len();
    }

    let mut register_of = vec![0; operations.len()];
    let mut free: Vec<usize> = Vec::new();
    let mut registers = 0;
    let mut code = Vec::with_capacity(operations.len());
    for (index, operation) in operations.iter().enumerate() {
        let target = free.pop().unwrap_or_else(|| {
            registers += 1;
            registers - 1
        });
        register_of[index] = target;
        let located = operation.map(|operand| locate(operand, &register_of));
        code.push(Instruction { operation: located, target });
        for operand in operation.operands() {
            if let Operand::Register(value) = operand
                && last_use[value] == index
                && !free.contains(&register_of[value])
            {
                free.push(register_of[value]);
            }
        }
    }
    Program { code, registers, result: locate(result, &register_of) }
}

fn locate(operand: Operand, register_of: &[usize]) -> Operand {
    match operand {
        Operand::Register(value) => Operand::Register(register_of[value]),
        other => other,
    }
}
