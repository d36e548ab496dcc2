use cobs::{EncoderState, PushResult};
use crc::{CRC_32_ISO_HDLC, Crc};
use postcard::experimental::max_size::MaxSize;
use postcard::ser_flavors::{Flavor, crc::CrcModifier};
use serde::Serialize;

use crate::{Error, Message};

/// The version, in its first byte, of a frame on a line with a single sender.
pub const VERSION: u8 = 1;

/// The version of a frame that names its sender ([`encode_from`]). A receiver reads both versions.
pub const VERSION_OF_FLEETS: u8 = 2;

/// The length of the longest frame of either version, delimiters included, in bytes.
pub const CAPACITY: usize = cobs::max_encoding_length(CONTENT) + 2 * size_of_val(&DELIMITER);

/// The length of the longest frame of version 1, in bytes, so that no stack is taken for fields that are not sent.
#[cfg(feature = "embedded-io")]
pub(crate) const CAPACITY_OF_A_LINE: usize =
    cobs::max_encoding_length(Envelope::POSTCARD_MAX_SIZE + CHECKSUM) + 2 * size_of_val(&DELIMITER);

/// The length of the longest frame before COBS stuffing, in bytes.
pub(crate) const CONTENT: usize = EnvelopeOfFleets::POSTCARD_MAX_SIZE + CHECKSUM;

pub(crate) const CHECKSUM: usize = size_of::<u32>();
pub(crate) const CRC: Crc<u32> = Crc::<u32>::new(&CRC_32_ISO_HDLC);
const DELIMITER: u8 = 0;

/// The part of a frame of version 1 that the CRC covers.
#[derive(Serialize, MaxSize)]
struct Envelope {
    version: u8,
    // Two plain bytes: a varint's length would change with the number.
    sequence: [u8; 2],
    message: Message,
}

/// The part of a fleet's frame that the CRC covers.
#[derive(Serialize, MaxSize)]
struct EnvelopeOfFleets {
    version: u8,
    device: [u8; 4],
    boot: [u8; 4],
    sequence: [u8; 4],
    message: Message,
}

/// The sender of a frame in a fleet.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Origin {
    /// The number of the device, which no other device has.
    pub device: u32,
    /// The number of times the device was switched on: one more each time, kept in flash; or anything else that only
    /// grows, such as the seconds of a clock that keeps running.
    pub boot: u32,
}

/// Writes a frame into the buffer and returns the part that is to be sent.
///
/// The sequence number is one more than that of the previous frame; 65535 is followed by 0.
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

/// Writes a frame that names its sender, for lines and ports that many devices share.
///
/// The sequence number is 0 after each start, and one more for each frame. Boot and sequence number together only ever
/// grow: a sender that runs out of sequence numbers increments its boot number.
///
/// # Errors
/// Those of [`encode`].
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

/// A buffer that COBS-encodes what is pushed, between two delimiters.
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
        // A placeholder: the first code is known only later.
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
