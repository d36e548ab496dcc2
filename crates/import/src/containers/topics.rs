//! ROS topics in a file, one of which is the wanted inertial sensor's.

use super::Decoded;
use super::catalogue::Catalogue;
use super::chunks::{Announced, Messages};
use super::gather::{Losses, Stream};
use super::imu_message::Encoding;
use super::own_message::OwnImu;
use crate::damage::Fault;
use crate::error::{Error, listed};
use crate::formats::{Description, Format};
use crate::options::Options;
use crate::part::Part;

/// The columns of the message `Imu`.
const SENSORS: [&str; 6] = [
    "linear_acceleration.x",
    "linear_acceleration.y",
    "linear_acceleration.z",
    "angular_velocity.x",
    "angular_velocity.y",
    "angular_velocity.z",
];
/// The time column, µs since 1970.
const TIME: &str = "header.stamp";

/// The description of a file format that holds the message `Imu`.
pub(super) const fn description(
    format: Format,
    name: &'static str,
    title: &'static str,
) -> Description {
    Description {
        format,
        name,
        title,
        is_it: None,
        time: &[(TIME, "us")],
        sensors: SENSORS,
        acceleration: "m/s2",
        rate: "rad/s",
        is_a_guess: false,
    }
}

/// An inertial sensor's topic.
#[derive(Debug)]
struct Topic {
    name: String,
    stream: Stream,
    /// The time of receipt of each message, µs.
    receipts: Vec<f64>,
    /// The layout of its messages, if `host-sim` wrote them.
    own: Option<OwnImu>,
}

/// The topics of a file.
#[derive(Debug, Default)]
pub(super) struct Topics {
    inertial: Catalogue<Topic>,
    losses: Losses,
}

impl Topics {
    /// The table of the wanted topic.
    ///
    /// # Errors
    /// If there is none, or several and no option chooses.
    pub(super) fn decoded(
        mut self,
        known: &Description,
        options: &Options,
    ) -> Result<Decoded, Error> {
        let place = self.wanted(options)?;
        let Topic { name, mut stream, receipts, .. } = self.inertial.topics.swap_remove(place);
        let name: String =
            name.chars().map(|c| if c.is_control() { '?' } else { c }).take(80).collect();
        let mut notes = vec![format!("topic {name}")];
        if stream.columns[0].iter().all(|&stamp| stamp == 0.0) {
            stream.columns[0] = receipts;
            notes.push("times of receipt, as all stamps are 0".to_owned());
        }
        let table = stream.table(known, TIME, &self.losses, Part::Record);
        Ok(Decoded { table, notes })
    }

    fn wanted(&self, options: &Options) -> Result<usize, Error> {
        let bare = |name: &str| name.trim().trim_start_matches('/').to_owned();
        let names = || self.inertial.topics.iter().map(|topic| topic.name.as_str());
        if let Some(said) = &options.topic {
            let place = names().position(|name| bare(name) == bare(said));
            return place.filter(|&place| self.inertial.topics[place].stream.len() > 0).ok_or_else(
                || {
                    let said = listed([said.as_str()]);
                    let problem = format!("expected messages of sensor_msgs/Imu on topic {said}");
                    Error::options(format!("{problem}, found topics {} (--topic)", listed(names())))
                },
            );
        }
        let filled = |&place: &usize| self.inertial.topics[place].stream.len() > 0;
        let places: Vec<_> = (0..self.inertial.topics.len()).filter(filled).collect();
        match places[..] {
            [place] => Ok(place),
            [] if self.inertial.topics.is_empty() => Err(self.none()),
            [] => {
                let found = listed(names());
                Err(Error::log(format!(
                    "expected messages of sensor_msgs/Imu, found none on {found}"
                )))
            }
            [first, ..] => {
                let names = places.iter().map(|&place| self.inertial.topics[place].name.as_str());
                let problem =
                    format!("expected one topic of sensor_msgs/Imu, found {}", listed(names));
                let option =
                    format!("--topic {}", listed([self.inertial.topics[first].name.as_str()]));
                Err(Error::undecided(problem, option))
            }
        }
    }

    /// The error for a file without an inertial sensor.
    fn none(&self) -> Error {
        let is_own = |other: &str| other.contains("(kestirim.") || other.contains("(foxglove.");
        if self.inertial.others().len() > 0 && self.inertial.others().all(is_own) {
            return Error::log(
                "expected a recording of sensors, found results of host-sim, which hold no inertial sensor's samples",
            );
        }
        let found = self.inertial.listed_others();
        Error::log(format!(
            "expected a topic of sensor_msgs/Imu in ROS 1's encoding or CDR, found {found}"
        ))
    }
}

impl Messages for Topics {
    fn topic(&mut self, topic: &Announced<'_>) -> Option<usize> {
        let Announced { name, kind, encoding, .. } = *topic;
        let is_of_ros = matches!(kind, "sensor_msgs/Imu" | "sensor_msgs/msg/Imu");
        let own = OwnImu::of(kind, topic.definition);
        let is_inertial = match encoding {
            Some(Encoding::Protobuf) => own.is_some(),
            Some(_) => is_of_ros,
            None => false,
        };
        self.inertial.place(topic, || {
            let (stream, receipts) = (Stream::default(), Vec::new());
            is_inertial.then(|| Topic { name: name.to_owned(), stream, receipts, own })
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
        let receipt = receipt as f64 / 1e3;
        let topic = self.inertial.topics.get_mut(place);
        let own = topic.as_ref().and_then(|topic| topic.own);
        let row = match (encoding, own) {
            (Encoding::Protobuf, Some(own)) => {
                own.read(message).map(|[ax, ay, az, gx, gy, gz]| [receipt, ax, ay, az, gx, gy, gz])
            }
            _ => encoding.read(message),
        };
        match (row, topic) {
            (Some(row), Some(topic)) => {
                topic.stream.push(record, row);
                topic.receipts.push(receipt);
            }
            // Its bytes were read, but it is not such a message.
            _ => self.losses.add(Fault::Torn, record, 0),
        }
    }

    fn losses(&mut self) -> &mut Losses {
        &mut self.losses
    }
}
