//! The first serial port, behind the traits of `embedded-io-async`: interrupts transfer its bytes.

use core::convert::Infallible;

use board::CmsdkPort;
use cortex_m::peripheral::NVIC;
use embassy_sync::blocking_mutex::raw::CriticalSectionRawMutex;
use embassy_sync::pipe::Pipe;
use embassy_sync::signal::Signal;
use embedded_io_async::{ErrorType, Read, Write};
use mps2_an386::interrupt;

/// The bytes received but not read yet.
static ARRIVED: Pipe<CriticalSectionRawMutex, 64> = Pipe::new();
/// Signals that a byte has been sent.
static SENT: Signal<CriticalSectionRawMutex, ()> = Signal::new();

/// The receiving half of the port.
pub(crate) struct Receiver(CmsdkPort);

/// The sending half of the port.
pub(crate) struct Sender(CmsdkPort);

/// Both halves of the first port. It must be called once, as there is one port.
pub(crate) fn first() -> (Receiver, Sender) {
    let port = CmsdkPort::first();
    mps2_an386::unmask(interrupt::UARTRX0);
    mps2_an386::unmask(interrupt::UARTTX0);
    (Receiver(port), Sender(port))
}

impl ErrorType for Receiver {
    type Error = Infallible;
}

impl Read for Receiver {
    async fn read(&mut self, bytes: &mut [u8]) -> Result<usize, Infallible> {
        let count = ARRIVED.read(bytes).await;
        // There is room again for a byte that the handler may have left in the port.
        NVIC::pend(interrupt::UARTRX0);
        Ok(count)
    }
}

impl ErrorType for Sender {
    type Error = Infallible;
}

impl Write for Sender {
    async fn write(&mut self, bytes: &[u8]) -> Result<usize, Infallible> {
        for &byte in bytes {
            while !self.0.send(byte) {
                SENT.wait().await;
            }
        }
        Ok(bytes.len())
    }

    async fn flush(&mut self) -> Result<(), Infallible> {
        while self.0.is_sending() {
            SENT.wait().await;
        }
        Ok(())
    }
}

#[interrupt]
fn UARTRX0() {
    let port = CmsdkPort::served();
    if ARRIVED.is_full() {
        port.postpone();
    } else if let Some(byte) = port.receive() {
        // There is room: this is the only writer.
        let _ = ARRIVED.try_write(&[byte]);
    }
}

#[interrupt]
fn UARTTX0() {
    CmsdkPort::served().sent();
    SENT.signal(());
}
