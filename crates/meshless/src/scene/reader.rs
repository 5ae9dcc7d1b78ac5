//! Typed access to TOML values that know their place.

use std::sync::Arc;

use meshless_expr::nearest_name;
use toml::de::{DeTable, DeValue};

use super::error::SceneError;
use super::source::{Place, Source};

/// A value of the file.
pub(super) struct Value<'a> {
    pub(super) place: Place,
    /// Dimension of the scene; 0 while it is not known.
    pub(super) dimension: usize,
    /// Whether the scene has `[time]`.
    pub(super) unsteady: bool,
    inner: &'a DeValue<'a>,
}

/// A table of the file.
pub(super) struct Table<'a> {
    pub(super) place: Place,
    pub(super) dimension: usize,
    pub(super) unsteady: bool,
    entries: &'a DeTable<'a>,
}

impl<'a> Table<'a> {
    /// The whole file; its place is the very beginning.
    pub(super) fn root(source: &Arc<Source>, entries: &'a DeTable<'a>) -> Self {
        Self { place: Place::new(source, "", 0..0), dimension: 0, unsteady: false, entries }
    }

    pub(super) fn with_dimension(self, dimension: usize) -> Self {
        Self { dimension, ..self }
    }

    pub(super) fn with_time(self, unsteady: bool) -> Self {
        Self { unsteady, ..self }
    }

    /// Refuses keys other than these; the first one in the file is reported.
    pub(super) fn allow(&self, known: &[&str]) -> Result<(), SceneError> {
        let unknown = self.entries.keys().filter(|key| !known.contains(&key.get_ref().as_ref()));
        let Some(key) = unknown.min_by_key(|key| key.span().start) else { return Ok(()) };
        let name = key.get_ref().as_ref();
        let place = self.place.at(key.span()).named(self.path(name));
        let keys = known.join(", ");
        let help = match nearest_name(name, known.iter().copied()) {
            Some(near) => format!("did you mean `{near}`? The keys here are {keys}"),
            None => format!("the keys here are {keys}"),
        };
        Err(place.error("unknown key", help))
    }

    pub(super) fn has(&self, key: &str) -> bool {
        self.entries.contains_key(key)
    }

    pub(super) fn get(&self, key: &str) -> Option<Value<'a>> {
        let value = self.entries.get(key)?;
        let place = self.place.at(value.span()).named(self.path(key));
        Some(Value { place, dimension: self.dimension, unsteady: self.unsteady, inner: value.get_ref() })
    }

    /// The value, or an error at the head of the table.
    pub(super) fn require(&self, key: &str) -> Result<Value<'a>, SceneError> {
        self.get(key).ok_or_else(|| self.missing(key, ""))
    }

    pub(super) fn missing(&self, key: &str, help: &str) -> SceneError {
        self.place.named(self.path(key)).error("the key is missing", help)
    }

    /// Entries of an array of tables; none, if the key is absent.
    pub(super) fn tables(&self, key: &str) -> Result<Vec<Self>, SceneError> {
        match self.get(key) {
            None => Ok(Vec::new()),
            Some(value) => value.items()?.into_iter().map(Value::table).collect(),
        }
    }

    fn path(&self, key: &str) -> String {
        if self.place.key.is_empty() { key.to_owned() } else { format!("{}.{key}", self.place.key) }
    }
}

impl<'a> Value<'a> {
    pub(super) fn error(&self, message: impl Into<String>, help: impl Into<String>) -> SceneError {
        self.place.error(message, help)
    }

    /// A value of another type was expected.
    pub(super) fn expected(&self, what: &str, help: &str) -> SceneError {
        let found = match self.inner {
            DeValue::String(_) => "a string",
            DeValue::Integer(_) => "an integer",
            DeValue::Float(_) => "a float",
            DeValue::Boolean(_) => "a boolean",
            DeValue::Datetime(_) => "a date",
            DeValue::Array(_) => "an array",
            DeValue::Table(_) => "a table",
        };
        self.error(format!("expected {what}, found {found}"), help)
    }

    /// Recognised, but not built.
    pub(super) fn not_supported(&self, what: &str, help: &str) -> SceneError {
        self.error(format!("{what} is not supported yet"), help)
    }

    pub(super) fn table(self) -> Result<Table<'a>, SceneError> {
        match self.inner {
            DeValue::Table(entries) => {
                Ok(Table { place: self.place, dimension: self.dimension, unsteady: self.unsteady, entries })
            }
            _ => Err(self.expected("a table", "")),
        }
    }

    /// A table with no other keys than these.
    pub(super) fn subtable(&self, known: &[&str]) -> Result<Table<'a>, SceneError> {
        let table = Self { place: self.place.clone(), ..*self }.table()?;
        table.allow(known)?;
        Ok(table)
    }

    /// Elements of an array, each with its index in the key.
    pub(super) fn items(&self) -> Result<Vec<Self>, SceneError> {
        let DeValue::Array(items) = self.inner else { return Err(self.expected("an array", "")) };
        let item = |(index, item): (usize, &'a toml::Spanned<DeValue<'a>>)| {
            let place = self.place.at(item.span()).named(format!("{}[{index}]", self.place.key));
            Self { place, dimension: self.dimension, unsteady: self.unsteady, inner: item.get_ref() }
        };
        Ok(items.iter().enumerate().map(item).collect())
    }

    /// The string, if it is one.
    pub(super) fn as_text(&self) -> Option<&'a str> {
        self.inner.as_str()
    }

    pub(super) fn text(&self) -> Result<&'a str, SceneError> {
        self.as_text().ok_or_else(|| self.expected("a string", ""))
    }

    /// A string that can serve as a name: neither empty nor with control characters.
    pub(super) fn name(&self) -> Result<String, SceneError> {
        let name = self.text()?;
        if name.trim().is_empty() || name.chars().any(char::is_control) {
            return Err(self.error("a name must have visible characters and no control characters", ""));
        }
        Ok(name.to_owned())
    }

    pub(super) fn boolean(&self) -> Result<bool, SceneError> {
        self.inner.as_bool().ok_or_else(|| self.expected("true or false", ""))
    }

    /// The number, if it is one and finite; an integer counts as a number.
    pub(super) fn as_number(&self) -> Option<Result<f64, SceneError>> {
        let value = match self.inner {
            DeValue::Integer(digits) => match i128::from_str_radix(digits.as_str(), digits.radix()) {
                Ok(value) => value as f64,
                Err(_) => f64::INFINITY,
            },
            DeValue::Float(digits) => digits.as_str().parse().unwrap_or(f64::NAN),
            _ => return None,
        };
        Some(if value.is_finite() { Ok(value) } else { Err(self.error("expected a finite number", "")) })
    }

    pub(super) fn number(&self) -> Result<f64, SceneError> {
        self.as_number().unwrap_or_else(|| Err(self.expected("a number", "")))
    }

    pub(super) fn positive(&self) -> Result<f64, SceneError> {
        match self.number()? {
            value if value > 0.0 => Ok(value),
            value => Err(self.error(format!("expected a positive number, found {value}"), "")),
        }
    }

    pub(super) fn not_negative(&self) -> Result<f64, SceneError> {
        match self.number()? {
            value if value >= 0.0 => Ok(value),
            value => Err(self.error(format!("expected a number not below 0, found {value}"), "")),
        }
    }

    /// An integer within limits, both included.
    pub(super) fn integer(&self, least: u64, most: u64) -> Result<u64, SceneError> {
        let what = if most == u64::MAX {
            format!("an integer not below {least}")
        } else {
            format!("an integer from {least} to {most}")
        };
        let DeValue::Integer(digits) = self.inner else { return Err(self.expected(&what, "")) };
        match u64::from_str_radix(digits.as_str(), digits.radix()) {
            Ok(value) if (least..=most).contains(&value) => Ok(value),
            _ => Err(self.error(format!("expected {what}, found {}", self.place.text()), "")),
        }
    }

    /// Coordinates, as many as the scene has dimensions.
    pub(super) fn vector(&self) -> Result<Vec<f64>, SceneError> {
        let dimension = self.dimension;
        let what = if dimension == 1 { "1 number".to_owned() } else { format!("{dimension} numbers") };
        if !matches!(self.inner, DeValue::Array(_)) {
            return Err(self.expected(&format!("an array of {what}"), ""));
        }
        let items = self.items()?;
        if items.len() != dimension {
            let message = format!("expected {what}, found {}", items.len());
            return Err(self.error(message, format!("the scene has dimension = {dimension}")));
        }
        items.iter().map(Value::number).collect()
    }

    /// A direction: a vector that is not zero.
    pub(super) fn direction(&self) -> Result<Vec<f64>, SceneError> {
        let vector = self.vector()?;
        if vector.iter().all(|component| *component == 0.0) {
            return Err(self.error("expected a direction, found the zero vector", ""));
        }
        Ok(vector)
    }

    /// What one of the given names stands for.
    pub(super) fn one_of<T: Copy>(&self, names: &[(&str, T)]) -> Result<T, SceneError> {
        let known = || names.iter().map(|(name, _)| *name);
        let all = known().collect::<Vec<_>>().join(", ");
        let Some(text) = self.as_text() else {
            return Err(self.expected("a name in quotes", &format!("the names here are {all}")));
        };
        if let Some((_, meaning)) = names.iter().find(|(name, _)| *name == text) {
            return Ok(*meaning);
        }
        let help = match nearest_name(text, known()) {
            Some(near) => format!("did you mean \"{near}\"? The names here are {all}"),
            None => format!("the names here are {all}"),
        };
        Err(self.error(format!("unknown name \"{}\"", text.escape_debug()), help))
    }
}
