//! Values and columns of rows.

use std::fmt;

/// A value of a row.
#[derive(Debug, Clone, Default, PartialEq)]
pub enum Value {
    /// No value: an empty field.
    #[default]
    Missing,
    /// A number; `NaN` becomes a missing value.
    Number(f64),
    /// A text.
    Text(Box<str>),
}

impl Value {
    /// The value as a number: `NaN` if it is missing, `None` if it is a text that is not a number.
    pub fn number(&self) -> Option<f64> {
        match self {
            Self::Missing => Some(f64::NAN),
            Self::Number(number) => Some(*number),
            Self::Text(text) => text.parse().ok(),
        }
    }
}

impl From<f64> for Value {
    fn from(number: f64) -> Self {
        if number.is_nan() { Self::Missing } else { Self::Number(number) }
    }
}

impl From<&str> for Value {
    fn from(text: &str) -> Self {
        if text.is_empty() { Self::Missing } else { Self::Text(text.into()) }
    }
}

/// The shortest text that is read as the same number again, to the bit.
impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Missing => Ok(()),
            // For larger numbers, an exponent is shorter.
            Self::Number(number) if number.fract() == 0.0 && number.abs() < 1e15 => {
                write!(f, "{number}")
            }
            Self::Number(number) => write!(f, "{number:?}"),
            Self::Text(text) => f.write_str(text),
        }
    }
}

/// The kind of values in a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Whole numbers from 0 to 2⁵³.
    Whole,
    /// Numbers.
    Number,
    /// Texts.
    Text,
}

/// A column of a table.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Column {
    /// The name of the column.
    pub name: String,
    /// The kind of its values.
    pub kind: Kind,
}

impl Column {
    /// A column of numbers.
    pub fn number(name: impl Into<String>) -> Self {
        Self { name: name.into(), kind: Kind::Number }
    }

    /// A column of texts.
    pub fn text(name: impl Into<String>) -> Self {
        Self { name: name.into(), kind: Kind::Text }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_number_is_read_again_to_the_bit(bits in any::<u64>()) {
            let number = f64::from_bits(bits);
            let text = Value::from(number).to_string();
            let again = Value::from(text.as_str()).number().unwrap();
            prop_assert!(number.is_nan() && again.is_nan() || again.to_bits() == bits, "{text}");
        }
    }

    #[test]
    fn whole_numbers_have_no_point() {
        for (number, text) in [(3.0, "3"), (-0.0, "-0"), (0.1, "0.1"), (1e300, "1e300")] {
            assert_eq!(Value::from(number).to_string(), text);
        }
    }
}
