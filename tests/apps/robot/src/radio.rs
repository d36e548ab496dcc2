//! Two-way ranging with a DW1000.

use core::cell::RefCell;

use dw1000::hl::SendTime;
use dw1000::mac::{Address, PanId, ShortAddress};
use dw1000::{DW1000, Ready, RxConfig, TxConfig};
use embedded_hal::delay::DelayNs;
use embedded_hal::digital::OutputPin;
use embedded_hal::spi::SpiBus;
use embedded_hal_compat::{Reverse, ReverseCompat};
use kestirim_uwb_ranging::{DoubleSided, Timestamp};

use crate::message::{Answer, Question, Report};

/// The number of times that the chip is polled for completion, and the pause in between, µs: 10 ms in all.
const QUESTIONS: u32 = 200;
const PAUSE_US: u32 = 50;

/// The reason why there is no range.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum RadioError {
    /// The chip did not send, or no anchor answered.
    TimedOut,
    /// The received frame was damaged.
    Damaged,
    /// The received frame is not the expected answer.
    Unexpected,
    /// The bus failed: the driver is lost with it, and a new one must be created after a reset.
    Lost,
}

/// The tag's addresses, and the delays of its antenna (ticks), which the chip subtracts from its timestamps.
#[derive(Clone, Copy, Debug)]
pub struct Tag {
    /// The network of the tag and the anchors.
    pub network: u16,
    /// The tag's address in the network.
    pub address: u16,
    /// The delay from the antenna to the timestamp of a received frame, ticks.
    pub receive_delay: u16,
    /// The delay from the timestamp of a transmitted frame to the antenna, ticks.
    pub transmit_delay: u16,
}

type Driver<B, CS, State> = DW1000<Reverse<B>, Reverse<RefCell<CS>>, State>;

/// A DW1000 on a bus of its own, because the driver holds its chip select.
pub struct Radio<B: SpiBus, CS: OutputPin, D> {
    /// The driver; `None` after the bus failed.
    driver: Option<Driver<B, CS, Ready>>,
    delay: D,
    network: u16,
    exchange: u8,
}

impl<B: SpiBus, CS: OutputPin, D: DelayNs> Radio<B, CS, D> {
    /// Initialises the chip, which must have been reset before; the bus runs at 3 MHz or less.
    ///
    /// # Errors
    /// [`RadioError::Lost`].
    pub fn new(bus: B, chip_select: CS, mut delay: D, tag: &Tag) -> Result<Self, RadioError> {
        let driver = DW1000::new(bus.reverse(), chip_select.reverse_cell());
        let mut driver =
            driver.init(&mut Milliseconds(&mut delay)).map_err(|_| RadioError::Lost)?;
        driver
            .set_antenna_delay(tag.receive_delay, tag.transmit_delay)
            .and_then(|()| driver.set_address(PanId(tag.network), ShortAddress(tag.address)))
            .map_err(|_| RadioError::Lost)?;
        Ok(Self { driver: Some(driver), delay, network: tag.network, exchange: 0 })
    }

    /// Performs an exchange with the anchor at this address.
    ///
    /// It measures both clocks, so no carrier offset is needed, of which the driver reads 16 of 21 bits.
    ///
    /// # Errors
    /// Any [`RadioError`]; the next exchange recovers from all but `Lost`.
    pub fn exchange(&mut self, anchor: u16) -> Result<DoubleSided, RadioError> {
        self.exchange = self.exchange.wrapping_add(1);
        let poll_sent = self.send(Question::Poll, anchor)?;
        let (Answer::Response, response_received) = self.receive(anchor)? else {
            return Err(RadioError::Unexpected);
        };
        let final_sent = self.send(Question::Final, anchor)?;
        let (Answer::Report(Report { poll_received, response_sent, final_received }), _) =
            self.receive(anchor)?
        else {
            return Err(RadioError::Unexpected);
        };
        Ok(DoubleSided::new(
            poll_sent,
            poll_received,
            response_sent,
            response_received,
            final_sent,
            final_received,
        ))
    }

    fn send(&mut self, question: Question, anchor: u16) -> Result<Timestamp, RadioError> {
        let driver = self.driver.take().ok_or(RadioError::Lost)?;
        let config = TxConfig { ranging_enable: true, ..TxConfig::default() };
        let payload = question.encode(self.exchange);
        let mut sending = driver
            .send(&payload, Some(address(self.network, anchor)), SendTime::Now, config)
            .map_err(|_| RadioError::Lost)?;
        let sent =
            patiently(&mut self.delay, || sending.wait_transmit().map_err(|e| e.map(|e| why(&e))));
        self.driver = sending.finish_sending().ok();
        sent.map(|time| Timestamp::new(time.value()))
    }

    fn receive(&mut self, anchor: u16) -> Result<(Answer, Timestamp), RadioError> {
        let driver = self.driver.take().ok_or(RadioError::Lost)?;
        let mut receiving = driver.receive(RxConfig::default()).map_err(|_| RadioError::Lost)?;
        let from = Some(address(self.network, anchor));
        let exchange = self.exchange;
        let received = patiently(&mut self.delay, || {
            // The longest possible frame.
            let mut buffer = [0; 127];
            let message = receiving.wait_receive(&mut buffer).map_err(|e| e.map(|e| why(&e)))?;
            let time = Timestamp::new(message.rx_time.value());
            match Answer::decode(message.frame.payload) {
                Some((answer, number))
                    if number == exchange && message.frame.header.source == from =>
                {
                    Ok((answer, time))
                }
                _ => Err(nb::Error::Other(RadioError::Unexpected)),
            }
        });
        self.driver = receiving.finish_receiving().ok();
        received
    }
}

const fn address(network: u16, short: u16) -> Address {
    Address::Short(PanId(network), ShortAddress(short))
}

fn why<S, CS>(error: &dw1000::Error<S, CS>) -> RadioError
where
    S: embedded_hal_02::blocking::spi::Transfer<u8> + embedded_hal_02::blocking::spi::Write<u8>,
    CS: embedded_hal_02::digital::v2::OutputPin,
{
    match error {
        dw1000::Error::Spi(_) => RadioError::Lost,
        dw1000::Error::FrameFilteringRejection => RadioError::Unexpected,
        dw1000::Error::FrameWaitTimeout | dw1000::Error::PreambleDetectionTimeout => {
            RadioError::TimedOut
        }
        _ => RadioError::Damaged,
    }
}

/// Polls repeatedly, but not for ever.
fn patiently<T>(
    delay: &mut impl DelayNs,
    mut ask: impl FnMut() -> nb::Result<T, RadioError>,
) -> Result<T, RadioError> {
    for _ in 0..QUESTIONS {
        match ask() {
            Ok(answer) => return Ok(answer),
            Err(nb::Error::Other(error)) => return Err(error),
            Err(nb::Error::WouldBlock) => delay.delay_us(PAUSE_US),
        }
    }
    Err(RadioError::TimedOut)
}

/// Adapts a delay to the driver's type, which `embedded-hal-compat` does not support: milliseconds in a byte.
struct Milliseconds<'a, D>(&'a mut D);

impl<D: DelayNs> embedded_hal_02::blocking::delay::DelayMs<u8> for Milliseconds<'_, D> {
    fn delay_ms(&mut self, milliseconds: u8) {
        self.0.delay_ms(milliseconds.into());
    }
}
