//! The synthetic walk: the paper's route of 12.60 m through a flat, in five legs.
//!
//! The paper gives the sum but not the legs, and shows the walker near (6 m, 3 m) towards the end. The legs here go
//! east 3.78 m, north 1.26 m, east 2.52 m, north 1.26 m and back west 3.78 m, with a right angle between any two. The
//! foot falls on every corner, half turned; all footfalls lie on the route, so the distance from stance to stance adds
//! up to exactly the length of the route. Longer walks close the route to a loop of 17.64 m and repeat it.

use std::f64::consts::{PI, TAU};

use kestirim_replay::pedestrian::{Footprint, Sample};
use nalgebra::UnitQuaternion;
use rand_core::Rng;

use super::gait::{Pose, Stride};
use super::kinematics::ideal_imu;
use crate::random::{normal, normal3};

/// A leg of the route: its length, m, its heading, rad anticlockwise from east, and its number of strides.
#[derive(Debug, Clone, Copy)]
struct Leg {
    length: f64,
    heading: f64,
    strides: usize,
}

const LEGS: [Leg; 5] = [
    Leg { length: 3.78, heading: 0.0, strides: 3 },
    Leg { length: 1.26, heading: PI / 2.0, strides: 1 },
    Leg { length: 2.52, heading: 0.0, strides: 2 },
    Leg { length: 1.26, heading: PI / 2.0, strides: 1 },
    Leg { length: 3.78, heading: PI, strides: 3 },
];

/// The legs from the end of [`LEGS`] straight on and back to its start.
const WAY_BACK: [Leg; 2] = [
    Leg { length: 2.52, heading: PI, strides: 2 },
    Leg { length: 2.52, heading: 1.5 * PI, strides: 2 },
];

/// The share of a stride during which the foot stands.
const STANCE_SHARE: f64 = 0.4;
/// The usual time from stance to stance, s, and its standard deviations among walks and among strides.
const STRIDE_S: f64 = 1.15;
const WALK_SPREAD: f64 = 0.04;
const STRIDE_SPREAD: f64 = 0.02;
/// The standard deviation of stride lengths within a leg.
const LENGTH_SPREAD: f64 = 0.04;
/// The mounting of the sensor on the instep: forward tilt, rad, and the standard deviation of all angles from walk to
/// walk.
const MOUNT_TILT: f64 = 25.0 * PI / 180.0;
const MOUNT_SPREAD: f64 = 5.0 * PI / 180.0;
/// The walker's sway: amplitude of roll and pitch, rad, and frequencies, Hz.
const SWAY: f64 = 0.15 * PI / 180.0;
const SWAY_HZ: [f64; 2] = [0.31, 0.47];

/// One walk along the route.
#[derive(Debug, Clone)]
pub struct Scenario {
    strides: Vec<Stride>,
    mount: UnitQuaternion<f64>,
    sway_phases: [f64; 3],
    duration_s: f64,
}

impl Scenario {
    /// Draws a walk; speed, stride lengths, mounting and sway vary a little from walk to walk.
    pub fn draw<R: Rng + ?Sized>(rng: &mut R) -> Self {
        Self::along(rng, LEGS)
    }

    /// Draws a walk of several rounds through the flat, each of which ends where it began.
    pub fn draw_rounds<R: Rng + ?Sized>(rng: &mut R, rounds: u32) -> Self {
        let round = |turns| {
            let legs = LEGS.into_iter().chain(WAY_BACK);
            legs.map(move |leg| Leg { heading: leg.heading + TAU * f64::from(turns), ..leg })
        };
        Self::along(rng, (0..rounds).flat_map(round))
    }

    fn along<R: Rng + ?Sized>(rng: &mut R, legs: impl IntoIterator<Item = Leg>) -> Self {
        let mut uniform =
            |low: f64, high: f64| low + (high - low) * (rng.next_u64() as f64 / u64::MAX as f64);
        let (still_before_s, still_after_s) = (uniform(2.0, 3.0), uniform(1.0, 2.0));
        let sway_phases = std::array::from_fn(|_| uniform(0.0, TAU));
        let stride_s = STRIDE_S * (1.0 + normal(rng, WALK_SPREAD));
        let legs: Vec<_> = legs.into_iter().collect();
        let strides = strides(rng, &legs, still_before_s, stride_s);
        let end_of_walk =
            strides.last().map_or(still_before_s, |last| last.start_s + last.moving_s);
        let [roll, pitch, yaw] = normal3(rng, MOUNT_SPREAD);
        Self {
            strides,
            mount: UnitQuaternion::from_euler_angles(roll, MOUNT_TILT + pitch, yaw),
            sway_phases,
            duration_s: end_of_walk + still_after_s,
        }
    }

    /// The pose of the body frame, which is the sensor's, at time `t`, s.
    pub fn pose(&self, t: f64) -> Pose {
        let begun = self.strides.partition_point(|stride| stride.start_s <= t).max(1);
        let Pose { position, attitude } = self.strides[begun - 1].pose(t);
        let [roll, pitch] =
            [0, 1].map(|i| SWAY * (TAU * SWAY_HZ[i] * t + self.sway_phases[i]).sin());
        let sway = UnitQuaternion::from_euler_angles(roll, pitch, 0.0);
        Pose { position, attitude: attitude * sway * self.mount }
    }

    /// The duration, including the standing before and after, s.
    pub fn duration_s(&self) -> f64 {
        self.duration_s
    }

    /// The lengths of the route's legs, m.
    pub fn leg_lengths() -> impl Iterator<Item = f64> {
        LEGS.iter().map(|leg| leg.length)
    }

    /// The samples of a perfect IMU on this walk.
    pub fn ideal_imu(&self, rate_hz: f64) -> Vec<Sample> {
        ideal_imu(|t| self.pose(t), self.duration_s, rate_hz)
    }

    /// The footprints: at the start, in the middle of every stance, and at the end.
    pub fn footprints(&self) -> Vec<Footprint> {
        let start = self.strides.first().map(|first| (first.start_s / 2.0, first.footfalls[0]));
        let next = self.strides.iter().skip(1).map(|stride| stride.start_s);
        let leaves = next.chain([self.duration_s]);
        let stances = self.strides.iter().zip(leaves).map(|(stride, leaves_s)| {
            ((stride.start_s + stride.moving_s + leaves_s) / 2.0, stride.footfalls[1])
        });
        let footprint = |(t, position): (f64, _)| Footprint { time_us: (t * 1e6) as u64, position };
        start.into_iter().chain(stances).map(footprint).collect()
    }
}

/// The strides of all legs.
fn strides<R: Rng + ?Sized>(
    rng: &mut R,
    legs: &[Leg],
    mut start_s: f64,
    stride_s: f64,
) -> Vec<Stride> {
    let mut strides: Vec<Stride> = Vec::new();
    let mut corner = [0.0, 0.0];
    for (leg, next) in legs.iter().zip(legs.iter().skip(1).map(Some).chain([None])) {
        let (sin, cos) = leg.heading.sin_cos();
        let on_leg = |way: f64| [corner[0] + cos * way, corner[1] + sin * way];
        let weights: Vec<_> = (0..leg.strides).map(|_| 1.0 + normal(rng, LENGTH_SPREAD)).collect();
        let scale = leg.length / weights.iter().sum::<f64>();
        let mut way = 0.0;
        for (i, weight) in weights.iter().enumerate() {
            let footfalls = [on_leg(way), on_leg(way + weight * scale)];
            way += weight * scale;
            let yaw_from = strides.last().map_or(leg.heading, |last| last.yaws[1]);
            let yaw_to = match next {
                // Half of the turn is made before the corner, half after it.
                Some(next) if i + 1 == leg.strides => f64::midpoint(leg.heading, next.heading),
                _ => leg.heading,
            };
            let period_s = stride_s * (1.0 + normal(rng, STRIDE_SPREAD));
            let moving_s = period_s * (1.0 - STANCE_SHARE);
            let vigour = 1.0 + normal(rng, STRIDE_SPREAD);
            strides.push(Stride { start_s, moving_s, footfalls, yaws: [yaw_from, yaw_to], vigour });
            start_s += period_s;
        }
        corner = on_leg(leg.length);
    }
    strides
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::*;
    use crate::random::stream;
    use kestirim_replay::metrics::{STANDARD_GRAVITY, polyline_length};

    /// The length of the paper's route, m.
    const ROUTE_M: f64 = 12.60;

    fn scenario() -> Scenario {
        Scenario::draw(&mut stream(7, 0))
    }

    #[test]
    fn the_route_is_as_long_as_the_papers() {
        let footfalls: Vec<_> = scenario().footprints().iter().map(|f| f.position).collect();
        assert_eq!(footfalls.len(), 11);
        assert!((polyline_length(&footfalls) - ROUTE_M).abs() < 1e-9);
        let mut steps = footfalls.windows(2).map(polyline_length);
        assert!(steps.all(|step| (1.05..1.45).contains(&step)));
    }

    #[test]
    fn rounds_end_where_they_begin_and_never_turn_back() {
        let scenario = Scenario::draw_rounds(&mut stream(7, 0), 3);
        let footfalls: Vec<_> = scenario.footprints().iter().map(|f| f.position).collect();
        assert!((polyline_length(&footfalls) - 3.0 * (ROUTE_M + 5.04)).abs() < 1e-9);
        assert!(kestirim_replay::metrics::closure(&footfalls) < 1e-9);
        let turns = scenario.strides.iter().map(|stride| stride.yaws[1] - stride.yaws[0]);
        assert!(turns.map(f64::abs).all(|turn| turn < 1.6));
    }

    #[test]
    fn the_foot_is_at_rest_in_stance() {
        let scenario = scenario();
        let samples = scenario.ideal_imu(100.0);
        for footprint in scenario.footprints() {
            let around = samples.iter().filter(|s| s.time_us.abs_diff(footprint.time_us) < 150_000);
            for sample in around {
                let force = Vector3::from(sample.specific_force).norm();
                let rate = Vector3::from(sample.angular_rate).norm();
                assert!((force - STANDARD_GRAVITY).abs() < 1e-4, "|f| = {force}");
                assert!(rate < 1.0_f64.to_radians(), "|w| = {rate}");
            }
        }
    }

    #[test]
    fn the_ideal_imu_integrates_back_to_the_route() {
        let scenario = scenario();
        let rate_hz = 4000.0;
        let step_s = 1.0 / rate_hz;
        let Pose { mut position, mut attitude } = scenario.pose(0.0);
        let mut velocity = Vector3::zeros();
        for sample in scenario.ideal_imu(rate_hz) {
            let turn = Vector3::from(sample.angular_rate) * step_s;
            let middle = attitude * UnitQuaternion::from_scaled_axis(turn / 2.0);
            attitude *= UnitQuaternion::from_scaled_axis(turn);
            let force = middle * Vector3::from(sample.specific_force);
            let gained = (force - Vector3::z() * STANDARD_GRAVITY) * step_s;
            position += (velocity + gained / 2.0) * step_s;
            velocity += gained;
        }
        let end = scenario.pose(scenario.duration_s);
        assert!((position - end.position).norm() < 1e-3, "{}", (position - end.position).norm());
        assert!(velocity.norm() < 1e-3);
        assert!((end.position - Vector3::new(2.52, 2.52, 0.0)).norm() < 1e-9);
    }

    #[test]
    fn forces_and_rates_are_those_of_a_walking_foot() {
        let samples = scenario().ideal_imu(100.0);
        let largest = |vector: fn(&Sample) -> [f64; 3]| {
            samples.iter().map(|s| Vector3::from(vector(s)).norm()).fold(0.0, f64::max)
        };
        let force = largest(|sample| sample.specific_force);
        let rate = largest(|sample| sample.angular_rate).to_degrees();
        assert!((30.0..150.0).contains(&force), "{force} m/s²");
        assert!((300.0..900.0).contains(&rate), "{rate} °/s");
    }
}
