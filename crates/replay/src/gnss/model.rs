//! The data of files as the observation model takes them: `kestirim-gnss-files` to `kestirim-gnss-ppp`, bit for bit.

use kestirim_gnss_files::{self as files, Message, Observed};
use kestirim_gnss_ppp::{
    Carriers, ClockSample, Constellation, Ephemeris, GpsTime, OceanLoading, OrbitSample, Pattern,
};
use nalgebra::Vector3;

/// Observations of one instant.
#[derive(Debug, Clone, PartialEq)]
pub struct Epoch {
    /// The instant by the receiver's clock.
    pub time: GpsTime,
    /// Whether the receiver was without power since the epoch before.
    pub power_failure: bool,
    /// The satellites, each once.
    pub satellites: Vec<Observed>,
}

/// An epoch of a file.
pub fn epoch(epoch: files::Epoch) -> Epoch {
    let files::Epoch { time: instant, power_failure, satellites } = epoch;
    Epoch { time: time(instant), power_failure, satellites }
}

/// An instant.
pub(super) const fn time(time: files::GpsTime) -> GpsTime {
    GpsTime::new_in_day(time.day(), time.second())
}

/// A sample of an orbit that counts from `reference`.
pub(super) fn orbit_sample(reference: GpsTime, sample: &files::OrbitSample) -> OrbitSample {
    OrbitSample::from_ecef(reference, time(sample.time), &Vector3::from(sample.position))
}

/// A sample of a clock that counts from `reference`.
pub(super) fn clock_sample(reference: GpsTime, instant: files::GpsTime, bias: f64) -> ClockSample {
    ClockSample { second: time(instant).since(reference), bias }
}

/// An ephemeris of GPS holds for half its fit interval, which is four hours unless it tells another one …
const USUAL_FIT: f64 = 14_400.0;
/// … one of Galileo is not to be used when it is older, s (Galileo OS service definition), …
const OLDEST_GALILEO: f64 = 14_400.0;
/// … and one of BeiDou is sent for an hour (BDS-SIS-ICD-B1I) and serves for another, s.
const OLDEST_BEIDOU: f64 = 7_200.0;

/// An ephemeris with the clock of two carriers; none of which the group delay between its own carriers and these is not told. The
/// accuracy is infinite where the satellite calls itself unhealthy or tells none: such an ephemeris must not be used.
pub(super) fn ephemeris(told: &files::Ephemeris, carriers: Carriers) -> Option<Ephemeris> {
    let [first, second] = told.group_delays;
    let (delay, own) = match (carriers, told.message) {
        (Carriers::L1L2, Message::Lnav) | (Carriers::E1E5a, Message::Fnav) => (first, first),
        (Carriers::E1E5b, Message::Inav) => (second, second),
        // Galileo OS SIS ICD 5.1.5: the clock of E1 alone is the same, whichever it is taken from.
        (Carriers::E1E5a, Message::Inav) => (first, second),
        // BDS-SIS-ICD-B1I, TGD1 and TGD2: the clock is that of B3I, and those of B1I and B2I are behind by their delays.
        (Carriers::B1B3, Message::D1) => (first - carriers.ionosphere_free([first, 0.0]), first),
        (Carriers::B1B2, Message::D1) => (first - carriers.ionosphere_free([first, second]), first),
        _ => return None,
    };
    let constellation = carriers.constellation();
    let holds = match constellation {
        Constellation::Gps => told.fit.unwrap_or(USUAL_FIT) / 2.0,
        Constellation::Galileo => OLDEST_GALILEO,
        Constellation::Glonass | Constellation::BeiDou => OLDEST_BEIDOU,
    };
    let [offset, drift, ageing] = told.clock;
    let accuracy = told.accuracy.filter(|_| told.is_healthy).unwrap_or(f64::INFINITY);
    Some(Ephemeris {
        constellation,
        time: time(told.time),
        clock_time: time(told.clock_time),
        clock: [offset - own + delay, drift, ageing],
        group_delay: delay,
        root_of_axis: told.root_of_axis,
        eccentricity: told.eccentricity,
        mean_anomaly: told.mean_anomaly,
        mean_motion_correction: told.mean_motion_correction,
        perigee: told.perigee,
        node: told.node,
        node_rate: told.node_rate,
        inclination: told.inclination,
        inclination_rate: told.inclination_rate,
        latitude_terms: told.latitude_terms,
        radius_terms: told.radius_terms,
        inclination_terms: told.inclination_terms,
        accuracy,
        holds,
    })
}

/// Two carriers.
pub(super) const fn carriers(carriers: files::Carriers) -> Carriers {
    match carriers {
        files::Carriers::L1L2 => Carriers::L1L2,
        files::Carriers::E1E5a => Carriers::E1E5a,
        files::Carriers::E1E5b => Carriers::E1E5b,
        files::Carriers::G1G2 { channel } => Carriers::G1G2 { channel },
        files::Carriers::B1B3 => Carriers::B1B3,
        files::Carriers::B1B2 => Carriers::B1B2,
        files::Carriers::B1cB2a => Carriers::B1cB2a,
    }
}

/// An antenna's phase centres on two carriers, if both are known.
pub(super) fn patterns(
    antenna: &files::Antenna,
    carriers: files::Carriers,
) -> Option<[Pattern<'_>; 2]> {
    antenna.on(carriers).map(|both| both.map(pattern))
}

/// The same of a receiver's antenna: one that was calibrated for GPS alone is taken to be on the first carrier of another system
/// as on L1, and on the second as on L2.
pub(super) fn receiver_patterns(
    antenna: &files::Antenna,
    carriers: files::Carriers,
) -> Option<[Pattern<'_>; 2]> {
    patterns(antenna, carriers).or_else(|| patterns(antenna, files::Carriers::L1L2))
}

fn pattern(centre: &files::PhaseCentre) -> Pattern<'_> {
    Pattern {
        offset: centre.offset,
        first: centre.first,
        step: centre.step,
        mean: &centre.mean,
        azimuth_step: centre.azimuth_step,
        by_azimuth: &centre.by_azimuth,
    }
}

/// A station's ocean loading.
pub(super) const fn ocean_loading(loading: &files::OceanLoading) -> OceanLoading {
    OceanLoading { amplitude: loading.amplitude, lag: loading.lag }
}
