//! What values a setting has.

use clap::ValueEnum;
use clap::builder::PossibleValue;

/// What values a setting has.
#[derive(Debug, Clone)]
pub enum Kind {
    /// A number within bounds.
    Number(Number),
    /// One of a few.
    Choice {
        /// All, in the order in which they are shown.
        of: Vec<Named>,
        /// Which if none is given.
        default: String,
    },
    /// Any of a few.
    Set {
        /// All, in the order in which they are shown; none is the default.
        of: Vec<Named>,
    },
    /// On or off.
    Switch {
        /// Which if nothing is said. What is on at first is an option `--no-…`.
        default: bool,
    },
    /// A text of a certain form; without one the estimator does as it likes.
    Text {
        /// What it looks like: `X,Y,Z`.
        form: &'static str,
        /// Says what was expected if it is not of that form.
        check: fn(&str) -> Result<(), String>,
    },
}

/// A number within bounds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Number {
    /// Its unit; may be empty.
    pub unit: &'static str,
    /// The least value.
    pub min: f64,
    /// The greatest value.
    pub max: f64,
    /// From one position of a slider to the next; of a logarithmic one in decades.
    pub step: f64,
    /// Whether decades are equally long on a slider.
    pub logarithmic: bool,
    /// Whether it is a time or step that can be played.
    pub playable: bool,
    /// Which if none is given; none leaves it to the estimator, the recording or other settings.
    pub default: Option<f64>,
    /// Where a slider stands at first: at the default, or at what the estimator would take.
    pub initially: f64,
}

/// A value with a name.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Named {
    /// On the command line and in settings.
    pub name: String,
    /// What it is, for people.
    pub label: String,
    /// Earlier names.
    pub aliases: Vec<String>,
}

/// A value of a setting.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(untagged)]
pub enum Value {
    /// Of a switch.
    Switch(bool),
    /// Of a number.
    Number(f64),
    /// Of a choice or a text.
    Text(String),
    /// Of a set.
    Set(Vec<String>),
}

impl Number {
    /// A slider ends on the last whole step, give or take its rounding.
    pub(super) fn takes(&self, value: f64) -> bool {
        let slack = 1e-9 * self.max.abs().max(self.min.abs());
        (self.min - slack..=self.max + slack).contains(&value)
    }

    pub(super) fn read(&self, text: &str) -> Result<f64, String> {
        let whole = self.step >= 1.0 && self.step.fract() == 0.0 && self.unit.is_empty();
        let number = text.trim().parse::<f64>().ok();
        let number = number.filter(|value| (self.min..=self.max).contains(value));
        number.filter(|value| !whole || value.fract() == 0.0).ok_or_else(|| {
            let what = if whole { "a whole number" } else { "a number" };
            let (Self { min, max, .. }, unit) = (self, in_words(self.unit));
            format!("expected {what} from {min} to {max} {unit}").trim_end().to_owned()
        })
    }
}

impl Named {
    pub(super) fn new(name: &str, label: &str) -> Self {
        Self { name: name.to_owned(), label: label.to_owned(), aliases: Vec::new() }
    }

    /// Of an enum's variant; none if the command line does not show it.
    pub(super) fn of<T: ValueEnum>(variant: &T) -> Option<Self> {
        let value = variant.to_possible_value()?;
        let name = value.get_name().to_owned();
        let label = value.get_help().map_or_else(|| name.clone(), ToString::to_string);
        let aliases = value.get_name_and_aliases().skip(1).map(str::to_owned).collect();
        Some(Self { name, label, aliases })
    }

    pub(super) fn possible(&self) -> PossibleValue {
        let value = PossibleValue::new(self.name.clone()).help(self.label.clone());
        value.aliases(self.aliases.clone())
    }
}

pub(super) fn name_among(of: &[Named], text: &str) -> Result<String, String> {
    let is = |named: &&Named| named.name == text || named.aliases.iter().any(|name| name == text);
    let found = of.iter().find(is).map(|named| named.name.clone());
    found.ok_or_else(|| format!("expected one of {}", names(of)))
}

pub(super) fn names(of: &[Named]) -> String {
    of.iter().map(|named| named.name.as_str()).collect::<Vec<_>>().join(", ")
}

/// A unit as it is spoken, where that is short.
pub(super) fn in_words(unit: &'static str) -> &'static str {
    match unit {
        "m" => "metres",
        "s" => "seconds",
        "°" => "degrees",
        unit => unit,
    }
}
