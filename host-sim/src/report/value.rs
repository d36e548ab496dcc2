//! Numbers of the report, for other programs.

use serde::Serialize;

/// A number, what it measures, and what other sources state for the same quantity.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Value {
    /// The quantity that is measured.
    pub quantity: String,
    /// The conditions: where, of what, under which circumstances; may be empty.
    pub condition: String,
    /// The method that gave the number: `default` is this library's, `published …` the paper's own as run here.
    pub method: String,
    /// The number; `None` if only a published one is known.
    pub value: Option<f64>,
    /// The unit; empty for a dimensionless number.
    pub unit: &'static str,
    /// The standard error, if the number is a mean whose standard error is known.
    pub standard_error: Option<f64>,
    /// The number of repetitions that it was computed from.
    pub n: Option<usize>,
    /// The value as printed in the paper.
    pub published: Option<f64>,
    /// The theoretical bound.
    pub limit: Option<f64>,
}

impl Value {
    /// A quantity with its unit and no number yet.
    pub fn new(quantity: impl Into<String>, unit: &'static str) -> Self {
        Self {
            quantity: quantity.into(),
            condition: String::new(),
            method: "default".to_owned(),
            value: None,
            unit,
            standard_error: None,
            n: None,
            published: None,
            limit: None,
        }
    }

    /// Sets the conditions.
    pub fn under(mut self, condition: impl Into<String>) -> Self {
        self.condition = condition.into();
        self
    }

    /// Sets a method other than the default.
    pub fn by(mut self, method: impl Into<String>) -> Self {
        self.method = method.into();
        self
    }

    /// Sets the number; a value that is not finite counts as none.
    pub fn is(mut self, value: impl Into<Option<f64>>) -> Self {
        self.value = finite(value);
        self
    }

    /// Marks the number as the mean of `n` repetitions, with its standard error where known.
    pub fn of(mut self, n: usize, standard_error: impl Into<Option<f64>>) -> Self {
        (self.n, self.standard_error) = (Some(n), finite(standard_error));
        self
    }

    /// Sets the published number.
    pub fn published(mut self, value: impl Into<Option<f64>>) -> Self {
        self.published = finite(value);
        self
    }

    /// Sets the theoretical bound.
    pub fn limited(mut self, value: impl Into<Option<f64>>) -> Self {
        self.limit = finite(value);
        self
    }

    /// Values of the same quantity along axes or states: each is named `quantity` followed by one of `names`.
    pub fn each<const N: usize>(
        quantity: &str,
        names: [&'static str; N],
        units: [&'static str; N],
        values: [f64; N],
    ) -> [Self; N] {
        std::array::from_fn(|i| {
            Self::new(format!("{quantity} {}", names[i]), units[i]).is(values[i])
        })
    }
}

fn finite(value: impl Into<Option<f64>>) -> Option<f64> {
    value.into().filter(|value| value.is_finite())
}

/// Formats a number with three significant digits.
pub fn rounded(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let before = value.abs().max(1e-9).log10().floor() as i32 + 1;
    let decimals = usize::try_from(3 - before).unwrap_or_default();
    format!("{value:.decimals$}")
}

/// Parses the number in a printed text: 1.5 in `≈ 1.5`, −0.17 in `about −0.17`. `None` if there are several or none, or
/// only a bound.
pub fn printed(text: &str) -> Option<f64> {
    if ["<", ">", "above", "below"].iter().any(|bound| text.contains(bound)) {
        return None;
    }
    let text = text.replace('−', "-");
    let is_of_number = |letter: char| letter.is_ascii_digit() || letter == '.' || letter == '-';
    let mut numbers = text.split(|letter| !is_of_number(letter)).filter(|part| !part.is_empty());
    let number = numbers.next()?.parse().ok()?;
    numbers.next().is_none().then_some(number)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_is_found_in_what_is_printed() {
        for (text, number) in [
            ("≈ 1.5", Some(1.5)),
            ("about −0.17", Some(-0.17)),
            ("12°", Some(12.0)),
            ("3.5–6.5", None),
            ("invisible", None),
            ("< 1", None),
            ("", None),
        ] {
            assert_eq!(printed(text), number, "{text}");
        }
    }

    #[test]
    fn what_is_no_number_is_none() {
        let value = Value::new("error", "m").is(f64::NAN).of(7, f64::INFINITY).published(2.0);
        assert_eq!((value.value, value.standard_error, value.n), (None, None, Some(7)));
        assert_eq!((value.published, value.method.as_str()), (Some(2.0), "default"));
    }
}
