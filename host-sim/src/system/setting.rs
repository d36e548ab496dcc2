//! A setting is said once: the option of the command line, the page's control and both their help come from it.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::{Arg, ArgAction, ValueEnum};
use serde_json::{Map, json};

/// Something that a person can set.
#[derive(Debug, Clone)]
pub struct Setting {
    /// Its name everywhere: `contact-height` is `--contact-height`.
    pub name: &'static str,
    /// What it is: a noun phrase.
    pub help: &'static str,
    /// What values it has.
    pub kind: Kind,
    /// Whether it acts on a stream that is followed while it comes.
    pub in_live: bool,
    /// Whether it chooses what is shown of a track, and the track itself is the same.
    pub is_view: bool,
    /// An earlier name of the option.
    pub alias: Option<&'static str>,
    /// Options without a value that stand for a choice: the option's name and the choice's.
    pub flags: &'static [(&'static str, &'static str)],
    /// Another spelling of values on the command line.
    pub shorthand: Option<Shorthand>,
}

/// Another spelling of values on the command line.
#[derive(Debug, Clone, Copy)]
pub struct Shorthand {
    /// What it looks like: `NAME[:THRESHOLD]`.
    pub form: &'static str,
    /// The values of one or more settings that a text stands for; none if it is no such text.
    pub read: fn(&str) -> Option<Result<Given, String>>,
}

/// Settings by name with their values.
pub type Given = Vec<(&'static str, Value)>;

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

impl Setting {
    const fn new(name: &'static str, help: &'static str, kind: Kind) -> Self {
        let (in_live, is_view) = (false, false);
        Self { name, help, kind, in_live, is_view, alias: None, flags: &[], shorthand: None }
    }

    /// A number from the least to the greatest in equally long steps: `[min, max, step]`.
    pub const fn number(
        name: &'static str,
        help: &'static str,
        unit: &'static str,
        [min, max, step]: [f64; 3],
        default: f64,
    ) -> Self {
        let (logarithmic, playable, initially) = (false, false, default);
        let default = Some(default);
        let number = Number { unit, min, max, step, logarithmic, playable, default, initially };
        Self::new(name, help, Kind::Number(number))
    }

    /// A number whose decades are equally long on a slider, 40 steps each.
    pub const fn decades(
        name: &'static str,
        help: &'static str,
        unit: &'static str,
        [min, max]: [f64; 2],
        default: f64,
    ) -> Self {
        let mut setting = Self::number(name, help, unit, [min, max, 0.025], default);
        if let Kind::Number(number) = &mut setting.kind {
            number.logarithmic = true;
        }
        setting
    }

    /// One of a few, each with its name and what people call it; the first is the default.
    pub fn choice(
        name: &'static str,
        help: &'static str,
        of: &[(&'static str, &'static str)],
    ) -> Self {
        let default = of.first().map_or_else(String::new, |(first, _)| (*first).to_owned());
        let of = of.iter().map(|(name, label)| Named::new(name, label)).collect();
        Self::new(name, help, Kind::Choice { of, default })
    }

    /// One of the variants of an enum, with the names and the help of its command line.
    pub fn one_of<T: ValueEnum>(name: &'static str, help: &'static str, default: &T) -> Self {
        Self::some_of(name, help, T::value_variants(), default)
    }

    /// One of some variants of an enum.
    pub fn some_of<T: ValueEnum>(
        name: &'static str,
        help: &'static str,
        variants: &[T],
        default: &T,
    ) -> Self {
        let default = Named::of(default).map_or_else(String::new, |named| named.name);
        let of = variants.iter().filter_map(Named::of).collect();
        Self::new(name, help, Kind::Choice { of, default })
    }

    /// Any of the variants of an enum.
    pub fn any_of<T: ValueEnum>(name: &'static str, help: &'static str) -> Self {
        let of = T::value_variants().iter().filter_map(Named::of).collect();
        Self::new(name, help, Kind::Set { of })
    }

    /// On or off.
    pub const fn switch(name: &'static str, help: &'static str, default: bool) -> Self {
        Self::new(name, help, Kind::Switch { default })
    }

    /// A text of the form that `check` accepts.
    pub const fn text(
        name: &'static str,
        help: &'static str,
        form: &'static str,
        check: fn(&str) -> Result<(), String>,
    ) -> Self {
        Self::new(name, help, Kind::Text { form, check })
    }

    /// Without a default: what it is when nothing is given, others decide; a slider stands there at first.
    #[must_use]
    pub const fn undecided(mut self) -> Self {
        if let Kind::Number(number) = &mut self.kind {
            number.default = None;
        }
        self
    }

    /// A time or step that can be played, and chooses what is shown of a track.
    #[must_use]
    pub const fn playable(mut self) -> Self {
        if let Kind::Number(number) = &mut self.kind {
            number.playable = true;
        }
        self
    }

    /// Chooses what is shown of a track, and the track itself is the same.
    #[must_use]
    pub const fn view(mut self) -> Self {
        self.is_view = true;
        self
    }

    /// Acts on a stream that is followed while it comes, too.
    #[must_use]
    pub const fn live(mut self) -> Self {
        self.in_live = true;
        self
    }

    /// With an earlier name of the option.
    #[must_use]
    pub const fn alias(mut self, alias: &'static str) -> Self {
        self.alias = Some(alias);
        self
    }

    /// With options without a value that stand for a choice.
    #[must_use]
    pub const fn flags(mut self, flags: &'static [(&'static str, &'static str)]) -> Self {
        self.flags = flags;
        self
    }

    /// With another spelling of values on the command line.
    #[must_use]
    pub const fn shorthand(mut self, shorthand: Shorthand) -> Self {
        self.shorthand = Some(shorthand);
        self
    }

    /// The option's name without its dashes.
    pub fn option(&self) -> String {
        match self.kind {
            Kind::Switch { default: true } => format!("no-{}", self.name),
            _ => self.name.to_owned(),
        }
    }

    /// Options of the command line.
    pub fn arguments(&self) -> Vec<Arg> {
        let flag = |&(name, choice): &(&'static str, &'static str)| {
            let help = format!("As --{} {choice}", self.name);
            let arg = Arg::new(name).long(name).help(help).action(ArgAction::SetTrue);
            arg.conflicts_with(self.name)
        };
        std::iter::once(self.argument()).chain(self.flags.iter().map(flag)).collect()
    }

    fn argument(&self) -> Arg {
        let arg = Arg::new(self.name).long(self.option()).help(self.help_with_default());
        let arg = if let Some(alias) = self.alias { arg.alias(alias) } else { arg };
        let setting = self.clone();
        let read = move |text: String| setting.read(&text);
        match &self.kind {
            Kind::Switch { .. } => arg.action(ArgAction::SetTrue),
            Kind::Number(_) | Kind::Text { .. } => arg
                .value_name(self.form())
                .allow_hyphen_values(true)
                .value_parser(clap::builder::StringValueParser::new().try_map(read)),
            Kind::Choice { of, .. } if self.shorthand.is_some() => {
                let form = self.shorthand.map_or("NAME", |shorthand| shorthand.form);
                arg.value_name(form)
                    .help(format!("{}: {}", self.help_with_default(), names(of)))
                    .value_parser(clap::builder::StringValueParser::new().try_map(read))
            }
            Kind::Choice { of, .. } | Kind::Set { of } => {
                let values = PossibleValuesParser::new(of.iter().map(Named::possible));
                let arg = arg.value_name("NAME").value_parser(values.try_map(read));
                let many = matches!(self.kind, Kind::Set { .. });
                arg.action(if many { ArgAction::Append } else { ArgAction::Set })
            }
        }
    }

    /// The values that a text of the command line stands for, of this setting and perhaps others.
    ///
    /// # Errors
    /// What was expected.
    pub fn read(&self, text: &str) -> Result<Given, String> {
        if let Some(given) = self.shorthand.and_then(|shorthand| (shorthand.read)(text)) {
            return given;
        }
        let value = match &self.kind {
            Kind::Number(number) => Value::Number(number.read(text)?),
            Kind::Text { check, .. } => {
                check(text)?;
                Value::Text(text.to_owned())
            }
            Kind::Choice { of, .. } => Value::Text(name_among(of, text)?),
            Kind::Set { of } => Value::Set(vec![name_among(of, text)?]),
            Kind::Switch { .. } => {
                Value::Switch(text.parse().map_err(|_| "expected true or false".to_owned())?)
            }
        };
        Ok(vec![(self.name, value)])
    }

    /// Whether a value is one that this can have.
    pub fn takes(&self, value: &Value) -> bool {
        match (&self.kind, value) {
            (Kind::Number(number), Value::Number(value)) => number.takes(*value),
            (Kind::Choice { of, .. }, Value::Text(name)) => name_among(of, name).is_ok(),
            (Kind::Set { of }, Value::Set(names)) => {
                names.iter().all(|name| name_among(of, name).is_ok())
            }
            (Kind::Text { check, .. }, Value::Text(text)) => check(text).is_ok(),
            (Kind::Switch { .. }, Value::Switch(_)) => true,
            _ => false,
        }
    }

    /// The value if none is given; none if others decide.
    pub fn default(&self) -> Option<Value> {
        match &self.kind {
            Kind::Number(number) => number.default.map(Value::Number),
            Kind::Choice { default, .. } => Some(Value::Text(default.clone())),
            Kind::Set { .. } => Some(Value::Set(Vec::new())),
            Kind::Switch { default } => Some(Value::Switch(*default)),
            Kind::Text { .. } => None,
        }
    }

    /// The page's control.
    pub fn control(&self) -> serde_json::Value {
        let mut control = Map::new();
        control.insert("name".to_owned(), json!(self.name));
        control.insert("label".to_owned(), json!(self.help));
        let options = |of: &[Named]| -> serde_json::Value {
            of.iter().map(|named| json!([named.name, named.label])).collect()
        };
        let rest = match &self.kind {
            Kind::Number(number) => number.control(),
            Kind::Choice { of, default } => {
                json!({ "kind": "choice", "options": options(of), "value": default })
            }
            Kind::Set { of } => json!({ "kind": "set", "options": options(of) }),
            Kind::Switch { default } => json!({ "kind": "switch", "value": default }),
            Kind::Text { form, .. } => json!({ "kind": "text", "form": form }),
        };
        if let serde_json::Value::Object(rest) = rest {
            control.extend(rest);
        }
        control.into()
    }

    fn help_with_default(&self) -> String {
        let help = self.help;
        match &self.kind {
            Kind::Number(Number { unit, default: Some(default), .. }) => {
                format!("{help} [default: {}]", format!("{default} {unit}").trim_end())
            }
            Kind::Choice { default, .. } => format!("{help} [default: {default}]"),
            Kind::Switch { default: true } => format!("Without this: {help}"),
            _ => help.to_owned(),
        }
    }

    /// What values look like on the command line: `METRES`, `X,Y,Z`, `P1|P2`.
    pub fn form(&self) -> String {
        let unit = match &self.kind {
            Kind::Number(number) => number.unit,
            Kind::Text { form, .. } => return (*form).to_owned(),
            Kind::Choice { of, .. } | Kind::Set { of } => {
                return of.iter().map(|named| named.name.as_str()).collect::<Vec<_>>().join("|");
            }
            Kind::Switch { .. } => return String::new(),
        };
        match unit {
            "" => "N".to_owned(),
            unit => in_words(unit).to_uppercase(),
        }
    }
}

/// A unit as it is spoken, where that is short.
fn in_words(unit: &'static str) -> &'static str {
    match unit {
        "m" => "metres",
        "s" => "seconds",
        "°" => "degrees",
        unit => unit,
    }
}

impl Number {
    /// A slider ends on the last whole step, give or take its rounding.
    fn takes(&self, value: f64) -> bool {
        let slack = 1e-9 * self.max.abs().max(self.min.abs());
        (self.min - slack..=self.max + slack).contains(&value)
    }

    fn read(&self, text: &str) -> Result<f64, String> {
        let whole = self.step >= 1.0 && self.step.fract() == 0.0 && self.unit.is_empty();
        let number = text.trim().parse::<f64>().ok();
        let number = number.filter(|value| (self.min..=self.max).contains(value));
        number.filter(|value| !whole || value.fract() == 0.0).ok_or_else(|| {
            let what = if whole { "a whole number" } else { "a number" };
            let (Self { min, max, .. }, unit) = (self, in_words(self.unit));
            format!("expected {what} from {min} to {max} {unit}").trim_end().to_owned()
        })
    }

    fn control(&self) -> serde_json::Value {
        json!({
            "kind": "slider",
            "unit": self.unit,
            "min": self.min,
            "max": self.max,
            "step": self.step,
            "value": self.initially,
            "logarithmic": self.logarithmic,
            "playable": self.playable,
        })
    }
}

impl Named {
    fn new(name: &str, label: &str) -> Self {
        Self { name: name.to_owned(), label: label.to_owned(), aliases: Vec::new() }
    }

    /// Of an enum's variant; none if the command line does not show it.
    fn of<T: ValueEnum>(variant: &T) -> Option<Self> {
        let value = variant.to_possible_value()?;
        let name = value.get_name().to_owned();
        let label = value.get_help().map_or_else(|| name.clone(), ToString::to_string);
        let aliases = value.get_name_and_aliases().skip(1).map(str::to_owned).collect();
        Some(Self { name, label, aliases })
    }

    fn possible(&self) -> PossibleValue {
        let value = PossibleValue::new(self.name.clone()).help(self.label.clone());
        value.aliases(self.aliases.clone())
    }
}

fn name_among(of: &[Named], text: &str) -> Result<String, String> {
    let is = |named: &&Named| named.name == text || named.aliases.iter().any(|name| name == text);
    let found = of.iter().find(is).map(|named| named.name.clone());
    found.ok_or_else(|| format!("expected one of {}", names(of)))
}

fn names(of: &[Named]) -> String {
    of.iter().map(|named| named.name.as_str()).collect::<Vec<_>>().join(", ")
}
