//! Precise products as the filter wants them: a satellite's orbit, clock and antenna at an instant; the data of files as
//! the observation model takes them, bit for bit.

use kestirim_gnss_files::{self as files, Antenna, Antennas, Clocks, Observed, Orbits};
use kestirim_gnss_ppp::constants::SPEED_OF_LIGHT;
use kestirim_gnss_ppp::{
    Carriers, Clock, ClockSample, GpsTime, Orbit, OrbitSample, Pattern, SatelliteState,
};
use kestirim_ppp_filter::SatelliteObservation;
use nalgebra::Vector3;

/// Clocks are bridged over the interval of the coarsest products, s.
const LONGEST_CLOCK_GAP: f64 = 900.0;
/// The largest number of a satellite: of Galileo those of their names and 100.
const SATELLITES: u8 = 136;

/// One satellite's products.
struct Satellite {
    orbit: Vec<OrbitSample>,
    clock: Vec<ClockSample>,
    antenna: Option<Antenna>,
}

/// The products of a day.
pub(super) struct Products {
    reference: GpsTime,
    satellites: Vec<Satellite>,
}

impl Products {
    /// For observations that begin at `start`: clocks from `clocks` if there are any, from the orbit files otherwise.
    pub(super) fn new(
        start: files::GpsTime,
        orbits: &Orbits,
        clocks: Option<&Clocks>,
        antennas: &Antennas,
    ) -> Self {
        let reference = GpsTime::new(start.day(), 0.0);
        let clock_sample =
            |instant, bias| ClockSample { second: time(instant).since(reference), bias };
        let satellites = (0..=SATELLITES).map(|prn| {
            // A sample of a manoeuvre or of a jumping clock belongs to neither side.
            let samples = orbits.satellite(prn);
            let steady = samples.iter().filter(|sample| !sample.manoeuvre);
            let orbit = steady.map(|sample| {
                let position = Vector3::from(sample.position);
                OrbitSample::from_ecef(reference, time(sample.time), &position)
            });
            let clock = match clocks {
                Some(clocks) => {
                    let samples = clocks.satellite(prn).iter();
                    samples.map(|sample| clock_sample(sample.time, sample.bias)).collect()
                }
                None => samples
                    .iter()
                    .filter(|sample| !sample.clock_event)
                    .filter_map(|sample| Some(clock_sample(sample.time, sample.clock?)))
                    .collect(),
            };
            let antenna = antennas.satellite(prn, start).cloned();
            Satellite { orbit: orbit.collect(), clock, antenna }
        });
        Self { reference, satellites: satellites.collect() }
    }

    /// An observed satellite with its state when it sent what was received at `time`; none if something is missing.
    pub(super) fn observation(
        &self,
        time: GpsTime,
        observed: &Observed,
    ) -> Option<SatelliteObservation<'_>> {
        let ([Some(first), Some(second)], [Some(l1), Some(l2)]) = (observed.code, observed.phase)
        else {
            return None;
        };
        let satellite = self.satellites.get(usize::from(observed.prn))?;
        let clock = Clock {
            reference: self.reference,
            samples: &satellite.clock,
            longest_gap: LONGEST_CLOCK_GAP,
        };
        // By the satellite's own clock; it is off by less than a millisecond, in which it loses nothing.
        let sent = time.plus(-first / SPEED_OF_LIGHT);
        let orbit = Orbit { reference: self.reference, samples: &satellite.orbit };
        // Products that begin with the first epoch do not know when its signals were sent, 70 ms before.
        let clock = clock.at(sent).or_else(|| clock.at(time))?;
        let orbit = orbit.at(sent.plus(-clock.bias))?;
        let carriers = carriers(observed.carriers);
        Some(SatelliteObservation {
            satellite: observed.prn,
            carriers,
            code: [first, second],
            phase: [l1, l2],
            lock_lost: observed.loss_of_lock.contains(&true),
            state: SatelliteState {
                position: orbit.position,
                velocity: orbit.velocity,
                clock: clock.bias,
                clock_interval: clock.interval,
                clock_distance: clock.distance,
            },
            antenna: satellite.antenna.as_ref().and_then(|antenna| patterns(antenna, carriers)),
        })
    }
}

/// An instant.
pub(super) const fn time(time: files::GpsTime) -> GpsTime {
    GpsTime::new_in_day(time.day(), time.second())
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
pub(super) fn patterns(antenna: &Antenna, carriers: Carriers) -> Option<[Pattern<'_>; 2]> {
    let ([l1, l2], [e1, e5a, e5b]) = (&antenna.frequencies, &antenna.galileo);
    let (first, second) = match carriers {
        Carriers::L1L2 => (l1, l2),
        Carriers::E1E5a => (e1, e5a),
        Carriers::E1E5b => (e1, e5b),
    };
    Some([pattern(first.as_ref()?), pattern(second.as_ref()?)])
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
