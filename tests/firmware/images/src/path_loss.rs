//! The drone's filters as workloads for the replay: a user somewhere in a city of 2 km × 2 km.

use kestirim_air_to_ground::{Channel, Environment, Measurement};
use kestirim_particle_filter::{Moments, Region, Xoshiro128PlusPlus};
use kestirim_scalar::Scalar;
use kestirim_user_locator::{PublishedLocator, PublishedSettings};
use rand_core::SeedableRng;
use support::{Class, fail};

use crate::four_ranges::Named;
use crate::replay::Tracker;
use crate::stream::PathLoss;

/// Whether this is ARMv6-M, which has no atomic operations: a Cortex-M0 with 16 KiB of RAM.
const SMALL: bool = cfg!(all(target_arch = "arm", not(target_has_atomic = "32")));
/// The number of particles.
const PARTICLES: usize = if SMALL { 100 } else { 500 };

/// The wavelength, µm: 2 GHz.
const WAVELENGTH: i32 = 150_000;
/// The side of the city, µm.
const SIDE: i32 = 2_000_000_000;

fn channel<T: Scalar>() -> Channel<T> {
    match Channel::new(&Environment::urban(), T::from_micro(WAVELENGTH)) {
        Ok(channel) => channel,
        Err(_) => fail("a channel that makes sense"),
    }
}

fn city<T: Scalar>() -> Region<T, 2> {
    match Region::new([T::ZERO; 2], [T::from_micro(SIDE); 2]) {
        Ok(region) => region,
        Err(_) => fail("a region that makes sense"),
    }
}

fn measurement<T: Scalar>(record: &PathLoss) -> Measurement<T> {
    let place = record.place.map(T::from_f32);
    match Measurement::new(place, T::from_f32(record.height), T::from_f32(record.loss)) {
        Ok(measurement) => measurement,
        Err(_) => fail("no measurement"),
    }
}

/// The thesis' particle filter.
pub struct Published<T: Scalar> {
    locator: PublishedLocator<T, PARTICLES>,
    rng: Xoshiro128PlusPlus,
    moments: Option<Moments<T, 2>>,
}

impl<T: Scalar> Default for Published<T> {
    fn default() -> Self {
        let mut rng = Xoshiro128PlusPlus::seed_from_u64(1);
        let locator =
            PublishedLocator::new(channel(), &city(), PublishedSettings::thesis(), &mut rng);
        Self { locator, rng, moments: None }
    }
}

impl<T: Named> Tracker for Published<T> {
    const NAME: &str = if SMALL { "locator-100" } else { "locator-500" };
    const SCALAR: &str = T::NAME;
    const SAMPLES_A_POSITION: u32 = 1;
    type Record = PathLoss;
    type Input = Measurement<T>;

    fn input(record: &PathLoss) -> Measurement<T> {
        measurement(record)
    }

    #[inline(always)]
    fn step(&mut self, measurement: &Measurement<T>) -> Class {
        if self.locator.measure(measurement, &mut self.rng).is_err() {
            return Class::Rejected;
        }
        self.moments = Some(self.locator.moments());
        Class::Update
    }

    /// The mean, and the spread of the cloud about it.
    fn position(&self) -> [f32; 3] {
        let Some(moments) = self.moments else { fail("a position before the first step") };
        let [x, y] = moments.mean();
        [x, y, moments.spread()].map(T::to_f32)
    }
}
