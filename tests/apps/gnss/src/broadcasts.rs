//! Orbits and clocks that the satellites broadcast themselves: no modem is needed, and positions are good to metres.

use kestirim_gnss_message::gps::Subframe;
use kestirim_gnss_ppp::{Carriers, GpsTime, Pattern, SatelliteState};
use kestirim_ppp_filter::{Broadcast, Config, Lean, MessagePart};

use crate::source::{Source, Unusable};
use crate::{Error, site};

/// All satellites of GPS.
const SATELLITES: usize = 32;

/// The ephemerides received from the satellites.
#[derive(Debug, Default)]
pub struct Broadcasts(Broadcast<SATELLITES>);

impl Source for Broadcasts {
    fn poll(&mut self) -> Result<(), Error> {
        Ok(())
    }

    fn take(&mut self, satellite: u8, subframe: Subframe, received: GpsTime) {
        self.0.take(satellite, MessagePart::Gps(subframe), received);
    }

    fn state(
        &self,
        satellite: u8,
        received: GpsTime,
        code: f64,
    ) -> Result<SatelliteState, Unusable> {
        Ok(self.0.state(satellite, Carriers::L1L2, received, code)?)
    }

    fn antenna(&self) -> Option<[Pattern<'static>; 2]> {
        None
    }

    fn config() -> Config<Lean> {
        site::without_products()
    }

    fn damaged(&self) -> u32 {
        0
    }
}
