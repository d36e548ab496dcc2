use cobs::{EncoderState, PushResult};
use crc::{CRC_32_ISO_HDLC, Crc};
use postcard::experimental::max_size::MaxSize;
use postcard::ser_flavors::{Flavor, crc::CrcModifier};
use serde::Serialize;

use crate::{Error, Message};

/// The version of a frame on a line of one sender, in its first byte.
pub const VERSION: u8 = 1;

/// The version of a frame that says who sends it ([`encode_from`]). A receiver reads both.
pub const VERSION_OF_FLEETS: u8 = 2;

/// The longest frame of either version, delimiters included, in bytes.
pub const CAPACITY: usize = cobs::max_encoding_length(CONTENT) + 2 * size_of_val(&DELIMITER);

/// The longest frame of version 1: no stack is taken for what is not sent.
#[cfg(feature = "embedded-io")]
pub(crate) const CAPACITY_OF_A_LINE: usize =
    cobs::max_encoding_length(Envelope::POSTCARD_MAX_SIZE + CHECKSUM) + 2 * size_of_val(&DELIMITER);

/// Bytes of the longest frame before they are stuffed.
pub(crate) const CONTENT: usize = EnvelopeOfFleets::POSTCARD_MAX_SIZE + CHECKSUM;

pub(crate) const CHECKSUM: usize = size_of::<u32>();
pub(crate) const CRC: Crc<u32> = Crc::<u32>::new(&CRC_32_ISO_HDLC);
const DELIMITER: u8 = 0;

/// Part of a frame that the CRC checks.
#[derive(Serialize, MaxSize)]
struct Envelope {
    version: u8,
    // Two plain bytes: a varint's length would change with the number.
    sequence: [u8; 2],
    message: Message,
}

/// The same in a fleet.
#[derive(Serialize, MaxSize)]
struct EnvelopeOfFleets {
    version: u8,
    device: [u8; 4],
    boot: [u8; 4],
    sequence: [u8; 4],
    message: Message,
}

/// Who sends a frame, in a fleet.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Origin {
    /// Number of the device; no two have the same.
    pub device: u32,
    /// How often it was switched on: one more each time, kept in flash; or anything else that only grows, such as the
    /// seconds of a clock that goes on.
    pub boot: u32,
}

/// Writes a frame into the buffer and answers with the part that is to be sent.
///
/// The sequence number is one more than that of the frame before; after 65535 comes 0.
///
/// # Errors
/// [`Error::BufferTooShort`] if the frame does not fit; [`CAPACITY`] bytes hold any.
pub fn encode<'a>(
    message: &Message,
    sequence: u16,
    buffer: &'a mut [u8],
) -> Result<&'a [u8], Error> {
    let envelope =
        Envelope { version: VERSION, sequence: sequence.to_le_bytes(), message: *message };
    write(&envelope, buffer)
}

/// Writes a frame that says who sends it, for lines and ports that many devices share.
///
/// The sequence number is 0 after each start, and one more each time. Boot and sequence number together only ever grow: a
/// sender whose number ends counts a boot.
///
/// # Errors
/// As [`encode`].
pub fn encode_from<'a>(
    origin: Origin,
    message: &Message,
    sequence: u32,
    buffer: &'a mut [u8],
) -> Result<&'a [u8], Error> {
    let envelope = EnvelopeOfFleets {
        version: VERSION_OF_FLEETS,
        device: origin.device.to_le_bytes(),
        boot: origin.boot.to_le_bytes(),
        sequence: sequence.to_le_bytes(),
        message: *message,
    };
    write(&envelope, buffer)
}

fn write<'a>(envelope: &impl Serialize, buffer: &'a mut [u8]) -> Result<&'a [u8], Error> {
    // Postcard's own COBS flavour indexes its buffer, which links the panic machinery into an image.
    let line = Stuffed::new(buffer)?;
    postcard::serialize_with_flavor(envelope, CrcModifier::new(line, CRC.digest()))
        .map_err(|_| Error::BufferTooShort)
}

/// A buffer that stuffs what is pushed, between two delimiters.
struct Stuffed<'a> {
    buffer: &'a mut [u8],
    length: usize,
    state: EncoderState,
}

/// Offset from which the encoder counts its bytes: behind the first delimiter.
const START: usize = size_of_val(&DELIMITER);

impl<'a> Stuffed<'a> {
    fn new(buffer: &'a mut [u8]) -> Result<Self, Error> {
        let mut line = Self { buffer, length: 0, state: EncoderState::default() };
        line.append(DELIMITER)?;
        // The first code is known only later.
        line.append(0)?;
        Ok(line)
    }

    fn append(&mut self, byte: u8) -> Result<(), Error> {
        let length = self.length;
        *self.buffer.get_mut(length).ok_or(Error::BufferTooShort)? = byte;
        self.length += 1;
        Ok(())
    }

    fn set_code(&mut self, index: usize, code: u8) -> Result<(), Error> {
        *self.buffer.get_mut(START + index).ok_or(Error::BufferTooShort)? = code;
        Ok(())
    }

    fn stuff(&mut self, byte: u8) -> Result<(), Error> {
        match self.state.push(byte) {
            PushResult::AddSingle(byte) => self.append(byte),
            PushResult::ModifyFromStartAndSkip((index, code)) => {
                self.set_code(index, code)?;
                self.append(0)
            }
            PushResult::ModifyFromStartAndPushAndSkip((index, code, byte)) => {
                self.set_code(index, code)?;
                self.append(byte)?;
                self.append(0)
            }
        }
    }

    fn close(mut self) -> Result<&'a [u8], Error> {
        let (index, code) = core::mem::take(&mut self.state).finalize();
        self.set_code(index, code)?;
        self.append(DELIMITER)?;
        self.buffer.get(..self.length).ok_or(Error::BufferTooShort)
    }
}

impl<'a> Flavor for Stuffed<'a> {
    type Output = &'a [u8];

    fn try_push(&mut self, byte: u8) -> postcard::Result<()> {
        self.stuff(byte).map_err(|_| postcard::Error::SerializeBufferFull)
    }

    fn finalize(self) -> postcard::Result<&'a [u8]> {
        self.close().map_err(|_| postcard::Error::SerializeBufferFull)
    }
}
