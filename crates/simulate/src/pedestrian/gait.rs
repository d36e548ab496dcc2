//! One stride of a foot as a smooth curve: the position and attitude of the sensor on it.
//!
//! The foot rolls over its ball, which stays in place, swings, lands on its heel and rolls flat over it. Every curve
//! has continuous second derivatives, so forces are continuous too.
//!
//! Foot frame: x forward, y left, z up. The position of a pose is that of the sensor on the instep, with zero height
//! when the foot stands flat.

use std::f64::consts::TAU;

use nalgebra::{UnitQuaternion, Vector3};

/// Position and attitude of the foot in the room.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// The position of the sensor, m.
    pub position: Vector3<f64>,
    /// The rotation from the foot (or body) frame to the room.
    pub attitude: UnitQuaternion<f64>,
}

/// One stride, from leaving one stance to reaching the next.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stride {
    /// The time at which the heel begins to rise, s.
    pub start_s: f64,
    /// The time from then until the foot is flat again, s.
    pub moving_s: f64,
    /// The positions of the foot before and after the stride, m.
    pub footfalls: [[f64; 2]; 2],
    /// The yaw of the foot before and after the stride, rad, anticlockwise from x.
    pub yaws: [f64; 2],
    /// The scale of the lift and pitch of the foot; 1 is usual.
    pub vigour: f64,
}

// Moments of a stride, as shares of the time during which the foot moves.
/// The moment at which the foot is pitched down most and the ball leaves the ground.
const TOE_OFF: f64 = 0.38;
/// The moment at which the ball begins to move, still loaded.
const BALL_LEAVES: f64 = 0.24;
/// The moment at which the rolling begins to pass from the ball to the heel; the foot is nearly level when it has half
/// passed, so neither end dips below the ground.
const ROLL_PASSES: f64 = 0.4;
/// The moment at which the heel strikes, toes up.
const HEEL_STRIKE: f64 = 0.88;

/// The pitch when the ball leaves the ground, rad; negative is toes down.
const TOE_OFF_PITCH: f64 = -60.0 * TAU / 360.0;
/// The pitch when the heel strikes, rad.
const HEEL_STRIKE_PITCH: f64 = 25.0 * TAU / 360.0;
/// The position of the sensor relative to the ball and to the heel, m.
const FROM_BALL: Vector3<f64> = Vector3::new(-0.10, 0.0, 0.07);
const FROM_HEEL: Vector3<f64> = Vector3::new(0.12, 0.0, 0.07);
/// The lift of the foot in addition to its rolling, m.
const LIFT: f64 = 0.04;
/// The lateral excursion of the foot round the other leg, m.
const SIDEWAYS: f64 = 0.02;
/// The vibration of the sole after heel strike: amplitude, m, and frequency, Hz.
const RING: Vector3<f64> = Vector3::new(0.3e-3, 0.0, 0.6e-3);
const RING_HZ: f64 = 25.0;

impl Stride {
    /// The pose at time `t`, s; the foot stands before and after the stride.
    pub fn pose(&self, t: f64) -> Pose {
        let share = ((t - self.start_s) / self.moving_s).clamp(0.0, 1.0);
        let swing = between(share, BALL_LEAVES, HEEL_STRIKE);
        let yaw = self.yaws[0] + smooth(swing) * (self.yaws[1] - self.yaws[0]);
        let heading = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), yaw);
        // A positive rotation about y, which points left, lowers the toes, hence the sign.
        let pitch = UnitQuaternion::from_axis_angle(&Vector3::y_axis(), -self.pitch(share));
        let rolling = |from_pivot: Vector3<f64>| pitch * from_pivot - from_pivot;
        let on_heel = smooth(between(share, ROLL_PASSES, HEEL_STRIKE));
        let rolled = rolling(FROM_BALL) * (1.0 - on_heel) + rolling(FROM_HEEL) * on_heel;
        Pose {
            position: self.swung(swing) + heading * (rolled + self.ring(share)),
            attitude: heading * pitch,
        }
    }

    fn pitch(&self, share: f64) -> f64 {
        let [down, up] = [TOE_OFF_PITCH, HEEL_STRIKE_PITCH].map(|pitch| pitch * self.vigour);
        down * smooth(between(share, 0.0, TOE_OFF))
            + (up - down) * smooth(between(share, TOE_OFF, HEEL_STRIKE))
            - up * smooth(between(share, HEEL_STRIKE, 1.0))
    }

    /// The displacement from footfall to footfall, without the rolling of the foot.
    fn swung(&self, swing: f64) -> Vector3<f64> {
        let [from, to] = self.footfalls.map(|[x, y]| Vector3::new(x, y, 0.0));
        let way = to - from;
        let aside = Vector3::new(way.y, -way.x, 0.0).try_normalize(0.0).unwrap_or_default();
        let lifted = Vector3::z() * LIFT * self.vigour + aside * SIDEWAYS;
        from + way * smooth(swing) + lifted * bump(swing)
    }

    fn ring(&self, share: f64) -> Vector3<f64> {
        let since_strike_s = (share - HEEL_STRIKE) * self.moving_s;
        let fading = bump(between(share, HEEL_STRIKE, 1.0));
        RING * (fading * (TAU * RING_HZ * since_strike_s).sin())
    }
}

/// The progress of `share` from `start` to `end`, 0 to 1.
fn between(share: f64, start: f64, end: f64) -> f64 {
    ((share - start) / (end - start)).clamp(0.0, 1.0)
}

/// The minimum-jerk transition from 0 to 1: velocity and acceleration vanish at both ends.
fn smooth(x: f64) -> f64 {
    x * x * x * (10.0 + x * (6.0 * x - 15.0))
}

/// A smooth bump from 0 to 1 and back.
fn bump(x: f64) -> f64 {
    let arch = 4.0 * x * (1.0 - x);
    arch * arch * arch
}

#[cfg(test)]
mod tests {
    use super::*;

    const STRIDE: Stride = Stride {
        start_s: 2.0,
        moving_s: 0.7,
        footfalls: [[0.0, 0.0], [1.26, 0.0]],
        yaws: [0.0, 0.5],
        vigour: 1.0,
    };

    #[test]
    fn the_foot_stands_before_and_after() {
        for (t, x, yaw) in [(0.0, 0.0, 0.0), (2.0, 0.0, 0.0), (2.7, 1.26, 0.5), (9.0, 1.26, 0.5)] {
            let pose = STRIDE.pose(t);
            assert!((pose.position - Vector3::new(x, 0.0, 0.0)).norm() < 1e-12);
            let (roll, pitch, found) = pose.attitude.euler_angles();
            assert!(roll.abs() < 1e-12 && pitch.abs() < 1e-12 && (found - yaw).abs() < 1e-12);
        }
    }

    #[test]
    fn the_foot_pitches_as_feet_do_and_stays_above_the_ground() {
        let pitches =
            (0..=700).map(|ms| -STRIDE.pose(2.0 + f64::from(ms) / 1e3).attitude.euler_angles().1);
        let (lowest, highest) =
            pitches.fold((0.0, 0.0), |(low, high), p| (p.min(low), p.max(high)));
        assert!(
            (lowest - TOE_OFF_PITCH).abs() < 1e-3 && (highest - HEEL_STRIKE_PITCH).abs() < 1e-3
        );
        for ms in 0..=700 {
            let pose = STRIDE.pose(2.0 + f64::from(ms) / 1e3);
            for sole in [FROM_BALL, FROM_HEEL] {
                let height = (pose.position - pose.attitude * sole).z + FROM_BALL.z;
                assert!(height > -0.002, "{ms} ms: {height} m");
            }
        }
    }

    #[test]
    fn the_curve_has_no_kinks() {
        let h = 1e-4;
        let velocity =
            |t: f64| (STRIDE.pose(t + h).position - STRIDE.pose(t - h).position) / (2.0 * h);
        for ms in 1950..2750 {
            let t = f64::from(ms) / 1e3;
            let acceleration = (velocity(t + 1e-3) - velocity(t)).norm() / 1e-3;
            assert!(acceleration < 120.0, "{t} s: {acceleration} m/s²");
        }
    }
}
