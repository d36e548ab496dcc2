//! Whether the wheels tell the way that the ranges show.

use kestirim_health::{Health, Reason};

use crate::Finding;
use crate::robot::{Epoch, Event, Setup, Wheels, track};

/// What is compared is how far apart two places are that the robot was at so long after each other, µs: neither the start nor the
/// heading must be known.
const APART_US: i64 = 5_000_000;
/// Places are compared so often, µs.
const EVERY_US: i64 = 1_000_000;
/// Between two samples of the wheels no more time must pass, µs.
const LONGEST_US: i64 = 1_000_000;
/// The distances disagree if they differ by so many standard deviations of the ranges', …
const SIGMAS: f64 = 3.0;
/// … and by this share of the longer one: wheels have another scale, and slip.
const SHARE: f64 = 0.5;
/// From this share of the comparisons on it is told, because sound wheels slip at times, …
const OFTEN: f64 = 0.4;
/// … of which there are so many.
const FEWEST: usize = 10;

/// The finding that wheels and ranges contradict each other; none if they do not, or do not tell. `known` is what a tracker knows
/// that has no wheels.
pub(super) fn find(known: &Setup, parts: &[&[Event]]) -> Option<Finding> {
    let (mut compared, mut apart) = (0, 0);
    for events in parts {
        let way = way(events);
        if way.is_empty() {
            continue;
        }
        let is_of_wheels = |event: &&Event| matches!(event, Event::Wheels(_));
        let others: Vec<Event> = events.iter().filter(|it| !is_of_wheels(it)).copied().collect();
        let epochs = track(known, &others).ok()?.epochs;
        let mut next_us = i64::MIN;
        for epoch in epochs.iter().filter(|epoch| epoch.health == Health::GOOD) {
            if epoch.time_us < next_us {
                continue;
            }
            next_us = epoch.time_us.saturating_add(EVERY_US);
            let then_us = epoch.time_us.saturating_add(APART_US);
            let after = epochs.partition_point(|it| it.time_us < then_us);
            let is_then = |it: &&Epoch| {
                it.health == Health::GOOD && it.time_us.saturating_sub(then_us) <= EVERY_US
            };
            let Some(then) = epochs.get(after).filter(is_then) else { continue };
            let Some((ranges, sigma)) = distance(epoch, then) else { continue };
            let Some(wheels) = driven(&way, epoch.time_us, then.time_us) else { continue };
            let limit = (SIGMAS * sigma).max(SHARE * ranges.max(wheels));
            compared += 1;
            apart += usize::from((ranges - wheels).abs() > limit);
        }
    }
    let share = apart as f64 / compared.max(1) as f64;
    (compared >= FEWEST && share > OFTEN).then(|| {
        Finding::fault(
            "wheels",
            Reason::Innovations,
            format!(
                "wheels and ranges contradict each other in {:.0} % of the comparisons",
                100.0 * share
            ),
            "positions between the ranges, and their deviations, are the wheels'",
            "look at the wheels and at their clock, or leave --odom out",
        )
    })
}

/// How far apart the ranges put a tag at two epochs, m, and the standard deviation.
fn distance(a: &Epoch, b: &Epoch) -> Option<(f64, f64)> {
    let ([x, y, _], [u, v, _]) = (a.position?, b.position?);
    Some(((u - x).hypot(v - y), a.sigma_m()?.hypot(b.sigma_m()?)))
}

/// The way that the wheels tell: times, µs, and places, m, from where it begins, which is anywhere.
fn way(events: &[Event]) -> Vec<(i64, [f64; 2])> {
    let mut way = Vec::new();
    let (mut place, mut heading) = ([0.0; 2], 0.0_f64);
    let mut before: Option<Wheels> = None;
    for event in events {
        let Event::Wheels(wheels) = event else { continue };
        if !(wheels.speed.is_finite() && wheels.turn_rate.is_finite()) {
            continue;
        }
        if let Some(before) = before {
            let seconds = wheels.time_us.saturating_sub(before.time_us) as f64 * 1e-6;
            let middle = heading + 0.5 * before.turn_rate * seconds;
            place[0] += before.speed * seconds * middle.cos();
            place[1] += before.speed * seconds * middle.sin();
            heading += before.turn_rate * seconds;
        }
        before = Some(*wheels);
        way.push((wheels.time_us, place));
    }
    way
}

/// How far apart the wheels put two moments, m; none if they say nothing for a while in between.
fn driven(way: &[(i64, [f64; 2])], from_us: i64, to_us: i64) -> Option<f64> {
    let at = |time_us: i64| way.partition_point(|(at_us, _)| *at_us < time_us);
    let [first, last] = [at(from_us).checked_sub(1)?, at(to_us)];
    let between = way.get(first..=last)?;
    let is_whole = between.windows(2).all(|pair| pair[1].0.saturating_sub(pair[0].0) <= LONGEST_US);
    let ([x, y], [u, v]) = (between.first()?.1, between.last()?.1);
    is_whole.then(|| (u - x).hypot(v - y))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::robot::Range;

    const PLACES: [[f64; 3]; 4] =
        [[0.0, 0.0, 2.0], [8.0, 0.0, 2.0], [8.0, 6.0, 2.0], [0.0, 6.0, 2.0]];

    /// What is told of a robot that drives an oval at 0.5 m/s, with wheels that say something else.
    fn told(say: impl Fn(f64, Wheels) -> Wheels) -> Option<Finding> {
        let mut events = Vec::new();
        let (mut place, mut heading) = ([2.0, 1.5], 0.0_f64);
        for step in 0..1200_u32 {
            let seconds = 0.05 * f64::from(step);
            let time_us = 50_000 * i64::from(step);
            let turn_rate = if seconds % 12.0 < 6.0 { 0.0 } else { std::f64::consts::PI / 6.0 };
            let wheels = Wheels { time_us, speed: 0.5, turn_rate };
            events.push(Event::Wheels(say(seconds, wheels)));
            for (anchor, [x, y, z]) in PLACES.iter().enumerate() {
                let flat = (x - place[0]).hypot(y - place[1]);
                let noise = 0.03 * (1.7 * f64::from(step) + 2.9 * anchor as f64).sin();
                let metres = flat.hypot(z - 0.3) + noise;
                events.push(Event::Range(Range { time_us, anchor, metres }));
            }
            events.push(Event::EpochEnd { time_us });
            heading += 0.05 * turn_rate;
            place[0] += 0.025 * heading.cos();
            place[1] += 0.025 * heading.sin();
        }
        find(&Setup::new(&PLACES, 0.3), &[&events])
    }

    #[test]
    fn wheels_that_are_dead_are_told_and_scales_are_not() {
        for scale in [0.8, 1.0, 1.2] {
            let scaled = |_, it: Wheels| Wheels { speed: scale * it.speed, ..it };
            assert_eq!(told(scaled), None, "{scale}");
        }
        let slipping = |seconds: f64, it: Wheels| {
            let speed = if seconds % 20.0 < 1.0 { 2.0 * it.speed } else { it.speed };
            Wheels { speed, ..it }
        };
        assert_eq!(told(slipping), None);
        let dead = |_, it: Wheels| Wheels { speed: 0.0, turn_rate: 0.0, ..it };
        let turning = |seconds: f64, it: Wheels| {
            if seconds < 20.0 { it } else { Wheels { speed: 0.5 * it.speed, turn_rate: 2.0, ..it } }
        };
        for fault in [told(dead), told(turning)] {
            assert_eq!(fault.unwrap().reason, Some(Reason::Innovations));
        }
    }
}
