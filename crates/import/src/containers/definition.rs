//! ROS messages by their definitions, which are part of the file: in the header of a bag's connection
//! (<https://wiki.ros.org/msg>), in a schema `ros1msg` or `ros2msg` of MCAP (<https://mcap.dev/spec/registry>,
//! <https://design.ros2.org/articles/legacy_interface_definition.html>).
//!
//! A definition is a text of lines `type name`, followed by the types that it needs, each behind a line of `=` and
//! `MSG: package/Name`.

use std::collections::BTreeMap;

use super::bytes::Bytes;
use super::imu_message::Encoding;

/// The largest number of fields of a message, and the deepest nesting of types.
const MOST_FIELDS: usize = 10_000;
const DEEPEST: usize = 8;
/// The number of values, in excess of its bytes, that a message may have; one with more is invalid.
const MOST_STEPS: usize = 1000;

/// The type of a field: a number, or a builtin that stands for one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Of {
    Unsigned(usize),
    Signed(usize),
    Single,
    Double,
    Text,
    /// Seconds and nanoseconds, signed or unsigned.
    Time,
    /// A stamp and the name of a frame.
    Header,
    /// Another message type, by its index.
    Type(usize),
}

impl Of {
    fn known(name: &str) -> Option<Self> {
        let name = name.split("<=").next().unwrap_or(name);
        Some(match name {
            "bool" | "uint8" | "char" => Self::Unsigned(1),
            "byte" | "int8" => Self::Signed(1),
            "uint16" => Self::Unsigned(2),
            "uint32" => Self::Unsigned(4),
            "uint64" => Self::Unsigned(8),
            "int16" => Self::Signed(2),
            "int32" => Self::Signed(4),
            "int64" => Self::Signed(8),
            "float32" => Self::Single,
            "float64" => Self::Double,
            "string" => Self::Text,
            "time"
            | "duration"
            | "builtin_interfaces/Time"
            | "builtin_interfaces/msg/Time"
            | "builtin_interfaces/Duration"
            | "builtin_interfaces/msg/Duration" => Self::Time,
            "Header" | "std_msgs/Header" | "std_msgs/msg/Header" => Self::Header,
            _ => return None,
        })
    }

    /// Whether the type is an integer.
    pub(super) fn is_integer(self) -> bool {
        matches!(self, Self::Unsigned(_) | Self::Signed(_))
    }

    pub(super) fn is_number(self) -> bool {
        self.is_integer() || matches!(self, Self::Single | Self::Double)
    }
}

/// The number of values in a field.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Count {
    One,
    Fixed(usize),
    /// A list, whose length precedes its values.
    Told,
}

/// A field of a type.
#[derive(Debug)]
pub(super) struct Field {
    pub(super) name: String,
    pub(super) of: Of,
    pub(super) count: Count,
}

/// The type of a message, with those that it needs.
#[derive(Debug)]
pub(super) struct Definition(Vec<Vec<Field>>);

/// A value in a message.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Leaf<'a> {
    Number(f64),
    /// A time, µs.
    Time(f64),
    Text(&'a [u8]),
}

/// The visitor of values: it takes the indices of the fields that lead to a value, the index in a list, and the value.
pub(super) type Visit<'v, 'a> = dyn FnMut(&[usize], usize, Leaf<'a>) + 'v;

impl Definition {
    /// Parses the definition of a type; `None` if a type that it needs is missing.
    pub(super) fn read(kind: &str, text: &str) -> Option<Self> {
        let mut texts = BTreeMap::new();
        let (mut name, mut lines) = (plain(kind), Vec::new());
        for line in text.lines() {
            let line = line.split('#').next().unwrap_or_default().trim();
            if let Some(next) = line.strip_prefix("MSG:") {
                texts.entry(std::mem::replace(&mut name, plain(next))).or_insert(lines);
                lines = Vec::new();
            } else if !line.is_empty() && !line.starts_with("==") {
                lines.push(line);
            }
        }
        texts.entry(name).or_insert(lines);
        let mut reader = Reader { texts, places: BTreeMap::new(), types: Vec::new(), fields: 0 };
        reader.add(&plain(kind), 0)?;
        Some(Self(reader.types.into_iter().collect::<Option<_>>()?))
    }

    /// The fields of a type; the message itself is type 0.
    pub(super) fn fields(&self, of: usize) -> &[Field] {
        self.0.get(of).map_or(&[], Vec::as_slice)
    }

    /// Visits all values of a message; `None` if the message is too short.
    pub(super) fn walk<'a>(
        &self,
        encoding: Encoding,
        message: &'a [u8],
        visit: &mut Visit<'_, 'a>,
    ) -> Option<()> {
        let mut bytes = Bytes(message);
        let (is_cdr, is_big) = match encoding {
            Encoding::Ros1 => (false, false),
            Encoding::Cdr => match bytes.take()? {
                [_, 0, _, _] => (true, true),
                [_, 1, _, _] => (true, false),
                _ => return None,
            },
            Encoding::Protobuf => return None,
        };
        let whole = bytes.0.len();
        let steps = MOST_STEPS + whole;
        let mut cursor = Cursor { bytes, whole, is_cdr, is_big, steps };
        cursor.type_of(self, 0, &mut Vec::new(), 0, visit)
    }
}

/// The name of a type as messages of packages write it: without `/msg/`.
fn plain(name: &str) -> String {
    name.trim().replacen("/msg/", "/", 1)
}

struct Reader<'a> {
    texts: BTreeMap<String, Vec<&'a str>>,
    places: BTreeMap<String, usize>,
    types: Vec<Option<Vec<Field>>>,
    fields: usize,
}

impl Reader<'_> {
    fn add(&mut self, name: &str, depth: usize) -> Option<usize> {
        if let Some(&place) = self.places.get(name) {
            return Some(place);
        }
        let lines = self.texts.get(name)?.clone();
        let place = self.types.len();
        self.places.insert(name.to_owned(), place);
        self.types.push(None);
        let mut fields = Vec::new();
        for line in lines {
            self.fields += 1;
            if self.fields > MOST_FIELDS || depth > DEEPEST {
                return None;
            }
            let mut words = line.split_whitespace();
            let (of, field) = (words.next()?, words.next()?);
            // A constant, such as `uint8 NONE=0` or `uint8 NONE = 0`.
            if field.contains('=') || words.next().is_some_and(|word| word.starts_with('=')) {
                continue;
            }
            let (of, count) = match of.split_once('[') {
                None => (of, Count::One),
                Some((of, count)) => match count.strip_suffix(']')? {
                    count if count.is_empty() || count.starts_with("<=") => (of, Count::Told),
                    count => (of, Count::Fixed(count.parse().ok()?)),
                },
            };
            let of = match Of::known(of) {
                Some(known) => known,
                None => Of::Type(self.other(name, of, depth)?),
            };
            fields.push(Field { name: field.to_owned(), of, count });
        }
        *self.types.get_mut(place)? = Some(fields);
        Some(place)
    }

    /// A type that another one needs; without a package it belongs to the same one.
    fn other(&mut self, own: &str, of: &str, depth: usize) -> Option<usize> {
        let of = plain(of);
        let package = own.split_once('/').map_or("", |(package, _)| package);
        let name = if of.contains('/') { of } else { format!("{package}/{of}") };
        self.add(&name, depth + 1)
    }
}

struct Cursor<'a> {
    bytes: Bytes<'a>,
    whole: usize,
    is_cdr: bool,
    is_big: bool,
    /// The number of values that may still be visited.
    steps: usize,
}

impl<'a> Cursor<'a> {
    fn type_of(
        &mut self,
        definition: &Definition,
        of: usize,
        path: &mut Vec<usize>,
        element: usize,
        visit: &mut Visit<'_, 'a>,
    ) -> Option<()> {
        let fields = definition.fields(of);
        if path.len() > DEEPEST {
            return None;
        }
        if fields.is_empty() && self.is_cdr {
            // CDR puts one byte into a type without fields.
            self.bytes.u8()?;
        }
        for (place, field) in fields.iter().enumerate() {
            let (count, is_list) = match field.count {
                Count::One => (1, false),
                Count::Fixed(count) => (count, true),
                Count::Told => (usize::try_from(self.unsigned(4)?).ok()?, true),
            };
            path.push(place);
            for index in 0..count {
                let element = if is_list { index } else { element };
                self.value(definition, field.of, path, element, visit)?;
            }
            path.pop();
        }
        Some(())
    }

    fn value(
        &mut self,
        definition: &Definition,
        of: Of,
        path: &mut Vec<usize>,
        element: usize,
        visit: &mut Visit<'_, 'a>,
    ) -> Option<()> {
        self.steps = self.steps.checked_sub(1)?;
        let leaf = match of {
            Of::Unsigned(size) => Leaf::Number(self.unsigned(size)? as f64),
            Of::Signed(size) => {
                let shift = 64 - 8 * u32::try_from(size).ok()?;
                Leaf::Number((self.unsigned(size)?.cast_signed() << shift >> shift) as f64)
            }
            Of::Single => {
                Leaf::Number(f64::from(f32::from_bits(u32::try_from(self.unsigned(4)?).ok()?)))
            }
            Of::Double => Leaf::Number(f64::from_bits(self.unsigned(8)?)),
            Of::Text => Leaf::Text(self.text()?),
            Of::Time => Leaf::Time(self.time()?),
            Of::Header => {
                if !self.is_cdr {
                    let _sequence = self.unsigned(4)?;
                }
                let (stamp, frame) = (self.time()?, self.text()?);
                path.push(0);
                visit(path, element, Leaf::Time(stamp));
                path.pop();
                path.push(1);
                visit(path, element, Leaf::Text(frame));
                path.pop();
                return Some(());
            }
            Of::Type(of) => return self.type_of(definition, of, path, element, visit),
        };
        visit(path, element, leaf);
        Some(())
    }

    /// An unsigned number of `size` bytes; in CDR it is aligned to a multiple of them.
    fn unsigned(&mut self, size: usize) -> Option<u64> {
        if self.is_cdr {
            let read = self.whole - self.bytes.0.len();
            self.bytes.slice(read.next_multiple_of(size) - read)?;
        }
        let bytes = self.bytes.slice(size)?;
        let join = |sum: u64, byte: &u8| sum << 8 | u64::from(*byte);
        Some(if self.is_big {
            bytes.iter().fold(0, join)
        } else {
            bytes.iter().rev().fold(0, join)
        })
    }

    fn text(&mut self) -> Option<&'a [u8]> {
        let length = usize::try_from(self.unsigned(4)?).ok()?;
        let text = self.bytes.slice(length)?;
        // The length in CDR includes a terminating zero.
        Some(if self.is_cdr { text.strip_suffix(b"\0").unwrap_or(text) } else { text })
    }

    /// A time, µs.
    fn time(&mut self) -> Option<f64> {
        let (seconds, nanoseconds) = (self.unsigned(4)?, self.unsigned(4)?);
        Some(seconds as f64 * 1e6 + nanoseconds as f64 / 1e3)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "# what a radio says\nHeader header\nuint8 NONE=0\nstring NAME = \"x\"\nuint8 role # ours\n\
        Node[] nodes\nfloat64[2] pair\nint16<=5 low -3\nother_msgs/msg/Empty none\n\
        ================================\nMSG: radio/Node\nuint8 id\nfloat32 dis\n\
        ================================\nMSG: other_msgs/Empty\n";

    #[test]
    fn a_message_is_read_by_its_definition() {
        let definition = Definition::read("radio/msg/Frame", TEXT).unwrap();
        let mut plain = [7_u32, 12, 500, 2].map(u32::to_le_bytes).concat();
        plain.extend(b"ab\x09\x02\0\0\0\x05\0\0\x80\x3f\x06\0\0\0\x40");
        plain.extend([1.5_f64, -2.5].map(f64::to_le_bytes).concat());
        plain.extend((-3_i16).to_le_bytes());
        let mut cdr = vec![0, 1, 0, 0];
        cdr.extend([12_u32, 500, 3].map(u32::to_le_bytes).concat());
        cdr.extend(b"ab\0\x09\x02\0\0\0\x05\0\0\0\0\0\x80\x3f\x06\0\0\0\0\0\0\x40\0\0\0\0");
        cdr.extend([1.5_f64, -2.5].map(f64::to_le_bytes).concat());
        cdr.extend((-3_i16).to_le_bytes());
        cdr.push(0);
        for (encoding, message) in [(Encoding::Ros1, plain), (Encoding::Cdr, cdr)] {
            let mut seen = Vec::new();
            let mut visit = |path: &[usize], element: usize, leaf: Leaf<'_>| {
                seen.push(format!("{path:?} {element} {leaf:?}"));
            };
            definition.walk(encoding, &message, &mut visit).unwrap();
            assert_eq!(
                seen,
                [
                    "[0, 0] 0 Time(12000000.5)",
                    "[0, 1] 0 Text([97, 98])",
                    "[1] 0 Number(9.0)",
                    "[2, 0] 0 Number(5.0)",
                    "[2, 1] 0 Number(1.0)",
                    "[2, 0] 1 Number(6.0)",
                    "[2, 1] 1 Number(2.0)",
                    "[3] 0 Number(1.5)",
                    "[3] 1 Number(-2.5)",
                    "[4] 0 Number(-3.0)",
                ]
            );
            let cut = &message[..message.len() - 2];
            assert_eq!(definition.walk(encoding, cut, &mut |_, _, _| {}), None);
        }
    }

    #[test]
    fn what_is_no_definition_is_none() {
        assert!(Definition::read("a/B", "C c").is_none());
        assert!(Definition::read("a/B", "float64[x] c").is_none());
        // A type that contains itself never ends.
        let endless = Definition::read("a/B", "B[1] b").unwrap();
        assert_eq!(endless.walk(Encoding::Ros1, &[0; 100], &mut |_, _, _| {}), None);
        // Very many values that take no bytes.
        let empty = "E[] e\n==\nMSG: a/E\n";
        let many = Definition::read("a/B", empty).unwrap();
        assert_eq!(many.walk(Encoding::Ros1, &[0xff; 4], &mut |_, _, _| {}), None);
    }
}
