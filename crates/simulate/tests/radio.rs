//! Tests ranging on simulated timestamps against the Cramér–Rao bound: clocks up to 20 ppm off, counters that wrap, and
//! lost messages.

use kestirim_scalar::{Q12_20, Scalar};
use kestirim_simulate::random::{normal, stream, uniform};
use kestirim_simulate::robot::radio::{Clock, Network, exchange, least_two_way_sigma};
use kestirim_uwb_ranging::{Broadcast, DoubleSided, Downlink};
use kestirim_uwb_tracker::{
    Anchor, Config, DifferenceSample, DifferenceTracker, RangeSample, Tracker,
};
use nalgebra::{SMatrix, SVector};

/// The largest accepted ratio to the bound.
const WITHIN: f64 = 1.10;
/// The corners of a room, at which the anchors are, m.
const CORNERS: [[f64; 3]; 8] = [
    [0.0, 0.0, 0.3],
    [8.0, 0.0, 2.7],
    [8.0, 6.0, 0.3],
    [0.0, 6.0, 2.7],
    [0.0, 0.0, 2.7],
    [8.0, 0.0, 0.3],
    [8.0, 6.0, 2.7],
    [0.0, 6.0, 0.3],
];
/// The power spectral density of the tag's acceleration, m²/s³, the time step, s, and the duration, s.
const DENSITY: f64 = 0.03;
const STEP: f64 = 1e-3;
const SECONDS: f64 = 4.0;

fn anchors<T: Scalar>() -> Vec<Anchor<T>> {
    let anchor =
        |place: [f64; 3]| Anchor { position: SVector::from(place.map(T::from_f64)), bias: T::ZERO };
    CORNERS.map(anchor).to_vec()
}

/// The path of a tag from the middle of the room, every millisecond: white acceleration, in the plane or in space.
struct Way(Vec<[f64; 3]>);

impl Way {
    fn draw(rng: &mut impl rand_core::Rng, axes: usize) -> Self {
        let (mut place, mut velocity) = ([4.0, 3.0, 1.4], [0.0; 3]);
        for speed in velocity.iter_mut().take(axes) {
            *speed = normal(rng, 0.3);
        }
        let steps = (SECONDS / STEP) as usize + 2;
        let step = |_| {
            for axis in 0..axes {
                let jolt = normal(rng, (DENSITY * STEP).sqrt());
                place[axis] += STEP * (velocity[axis] + 0.5 * jolt);
                velocity[axis] += jolt;
            }
            place
        };
        Self((0..steps).map(step).collect())
    }

    fn at(&self, seconds: f64) -> [f64; 3] {
        let index = (seconds / STEP).floor();
        let share = seconds / STEP - index;
        let [from, to] = [0, 1].map(|next| self.0[index as usize + next]);
        std::array::from_fn(|axis| from[axis] + share * (to[axis] - from[axis]))
    }
}

/// A Kalman filter linearised at the truth: the least covariance of any estimator that only knows the density of the
/// motion.
struct Bound<const N: usize> {
    covariance: SMatrix<f64, N, N>,
    seconds: f64,
}

impl<const N: usize> Bound<N> {
    /// States for D coordinates, their velocities and, if N = 2 D + 1, a clock offset that does not walk.
    fn new(axes: usize) -> Self {
        let mut covariance = SMatrix::identity() * 1e4;
        for axis in 0..axes {
            covariance[(axes + axis, axes + axis)] = 0.3 * 0.3;
        }
        Self { covariance, seconds: 0.0 }
    }

    fn range(&mut self, axes: usize, seconds: f64, tag: [f64; 3], anchor: [f64; 3], sigma: f64) {
        let dt = seconds - self.seconds;
        let mut transition = SMatrix::<f64, N, N>::identity();
        let mut noise = SMatrix::<f64, N, N>::zeros();
        for axis in 0..axes {
            transition[(axis, axes + axis)] = dt;
            noise[(axis, axis)] = DENSITY * dt.powi(3) / 3.0;
            noise[(axis, axes + axis)] = DENSITY * dt * dt / 2.0;
            noise[(axes + axis, axis)] = DENSITY * dt * dt / 2.0;
            noise[(axes + axis, axes + axis)] = DENSITY * dt;
        }
        self.covariance = transition * self.covariance * transition.transpose() + noise;
        self.seconds = seconds;
        let offset: SVector<f64, 3> = SVector::from(tag) - SVector::from(anchor);
        let mut row = SVector::<f64, N>::zeros();
        for axis in 0..axes {
            row[axis] = offset[axis] / offset.norm();
        }
        if N > 2 * axes {
            row[2 * axes] = 1.0;
        }
        let spread = self.covariance * row;
        self.covariance -= spread * spread.transpose() / (row.dot(&spread) + sigma * sigma);
    }

    fn of_position(&self, axes: usize) -> f64 {
        (0..axes).map(|axis| self.covariance[(axis, axis)]).sum()
    }
}

/// Sums of squares: of the errors, of the bound, and of the tracker's own standard deviations.
#[derive(Debug, Default)]
struct Squares {
    errors: f64,
    least: f64,
    told: f64,
}

impl Squares {
    fn add<T: Scalar, const D: usize, const N: usize>(
        &mut self,
        estimate: Option<&kestirim_kalman::Gaussian<T, N>>,
        truth: [f64; 3],
        least: f64,
    ) {
        let estimate = estimate.expect("a position");
        self.errors +=
            (0..D).map(|axis| (estimate.mean[axis].to_f64() - truth[axis]).powi(2)).sum::<f64>();
        let variances = estimate.covariance.variances();
        self.told += variances.iter().take(D).map(|variance| variance.to_f64()).sum::<f64>();
        self.least += least;
    }

    fn over_bound(&self) -> f64 {
        (self.errors / self.least).sqrt()
    }

    fn over_told(&self) -> f64 {
        (self.errors / self.told).sqrt()
    }
}

fn config<T: Scalar>(sigma: f64) -> Config<T> {
    let number = T::from_f64;
    Config {
        range_sigma: number(sigma),
        acceleration_density: number(DENSITY),
        ..Config::plain(number(1.4))
    }
}

/// Simulates exchanges of six timestamps with each of four anchors in turn, with unequal reply times.
fn two_way<T: Scalar>(index: u64, sigma: f64, squares: &mut Squares, ranges: &mut [f64; 2]) {
    const REPLIES: [f64; 2] = [1e-3, 2.5e-3];
    let mut rng = stream(1, index);
    let way = Way::draw(&mut rng, 2);
    let tag = Clock::draw(&mut rng);
    let clocks: [Clock; 4] = std::array::from_fn(|_| Clock::draw(&mut rng));
    let least = least_two_way_sigma(REPLIES, sigma);
    let mut tracker =
        Tracker::<T, 2, 4, 4>::new(config(least), &anchors()[..4]).expect("four anchors fit");
    let mut bound = Bound::<4>::new(2);
    for k in 0..(SECONDS / 0.01) as usize {
        let (seconds, anchor) = (k as f64 * 0.01, k % 4);
        let (place, corner) = (way.at(seconds), CORNERS[anchor]);
        let metres = (SVector::from(place) - SVector::from(corner)).norm();
        let clocks = [&tag, &clocks[anchor]];
        let [a, b, c, d, e, f] = exchange(&mut rng, clocks, (seconds, metres), REPLIES, sigma);
        // Each of the three messages may be lost, and with it the exchange.
        if (0..3).any(|_| uniform(&mut rng) < 0.05) {
            continue;
        }
        let range = DoubleSided::new(a, b, c, d, e, f).asymmetric::<T>().expect("a distance");
        ranges[0] += (range.to_f64() - metres).powi(2);
        ranges[1] += least * least;
        let time_us = (seconds * 1e6).round() as u64;
        tracker.range(&RangeSample { time_us, anchor, range }).expect("taken");
        bound.range(2, seconds, place, corner, least);
        if seconds > 2.0 && k % 50 == 0 {
            squares.add::<T, 2, 4>(tracker.estimate(), place, bound.of_position(2));
        }
    }
}

#[test]
fn six_stamps_are_as_good_as_they_can_be() {
    fn check<T: Scalar>(name: &str) {
        let (mut squares, mut ranges) = (Squares::default(), [0.0; 2]);
        for index in 0..200 {
            two_way::<T>(index, 0.1, &mut squares, &mut ranges);
        }
        let of_ranges = (ranges[0] / ranges[1]).sqrt();
        let (over_bound, over_told) = (squares.over_bound(), squares.over_told());
        println!(
            "{name}: ranges {of_ranges:.3}, position {over_bound:.3} of the bound, {over_told:.3} of σ"
        );
        assert!((0.97..1.03).contains(&of_ranges), "{name}");
        assert!((0.9..WITHIN).contains(&over_bound), "{name}: {over_bound}");
    }
    check::<f64>("f64");
    check::<f32>("f32");
    check::<Q12_20>("Q12.20");
}

/// Simulates a tag in space that receives eight anchors, 400 messages a second in all.
fn downlink<T: Scalar>(index: u64, config: Config<T>, squares: &mut Squares) {
    let mut rng = stream(2, index);
    let way = Way::draw(&mut rng, 3);
    let sigmas = [0.1, 0.03];
    let network = Network { anchors: CORNERS.to_vec(), interval: 0.02, sigmas, loss: 0.1 };
    let places = CORNERS.map(|place| SVector::from(place.map(T::from_f64)));
    let [tag, anchor] = sigmas.map(T::from_f64);
    let mut engine = Downlink::<T, 8>::new(places, tag, anchor).expect("an engine");
    let tracker = DifferenceTracker::<T, 3, 7, 8>::new(config, &anchors());
    let mut tracker = tracker.expect("eight anchors fit");
    let mut bound = Bound::<7>::new(3);
    let mut next = 2.0;
    for message in network.heard(&mut rng, SECONDS, |seconds| way.at(seconds)) {
        let (seconds, place) = (message.seconds, way.at(message.seconds));
        bound.range(3, seconds, place, CORNERS[message.anchor], sigmas[0]);
        let time_us = (seconds * 1e6).round() as u64;
        let difference = engine.take(&Broadcast {
            time_us,
            anchor: message.anchor,
            sequence: message.sequence,
            sent: message.sent,
            received: message.received,
            heard: &message.heard,
        });
        let Some(difference) = difference.expect("no message is wrong") else { continue };
        let (anchors, difference) = (difference.anchors, difference.difference);
        tracker.difference(&DifferenceSample { time_us, anchors, difference }).expect("taken");
        if seconds > next {
            next += 0.5;
            squares.add::<T, 3, 7>(tracker.estimate(), place, bound.of_position(3));
        }
    }
}

#[test]
fn a_tag_that_only_listens_is_as_good_as_it_can_be() {
    fn check<T: Scalar>(name: &str, config: Config<T>, within: f64) {
        let mut squares = Squares::default();
        for index in 0..100 {
            downlink(index, config, &mut squares);
        }
        let (over_bound, over_told) = (squares.over_bound(), squares.over_told());
        let rms = (squares.errors / 400.0).sqrt();
        println!(
            "{name}: {:.1} cm, {over_bound:.3} of the bound, {over_told:.3} of σ",
            100.0 * rms
        );
        assert!((0.9..within).contains(&over_bound), "{name}: {over_bound}");
        assert!((0.85..1.15).contains(&over_told), "{name}: {over_told}");
    }
    check::<f64>("f64", config(0.1), WITHIN);
    check::<f32>("f32", config(0.1), WITHIN);
    check::<Q12_20>("Q12.20", config(0.1), WITHIN);
    // A configuration for obstacles and livelier motion, neither of which occurs here.
    check::<f32>("f32, as it comes", Config::uncalibrated(0.0), 1.35);
}

#[test]
fn counters_go_round_and_differences_go_on() {
    let mut rng = stream(3, 0);
    let network =
        Network { anchors: CORNERS.to_vec(), interval: 0.02, sigmas: [0.1, 0.03], loss: 0.3 };
    let tag = [5.0, 2.0, 1.0];
    let mut engine = Downlink::<f32, 8>::new(
        CORNERS.map(|place| SVector::from(place.map(|metres| metres as f32))),
        0.1,
        0.03,
    )
    .expect("an engine");
    let (mut rounds, mut last, mut made, mut squares, mut variances) =
        (0, [0; 8], [0; 4], 0.0, 0.0);
    let heard = network.heard(&mut rng, 60.0, |_| tag);
    for message in &heard {
        let wraps = message.sent.ticks() < last[message.anchor];
        rounds += usize::from(wraps);
        last[message.anchor] = message.sent.ticks();
        let found = engine.take(&Broadcast {
            time_us: (message.seconds * 1e6) as u64,
            anchor: message.anchor,
            sequence: message.sequence,
            sent: message.sent,
            received: message.received,
            heard: &message.heard,
        });
        let Some(found) = found.expect("no message is wrong") else { continue };
        made[(message.seconds / 15.0) as usize] += 1;
        let [one, other] = found
            .anchors
            .map(|anchor| (SVector::from(tag) - SVector::from(CORNERS[anchor])).norm());
        squares += (f64::from(found.difference) - (other - one)).powi(2);
        variances += f64::from(found.variance);
    }
    assert!(rounds >= 16, "each clock at least twice");
    // Seven tenths of the messages are received, and nearly each of those was also received by the next transmitter, or
    // an earlier one.
    let least = made.iter().min().expect("four quarters");
    assert!(*least as f64 > 0.9 * heard.len() as f64 / 4.0, "{made:?} of {}", heard.len());
    let ratio: f64 = squares / variances;
    assert!((0.95..1.05).contains(&ratio), "{ratio}");
}
