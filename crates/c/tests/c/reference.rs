//! Rust versions of the programs, using the crates directly: the expected output of C, bit for bit.

use std::fmt::Write;

use kestirim_air_to_ground::{FreeSpace, Measurement};
use kestirim_pedestrian::{Config, EkfTracker, ImuSample, PathUncertainty, SensorClass};
use kestirim_ppp_filter::{Config as PppConfig, Motion, PppFilter, states};
use kestirim_scalar::{Components, Scalar};
use kestirim_uav_estimator::{Dynamics, FlightFilter, Noise, Sample};
use kestirim_uav_longitudinal::{aerosonde, rate_airspeed_and_pitch};
use kestirim_user_locator::{Area, BeaconSearch};
use kestirim_uwb_tracker::{
    Anchor, Config as TagConfig, Health, InertialSample, OdometrySample, PlaneTracker, RangeSample,
    WheelTracker,
};
use nalgebra::{SVector, Vector2, Vector3};

use crate::ppp::{Epochs, receiver, station};

/// Lines of output in the programs' format.
#[derive(Default)]
struct Lines(String);

impl Lines {
    fn words(&mut self, key: &str, words: impl IntoIterator<Item = u32>) {
        self.0 += key;
        for (index, word) in words.into_iter().enumerate() {
            let before = if index == 0 { '=' } else { ' ' };
            let _ = write!(self.0, "{before}{word:08x}");
        }
        self.0.push('\n');
    }

    fn numbers<T: Scalar>(&mut self, key: &str, numbers: &[T]) {
        self.words(key, numbers.iter().map(|number| number.to_f32().to_bits()));
    }

    fn doubles(&mut self, key: &str, numbers: &[f64]) {
        let words = |number: &f64| [number.to_bits() as u32, (number.to_bits() >> 32) as u32];
        self.words(key, numbers.iter().flat_map(words));
    }

    fn health(&mut self, health: kestirim_health::Health) {
        self.words("health", [health.reasons().fold(0, |bits, reason| bits | 1 << reason as u32)]);
    }
}

/// Reads values from a stream.
struct Reader<'a>(&'a [u8]);

impl Reader<'_> {
    fn word(&mut self) -> Option<[u8; 4]> {
        let (word, rest) = self.0.split_first_chunk()?;
        self.0 = rest;
        Some(*word)
    }

    fn whole(&mut self) -> Option<u32> {
        self.word().map(u32::from_le_bytes)
    }

    fn floats<const N: usize>(&mut self) -> Option<[f32; N]> {
        let mut numbers = [0.0; N];
        for number in &mut numbers {
            *number = f32::from_le_bytes(self.word()?);
        }
        Some(numbers)
    }
}

pub(crate) fn pedestrian<T: Scalar>(stream: &[u8]) -> String {
    let config = Config { contact_height: T::from_f32(0.07), ..Config::default() };
    let mut tracker = EkfTracker::<T>::new(config);
    let mut uncertainty = PathUncertainty::new(SensorClass::Consumer);
    let (mut lines, mut reader, mut time_us) = (Lines::default(), Reader(stream), 0);
    let mut position = SVector::<T, 3>::zeros();
    let tell = |lines: &mut Lines, position: &SVector<T, 3>, of: &PathUncertainty<T>| {
        lines.numbers("position", position.as_array());
        lines.numbers("sigma", of.standard_deviation().as_array());
    };
    for count in 1.. {
        let Some(elapsed_us) = reader.whole() else { break };
        let [ax, ay, az, gx, gy, gz] = reader.floats().expect("a whole record");
        time_us += u64::from(elapsed_us);
        let estimate = tracker
            .update(&ImuSample {
                time_us,
                specific_force: SVector::from([ax, ay, az].map(T::from_f32)),
                angular_rate: SVector::from([gx, gy, gz].map(T::from_f32)),
            })
            .expect("a sensor can measure this");
        position = estimate.position;
        if let Some(stride) = &estimate.stride {
            uncertainty.add(stride);
        }
        if count % 50 == 0 {
            tell(&mut lines, &position, &uncertainty);
        }
    }
    if let Some(stride) = tracker.finish() {
        uncertainty.add(&stride);
    }
    tell(&mut lines, &position, &uncertainty);
    lines.numbers("length", &[tracker.path_length()]);
    lines.health(tracker.warnings().health());
    lines.0
}

/// The common interface of a tag's trackers in these tests.
trait Tag<T: Scalar> {
    fn take(
        &mut self,
        time_us: u64,
        kind: u32,
        anchor: u32,
        values: [T; 3],
    ) -> Result<(), kestirim_uwb_tracker::Error>;
    fn tell(&self, lines: &mut Lines, time_us: u64);
    fn health(&self, time_us: u64) -> Health<T>;
}

impl<T: Scalar> Tag<T> for PlaneTracker<T, 8> {
    fn take(
        &mut self,
        time_us: u64,
        kind: u32,
        anchor: u32,
        [first, second, third]: [T; 3],
    ) -> Result<(), kestirim_uwb_tracker::Error> {
        match kind {
            0 => {
                let range = RangeSample { time_us, anchor: anchor as usize, range: first };
                self.range(&range).map(|_| ())
            }
            1 => {
                let acceleration = SVector::from([first, second, third]);
                self.inertial(&InertialSample { time_us, acceleration, push: None })
            }
            _ => self.odometry(&OdometrySample { time_us, speed: first, turn_rate: second }),
        }
    }

    fn tell(&self, lines: &mut Lines, time_us: u64) {
        let (Some(position), Some(velocity)) = (self.position(), self.velocity()) else { return };
        lines.numbers("position", position.as_array());
        lines.numbers("velocity", velocity.as_array());
        lines.numbers("sigma", &[self.health(time_us).position_sigma.expect("a position")]);
    }

    fn health(&self, time_us: u64) -> Health<T> {
        Self::health(self, time_us)
    }
}

impl<T: Scalar> Tag<T> for WheelTracker<T, 8> {
    fn take(
        &mut self,
        time_us: u64,
        kind: u32,
        anchor: u32,
        [first, second, _]: [T; 3],
    ) -> Result<(), kestirim_uwb_tracker::Error> {
        match kind {
            0 => {
                let range = RangeSample { time_us, anchor: anchor as usize, range: first };
                self.range(&range).map(|_| ())
            }
            1 => Ok(()),
            _ => self.odometry(&OdometrySample { time_us, speed: first, turn_rate: second }),
        }
    }

    fn tell(&self, lines: &mut Lines, time_us: u64) {
        let Some(position) = self.position() else { return };
        lines.numbers("position", position.as_array());
        lines.numbers("sigma", &[self.health(time_us).position_sigma.expect("a position")]);
    }

    fn health(&self, time_us: u64) -> Health<T> {
        Self::health(self, time_us)
    }
}

fn tag<T: Scalar, G: Tag<T>>(stream: &[u8], new: impl FnOnce(&[Anchor<T>], T) -> G) -> String {
    let (mut lines, mut reader, mut now_us) = (Lines::default(), Reader(stream), 0);
    let (count, _) = (reader.whole().expect("a head"), reader.whole());
    let [height] = reader.floats().expect("a head");
    let anchors: Vec<_> = (0..count)
        .map(|_| {
            let [x, y, z, bias] = reader.floats::<4>().expect("an anchor").map(T::from_f32);
            Anchor { position: SVector::from([x, y, z]), bias }
        })
        .collect();
    let mut tracker = new(&anchors, T::from_f32(height));
    for taken in 1.. {
        let Some(elapsed_us) = reader.whole() else { break };
        let (kind, anchor) = (reader.whole().expect("a kind"), reader.whole().expect("an anchor"));
        let values = reader.floats::<3>().expect("values").map(T::from_f32);
        now_us += u64::from(elapsed_us);
        if let Err(error) = tracker.take(now_us, kind, anchor, values) {
            lines.words("status", [kestirim_c::Status::from(error) as u32]);
        }
        if taken % 100 == 0 {
            tracker.tell(&mut lines, now_us);
        }
    }
    lines.health(tracker.health(now_us).in_short());
    lines.0
}

pub(crate) fn robot<T: Scalar>(stream: &[u8]) -> String {
    tag(stream, |anchors, height| {
        PlaneTracker::<T, 8>::new(TagConfig::uncalibrated(height), anchors).expect("anchors")
    })
}

pub(crate) fn wheels<T: Scalar>(stream: &[u8]) -> String {
    tag(stream, |anchors, height| {
        WheelTracker::<T, 8>::new(TagConfig::uncalibrated(height), anchors).expect("anchors")
    })
}

pub(crate) fn uav<T: Scalar>(stream: &[u8]) -> String {
    let dynamics = Dynamics::Continuous(aerosonde().expect("a model"));
    let noise =
        Noise { inputs: Vector2::new(0.009, 0.02), outputs: Vector3::new(0.009, 0.5, 0.009) };
    let mut filter = FlightFilter::<T, 3>::new(&dynamics, &rate_airspeed_and_pitch(), &noise, 0.01)
        .expect("a filter");
    let (mut lines, mut reader, mut time_us) = (Lines::default(), Reader(stream), 0);
    for count in 1.. {
        let Some(elapsed_us) = reader.whole() else { break };
        let present = reader.whole().expect("which there are");
        let input = SVector::from(reader.floats::<2>().expect("inputs").map(f64::from));
        let values = reader.floats::<3>().expect("outputs").map(f64::from);
        time_us += i64::from(elapsed_us);
        let mut measured = [None; 3];
        for (output, measured) in measured.iter_mut().enumerate() {
            *measured = (present >> output & 1 == 1).then_some(values[output]);
        }
        filter.take(&Sample { time_us, input, measured }).expect("a sample");
        if count % 20 == 0 {
            lines.doubles("estimate", filter.filter().estimate().as_array());
            lines.doubles("sigma", filter.filter().sigma().as_array());
        }
    }
    lines.health(filter.health());
    lines.0
}

pub(crate) fn drone<T: Scalar>(stream: &[u8]) -> String {
    let mut reader = Reader(stream);
    let count = reader.whole().expect("a head");
    let corners: Vec<_> =
        (0..count).map(|_| reader.floats::<2>().expect("a corner").map(T::from_f32)).collect();
    let area = Area::new(&corners).expect("an area");
    let mut search = BeaconSearch::<T, 40, 16>::new(FreeSpace::new(None), area);
    while let Some([x, y, height, level]) = reader.floats() {
        let [x, y, height, level] = [x, y, height, level].map(T::from_f32);
        search.measure(&Measurement::new([x, y], height, -level).expect("a measurement"));
    }
    let found = search.estimate::<500>().expect("a place");
    let [x, y] = found.place;
    let mut lines = Lines::default();
    lines.numbers("place", &[x, y, found.sigma(), found.level]);
    lines.health(search.health(&found));
    lines.0
}

pub(crate) fn gnss(_: &[u8]) -> String {
    let mut lines = Lines::default();
    let config = PppConfig { gradient: 0.0, ..PppConfig::new(Motion::Static) };
    let mut filter = PppFilter::<{ states(12) }>::new(config);
    let receiver = receiver();
    // The receiver of C's interface: the same antenna for all systems, and no ocean loading.
    let receiver = kestirim_gnss_ppp::Receiver {
        galileo_antenna: receiver.antenna,
        glonass_antenna: receiver.antenna,
        beidou_antenna: receiver.antenna,
        ocean_loading: None,
        ..receiver
    };
    for epoch in Epochs::at(station()) {
        let solution =
            filter.process(epoch.time, &receiver, &epoch.observations).expect("a solution");
        lines.doubles("position", solution.position.as_array());
        lines.doubles("sigma", &solution.deviations_enu());
        lines.doubles("clock", &[solution.clock, solution.wet_delay]);
        lines.health(solution.health.in_short());
    }
    lines.0
}
