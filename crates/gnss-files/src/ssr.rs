//! Corrections of broadcast ephemerides, from a service's stream.

pub use kestirim_gnss_message::ssr::{
    Clock as SsrClock, Header as SsrHeader, Orbit as SsrOrbit, System as SsrSystem,
};
#[cfg(feature = "rtcm")]
use kestirim_gnss_message::ssr::{Correction, Message};

use crate::observations::Signal;
#[cfg(feature = "rtcm")]
use crate::system::System;

/// A correction of a satellite's broadcast orbit or clock, or of one of its codes.
///
/// The messages tell neither day nor week: the times nearest to the observations are meant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SsrCorrection {
    /// The number of the satellite ([`Observed::prn`](crate::Observed::prn)).
    pub satellite: u8,
    /// What it has in common with others of the same message.
    pub header: SsrHeader,
    /// The values.
    pub values: SsrValues,
}

/// The values of a correction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SsrValues {
    /// What is to be subtracted from the broadcast orbit.
    Orbit(SsrOrbit),
    /// What is to be added to the broadcast clock.
    Clock(SsrClock),
    /// What is to be added to a code, m.
    Code(Signal, f64),
}

#[cfg(feature = "rtcm")]
impl SsrCorrection {
    /// The corrections of a message; those of signals that are not used are left out.
    pub(crate) fn of(message: Message<'_>) -> impl Iterator<Item = Self> {
        let system = match message.header.system {
            SsrSystem::Gps => System::Gps,
            SsrSystem::Galileo => System::Galileo,
        };
        message.corrections().filter_map(move |(number, correction)| {
            let values = match correction {
                Correction::Orbit(orbit) => SsrValues::Orbit(orbit),
                Correction::Clock(clock) => SsrValues::Clock(clock),
                Correction::Code { signal: [band, attribute], bias } => {
                    let signal = Signal::new(system.letter(), &[b'C', band, attribute])?;
                    SsrValues::Code(signal, bias)
                }
            };
            Some(Self { satellite: system.number(number)?, header: message.header, values })
        })
    }
}
