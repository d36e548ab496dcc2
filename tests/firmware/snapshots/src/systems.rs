//! Estimators to be stored and restored, one or more for each system, and their samples. The host's tests include this
//! file.

use heapless::Vec;
use kestirim_air_to_ground::Measurement;
use kestirim_gnss_ppp::{Carriers, GpsTime, Receiver, SatelliteState};
use kestirim_luenberger::Predictor;
use kestirim_particle_filter::Xoshiro128PlusPlus;
use kestirim_pedestrian::{ImuSample, Navigator, Tracker as Walk};
use kestirim_ppp_filter::{PppFilter, SatelliteObservation};
use kestirim_scalar::Scalar;
use kestirim_snapshot::Layout;
use kestirim_uav_estimator::{FlightFilter, FlightObserver, Sample as FlightSample};
use kestirim_user_locator::{Locator, PublishedLocator, Tracker as Follower};
use kestirim_uwb_tracker::{
    HeightFinder, OdometrySample, PublishedTracker, RangeSample, Tracker as Robot, WheelTracker,
};
use nalgebra::SVector;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

/// The largest number of satellites in an epoch.
pub const SATELLITES: usize = 12;

/// A sample for any of the estimators.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[allow(clippy::large_enum_variant, reason = "nothing to box with where there is no allocator")]
pub enum Sample {
    /// An inertial sample: time (µs), specific force (m/s²) and angular rate (rad/s).
    Inertial(u64, [f32; 3], [f32; 3]),
    /// A range: time (µs), anchor and range (m).
    Range(u64, u32, f32),
    /// A wheel sample: time (µs), speed (m/s) and turn rate (rad/s).
    Wheels(u64, f32, f32),
    /// A path loss: the drone's x, y and height (m) and the loss (dB), one a second.
    PathLoss([f32; 4]),
    /// A sample of a flight: time (µs), inputs and outputs of an aeroplane.
    Flight(i64, [f64; 2], [f64; 3]),
    /// An epoch: its time, and for each satellite its number, codes (m), phases (cycles) and state.
    Epoch(GpsTime, Vec<(u8, [f64; 2], [f64; 2], SatelliteState), SATELLITES>),
}

/// An estimator that can be stored, and whose estimates after each sample have a digest.
pub trait Sleeper: Layout + Serialize + DeserializeOwned {
    /// Processes a sample, and returns a digest of all estimates after it.
    fn take(&mut self, sample: &Sample) -> u64;
}

/// A digest of a list of numbers, which differs for lists that differ in a bit (FNV-1a, Fowler, Noll and Vo 1991).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Digest(pub u64);

impl Digest {
    /// The digest of an empty list.
    pub const NONE: Self = Self(0xcbf2_9ce4_8422_2325);

    /// The digest with one more number.
    pub fn and(self, bits: u64) -> Self {
        let step =
            |digest: u64, byte: &u8| (digest ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3);
        Self(bits.to_le_bytes().iter().fold(self.0, step))
    }

    /// The digest with these numbers added.
    pub fn all<T: Scalar>(self, numbers: &[T]) -> Self {
        numbers.iter().fold(self, |digest, number| digest.and(number.to_f64().to_bits()))
    }
}

impl<T, N> Sleeper for Walk<T, N>
where
    T: Scalar + Serialize + DeserializeOwned,
    N: Navigator<T> + Layout + Serialize + DeserializeOwned,
{
    fn take(&mut self, sample: &Sample) -> u64 {
        let &Sample::Inertial(time_us, force, rate) = sample else { return 0 };
        let [specific_force, angular_rate] =
            [force, rate].map(|it| SVector::from(it.map(T::from_f32)));
        let estimate = self.update(&ImuSample { time_us, specific_force, angular_rate });
        let said = Digest::NONE.and(u64::from(self.warnings().gaps)).all(&[self.path_length()]);
        estimate.map_or(said.0, |estimate| {
            let stance = said.and(u64::from(estimate.stance));
            stance.all(estimate.position.as_slice()).all(estimate.velocity.as_slice()).0
        })
    }
}

/// A range to a known anchor.
fn range<T: Scalar>(sample: &Sample) -> Option<RangeSample<T>> {
    let &Sample::Range(time_us, anchor, range) = sample else { return None };
    Some(RangeSample { time_us, anchor: anchor as usize, range: T::from_f32(range) })
}

fn wheels<T: Scalar>(sample: &Sample) -> Option<OdometrySample<T>> {
    let &Sample::Wheels(time_us, speed, turn_rate) = sample else { return None };
    Some(OdometrySample { time_us, speed: T::from_f32(speed), turn_rate: T::from_f32(turn_rate) })
}

impl<T, const D: usize, const N: usize, const A: usize> Sleeper for Robot<T, D, N, A>
where
    T: Scalar + Serialize + DeserializeOwned,
{
    fn take(&mut self, sample: &Sample) -> u64 {
        let taken = range(sample).map(|sample| self.range(&sample).is_ok());
        let driven = wheels(sample).map(|sample| self.odometry(&sample).is_ok());
        let said =
            Digest::NONE.and(u64::from(taken == Some(true))).and(u64::from(driven == Some(true)));
        self.estimate().map_or(said, |estimate| said.all(estimate.mean.as_slice())).0
    }
}

impl<T, const A: usize> Sleeper for WheelTracker<T, A>
where
    T: Scalar + Serialize + DeserializeOwned,
{
    fn take(&mut self, sample: &Sample) -> u64 {
        let taken = range(sample).map(|sample| self.range(&sample).is_ok());
        let driven = wheels(sample).map(|sample| self.odometry(&sample).is_ok());
        let said =
            Digest::NONE.and(u64::from(taken == Some(true))).and(u64::from(driven == Some(true)));
        self.estimate().map_or(said, |estimate| said.all(estimate.mean.as_slice())).0
    }
}

impl<T, const D: usize, const N: usize, const A: usize> Sleeper for PublishedTracker<T, D, N, A>
where
    T: Scalar + Serialize + DeserializeOwned,
{
    /// Processes a range. An epoch ends with the last anchor.
    fn take(&mut self, sample: &Sample) -> u64 {
        let Some(sample) = range::<T>(sample) else { return 0 };
        let said = Digest::NONE.and(u64::from(self.range(&sample).is_ok()));
        if sample.anchor + 1 == A {
            let _ = self.end_epoch(sample.time_us);
        }
        self.estimate().map_or(said, |estimate| said.all(estimate.mean.as_slice())).0
    }
}

impl<T, const A: usize> Sleeper for HeightFinder<T, A>
where
    T: Scalar + Serialize + DeserializeOwned,
{
    fn take(&mut self, sample: &Sample) -> u64 {
        let Some(sample) = range::<T>(sample) else { return 0 };
        let said = Digest::NONE.and(u64::from(self.range(&sample) == Ok(true)));
        self.height().map_or(said, |height| said.all(&[height.metres, height.sigma])).0
    }
}

/// An estimator that draws random numbers, stored together with its generator.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Drawing<E> {
    /// The estimator.
    pub estimator: E,
    /// The random generator.
    #[serde(with = "kestirim_particle_filter::generator")]
    pub rng: Xoshiro128PlusPlus,
}

impl<E: Layout> Layout for Drawing<E> {
    const NAME: &'static str = E::NAME;
    const VERSION: u16 = E::VERSION;
    const IS_FINITE: bool = E::IS_FINITE;

    fn number() -> kestirim_snapshot::Number {
        E::number()
    }

    fn sizes() -> [u32; 4] {
        E::sizes()
    }
}

fn measurement<T: Scalar>(sample: &Sample) -> Option<Measurement<T>> {
    let &Sample::PathLoss(numbers) = sample else { return None };
    let [x, y, height, loss] = numbers.map(T::from_f32);
    Measurement::new([x, y], height, loss).ok()
}

impl<T, const L: usize> Sleeper for Drawing<PublishedLocator<T, L>>
where
    T: Scalar + Serialize + DeserializeOwned,
{
    fn take(&mut self, sample: &Sample) -> u64 {
        let Some(measurement) = measurement(sample) else { return 0 };
        let taken = self.estimator.measure(&measurement, &mut self.rng).is_ok();
        let moments = self.estimator.moments();
        Digest::NONE.and(u64::from(taken)).all(&moments.mean()).all(&[moments.spread()]).0
    }
}

impl<T, const L: usize> Sleeper for Drawing<Follower<T, L>>
where
    T: Scalar + Serialize + DeserializeOwned,
{
    fn take(&mut self, sample: &Sample) -> u64 {
        let Some(measurement) = measurement(sample) else { return 0 };
        let moved = self.estimator.predict(T::ONE, &mut self.rng).is_ok();
        let taken = self.estimator.measure(&measurement, &mut self.rng).is_ok();
        let estimate = self.estimator.estimate();
        let said = Digest::NONE.and(u64::from(moved && taken)).all(&estimate.place);
        said.all(&estimate.velocity).all(&[estimate.spread]).0
    }
}

impl<T, const L: usize, const M: usize> Sleeper for Locator<T, L, M>
where
    T: Scalar + Serialize + DeserializeOwned,
{
    fn take(&mut self, sample: &Sample) -> u64 {
        let Some(measurement) = measurement(sample) else { return 0 };
        let taken = self.measure(&measurement).is_ok();
        let moments = self.moments();
        Digest::NONE.and(u64::from(taken)).all(&moments.mean()).all(&[moments.spread()]).0
    }
}

fn flight(sample: &Sample) -> Option<FlightSample<3>> {
    let &Sample::Flight(time_us, input, measured) = sample else { return None };
    Some(FlightSample { time_us, input: SVector::from(input), measured: measured.map(Some) })
}

impl<T> Sleeper for Predictor<T, 4, 2, 3>
where
    T: Scalar + Serialize + DeserializeOwned,
    T::Accumulator: Serialize + DeserializeOwned,
{
    fn take(&mut self, sample: &Sample) -> u64 {
        let Sample::Flight(_, input, measured) = sample else { return 0 };
        let (input, measured) = (input.map(T::from_f64), measured.map(T::from_f64));
        let taken = self.step(&SVector::from(input), &SVector::from(measured)).is_ok();
        Digest::NONE.and(u64::from(taken)).all(self.estimate().as_slice()).0
    }
}

impl<T, const L: usize> Sleeper for FlightFilter<T, 3, L>
where
    T: Scalar + Serialize + DeserializeOwned,
{
    fn take(&mut self, sample: &Sample) -> u64 {
        let Some(sample) = flight(sample) else { return 0 };
        let said = Digest::NONE.and(u64::from(FlightFilter::take(self, &sample).is_ok()));
        said.all(self.filter().estimate().as_slice()).all(self.filter().sigma().as_slice()).0
    }
}

impl<T, const L: usize> Sleeper for FlightObserver<T, 3, L>
where
    T: Scalar + Serialize + DeserializeOwned,
    T::Accumulator: Serialize + DeserializeOwned,
{
    fn take(&mut self, sample: &Sample) -> u64 {
        let Some(sample) = flight(sample) else { return 0 };
        let said = Digest::NONE.and(u64::from(FlightObserver::take(self, &sample).is_ok()));
        said.all(self.estimate().as_slice()).0
    }
}

impl<const N: usize> Sleeper for PppFilter<N> {
    fn take(&mut self, sample: &Sample) -> u64 {
        let Sample::Epoch(time, satellites) = sample else { return 0 };
        let observe =
            |&(satellite, code, phase, state): &(u8, [f64; 2], [f64; 2], SatelliteState)| {
                let carriers = Carriers::L1L2;
                SatelliteObservation {
                    satellite,
                    carriers,
                    code,
                    phase,
                    lock_lost: false,
                    state,
                    antenna: None,
                }
            };
        let mut observations = Vec::<_, SATELLITES>::new();
        for satellite in satellites {
            let _ = observations.push(observe(satellite)); // There is room for as many.
        }
        let solution = self.process(*time, &Receiver::default(), &observations);
        solution.map_or(0, |solution| {
            let said = Digest::NONE.all(solution.position.as_slice());
            said.all(solution.covariance.as_slice()).all(&[solution.clock, solution.wet_delay]).0
        })
    }
}
