//! A foot that stands on what moves: a lift, an escalator, a vehicle.

use super::Sample;

/// A foot that turns by less stands, rad/s: even a bare chip's zero is within it.
const QUIET: f64 = 0.2;
/// It is looked at if it stands so long, s.
const LONG: f64 = 3.0;
/// The force is averaged over so long, s.
const WINDOW: f64 = 0.25;
/// A stand on the ground shows a force whose length changes by less, m/s²: a lift begins with two to four times as much …
const CHANGE: f64 = 0.3;
/// … and no lift with more, m/s²: what does has no sensor, …
const MOST: f64 = 4.0;
/// … and it lasts so many windows, if so many of the other sign come in the same stand, …
const BOTH_WAYS: usize = 2;
/// … no later than this, s, …
const RIDE: f64 = 60.0;
/// … or else so many.
const ONE_WAY: usize = 4;

/// The index of the first sample at which a standing foot is carried: for a while, the force is longer or shorter than it mostly
/// is in that stand. Its direction says nothing, as that changes with the foot's.
pub(super) fn carried(samples: &[Sample]) -> Option<usize> {
    let mut begin = 0;
    for index in 0..=samples.len() {
        let stands = samples.get(index).is_some_and(|it| norm(&it.angular_rate) < QUIET);
        if stands {
            continue;
        }
        if let Some(found) = in_stand(&samples[begin..index]) {
            return Some(begin + found);
        }
        begin = index + 1;
    }
    None
}

fn in_stand(samples: &[Sample]) -> Option<usize> {
    let (first, last) = (samples.first()?, samples.last()?);
    let seconds = |sample: &Sample| (sample.time_us - first.time_us) as f64 * 1e-6;
    if seconds(last) < LONG {
        return None;
    }
    let window = |sample: &Sample| (seconds(sample) / WINDOW) as usize;
    let windows: Vec<(usize, f64)> = samples
        .chunk_by(|a, b| window(a) == window(b))
        .map(|inside| {
            let sum: f64 = inside.iter().map(|it| norm(&it.specific_force)).sum();
            (inside.len(), sum / inside.len() as f64)
        })
        .collect();
    let mut lengths: Vec<f64> = windows.iter().map(|(_, length)| *length).collect();
    lengths.sort_by(f64::total_cmp);
    let usual = lengths[lengths.len() / 2];
    let sign = |length: f64| {
        let more = length - usual;
        if (CHANGE..MOST).contains(&more.abs()) { more.signum() } else { 0.0 }
    };
    // Where each change begins, its sign, and how many windows it lasts.
    let mut at = 0;
    let changes: Vec<(usize, f64, usize)> = windows
        .chunk_by(|(_, a), (_, b)| sign(*a) == sign(*b))
        .map(|run| {
            let begin = at;
            at += run.iter().map(|(count, _)| count).sum::<usize>();
            (begin, sign(run[0].1), run.len())
        })
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

fn norm([x, y, z]: &[f64; 3]) -> f64 {
    x.hypot(*y).hypot(*z)
}

#[cfg(test)]
mod tests {
    use super::super::{Options, walk};
    use super::*;
    use kestirim_health::{Reason, State};

    /// At 100 Hz: ten seconds on the ground, and this force and rate beyond those of standing still from 4 s on for so long.
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
        // Half a second, and as long the other way at the end.
        let mut ride = stand(0.9, 0.0, 0.5);
        assert_eq!(carried(&ride), None);
        for sample in &mut ride[700..750] {
            sample.specific_force[2] -= 0.9;
        }
        assert_eq!(carried(&ride), Some(400));
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
