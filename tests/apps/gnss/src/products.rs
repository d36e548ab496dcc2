//! Precise orbits and clocks, as lines of the files that services publish: SP3 and RINEX clock.

use embedded_io::{Read, ReadReady};
use heapless::{String, Vec};
use kestirim_gnss_message::gps::Subframe;
use kestirim_gnss_ppp::constants::SPEED_OF_LIGHT;
use kestirim_gnss_ppp::{Clock, ClockSample, GpsTime, Orbit, OrbitSample, Pattern, SatelliteState};
use kestirim_ppp_filter::{Config, Lean};
use nalgebra::Vector3;

use crate::lines::Lines;
use crate::source::{Source, Unusable};
use crate::{Error, calendar, site};

/// The number of samples from which an orbit is interpolated (each sample must arrive before the fifth-next is
/// reached), and that for a clock.
const ORBIT_SAMPLES: usize = 11;
const CLOCK_SAMPLES: usize = 4;
/// The longest gap between clock samples that is interpolated over, s: the interval of the coarsest products.
const LONGEST_CLOCK_GAP: f64 = 900.0;
/// The bias from which a clock counts as unknown, s.
const NO_BIAS: f64 = 0.9;
const SATELLITES: usize = 32;

/// The error for a line that cannot be parsed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Malformed;

#[derive(Debug)]
struct Satellite {
    orbit: Vec<OrbitSample, ORBIT_SAMPLES>,
    clock: Vec<ClockSample, CLOCK_SAMPLES>,
}

impl Satellite {
    const NONE: Self = Self { orbit: Vec::new(), clock: Vec::new() };
}

/// The products around the current time, from a modem that delivers lines of both kinds of files.
#[derive(Debug)]
pub struct Products<M> {
    modem: Lines<M>,
    tables: Tables,
    damaged: u32,
}

impl<M: Read + ReadReady> Products<M> {
    /// Creates the source from a modem that delivers products before they are needed.
    pub const fn new(modem: M) -> Self {
        Self { modem: Lines::new(modem), tables: Tables::new(), damaged: 0 }
    }
}

impl<M: Read + ReadReady> Source for Products<M> {
    fn poll(&mut self) -> Result<(), Error> {
        let (tables, damaged) = (&mut self.tables, &mut self.damaged);
        let read = |line: &str| {
            let refused = tables.read(line).is_err();
            *damaged = damaged.saturating_add(refused.into());
        };
        self.modem.each(read).map_err(|_| Error::Modem)
    }

    /// Ignores broadcast subframes: products are better.
    fn take(&mut self, _: u8, _: Subframe, _: GpsTime) {}

    fn state(
        &self,
        satellite: u8,
        received: GpsTime,
        code: f64,
    ) -> Result<SatelliteState, Unusable> {
        self.tables.state(satellite, received, code)
    }

    fn antenna(&self) -> Option<[Pattern<'static>; 2]> {
        site::satellite_antenna()
    }

    fn config() -> Config<Lean> {
        site::config()
    }

    fn damaged(&self) -> u32 {
        self.damaged
    }
}

/// Samples of orbits and clocks.
#[derive(Debug)]
struct Tables {
    /// The midnight before the first line with a time, from which all samples count.
    reference: Option<GpsTime>,
    /// The time of the positions that follow.
    time: Option<GpsTime>,
    satellites: [Satellite; SATELLITES],
}

impl Tables {
    const fn new() -> Self {
        Self { reference: None, time: None, satellites: [const { Satellite::NONE }; SATELLITES] }
    }

    /// Takes a line of either format; lines without a time, a position or a GPS clock are ignored.
    fn read(&mut self, line: &str) -> Result<(), Malformed> {
        let done = match line.as_bytes() {
            [b'*', ..] => self.epoch(line),
            [b'P', b'G', ..] => self.position(line),
            [b'A', b'S', b' ', b'G', ..] => self.clock(line),
            [] => None,
            _ => Some(()),
        };
        done.ok_or(Malformed)
    }

    fn epoch(&mut self, line: &str) -> Option<()> {
        // Positions after an unreadable time must not be assigned to another.
        self.time = None;
        self.time = Some(calendar::date(&mut line.split_whitespace().skip(1))?);
        Some(())
    }

    /// Takes a position: columns 5 to 46 are x, y and z in km; an M in column 79 is a manoeuvre between the samples.
    fn position(&mut self, line: &str) -> Option<()> {
        let time = self.time?;
        let column = |start: usize| {
            line.get(start..start + 14)?.trim_ascii().parse().ok().filter(|km: &f64| km.is_finite())
        };
        let position = 1e3 * Vector3::new(column(4)?, column(18)?, column(32)?);
        let moved = line.as_bytes().get(78) == Some(&b'M');
        let reference = self.reference(time);
        let satellite = self.satellites.get_mut(index(line.get(2..4)?)?)?;
        // Zeros stand for an unknown position.
        if !moved && position != Vector3::zeros() {
            let sample = OrbitSample::from_ecef(reference, time, &position);
            append(&mut satellite.orbit, sample, |sample| sample.second);
        }
        Some(())
    }

    /// Takes a clock: `AS Gnn`, the time, the count of numbers that follow, and the first of them: the bias, s.
    fn clock(&mut self, line: &str) -> Option<()> {
        let mut fields = line.split_whitespace().skip(1);
        let satellite = index(fields.next()?.strip_prefix('G')?)?;
        let time = calendar::date(&mut fields)?;
        let bias = number(fields.nth(1)?)?;
        let second = time.since(self.reference(time));
        let satellite = self.satellites.get_mut(satellite)?;
        if bias.abs() < NO_BIAS {
            append(&mut satellite.clock, ClockSample { second, bias }, |sample| sample.second);
        }
        Some(())
    }

    fn reference(&mut self, time: GpsTime) -> GpsTime {
        *self.reference.get_or_insert(GpsTime::new(time.day(), 0.0))
    }

    fn state(
        &self,
        satellite: u8,
        received: GpsTime,
        code: f64,
    ) -> Result<SatelliteState, Unusable> {
        let reference = self.reference.ok_or(Unusable::NoOrbit)?;
        let satellite = usize::from(satellite).checked_sub(1);
        let satellite =
            satellite.and_then(|index| self.satellites.get(index)).ok_or(Unusable::NoOrbit)?;
        let orbit = Orbit { reference, samples: &satellite.orbit };
        let clock = Clock { reference, samples: &satellite.clock, longest_gap: LONGEST_CLOCK_GAP };
        // By the satellite's own clock, which is off by less than a millisecond; the clock does not change noticeably
        // within that.
        let sent = received.plus(-code / SPEED_OF_LIGHT);
        let missing =
            || if orbit.at(sent).is_none() { Unusable::NoOrbit } else { Unusable::NoClock };
        let clock = clock.at(sent).ok_or_else(missing)?;
        let orbit = orbit.at(sent.plus(-clock.bias)).ok_or(Unusable::NoOrbit)?;
        Ok(SatelliteState {
            position: orbit.position,
            velocity: orbit.velocity,
            clock: clock.bias,
            clock_interval: clock.interval,
            clock_distance: clock.distance,
            accuracy: 0.0,
        })
    }
}

/// The index of a satellite's number.
fn index(number: &str) -> Option<usize> {
    number.trim_ascii().parse::<usize>().ok()?.checked_sub(1)
}

/// Parses a number whose exponent may be marked with D, as in Fortran.
fn number(text: &str) -> Option<f64> {
    let mut marked: String<32> = String::new();
    for letter in text.chars() {
        marked.push(if matches!(letter, 'D' | 'd') { 'E' } else { letter }).ok()?;
    }
    marked.parse().ok()
}

/// Appends a sample if it is later than all others, dropping the oldest when full.
fn append<T, const N: usize>(samples: &mut Vec<T, N>, sample: T, second: impl Fn(&T) -> f64) {
    if samples.last().is_some_and(|last| second(last) >= second(&sample)) {
        return;
    }
    if samples.is_full() {
        samples.rotate_left(1);
        samples.pop();
    }
    // Cannot fail: there is room now.
    let _ = samples.push(sample);
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use std::format;

    const MIDDAY: GpsTime = GpsTime::new_in_day(59_025, 43_200.0);

    /// Positions every 15 minutes from 10:45 on, and clocks about midday.
    fn products(samples: u32) -> Tables {
        let mut products = Tables::new();
        let mut read = |line: &str| assert_eq!(products.read(line), Ok(()), "{line}");
        read("#cP2020  6 25 10 45  0.00000000      11 ORBIT IGS14 FIT  ME");
        for sample in 0..samples {
            let (hour, minute) = (10 + (45 + 15 * sample) / 60, (45 + 15 * sample) % 60);
            read(&format!("*  2020  6 25 {hour:2} {minute:2}  0.00000000"));
            let (sine, cosine) = (0.13 * f64::from(sample)).sin_cos();
            let [x, y] = [26_560.0 * cosine, 26_560.0 * sine];
            read(&format!("PG05{x:14.6}{y:14.6}   1000.000000 999999.999999"));
            read("PG06      0.000000      0.000000      0.000000 999999.999999");
            read(&format!("PG07{x:14.6}{y:14.6}   1000.000000 999999.999999                  M"));
        }
        read("AS G05  2020 06 25 11 59 30.000000  2    0.100000000000E-04  0.640687583086E-11");
        read("AS G05  2020 06 25 12 00  0.000000  1    0.200000000000D-04");
        read("AS G06  2020 06 25 12 00  0.000000  1    0.999999999999E+00");
        read("AR HERE 2020 06 25 12 00  0.000000  1    0.159438015248E-04");
        products
    }

    const CODE: f64 = 20_986e3;

    #[test]
    fn a_satellite_is_where_it_sent() {
        let state = products(11).state(5, MIDDAY, CODE).expect("a state");
        assert!((state.position.norm() - 26_578_817.0).abs() < 10.0);
        assert!((state.clock - 2e-5).abs() < 1e-7 && state.clock_interval == 30.0);
        // 11 samples are kept when more arrive, and repeated ones are ignored.
        let mut products = products(13);
        let again = "PG05      1.000000      1.000000      1.000000";
        assert_eq!((products.read(again), products.satellites[4].orbit.len()), (Ok(()), 11));
        let later = products.state(5, MIDDAY, CODE).expect("a state");
        assert!((later.position - state.position).norm() < 0.1);
    }

    #[test]
    fn what_is_missing_is_told() {
        let products = products(11);
        let refused = |time, satellite| products.state(satellite, time, CODE).err();
        assert_eq!(refused(MIDDAY.plus(60.0), 5), Some(Unusable::NoClock));
        assert_eq!(refused(MIDDAY.plus(9_000.0), 5), Some(Unusable::NoOrbit));
        for unknown in [0, 6, 7, 32, 33, 255] {
            assert_eq!(refused(MIDDAY, unknown), Some(Unusable::NoOrbit), "{unknown}");
        }
        assert_eq!(Tables::new().state(5, MIDDAY, CODE).err(), Some(Unusable::NoOrbit));
    }

    #[test]
    fn damaged_lines_are_told() {
        let mut products = products(1);
        for line in [
            "",
            "PG05  10000.000000",
            "PG05  10000.0x0000      0.000000      0.000000",
            "PG33  10000.000000      0.000000      0.000000",
            "AS G05  2020 06 25 12 00",
            "AS G05  2020 06 25 12 00  0.000000  1    0.1E",
            "*  2020  6 25",
            // A position after an unreadable time.
            "PG05  10000.000000      0.000000      0.000000",
        ] {
            assert_eq!(products.read(line), Err(Malformed), "{line}");
        }
    }
}
