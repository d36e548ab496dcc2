//! The path in space, in parallel projection.

use kestirim_replay::pedestrian::TrackPoint;
use nalgebra::Vector3;

use super::attitude::Foot;
use super::{Placed, is_continuous, seconds};
use crate::figure::{Colour, Figure, Mark, Series};

/// The direction of view: the azimuth anticlockwise from x, and the elevation above the floor.
const AZIMUTH_DEG: f64 = -60.0;
const ELEVATION_DEG: f64 = 30.0;

/// The length of the foot's axes as a share of the path's extent, and its minimum, the width of a foot (m).
const AXIS: (f64, f64) = (0.04, 0.1);
const AXES: [&str; 3] = ["the foot's x, ahead", "the foot's y, left", "the foot's z, up"];

/// Projects a point.
fn seen([x, y, z]: [f64; 3]) -> [f64; 2] {
    let (sin_a, cos_a) = AZIMUTH_DEG.to_radians().sin_cos();
    let (sin_e, cos_e) = ELEVATION_DEG.to_radians().sin_cos();
    [cos_a * y - sin_a * x, cos_e * z - sin_e * (cos_a * x + sin_a * y)]
}

/// The path, the attitude of the foot after each stride, and the true path if its heights are known.
pub(super) fn draw(ours: &Placed<'_>, foot: &Foot<'_>, truth: &[TrackPoint]) -> Figure {
    let track = &ours.trace.walk.track;
    let places: Vec<_> = track.iter().map(|point| ours.in_room(point.position)).collect();
    let time = |point: &TrackPoint| seconds(point.time_us);
    let truth = is_continuous(truth).then(|| {
        Series::path("true path", truth.iter().map(|point| seen(point.position)))
            .timed(truth.iter().map(time))
            .marked(Mark::Dashes)
            .coloured(Colour::Truth)
    });
    let path = Series::path("ours", places.iter().map(|place| seen(*place)));
    Figure::new("space", "Path in space")
        .axes("to the right, m", "up, m")
        .map()
        .caption(format!(
            "Parallel projection, seen from {AZIMUTH_DEG}° (anticlockwise from x) and {ELEVATION_DEG}° above the floor; the \
             three strokes at each stance are the axes of the foot."
        ))
        .with_all(truth)
        .with(path.timed(track.iter().map(time)).coloured(Colour::Ours))
        .with_all(axes(ours, foot, length(&places)))
}

/// The length of the foot's axes in the figure (m).
fn length(places: &[[f64; 3]]) -> f64 {
    let extent = |axis: usize| {
        let values = places.iter().filter_map(|place| place.get(axis));
        let [low, high] = values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| {
            [low.min(*value), high.max(*value)]
        });
        high - low
    };
    let (share, least) = AXIS;
    (share * extent(0).max(extent(1))).max(least)
}

/// The axes of the foot at the stance after each stride.
fn axes(ours: &Placed<'_>, foot: &Foot<'_>, length_m: f64) -> [Series; 3] {
    let walk = &ours.trace.walk;
    let stances: Vec<_> = walk
        .strides
        .iter()
        .filter_map(|stride| {
            let after = walk.track.partition_point(|point| point.time_us <= stride.time_us);
            let attitude = foot.attitude(after.checked_sub(1)?)?;
            Some((seconds(stride.time_us), stride.position, attitude))
        })
        .collect();
    let axis = |of: usize| {
        let strokes = stances.iter().flat_map(|(_, [x, y, z], attitude)| {
            let tip = attitude * Vector3::ith(of, length_m);
            let ends = [[*x, *y, *z], [x + tip.x, y + tip.y, z + tip.z]];
            let [from, to] = ends.map(|end| seen(ours.in_room(end)));
            [from, to, [f64::NAN; 2]]
        });
        let times = stances.iter().flat_map(|(time, ..)| [*time; 3]);
        Series::path(AXES[of], strokes).timed(times).coloured(Colour::Other(of + 3))
    };
    std::array::from_fn(axis)
}

#[cfg(test)]
mod tests {
    use super::seen;

    #[test]
    fn up_is_up_and_lengths_across_the_view_are_true() {
        let [x, y] = seen([0.0, 0.0, 1.0]);
        assert!(x.abs() < 1e-12 && (y - 30_f64.to_radians().cos()).abs() < 1e-12);
        // A point perpendicular to the direction of view.
        let (sin, cos) = 30_f64.to_radians().sin_cos();
        let [x, y] = seen([2.0 * cos, 2.0 * sin, 0.0]);
        assert!((x - 2.0).abs() < 1e-12 && y.abs() < 1e-12, "{x}, {y}");
    }
}
