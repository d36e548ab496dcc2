//! Broadcast ephemerides, as the filter needs them: a satellite's state at an instant, with the accuracy that the
//! satellite itself states, or that of a service's corrections.

use std::collections::BTreeMap;

use kestirim_gnss_files::{Message, Navigation, Signal, Signals};
use kestirim_gnss_ppp::constants::SPEED_OF_LIGHT;
use kestirim_gnss_ppp::{Carriers, Constellation, Ephemeris, GpsTime, Klobuchar, SatelliteState};

use super::model;
use super::products::Unusable;
use super::ssr::Ssr;

/// The ephemerides of the satellites that were observed.
#[derive(Debug, Default)]
pub struct Broadcast {
    satellites: BTreeMap<u8, Own>,
    ionosphere: Option<Klobuchar>,
    /// Corrections by a service: without those of its orbit and clock, no satellite is used.
    ssr: Option<Ssr>,
    /// Whether codes are corrected, too.
    with_codes: bool,
}

/// The ephemerides of one satellite, including unhealthy ones: an earlier one does not serve in place of those.
#[derive(Debug, Default)]
struct Own {
    /// The ephemerides of the message that is made for the observed carriers, and that tells their health.
    first: Vec<Ephemeris>,
    /// The ephemerides of another message, whose orbits are the same.
    other: Vec<Ephemeris>,
    /// The ephemerides to which corrections refer, with the clock as it is broadcast.
    corrected: Vec<Ephemeris>,
    /// The observed codes.
    codes: [Option<Signal>; 2],
}

impl Own {
    /// The ephemeris to be used at a time: the nearest one, unless the satellite declares itself unhealthy in it.
    fn at(&self, time: GpsTime) -> Option<&Ephemeris> {
        let nearest = |of| Ephemeris::nearest(of, time);
        let away = |it: &Ephemeris| time.since(it.time).abs();
        let (first, other) = (nearest(&self.first), nearest(&self.other));
        match (first.filter(|it| serves(it)), other.filter(|it| serves(it))) {
            (Some(first), Some(other)) if away(other) < away(first) => Some(other),
            (None, other) if first.is_none() => other,
            (served, _) => served,
        }
    }

    /// Whether the satellite is left out at some time.
    fn is_disowned(&self) -> bool {
        let is_judged = |it: &Ephemeris| self.first.iter().any(|first| first.holds_at(it.time));
        let mut unhealthy = self.other.iter().filter(|it| !serves(it));
        self.first.iter().any(|it| !serves(it)) || unhealthy.any(|it| !is_judged(it))
    }
}

/// Whether an ephemeris has an accuracy, unlike those of unhealthy satellites ([`model::ephemeris`]).
const fn serves(ephemeris: &Ephemeris) -> bool {
    ephemeris.accuracy.is_finite()
}

impl Broadcast {
    /// The ephemerides for the observed signals of each satellite, and corrections from around `start`; those of codes are for
    /// codes that nothing else has corrected.
    pub(super) fn new(
        navigation: &Navigation,
        signals: &BTreeMap<u8, Signals>,
        start: GpsTime,
        with_codes: bool,
    ) -> Self {
        let mut broadcast = Self {
            ionosphere: navigation.ionosphere.map(|[alpha, beta]| Klobuchar { alpha, beta }),
            ssr: Ssr::new(navigation, start),
            with_codes,
            ..Self::default()
        };
        for (&satellite, signals) in signals {
            let carriers = model::carriers(signals.carriers);
            let on = |message, carriers| -> Vec<_> {
                let told = navigation.satellite(satellite, message).iter();
                told.filter_map(|ephemeris| model::ephemeris(ephemeris, carriers)).collect()
            };
            let of = |message| on(message, carriers);
            let own = match carriers {
                Carriers::L1L2 => Own { first: of(Message::Lnav), ..Own::default() },
                Carriers::E1E5a => {
                    Own { first: of(Message::Fnav), other: of(Message::Inav), ..Own::default() }
                }
                Carriers::E1E5b => Own { first: of(Message::Inav), ..Own::default() },
                Carriers::B1B3 | Carriers::B1B2 => Own { first: of(Message::D1), ..Own::default() },
                Carriers::G1G2 { .. } | Carriers::B1cB2a => Own::default(),
            };
            let corrected = match carriers.constellation() {
                _ if broadcast.ssr.is_none() => Vec::new(),
                Constellation::Gps => on(Message::Lnav, Carriers::L1L2),
                Constellation::Galileo => on(Message::Inav, Carriers::E1E5b),
                Constellation::Glonass | Constellation::BeiDou => Vec::new(),
            };
            let own = Own { corrected, codes: signals.code, ..own };
            broadcast.satellites.insert(satellite, own);
        }
        broadcast
    }

    /// The state of a satellite when it sent what was received at `time` with a code of `code` m, and the lead of its
    /// clock over that of the first carrier alone, s.
    pub(super) fn state(
        &self,
        satellite: u8,
        time: GpsTime,
        code: f64,
    ) -> Result<(SatelliteState, f64), Unusable> {
        let sent = time.plus(-code / SPEED_OF_LIGHT);
        let own = self.satellites.get(&satellite).ok_or(Unusable::NoOrbit)?;
        let ephemeris = own.at(sent).ok_or(Unusable::NoOrbit)?;
        if let Some(ssr) = &self.ssr {
            let state = ssr.state(satellite, &own.corrected, sent).ok_or(Unusable::NoClock)?;
            return Ok((state, ephemeris.group_delay));
        }
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

    /// What is to be added to the codes of a satellite, m, if it is known.
    pub(super) fn of_codes(&self, satellite: u8, time: GpsTime) -> Option<[f64; 2]> {
        let ssr = self.ssr.as_ref().filter(|_| self.with_codes)?;
        ssr.of_codes(satellite, self.satellites.get(&satellite)?.codes, time)
    }

    /// Whether there is any ephemeris for the observed signals of a satellite, and any correction if there are some.
    pub(super) fn knows(&self, satellite: u8) -> bool {
        self.satellites.get(&satellite).is_some_and(|own| match &self.ssr {
            Some(ssr) => !own.corrected.is_empty() && ssr.knows(satellite),
            None => !own.first.is_empty() || !own.other.is_empty(),
        })
    }

    /// Whether the codes of any satellite are corrected at a time.
    pub(super) fn has_codes_at(&self, time: GpsTime) -> bool {
        self.satellites.keys().any(|satellite| self.of_codes(*satellite, time).is_some())
    }

    /// The corrections, if there are any.
    pub(super) const fn ssr(&self) -> Option<&Ssr> {
        self.ssr.as_ref()
    }

    /// The broadcast ionosphere model, if there is one.
    pub(super) const fn ionosphere(&self) -> Option<&Klobuchar> {
        self.ionosphere.as_ref()
    }

    /// The satellites that declare themselves unhealthy, or state no accuracy, at some time.
    pub(super) fn disowned(&self) -> impl Iterator<Item = u8> {
        self.satellites.iter().filter(|(_, own)| own.is_disowned()).map(|(satellite, _)| *satellite)
    }
}

#[cfg(test)]
mod tests {
    use kestirim_gnss_files::{self as files, Carriers as Observed};

    use super::*;

    /// The ephemeris of a healthy satellite at a second of a day.
    fn told(message: Message, second: f64) -> files::Ephemeris {
        let time = files::GpsTime::new(59_025, second);
        files::Ephemeris {
            message,
            time,
            clock_time: time,
            clock: [second, 0.0, 0.0],
            issue: 1,
            root_of_axis: 5_440.6,
            eccentricity: 1e-4,
            mean_anomaly: 0.0,
            mean_motion_correction: 0.0,
            perigee: 0.0,
            node: 0.0,
            node_rate: 0.0,
            inclination: 0.97,
            inclination_rate: 0.0,
            latitude_terms: [0.0; 2],
            radius_terms: [0.0; 2],
            inclination_terms: [0.0; 2],
            group_delays: [0.0; 2],
            accuracy: Some(3.12),
            is_healthy: true,
            fit: None,
        }
    }

    fn unhealthy(message: Message, second: f64) -> files::Ephemeris {
        files::Ephemeris { is_healthy: false, ..told(message, second) }
    }

    /// The time of the ephemeris that serves at a second, and whether the satellite is left out at times.
    fn served(carriers: Observed, all: &[files::Ephemeris], second: f64) -> (Option<f64>, bool) {
        let navigation = Navigation::of(all.iter().map(|it| (1, *it)));
        let carriers = model::carriers(carriers);
        let of = |message| {
            let told = navigation.satellite(1, message).iter();
            told.filter_map(|it| model::ephemeris(it, carriers)).collect::<Vec<_>>()
        };
        let [lnav, fnav, inav] = [Message::Lnav, Message::Fnav, Message::Inav].map(of);
        let own = if lnav.is_empty() {
            Own { first: fnav, other: inav, ..Own::default() }
        } else {
            Own { first: lnav, ..Own::default() }
        };
        let time = GpsTime::new_in_day(59_025, second);
        (own.at(time).map(|it| it.time.second()), own.is_disowned())
    }

    #[test]
    fn an_older_ephemeris_does_not_serve_in_place_of_an_unhealthy_one() {
        let all = [told(Message::Lnav, 7_200.0), unhealthy(Message::Lnav, 14_384.0)];
        assert_eq!(served(Observed::L1L2, &all, 9_000.0), (Some(7_200.0), true));
        assert_eq!(served(Observed::L1L2, &all, 13_000.0), (None, true));
        assert_eq!(served(Observed::L1L2, &all[..1], 13_000.0), (Some(7_200.0), false));
    }

    #[test]
    fn what_is_said_on_e5a_counts_for_e5a() {
        use Message::{Fnav, Inav};
        let served = |all: &[_]| served(Observed::E1E5a, all, 9_000.0);
        assert_eq!(served(&[unhealthy(Fnav, 7_200.0), told(Inav, 7_800.0)]), (None, true));
        // The unhealthy signal may be E5b.
        let other = [told(Fnav, 7_200.0), unhealthy(Inav, 7_800.0)];
        assert_eq!(served(&other), (Some(7_200.0), false));
        assert_eq!(served(&other[1..]), (None, true));
        let both = [told(Fnav, 7_200.0), told(Inav, 7_800.0)];
        assert_eq!(served(&both), (Some(7_800.0), false));
    }
}
