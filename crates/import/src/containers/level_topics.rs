//! ROS topics that hold a drone's positions, its height, and the level of a radio on board.

use std::collections::BTreeSet;

use super::catalogue::{Catalogue, MOST_NAMES};
use super::chunks::{Announced, Messages};
use super::gather::Losses;
use super::imu_message::Encoding;
use super::number_message::{NumberMessage, Values};
use crate::damage::Fault;
use crate::error::{Error, listed};
use crate::options::Options;
use crate::unit::Unit;

/// The content of a topic.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Role {
    /// Latitude, longitude, altitude, and whether there is a fix.
    Fix,
    /// A height above the take-off point.
    Height,
    /// A received level.
    Level,
    /// A path loss.
    Loss,
}

impl Role {
    /// The name of the corresponding column in a table.
    pub(crate) fn column(self) -> &'static str {
        match self {
            Self::Fix => "lat",
            Self::Height => "h",
            Self::Level => "rssi_db",
            Self::Loss => "path_loss_db",
        }
    }
}

/// The numbers of one message.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Entry {
    /// The times at which it was sent and received, µs since 1970; the first is 0 or `None` without a stamp.
    pub(crate) stamp: Option<f64>,
    pub(crate) receipt: f64,
    /// The values: as many as the role has, followed by NaN.
    pub(crate) values: Values,
}

/// A topic that may hold wanted data.
#[derive(Debug)]
pub(crate) struct Topic {
    pub(crate) name: String,
    pub(crate) role: Role,
    /// The name of the field that holds the number.
    pub(crate) field: String,
    unit: Option<Unit>,
    message: NumberMessage,
    pub(crate) entries: Vec<Entry>,
}

/// The topics of a file, with their data.
pub(crate) struct LevelTopics<'o> {
    options: &'o Options,
    catalogue: Catalogue<Topic>,
    /// The names of topics that may hold levels, although nothing confirms it.
    doubtful: BTreeSet<String>,
    pub(crate) losses: Losses,
}

impl<'o> LevelTopics<'o> {
    pub(super) fn new(options: &'o Options) -> Self {
        Self {
            options,
            catalogue: Catalogue::default(),
            doubtful: BTreeSet::new(),
            losses: Losses::default(),
        }
    }

    /// The single topic of positions.
    ///
    /// # Errors
    /// If there is none, or several and no option chooses.
    pub(crate) fn fixes(&self) -> Result<&Topic, Error> {
        let found: Vec<_> = self.of(&[Role::Fix]).collect();
        match found[..] {
            [only] => Ok(only),
            [] => Err(Error::log(format!(
                "expected places as a topic of sensor_msgs/NavSatFix, found {}",
                self.catalogue.listed_others()
            ))),
            [first, ..] => Err(several("sensor_msgs/NavSatFix", &found, first, "--columns lat=")),
        }
    }

    /// The single topic of heights, if there is one.
    ///
    /// # Errors
    /// If there are several and no option chooses.
    pub(crate) fn heights(&self) -> Result<Option<&Topic>, Error> {
        let found: Vec<_> = self.of(&[Role::Height]).collect();
        match found[..] {
            [first, _, ..] => Err(several("heights", &found, first, "--columns h=")),
            _ => Ok(found.first().copied()),
        }
    }

    /// The single topic of levels or path losses.
    ///
    /// # Errors
    /// If there is none, or several and no option chooses.
    pub(crate) fn levels(&self) -> Result<&Topic, Error> {
        let found: Vec<_> = self.of(&[Role::Level, Role::Loss]).collect();
        match found[..] {
            [only] => Ok(only),
            [] if self.options.topic.is_some() => Err(Error::options(format!(
                "expected a level on the topic that --topic says, found {}",
                self.catalogue.listed_others()
            ))),
            [] => Err(match self.doubtful.first() {
                Some(first) => Error::undecided(
                    format!(
                        "expected a topic of levels in dB, such as rssi, found {}",
                        listed(self.doubtful.iter().map(String::as_str))
                    ),
                    format!("--columns rssi_db={}", listed([first.as_str()])),
                ),
                None => Error::log(format!(
                    "expected levels as a topic of a number that is called rssi, rx_power or level_dbm, and whose definition \
                     is in the file, found {}",
                    self.catalogue.listed_others()
                )),
            }),
            [first, ..] => Err(several("levels", &found, first, "--topic ")),
        }
    }

    /// The factor that converts a topic's numbers to dB.
    ///
    /// # Errors
    /// If the numbers are unsigned integers and no option gives their unit.
    pub(crate) fn scale(&self, topic: &Topic) -> Result<f64, Error> {
        let column = topic.role.column();
        let unit = self.options.units.of(column).or_else(|| topic.unit.clone());
        unit.map(|unit| unit.scale).ok_or_else(|| {
            let (field, name) = (&topic.field, listed([topic.name.as_str()]));
            let problem = format!(
                "expected {field} of {name} in dB, found whole numbers that are never below zero, a radio's own units"
            );
            Error::undecided(problem, format!("--units {column}=dB"))
        })
    }

    fn of<'t>(&'t self, roles: &'t [Role]) -> impl Iterator<Item = &'t Topic> {
        let is_heard = |topic: &&Topic| !topic.entries.is_empty() && roles.contains(&topic.role);
        self.catalogue.topics.iter().filter(is_heard)
    }
}

/// The topic, as its messages' definition and the options describe it; `None` if it is not wanted.
fn known(
    topic: &Announced<'_>,
    options: &Options,
    doubtful: &mut BTreeSet<String>,
) -> Option<Topic> {
    topic.encoding.filter(|encoding| *encoding != Encoding::Protobuf)?;
    let found = NumberMessage::of(topic.name, topic.kind, topic.definition, options)?;
    if found.is_doubtful {
        if doubtful.len() < MOST_NAMES {
            doubtful.insert(topic.name.to_owned());
        }
        return None;
    }
    let (role, field, unit, message) = (found.role, found.field, found.unit, found.message);
    Some(Topic { name: topic.name.to_owned(), role, field, unit, message, entries: Vec::new() })
}

/// The error for several topics where one is needed.
fn several(what: &str, found: &[&Topic], first: &Topic, option: &str) -> Error {
    let names = listed(found.iter().map(|topic| topic.name.as_str()));
    let option = format!("{option}{}", listed([first.name.as_str()]));
    Error::undecided(format!("expected one topic of {what}, found {names}"), option)
}

impl Messages for LevelTopics<'_> {
    fn topic(&mut self, topic: &Announced<'_>) -> Option<usize> {
        let Self { options, catalogue, doubtful, .. } = self;
        catalogue.place(topic, || known(topic, options, doubtful))
    }

    fn message(
        &mut self,
        place: usize,
        encoding: Encoding,
        record: usize,
        receipt: u64,
        message: &[u8],
    ) {
        let Some(topic) = self.catalogue.topics.get_mut(place) else { return };
        match topic.message.read(encoding, message) {
            Some((stamp, values)) => {
                topic.entries.push(Entry { stamp, receipt: receipt as f64 / 1e3, values });
            }
            // Its bytes were read, but it is not such a message.
            None => self.losses.add(Fault::Torn, record, 0),
        }
    }

    fn losses(&mut self) -> &mut Losses {
        &mut self.losses
    }
}
