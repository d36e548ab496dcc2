//! The figures of the paper, from one walk. As in the paper, the sensor data are those of a log at 100 Hz and the
//! position that of one at 50 Hz.

use kestirim_replay::pedestrian::{DetectorKind, Trace};

use super::Typical;
use crate::figure::{Colour, Figure, Series};
use crate::metrics::STANDARD_GRAVITY;
use crate::systems::pedestrian::Sample;
use crate::systems::pedestrian::figures::{self, Placed};
use crate::systems::pedestrian::paper::published::AFTER_15_S;
use crate::systems::pedestrian::simulate::scenario::Scenario;

/// Figs 8 to 11: the sensor data, and the stance detected in them.
pub(super) fn of_the_sensor(walk: &Typical) -> [Figure; 4] {
    let samples = &walk.recording.log.samples;
    let placed = |trace| Placed::new(trace, &[]);
    let steps = figures::magnitude("pedestrian-figure-10", samples)
        .with(figures::threshold(samples, DetectorKind::MAGNITUDE_THRESHOLD / STANDARD_GRAVITY))
        .with(placed(&walk.paper).stance("within the threshold").coloured(Colour::Published))
        .with(placed(&walk.ours).stance("standing, ours").coloured(Colour::Ours))
        .caption(
            "The paper's detector, literally, finds several stances in every swing, where |a| passes 1 g; ours finds one a stride.",
        );
    [
        titled(figures::accelerometer("pedestrian-figure-8", samples), "Fig. 8: accelerometer"),
        titled(figures::magnitude("pedestrian-figure-9", samples), "Fig. 9: magnitude |a|"),
        titled(steps, "Fig. 10: detection of steps"),
        titled(figures::gyroscope("pedestrian-figure-11", samples), "Fig. 11: gyroscope"),
    ]
}

/// Figs 12 to 15: the ideal velocity, and that without and with updates.
pub(super) fn of_the_velocity(slow: &Typical, fast: &Typical, truth: &Scenario) -> [Figure; 4] {
    let ours = placed(fast, &fast.ours);
    let without = Placed { trace: &fast.drifting, placement: ours.placement };
    let with = Figure::new("pedestrian-figure-14", "Fig. 14: velocity with zero-velocity updates")
        .over_seconds("velocity along x, m/s")
        .caption("Ours is the true velocity but for its errors; the paper's method stops within every swing.")
        .with(
            placed(fast, &fast.paper)
                .velocity("the paper's method, literally", 0)
                .coloured(Colour::Published),
        )
        .with(ours.velocity("ours", 0).coloured(Colour::Ours));
    let all = figures::velocities("pedestrian-figure-15", &placed(slow, &slow.ours));
    [
        ideal("pedestrian-figure-12", truth, &fast.recording.log.samples),
        titled(
            figures::velocity("pedestrian-figure-13", &ours, &without),
            "Fig. 13: velocity without zero-velocity updates",
        ),
        with,
        titled(all, "Fig. 15: velocity of all axes"),
    ]
}

/// Figs 16 and 17: the position over time, and the path.
pub(super) fn of_the_position(walk: &Typical) -> [Figure; 2] {
    let truth = walk.recording.truth();
    let ours = placed(walk, &walk.ours);
    let [x, y] = AFTER_15_S;
    let over_time = figures::position("pedestrian-figure-16", &ours, &truth).caption(format!(
        "Flat in stance, one step a stride, z near zero; the paper's walker is at about x = {x} m, y = {y} m after \
         15 s, on legs of which we know only the sum."
    ));
    let literally =
        placed(walk, &walk.paper).path("the paper's method, literally").coloured(Colour::Published);
    [
        titled(over_time, "Fig. 16: position"),
        titled(
            figures::path("pedestrian-figure-17", &truth, &ours, vec![literally]),
            "Fig. 17: path on the plan",
        ),
    ]
}

fn placed<'a>(walk: &Typical, trace: &'a Trace) -> Placed<'a> {
    Placed::new(trace, &walk.recording.truth())
}

/// The true velocity of the foot.
fn ideal(id: &str, truth: &Scenario, samples: &[Sample]) -> Figure {
    let half_s = 5e-4;
    let times: Vec<_> = samples.iter().map(|sample| figures::seconds(sample.time_us)).collect();
    let velocity = |&t: &f64| {
        (truth.pose(t + half_s).position.x - truth.pose(t - half_s).position.x) / (2.0 * half_s)
    };
    let velocities = times.iter().map(velocity).collect();
    Figure::new(id, "Fig. 12: velocity as it should be")
        .over_seconds("velocity along x, m/s")
        .caption("The true velocity of the synthetic foot: exactly zero from the end of a stride to the next.")
        .with(Series::line("true x", times, velocities).coloured(Colour::Truth))
}

fn titled(figure: Figure, title: &str) -> Figure {
    Figure { title: title.to_owned(), ..figure }
}
