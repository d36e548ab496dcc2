//! Orbits and clocks that the satellites broadcast, corrected by a service: a modem delivers its frames of RTCM 3 as they come.

use embedded_io::{Read, ReadReady};
use kestirim_gnss_message::gps::Subframe;
use kestirim_gnss_message::ssr::{Message, System};
use kestirim_gnss_ppp::{GpsTime, Pattern, SatelliteState};
use kestirim_ppp_filter::{Broadcast, Config, Corrected, Lean, MessagePart};

use crate::frames::Frames;
use crate::source::{Source, Unusable};
use crate::{Error, site};

/// All satellites of GPS.
const SATELLITES: usize = 32;

/// The ephemerides received from the satellites, and the corrections of them.
#[derive(Debug)]
pub struct Corrections<M> {
    modem: Frames<M>,
    broadcast: Broadcast<SATELLITES>,
    corrected: Corrected<SATELLITES>,
    /// When a satellite was heard last: corrections tell the second of the week alone.
    heard: Option<GpsTime>,
}

impl<M: Read + ReadReady> Corrections<M> {
    /// Creates the source from a modem that delivers the frames of a service.
    pub const fn new(modem: M) -> Self {
        Self {
            modem: Frames::new(modem),
            broadcast: Broadcast::new(),
            corrected: Corrected::new(),
            heard: None,
        }
    }
}

impl<M: Read + ReadReady> Source for Corrections<M> {
    fn poll(&mut self) -> Result<(), Error> {
        let Self { modem, broadcast, corrected, heard } = self;
        let read = |data: &[u8]| {
            // The filter of this application has no room for other systems.
            let message = Message::from_data(data).filter(|it| it.header.system == System::Gps);
            if let (Some(message), Some(heard)) = (message, *heard) {
                corrected.take(&message, Some, broadcast, heard);
            }
        };
        modem.each(read).map_err(|_| Error::Modem)
    }

    fn take(&mut self, satellite: u8, subframe: Subframe, received: GpsTime) {
        self.broadcast.take(satellite, MessagePart::Gps(subframe), received);
        self.heard = Some(received);
    }

    fn state(
        &self,
        satellite: u8,
        received: GpsTime,
        code: f64,
    ) -> Result<SatelliteState, Unusable> {
        Ok(self.corrected.state(satellite, &self.broadcast, received, code)?)
    }

    fn antenna(&self) -> Option<[Pattern<'static>; 2]> {
        None
    }

    fn config() -> Config<Lean> {
        site::without_products()
    }

    fn damaged(&self) -> u32 {
        self.modem.damaged
    }
}
