//! The sources of a recording.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use clap::{Arg, ArgAction, ArgMatches, value_parser};
use kestirim_sweep::Shared;

use super::reading::Reading;
use super::setting::Setting;
use super::settings::Settings;
use crate::Error;
use crate::text::printable_path;

/// A file that is part of a recording.
///
/// A setting of the same name is an alternative: `--height 0.1` or `--height FILE`.
#[derive(Debug, Clone, Copy, serde::Serialize)]
#[expect(clippy::struct_excessive_bools, reason = "each says something of its own")]
pub struct FileField {
    /// The name used everywhere: `log` is `--log`.
    pub name: &'static str,
    /// The contents of the file, with its columns.
    #[serde(rename = "label")]
    pub help: &'static str,
    /// Whether the file is required for a recording.
    pub required: bool,
    /// Whether there may be more than one such file.
    pub several: bool,
    /// Whether the file is also read for a live stream.
    #[serde(skip)]
    pub in_live: bool,
    /// Whether the file may be a log of an unknown device, whose columns and units are inferred or given by the user.
    pub imported: bool,
}

impl FileField {
    /// A required file.
    pub const fn required(name: &'static str, help: &'static str) -> Self {
        Self { name, help, required: true, several: false, in_live: false, imported: false }
    }

    /// An optional file.
    pub const fn optional(name: &'static str, help: &'static str) -> Self {
        Self { name, help, required: false, several: false, in_live: false, imported: false }
    }

    /// Allows more than one such file.
    #[must_use]
    pub const fn several(mut self) -> Self {
        self.several = true;
        self
    }

    /// Makes the file available for live streams as well.
    #[must_use]
    pub const fn live(mut self) -> Self {
        self.in_live = true;
        self
    }

    /// Accepts logs of unknown devices.
    #[must_use]
    pub const fn imported(mut self) -> Self {
        self.imported = true;
        self
    }

    /// The option of the command line for this file.
    pub fn argument(&self, settings: &[Setting]) -> Arg {
        let arg = Arg::new(self.name).long(self.name).help(self.help);
        let alternative = settings.iter().find(|setting| setting.name == self.name);
        let arg = match alternative {
            Some(setting) => {
                let value_name = format!("{}|FILE", setting.form());
                let help = format!("{}, or {}", setting.help, self.help);
                arg.value_name(value_name).help(help).allow_hyphen_values(true)
            }
            None => arg.value_name("FILE").value_parser(value_parser!(PathBuf)),
        };
        arg.action(if self.several { ArgAction::Append } else { ArgAction::Set })
    }
}

/// The paths of a recording's files by the names of their fields, and how they are to be read.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Files {
    paths: BTreeMap<String, Vec<PathBuf>>,
    /// The user's description of an imported log.
    pub reading: Reading,
    /// Data that related recordings have already read.
    pub shared: Shared,
}

impl Files {
    /// The files that the command line names. A text that is a value of the setting of the same name goes to that
    /// setting.
    ///
    /// # Errors
    /// Those of [`Reading::matched`].
    pub fn matched(
        fields: &[FileField],
        matches: &ArgMatches,
        settings: &mut Settings,
    ) -> Result<Self, Error> {
        let mut files = Self { reading: Reading::matched(matches)?, ..Self::default() };
        for field in fields {
            if let Ok(Some(paths)) = matches.try_get_many::<PathBuf>(field.name) {
                paths.for_each(|path| files.add(field.name, path));
            } else if let Ok(Some(texts)) = matches.try_get_many::<String>(field.name) {
                for text in texts {
                    if settings.set(field.name, text).is_err() {
                        files.add(field.name, text);
                    }
                }
            }
        }
        Ok(files)
    }

    /// The same files, without the data already read from them.
    #[must_use]
    pub fn without_what_was_read(&self) -> Self {
        Self { shared: Shared::default(), ..self.clone() }
    }

    /// Adds a file.
    pub fn add(&mut self, field: impl Into<String>, path: impl Into<PathBuf>) {
        self.paths.entry(field.into()).or_default().push(path.into());
    }

    /// The first file of a field, if there is one.
    pub fn one(&self, field: &str) -> Option<&Path> {
        self.all(field).first().map(PathBuf::as_path)
    }

    /// All files of a field.
    pub fn all(&self, field: &str) -> &[PathBuf] {
        self.paths.get(field).map_or(&[], Vec::as_slice)
    }

    /// All files of all fields.
    pub fn paths(&self) -> impl Iterator<Item = &PathBuf> + Clone {
        self.paths.values().flatten()
    }

    /// The file of a field, which is required.
    ///
    /// # Errors
    /// [`Error::Usage`] if it is missing.
    pub fn required(&self, field: &str) -> Result<&Path, Error> {
        self.one(field).ok_or_else(|| Error::Usage(format!("a file is needed: --{field}")))
    }

    /// Refuses files that exclude each other.
    ///
    /// # Errors
    /// [`Error::Usage`] if both `one` and any of the others are given.
    pub fn exclude(&self, one: &str, others: &[&str]) -> Result<(), Error> {
        let other = others.iter().find(|other| self.one(other).is_some());
        match (self.one(one), other) {
            (Some(_), Some(other)) => {
                Err(Error::Usage(format!("--{one} cannot be used with --{other}")))
            }
            _ => Ok(()),
        }
    }
}

/// The source of a recording.
#[derive(Debug, Clone, PartialEq)]
pub enum Source {
    /// Recorded files.
    Files(Files),
    /// A synthetic recording, by name.
    Synthetic(String),
}

impl Source {
    /// The options of the command line that name the source; uploaded files appear by their file names only.
    pub fn arguments(&self) -> Vec<String> {
        match self {
            Self::Synthetic(name) => vec!["--synthetic".to_owned(), name.clone()],
            Self::Files(Files { paths, reading, .. }) => {
                let each = paths.iter().flat_map(|(field, paths)| {
                    paths.iter().map(move |path| [format!("--{field}"), printable_path(path)])
                });
                each.flatten().chain(reading.words()).collect()
            }
        }
    }
}
