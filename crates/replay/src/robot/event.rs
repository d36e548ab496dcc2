//! Events: the data of a tag's sensors, in the order in which trackers process them.

use std::iter::from_fn;

use super::{Course, Error};

/// An input of a tracker. Times are those of the log's clock, µs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Event {
    /// A range was measured.
    Range(Range),
    /// A difference of the distances to two anchors was measured.
    Difference(Difference),
    /// The IMU was read.
    Inertial(Inertial),
    /// The wheels were read.
    Wheels(Wheels),
    /// The height of the tag was given.
    Height {
        /// The time.
        time_us: i64,
        /// The height, m.
        metres: f64,
    },
    /// All ranges of a time have been given.
    EpochEnd {
        /// The time of these ranges.
        time_us: i64,
    },
}

/// A sample of the IMU.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Inertial {
    /// Time of the log's clock, µs.
    pub time_us: i64,
    /// Acceleration as logged, body axes, m/s².
    pub acceleration: [f64; 3],
    /// Acceleration without gravity, room axes, m/s², if the attitude is known.
    pub push: Option<[f64; 3]>,
}

/// A sample of the wheels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wheels {
    /// Time of the log's clock, µs.
    pub time_us: i64,
    /// Mean speed of the wheels, m/s.
    pub speed: f64,
    /// Difference of the wheels' speeds divided by the track width, rad/s.
    pub turn_rate: f64,
}

/// A range to an anchor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    /// The time of the measurement, µs.
    pub time_us: i64,
    /// The index of the anchor in the list.
    pub anchor: usize,
    /// The range as measured, m, which may be `NaN`.
    pub metres: f64,
}

/// How much farther the second of two anchors is than the first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Difference {
    /// The time of the measurement, µs.
    pub time_us: i64,
    /// The indices of the anchors in the list.
    pub anchors: [usize; 2],
    /// The difference, m.
    pub metres: f64,
}

impl Event {
    /// The time of the event, µs.
    pub const fn time_us(&self) -> i64 {
        match self {
            Self::Range(Range { time_us, .. })
            | Self::Difference(Difference { time_us, .. })
            | Self::Inertial(Inertial { time_us, .. })
            | Self::Wheels(Wheels { time_us, .. })
            | Self::Height { time_us, .. }
            | Self::EpochEnd { time_us } => *time_us,
        }
    }
}

/// One line of a log: a range, or the absence of one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RangeRow {
    /// Time of the log's clock, µs.
    pub time_us: i64,
    /// The index of the anchor in the list.
    pub anchor: usize,
    /// The range as logged, m, which may be `NaN`; `None` if there was none.
    pub range: Option<f64>,
}

/// The samples of each sensor, in the order of its log.
#[derive(Debug, Clone, Default)]
pub struct Sensors {
    /// The ranges.
    pub ranges: Vec<RangeRow>,
    /// The differences of distances, for a tag without ranges.
    pub differences: Vec<Difference>,
    /// The samples of the IMU.
    pub inertial: Vec<Inertial>,
    /// The samples of the wheels.
    pub wheels: Vec<Wheels>,
    /// The height of the tag over time, m.
    pub height: Option<Course<1>>,
}

impl Sensors {
    /// Sensors with ranges alone.
    pub fn ranges(ranges: Vec<RangeRow>) -> Self {
        Self { ranges, ..Self::default() }
    }

    /// Drops samples whose time is more than 10 s ahead of what follows them, or behind what precedes them, whichever are
    /// fewer, and returns a warning if there were any: a single wrong time would make everything else late.
    ///
    /// # Errors
    /// [`Error::Times`] if they are more than a tenth of a sensor's.
    pub fn drop_wrong_times(&mut self) -> Result<Option<String>, Error> {
        let dropped = drop_wrong("ranges", &mut self.ranges, |row| row.time_us)?
            + drop_wrong("differences", &mut self.differences, |difference| difference.time_us)?
            + drop_wrong("samples of the IMU", &mut self.inertial, |sample| sample.time_us)?
            + drop_wrong("samples of the wheels", &mut self.wheels, |sample| sample.time_us)?;
        Ok((dropped > 0).then(|| {
            format!("{dropped} samples are more than 10 s off the times around them: left out")
        }))
    }

    /// All events in the order of their times. The samples of one sensor are never reordered: the tracker rejects times
    /// that go backwards, and ranges that come late end no epoch.
    pub fn events(&self) -> Vec<Event> {
        let mut events = Vec::with_capacity(2 * self.ranges.len() + self.inertial.len());
        let mut motion = self.motion().into_iter().peekable();
        let mut latest_us = i64::MIN;
        let rows = self.radio();
        for epoch in rows.chunk_by(|a, b| a.0 == b.0) {
            let time_us = epoch[0].0;
            events.extend(from_fn(|| motion.next_if(|event| event.time_us() <= time_us)));
            let height = self.height.as_ref().and_then(|course| course.held(time_us));
            events.extend(height.map(|[metres]| Event::Height { time_us, metres }));
            events.extend(epoch.iter().filter_map(|(_, event)| *event));
            if time_us > latest_us {
                latest_us = time_us;
                events.push(Event::EpochEnd { time_us });
            }
        }
        events.extend(motion);
        events
    }

    /// Ranges and differences with their times, or `None` for a line without a range.
    fn radio(&self) -> Vec<(i64, Option<Event>)> {
        let range = |row: &RangeRow| {
            let (time_us, anchor) = (row.time_us, row.anchor);
            let of = |metres| Event::Range(Range { time_us, anchor, metres });
            (time_us, row.range.map(of))
        };
        let difference = |it: &Difference| (it.time_us, Some(Event::Difference(*it)));
        self.ranges.iter().map(range).chain(self.differences.iter().map(difference)).collect()
    }

    /// The samples of IMU and wheels.
    fn motion(&self) -> Vec<Event> {
        let inertial = self.inertial.iter().copied().map(Event::Inertial);
        merged(inertial, self.wheels.iter().copied().map(Event::Wheels))
    }
}

/// The largest step back in time of later samples, µs; where they go back further, a time is wrong.
const LARGEST_STEP_BACK_US: i64 = 10_000_000;

/// The largest share of samples, one in so many, whose times are mistakes.
const MOST_WRONG: usize = 10;

/// Drops the fewest samples whose times are wrong; returns their number.
fn drop_wrong<S>(
    what: &'static str,
    samples: &mut Vec<S>,
    time_us: impl Fn(&S) -> i64,
) -> Result<usize, Error> {
    let times: Vec<_> = samples.iter().map(time_us).collect();
    let mut latest_us = i64::MIN;
    let is_behind: Vec<_> = (times.iter())
        .map(|time_us| {
            latest_us = latest_us.max(*time_us);
            time_us.saturating_add(LARGEST_STEP_BACK_US) < latest_us
        })
        .collect();
    let mut earliest_us = i64::MAX;
    let mut is_ahead: Vec<_> = (times.iter().rev())
        .map(|time_us| {
            let is_ahead = time_us.saturating_sub(LARGEST_STEP_BACK_US) > earliest_us;
            earliest_us = earliest_us.min(*time_us);
            is_ahead
        })
        .collect();
    is_ahead.reverse();
    let count = |wrong: &[bool]| wrong.iter().filter(|it| **it).count();
    let wrong = if count(&is_behind) < count(&is_ahead) { is_behind } else { is_ahead };
    let (dropped, count) = (count(&wrong), samples.len());
    if dropped * MOST_WRONG > count {
        return Err(Error::Times { what, dropped, count });
    }
    let mut each = wrong.iter();
    samples.retain(|_| each.next() == Some(&false));
    Ok(dropped)
}

/// Merges two sequences in the order of their times; at equal times, the first comes before the second.
fn merged(
    first: impl IntoIterator<Item = Event>,
    second: impl Iterator<Item = Event>,
) -> Vec<Event> {
    let mut first = first.into_iter().peekable();
    let mut events = Vec::with_capacity(first.size_hint().0 + second.size_hint().0);
    for event in second {
        let time_us = event.time_us();
        events.extend(from_fn(|| first.next_if(|before| before.time_us() <= time_us)));
        events.push(event);
    }
    events.extend(first);
    events
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn events_come_in_the_order_of_their_times() {
        let range = |time_us, range| RangeRow { time_us, anchor: 0, range };
        let wheels = |time_us| Wheels { time_us, speed: 0.0, turn_rate: 0.0 };
        let inertial = |time_us| Inertial { time_us, acceleration: [0.0; 3], push: None };
        let sensors = Sensors {
            ranges: vec![
                range(10, Some(1.0)),
                range(10, None),
                range(20, None),
                range(5, Some(1.0)),
            ],
            inertial: vec![inertial(1), inertial(12), inertial(30)],
            wheels: vec![wheels(2), wheels(11)],
            height: Some(Course::new(vec![(0, [1.0])])),
            ..Sensors::default()
        };
        let times: Vec<_> = sensors.events().iter().map(Event::time_us).collect();
        assert_eq!(times, [1, 2, 10, 10, 10, 11, 12, 20, 20, 5, 5, 30]);
        let ends = |event: &&Event| matches!(event, Event::EpochEnd { .. });
        assert_eq!(sensors.events().iter().filter(ends).count(), 2);
    }

    #[test]
    fn one_wrong_time_is_left_out_and_a_clock_that_begins_anew_is_refused() {
        let dropped = |wrong: usize, time_us: i64| {
            let mut times: Vec<i64> = (0..100).map(|k| 1_000_000 * k).collect();
            times[50..50 + wrong].fill(time_us);
            let range = |time_us| RangeRow { time_us, anchor: 0, range: Some(1.0) };
            let mut sensors = Sensors::ranges(times.into_iter().map(range).collect());
            let told = sensors.drop_wrong_times();
            (told.map(|told| told.is_some()), sensors.ranges.len())
        };
        assert_eq!(dropped(1, 1_000_000_000_000), (Ok(true), 99));
        assert_eq!(dropped(10, 0), (Ok(true), 90));
        let times = Error::Times { what: "ranges", dropped: 11, count: 100 };
        assert_eq!(dropped(11, 0), (Err(times), 100));
        assert_eq!(dropped(0, 0), (Ok(false), 100));
    }
}
