//! Topics of ROS that hold a drone's places, its height, and the level of a radio on board.

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

/// What a topic holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Role {
    /// Latitude, longitude, altitude, and whether there is a fix.
    Fix,
    /// A height above where the drone took off.
    Height,
    /// A received level.
    Level,
    /// A path loss.
    Loss,
}

impl Role {
    /// The column that it is in a table.
    pub(crate) fn column(self) -> &'static str {
        match self {
            Self::Fix => "lat",
            Self::Height => "h",
            Self::Level => "rssi_db",
            Self::Loss => "path_loss_db",
        }
    }
}

/// A message's numbers.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Entry {
    /// When it was sent and received, µs since 1970; the first is 0 or none without a stamp.
    pub(crate) stamp: Option<f64>,
    pub(crate) receipt: f64,
    /// As many as the role has, then not a number.
    pub(crate) values: Values,
}

/// A topic that may hold something wanted.
#[derive(Debug)]
pub(crate) struct Topic {
    pub(crate) name: String,
    pub(crate) role: Role,
    /// The field of the number.
    pub(crate) field: String,
    unit: Option<Unit>,
    message: NumberMessage,
    pub(crate) entries: Vec<Entry>,
}

/// What topics there are, and what they say.
pub(crate) struct LevelTopics<'o> {
    options: &'o Options,
    catalogue: Catalogue<Topic>,
    /// Those that may be levels, but nothing says so.
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

    /// The one topic of places.
    ///
    /// # Errors
    /// If there is none, or several and nobody says which.
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

    /// The one topic of heights, if there is one.
    ///
    /// # Errors
    /// If there are several and nobody says which.
    pub(crate) fn heights(&self) -> Result<Option<&Topic>, Error> {
        let found: Vec<_> = self.of(&[Role::Height]).collect();
        match found[..] {
            [first, _, ..] => Err(several("heights", &found, first, "--columns h=")),
            _ => Ok(found.first().copied()),
        }
    }

    /// The one topic of levels or path losses.
    ///
    /// # Errors
    /// If there is none, or several and nobody says which.
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

    /// How much a topic's numbers are in dB.
    ///
    /// # Errors
    /// If nobody says the unit of whole numbers that cannot be below zero.
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

/// What a topic is to its messages' definition and the options.
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

/// Several topics where one is wanted.
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
            // Its bytes were read, but it is none.
            None => self.losses.add(Fault::Torn, record, 0),
        }
    }

    fn losses(&mut self) -> &mut Losses {
        &mut self.losses
    }
}
