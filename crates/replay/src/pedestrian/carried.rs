//! Detection of a foot that stands on something that moves: a lift, an escalator, a vehicle.

use nalgebra::{UnitQuaternion, Vector3};

use super::Sample;
use crate::metrics::median;

/// The angular rate below which a foot stands, rad/s: even a bare chip's zero is within it.
const QUIET: f64 = 0.2;
/// The shortest stand that is examined, s.
const LONG: f64 = 3.0;
/// The time over which the force is averaged, s.
const WINDOW: f64 = 0.25;
/// The smallest change in the length of the force that may be a lift, m/s²: a stand on the ground shows less, and a
/// lift begins with two to four times as much.
const CHANGE: f64 = 0.3;
/// The largest change of the force with which a lift begins, m/s²: more comes from a sensor that does not measure.
const MOST: f64 = 4.0;
/// The fewest windows that a change must last if as many of the other sign come in the same stand.
const BOTH_WAYS: usize = 2;
/// The longest time between the changes of both signs, s.
const RIDE: f64 = 60.0;
/// The fewest windows that a change must last if none of the other sign comes.
const ONE_WAY: usize = 4;

/// The smallest sideways force on the foot in a vehicle that begins to move, m/s², relative to the median over
/// `AROUND`.
const ACROSS: f64 = 0.4;
/// The time before and after, over which the median is taken, s.
const AROUND: f64 = 3.0;
/// The interval between samples after which it is unknown how the foot turned, s.
const GAP: f64 = 0.06;

/// The index of the first sample at which a standing foot is carried: for a while, the force is larger or smaller than
/// it mostly is in that stand, or it leans although the gyroscope saw no turn.
pub(super) fn carried(samples: &[Sample]) -> Option<usize> {
    let stands = |it: &Sample| norm(&it.angular_rate) < QUIET;
    // The zero is that of all stands, as in one of them the foot may turn slowly.
    let usual = |axis: usize| {
        let rates = samples.iter().filter(|it| stands(it)).map(|it| it.angular_rate[axis]);
        median(&rates.collect::<Vec<_>>())
    };
    let zero = Vector3::from([0, 1, 2].map(usual));
    let mut begin = 0;
    let seconds = |a: &Sample, b: &Sample| (b.time_us - a.time_us) as f64 * 1e-6;
    for stand in samples.chunk_by(|a, b| stands(a) == stands(b) && seconds(a, b) < GAP) {
        if stands(&stand[0])
            && let Some(found) = in_stand(stand, &zero)
        {
            return Some(begin + found);
        }
        begin += stand.len();
    }
    None
}

/// The mean force over a window.
struct Window {
    /// The index of the first sample.
    at: usize,
    /// The mean length of the force, m/s².
    length: f64,
    /// The mean force in the axes that the foot had when the stand began, m/s².
    force: Vector3<f64>,
}

fn in_stand(samples: &[Sample], zero: &Vector3<f64>) -> Option<usize> {
    let (first, last) = (samples.first()?, samples.last()?);
    if (last.time_us - first.time_us) as f64 * 1e-6 < LONG {
        return None;
    }
    let windows = windows(samples, zero);
    [up_or_down(samples, &windows), across(&windows)].into_iter().flatten().min()
}

/// Splits a stand into windows, using the gyroscope's `zero`, rad/s.
fn windows(samples: &[Sample], zero: &Vector3<f64>) -> Vec<Window> {
    let begin_us = samples[0].time_us;
    let mut turned = UnitQuaternion::identity();
    let mut before_us = begin_us;
    let mut at = 0;
    let window = |sample: &Sample| ((sample.time_us - begin_us) as f64 * 1e-6 / WINDOW) as usize;
    let mean = |inside: &[Sample]| {
        let (mut length, mut force) = (0.0, Vector3::zeros());
        for sample in inside {
            let seconds = (sample.time_us - before_us) as f64 * 1e-6;
            before_us = sample.time_us;
            let rate = Vector3::from(sample.angular_rate) - zero;
            turned *= UnitQuaternion::from_scaled_axis(rate * seconds);
            length += norm(&sample.specific_force);
            force += turned * Vector3::from(sample.specific_force);
        }
        let (count, begin) = (inside.len() as f64, at);
        at += inside.len();
        Window { at: begin, length: length / count, force: force / count }
    };
    samples.chunk_by(|a, b| window(a) == window(b)).map(mean).collect()
}

/// The first sample where the force is larger or smaller than it mostly is.
fn up_or_down(samples: &[Sample], windows: &[Window]) -> Option<usize> {
    let usual = median(&windows.iter().map(|it| it.length).collect::<Vec<_>>());
    let sign = |length: f64| {
        let more = length - usual;
        if (CHANGE..MOST).contains(&more.abs()) { more.signum() } else { 0.0 }
    };
    // The first sample of each change, its sign, and the number of windows that it lasts.
    let changes: Vec<(usize, f64, usize)> = windows
        .chunk_by(|a, b| sign(a.length) == sign(b.length))
        .map(|run| (run[0].at, sign(run[0].length), run.len()))
        .collect();
    let lasts = |wanted: f64, most: usize| {
        move |(_, sign, windows): &&(usize, f64, usize)| *sign == wanted && *windows >= most
    };
    let first = |sign, most| changes.iter().find(lasts(sign, most)).map(|(at, ..)| *at);
    let both = first(1.0, BOTH_WAYS).zip(first(-1.0, BOTH_WAYS));
    let both = both.map(|(up, down)| (up.min(down), up.max(down))).filter(|&(begin, end)| {
        samples[end].time_us - samples[begin].time_us < (RIDE * 1e6) as u64
    });
    let both = both.map(|(begin, _)| begin);
    both.or_else(|| first(1.0, ONE_WAY)).or_else(|| first(-1.0, ONE_WAY))
}

/// The first sample where the force leans for a while as it does not before and after, with the attitude from the
/// gyroscope.
fn across(windows: &[Window]) -> Option<usize> {
    let around = (AROUND / WINDOW) as usize;
    let leans = |at: usize| {
        let usual = [0, 1, 2].map(|axis| {
            let values = windows[at - around..=at + around].iter().map(|it| it.force[axis]);
            median(&values.collect::<Vec<_>>())
        });
        let usual = Vector3::from(usual);
        let off = windows[at].force - usual;
        let up = usual.normalize();
        let across = (off - up * off.dot(&up)).norm();
        (ACROSS..MOST).contains(&across)
    };
    let leaning: Vec<bool> = (around..windows.len().saturating_sub(around)).map(leans).collect();
    let run = leaning.windows(BOTH_WAYS).position(|run| run.iter().all(|it| *it))?;
    Some(windows[around + run].at)
}

fn norm([x, y, z]: &[f64; 3]) -> f64 {
    x.hypot(*y).hypot(*z)
}

#[cfg(test)]
mod tests {
    use super::super::{Options, walk};
    use super::*;
    use kestirim_health::{Reason, State};

    /// Ten seconds on the ground at 100 Hz, with this additional force and rate from 4 s on for `lasts` seconds.
    fn stand(force: f64, rate: f64, lasts: f64) -> Vec<Sample> {
        let sample = |index: u32| {
            let t = f64::from(index) / 100.0;
            let on = f64::from(u8::from((4.0..4.0 + lasts).contains(&t)));
            Sample {
                time_us: u64::from(index) * 10_000,
                specific_force: [0.3, -0.2, 9.81 + on * force],
                angular_rate: [0.02, on * rate, 0.0],
            }
        };
        (0..1000).map(sample).collect()
    }

    #[test]
    fn a_lift_that_begins_to_move_is_found() {
        for force in [0.9, -0.6] {
            assert_eq!(carried(&stand(force, 0.0, 1.5)), Some(400), "{force}");
        }
        assert_eq!(carried(&stand(0.25, 0.0, 1.5)), None, "less than any lift");
        assert_eq!(carried(&stand(0.9, 0.0, 0.4)), None, "a knock");
        assert_eq!(carried(&stand(3.0, 2.0, 1.0)), None, "a step");
        assert_eq!(carried(&stand(0.9, 0.0, 1.5)[200..490]), None, "a short stand");
        assert_eq!(carried(&[]), None);
        let mut stalled = stand(0.0, 0.0, 0.0);
        stalled[300..500].iter_mut().for_each(|it| it.specific_force = [0.0; 3]);
        assert_eq!(carried(&stalled), None, "a sensor that says nothing");
        // Half a second, and as much the other way at the end.
        let mut ride = stand(0.9, 0.0, 0.5);
        assert_eq!(carried(&ride), None);
        for sample in &mut ride[700..750] {
            sample.specific_force[2] -= 0.9;
        }
        assert_eq!(carried(&ride), Some(400));
    }

    #[test]
    fn a_vehicle_that_begins_to_move_is_found_and_a_foot_that_leans_is_none() {
        let mut ride = stand(0.0, 0.0, 0.0);
        for sample in &mut ride[400..500] {
            sample.specific_force[0] += 0.8;
        }
        assert_eq!(carried(&ride), Some(400));
        // A turn about y of half a second brings as much of gravity along x.
        let mut leaning = stand(0.0, 0.0, 0.0);
        for (index, sample) in leaning.iter_mut().enumerate() {
            let angle = 0.0815 * ((index as f64 - 400.0) / 50.0).clamp(0.0, 1.0);
            if (400..450).contains(&index) {
                sample.angular_rate[1] -= 0.163;
            }
            let turned = UnitQuaternion::from_axis_angle(&Vector3::y_axis(), -angle);
            sample.specific_force =
                (turned.inverse() * Vector3::from(sample.specific_force)).into();
        }
        assert!(leaning[999].specific_force[0] > 1.0);
        assert_eq!(carried(&leaning), None);
    }

    #[test]
    fn a_walk_is_doubted_from_there_on() {
        let walk = walk(&stand(0.9, 0.0, 1.5), &Options::default()).expect("a walk");
        assert!(walk.warnings[0].contains("4 s after the start the foot is carried"), "{walk:?}");
        assert!(walk.doubts.has(Reason::Innovations));
        let bad: Vec<bool> = walk.healths().map(|it| it == State::Bad).collect();
        assert_eq!(bad.iter().position(|it| *it), Some(400));
        assert!(bad[400..].iter().all(|it| *it));
    }
}
