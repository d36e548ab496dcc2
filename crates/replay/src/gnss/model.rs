//! The data of files as the observation model takes them: `kestirim-gnss-files` to `kestirim-gnss-ppp`, bit for bit.

use kestirim_gnss_files::{self as files, Observed};
use kestirim_gnss_ppp::{Carriers, ClockSample, GpsTime, OceanLoading, OrbitSample, Pattern};
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

/// Two carriers.
pub(super) const fn carriers(carriers: files::Carriers) -> Carriers {
    match carriers {
        files::Carriers::L1L2 => Carriers::L1L2,
        files::Carriers::E1E5a => Carriers::E1E5a,
        files::Carriers::E1E5b => Carriers::E1E5b,
    }
}

/// An antenna's phase centres on two carriers, if both are known.
pub(super) fn patterns(antenna: &files::Antenna, carriers: Carriers) -> Option<[Pattern<'_>; 2]> {
    let ([l1, l2], [e1, e5a, e5b]) = (&antenna.frequencies, &antenna.galileo);
    let (first, second) = match carriers {
        Carriers::L1L2 => (l1, l2),
        Carriers::E1E5a => (e1, e5a),
        Carriers::E1E5b => (e1, e5b),
    };
    Some([pattern(first.as_ref()?), pattern(second.as_ref()?)])
}

/// The same of a receiver's antenna: one that was calibrated for GPS alone is taken to be on E1 as on L1, and on E5a
/// and E5b as on L2.
pub(super) fn receiver_patterns(
    antenna: &files::Antenna,
    carriers: Carriers,
) -> Option<[Pattern<'_>; 2]> {
    patterns(antenna, carriers).or_else(|| patterns(antenna, Carriers::L1L2))
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
