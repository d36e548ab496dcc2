//! Settings in the form of firmware source.

use std::fmt;

use kestirim_replay::ScalarKind;

/// A Rust literal of a crate's `Config`, with the fields that differ from its base.
#[derive(Debug, Clone)]
pub struct Literal {
    imports: Vec<String>,
    scalar: ScalarKind,
    config: String,
    base: String,
    fields: Vec<(String, String)>,
    rest: Vec<String>,
}

impl Literal {
    /// A literal of type `config`, such as `Config::<f32>`, based on `base`, such as `Config::default()`, with the
    /// imports that both need.
    pub fn new(imports: &str, scalar: ScalarKind, config: &str, base: &str) -> Self {
        Self {
            imports: vec![imports.to_owned()],
            scalar,
            config: config.to_owned(),
            base: base.to_owned(),
            fields: Vec::new(),
            rest: Vec::new(),
        }
    }

    /// The name of the number type, as firmware imports it.
    pub const fn number_type(scalar: ScalarKind) -> &'static str {
        match scalar {
            ScalarKind::F32 => "f32",
            ScalarKind::F64 => "f64",
            ScalarKind::Fixed => "Q12_20",
        }
    }

    /// A Rust literal of a number of the estimator's type.
    pub fn number(scalar: ScalarKind, value: f64) -> String {
        match scalar {
            ScalarKind::Fixed => format!("Q12_20::from_f64({value:?})"),
            _ => format!("{value:?}"),
        }
    }

    /// Adds an import.
    #[must_use]
    pub fn import(mut self, path: &str) -> Self {
        self.imports.push(path.to_owned());
        self
    }

    /// Adds a field with its value in Rust.
    #[must_use]
    pub fn field(mut self, name: &str, value: impl Into<String>) -> Self {
        self.fields.push((name.to_owned(), value.into()));
        self
    }

    /// Adds a line after the literal.
    #[must_use]
    pub fn then(mut self, line: String) -> Self {
        self.rest.push(line);
        self
    }

    /// Adds a number field if there is a value.
    #[must_use]
    pub fn number_field(self, name: &str, value: Option<f64>) -> Self {
        match value {
            Some(value) => {
                let value = Self::number(self.scalar, value);
                self.field(name, value)
            }
            None => self,
        }
    }
}

impl fmt::Display for Literal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for import in &self.imports {
            writeln!(f, "use {import};")?;
        }
        if self.scalar == ScalarKind::Fixed {
            writeln!(f, "use kestirim_scalar::{{Q12_20, Scalar}};")?;
        }
        if self.fields.is_empty() {
            write!(f, "\nlet config: {} = {};", self.config.replace("::<", "<"), self.base)?;
        } else {
            writeln!(f, "\nlet config = {} {{", self.config)?;
            for (name, value) in &self.fields {
                writeln!(f, "    {name}: {value},")?;
            }
            write!(f, "    ..{}\n}};", self.base)?;
        }
        self.rest.iter().try_for_each(|line| write!(f, "\n{line}"))
    }
}
