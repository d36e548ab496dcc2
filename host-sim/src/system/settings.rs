//! The settings in effect: the given values, checked against the table of available settings.

use std::collections::BTreeMap;
use std::sync::Arc;

use clap::parser::ValueSource;
use clap::{ArgMatches, ValueEnum};

use super::kind::{Kind, Value};
use super::setting::{Given, Setting};
use crate::Error;

/// The table of a system's settings, and the values that were given.
#[derive(Debug, Clone)]
pub struct Settings {
    table: Arc<[Setting]>,
    given: BTreeMap<&'static str, Value>,
}

impl PartialEq for Settings {
    /// Whether the same values are given.
    fn eq(&self, other: &Self) -> bool {
        self.given == other.given
    }
}

impl Settings {
    /// Settings with no value given: all at their defaults.
    pub fn new(table: impl Into<Arc<[Setting]>>) -> Self {
        Self { table: table.into(), given: BTreeMap::new() }
    }

    /// The settings that a page has `sent`, the rest at their defaults.
    ///
    /// # Errors
    /// [`Error::Usage`] for an unknown name or a value that the setting does not accept.
    pub fn sent(
        table: impl Into<Arc<[Setting]>>,
        sent: &serde_json::Map<String, serde_json::Value>,
    ) -> Result<Self, Error> {
        let mut settings = Self::new(table);
        for (name, value) in sent {
            let Some(setting) = settings.table.iter().find(|setting| setting.name == name) else {
                return Err(Error::Usage(format!("there is no setting {name:?}")));
            };
            let read = serde_json::from_value(value.clone()).ok();
            let Some(value) = read.filter(|value| setting.takes(value)) else {
                return Err(Error::Usage(format!("{name} cannot be {value}")));
            };
            let name = setting.name;
            settings.given.insert(name, value);
        }
        Ok(settings)
    }

    /// The settings given on the command line; unknown arguments are ignored.
    pub fn matched(table: impl Into<Arc<[Setting]>>, matches: &ArgMatches) -> Self {
        let mut settings = Self::new(table);
        let table = Arc::clone(&settings.table);
        for setting in table.iter() {
            let is_given = |id: &str| {
                let known = matches.ids().any(|known| known.as_str() == id);
                known && matches.value_source(id) == Some(ValueSource::CommandLine)
            };
            if is_given(setting.name) {
                if let Kind::Switch { default } = setting.kind {
                    settings.give(vec![(setting.name, Value::Switch(!default))]);
                } else if let Ok(Some(all)) = matches.try_get_many::<Given>(setting.name) {
                    all.for_each(|given| settings.give(given.clone()));
                }
            }
            for (flag, choice) in setting.flags {
                if is_given(flag) {
                    settings.give(vec![(setting.name, Value::Text((*choice).to_owned()))]);
                }
            }
        }
        settings
    }

    /// Sets values; members of sets are added to those already there.
    pub fn give(&mut self, given: Given) {
        for (name, value) in given {
            match (self.given.get_mut(name), value) {
                (Some(Value::Set(known)), Value::Set(more)) => {
                    known.extend(
                        more.into_iter().filter(|name| !known.contains(name)).collect::<Vec<_>>(),
                    );
                }
                (_, value) => {
                    self.given.insert(name, value);
                }
            }
        }
    }

    /// Sets the value that a text of the command line stands for.
    ///
    /// # Errors
    /// [`Error::Usage`] for an unknown name or a malformed text.
    pub fn set(&mut self, name: &str, text: &str) -> Result<(), Error> {
        let setting = self.table.iter().find(|setting| setting.name == name);
        let setting =
            setting.ok_or_else(|| Error::Usage(format!("there is no setting {name:?}")))?;
        let given = setting.read(text);
        self.give(given.map_err(|expected| Error::Usage(format!("--{name}: {expected}")))?);
        Ok(())
    }

    /// The settings without those that only select what is shown of a track.
    #[must_use]
    pub fn without_views(&self) -> Self {
        self.without(|name| self.table.iter().any(|s| s.name == name && s.is_view))
    }

    /// The settings without the given values whose names satisfy `is_so`.
    #[must_use]
    pub fn without(&self, is_so: impl Fn(&str) -> bool) -> Self {
        let mut settings = self.clone();
        settings.given.retain(|name, _| !is_so(name));
        settings
    }

    /// Adds an available setting.
    #[must_use]
    pub fn and(mut self, setting: Setting) -> Self {
        self.table = self.table.iter().cloned().chain([setting]).collect();
        self
    }

    /// The table of available settings.
    pub fn table(&self) -> &[Setting] {
        &self.table
    }

    /// The names of the given settings, in the order of the table.
    pub fn given(&self) -> impl Iterator<Item = &'static str> {
        let names = self.table.iter().map(|setting| setting.name);
        names.filter(|name| self.given.contains_key(name))
    }

    /// The given values by name, as [`Self::sent`] accepts them.
    pub fn to_json(&self) -> serde_json::Value {
        serde_json::to_value(&self.given).unwrap_or_default()
    }

    /// Whether a value is given for this setting.
    pub fn is_given(&self, name: &str) -> bool {
        self.given.contains_key(name)
    }

    fn value(&self, name: &str) -> Option<Value> {
        let default = || self.table.iter().find(|setting| setting.name == name)?.default();
        self.given.get(name).cloned().or_else(default)
    }

    /// The value of a number setting; `None` if it is not given and decided elsewhere.
    pub fn number(&self, name: &str) -> Option<f64> {
        match self.value(name) {
            Some(Value::Number(number)) => Some(number),
            _ => None,
        }
    }

    /// The value of a number setting that has a default.
    pub fn decided(&self, name: &str) -> f64 {
        self.number(name).unwrap_or_default()
    }

    /// The name of the chosen value; empty if there is no such setting.
    pub fn choice(&self, name: &str) -> String {
        self.text(name).unwrap_or_default()
    }

    /// The chosen variant of an enum; the enum's default if there is no such setting.
    pub fn chosen<T: ValueEnum + Default>(&self, name: &str) -> T {
        T::from_str(&self.choice(name), false).unwrap_or_default()
    }

    /// The given variants of a set.
    pub fn all_of<T: ValueEnum>(&self, name: &str) -> Vec<T> {
        let Some(Value::Set(names)) = self.value(name) else { return Vec::new() };
        names.iter().filter_map(|name| T::from_str(name, false).ok()).collect()
    }

    /// The value of a text or choice, if there is one.
    pub fn text(&self, name: &str) -> Option<String> {
        match self.value(name) {
            Some(Value::Text(text)) => Some(text),
            _ => None,
        }
    }

    /// Whether a switch is on; false if there is none of that name.
    pub fn is_on(&self, name: &str) -> bool {
        self.value(name) == Some(Value::Switch(true))
    }

    /// The options of an equivalent command line: the values that differ from the defaults.
    pub fn arguments(&self) -> Vec<String> {
        let differing = self.table.iter().filter_map(|setting| {
            let value = self.given.get(setting.name)?;
            (setting.default().as_ref() != Some(value)).then_some((setting, value))
        });
        differing
            .flat_map(|(setting, value)| {
                let option = format!("--{}", setting.option());
                match value {
                    Value::Switch(_) => vec![option],
                    Value::Number(number) => vec![option, number.to_string()],
                    Value::Text(text) => vec![option, text.clone()],
                    Value::Set(names) => {
                        names.iter().flat_map(|name| [option.clone(), name.clone()]).collect()
                    }
                }
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Command;
    use serde_json::json;

    fn table() -> Vec<Setting> {
        vec![
            Setting::number("threshold", "threshold", "g", [0.0, 1.0, 0.01], 0.1),
            Setting::number("rate", "rate", "Hz", [1.0, 100.0, 1.0], 50.0).undecided(),
            Setting::choice("tracker", "tracker", &[("ekf", "EKF"), ("lite", "integration")]),
            Setting::switch("causal", "look only backwards", false),
            Setting::switch("gate", "leave outliers out", true),
            Setting::choice(
                "environment",
                "what is built",
                &[("open", "nothing"), ("urban", "a town")],
            )
            .flags(&[("free-space", "open")]),
        ]
    }

    fn matched(arguments: &[String]) -> Result<Settings, clap::Error> {
        let command = Command::new("test").no_binary_name(true);
        let command = command.args(table().iter().flat_map(Setting::arguments));
        Ok(Settings::matched(table(), &command.try_get_matches_from(arguments)?))
    }

    #[test]
    fn what_is_not_sent_is_at_its_default() -> Result<(), Error> {
        let sent = json!({ "threshold": 0.25, "causal": true });
        let settings = Settings::sent(table(), sent.as_object().unwrap())?;
        assert_eq!(settings.number("threshold"), Some(0.25));
        assert_eq!((settings.number("rate"), settings.choice("tracker").as_str()), (None, "ekf"));
        assert!(settings.is_on("causal") && settings.is_on("gate"));
        Ok(())
    }

    #[test]
    fn what_no_setting_can_be_is_refused() {
        for sent in [
            json!({ "threshold": 2 }),
            json!({ "threshold": "high" }),
            json!({ "tracker": "best" }),
            json!({ "causal": 1 }),
            json!({ "speed": 1 }),
        ] {
            let refusal = Settings::sent(table(), sent.as_object().unwrap()).unwrap_err();
            assert!(!refusal.to_string().contains('\n'), "{refusal}");
        }
    }

    #[test]
    fn the_arguments_give_the_same_settings_again() {
        for sent in [
            json!({}),
            json!({ "threshold": 0.25, "rate": 20.5, "tracker": "lite", "causal": true, "gate": false }),
            json!({ "threshold": 0.1, "gate": true, "environment": "urban" }),
        ] {
            let settings = Settings::sent(table(), sent.as_object().unwrap()).unwrap();
            let again = matched(&settings.arguments()).unwrap();
            assert_eq!(again.arguments(), settings.arguments());
            for name in ["threshold", "rate", "tracker", "causal", "gate", "environment"] {
                assert_eq!(again.value(name), settings.value(name), "{name}");
            }
        }
        let flagged = matched(&["--free-space".to_owned()]).unwrap();
        assert_eq!(flagged.choice("environment"), "open");
    }
}
