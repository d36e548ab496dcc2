use serde::Serialize;

/// Something to turn.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum Control {
    /// A number.
    Slider(Slider),
    /// One of a few.
    Choice(Choice),
    /// On or off.
    Switch(Switch),
}

/// A number within bounds.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Slider {
    /// Name in the [`Settings`](super::Settings).
    pub name: &'static str,
    /// What it is, for people.
    pub label: &'static str,
    /// Its unit; may be empty.
    pub unit: &'static str,
    /// The least value.
    pub min: f64,
    /// The greatest value.
    pub max: f64,
    /// From one position to the next; of a logarithmic slider in decades.
    pub step: f64,
    /// Where it stands at first.
    pub value: f64,
    /// Whether decades are equally long.
    pub logarithmic: bool,
    /// Whether it is a time that can be played.
    pub playable: bool,
}

/// One of a few.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Choice {
    /// Name in the [`Settings`](super::Settings).
    pub name: &'static str,
    /// What it is, for people.
    pub label: &'static str,
    /// Names of the options and what people call them.
    pub options: Vec<(String, String)>,
    /// Which is chosen at first.
    pub value: String,
}

/// On or off.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Switch {
    /// Name in the [`Settings`](super::Settings).
    pub name: &'static str,
    /// What it is, for people.
    pub label: &'static str,
    /// How it stands at first.
    pub value: bool,
}

impl Slider {
    /// From the least to the greatest value in equally long steps.
    const fn new(
        name: &'static str,
        label: &'static str,
        unit: &'static str,
        [min, max, step]: [f64; 3],
        value: f64,
    ) -> Self {
        let (logarithmic, playable) = (false, false);
        Self { name, label, unit, min, max, step, value, logarithmic, playable }
    }
}

impl Control {
    /// A slider with equally long steps.
    pub const fn slider(
        name: &'static str,
        label: &'static str,
        unit: &'static str,
        range: [f64; 3],
        value: f64,
    ) -> Self {
        Self::Slider(Slider::new(name, label, unit, range, value))
    }

    /// A slider with equally long decades, 40 steps each.
    pub const fn decades(
        name: &'static str,
        label: &'static str,
        unit: &'static str,
        [min, max]: [f64; 2],
        value: f64,
    ) -> Self {
        let slider = Slider::new(name, label, unit, [min, max, 0.025], value);
        Self::Slider(Slider { logarithmic: true, ..slider })
    }

    /// A time or step that can be played like a film.
    pub const fn playable(
        name: &'static str,
        label: &'static str,
        unit: &'static str,
        range: [f64; 3],
        value: f64,
    ) -> Self {
        Self::Slider(Slider { playable: true, ..Slider::new(name, label, unit, range, value) })
    }

    /// One of a few, each with its name and what people call it; the first at first.
    pub fn choice(name: &'static str, label: &'static str, options: &[(&str, &str)]) -> Self {
        let value = options.first().map_or_else(String::new, |(option, _)| (*option).to_owned());
        let options =
            options.iter().map(|&(name, label)| (name.to_owned(), label.to_owned())).collect();
        Self::Choice(Choice { name, label, options, value })
    }

    /// On or off.
    pub fn switch(name: &'static str, label: &'static str, value: bool) -> Self {
        Self::Switch(Switch { name, label, value })
    }

    /// Its name in the settings.
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Slider(Slider { name, .. })
            | Self::Choice(Choice { name, .. })
            | Self::Switch(Switch { name, .. }) => name,
        }
    }
}
