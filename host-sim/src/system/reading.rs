//! What a user says about a log that does not say it by itself.

use std::collections::BTreeMap;

use clap::{Arg, ArgAction, ArgMatches};
use kestirim_import::{Format, Options};

use crate::Error;

/// Options with a text, the form of the text, and what they say.
const TEXTS: [(&str, &str, &str); 4] = [
    (
        "columns",
        "NAMES",
        "Which columns are which, such as t=timestamp,ax=AccX,gy=-GyrZ; a minus sign turns an axis round [default: found]",
    ),
    (
        "units",
        "UNITS",
        "Units of the log, such as acc=g,gyro=deg/s,t=ms; acc=-g for one that shows -1 g upwards at rest [default: found]",
    ),
    ("format", "NAME", "Device or program that wrote the log [default: recognised]"),
    (
        "topic",
        "NAME",
        "Which of several sensors in the file: a topic of ROS or MCAP, the number of an ArduPilot, PX4 or OpenShoe sensor, a transmitter in the column user of a flight [default: the only one, or 0]",
    ),
];
/// The option without one.
const STRICT: &str = "strict";

/// What a user says about a log.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Reading {
    options: Box<Options>,
    /// As it was said.
    given: BTreeMap<&'static str, String>,
}

impl Reading {
    /// The options of the command line.
    pub fn arguments() -> impl Iterator<Item = Arg> {
        let texts = TEXTS.into_iter().map(|(name, form, help)| {
            let help = match name {
                "format" => format!("{help}: {}", Format::names().collect::<Vec<_>>().join(", ")),
                _ => help.to_owned(),
            };
            Arg::new(name).long(name).value_name(form).help(help)
        });
        let strict = Arg::new(STRICT).long(STRICT).action(ArgAction::SetTrue);
        texts.chain([strict.help("Refuse a log at its first damaged line instead of skipping it")])
    }

    /// The names of the options with a text.
    pub fn texts() -> impl Iterator<Item = &'static str> {
        TEXTS.into_iter().map(|(name, ..)| name)
    }

    /// For the page: each option with a text, and what it says.
    pub fn forms() -> Vec<(&'static str, &'static str)> {
        TEXTS.into_iter().map(|(name, _, help)| (name, help)).collect()
    }

    /// What the command line says.
    ///
    /// # Errors
    /// [`Error::Usage`] for a text that is not of its form.
    pub fn matched(matches: &ArgMatches) -> Result<Self, Error> {
        let mut reading = Self::default();
        for name in Self::texts() {
            if let Ok(Some(text)) = matches.try_get_one::<String>(name) {
                reading.say(name, text)?;
            }
        }
        if let Ok(Some(true)) = matches.try_get_one::<bool>(STRICT) {
            reading.options.strict = true;
        }
        Ok(reading)
    }

    /// Says something; nothing by an empty text.
    ///
    /// # Errors
    /// [`Error::Usage`] for a text that is not of its form, or an unknown name.
    pub fn say(&mut self, name: &str, text: &str) -> Result<(), Error> {
        let known = Self::texts().find(|known| *known == name);
        let name = known.ok_or_else(|| Error::Usage(format!("there is no option {name:?}")))?;
        if text.is_empty() {
            return Ok(());
        }
        let said = match name {
            "columns" => text.parse().map(|columns| self.options.columns = columns),
            "units" => text.parse().map(|units| self.options.units = units),
            "topic" => {
                self.options.topic = Some(text.to_owned());
                Ok(())
            }
            _ => text.parse().map(|format| self.options.format = Some(format)),
        };
        said.map_err(|error| Error::Usage(format!("--{name}: {error}")))?;
        self.given.insert(name, text.to_owned());
        Ok(())
    }

    /// For the importer.
    pub fn options(&self) -> &Options {
        &self.options
    }

    /// For a reader of tables, which are recognised by their columns.
    ///
    /// # Errors
    /// [`Error::Usage`] if a format is said.
    pub fn tables(&self) -> Result<&Options, Error> {
        match self.options.format {
            None => Ok(&self.options),
            Some(format) => Err(Error::Usage(format!(
                "--format {}: expected --columns and --units, as this log is no {format}",
                format.name()
            ))),
        }
    }

    /// The words of a command line that say the same.
    pub fn words(&self) -> Vec<String> {
        let texts = self.given.iter().flat_map(|(name, text)| [format!("--{name}"), text.clone()]);
        let strict = self.options.strict.then(|| format!("--{STRICT}"));
        texts.chain(strict).collect()
    }
}
