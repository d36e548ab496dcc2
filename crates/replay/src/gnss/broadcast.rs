//! What satellites broadcast, as the filter wants it: a satellite's state at an instant, with its own word for how good it is.

use std::collections::{BTreeMap, BTreeSet};

use kestirim_gnss_files::{Message, Navigation, Signals};
use kestirim_gnss_ppp::constants::SPEED_OF_LIGHT;
use kestirim_gnss_ppp::{Carriers, Ephemeris, GpsTime, Klobuchar, SatelliteState};

use super::model;
use super::products::Unusable;

/// Ephemerides of the satellites that were observed.
#[derive(Debug, Default)]
pub struct Broadcast {
    satellites: BTreeMap<u8, Vec<Ephemeris>>,
    /// Those of which some ephemerides do not serve, as they say so themselves.
    disowned: BTreeSet<u8>,
    ionosphere: Option<Klobuchar>,
}

impl Broadcast {
    /// The ephemerides for the signals that are observed of each satellite.
    pub(super) fn new(navigation: &Navigation, signals: &BTreeMap<u8, Signals>) -> Self {
        let mut broadcast = Self {
            ionosphere: navigation.ionosphere.map(|[alpha, beta]| Klobuchar { alpha, beta }),
            ..Self::default()
        };
        for (&satellite, signals) in signals {
            let carriers = model::carriers(signals.carriers);
            // Where two tell the same, that which is made for the carriers.
            let messages: &[Message] = match carriers {
                Carriers::L1L2 => &[Message::Lnav],
                Carriers::E1E5a => &[Message::Fnav, Message::Inav],
                Carriers::E1E5b => &[Message::Inav],
            };
            let all = messages.iter().flat_map(|message| navigation.satellite(satellite, *message));
            let (serve, disowned): (Vec<_>, Vec<_>) = all
                .map(|ephemeris| model::ephemeris(ephemeris, carriers))
                .partition(Option::is_some);
            if !disowned.is_empty() {
                broadcast.disowned.insert(satellite);
            }
            broadcast.satellites.insert(satellite, serve.into_iter().flatten().collect());
        }
        broadcast
    }

    /// The state of a satellite when it sent what was received at `time` with a code of so many m, and by what its clock is ahead
    /// of that of the first carrier alone, s.
    pub(super) fn state(
        &self,
        satellite: u8,
        time: GpsTime,
        code: f64,
    ) -> Result<(SatelliteState, f64), Unusable> {
        let sent = time.plus(-code / SPEED_OF_LIGHT);
        let ephemerides = self.satellites.get(&satellite).ok_or(Unusable::NoOrbit)?;
        let ephemeris = Ephemeris::nearest(ephemerides, sent).ok_or(Unusable::NoOrbit)?;
        let clock = ephemeris.clock_at(sent);
        let orbit = ephemeris.orbit_at(sent.plus(-clock));
        let state = SatelliteState {
            position: orbit.position,
            velocity: orbit.velocity,
            clock,
            clock_interval: 0.0,
            clock_distance: 0.0,
            accuracy: ephemeris.accuracy,
        };
        Ok((state, ephemeris.group_delay))
    }

    /// The ionosphere, if it is broadcast.
    pub(super) const fn ionosphere(&self) -> Option<&Klobuchar> {
        self.ionosphere.as_ref()
    }

    /// Satellites that call themselves unhealthy, or tell no accuracy, at some time.
    pub(super) fn disowned(&self) -> impl Iterator<Item = u8> {
        self.disowned.iter().copied()
    }
}
