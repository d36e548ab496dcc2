//! The first serial port of the machine `mps2-an386`, for programs that use its interrupts.

use crate::registers::Register;

const BASE: usize = 0x4000_4000;
const DATA: Register = Register::at(BASE);
const STATE: Register = Register::at(BASE + 0x04);
const CONTROL: Register = Register::at(BASE + 0x08);
const INTERRUPTS: Register = Register::at(BASE + 0x0C);
const DIVIDER: Register = Register::at(BASE + 0x10);

const SENDING: u32 = 1 << 0;
const RECEIVED: u32 = 1 << 1;

/// The port's registers: one byte and one interrupt in each direction.
#[derive(Clone, Copy, Debug)]
pub struct CmsdkPort(());

impl CmsdkPort {
    /// The enable bits of sender and receiver, and of the interrupts of both.
    const ENABLE: u32 = 0b1111;
    /// The smallest divider that the port accepts, for the highest rate; QEMU sends at once.
    const FASTEST: u32 = 16;

    /// Turns on the first port, which QEMU connects to its first `-serial`. Its interrupts are still masked.
    pub fn first() -> Self {
        DIVIDER.write(Self::FASTEST);
        CONTROL.write(Self::ENABLE);
        Self(())
    }

    /// The same port within a handler of its interrupts, where it is already turned on.
    pub fn served() -> Self {
        Self(())
    }

    /// Takes the received byte, if there is one. Until it is taken, the other side waits.
    pub fn receive(self) -> Option<u8> {
        INTERRUPTS.write(RECEIVED);
        (STATE.read() & RECEIVED != 0).then(|| DATA.read() as u8)
    }

    /// Acknowledges the interrupt but leaves the byte in the port, for a handler that has no room for it.
    pub fn postpone(self) {
        INTERRUPTS.write(RECEIVED);
    }

    /// Sends a byte, unless the previous one is still being sent.
    pub fn send(self, byte: u8) -> bool {
        let is_free = !self.is_sending();
        if is_free {
            DATA.write(byte.into());
        }
        is_free
    }

    /// Whether a byte is still being sent.
    pub fn is_sending(self) -> bool {
        STATE.read() & SENDING != 0
    }

    /// Acknowledges the interrupt after a byte has been sent.
    pub fn sent(self) {
        INTERRUPTS.write(SENDING);
    }
}
