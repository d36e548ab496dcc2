//! Logs of one recording whose clocks differ: one begins before midnight, or before its counter begins anew, and another after it; or
//! a table's times are not those of the ranges.

use kestirim_replay::robot::{Course, Sensors};

/// A day, µs.
const DAY_US: i64 = 86_400_000_000;

/// After how long a counter of 32 bits begins anew, µs: of microseconds, and of milliseconds.
const COUNTERS_US: [i64; 2] = [1 << 32, 1000 << 32];
/// How near to a counter's end the one log begins, and how soon after it the other, µs.
const NEAR_US: i64 = 60_000_000;

/// By how much times that begin at `first_us` are before those that begin at `reference_us`: a counter's whole range if one begins
/// shortly before its end and the other shortly after; else in whole days.
fn behind_us(reference_us: i64, first_us: i64) -> i64 {
    let [early, late] = [reference_us.min(first_us), reference_us.max(first_us)];
    let ends = |end: &i64| (0..NEAR_US).contains(&early) && (end - NEAR_US..*end).contains(&late);
    let ended = COUNTERS_US.into_iter().find(ends);
    ended.map_or_else(
        || days_us(reference_us, first_us),
        |end| end * (reference_us - first_us).signum(),
    )
}

/// The same in whole days; zero for times of more than two days, which have a date.
fn days_us(reference_us: i64, first_us: i64) -> i64 {
    let is_of_day = |time_us: i64| (0..2 * DAY_US).contains(&time_us);
    if !(is_of_day(reference_us) && is_of_day(first_us)) {
        return 0;
    }
    let days = (reference_us - first_us) as f64 / DAY_US as f64;
    days.round() as i64 * DAY_US
}

/// Puts the IMU, the wheels and the courses onto the day, or the count, of the ranges.
pub(super) fn align<'a>(
    sensors: &mut Sensors,
    courses: impl IntoIterator<Item = &'a mut Course<2>>,
) {
    let differences = sensors.differences.first().map(|it| it.time_us);
    let Some(reference_us) = sensors.ranges.first().map(|it| it.time_us).or(differences) else {
        return;
    };
    let by_us = |first: Option<i64>| first.map_or(0, |first_us| behind_us(reference_us, first_us));
    let by = by_us(sensors.inertial.first().map(|it| it.time_us));
    sensors.inertial.iter_mut().for_each(|it| it.time_us += by);
    let by = by_us(sensors.wheels.first().map(|it| it.time_us));
    sensors.wheels.iter_mut().for_each(|it| it.time_us += by);
    if let Some(height) = &mut sensors.height {
        height.shift(by_us(height.rows().first().map(|row| row.0)));
    }
    for course in courses {
        course.shift(by_us(course.rows().first().map(|row| row.0)));
    }
}

/// The first and the last time of the ranges, or of the differences, µs.
pub(super) fn span_us(sensors: &Sensors) -> Option<[i64; 2]> {
    let ranges = sensors.ranges.iter().map(|it| it.time_us);
    let times = || ranges.clone().chain(sensors.differences.iter().map(|it| it.time_us));
    Some([times().min()?, times().max()?])
}

/// A table's times that last this many times as long as the ranges' are in another unit.
const ANOTHER_UNIT: i64 = 100;

/// A warning if a table beside the ranges can hardly have their clock.
pub(super) fn doubt<const N: usize>(
    name: &str,
    course: &Course<N>,
    ranges_us: Option<[i64; 2]>,
) -> Option<String> {
    let [first, last] = ranges_us?;
    let (begin, end) = (course.rows().first()?.0, course.rows().last()?.0);
    let times = end.saturating_sub(begin).checked_div(last.saturating_sub(first));
    if let Some(times) = times.filter(|times| *times >= ANOTHER_UNIT) {
        return Some(format!(
            "{name}: its times last {times} times as long as those of the ranges: if they are in ms or µs, its header must say so (t [ms])"
        ));
    }
    (end < first || begin > last).then(|| {
        format!(
            "{name}: it has no time in common with the ranges; look whether both have one clock"
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use kestirim_replay::robot::{RangeRow, Wheels};

    #[test]
    fn what_begins_after_a_counter_has_begun_anew_is_as_much_later() {
        let end = 1_i64 << 32;
        assert_eq!(behind_us(end - 2_000_000, 3_000_000), end);
        assert_eq!(behind_us(3_000_000, end - 2_000_000), -end);
        assert_eq!(behind_us(1000 * end - 5_000_000, 1_000_000), 1000 * end);
        // Logs that simply begin at another time.
        assert_eq!(behind_us(end - 2_000_000, 90_000_000), 0);
        assert_eq!(behind_us(end - 90_000_000, 3_000_000), 0);
        assert_eq!(behind_us(end + 2_000_000, 3_000_000), 0);
    }

    #[test]
    fn a_table_of_another_clock_is_told() {
        let told = |times: [i64; 2]| {
            let course = Course::new(times.map(|time_us| (time_us, [0.0])).to_vec());
            doubt("truth", &course, Some([1_000_000, 61_000_000])).unwrap_or_default()
        };
        assert_eq!([told([0, 90_000_000]), told([61_000_000, 62_000_000])], ["", ""]);
        assert!(told([1_000_000_000, 61_000_000_000]).contains("1000 times as long"));
        assert!(told([62_000_000, 90_000_000]).contains("no time in common"));
    }

    #[test]
    fn what_begins_after_midnight_is_of_the_next_day() {
        let range = |time_us| RangeRow { time_us, anchor: 0, range: Some(1.0) };
        let wheels = |time_us| Wheels { time_us, speed: 1.0, turn_rate: 0.0 };
        for (first_us, expected_us) in [
            (5_000_000, DAY_US + 5_000_000),
            (DAY_US - 8_000_000, DAY_US - 8_000_000),
            (1_700_000_000_000_000, 1_700_000_000_000_000),
        ] {
            let mut sensors = Sensors::ranges(vec![range(DAY_US - 10_000_000)]);
            sensors.wheels = vec![wheels(first_us)];
            let mut truth = Course::new(vec![(first_us, [0.0; 2])]);
            align(&mut sensors, [&mut truth]);
            assert_eq!(sensors.wheels[0].time_us, expected_us);
            assert_eq!(truth.rows()[0].0, expected_us);
        }
    }
}
