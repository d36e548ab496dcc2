//! Corrections of broadcast ephemerides by a service: what is known of them at an instant.

use std::collections::BTreeMap;

use kestirim_gnss_files::{Navigation, Signal, SsrClock, SsrCorrection, SsrOrbit, SsrValues};
use kestirim_gnss_ppp::{Ephemeris, GpsTime, SatelliteState};
use kestirim_ppp_filter::{Timed, corrected};

/// The corrections of one satellite, each in the order of time.
#[derive(Debug, Default)]
struct Own {
    orbits: Vec<Timed<SsrOrbit>>,
    clocks: Vec<Timed<SsrClock>>,
    codes: Vec<(Signal, Vec<Timed<f64>>)>,
}

/// The corrections of all satellites by one service.
#[derive(Debug)]
pub(super) struct Ssr {
    satellites: BTreeMap<u8, Own>,
    /// The numbers of the service and of its solution.
    pub(super) provider: (u16, u8),
    /// Whether corrections by other services or solutions are left out.
    pub(super) are_several: bool,
}

impl Ssr {
    /// The corrections of a stream, if there are any of orbits, whose times are those nearest to `near`. Those of different
    /// services do not fit each other: of several, the first one counts.
    pub(super) fn new(navigation: &Navigation, near: GpsTime) -> Option<Self> {
        let all = &navigation.corrections;
        let first = all.iter().find(|it| matches!(it.values, SsrValues::Orbit(_)))?;
        let provider = first.header.provider;
        let mut satellites: BTreeMap<u8, Own> = BTreeMap::new();
        for it in all.iter().filter(|it| it.header.provider == provider) {
            satellites.entry(it.satellite).or_default().take(it, near);
        }
        satellites.values_mut().for_each(Own::sort);
        let are_several = all.iter().any(|it| it.header.provider != provider);
        Some(Self { satellites, provider, are_several })
    }

    /// The state of a satellite when it sent a signal, by one of its ephemerides; `None` if there is no correction at that
    /// time of any of them.
    pub(super) fn state(
        &self,
        satellite: u8,
        ephemerides: &[Ephemeris],
        sent: GpsTime,
    ) -> Option<SatelliteState> {
        let own = self.satellites.get(&satellite)?;
        let orbit = at(&own.orbits, sent)?;
        let clock = at(&own.clocks, sent)?;
        // A clock's correction is one of the ephemeris that the orbit before it names.
        let of_clock = at(&own.orbits, clock.since())?;
        let away = |it: &&Ephemeris| sent.since(it.time).abs();
        let is_of_both =
            |it: &&Ephemeris| orbit.value.is_of(it.issue) && of_clock.value.is_of(it.issue);
        let candidates = ephemerides.iter().filter(is_of_both);
        let ephemeris = candidates.min_by(|a, b| away(a).total_cmp(&away(b)))?;
        corrected(ephemeris, orbit, clock, sent)
    }

    /// What is to be added to the codes of a satellite, m; `None` unless it is known of each code that there is, since a
    /// combination of one that is corrected and one that is not is worse than that of two that are not.
    pub(super) fn of_codes(
        &self,
        satellite: u8,
        codes: [Option<Signal>; 2],
        time: GpsTime,
    ) -> Option<[f64; 2]> {
        let own = self.satellites.get(&satellite)?;
        let bias = |code: Signal| {
            let (_, biases) = own.codes.iter().find(|(signal, _)| *signal == code)?;
            // Biases of codes hardly change in a day, and are sent more rarely.
            Some(newest(biases, time)?.value)
        };
        let [first, second] = codes;
        Some([bias(first?)?, second.map_or(Some(0.0), bias)?])
    }

    /// Whether there are corrections of a satellite's orbit and clock at any time.
    pub(super) fn knows(&self, satellite: u8) -> bool {
        let own = self.satellites.get(&satellite);
        own.is_some_and(|own| !own.orbits.is_empty() && !own.clocks.is_empty())
    }
}

impl Own {
    fn take(&mut self, told: &SsrCorrection, near: GpsTime) {
        match told.values {
            SsrValues::Orbit(value) => self.orbits.push(Timed::new(near, &told.header, value)),
            SsrValues::Clock(value) => self.clocks.push(Timed::new(near, &told.header, value)),
            SsrValues::Code(signal, value) => {
                let place = self.codes.iter().position(|(known, _)| *known == signal);
                let place = place.unwrap_or_else(|| {
                    self.codes.push((signal, Vec::new()));
                    self.codes.len() - 1
                });
                self.codes[place].1.push(Timed::new(near, &told.header, value));
            }
        }
    }

    fn sort(&mut self) {
        sort(&mut self.orbits);
        sort(&mut self.clocks);
        self.codes.iter_mut().for_each(|(_, biases)| sort(biases));
    }
}

fn sort<T>(values: &mut [Timed<T>]) {
    values.sort_by(|a, b| a.since().since(b.since()).total_cmp(&0.0));
}

/// The newest value at a time; the first one before its own time.
fn newest<T>(values: &[Timed<T>], time: GpsTime) -> Option<&Timed<T>> {
    let later = values.partition_point(|it| time.since(it.since()) >= 0.0);
    values.get(later.saturating_sub(1))
}

/// The newest value at a time, if it still serves.
fn at<T>(values: &[Timed<T>], time: GpsTime) -> Option<&Timed<T>> {
    newest(values, time).filter(|newest| newest.serves_at(time))
}

#[cfg(test)]
mod tests {
    use kestirim_gnss_files::{SsrHeader, SsrSystem};

    use super::*;

    #[test]
    fn the_newest_value_serves_and_the_first_one_before_its_time() {
        let midnight = GpsTime::new(59_025, 0.0);
        let header = |second: f64| SsrHeader {
            system: SsrSystem::Gps,
            second: midnight.second_of_week() + second,
            interval: 60.0,
            reference: midnight.second_of_week() + second + 30.0,
            provider: (258, 1),
            configuration: 0,
        };
        // As they came, one of them late.
        let mut values =
            [100.0, 160.0, 40.0, 220.0].map(|second| Timed::new(midnight, &header(second), second));
        sort(&mut values);
        let served = |second| {
            let of = |it: &Timed<f64>| it.value;
            let time = midnight.plus(second);
            [newest(&values, time).map(of), at(&values, time).map(of)]
        };
        assert_eq!(served(0.0), [Some(40.0), None]);
        assert_eq!(served(39.5), [Some(40.0); 2]);
        assert_eq!(served(99.9), [Some(40.0); 2]);
        assert_eq!(served(100.0), [Some(100.0); 2]);
        assert_eq!(served(340.0), [Some(220.0); 2]);
        assert_eq!(served(340.1), [Some(220.0), None]);
    }
}
