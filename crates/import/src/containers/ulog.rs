//! The records of `ULog`, and the layout of each topic's.

use std::collections::BTreeMap;
use std::rc::Rc;

use super::bytes::Bytes;
use super::walk::Framing;

/// The size of the length and kind of a record, bytes.
const HEADER: usize = 3;
/// The content of a record of kind `S`.
const SYNC: [u8; 8] = [0x2f, 0x73, 0x13, 0x20, 0x25, 0x0c, 0xbb, 0x12];
/// The total number of fields that are visited to compute sizes: types may contain each other.
const MOST_FIELDS: usize = 1_000_000;
/// The deepest nesting of types.
const DEEPEST: usize = 10;

/// A numeric type.
#[derive(Debug, Clone, Copy)]
enum Number {
    Unsigned(usize),
    Signed(usize),
    Single,
    Double,
}

impl Number {
    fn of(name: &str) -> Option<Self> {
        Some(match name {
            "uint8_t" | "bool" | "char" => Self::Unsigned(1),
            "uint16_t" => Self::Unsigned(2),
            "uint32_t" => Self::Unsigned(4),
            "uint64_t" => Self::Unsigned(8),
            "int8_t" => Self::Signed(1),
            "int16_t" => Self::Signed(2),
            "int32_t" => Self::Signed(4),
            "int64_t" => Self::Signed(8),
            "float" => Self::Single,
            "double" => Self::Double,
            _ => return None,
        })
    }

    fn size(self) -> usize {
        match self {
            Self::Unsigned(size) | Self::Signed(size) => size,
            Self::Single => 4,
            Self::Double => 8,
        }
    }
}

/// The position and type of a number in a topic's record.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    from: usize,
    number: Number,
}

impl Place {
    /// Reads the number from a record's data.
    pub(super) fn value(self, data: &[u8]) -> Option<f64> {
        let mut bytes = Bytes(data.get(self.from..)?);
        Some(match self.number {
            Number::Single => f64::from(f32::from_le_bytes(bytes.take()?)),
            Number::Double => f64::from_le_bytes(bytes.take()?),
            Number::Unsigned(size) => {
                let unsigned = bytes.slice(size)?;
                unsigned.iter().rev().fold(0_u64, |sum, &byte| sum << 8 | u64::from(byte)) as f64
            }
            Number::Signed(size) => {
                let bytes = bytes.slice(size)?;
                let first = if bytes.last()? & 0x80 == 0 { 0 } else { -1 };
                bytes.iter().rev().fold(first, |sum, &byte| sum << 8 | i64::from(byte)) as f64
            }
        })
    }
}

/// A field of a type: `count` values of another type.
#[derive(Debug, Clone)]
struct Field {
    of: String,
    count: usize,
    name: String,
}

/// The definition of a topic's records.
#[derive(Debug)]
pub(super) struct Topic {
    pub(super) name: String,
    pub(super) instance: u8,
    /// The size of its data with and without the trailing padding, bytes, if it can be determined.
    sizes: Option<[usize; 2]>,
}

/// The types and topics defined so far.
#[derive(Debug, Default)]
pub(super) struct Formats {
    types: BTreeMap<String, Rc<[Field]>>,
    topics: BTreeMap<u16, Topic>,
    looked_at: usize,
}

impl Formats {
    /// Takes a record of kind `F`, `name:type field;…`, if it is the first with its name.
    pub(super) fn define(&mut self, body: &[u8]) -> Option<()> {
        let (name, fields) = std::str::from_utf8(body).ok()?.split_once(':')?;
        let field = |text: &str| {
            let (of, name) = text.trim().split_once(' ')?;
            let (of, count) = match of.split_once('[') {
                Some((of, count)) => (of, count.strip_suffix(']')?.parse().ok()?),
                None => (of, 1),
            };
            Some(Field { of: of.to_owned(), count, name: name.trim().to_owned() })
        };
        let fields = fields.split(';').filter(|text| !text.trim().is_empty());
        let fields = fields.map(field).collect::<Option<Rc<[_]>>>()?;
        self.types.entry(name.to_owned()).or_insert(fields);
        Some(())
    }

    /// Takes a record of kind `A`, if it is the first with its number; returns the topic.
    pub(super) fn subscribe(&mut self, body: &[u8]) -> Option<(u16, &Topic)> {
        let mut bytes = Bytes(body);
        let (instance, id) = (bytes.u8()?, bytes.u16()?);
        let name = std::str::from_utf8(bytes.0).ok()?.to_owned();
        if self.topics.contains_key(&id) {
            return None;
        }
        let padding = self.padding(&name);
        let size = self.size(&name, 0);
        let sizes = size.map(|size| [size, size.saturating_sub(padding)]);
        let topic = self.topics.entry(id).or_insert(Topic { name, instance, sizes });
        Some((id, topic))
    }

    pub(super) fn topics(&self) -> impl Iterator<Item = &Topic> {
        self.topics.values()
    }

    /// The position of a number in the records of a type.
    pub(super) fn place(&mut self, of: &str, field: &str, index: usize) -> Option<Place> {
        let fields = self.types.get(of)?.clone();
        let mut from = 0_usize;
        for known in fields.iter() {
            if known.name == field {
                let number = Number::of(&known.of).filter(|_| index < known.count)?;
                return Some(Place { from: from + index * number.size(), number });
            }
            from = from.checked_add(self.size_of_field(known, 0)?)?;
        }
        None
    }

    /// The size of a type, bytes.
    fn size(&mut self, of: &str, depth: usize) -> Option<usize> {
        if let Some(number) = Number::of(of) {
            return Some(number.size());
        }
        let fields = self.types.get(of).filter(|_| depth < DEEPEST)?.clone();
        fields.iter().try_fold(0_usize, |sum, field| {
            self.size_of_field(field, depth + 1).and_then(|size| sum.checked_add(size))
        })
    }

    fn size_of_field(&mut self, field: &Field, depth: usize) -> Option<usize> {
        self.looked_at += 1;
        if self.looked_at > MOST_FIELDS {
            return None;
        }
        self.size(&field.of, depth)?.checked_mul(field.count)
    }

    /// The size of the padding at the end of a type, bytes; it is not written.
    fn padding(&self, of: &str) -> usize {
        let last = self.types.get(of).and_then(|fields| fields.last());
        last.filter(|field| field.name.starts_with("_padding")).map_or(0, |field| field.count)
    }

    /// The topic of a record of kind `D`, and its data.
    pub(super) fn data<'a>(&self, body: &'a [u8]) -> Option<(u16, &'a [u8])> {
        let mut bytes = Bytes(body);
        let id = bytes.u16().filter(|id| self.topics.contains_key(id))?;
        Some((id, bytes.0))
    }

    /// Whether a record may be of a known kind, judging by its size and as much of its body as there is.
    fn is_known(&self, kind: u8, size: usize, body: &[u8]) -> bool {
        let is_text =
            |text: &[u8]| text.iter().all(|&byte| byte == b' ' || byte.is_ascii_graphic());
        let is_key = |at: usize| {
            let length = body.get(at).map_or(1, |&length| usize::from(length));
            let key = body.get(at + 1..).unwrap_or_default();
            length > 0 && length + at < size && is_text(&key[..key.len().min(length)])
        };
        match kind {
            b'D' => match body {
                [low, high, ..] => {
                    let topic = self.topics.get(&u16::from_le_bytes([*low, *high]));
                    let is_size = |sizes: [usize; 2]| sizes.contains(&size.saturating_sub(2));
                    topic.is_some_and(|topic| topic.sizes.is_none_or(is_size))
                }
                _ => size > 2,
            },
            b'A' => size > 3 && is_text(body.get(3..).unwrap_or_default()),
            b'F' => size > 3 && is_text(body),
            b'I' | b'P' => is_key(0),
            b'M' | b'Q' => is_key(1),
            b'L' => size > 8 && body.first().is_none_or(|level| matches!(level, b'0'..=b'7')),
            b'C' => size > 10 && body.first().is_none_or(|level| matches!(level, b'0'..=b'7')),
            b'S' => size == SYNC.len() && SYNC.starts_with(body),
            b'O' | b'R' => size == 2,
            b'B' => size >= 40,
            _ => false,
        }
    }
}

impl Framing for Formats {
    fn length(&self, bytes: &[u8], is_in_sequence: bool) -> Option<usize> {
        let [low, high, kind, body @ ..] = bytes else { return Some(HEADER) };
        let size = usize::from(u16::from_le_bytes([*low, *high]));
        let body = body.get(..size).unwrap_or(body);
        let is_new =
            is_in_sequence && kind.is_ascii_alphabetic() && !b"DAFIPMQLCSORB".contains(kind);
        (is_new || self.is_known(*kind, size, body)).then_some(HEADER + size)
    }

    fn follows(&self, bytes: &[u8]) -> bool {
        bytes.get(2).is_none_or(u8::is_ascii_alphabetic)
    }

    fn candidate(&self, bytes: &[u8]) -> Option<usize> {
        (bytes.len() > 1).then_some(1)
    }
}
