//! ROS topics in a file that hold ranges.

use super::catalogue::Catalogue;
use super::chunks::{Announced, Messages};
use super::gather::Losses;
use super::imu_message::Encoding;
use super::range_message::{Heard, RangeMessage};
use crate::damage::Fault;
use crate::error::{Error, listed};
use crate::options::Options;

/// A topic that may hold ranges.
#[derive(Debug)]
pub(crate) struct Topic {
    pub(crate) name: String,
    message: RangeMessage,
    is_heard: bool,
}

/// A range from a message.
#[derive(Debug)]
pub(crate) struct Entry {
    /// The index of its topic.
    pub(crate) topic: usize,
    /// The times at which it was sent and received, µs since 1970.
    pub(crate) stamp: Option<f64>,
    pub(crate) receipt: f64,
    pub(crate) heard: Heard,
}

/// The topics of a file, with their ranges.
pub(crate) struct RangeTopics<'o> {
    options: &'o Options,
    catalogue: Catalogue<Topic>,
    pub(crate) entries: Vec<Entry>,
    pub(crate) losses: Losses,
}

impl<'o> RangeTopics<'o> {
    pub(super) fn new(options: &'o Options) -> Self {
        Self {
            options,
            catalogue: Catalogue::default(),
            entries: Vec::new(),
            losses: Losses::default(),
        }
    }

    /// The name of a topic, by its index.
    pub(crate) fn name(&self, place: usize) -> &str {
        &self.catalogue.topics[place].name
    }

    /// The wanted topics: the one that an option names or those below it, else all that hold `sensor_msgs/Range`, else
    /// the only other one.
    ///
    /// # Errors
    /// If there is none, or several and no option chooses.
    pub(crate) fn wanted(&self) -> Result<Vec<usize>, Error> {
        let bare = |name: &str| name.trim().trim_matches('/').to_owned();
        let topics = &self.catalogue.topics;
        let heard: Vec<_> = (0..topics.len()).filter(|&it| topics[it].is_heard).collect();
        let names = |places: &[usize]| listed(places.iter().map(|&it| self.name(it)));
        if let Some(said) = &self.options.topic {
            let (own, below) = (bare(said), bare(said) + "/");
            let is_said = |place: &usize| {
                let name = bare(self.name(*place));
                name == own || name.starts_with(&below)
            };
            let found: Vec<_> = heard.iter().copied().filter(is_said).collect();
            if found.is_empty() {
                let (said, found) = (listed([said.as_str()]), names(&heard));
                let problem =
                    format!("expected ranges on topic {said}, found them on {found} (--topic)");
                return Err(Error::options(problem));
            }
            return self.alike(found);
        }
        if heard.is_empty() {
            let others = self.catalogue.listed_others();
            let silent = listed(topics.iter().map(|topic| topic.name.as_str()));
            return Err(Error::log(if topics.is_empty() {
                format!(
                    "expected a topic of ranges, such as sensor_msgs/Range, whose definition is in the file, found {others}"
                )
            } else {
                format!("expected messages of ranges, found none on {silent}")
            }));
        }
        self.alike(heard)
    }

    /// Accepts one topic, or several that each belong to one anchor.
    fn alike(&self, places: Vec<usize>) -> Result<Vec<usize>, Error> {
        let names_anchors = |place: &usize| self.catalogue.topics[*place].message.names_anchors();
        if places.len() == 1 || !places.iter().any(names_anchors) {
            return Ok(places);
        }
        let names = listed(places.iter().map(|&it| self.name(it)));
        let first = listed(places.first().map(|&it| self.name(it)));
        let problem = format!("expected one topic of ranges, found {names}");
        Err(Error::undecided(problem, format!("--topic {first}")))
    }

    /// The factor that converts a topic's numbers to m, and a note on the unit.
    ///
    /// # Errors
    /// If neither the message nor an option gives the unit.
    pub(crate) fn scale(&self, place: usize) -> Result<(f64, String), Error> {
        let message = &self.catalogue.topics[place].message;
        let said = self.options.units.of("range");
        let unit = said.or_else(|| message.unit.clone()).ok_or_else(|| {
            let problem = format!("expected a unit of {}, found whole numbers", message.field);
            Error::undecided(problem, "--units range=mm")
        })?;
        Ok((unit.scale, format!("{} in {unit}", message.field)))
    }
}

impl Messages for RangeTopics<'_> {
    fn topic(&mut self, topic: &Announced<'_>) -> Option<usize> {
        self.catalogue.place(topic, || {
            topic.encoding.filter(|encoding| *encoding != Encoding::Protobuf)?;
            let message = RangeMessage::of(topic.kind, topic.definition, self.options)?;
            Some(Topic { name: topic.name.to_owned(), message, is_heard: false })
        })
    }

    fn message(
        &mut self,
        place: usize,
        encoding: Encoding,
        record: usize,
        receipt: u64,
        message: &[u8],
    ) {
        let read = self.catalogue.topics.get_mut(place).and_then(|topic| {
            let read = topic.message.read(encoding, message)?;
            topic.is_heard = true;
            Some(read)
        });
        let Some(read) = read else {
            // Its bytes were read, but it is not such a message.
            self.losses.add(Fault::Torn, record, 0);
            return;
        };
        let receipt = receipt as f64 / 1e3;
        let entries = read.heard.into_iter();
        let entry = |heard| Entry { topic: place, stamp: read.stamp, receipt, heard };
        self.entries.extend(entries.map(entry));
    }

    fn losses(&mut self) -> &mut Losses {
        &mut self.losses
    }
}
