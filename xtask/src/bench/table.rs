//! Tables on the terminal.

use std::fmt;

/// A table; the first column is text, the others are figures.
#[derive(Debug, Clone, Default)]
pub(super) struct Table {
    head: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Table {
    pub(super) fn new(head: &[&str]) -> Self {
        Self { head: head.iter().map(|&h| h.to_owned()).collect(), rows: Vec::new() }
    }

    pub(super) fn row(&mut self, name: &str, figures: Vec<String>) {
        self.rows.push(std::iter::once(name.to_owned()).chain(figures).collect());
    }
}

impl fmt::Display for Table {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let lines = || std::iter::once(&self.head).chain(&self.rows);
        let width = |k: usize| lines().filter_map(|l| l.get(k)).map(|c| c.chars().count()).max().unwrap_or(0);
        let widths: Vec<usize> = (0..self.head.len()).map(width).collect();
        for line in lines() {
            for (k, (cell, &width)) in line.iter().zip(&widths).enumerate() {
                if k == 0 {
                    write!(f, "  {cell:<width$}")?;
                } else {
                    write!(f, "  {cell:>width$}")?;
                }
            }
            writeln!(f)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::Table;

    #[test]
    fn columns_line_up() {
        let mut table = Table::new(&["what", "us"]);
        table.row("µ", vec!["1.25".to_owned()]);
        table.row("longer", vec!["10".to_owned()]);
        assert_eq!(table.to_string(), "  what      us\n  µ       1.25\n  longer    10\n");
    }
}
