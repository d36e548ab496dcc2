//! Checks that the accelerations of the IMU are plausible.

use kestirim_health::Reason;

use crate::Finding;
use crate::metrics::median;
use crate::robot::Event;

/// The fewest accelerations that are judged.
const FEWEST: usize = 50;
/// The usual magnitude of accelerations that include gravity, in units of g.
const IN_G: std::ops::Range<f64> = 0.9..1.1;
/// The median deviation from the usual magnitude below which accelerations include gravity, in units of g; without
/// gravity it is larger.
const CLOSELY: f64 = 0.1;
/// The largest usual acceleration of a tag, m/s².
const LARGEST: f64 = 50.0;

/// A finding if accelerations are all the same, or in another unit.
pub(super) fn find(parts: &[&[Event]]) -> Option<Finding> {
    let accelerations: Vec<[f64; 3]> = parts
        .iter()
        .copied()
        .flatten()
        .filter_map(|event| match event {
            Event::Inertial(sample) => Some(sample.acceleration),
            _ => None,
        })
        .filter(|axes| axes.iter().all(|axis| axis.is_finite()))
        .collect();
    if accelerations.len() < FEWEST {
        return None;
    }
    if accelerations.windows(2).all(|pair| pair[0] == pair[1]) {
        return Some(Finding::fault(
            "IMU",
            Reason::Stuck,
            "all accelerations are the same",
            "a tag that moves is taken for one that stands",
            "look at the sensor, or leave --imu out",
        ));
    }
    let sizes: Vec<f64> = accelerations.iter().map(|[x, y, z]| x.hypot(*y).hypot(*z)).collect();
    let usual = median(&sizes);
    let from_it: Vec<f64> = sizes.iter().map(|size| (size - usual).abs()).collect();
    let seems_in_g = IN_G.contains(&usual) && median(&from_it) < CLOSELY;
    (seems_in_g || usual > LARGEST).then(|| {
        let (what, remedy) = if seems_in_g {
            ("they seem to be in g", "--units acc=g")
        } else {
            ("they are in another unit", "say which, such as --units acc=mg")
        };
        Finding::fault(
            "IMU",
            Reason::Units,
            format!("accelerations usually have a size of {usual:.3} m/s²: {what}"),
            "whether the tag stands or moves is told wrong",
            remedy,
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::robot::Inertial;

    fn told(scale: f64) -> Option<Reason> {
        let sample = |k: i32| {
            let turn = 0.3 * f64::from(k);
            let acceleration = [0.8 * turn.sin(), 0.5 * turn.cos(), 9.8].map(|axis| axis * scale);
            Event::Inertial(Inertial { time_us: i64::from(k) * 10_000, acceleration, push: None })
        };
        let events: Vec<_> = (0..200).map(sample).collect();
        find(&[&events])?.reason
    }

    #[test]
    fn accelerations_of_another_unit_or_of_a_dead_sensor_are_told() {
        assert_eq!(told(1.0), None);
        for scale in [1.0 / 9.80665, 1000.0, 1000.0 / 9.80665] {
            assert_eq!(told(scale), Some(Reason::Units), "{scale}");
        }
        assert_eq!(told(0.0), Some(Reason::Stuck));
    }

    #[test]
    fn accelerations_without_gravity_are_none_of_them() {
        let sample = |k: i32| {
            let size = (0.3 * f64::from(k)).sin().powi(2) * 2.0;
            let acceleration = [size, 0.0, 0.0];
            Event::Inertial(Inertial { time_us: i64::from(k) * 10_000, acceleration, push: None })
        };
        let events: Vec<_> = (0..200).map(sample).collect();
        assert_eq!(find(&[&events]), None);
    }
}
