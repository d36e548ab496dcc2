//! The kinds of values that a setting takes.

use clap::ValueEnum;
use clap::builder::PossibleValue;

/// The kind of values that a setting takes.
#[derive(Debug, Clone)]
pub enum Kind {
    /// A number within bounds.
    Number(Number),
    /// One of several named values.
    Choice {
        /// All values, in the order in which they are shown.
        of: Vec<Named>,
        /// The name of the default.
        default: String,
    },
    /// Any subset of several named values.
    Set {
        /// All values, in the order in which they are shown; the default is the empty set.
        of: Vec<Named>,
    },
    /// On or off.
    Switch {
        /// The default. A switch that is on by default is turned off by an option `--no-…`.
        default: bool,
    },
    /// A text of a certain form; without one the estimator uses its own value.
    Text {
        /// The form of the text: `X,Y,Z`.
        form: &'static str,
        /// Validates a text; the error says what was expected.
        check: fn(&str) -> Result<(), String>,
    },
}

/// A number within bounds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Number {
    /// The unit; may be empty.
    pub unit: &'static str,
    /// The minimum.
    pub min: f64,
    /// The maximum.
    pub max: f64,
    /// The step of a slider; of a logarithmic one in decades.
    pub step: f64,
    /// Whether the slider is logarithmic.
    pub logarithmic: bool,
    /// Whether the setting is a time or step that can be played.
    pub playable: bool,
    /// The default; `None` leaves the value to the estimator, the recording or other settings.
    pub default: Option<f64>,
    /// The initial position of the slider: the default, or the value that the estimator would use.
    pub initially: f64,
}

/// A named value.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Named {
    /// The name on the command line and in settings.
    pub name: String,
    /// The description for people.
    pub label: String,
    /// Earlier names of the value.
    pub aliases: Vec<String>,
}

/// A value of a setting.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(untagged)]
pub enum Value {
    /// The value of a switch.
    Switch(bool),
    /// The value of a number.
    Number(f64),
    /// The value of a choice or a text.
    Text(String),
    /// The members of a set.
    Set(Vec<String>),
}

impl Number {
    /// Whether a value is within the bounds, with a tolerance for the rounding of a slider's last step.
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

    /// The named value of an enum's variant; `None` if it is hidden on the command line.
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

/// The unit in words, where they are short.
pub(super) fn in_words(unit: &'static str) -> &'static str {
    match unit {
        "m" => "metres",
        "s" => "seconds",
        "°" => "degrees",
        unit => unit,
    }
}
