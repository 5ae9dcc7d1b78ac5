//! Text into tokens with byte spans.

use std::ops::Range;

use crate::error::ParseError;
use crate::ops::Binary;

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Token<'a> {
    Number(f64),
    Name(&'a str),
    /// An infix operator; `-` and `+` may also stand before an operand.
    Operator(Binary),
    Open,
    Close,
    Comma,
    End,
}

impl std::fmt::Display for Token<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Number(_) => f.write_str("a number"),
            Self::Name(name) => write!(f, "`{name}`"),
            Self::Operator(op) => write!(f, "`{}`", op.name()),
            Self::Open => f.write_str("`(`"),
            Self::Close => f.write_str("`)`"),
            Self::Comma => f.write_str("`,`"),
            Self::End => f.write_str("the end"),
        }
    }
}

/// All tokens of the text; the last one is [`Token::End`] with an empty span.
pub(crate) fn tokens(text: &str) -> Result<Vec<(Token<'_>, Range<usize>)>, ParseError> {
    let mut tokens = Vec::new();
    let mut at = 0;
    while let Some(first) = text[at..].chars().next() {
        if first.is_ascii_whitespace() {
            at += 1;
            continue;
        }
        let (token, length) = if first.is_ascii_digit() || first == '.' {
            number(text, at)?
        } else if first.is_ascii_alphabetic() || first == '_' {
            let length = text[at..].bytes().take_while(|&b| b.is_ascii_alphanumeric() || b == b'_').count();
            (Token::Name(&text[at..at + length]), length)
        } else {
            symbol(text, at, first)?
        };
        tokens.push((token, at..at + length));
        at += length;
    }
    tokens.push((Token::End, at..at));
    Ok(tokens)
}

fn symbol(text: &str, at: usize, first: char) -> Result<(Token<'_>, usize), ParseError> {
    const PAIRS: [(&str, Binary); 4] = [
        ("<=", Binary::LessEqual),
        (">=", Binary::GreaterEqual),
        ("==", Binary::Equal),
        ("!=", Binary::NotEqual),
    ];
    if let Some((_, op)) = PAIRS.iter().find(|(pair, _)| text[at..].starts_with(pair)) {
        return Ok((Token::Operator(*op), 2));
    }
    if text[at..].starts_with("**") {
        return Err(ParseError::new(at..at + 2, "unknown operator `**`").with_help("a power is written `^`"));
    }
    let token = match first {
        '+' => Token::Operator(Binary::Add),
        '-' => Token::Operator(Binary::Sub),
        '*' => Token::Operator(Binary::Mul),
        '/' => Token::Operator(Binary::Div),
        '^' => Token::Operator(Binary::Pow),
        '<' => Token::Operator(Binary::Less),
        '>' => Token::Operator(Binary::Greater),
        '(' => Token::Open,
        ')' => Token::Close,
        ',' => Token::Comma,
        _ => return Err(unexpected_character(text, at, first)),
    };
    Ok((token, 1))
}

fn unexpected_character(text: &str, at: usize, first: char) -> ParseError {
    let error = ParseError::new(
        at..at + first.len_utf8(),
        format!("unexpected character `{}`", first.escape_debug()),
    );
    match first {
        '=' => error.with_help("equality is written `==`"),
        '&' => error.with_help("`a and b` is written as a product, `(a)*(b)`"),
        '|' => error.with_help("`a or b` is written `max(a, b)`"),
        '!' => error.with_help("`not a` is written `(a) == 0`"),
        '[' | '{' => error.with_help("group with `(` and `)`"),
        '\u{2212}' | '\u{2013}' => error.with_help("the sign is written `-`"),
        '\u{b7}' | '\u{d7}' => error.with_help("a product is written `*`"),
        '\u{3c0}' => error.with_help("write `pi`"),
        _ if text[at..].starts_with(|c: char| c.is_alphabetic()) => {
            error.with_help("names consist of ASCII letters, digits and `_`")
        }
        _ => error,
    }
}

/// `12`, `1.5`, `.5`, `5.`, each with an optional exponent. A letter `e` that no digit follows is not one.
fn number(text: &str, at: usize) -> Result<(Token<'_>, usize), ParseError> {
    let bytes = &text.as_bytes()[at..];
    let digits = |from: usize| bytes[from..].iter().take_while(|b| b.is_ascii_digit()).count();
    let mut length = digits(0);
    let mut mantissa_digits = length;
    if bytes.get(length) == Some(&b'.') {
        let fraction = digits(length + 1);
        mantissa_digits += fraction;
        length += 1 + fraction;
    }
    if mantissa_digits == 0 {
        return Err(ParseError::new(at..at + length, "`.` without digits is not a number"));
    }
    if let Some(b'e' | b'E') = bytes.get(length) {
        let sign = usize::from(matches!(bytes.get(length + 1), Some(b'+' | b'-')));
        let exponent = digits((length + 1 + sign).min(bytes.len()));
        if exponent > 0 {
            length += 1 + sign + exponent;
        }
    }
    let span = at..at + length;
    match text[span.clone()].parse::<f64>() {
        Ok(value) if value.is_finite() => Ok((Token::Number(value), length)),
        _ => Err(ParseError::new(span, "the number is too large").with_help("numbers reach up to 1.8e308")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reads_numbers_in_every_form() {
        for (text, value) in [("2", 2.0), (".5", 0.5), ("5.", 5.0), ("1e-3", 1e-3), ("1.5E+2", 150.0)] {
            let tokens = tokens(text).expect(text);
            assert_eq!(tokens, [(Token::Number(value), 0..text.len()), (Token::End, text.len()..text.len())]);
        }
        assert_eq!(tokens("2exp").expect("two tokens")[1], (Token::Name("exp"), 1..4));
        assert_eq!(tokens("2e").expect("two tokens")[1], (Token::Name("e"), 1..2));
    }

    #[test]
    fn refuses_what_is_not_arithmetic() {
        for (text, span) in [("x = 1", 2..3), ("a && b", 2..3), ("2**3", 1..3), ("1e999", 0..5), (".", 0..1)]
        {
            assert_eq!(tokens(text).expect_err(text).span, span);
        }
        assert_eq!(tokens("x \u{2212} 1").expect_err("minus sign").span, 2..5);
    }
}
