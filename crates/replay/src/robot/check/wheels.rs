//! Checks that the wheels agree with the motion that the ranges show.

use kestirim_health::{Health, Reason};

use crate::Finding;
use crate::robot::{Epoch, Event, Setup, track};

/// The time between the two places whose distance is compared, µs: neither the start nor the heading must be known.
const APART_US: i64 = 5_000_000;
/// The interval at which places are compared, µs.
const EVERY_US: i64 = 1_000_000;
/// The longest time between two samples of the wheels, µs.
const LONGEST_US: i64 = 1_000_000;
/// The difference at which distances disagree, in standard deviations of the ranges'.
const SIGMAS: f64 = 3.0;
/// The difference at which distances disagree, as a share of the longer one: wheels have scale errors, and slip.
const SHARE: f64 = 0.5;
/// The share of disagreeing comparisons above which it is reported: sound wheels slip at times.
const OFTEN: f64 = 0.4;
/// The fewest comparisons that are judged.
const FEWEST: usize = 10;

/// The step of the clock offsets that are tried, µs; `SHIFTS` is the number of them to either side.
const SHIFT_US: i64 = 500_000;
const SHIFTS: i64 = 20;
/// The fewest steps that are reported: a logger may be late by fewer.
const LATE: i64 = 2;
/// The share of the disagreement that another clock may leave to explain the wheels.
const LEFT: f64 = 0.6;
/// The smallest mean disagreement for which other clocks are tried, m, and the limit to which each is clipped, m.
const DISAGREEMENT_M: [f64; 2] = [0.2, 2.0];
/// The fewest distances that are compared for the clock, between places whose standard deviations are below `SHARP_M`,
/// m.
const FEWEST_TIMED: usize = 20;
const SHARP_M: f64 = 1.0;

/// Two times between which the ranges give a distance.
struct Compared {
    /// The index among the ways of the wheels.
    way: usize,
    from_us: i64,
    to_us: i64,
    /// The distance, m, and its standard deviation.
    ranges: f64,
    sigma: f64,
}

/// A way: times, µs, and places, m.
type Way = Vec<(i64, [f64; 2])>;

/// The finding that wheels and ranges contradict each other; `None` if they do not, or do not tell. `known` is the
/// setup of a tracker without wheels.
pub(super) fn find(known: &Setup, parts: &[&[Event]]) -> Option<Finding> {
    let (mut ways, mut pairs, mut timed) = (Vec::new(), Vec::new(), Vec::new());
    for events in parts {
        let way = way(events);
        if way.is_empty() {
            continue;
        }
        let is_of_wheels = |event: &&Event| matches!(event, Event::Wheels(_));
        let others: Vec<Event> = events.iter().filter(|it| !is_of_wheels(it)).copied().collect();
        let epochs = track(known, &others).ok()?.epochs;
        pairs.extend(compared(ways.len(), &epochs, |it| it.health == Health::GOOD));
        let is_sharp = |it: &Epoch| it.sigma_m().is_some_and(|sigma| sigma < SHARP_M);
        timed.extend(compared(ways.len(), &epochs, is_sharp));
        ways.push(way);
    }
    if let Some(late_s) = late(&ways, &timed) {
        let by = if late_s > 0.0 { "late" } else { "early" };
        return Some(Finding::fault(
            "wheels",
            Reason::Time,
            format!(
                "the times of the wheels are {:.1} s too {by}, or those of the ranges are not theirs",
                late_s.abs()
            ),
            "positions are moved by what was driven at another time",
            "give both the times of one clock",
        ));
    }
    let differs = |pair: &Compared| {
        let wheels = driven(&ways[pair.way], pair.from_us, pair.to_us)?;
        let limit = (SIGMAS * pair.sigma).max(SHARE * pair.ranges.max(wheels));
        Some((pair.ranges - wheels).abs() > limit)
    };
    let differing: Vec<bool> = pairs.iter().filter_map(differs).collect();
    let apart = differing.iter().filter(|differs| **differs).count();
    let share = apart as f64 / differing.len().max(1) as f64;
    (differing.len() >= FEWEST && share > OFTEN).then(|| {
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

/// Pairs of usable epochs that are `APART_US` apart.
fn compared(way: usize, epochs: &[Epoch], serves: impl Fn(&Epoch) -> bool) -> Vec<Compared> {
    let mut pairs = Vec::new();
    let mut next_us = i64::MIN;
    for epoch in epochs.iter().filter(|it| serves(it)) {
        if epoch.time_us < next_us {
            continue;
        }
        next_us = epoch.time_us.saturating_add(EVERY_US);
        let then_us = epoch.time_us.saturating_add(APART_US);
        let after = epochs.partition_point(|it| it.time_us < then_us);
        let is_then = |it: &&Epoch| serves(it) && it.time_us.saturating_sub(then_us) <= EVERY_US;
        let Some(then) = epochs.get(after).filter(is_then) else { continue };
        let Some((ranges, sigma)) = distance(epoch, then) else { continue };
        pairs.push(Compared { way, from_us: epoch.time_us, to_us: then.time_us, ranges, sigma });
    }
    pairs
}

/// The delay of the wheels, s, if another clock explains them far better.
fn late(ways: &[Way], pairs: &[Compared]) -> Option<f64> {
    let [least, most] = DISAGREEMENT_M;
    let off = |pair: &Compared, shift: i64| {
        let [from, to] = [pair.from_us, pair.to_us].map(|it| it.saturating_add(shift * SHIFT_US));
        let wheels = driven(&ways[pair.way], from, to)?;
        Some((pair.ranges - wheels).abs().min(most))
    };
    // Each clock is compared with that of the log only where both can be evaluated: at its ends, a log may be at its
    // worst.
    let left = |shift: i64| {
        let both = |pair| Some([off(pair, 0)?, off(pair, shift)?]);
        let all: Vec<[f64; 2]> = pairs.iter().filter_map(both).collect();
        let mean = |which: usize| all.iter().map(|it| it[which]).sum::<f64>() / all.len() as f64;
        let is_enough = all.len() >= FEWEST_TIMED && 2 * all.len() > pairs.len();
        (is_enough && mean(0) > least).then(|| mean(1) / mean(0))
    };
    let shifts = (-SHIFTS..=SHIFTS).filter_map(|shift| Some((shift, left(shift)?)));
    let (shift, share) = shifts.min_by(|a, b| a.1.total_cmp(&b.1))?;
    (shift.abs() >= LATE && share < LEFT).then_some((shift * SHIFT_US) as f64 * 1e-6)
}

/// The distance between the positions from ranges at two epochs, m, and its standard deviation.
fn distance(a: &Epoch, b: &Epoch) -> Option<(f64, f64)> {
    let ([x, y, _], [u, v, _]) = (a.position?, b.position?);
    Some(((u - x).hypot(v - y), a.sigma_m()?.hypot(b.sigma_m()?)))
}

/// The way according to the wheels: times, µs, and places, m, relative to an arbitrary start.
fn way(events: &[Event]) -> Way {
    let mut way = Vec::new();
    let (mut place, mut heading) = ([0.0; 2], 0.0_f64);
    let mut before_us = None;
    for event in events {
        let Event::Wheels(wheels) = event else { continue };
        if !(wheels.speed.is_finite() && wheels.turn_rate.is_finite()) {
            continue;
        }
        if let Some(before_us) = before_us {
            let seconds = wheels.time_us.saturating_sub(before_us) as f64 * 1e-6;
            // A sample tells the motion since the one before.
            let middle = heading + 0.5 * wheels.turn_rate * seconds;
            place[0] += wheels.speed * seconds * middle.cos();
            place[1] += wheels.speed * seconds * middle.sin();
            heading += wheels.turn_rate * seconds;
        }
        before_us = Some(wheels.time_us);
        way.push((wheels.time_us, place));
    }
    way
}

/// The distance between the positions from the wheels at two times, m; `None` if there is a gap in between.
fn driven(way: &[(i64, [f64; 2])], from_us: i64, to_us: i64) -> Option<f64> {
    let at = |time_us: i64| way.partition_point(|(at_us, _)| *at_us < time_us);
    let [first, last] = [at(from_us).checked_sub(1)?, at(to_us)];
    let between = way.get(first..=last)?;
    let is_whole = between.windows(2).all(|pair| pair[1].0.saturating_sub(pair[0].0) <= LONGEST_US);
    let ([x, y], [u, v]) = (between.first()?.1, between.last()?.1);
    is_whole.then(|| (u - x).hypot(v - y))
}
