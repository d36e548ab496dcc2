//! Precise products, as the filter needs them: a satellite's orbit, clock and antenna at an instant.

use kestirim_gnss_files::{
    self as files, Antenna, AntennaModel, Antennas, Clocks, Observed, Orbits,
};
use kestirim_gnss_ppp::constants::SPEED_OF_LIGHT;
use kestirim_gnss_ppp::{Clock, ClockSample, GpsTime, Orbit, OrbitSample, Pattern, SatelliteState};
use kestirim_ppp_filter::{CodeObservation, SatelliteObservation};

use super::broadcast::Broadcast;
use super::coverage::names;
use super::model::{carriers, clock_sample, orbit_sample, patterns};
use super::orbit_jumps;
use super::whole_biases::WholeBiases;

/// The longest gap between clock samples that is interpolated, s: the interval of the coarsest products.
const LONGEST_CLOCK_GAP: f64 = 900.0;
/// Time before the first sample after a clock's jump at which the clock counts as unknown, s.
const JUST_BEFORE: f64 = 1e-3;

/// Why an observed satellite cannot be used.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unusable {
    /// A code or a phase is missing.
    Incomplete,
    /// There is no orbit at the time.
    NoOrbit,
    /// There is no clock at the time.
    NoClock,
}

/// The products of one satellite.
#[derive(Debug, Default)]
pub struct Satellite {
    /// The orbit, in the order of time.
    pub orbit: Vec<OrbitSample>,
    /// The clock, in the order of time.
    pub clock: Vec<ClockSample>,
    /// The antenna, if known.
    pub antenna: Option<Antenna>,
}

/// The edition of the antenna models with which products were made: that of the clocks, which would absorb the offset
/// of another edition.
pub(super) fn antenna_model(orbits: &Orbits, clocks: Option<&Clocks>) -> Option<AntennaModel> {
    clocks.and_then(|clocks| clocks.antenna_model).or(orbits.antenna_model)
}

/// The products of a day.
#[derive(Debug)]
pub struct Products {
    reference: GpsTime,
    satellites: Vec<Satellite>,
    whole: WholeBiases,
    /// Satellites with samples off their orbit, the number of samples removed for each, and how far they were off, m.
    jumps: Vec<(u8, usize, f64)>,
    /// Broadcast ephemerides, which replace the products if there are no precise ones.
    broadcast: Option<Broadcast>,
}

/// The clock of an orbit's sample, after a mark that it has jumped if it has.
fn clock_of(reference: GpsTime, sample: &files::OrbitSample) -> impl Iterator<Item = ClockSample> {
    let at = |bias| clock_sample(reference, sample.time, bias);
    let unknown = at(f64::NAN);
    let jump = ClockSample { second: unknown.second - JUST_BEFORE, ..unknown };
    let jump = sample.clock_event.then_some(jump);
    jump.into_iter().chain(sample.clock.map(at))
}

impl Products {
    /// Products for observations that begin at `start`. Clocks are from `clocks` if given, otherwise from the orbit
    /// files.
    pub fn new(
        start: files::GpsTime,
        orbits: &Orbits,
        clocks: Option<&Clocks>,
        antennas: &Antennas,
    ) -> Self {
        let reference = GpsTime::new(start.day(), 0.0);
        let model = antenna_model(orbits, clocks);
        let mut jumps = Vec::new();
        let satellites = (0..=u8::MAX).map(|prn| {
            // A sample of a manoeuvre belongs to neither side.
            let samples = orbits.satellite(prn);
            let steady = samples.iter().filter(|sample| !sample.manoeuvre);
            let mut orbit: Vec<_> = steady.map(|sample| orbit_sample(reference, sample)).collect();
            if let Some((count, metres)) = orbit_jumps::remove(&mut orbit) {
                jumps.push((prn, count, metres));
            }
            let clock = match clocks {
                Some(clocks) => clocks
                    .satellite(prn)
                    .iter()
                    .map(|sample| clock_sample(reference, sample.time, sample.bias))
                    .collect(),
                None => samples.iter().flat_map(|sample| clock_of(reference, sample)).collect(),
            };
            let antenna = antennas.satellite(prn, start);
            // If that edition's values are not known, another's are better than none.
            let as_made = antenna.zip(model).and_then(|(antenna, model)| antenna.in_model(model));
            let antenna = as_made.or_else(|| antenna.cloned());
            Satellite { orbit, clock, antenna }
        });
        let satellites = satellites.collect();
        Self { reference, satellites, whole: WholeBiases::default(), jumps, broadcast: None }
    }

    /// Products whose samples all count from `reference`: the satellites in the order of their numbers, from 1.
    pub fn of_satellites(
        reference: GpsTime,
        satellites: impl IntoIterator<Item = Satellite>,
    ) -> Self {
        let satellites = std::iter::once(Satellite::default()).chain(satellites).collect();
        let whole = WholeBiases::default();
        Self { reference, satellites, whole, jumps: Vec::new(), broadcast: None }
    }

    /// Broadcast ephemerides in place of products.
    pub(super) fn of_broadcast(start: files::GpsTime, broadcast: Broadcast) -> Self {
        let nothing = Self::of_satellites(GpsTime::new(start.day(), 0.0), []);
        Self { broadcast: Some(broadcast), ..nothing }
    }

    /// A warning about samples that were off their orbit and are not used.
    pub(super) fn jumps(&self) -> Option<String> {
        let farthest = self.jumps.iter().map(|(_, _, metres)| *metres).reduce(f64::max)?;
        let count: usize = self.jumps.iter().map(|(_, count, _)| count).sum();
        let names = names(self.jumps.iter().map(|(number, ..)| *number));
        Some(format!(
            "orbits of {names} jump by up to {farthest:.0} m at {count} of their samples: these satellites are left out around them"
        ))
    }

    /// The broadcast ephemerides, if they are used in place of products.
    pub const fn broadcast(&self) -> Option<&Broadcast> {
        self.broadcast.as_ref()
    }

    /// Adds the biases that make ambiguities integers.
    #[must_use]
    pub(super) fn with_whole(self, whole: WholeBiases) -> Self {
        Self { whole, ..self }
    }

    /// The satellite biases that make ambiguities integers.
    pub const fn whole(&self) -> &WholeBiases {
        &self.whole
    }

    /// The observations of a satellite, with its state when it sent what was received at `time`.
    ///
    /// # Errors
    /// An [`Unusable`] that says what is missing.
    pub fn observation(
        &self,
        time: GpsTime,
        observed: &Observed,
    ) -> Result<SatelliteObservation<'_>, Unusable> {
        let ([Some(first), Some(second)], [Some(l1), Some(l2)]) = (observed.code, observed.phase)
        else {
            return Err(Unusable::Incomplete);
        };
        let (state, _) = self.state(observed.prn, time, first)?;
        let [of_first, of_second] = self.of_codes(observed.prn, time).unwrap_or_default();
        Ok(SatelliteObservation {
            satellite: observed.prn,
            carriers: carriers(observed.carriers),
            code: [first + of_first, second + of_second],
            phase: [l1, l2],
            lock_lost: observed.loss_of_lock.contains(&true),
            state,
            antenna: self.antenna(observed),
        })
    }

    /// The codes of a satellite, with its state when it sent what was received at `time`, as in [`Self::observation`].
    ///
    /// # Errors
    /// An [`Unusable`] that says what is missing.
    pub fn code(
        &self,
        time: GpsTime,
        observed: &Observed,
    ) -> Result<CodeObservation<'_>, Unusable> {
        let first = observed.code[0].ok_or(Unusable::Incomplete)?;
        let (state, group_delay) = self.state(observed.prn, time, first)?;
        let of_codes = self.of_codes(observed.prn, time);
        let [of_first, of_second] = of_codes.unwrap_or_default();
        let [first, second] = observed.code;
        Ok(CodeObservation {
            satellite: observed.prn,
            carriers: carriers(observed.carriers),
            code: [first.map(|it| it + of_first), second.map(|it| it + of_second)],
            // A corrected code refers to the service's clock by itself.
            group_delay: if of_codes.is_some() { 0.0 } else { group_delay },
            state,
            antenna: self.antenna(observed),
        })
    }

    /// What a service's corrections add to the codes of a satellite, m, if it is known.
    fn of_codes(&self, number: u8, time: GpsTime) -> Option<[f64; 2]> {
        self.broadcast.as_ref()?.of_codes(number, time)
    }

    /// The edition of the antenna model used for a satellite, if it is stated.
    pub(super) fn antenna_model(&self, number: u8) -> Option<AntennaModel> {
        self.satellites.get(usize::from(number))?.antenna.as_ref()?.model
    }

    /// The phase centres of an observed satellite's antenna, if known; broadcast ephemerides need none.
    fn antenna(&self, observed: &Observed) -> Option<[Pattern<'_>; 2]> {
        let satellite = self.satellites.get(usize::from(observed.prn))?;
        patterns(satellite.antenna.as_ref()?, observed.carriers)
    }

    /// The state of a satellite when it sent what was received at `time` with a code of `first` m, and the lead of its
    /// clock over that of the first carrier alone, s, if that is given.
    fn state(
        &self,
        number: u8,
        time: GpsTime,
        first: f64,
    ) -> Result<(SatelliteState, f64), Unusable> {
        if let Some(broadcast) = &self.broadcast {
            return broadcast.state(number, time, first);
        }
        let satellite = self.satellites.get(usize::from(number)).ok_or(Unusable::NoOrbit)?;
        let clock = Clock {
            reference: self.reference,
            samples: &satellite.clock,
            longest_gap: LONGEST_CLOCK_GAP,
        };
        // The time by the satellite's own clock, which is off by less than a millisecond; over that the clock drifts by
        // nothing.
        let sent = time.plus(-first / SPEED_OF_LIGHT);
        let orbit = Orbit { reference: self.reference, samples: &satellite.orbit };
        // A satellite that the products do not know at all lacks an orbit in the first place.
        let missing =
            || if orbit.at(sent).is_none() { Unusable::NoOrbit } else { Unusable::NoClock };
        // Products that begin with the first epoch do not cover the time when its signals were sent, 70 ms earlier: a
        // clock drifts by less than a millimetre in it.
        let clock = clock.at(sent).or_else(|| clock.at(time)).ok_or_else(missing)?;
        let orbit = orbit.at(sent.plus(-clock.bias)).ok_or(Unusable::NoOrbit)?;
        let state = SatelliteState {
            position: orbit.position,
            velocity: orbit.velocity,
            clock: clock.bias,
            clock_interval: clock.interval,
            clock_distance: clock.distance,
            accuracy: 0.0,
        };
        Ok((state, 0.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_clock_is_not_interpolated_across_its_jump() {
        let (reference, day) = (GpsTime::new(58_849, 0.0), 58_849);
        let sample = |second, clock, clock_event| files::OrbitSample {
            time: files::GpsTime::new(day, second),
            position: [2e7, 0.0, 0.0],
            clock,
            clock_predicted: false,
            clock_event,
            manoeuvre: false,
        };
        for clock in [Some(5e-4), None] {
            let file = [
                sample(0.0, Some(1e-4), false),
                sample(300.0, Some(1e-4), false),
                sample(600.0, clock, true),
                sample(900.0, Some(5e-4), false),
            ];
            let samples: Vec<_> = file.iter().flat_map(|it| clock_of(reference, it)).collect();
            let clock = Clock { reference, samples: &samples, longest_gap: LONGEST_CLOCK_GAP };
            let at = |second| Some(clock.at(reference.plus(second))?.bias);
            assert_eq!((at(150.0), at(300.0)), (Some(1e-4), Some(1e-4)));
            assert_eq!((at(450.0), at(599.0)), (None, None));
            let jumped = file[2].clock;
            assert_eq!((at(600.0), at(750.0), at(900.0)), (jumped, jumped, Some(5e-4)));
        }
    }
}
