//! Tokens into a tree, by binding powers (Pratt 1973, "Top down operator precedence").

use std::ops::Range;
use std::sync::Arc;

use crate::error::ParseError;
use crate::lexer::{Token, tokens};
use crate::node::Node;
use crate::ops::{BINARY_FUNCTIONS, Binary, UNARY_FUNCTIONS, Unary};
use crate::suggest::nearest_name;

/// Longest text that is parsed, in bytes.
pub const MAX_LENGTH: usize = 8192;
/// Deepest nesting of parentheses, arguments, signs and right operands; it bounds the parser's stack.
pub const MAX_NESTING: usize = 256;
/// Greatest height of the tree, which a sum of this many terms has; it bounds the stack of evaluation.
pub const MAX_HEIGHT: usize = 512;

/// Binding power of a sign: above products, below powers, so `-x^2` is `-(x^2)`.
const SIGN_POWER: u8 = 4;

/// Binding power of an infix operator: the greater one takes the operand between two operators.
pub(crate) fn binding_power(op: Binary) -> u8 {
    match op {
        Binary::Add | Binary::Sub => 2,
        Binary::Mul | Binary::Div => 3,
        Binary::Pow => 5,
        _ => 1,
    }
}

/// A tree with the bytes it came from and its height.
struct Parsed {
    node: Arc<Node>,
    span: Range<usize>,
    height: usize,
}

struct Parser<'a> {
    tokens: Vec<(Token<'a>, Range<usize>)>,
    next: usize,
    nesting: usize,
    variables: &'a [&'a str],
}

pub(crate) fn parse(text: &str, variables: &[&str]) -> Result<Arc<Node>, ParseError> {
    if text.len() > MAX_LENGTH {
        let message = format!("the expression has {} bytes, more than {MAX_LENGTH}", text.len());
        return Err(ParseError::new(0..text.len(), message));
    }
    let mut parser = Parser { tokens: tokens(text)?, next: 0, nesting: 0, variables };
    if parser.tokens.len() == 1 {
        return Err(ParseError::new(0..text.len(), "the expression is empty"));
    }
    let parsed = parser.expression(0)?;
    match parser.peek() {
        (Token::End, _) => Ok(parsed.node),
        (Token::Close, span) => Err(ParseError::new(span, "`)` closes nothing")),
        (Token::Comma, span) => {
            Err(ParseError::new(span, "unexpected `,`").with_help("the decimal separator is `.`"))
        }
        (token @ (Token::Name(_) | Token::Number(_) | Token::Open), span) => {
            Err(ParseError::new(span, format!("expected an operator, found {token}"))
                .with_help(parser.after_operand()))
        }
        (token @ Token::Operator(_), span) => {
            Err(ParseError::new(span, format!("expected the end, found {token}")))
        }
    }
}

impl<'a> Parser<'a> {
    /// What to do where a value follows a value.
    fn after_operand(&self) -> &'static str {
        let unit = |before: &Token<'_>, this: &Token<'_>| matches!((before, this), (Token::Number(_), Token::Name(name)) if !self.variables.contains(name));
        match self.next.checked_sub(1).map(|before| (&self.tokens[before].0, &self.tokens[self.next].0)) {
            Some((before, this)) if unit(before, this) => {
                "numbers have no units: write all of them in units that fit together; a product is written with `*`"
            }
            _ => "a product is written with `*`",
        }
    }

    fn peek(&self) -> (Token<'a>, Range<usize>) {
        self.tokens[self.next].clone()
    }

    /// The next token is consumed, except the end, which stays.
    fn take(&mut self) -> (Token<'a>, Range<usize>) {
        let token = self.peek();
        self.next = (self.next + 1).min(self.tokens.len() - 1);
        token
    }

    /// An expression whose infix operators all bind tighter than `least`.
    fn expression(&mut self, least: u8) -> Result<Parsed, ParseError> {
        self.nesting += 1;
        if self.nesting > MAX_NESTING {
            let message = format!("the expression is nested more than {MAX_NESTING} levels deep");
            return Err(ParseError::new(self.peek().1, message));
        }
        let mut left = self.operand()?;
        while let (Token::Operator(op), span) = self.peek() {
            let power = binding_power(op);
            if power <= least {
                break;
            }
            self.take();
            // A power takes everything to its right, signs included: 2^3^2 = 2^(3^2).
            let right = self.expression(if op == Binary::Pow { SIGN_POWER - 1 } else { power })?;
            left = join(op, left, right)?;
            if op.is_comparison() {
                self.refuse_chain(&span)?;
            }
        }
        self.nesting -= 1;
        Ok(left)
    }

    /// `0 < x < 1` would compare a truth value with 1.
    fn refuse_chain(&self, first: &Range<usize>) -> Result<(), ParseError> {
        match self.peek() {
            (Token::Operator(op), span) if op.is_comparison() => {
                Err(ParseError::new(first.start..span.end, "comparisons do not chain")
                    .with_help("write `(a < b)*(b < c)` for `a < b < c`"))
            }
            _ => Ok(()),
        }
    }

    fn operand(&mut self) -> Result<Parsed, ParseError> {
        let (token, span) = self.take();
        match token {
            Token::Number(value) => Ok(Parsed { node: Arc::new(Node::Constant(value)), span, height: 1 }),
            Token::Name(name) => self.name(name, span),
            Token::Operator(Binary::Sub) => {
                let a = self.expression(SIGN_POWER)?;
                let span = span.start..a.span.end;
                checked(Node::unary(Unary::Neg, a.node), span, a.height)
            }
            Token::Operator(Binary::Add) => self.expression(SIGN_POWER),
            Token::Open => {
                let inner = self.expression(0)?;
                let close = self.close(&span)?;
                Ok(Parsed { span: span.start..close.end, ..inner })
            }
            Token::End if self.next > 0 => {
                Err(ParseError::new(span, "the expression ends where an operand is expected"))
            }
            other => Err(ParseError::new(span, format!("expected an operand, found {other}"))),
        }
    }

    fn close(&mut self, open: &Range<usize>) -> Result<Range<usize>, ParseError> {
        match self.take() {
            (Token::Close, span) => Ok(span),
            (Token::End, _) => Err(ParseError::new(open.clone(), "`(` is never closed")),
            (token, span) => Err(ParseError::new(span, format!("expected `)`, found {token}"))),
        }
    }

    fn name(&mut self, name: &'a str, span: Range<usize>) -> Result<Parsed, ParseError> {
        let called = matches!(self.peek().0, Token::Open);
        let value = match self.variables.iter().position(|variable| *variable == name) {
            Some(index) => Some(Node::Variable(index)),
            None if name == "pi" => Some(Node::Constant(std::f64::consts::PI)),
            None => None,
        };
        match (value, called) {
            (Some(node), false) => Ok(Parsed { node: Arc::new(node), span, height: 1 }),
            (Some(_), true) => Err(ParseError::new(span, format!("`{name}` is not a function"))
                .with_help(format!("a product is written `{name}*(…)`"))),
            (None, _) if !is_function(name) => Err(self.unknown(name, span)),
            (None, false) => Err(ParseError::new(span, format!("the function `{name}` has no arguments"))
                .with_help(format!("write `{name}(…)`"))),
            (None, true) => self.call(name, span),
        }
    }

    fn call(&mut self, name: &str, span: Range<usize>) -> Result<Parsed, ParseError> {
        let (_, open) = self.take();
        let mut arguments = Vec::new();
        if !matches!(self.peek().0, Token::Close) {
            arguments.push(self.expression(0)?);
            while matches!(self.peek().0, Token::Comma) {
                self.take();
                arguments.push(self.expression(0)?);
            }
        }
        let span = span.start..self.close(&open)?.end;
        let unary = UNARY_FUNCTIONS.iter().find(|(known, _)| *known == name).map(|(_, op)| *op);
        let binary = BINARY_FUNCTIONS.iter().find(|(known, _)| *known == name).map(|(_, op)| *op);
        let mut arguments = arguments.into_iter();
        let (first, second, third) = (arguments.next(), arguments.next(), arguments.next());
        match (unary, binary, first, second, third) {
            (Some(op), _, Some(a), None, None) => checked(Node::unary(op, a.node), span, a.height),
            (_, Some(op), Some(a), Some(b), None) => join(op, a, b).map(|joined| Parsed { span, ..joined }),
            (_, Some(op @ (Binary::Min | Binary::Max)), Some(a), Some(b), Some(c)) => {
                let two = join(op, a, b)?;
                let all =
                    std::iter::once(c).chain(arguments).try_fold(two, |left, right| join(op, left, right));
                all.map(|joined| Parsed { span, ..joined })
            }
            (None, None, Some(c), Some(a), Some(b)) if arguments.len() == 0 => {
                let height = c.height.max(a.height).max(b.height);
                checked(Node::select(c.node, a.node, b.node), span, height)
            }
            (_, _, first, second, third) => {
                let given =
                    [&first, &second, &third].iter().filter(|a| a.is_some()).count() + arguments.len();
                let message = format!("`{name}` takes {}, found {given}", arity(name));
                Err(ParseError::new(span, message))
            }
        }
    }

    fn unknown(&self, name: &str, span: Range<usize>) -> ParseError {
        /// What other languages call it, and how it is written here.
        const FOREIGN: [(&str, &str); 9] = [
            ("ln", "the natural logarithm is `log`"),
            ("log10", "write `log(x)/log(10)`"),
            ("log2", "write `log(x)/log(2)`"),
            ("pow", "a power is written `a^b`"),
            ("fabs", "the absolute value is `abs`"),
            ("e", "write `exp(1)`"),
            ("and", "`a and b` is written as a product, `(a)*(b)`"),
            ("or", "`a or b` is written `max(a, b)`"),
            ("not", "`not a` is written `(a) == 0`"),
        ];
        let functions = UNARY_FUNCTIONS.iter().map(|(known, _)| *known);
        let others = BINARY_FUNCTIONS.iter().map(|(known, _)| *known).chain(["if", "pi"]);
        let known = self.variables.iter().copied().chain(functions).chain(others);
        let help = match FOREIGN.iter().find(|(foreign, _)| *foreign == name) {
            Some((_, help)) => (*help).to_owned(),
            None => match nearest_name(name, known) {
                Some(near) => format!("did you mean `{near}`?"),
                None if self.variables.is_empty() => "there are no variables here".to_owned(),
                None => format!("the variables here are {}", self.variables.join(", ")),
            },
        };
        ParseError::new(span, format!("unknown name `{name}`")).with_help(help)
    }
}

fn is_function(name: &str) -> bool {
    name == "if"
        || UNARY_FUNCTIONS.iter().any(|(known, _)| *known == name)
        || BINARY_FUNCTIONS.iter().any(|(known, _)| *known == name)
}

fn arity(name: &str) -> &'static str {
    match name {
        "if" => "three arguments: the condition, the value where it holds, the value elsewhere",
        "atan2" => "two arguments",
        "min" | "max" => "two or more arguments",
        _ => "one argument",
    }
}

fn join(op: Binary, a: Parsed, b: Parsed) -> Result<Parsed, ParseError> {
    let span = a.span.start..b.span.end;
    checked(Node::binary(op, a.node, b.node), span, a.height.max(b.height))
}

/// The tree above operands of the given height, unless it is too high.
fn checked(node: Arc<Node>, span: Range<usize>, operands: usize) -> Result<Parsed, ParseError> {
    let height = if node.constant().is_some() { 1 } else { operands + 1 };
    if height > MAX_HEIGHT {
        let message = format!("the expression has a chain of more than {MAX_HEIGHT} operations");
        return Err(ParseError::new(span, message).with_help("group long sums and products with parentheses"));
    }
    Ok(Parsed { node, span, height })
}
