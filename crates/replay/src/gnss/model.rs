//! Conversion of the data of files to those of the observation model: `kestirim-gnss-files` to `kestirim-gnss-ppp`, bit
//! for bit.

use kestirim_gnss_files::{self as files, Message, Observed};
use kestirim_gnss_ppp::{
    Carriers, ClockSample, Ephemeris, GpsTime, NavigationMessage, OceanLoading, OrbitSample,
    Pattern,
};
use nalgebra::Vector3;

/// The observations of one instant.
#[derive(Debug, Clone, PartialEq)]
pub struct Epoch {
    /// The instant by the receiver's clock.
    pub time: GpsTime,
    /// Whether the receiver was without power since the previous epoch.
    pub power_failure: bool,
    /// The satellites, each once.
    pub satellites: Vec<Observed>,
}

/// Converts an epoch of a file.
pub fn epoch(epoch: files::Epoch) -> Epoch {
    let files::Epoch { time: instant, power_failure, satellites } = epoch;
    Epoch { time: time(instant), power_failure, satellites }
}

/// Converts an instant.
pub(super) const fn time(time: files::GpsTime) -> GpsTime {
    GpsTime::new_in_day(time.day(), time.second())
}

/// Converts a sample of an orbit, whose time counts from `reference`.
pub(super) fn orbit_sample(reference: GpsTime, sample: &files::OrbitSample) -> OrbitSample {
    OrbitSample::from_ecef(reference, time(sample.time), &Vector3::from(sample.position))
}

/// Converts a sample of a clock, whose time counts from `reference`.
pub(super) fn clock_sample(reference: GpsTime, instant: files::GpsTime, bias: f64) -> ClockSample {
    ClockSample { second: time(instant).since(reference), bias }
}

/// Converts an ephemeris to the clock of two carriers; `None` if the group delay between its own carriers and these is
/// not given. The accuracy is infinite if the satellite declares itself unhealthy or states none: such an ephemeris
/// must not be used.
pub fn ephemeris(told: &files::Ephemeris, carriers: Carriers) -> Option<Ephemeris> {
    let message = match told.message {
        Message::Lnav => NavigationMessage::Lnav,
        Message::Inav => NavigationMessage::Inav,
        Message::Fnav => NavigationMessage::Fnav,
        Message::D1 => NavigationMessage::D1,
    };
    let clock = message.clock_reference(carriers, told.group_delays)?;
    let [offset, drift, ageing] = told.clock;
    let accuracy = told.accuracy.filter(|_| told.is_healthy).unwrap_or(f64::INFINITY);
    Some(Ephemeris {
        constellation: carriers.constellation(),
        time: time(told.time),
        clock_time: time(told.clock_time),
        clock: [offset + clock.correction, drift, ageing],
        issue: told.issue,
        group_delay: clock.group_delay,
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
        holds: told.fit.map_or(message.holds(), |fit| fit / 2.0),
    })
}

/// Converts a pair of carriers.
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

/// The phase centres of an antenna on two carriers, if both are known.
pub(super) fn patterns(
    antenna: &files::Antenna,
    carriers: files::Carriers,
) -> Option<[Pattern<'_>; 2]> {
    antenna.on(carriers).map(|both| both.map(pattern))
}

/// The phase centres of a receiver's antenna on two carriers. An antenna that was calibrated for GPS alone is taken to
/// be on the first carrier of another system as on L1, and on the second as on L2.
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

/// Converts a station's ocean loading.
pub(super) const fn ocean_loading(loading: &files::OceanLoading) -> OceanLoading {
    OceanLoading { amplitude: loading.amplitude, lag: loading.lag }
}
