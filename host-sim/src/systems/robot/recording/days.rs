//! Logs with times of day of which one begins before midnight and another after it.

use kestirim_replay::robot::{Course, Sensors};

/// A day, µs.
const DAY_US: i64 = 86_400_000_000;

/// By how much times that begin at `first_us` are before those that begin at `reference_us`, in whole days; zero for times of more
/// than two days, which have a date.
fn days_us(reference_us: i64, first_us: i64) -> i64 {
    let is_of_day = |time_us: i64| (0..2 * DAY_US).contains(&time_us);
    if !(is_of_day(reference_us) && is_of_day(first_us)) {
        return 0;
    }
    let days = (reference_us - first_us) as f64 / DAY_US as f64;
    days.round() as i64 * DAY_US
}

/// Puts the IMU, the wheels and the courses onto the day of the ranges.
pub(super) fn align<'a>(
    sensors: &mut Sensors,
    courses: impl IntoIterator<Item = &'a mut Course<2>>,
) {
    let differences = sensors.differences.first().map(|it| it.time_us);
    let Some(reference_us) = sensors.ranges.first().map(|it| it.time_us).or(differences) else {
        return;
    };
    let by_us = |first: Option<i64>| first.map_or(0, |first_us| days_us(reference_us, first_us));
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

#[cfg(test)]
mod tests {
    use super::*;
    use kestirim_replay::robot::{RangeRow, Wheels};

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
