//! The input streams of the estimators, and their initial states.

use kestirim_air_to_ground::{Channel, Environment};
use kestirim_luenberger::Predictor;
use kestirim_observer_design::Complex;
use kestirim_particle_filter::{Region, Xoshiro128PlusPlus};
use kestirim_pedestrian::{Config as WalkConfig, Ekf, Lite, Tracker as Walk};
use kestirim_ppp_filter::{Config as PppConfig, Motion as Moving, PppFilter, states};
use kestirim_scalar::{Q12_20, Q16_16, Scalar};
use kestirim_tests::{ppp, uav};
use kestirim_uav_estimator::{Dynamics, FlightFilter, FlightObserver, Noise};
use kestirim_uav_longitudinal::StateSpace;
use kestirim_user_locator::{
    Locator, Motion, PublishedLocator, PublishedSettings, Tracker as Follower,
};
use kestirim_uwb_tracker::{
    Anchor, Config, HeightFinder, PublishedConfig, PublishedTracker, Tracker as Robot, WheelTracker,
};
use nalgebra::SVector;
use rand_core::SeedableRng;
use target_bench::streams::{PLACES, circle, ellipse, fly, walk};

use super::Visit;
use super::systems::{Drawing, SATELLITES, Sample, Sleeper};

/// The time between two samples of a flight, s.
const FLIGHT_INTERVAL: f64 = 0.01;
/// The number of epochs of positioning.
const EPOCHS: usize = 40;

/// Identifies an estimator.
pub(super) struct Kind {
    /// The number by which the image knows it, if it does.
    pub(super) image: Option<u8>,
    /// The seed of the places at which it is stored.
    pub(super) seed: u64,
}

fn inertial() -> Vec<Sample> {
    let mut time_us = 0;
    let sample = |sample: &target_bench::streams::Sample| {
        time_us += u64::from(sample.elapsed_us);
        Sample::Inertial(time_us, sample.specific_force, sample.angular_rate)
    };
    walk().iter().map(sample).collect()
}

/// Ranges to four anchors, with wheel speeds between them if there are any.
fn ranges(has_wheels: bool) -> Vec<Sample> {
    let mut time_us = 0;
    let mut samples = Vec::new();
    for (elapsed_us, anchor, range) in ellipse(4) {
        time_us += u64::from(elapsed_us);
        if has_wheels && elapsed_us > 0 {
            samples.push(Sample::Wheels(time_us - 50_000, 0.75, 0.3));
        }
        samples.push(Sample::Range(time_us, anchor as u32, range));
    }
    samples
}

fn path_losses() -> Vec<Sample> {
    let circle = circle();
    circle.iter().cycle().take(5 * circle.len()).map(|numbers| Sample::PathLoss(*numbers)).collect()
}

fn flight() -> Vec<Sample> {
    let sample = |(index, numbers): (usize, &[f32; 5])| {
        let [elevator, throttle, rate, airspeed, pitch] = numbers.map(f64::from);
        Sample::Flight(10_000 * index as i64, [elevator, throttle], [rate, airspeed, pitch])
    };
    fly(&uav::plant(FLIGHT_INTERVAL)).iter().enumerate().map(sample).collect()
}

fn epochs() -> Vec<Sample> {
    let mut epochs = ppp::Epochs::at(ppp::station());
    let sample = |index| {
        let epoch = epochs.epoch(index).expect("satellites");
        let satellites =
            epoch.observations.iter().map(|it| (it.satellite, it.code, it.phase, it.state));
        Sample::Epoch(epoch.time, satellites.collect())
    };
    (0..EPOCHS).map(sample).collect()
}

fn anchors<T: Scalar>() -> [Anchor<T>; 4] {
    let anchor =
        |place: [f64; 3]| Anchor { position: SVector::from(place.map(T::from_f64)), bias: T::ZERO };
    [PLACES[0], PLACES[1], PLACES[2], PLACES[3]].map(anchor)
}

fn robot<T: Scalar>() -> Robot<T, 2, 4, 4> {
    Robot::new(Config::calibrated(T::ONE), &anchors()).expect("they fit")
}

fn on_wheels<T: Scalar>() -> WheelTracker<T, 4> {
    WheelTracker::new(Config::calibrated(T::ONE), &anchors()).expect("they fit")
}

fn published_robot<T: Scalar>() -> PublishedTracker<T, 2, 4, 4> {
    PublishedTracker::new(PublishedConfig::adaptive(T::ONE), &anchors()).expect("they fit")
}

fn channel<T: Scalar>() -> Channel<T> {
    Channel::new(&Environment::urban(), T::from_f64(0.15)).expect("a channel")
}

fn city<T: Scalar>() -> Region<T, 2> {
    Region::new([T::ZERO; 2], [T::from_f64(2000.0); 2]).expect("a city")
}

fn published_drone<T: Scalar>() -> Drawing<PublishedLocator<T, 500>> {
    let mut rng = Xoshiro128PlusPlus::seed_from_u64(1);
    let estimator =
        PublishedLocator::new(channel(), &city(), PublishedSettings::thesis(), &mut rng);
    Drawing { estimator, rng }
}

fn follower<T: Scalar>() -> Drawing<Follower<T, 500>> {
    let mut rng = Xoshiro128PlusPlus::seed_from_u64(2);
    let estimator = Follower::new(channel(), Motion::people(), &city(), &mut rng);
    Drawing { estimator, rng }
}

fn locator<T: Scalar>() -> Locator<T, 500, 32> {
    Locator::new(channel(), &city())
}

fn predictor<T: Scalar>() -> Predictor<T, 4, 2, 3> {
    let start = SVector::from(uav::START.map(T::from_f32));
    Predictor::new(&uav::gains(FLIGHT_INTERVAL), &start).expect("gains")
}

fn dynamics() -> Dynamics {
    Dynamics::Continuous(StateSpace { a: uav::A, b: uav::B })
}

fn flight_filter<T: Scalar>() -> FlightFilter<T, 3> {
    let noise =
        Noise { inputs: SVector::from([0.01, 0.02]), outputs: SVector::from([0.01, 0.5, 0.01]) };
    FlightFilter::new(&dynamics(), &uav::C, &noise, FLIGHT_INTERVAL).expect("a filter")
}

fn flight_observer<T: Scalar>() -> FlightObserver<T, 3> {
    let poles = uav::POLES.map(|pole| Complex { re: (pole * FLIGHT_INTERVAL).exp(), im: 0.0 });
    FlightObserver::new(&dynamics(), &uav::C, &poles, FLIGHT_INTERVAL).expect("an observer")
}

fn positioning() -> PppFilter<{ states(SATELLITES) }> {
    PppFilter::new(PppConfig::new(Moving::Static))
}

/// Visits all estimators with their streams: those that the image knows by number, and those that only the host has.
pub(super) fn visit_all(visitor: &mut impl Visit) {
    fn each<E: Sleeper>(
        visitor: &mut impl Visit,
        image: impl Into<Option<u8>>,
        of: E,
        samples: &[Sample],
    ) {
        let image = image.into();
        let seed = u64::from(image.unwrap_or(0xff)) + 1;
        visitor.visit(&Kind { image, seed }, of, samples);
    }
    let samples = &inertial();
    each(visitor, 0, Walk::<f32, Ekf<f32>>::new(WalkConfig::default()), samples);
    each(visitor, 1, Walk::<f32, Lite<f32>>::new(WalkConfig::default()), samples);
    each(visitor, 2, Walk::<Q12_20, Ekf<Q12_20>>::new(WalkConfig::default()), samples);
    each(visitor, None, Walk::<f64, Ekf<f64>>::new(WalkConfig::default()), samples);
    let samples = &ranges(false);
    each(visitor, 3, robot::<f32>(), samples);
    each(visitor, 4, robot::<Q12_20>(), samples);
    each(visitor, None, robot::<f64>(), samples);
    each(visitor, None, published_robot::<f32>(), samples);
    each(visitor, None, published_robot::<f64>(), samples);
    each(visitor, None, HeightFinder::<f32, 4>::calibrated(&anchors()).expect("they fit"), samples);
    let samples = &ranges(true);
    each(visitor, None, robot::<f32>(), samples);
    each(visitor, 5, on_wheels::<f32>(), samples);
    each(visitor, None, on_wheels::<Q12_20>(), samples);
    each(visitor, None, on_wheels::<f64>(), samples);
    let samples = &path_losses();
    each(visitor, 6, published_drone::<f32>(), samples);
    each(visitor, 7, published_drone::<Q16_16>(), samples);
    each(visitor, None, published_drone::<f64>(), samples);
    each(visitor, 8, follower::<f32>(), samples);
    each(visitor, None, follower::<f64>(), samples);
    each(visitor, 9, locator::<f32>(), samples);
    each(visitor, None, locator::<Q16_16>(), samples);
    each(visitor, None, locator::<f64>(), samples);
    let samples = &flight();
    each(visitor, 10, predictor::<f32>(), samples);
    each(visitor, 11, predictor::<Q16_16>(), samples);
    each(visitor, None, predictor::<f64>(), samples);
    each(visitor, 12, flight_filter::<f32>(), samples);
    each(visitor, None, flight_filter::<f64>(), samples);
    each(visitor, 13, flight_observer::<f32>(), samples);
    each(visitor, None, flight_observer::<Q16_16>(), samples);
    each(visitor, None, flight_observer::<f64>(), samples);
    each(visitor, 14, positioning(), &epochs());
}
