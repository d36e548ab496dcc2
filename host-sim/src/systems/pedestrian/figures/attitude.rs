//! Figures of the attitude of the foot.

use kestirim_replay::pedestrian::{Moment, Trace};
use nalgebra::{Quaternion, UnitQuaternion};

use super::{COLOURS, seconds};
use crate::figure::{Colour, Figure, Mark, Series};
use crate::systems::pedestrian::strides::stances;

/// The attitude of the foot relative to its first stance: however the sensor is mounted, a foot that is flat and points
/// as at the start has zero roll, pitch and yaw.
#[derive(Debug, Clone, Copy)]
pub(super) struct Foot<'a> {
    trace: &'a Trace,
    /// The rotation from the foot to the sensor on it.
    mounted: UnitQuaternion<f64>,
}

impl<'a> Foot<'a> {
    pub(super) fn of(trace: &'a Trace) -> Self {
        // In the middle of the first stance gravity is known, and the heel has not begun to rise.
        let first = stances(trace).first().map(|[from, to]| usize::midpoint(*from, *to));
        let first = first.and_then(|place| trace.moments.get(place));
        let mounted = first.map_or_else(UnitQuaternion::identity, |it| attitude(it).inverse());
        Self { trace, mounted }
    }

    /// The rotation from the foot (x ahead, y to the left, z up) to the room at a sample.
    pub(super) fn attitude(&self, place: usize) -> Option<UnitQuaternion<f64>> {
        Some(attitude(self.trace.moments.get(place)?) * self.mounted)
    }

    /// The roll, pitch and yaw of all samples (°); pitch is positive with the toes up. There is a gap where the yaw
    /// passes ±180°.
    fn angles_deg(&self) -> [Vec<f64>; 3] {
        let (mut angles, mut before) = ([const { Vec::new() }; 3], 0.0_f64);
        for attitude in (0..self.trace.moments.len()).filter_map(|place| self.attitude(place)) {
            let (roll, pitch, yaw) = attitude.euler_angles();
            let [roll, pitch, yaw] = [roll, -pitch, yaw].map(f64::to_degrees);
            let shown = if (yaw - before).abs() > 180.0 { f64::NAN } else { yaw };
            before = yaw;
            for (all, angle) in angles.iter_mut().zip([roll, pitch, shown]) {
                all.push(angle);
            }
        }
        angles
    }
}

fn attitude(moment: &Moment) -> UnitQuaternion<f64> {
    let [w, x, y, z] = moment.orientation;
    UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z))
}

/// The roll, pitch and yaw over time, with the stances marked.
pub(super) fn draw(foot: &Foot<'_>) -> Figure {
    let track = &foot.trace.walk.track;
    let angles = foot.angles_deg();
    let lowest = angles.iter().flatten().copied().fold(0.0, f64::min);
    let names = ["roll", "pitch", "yaw"].into_iter().zip(COLOURS);
    let lines = names.zip(angles).map(|((name, colour), angles)| {
        let times = track.iter().map(|point| seconds(point.time_us)).collect();
        Series::line(name, times, angles).coloured(colour)
    });
    Figure::new("attitude", "Attitude of the foot")
        .over_seconds("angle, °")
        .caption(
            "Turned from how it stood at first: pitch with the toes up, yaw anticlockwise, roll with the left side up. \
             The bar below is drawn while the foot stands.",
        )
        .with_all(lines)
        .with(standing(foot.trace, lowest - 15.0))
}

/// A bar for each stance.
fn standing(trace: &Trace, height: f64) -> Series {
    let (mut x, mut y) = (Vec::new(), Vec::new());
    for ends in stances(trace) {
        let [from, to] = ends.map(|end| trace.walk.track.get(end));
        let (Some(from), Some(to)) = (from, to) else { continue };
        x.extend([seconds(from.time_us), seconds(to.time_us), seconds(to.time_us)]);
        y.extend([height, height, f64::NAN]);
    }
    Series::new("standing", Mark::Line, x, y).coloured(Colour::Other(5))
}
