//! A small SVG writer: positions in pixels, two decimals.

use std::fmt::Write as _;

use crate::color::{Rgb, hex};

/// Where a text stands relative to its position.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Anchor {
    Start,
    Middle,
    End,
}

/// An SVG document in progress.
pub(crate) struct Svg {
    body: String,
    width: f64,
    height: f64,
}

impl Svg {
    /// A white page.
    pub(crate) fn new(width: f64, height: f64) -> Self {
        let mut svg = Self { body: String::new(), width, height };
        svg.raw("<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>");
        svg
    }

    /// Appends an element as it is.
    pub(crate) fn raw(&mut self, element: &str) {
        self.body.push_str(element);
        self.body.push('\n');
    }

    /// Closed loops, filled by the even-odd rule, with a hairline of the same colour that hides the seam between areas
    /// that touch.
    pub(crate) fn area(&mut self, loops: &[Vec<[f64; 2]>], color: Rgb) {
        let d = path(loops.iter().map(|points| (points.as_slice(), true)));
        if !d.is_empty() {
            let color = hex(color);
            self.raw(&format!(
                "<path fill=\"{color}\" stroke=\"{color}\" stroke-width=\".6\" fill-rule=\"evenodd\" d=\"{d}\"/>"
            ));
        }
    }

    /// Lines `(points, closed)`, with attributes of the stroke.
    pub(crate) fn lines<'p>(
        &mut self,
        lines: impl Iterator<Item = (&'p [[f64; 2]], bool)>,
        color: &str,
        width: f64,
        attributes: &str,
    ) {
        let d = path(lines);
        if !d.is_empty() {
            self.raw(&format!(
                "<path fill=\"none\" stroke=\"{color}\" stroke-width=\"{width}\" stroke-linejoin=\"round\"{attributes} d=\"{d}\"/>"
            ));
        }
    }

    /// A straight line.
    pub(crate) fn line(&mut self, from: [f64; 2], to: [f64; 2], color: &str, width: f64) {
        self.lines([([from, to].as_slice(), false)].into_iter(), color, width, "");
    }

    /// A line of text whose middle is at the height of the position.
    pub(crate) fn text(&mut self, at: [f64; 2], text: &str, size: f64, anchor: Anchor, attributes: &str) {
        if text.is_empty() {
            return;
        }
        let anchor = match anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        // The middle of digits and capitals lies 0.36 of the font size above the base line.
        let (x, y) = (number(at[0]), number(at[1] + 0.36 * size));
        let text = escape(text);
        self.raw(&format!(
            "<text x=\"{x}\" y=\"{y}\" font-size=\"{size}\" text-anchor=\"{anchor}\"{attributes}>{text}</text>"
        ));
    }

    /// The whole document.
    pub(crate) fn finish(self) -> String {
        let (w, h) = (number(self.width), number(self.height));
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w}\" height=\"{h}\" viewBox=\"0 0 {w} {h}\" \
             font-family=\"sans-serif\" fill=\"#282828\">\n{}</svg>\n",
            self.body
        )
    }
}

/// Path data in relative coordinates: every point is rounded to two decimals first, so that errors do not add up.
fn path<'p>(lines: impl Iterator<Item = (&'p [[f64; 2]], bool)>) -> String {
    let mut d = String::new();
    for (points, closed) in lines {
        let mut last: Option<[i64; 2]> = None;
        for point in points {
            let hundredths = point.map(|x| (100.0 * x).round() as i64);
            match last {
                None => {
                    let _ = write!(d, "M{} {}", decimal(hundredths[0]), decimal(hundredths[1]));
                    d.push('l');
                }
                Some(last) if last == hundredths => continue,
                Some(last) => {
                    let [dx, dy] = [hundredths[0] - last[0], hundredths[1] - last[1]];
                    push_number(&mut d, dx);
                    push_number(&mut d, dy);
                }
            }
            last = Some(hundredths);
        }
        if d.ends_with('l') {
            d.push_str("0 0");
        }
        if closed {
            d.push('z');
        }
    }
    d
}

/// Appends a number, with a blank only where one is needed to tell it from the one before.
fn push_number(d: &mut String, hundredths: i64) {
    let text = decimal(hundredths);
    if !d.ends_with('l') && !text.starts_with('-') {
        d.push(' ');
    }
    d.push_str(&text);
}

/// Hundredths as a decimal number without needless zeros.
fn decimal(hundredths: i64) -> String {
    let sign = if hundredths < 0 { "-" } else { "" };
    let (whole, rest) = (hundredths.unsigned_abs() / 100, hundredths.unsigned_abs() % 100);
    let whole = if whole == 0 && rest != 0 { String::new() } else { whole.to_string() };
    match rest {
        0 => format!("{sign}{whole}"),
        r if r % 10 == 0 => format!("{sign}{whole}.{}", r / 10),
        r => format!("{sign}{whole}.{r:02}"),
    }
}

pub(crate) fn number(x: f64) -> String {
    decimal((100.0 * x).round() as i64)
}

/// Text with the characters escaped that XML reserves, and without those that it forbids.
pub(crate) fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            c if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') => escaped.push(' '),
            c => escaped.push(c),
        }
    }
    escaped
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_round_once() {
        assert_eq!(
            ["0", "-.5", "12.34", "-3", ".07"].map(String::from),
            [0, -50, 1234, -300, 7].map(decimal)
        );
        let thirds: Vec<[f64; 2]> = (0..4).map(|k| [f64::from(k) / 3.0, 0.0]).collect();
        assert_eq!(path([(thirds.as_slice(), false)].into_iter()), "M0 0l.33 0 .34 0 .33 0");
    }

    #[test]
    fn reserved_and_forbidden_characters_are_replaced() {
        assert_eq!(escape("a<b & \"c\"\u{0}"), "a&lt;b &amp; &quot;c&quot; ");
    }
}
