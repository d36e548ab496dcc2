//! The strides of a walk in readable form, and its turns and stops.

use kestirim_replay::pedestrian::{Stride, Trace, Walk, position_at};

use super::figures::seconds;
use crate::system::{Sheet, Table};

/// The minimum angle of a turn (°). A right angle is a turn, even if it takes several strides and the foot cuts the
/// corner; the sway of straight walking is far less.
const LEAST_TURN_DEG: f64 = 45.0;
/// The minimum change of heading per stride within a turn (°): on a straight path strides differ by some degrees to
/// either side.
const LEAST_CHANGE_DEG: f64 = 10.0;
/// The maximum number of strides of a turn: a slower one is a bend.
const LONGEST_TURN: usize = 4;
/// The minimum duration of a stop (s): a stance takes 0.4 to 0.7 s in walking, 1 s in slow walking.
const LEAST_STOP_S: f64 = 1.5;

/// A stride, from the end of one stance to the end of the next.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Line {
    /// The stride as the tracker reports it.
    pub stride: Stride,
    /// The position of the foot before the stride (m).
    pub from: [f64; 3],
}

impl Line {
    /// The change of height over the stride, positive upwards (m).
    pub fn height_change_m(&self) -> f64 {
        self.stride.position[2] - self.from[2]
    }

    /// The horizontal speed, including the stance (m/s); `None` for a stride of zero duration.
    pub fn speed_m_s(&self) -> Option<f64> {
        let Stride { length_m, duration_s, .. } = self.stride;
        (duration_s > 0.0).then(|| length_m / duration_s)
    }

    /// The direction of the stride (rad), anticlockwise from the room's x axis.
    pub fn heading_rad(&self) -> f64 {
        let ([x, y, _], [from_x, from_y, _]) = (self.stride.position, self.from);
        (y - from_y).atan2(x - from_x)
    }
}

/// The strides of a walk, each with its start.
pub fn lines(walk: &Walk) -> Vec<Line> {
    let mut from = walk.strides.first().and_then(|first| {
        let lasted_us = (first.duration_s * 1e6).round() as u64;
        position_at(&walk.track, first.time_us.saturating_sub(lasted_us))
    });
    let line = |stride: &Stride| {
        let begun = from.replace(stride.position).unwrap_or(stride.position);
        Line { stride: *stride, from: begun }
    };
    walk.strides.iter().map(line).collect()
}

/// A turn of the path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Turn {
    /// The time at which the foot left the place of the turn (s).
    pub time_s: f64,
    /// The position of the sharpest change (m).
    pub position: [f64; 3],
    /// The angle of the turn (rad), anticlockwise.
    pub angle_rad: f64,
}

/// The turns of a walk, at which the heading of the strides changes by more than 45° to one side within four of them.
pub fn turns(walk: &Walk) -> Vec<Turn> {
    let (mut found, mut run) = (Vec::new(), Vec::new());
    for pair in walk.strides.windows(2) {
        let [before, after] = pair else { continue };
        let change = after.heading_change_rad;
        let goes_on = run.last().is_none_or(|(_, last): &(Stride, f64)| last * change > 0.0);
        let turns = change.abs() >= LEAST_CHANGE_DEG.to_radians();
        if !turns || !goes_on || run.len() == LONGEST_TURN {
            found.extend(turn(&run));
            run.clear();
        }
        if turns {
            run.push((*before, change));
        }
    }
    found.extend(turn(&run));
    found
}

/// The turn that consecutive strides to the same side make, if it is large enough; each stride comes with the change
/// after it.
fn turn(run: &[(Stride, f64)]) -> Option<Turn> {
    let angle_rad: f64 = run.iter().map(|(_, change)| change).sum();
    let (at, _) = run.iter().max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))?;
    let turn = Turn { time_s: seconds(at.time_us), position: at.position, angle_rad };
    (angle_rad.abs() > LEAST_TURN_DEG.to_radians()).then_some(turn)
}

/// A stop: a stance far longer than those of walking.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stop {
    /// The start of the stop (s).
    pub time_s: f64,
    /// The duration of the stop (s).
    pub duration_s: f64,
    /// The position of the foot (m).
    pub position: [f64; 3],
}

/// The stops of a walk: stances longer than 1.5 s between the first and the last stride.
pub fn stops(trace: &Trace) -> Vec<Stop> {
    let strides = &trace.walk.strides;
    let (Some(first), Some(last)) = (strides.first(), strides.last()) else { return Vec::new() };
    let begin_s = seconds(first.time_us) - first.duration_s;
    let stances = stances(trace).into_iter().filter_map(|[from, to]| {
        let [from, to] = [trace.walk.track.get(from)?, trace.walk.track.get(to)?];
        let [time_s, end_s] = [from, to].map(|point| seconds(point.time_us));
        let is_between = time_s > begin_s && to.time_us < last.time_us;
        let stop = Stop { time_s, duration_s: end_s - time_s, position: to.position };
        (is_between && stop.duration_s > LEAST_STOP_S).then_some(stop)
    });
    stances.collect()
}

/// The first and the last sample of each stance.
pub fn stances(trace: &Trace) -> Vec<[usize; 2]> {
    let mut found: Vec<[usize; 2]> = Vec::new();
    for (place, _) in trace.moments.iter().enumerate().filter(|(_, moment)| moment.stance) {
        match found.last_mut() {
            Some([_, last]) if *last + 1 == place => *last = place,
            _ => found.push([place, place]),
        }
    }
    found
}

/// The table of strides for the page.
pub fn sheet(walk: &Walk) -> Sheet {
    let lines = lines(walk);
    let header = [
        "stride",
        "time, s",
        "length, m",
        "height change, m",
        "duration, s",
        "speed, m/s",
        "heading, °",
    ];
    let rows = cells(&lines, [2, 3, 3, 2, 2, 1]);
    Sheet::new("strides", "Strides", &header)
        .caption(
            "Each from the end of one stance to the end of the next, which is its time: the speed before a stop is low; lengths are horizontal, headings \
             anticlockwise from the way the foot pointed at the start.",
        )
        .with(rows)
        .timed(lines.iter().map(|line| seconds(line.stride.time_us)))
}

/// The table of strides for a file.
pub fn table(walk: &Walk) -> Table {
    let header = ["stride", "t", "length", "height_change", "duration", "speed", "heading_deg"];
    Table { rows: cells(&lines(walk), [6, 4, 4, 4, 4, 2]), ..Table::new(&header) }
}

/// The number, time, length, change of height, duration, speed and heading of strides, with the given numbers of
/// decimals.
fn cells(lines: &[Line], decimals: [usize; 6]) -> Vec<Vec<String>> {
    let row = |(place, line): (usize, &Line)| {
        let Stride { time_us, length_m, duration_s, .. } = line.stride;
        let (height, heading) = (line.height_change_m(), line.heading_rad().to_degrees());
        let speed = line.speed_m_s().unwrap_or(f64::NAN);
        let values = [seconds(time_us), length_m, height, duration_s, speed, heading];
        let values = values.into_iter().zip(decimals);
        let values = values.map(|(value, decimals)| format!("{value:.decimals$}"));
        std::iter::once((place + 1).to_string()).chain(values).collect()
    };
    lines.iter().enumerate().map(row).collect()
}
