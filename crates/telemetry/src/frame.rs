use cobs::{EncoderState, PushResult};
use crc::{CRC_32_ISO_HDLC, Crc};
use postcard::experimental::max_size::MaxSize;
use postcard::ser_flavors::{Flavor, crc::CrcModifier};
use serde::Serialize;

use crate::{Error, Message};

/// The version of the format, in every frame. A receiver reads its own only.
pub const VERSION: u8 = 1;

/// The longest frame, delimiters included, in bytes.
pub const CAPACITY: usize = cobs::max_encoding_length(CONTENT) + 2 * size_of_val(&DELIMITER);

/// Bytes of the longest frame before they are stuffed.
pub(crate) const CONTENT: usize = Envelope::POSTCARD_MAX_SIZE + CHECKSUM;

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
    // Postcard's own COBS flavour indexes its buffer, which links the panic machinery into an image.
    let line = Stuffed::new(buffer)?;
    postcard::serialize_with_flavor(&envelope, CrcModifier::new(line, CRC.digest()))
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
