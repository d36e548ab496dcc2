//! ROS messages that hold a position, a height or a level, identified by their definitions.
//!
//! | message | |
//! |---|---|
//! | `sensor_msgs/NavSatFix` | `latitude`, `longitude`, `altitude`, `status.status` (`docs.ros.org/en/noetic/api/sensor_msgs`) |
//! | `std_msgs/Float32` and its kin | `data`, by the last part of the topic's name (`docs.ros.org/en/noetic/api/std_msgs`) |
//! | `mavros_msgs/RadioStatus` | `rssi_dbm` (`docs.ros.org/en/noetic/api/mavros_msgs`) |
//!
//! Any other message with a number named `rssi`, `rx_power`, `path_loss` or the like is accepted as well. `level` and
//! `power` alone may mean anything (the messages of `/rosout` have a `level`), unless they carry the unit dB.

use super::definition::{Count, Definition, Field, Leaf, Of};
use super::imu_message::Encoding;
use super::level_topics::Role;
use crate::names::named;
use crate::options::Options;
use crate::unit::{Quantity, Unit};

/// The definition of `sensor_msgs/NavSatFix`, for files that lack it.
const FIX: &str = "Header header\nsensor_msgs/NavSatStatus status\nfloat64 latitude\nfloat64 longitude\nfloat64 altitude\n\
    float64[9] position_covariance\nuint8 position_covariance_type\n==\nMSG: sensor_msgs/NavSatStatus\nint8 status\nuint16 service\n";

/// Names of fields and topics that hold a level.
const LEVELS: [&str; 8] =
    ["rssi", "rss", "signal", "signalstrength", "rxpower", "receivedpower", "rsrp", "rxrssi"];
/// Names that may mean a level in dB or something else.
const DOUBTFUL: [&str; 2] = ["level", "power"];
/// Names of fields and topics that hold a path loss.
const LOSSES: [&str; 2] = ["pathloss", "pl"];
/// Names of fields and topics that hold a height above the ground at the take-off point.
const HEIGHTS: [&str; 6] =
    ["relalt", "relativealtitude", "heightabovetakeoff", "heightaboveground", "height", "agl"];

/// The numbers of a message: four for a fix, one for any other.
pub(crate) type Values = [f64; 4];

/// The layout of a message's numbers.
#[derive(Debug)]
pub(super) struct NumberMessage {
    definition: Definition,
    paths: Vec<Vec<usize>>,
    header: Option<usize>,
}

/// The role of a message, and how it is read.
pub(super) struct Found {
    pub(super) role: Role,
    pub(super) field: String,
    /// The unit; `None` for unsigned integers whose name does not give it.
    pub(super) unit: Option<Unit>,
    /// Whether the role rests on the name `level` or `power` alone.
    pub(super) is_doubtful: bool,
    pub(super) message: NumberMessage,
}

impl NumberMessage {
    /// Identifies a message from the names of its topic and type and its definition; `None` if it holds nothing wanted.
    pub(super) fn of(topic: &str, kind: &str, text: &[u8], options: &Options) -> Option<Found> {
        let text = std::str::from_utf8(text).unwrap_or_default();
        let kind = kind.replacen("/msg/", "/", 1);
        let read = |text: &str| {
            Definition::read(&kind, text).filter(|definition| !definition.fields(0).is_empty())
        };
        if kind == "sensor_msgs/NavSatFix" {
            return fix(topic, read(text).or_else(|| read(FIX))?, options);
        }
        let definition = read(text).or_else(|| read(usual(&kind)?))?;
        let fields = definition.fields(0);
        let numbers = fields.iter().enumerate();
        let numbers =
            numbers.filter(|(_, field)| field.count == Count::One && field.of.is_number());
        let is_plain = matches!(fields, [Field { name, .. }] if name == "data");
        let mut all = numbers.filter_map(|(place, field)| {
            let (role, unit, is_doubtful) = meaning(topic, field, is_plain, options)?;
            Some((place, role, unit, is_doubtful))
        });
        let all: Vec<_> = all.by_ref().collect();
        // Of several fields, one whose unit is certain is preferred.
        let (place, role, unit, is_doubtful) = all
            .iter()
            .find(|(_, _, unit, is_doubtful)| unit.is_some() && !is_doubtful)
            .or_else(|| all.iter().find(|(.., is_doubtful)| !is_doubtful))
            .or_else(|| all.first())?
            .clone();
        let field = fields.get(place)?.name.clone();
        let header = header(&definition);
        let message = Self { definition, paths: vec![vec![place]], header };
        Some(Found { role, field, unit, is_doubtful, message })
    }

    /// The stamp, µs, and the numbers of a message; `None` if it is not of this type.
    pub(super) fn read(&self, encoding: Encoding, message: &[u8]) -> Option<(Option<f64>, Values)> {
        let (mut stamp, mut values) = (None, [f64::NAN; 4]);
        let mut visit = |path: &[usize], _: usize, leaf: Leaf<'_>| match leaf {
            Leaf::Number(number) => {
                let place = self.paths.iter().position(|wanted| wanted == path);
                if let Some(value) = place.and_then(|place| values.get_mut(place)) {
                    *value = number;
                }
            }
            Leaf::Time(time) if path.first() == self.header.as_ref() && path.len() == 2 => {
                stamp = Some(time);
            }
            _ => {}
        };
        self.definition.walk(encoding, message, &mut visit)?;
        Some((stamp, values))
    }
}

fn header(definition: &Definition) -> Option<usize> {
    definition.fields(0).iter().position(|field| field.of == Of::Header)
}

/// The definition of a numeric type of `std_msgs`, for files that lack it.
fn usual(kind: &str) -> Option<&'static str> {
    Some(match kind {
        "std_msgs/Float32" => "float32 data",
        "std_msgs/Float64" => "float64 data",
        "std_msgs/Int8" => "int8 data",
        "std_msgs/Int16" => "int16 data",
        "std_msgs/Int32" => "int32 data",
        _ => return None,
    })
}

fn fix(topic: &str, definition: Definition, options: &Options) -> Option<Found> {
    let is_said =
        options.columns.of(Role::Fix.column()).map(|pick| bare(&pick.name) == bare(topic));
    if is_said == Some(false) {
        return None;
    }
    let fields = definition.fields(0);
    let place = |name: &str| fields.iter().position(|field| field.name == name);
    let status = place("status")?;
    let Of::Type(of) = fields.get(status)?.of else { return None };
    let of_status = definition.fields(of).iter().position(|field| field.name == "status")?;
    let [latitude, longitude, altitude] = ["latitude", "longitude", "altitude"].map(place);
    let paths = vec![vec![latitude?], vec![longitude?], vec![altitude?], vec![status, of_status]];
    let header = header(&definition);
    let message = NumberMessage { definition, paths, header };
    let field = "latitude".to_owned();
    Some(Found { role: Role::Fix, field, unit: None, is_doubtful: false, message })
}

/// A topic's name without surrounding slashes.
fn bare(name: &str) -> &str {
    name.trim().trim_matches('/')
}

/// The role of a number, its unit if that is certain, and whether the role is doubtful.
fn meaning(
    topic: &str,
    field: &Field,
    is_plain: bool,
    options: &Options,
) -> Option<(Role, Option<Unit>, bool)> {
    let last = topic.rsplit('/').next().unwrap_or(topic);
    let name = if is_plain { last } else { field.name.as_str() };
    let fraction = |quantity: Quantity, unit: &str| {
        let is_sure = !matches!(field.of, Of::Unsigned(_));
        is_sure.then(|| Unit::read(quantity, unit)).flatten()
    };
    let is_said =
        [Role::Level, Role::Loss].iter().any(|role| options.columns.of(role.column()).is_some());
    let is_topic = options.topic.as_ref().map(|said| bare(said) == bare(topic));
    for (role, names, quantity, unit) in [
        (Role::Level, &LEVELS[..], Quantity::Level, "dB"),
        (Role::Loss, &LOSSES[..], Quantity::Level, "dB"),
        (Role::Height, &HEIGHTS[..], Quantity::Length, "m"),
    ] {
        let is_height = role == Role::Height;
        let said = options.columns.of(role.column()).filter(|pick| pick.name != ALTITUDE);
        let of_name = named(name, Some(quantity), names);
        let is_known = match said {
            Some(pick) => bare(&pick.name) == bare(topic) || pick.name == field.name,
            // A height counts only if it is the message's sole number: images have a height as well.
            None => of_name.is_some() && if is_height { is_plain } else { !is_said },
        };
        if is_known && (is_height || is_topic != Some(false)) {
            let unit = of_name.and_then(|named| named.unit).or_else(|| fraction(quantity, unit));
            return Some((role, unit, false));
        }
    }
    let doubtful = named(name, Some(Quantity::Level), &DOUBTFUL).filter(|_| !is_said)?;
    let is_sure = doubtful.unit.is_some() || is_topic == Some(true);
    let unit = doubtful.unit.or_else(|| fraction(Quantity::Level, "dB"));
    (is_topic != Some(false)).then_some((Role::Level, unit, !is_sure))
}

/// The value of `--columns h=` that takes the altitude of the fixes as the height.
pub(crate) const ALTITUDE: &str = "altitude";
