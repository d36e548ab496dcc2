//! An I²C bus with one device.

use embedded_hal::i2c::{
    Error, ErrorKind, ErrorType, I2c, NoAcknowledgeSource, Operation, SevenBitAddress,
};

/// A device as its bus accesses it, with registers as in the hardware's documentation.
pub trait Device {
    /// The device's address.
    const ADDRESS: SevenBitAddress;

    /// Handles a write by the master.
    fn write(&mut self, bytes: &[u8]);

    /// Handles a read by the master.
    fn read(&mut self, bytes: &mut [u8]);
}

/// A bus with this device only.
pub struct Only<D>(pub D);

/// The error for an address at which there is no device.
#[derive(Clone, Copy, Debug, defmt::Format)]
pub struct NoAcknowledge;

impl Error for NoAcknowledge {
    fn kind(&self) -> ErrorKind {
        ErrorKind::NoAcknowledge(NoAcknowledgeSource::Address)
    }
}

impl<D> ErrorType for Only<D> {
    type Error = NoAcknowledge;
}

impl<D: Device> I2c for Only<D> {
    fn transaction(
        &mut self,
        address: SevenBitAddress,
        operations: &mut [Operation<'_>],
    ) -> Result<(), NoAcknowledge> {
        if address != D::ADDRESS {
            return Err(NoAcknowledge);
        }
        for operation in operations {
            match operation {
                Operation::Write(bytes) => self.0.write(bytes),
                Operation::Read(bytes) => self.0.read(bytes),
            }
        }
        Ok(())
    }
}

/// One-byte registers behind an auto-incrementing pointer.
pub(crate) struct Registers<const N: usize> {
    bytes: [u8; N],
    pointer: usize,
}

impl<const N: usize> Registers<N> {
    pub(crate) const fn new() -> Self {
        Self { bytes: [0; N], pointer: 0 }
    }

    /// Handles a write: the first byte sets the pointer, the others the registers.
    pub(crate) fn write(&mut self, bytes: &[u8]) {
        let Some((&pointer, values)) = bytes.split_first() else { return };
        self.pointer = pointer.into();
        for &value in values {
            self.set(self.pointer, &[value]);
            self.pointer += 1;
        }
    }

    pub(crate) fn read(&mut self, bytes: &mut [u8]) {
        for byte in bytes {
            *byte = self.get(self.pointer);
            self.pointer += 1;
        }
    }

    /// The register that is read next.
    pub(crate) fn pointer(&self) -> usize {
        self.pointer
    }

    pub(crate) fn get(&self, register: usize) -> u8 {
        self.bytes.get(register).copied().unwrap_or(0)
    }

    pub(crate) fn set(&mut self, first: usize, values: &[u8]) {
        for (register, &value) in self.bytes.iter_mut().skip(first).zip(values) {
            *register = value;
        }
    }
}

/// A measurement in steps, as an analogue-to-digital converter gives it: rounded, and saturated.
pub(crate) fn steps(value: f32, step: f32) -> i16 {
    let steps = value / step;
    (steps + if steps < 0.0 { -0.5 } else { 0.5 }) as i16
}
