//! Settings, each declared once: the command line's option, the page's control and the help of both are derived from
//! it.

use clap::ValueEnum;

use super::kind::{Kind, Named, Number, Value, name_among};

/// A value that the user can set.
#[derive(Debug, Clone)]
pub struct Setting {
    /// The name used everywhere: `contact-height` is `--contact-height`.
    pub name: &'static str,
    /// The description: a noun phrase.
    pub help: &'static str,
    /// The kind of values that it takes.
    pub kind: Kind,
    /// Whether the setting also applies to live streams.
    pub in_live: bool,
    /// Whether the setting only selects what is shown of a track and leaves the track itself unchanged.
    pub is_view: bool,
    /// An earlier name of the option.
    pub alias: Option<&'static str>,
    /// Options without a value that stand for a choice: the name of the option and that of the choice.
    pub flags: &'static [(&'static str, &'static str)],
    /// An alternative notation for values on the command line.
    pub shorthand: Option<Shorthand>,
}

/// An alternative notation for values on the command line.
#[derive(Debug, Clone, Copy)]
pub struct Shorthand {
    /// The form of the notation: `NAME[:THRESHOLD]`.
    pub form: &'static str,
    /// Parses the values of one or more settings from a text; `None` if the text is not in this notation.
    pub read: fn(&str) -> Option<Result<Given, String>>,
}

/// Values by the names of their settings.
pub type Given = Vec<(&'static str, Value)>;

impl Setting {
    const fn new(name: &'static str, help: &'static str, kind: Kind) -> Self {
        let (in_live, is_view) = (false, false);
        Self { name, help, kind, in_live, is_view, alias: None, flags: &[], shorthand: None }
    }

    /// A number within bounds, with a slider in equal steps: `[min, max, step]`.
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

    /// A number with a logarithmic slider of 40 steps per decade.
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

    /// One of several named values, each with its name and description; the first is the default.
    pub fn choice(
        name: &'static str,
        help: &'static str,
        of: &[(&'static str, &'static str)],
    ) -> Self {
        let default = of.first().map_or_else(String::new, |(first, _)| (*first).to_owned());
        let of = of.iter().map(|(name, label)| Named::new(name, label)).collect();
        Self::new(name, help, Kind::Choice { of, default })
    }

    /// One of the variants of an enum, with its names and help of the command line.
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

    /// Any subset of the variants of an enum.
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

    /// Removes the default: a value that is not given is decided elsewhere, and only the slider starts there.
    #[must_use]
    pub const fn undecided(mut self) -> Self {
        if let Kind::Number(number) = &mut self.kind {
            number.default = None;
        }
        self
    }

    /// Marks a time or step that can be played, which only selects what is shown of a track.
    #[must_use]
    pub const fn playable(mut self) -> Self {
        if let Kind::Number(number) = &mut self.kind {
            number.playable = true;
        }
        self
    }

    /// Marks a setting that only selects what is shown of a track and leaves the track itself unchanged.
    #[must_use]
    pub const fn view(mut self) -> Self {
        self.is_view = true;
        self
    }

    /// Makes the setting available for live streams as well.
    #[must_use]
    pub const fn live(mut self) -> Self {
        self.in_live = true;
        self
    }

    /// Adds an earlier name of the option.
    #[must_use]
    pub const fn alias(mut self, alias: &'static str) -> Self {
        self.alias = Some(alias);
        self
    }

    /// Adds options without a value that stand for a choice.
    #[must_use]
    pub const fn flags(mut self, flags: &'static [(&'static str, &'static str)]) -> Self {
        self.flags = flags;
        self
    }

    /// Adds an alternative notation for values on the command line.
    #[must_use]
    pub const fn shorthand(mut self, shorthand: Shorthand) -> Self {
        self.shorthand = Some(shorthand);
        self
    }

    /// Parses a text of the command line into values of this setting and possibly others.
    ///
    /// # Errors
    /// A sentence that says what was expected.
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

    /// Whether the setting accepts a value.
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

    /// The default value; `None` if the value is decided elsewhere.
    pub fn default(&self) -> Option<Value> {
        match &self.kind {
            Kind::Number(number) => number.default.map(Value::Number),
            Kind::Choice { default, .. } => Some(Value::Text(default.clone())),
            Kind::Set { .. } => Some(Value::Set(Vec::new())),
            Kind::Switch { default } => Some(Value::Switch(*default)),
            Kind::Text { .. } => None,
        }
    }
}
