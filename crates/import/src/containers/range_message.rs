//! ROS messages that hold ranges, identified by their definitions: a range with its anchor's name, a list of such
//! pairs, or a list of ranges in the order of the anchors.
//!
//! | message | |
//! |---|---|
//! | `sensor_msgs/Range` | `range`; the anchor by `header.frame_id` or the topic (`docs.ros.org/en/noetic/api/sensor_msgs`) |
//! | `uwb_driver/UwbRange` | `distance`, `responder_id` (`github.com/ntu-aris/uwb_driver`) |
//! | `nlink_parser/LinktrackTagframe0` | `dis_arr` (`github.com/nooploop-dev/nlink_parser`) |
//! | `nlink_parser/LinktrackNodeframe2` | `nodes`, each with `id` and `dis` |
//! | `msgs/Ranging` of GTEC | `range`, `anchorId`; integers, whose unit must be given (`github.com/GTEC-UDC/rosmsgs`) |
//!
//! Any other message with such field names is accepted as well.

use super::definition::{Count, Definition, Field, Leaf, Of};
use super::imu_message::Encoding;
use crate::names::named;
use crate::options::Options;
use crate::unit::{Quantity, Unit};

/// The definition of `sensor_msgs/Range`, for files that lack it.
const RANGE: &str = "Header header\nuint8 radiation_type\nfloat32 field_of_view\nfloat32 min_range\nfloat32 max_range\nfloat32 range\n";

/// Names of a field with a range.
const RANGES: [&str; 6] = ["range", "distance", "dist", "dis", "d", "r"];
/// Names of a field with a list of ranges.
const LISTS: [&str; 8] =
    ["ranges", "distances", "dists", "disarr", "distance", "range", "dist", "dis"];
/// Names of a field with a range's anchor.
const ANCHORS: [&str; 14] = [
    "anchor",
    "anchorid",
    "anchorname",
    "anchoraddress",
    "anc",
    "ancid",
    "beacon",
    "beaconid",
    "responder",
    "responderid",
    "toid",
    "destid",
    "nodeid",
    "macdest",
];
/// Names that mean the anchor only within a list: beside a message's single range they may mean the tag.
const IDS: [&str; 4] = ["id", "name", "node", "address"];
/// Names of a field with the tag.
const TAGS: [&str; 8] =
    ["tag", "tagid", "tagname", "tagaddress", "requester", "requesterid", "fromid", "srcid"];

/// How a message identifies the anchor of a range.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Label {
    /// By its name or number, or by its index in a list.
    Said(String),
    /// By a frame at most; the name may be empty.
    Frame(String),
}

/// A range in a message.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Heard {
    pub(crate) label: Label,
    /// The name or number of the tag, if it is given.
    pub(crate) tag: Option<String>,
    /// The range, in the unit of the field.
    pub(crate) range: f64,
}

/// The ranges in a message.
#[derive(Debug, Default)]
pub(super) struct Message {
    /// The stamp, µs; `None` if there is none.
    pub(super) stamp: Option<f64>,
    pub(super) heard: Vec<Heard>,
}

/// The layout of a message with ranges.
#[derive(Debug)]
pub(super) struct RangeMessage {
    definition: Definition,
    range: Vec<usize>,
    anchor: Option<Vec<usize>>,
    tag: Option<Vec<usize>>,
    header: Option<usize>,
    /// Whether the index in the list identifies the anchor.
    is_list: bool,
    /// The unit, if the field's name gives it, or if it is a floating-point number, for which ROS prescribes m (REP
    /// 103).
    pub(super) unit: Option<Unit>,
    /// The name of the field.
    pub(super) field: String,
}

impl RangeMessage {
    /// The layout of a type, from its name and definition; `None` if it holds no ranges.
    pub(super) fn of(kind: &str, text: &[u8], options: &Options) -> Option<Self> {
        let text = std::str::from_utf8(text).unwrap_or_default();
        let is_range = matches!(kind, "sensor_msgs/Range" | "sensor_msgs/msg/Range");
        let definition = match Definition::read(kind, text) {
            Some(definition) if !definition.fields(0).is_empty() => definition,
            _ if is_range => Definition::read(kind, RANGE)?,
            _ => return None,
        };
        let root = definition.fields(0);
        let header = root.iter().position(|field| field.of == Of::Header);
        let found = Found::of(root, &[], !is_range, options)
            .filter(|found| found.anchor.is_some() || found.is_list || is_range)
            .or_else(|| {
                root.iter().enumerate().find_map(|(place, field)| {
                    let (Of::Type(of), true) = (field.of, field.count != Count::One) else {
                        return None;
                    };
                    let found = Found::of(definition.fields(of), &[place], false, options)?;
                    found.anchor.is_some().then_some(found)
                })
            })?;
        let Found { range, anchor, tag, is_list, unit, field } = found;
        Some(Self { definition, range, anchor, tag, header, is_list, unit, field })
    }

    /// Whether the messages themselves identify the anchor of each range.
    pub(super) fn names_anchors(&self) -> bool {
        self.anchor.is_some() || self.is_list
    }

    /// The ranges of a message; `None` if it is not of this type.
    pub(super) fn read(&self, encoding: Encoding, message: &[u8]) -> Option<Message> {
        let mut read = Message::default();
        let (mut ranges, mut anchors, mut tags) = (Vec::new(), Vec::new(), Vec::new());
        let mut frame = String::new();
        let mut visit = |path: &[usize], element: usize, leaf: Leaf<'_>| {
            let is = |wanted: &Option<Vec<usize>>| wanted.as_deref() == Some(path);
            match leaf {
                Leaf::Number(range) if path == self.range => ranges.push((element, range)),
                leaf if is(&self.anchor) => anchors.push((element, words(leaf))),
                leaf if is(&self.tag) => tags.push((element, words(leaf))),
                Leaf::Time(stamp) if path.first() == self.header.as_ref() && path.len() == 2 => {
                    read.stamp = Some(stamp);
                }
                leaf @ Leaf::Text(_) if path.first() == self.header.as_ref() && path.len() == 2 => {
                    frame = words(leaf);
                }
                _ => {}
            }
        };
        self.definition.walk(encoding, message, &mut visit)?;
        let of = |list: &[(usize, String)], element: usize| {
            let own = list.iter().find(|(place, _)| *place == element).or_else(|| list.first());
            own.map(|(_, text)| text.clone())
        };
        for (element, range) in ranges {
            let label = match (self.is_list, of(&anchors, element)) {
                (true, _) => Label::Said(element.to_string()),
                (false, Some(anchor)) => Label::Said(anchor),
                (false, None) => Label::Frame(frame.clone()),
            };
            read.heard.push(Heard { label, tag: of(&tags, element), range });
        }
        Some(read)
    }
}

/// A value as a name.
fn words(leaf: Leaf<'_>) -> String {
    match leaf {
        Leaf::Number(number) => number.to_string(),
        Leaf::Time(time) => time.to_string(),
        Leaf::Text(text) => String::from_utf8_lossy(text).trim().to_owned(),
    }
}

/// The fields of a type that were recognised.
struct Found {
    range: Vec<usize>,
    anchor: Option<Vec<usize>>,
    tag: Option<Vec<usize>>,
    is_list: bool,
    unit: Option<Unit>,
    field: String,
}

impl Found {
    fn of(
        fields: &[Field],
        before: &[usize],
        may_be_list: bool,
        options: &Options,
    ) -> Option<Self> {
        let said = |role: &str| options.columns.of(role).map(|pick| pick.name.as_str());
        let length = Some(Quantity::Length);
        let path = |place: usize| [before, &[place]].concat();
        let is_one = |field: &Field, role: &str, names: &[&str], quantity| match said(role) {
            Some(said) => field.name == said,
            None => named(&field.name, quantity, names).is_some(),
        };
        let find = |role: &str, names: &[&str]| {
            let mut all = fields.iter();
            let place = all.position(|field| {
                let is_name = field.of.is_integer() || field.of == Of::Text;
                field.count == Count::One && is_name && is_one(field, role, names, None)
            });
            place.map(path)
        };
        let anchor = find("anchor", &ANCHORS)
            .or_else(|| if before.is_empty() { None } else { find("anchor", &IDS) });
        let tag = find("", &TAGS);
        let mut numbers = fields.iter().enumerate().filter(|(_, field)| field.of.is_number());
        let range = numbers.clone().find(|(_, field)| {
            field.count == Count::One && is_one(field, "range", &RANGES, length)
        });
        let list = numbers.find(|(_, field)| {
            may_be_list && field.count != Count::One && is_one(field, "range", &LISTS, length)
        });
        let (is_list, (place, field)) = match (range, list) {
            (Some(range), _) if anchor.is_some() || list.is_none() => (false, range),
            (_, Some(list)) => (true, list),
            (range, None) => (false, range?),
        };
        let unit = named(&field.name, length, if is_list { &LISTS } else { &RANGES });
        let unit = unit.and_then(|named| named.unit);
        let metres = (!field.of.is_integer()).then(|| Unit::read(Quantity::Length, "m"));
        let unit = unit.or(metres.flatten());
        let field = field.name.clone();
        let anchor = anchor.filter(|_| !is_list);
        Some(Self { range: path(place), anchor, tag, is_list, unit, field })
    }
}
