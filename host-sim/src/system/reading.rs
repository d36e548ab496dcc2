//! The user's description of a log that does not describe itself.

use std::collections::BTreeMap;

use clap::{Arg, ArgAction, ArgMatches};
use kestirim_import::{Format, Options};

use crate::Error;

/// The options with a text: name, form of the text and help.
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
        "Which of several sensors in the file: a topic of ROS or MCAP, the number of an ArduPilot, PX4 or OpenShoe sensor, a transmitter in the column user of a flight, a tag of ranges [default: the only one; of sensors with numbers 0]",
    ),
];
/// The name of the only option without a text.
const STRICT: &str = "strict";

/// The user's description of a log.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Reading {
    options: Box<Options>,
    /// The texts as given.
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

    /// Each option with a text and its help, for the page.
    pub fn forms() -> Vec<(&'static str, &'static str)> {
        TEXTS.into_iter().map(|(name, _, help)| (name, help)).collect()
    }

    /// The description given on the command line.
    ///
    /// # Errors
    /// [`Error::Usage`] for a malformed text.
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

    /// Sets an option; an empty text sets nothing.
    ///
    /// # Errors
    /// [`Error::Usage`] for a malformed text or an unknown name.
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

    /// The options for the importer.
    pub fn options(&self) -> &Options {
        &self.options
    }

    /// The options for a reader of tables, which are recognised by their columns.
    ///
    /// # Errors
    /// [`Error::Usage`] if a format is given.
    pub fn tables(&self) -> Result<&Options, Error> {
        match self.options.format {
            None => Ok(&self.options),
            Some(format) => Err(Error::Usage(format!(
                "--format {}: expected --columns and --units, as this log is no {format}",
                format.name()
            ))),
        }
    }

    /// The words of an equivalent command line.
    pub fn words(&self) -> Vec<String> {
        let texts = self.given.iter().flat_map(|(name, text)| [format!("--{name}"), text.clone()]);
        let strict = self.options.strict.then(|| format!("--{STRICT}"));
        texts.chain(strict).collect()
    }
}
