//! Markers on the plan beside the path: turns, stops and uncertainties.

use std::f64::consts::TAU;

use super::{Placed, seconds};
use crate::figure::{Colour, Mark, Series};
use crate::systems::pedestrian::strides::{stops, turns};

/// The maximum number of ellipses: more would hide the path.
const MOST_ELLIPSES: usize = 24;
/// The maximum number of turns that are labelled: labels of more would overlap.
const MOST_LABELS: usize = 12;
/// The number of corners of an ellipse.
const CORNERS: u32 = 24;

/// The turns and stops of a walk, and ellipses of one standard deviation.
pub(super) fn on_plan(ours: &Placed<'_>) -> [Series; 3] {
    let turns = turns(&ours.trace.walk);
    let are_few = turns.len() <= MOST_LABELS;
    let turns = turns.into_iter().map(|turn| {
        let label = are_few.then(|| format!("{:+.0}°", turn.angle_rad.to_degrees()));
        (turn.time_s, turn.position, label.unwrap_or_default())
    });
    let stops = stops(ours.trace).into_iter();
    let stops = stops.map(|stop| (stop.time_s, stop.position, format!("{:.1} s", stop.duration_s)));
    [
        ellipses(ours),
        marks("turns", ours, turns).coloured(Colour::Other(3)),
        marks("stops", ours, stops).coloured(Colour::Other(5)).marked(Mark::Crosses),
    ]
}

/// Labelled positions. The gap after each keeps the cursor from selecting one while the foot is elsewhere.
fn marks(
    name: &str,
    ours: &Placed<'_>,
    of: impl Iterator<Item = (f64, [f64; 3], String)>,
) -> Series {
    let (mut places, mut times, mut labels) = (Vec::new(), Vec::new(), Vec::new());
    for (time, [x, y, _], label) in of {
        places.extend([ours.placement.onto_plan([x, y]), [f64::NAN; 2]]);
        times.extend([time; 2]);
        labels.extend([label, String::new()]);
    }
    Series::points(name, places).timed(times).labelled(labels)
}

/// Ellipses of one standard deviation of x and y, at strides spread over the walk.
fn ellipses(ours: &Placed<'_>) -> Series {
    let strides = &ours.trace.walk.strides;
    let step = strides.len().div_ceil(MOST_ELLIPSES).max(1);
    // Counted backwards, so that the last one, the most important, is included.
    let mut shown: Vec<_> = strides.iter().rev().step_by(step).collect();
    shown.reverse();
    let corners = shown.iter().flat_map(|stride| {
        let ([x, y, _], [sx, sy, _]) = (stride.position, stride.sigma_m);
        let corner = move |corner: u32| {
            let (sin, cos) = (TAU * f64::from(corner) / f64::from(CORNERS)).sin_cos();
            ours.placement.onto_plan([x + sx * cos, y + sy * sin])
        };
        (0..=CORNERS).map(corner).chain([[f64::NAN; 2]])
    });
    let times = shown
        .iter()
        .flat_map(|stride| std::iter::repeat_n(seconds(stride.time_us), CORNERS as usize + 2));
    Series::path("standard deviation", corners).timed(times).coloured(Colour::Other(4))
}
