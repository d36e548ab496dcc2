//! Sources of orbits and clocks.

use kestirim_gnss_message::gps::Subframe;
use kestirim_gnss_ppp::{Carriers, GpsTime, Pattern, SatelliteState};
use kestirim_ppp_filter::{Config, Lean, NoEphemeris, SatelliteObservation};

use crate::Error;
use crate::observations::Observed;

/// The reason why an observed satellite is not used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Unusable {
    /// A code or a phase is missing or incomplete.
    Incomplete,
    /// There is no orbit at the time.
    NoOrbit,
    /// There is no clock at the time.
    NoClock,
    /// The satellite reports itself as unhealthy.
    Unhealthy,
    /// More satellites are in view than the filter has room for.
    NoRoom,
}

impl From<NoEphemeris> for Unusable {
    fn from(reason: NoEphemeris) -> Self {
        match reason {
            NoEphemeris::Unhealthy => Self::Unhealthy,
            // LNAV always has the clock of L1 and L2.
            _ => Self::NoOrbit,
        }
    }
}

/// A source of orbits and clocks.
pub trait Source {
    /// Reads what has arrived; does not block.
    ///
    /// # Errors
    /// If a port fails.
    fn poll(&mut self) -> Result<(), Error>;

    /// Takes a subframe broadcast by a GPS satellite, received at about this time.
    fn take(&mut self, satellite: u8, subframe: Subframe, received: GpsTime);

    /// The state of a GPS satellite at the transmission of the signal received at `received` with this code, m.
    ///
    /// # Errors
    /// The reason why the satellite is not used.
    fn state(
        &self,
        satellite: u8,
        received: GpsTime,
        code: f64,
    ) -> Result<SatelliteState, Unusable>;

    /// The phase centres of the satellites' antennas; `None` if the positions already refer to them.
    fn antenna(&self) -> Option<[Pattern<'static>; 2]>;

    /// The filter configuration for orbits from this source.
    fn config() -> Config<Lean>;

    /// The number of damaged pieces of data.
    fn damaged(&self) -> u32;
}

/// An observed satellite with its state.
pub(crate) fn sighting(
    source: &impl Source,
    time: GpsTime,
    observed: &Observed,
    lock_lost: bool,
) -> Result<SatelliteObservation<'static>, Unusable> {
    let ([Some(first), Some(second)], [Some(l1), Some(l2)]) = (observed.code, observed.phase)
    else {
        return Err(Unusable::Incomplete);
    };
    Ok(SatelliteObservation {
        satellite: observed.satellite,
        carriers: Carriers::L1L2,
        code: [first, second],
        phase: [l1, l2],
        lock_lost,
        state: source.state(observed.satellite, time, first)?,
        antenna: source.antenna(),
    })
}
