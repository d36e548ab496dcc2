//! An inertial sensor's samples as `host-sim` writes them with `--mcap`: protobuf messages of package `kestirim` with
//! one double for each column, whose names the schema gives (`google/protobuf/descriptor.proto`, `FileDescriptorSet`;
//! <https://protobuf.dev/programming-guides/encoding/>). The time of a sample is that of its record.

use super::bytes::Bytes;

/// The names of the columns, in m/s² and rad/s.
const COLUMNS: [&[u8]; 6] =
    [b"ax_m_s2", b"ay_m_s2", b"az_m_s2", b"gx_rad_s", b"gy_rad_s", b"gz_rad_s"];
/// The descriptor's code for a field of type double.
const DOUBLE: u64 = 1;

/// The value of a field.
enum Value<'a> {
    Varint(u64),
    Fixed64([u8; 8]),
    Bytes(&'a [u8]),
    Fixed32,
}

/// The field numbers of the six values of a sample.
#[derive(Debug, Clone, Copy)]
pub(super) struct OwnImu([u64; 6]);

impl OwnImu {
    /// The layout of a type, from its name and description; `None` if it is not an inertial sensor's.
    pub(super) fn of(kind: &str, description: &[u8]) -> Option<Self> {
        let own = kind.strip_prefix("kestirim.")?;
        let mut found = None;
        // `FileDescriptorSet.file`, `FileDescriptorProto.message_type`
        each(description, 1, |file| {
            each(file, 4, |message| {
                let mut places = [0; 6];
                let mut is_own = false;
                // `DescriptorProto.name`, `DescriptorProto.field`
                each(message, 1, |name| is_own = name == own.as_bytes())?;
                each(message, 2, |field| place(field, &mut places).unwrap_or_default())?;
                if is_own && places.iter().all(|&place| place > 0) {
                    found = Some(Self(places));
                }
                Some(())
            });
        })?;
        found
    }

    /// Acceleration and rate; fields that a message omits are zero.
    pub(super) fn read(self, message: &[u8]) -> Option<[f64; 6]> {
        let mut values = [0.0; 6];
        fields(message, |number, value| {
            let column = self.0.iter().position(|&place| place == number);
            if let (Some(column), Value::Fixed64(bytes)) = (column, value) {
                values[column] = f64::from_le_bytes(bytes);
            }
        })?;
        Some(values)
    }
}

/// Takes the description of a field: `FieldDescriptorProto.name`, `.number`, `.type`.
fn place(field: &[u8], places: &mut [u64; 6]) -> Option<()> {
    let (mut column, mut number, mut kind) = (None, 0, 0);
    fields(field, |id, value| match (id, value) {
        (1, Value::Bytes(name)) => column = COLUMNS.iter().position(|known| *known == name),
        (3, Value::Varint(said)) => number = said,
        (5, Value::Varint(said)) => kind = said,
        _ => {}
    })?;
    if let Some(column) = column.filter(|_| kind == DOUBLE) {
        places[column] = number;
    }
    Some(())
}

/// Calls `take` for each message or text with this field number.
fn each<'a, T>(message: &'a [u8], wanted: u64, mut take: impl FnMut(&'a [u8]) -> T) -> Option<()> {
    fields(message, |number, value| {
        if let (true, Value::Bytes(bytes)) = (number == wanted, value) {
            take(bytes);
        }
    })
}

/// Calls `take` for each field of a message; `None` if the message is malformed.
fn fields<'a>(message: &'a [u8], mut take: impl FnMut(u64, Value<'a>)) -> Option<()> {
    let mut bytes = Bytes(message);
    while !bytes.0.is_empty() {
        let key = varint(&mut bytes)?;
        let value = match key & 7 {
            0 => Value::Varint(varint(&mut bytes)?),
            1 => Value::Fixed64(bytes.take()?),
            2 => {
                let length = usize::try_from(varint(&mut bytes)?).ok()?;
                Value::Bytes(bytes.slice(length)?)
            }
            5 => {
                bytes.take::<4>()?;
                Value::Fixed32
            }
            _ => return None,
        };
        take(key >> 3, value);
    }
    Some(())
}

fn varint(bytes: &mut Bytes<'_>) -> Option<u64> {
    let mut value = 0;
    for shift in (0..64).step_by(7) {
        let byte = bytes.u8()?;
        value |= u64::from(byte & 0x7f) << shift;
        if byte & 0x80 == 0 {
            return Some(value);
        }
    }
    None
}
