//! The wanted fields of an autopilot's messages, over time.

use super::dataflash;
use super::gather::Losses;
use super::numbered;
use super::ulog::{Formats, Place};
use super::ulog_reader;
use super::{ardupilot_text, ulog_reader::Reading};
use crate::error::Error;
use crate::flight::{Channel, Family, Source};
use crate::options::Options;
use crate::part::Part;

/// The largest number of messages whose names are kept for error messages.
const MOST_NAMES: usize = 100;
/// The labels of times, and their unit in µs.
const TIMES: [(&str, f64); 2] = [("TimeUS", 1.0), ("TimeMS", 1e3)];
/// The labels of a sensor's number.
const NUMBERS: [&str; 3] = ["I", "Inst", "Instance"];

/// The result of reading the wanted fields.
#[derive(Debug)]
pub(crate) struct Signals {
    /// The channels, in the order in which they were wanted.
    pub(crate) channels: Vec<Channel>,
    /// The names of the messages in the file.
    pub(crate) names: Vec<String>,
    /// Notes on the file.
    pub(crate) notes: Vec<String>,
    pub(crate) losses: Losses,
    /// What the file consists of: lines or records.
    pub(crate) part: Part,
}

/// The autopilot that wrote a file, and whether it is text; `None` if no autopilot did.
pub(crate) fn autopilot(bytes: &[u8]) -> Option<(Family, bool)> {
    if dataflash::is_it(bytes) {
        Some((Family::ArduPilot, false))
    } else if ulog_reader::is_it(bytes) {
        Some((Family::Px4, false))
    } else if ardupilot_text::is_it(bytes) {
        Some((Family::ArduPilot, true))
    } else {
        None
    }
}

/// Reads the wanted fields; of numbered sensors, those of the number that `--topic` gives, or number 0.
///
/// # Errors
/// If there is no sensor with the given number, or the file needs a newer reader.
pub(crate) fn signals(
    bytes: &[u8],
    family: Family,
    is_text: bool,
    sources: Vec<Source>,
    options: &Options,
) -> Result<Signals, Error> {
    let part = if is_text { Part::Line } else { Part::Record };
    let channels = sources.into_iter().map(Channel::new).collect();
    let (names, notes, losses) = (Vec::new(), Vec::new(), Losses::default());
    let signals = Signals { channels, names, notes, losses, part };
    let number = numbered::wanted(options)?;
    let mut wanted = Wanted { signals, number: number.unwrap_or(0), is_seen: false };
    match family {
        Family::ArduPilot if is_text => ardupilot_text::read(bytes, &mut wanted)?,
        Family::ArduPilot => dataflash::read(bytes, &mut wanted),
        Family::Px4 => {
            let reading = ulog_reader::read(bytes, &mut wanted)?;
            wanted.signals.notes.extend(reading.pauses());
            let Reading { losses, .. } = reading;
            wanted.signals.losses = losses;
        }
    }
    match number {
        Some(number) if !wanted.is_seen => {
            Err(Error::options(format!("expected a sensor {number}, found none (--topic)")))
        }
        _ => Ok(wanted.signals),
    }
}

struct Wanted {
    signals: Signals,
    number: u32,
    /// Whether a sensor with the wanted number was seen.
    is_seen: bool,
}

impl Wanted {
    fn tell(&mut self, name: &str) {
        let names = &mut self.signals.names;
        if names.len() < MOST_NAMES && !names.iter().any(|known| known == name) {
            names.push(name.to_owned());
        }
    }

    /// The indices of the channels that a message may fill.
    fn of(&self, message: &str) -> Vec<usize> {
        let channels = self.signals.channels.iter().enumerate();
        let own = channels.filter(|(_, channel)| channel.source.message == message);
        own.map(|(place, _)| place).collect()
    }
}

/// The layout of an `ArduPilot` message.
pub(super) struct Labels {
    time: (usize, f64),
    number: Option<usize>,
    /// The channels, each with the index of its field.
    values: Vec<(usize, usize)>,
}

impl dataflash::Gather for Wanted {
    type Layout = Labels;

    fn define(&mut self, name: &str, labels: &[&str]) -> Option<Labels> {
        self.tell(name);
        let place = |label: &str| labels.iter().position(|known| *known == label);
        let field =
            |channel: usize| Some((channel, place(&self.signals.channels[channel].source.field)?));
        let values: Vec<_> = self.of(name).into_iter().filter_map(field).collect();
        let time = TIMES.iter().find_map(|(label, scale)| Some((place(label)?, *scale)))?;
        let number = NUMBERS.iter().find_map(|label| place(label));
        (!values.is_empty()).then_some(Labels { time, number, values })
    }

    fn take(
        &mut self,
        labels: &Labels,
        record: usize,
        field: &dyn Fn(usize) -> Option<f64>,
    ) -> Option<()> {
        let (place, scale) = labels.time;
        let time = field(place)? * scale;
        if let Some(place) = labels.number {
            if field(place)? != f64::from(self.number) {
                return Some(());
            }
            self.is_seen = true;
        }
        for &(channel, place) in &labels.values {
            let value = field(place)?;
            self.signals.channels[channel].push(time, value, record);
        }
        Some(())
    }

    fn losses(&mut self) -> &mut Losses {
        &mut self.signals.losses
    }
}

/// The layout of the records of a PX4 topic.
pub(super) struct Places {
    time: Place,
    /// The channels, each with its fields: one number, or the four of a quaternion.
    values: Vec<(usize, Vec<Place>)>,
}

impl ulog_reader::Gather for Wanted {
    type Layout = Places;

    fn define(&mut self, formats: &mut Formats, topic: &str, instance: u8) -> Option<Places> {
        self.tell(topic);
        let own = self.of(topic);
        if own.is_empty() || u32::from(instance) != self.number {
            return None;
        }
        self.is_seen = true;
        let time = formats.place(topic, "timestamp_sample", 0);
        let time = time.or_else(|| formats.place(topic, "timestamp", 0))?;
        let mut values = Vec::new();
        for channel in own {
            let source = &self.signals.channels[channel].source;
            let count = if source.is_quaternion { 4 } else { 1 };
            let places = (source.index..source.index + count)
                .map(|index| formats.place(topic, &source.field, index));
            if let Some(places) = places.collect() {
                values.push((channel, places));
            }
        }
        Some(Places { time, values })
    }

    fn take(&mut self, places: &Places, record: usize, data: &[u8]) -> Option<()> {
        let time = places.time.value(data)?;
        for (channel, places) in &places.values {
            let numbers: Vec<_> =
                places.iter().map(|place| place.value(data)).collect::<Option<_>>()?;
            let value = match numbers[..] {
                [value] => value,
                [w, x, y, z] => pitch([w, x, y, z]),
                _ => return None,
            };
            self.signals.channels[*channel].push(time, value, record);
        }
        Some(())
    }
}

/// The pitch, rad, nose up, of a quaternion from body (x forward, y right, z down) to north, east, down.
fn pitch([w, x, y, z]: [f64; 4]) -> f64 {
    let square = w * w + x * x + y * y + z * z;
    (2.0 * (w * y - z * x) / square).clamp(-1.0, 1.0).asin()
}

#[cfg(test)]
mod tests {
    use super::pitch;

    #[test]
    fn a_turn_about_the_right_wing_is_pitch() {
        let (half, yaw) = (0.15_f64, 0.7_f64);
        assert!((pitch([half.cos(), 0.0, half.sin(), 0.0]) - 0.3).abs() < 1e-12);
        // A rotation about the vertical does not change it.
        let turned = [
            yaw.cos() * half.cos(),
            -yaw.sin() * half.sin(),
            yaw.cos() * half.sin(),
            yaw.sin() * half.cos(),
        ];
        assert!((pitch(turned) - 0.3).abs() < 1e-12);
        assert!(pitch([0.0; 4]).is_nan());
    }
}
