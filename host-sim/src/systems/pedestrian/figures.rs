//! Figures of a walk: the diagrams of the paper.

mod attitude;
mod events;
pub mod placement;
mod space;
pub mod streams;
mod uncertainty;

use kestirim_replay::pedestrian::{
    self, Moment, Options, Trace, TrackPoint, trace, without_updates,
};

use self::attitude::Foot;
use self::placement::Placement;
use super::Sample;
use super::recording::Recording;
use super::strides;
use super::track::refused;
use crate::Error;
use crate::figure::{Colour, Figure, Mark, Series};
use crate::metrics::STANDARD_GRAVITY;
use crate::system::Answer;

const AXES: [&str; 3] = ["x", "y", "z"];
/// The colours of the axes, wherever colour has no other meaning.
const COLOURS: [Colour; 3] = [Colour::Other(0), Colour::Other(1), Colour::Other(2)];

/// A function that tracks a log.
type Tracker = fn(&[Sample], &Options) -> Result<Trace, pedestrian::Error>;

/// Adds the page's figures, and facts about what they compare with: the published method, and no updates at all.
pub(super) fn draw(
    recording: &Recording,
    options: &Options,
    ours: &Trace,
    answer: &mut Answer,
) -> Result<(), Error> {
    let published = options.published_beside();
    let samples = &recording.log.samples;
    let traced = |tracker: Tracker, options: &Options| {
        tracker(samples, options).map_err(|error| refused(recording, &error))
    };
    let (published_trace, drifting) =
        rayon::join(|| traced(trace, &published), || traced(without_updates, options));
    let (published_trace, drifting) = (published_trace?, drifting?);
    let truth = recording.truth();
    let (with, by_paper) = (Placed::new(ours, &truth), Placed::new(&published_trace, &truth));
    // Without updates the track leaves the plan and no alignment would fit, so it is placed like ours.
    let without = Placed { trace: &drifting, placement: with.placement };
    let others = vec![
        by_paper.path("the published method").coloured(Colour::Published),
        without.path("without updates").coloured(Colour::Alarm).hidden(),
    ];
    let threshold_g = published.magnitude_threshold_g();
    let magnitude = magnitude("magnitude", samples)
        .with(threshold(samples, threshold_g))
        .with(by_paper.stance("within the threshold").coloured(Colour::Published).hidden())
        .with(with.stance("standing, as detected").coloured(Colour::Ours));
    let foot = Foot::of(ours);
    let caption = "The walked path from above, each stride marked; where the truth is known, tracks are turned onto it. \
                   Ellipses are one standard deviation, marks where the heading turns by more than 45° within four strides, or \
                   where the foot stands for more than 1.5 s.";
    answer.figures = vec![
        path("path", &truth, &with, others).with_all(events::on_plan(&with)).caption(caption),
        space::draw(&with, &foot, &truth),
        attitude::draw(&foot),
        uncertainty::draw(&with, &truth),
        uncertainty::height(&with, &truth),
        accelerometer("accelerometer", samples),
        gyroscope("gyroscope", samples),
        magnitude,
        velocity("velocity", &with, &without),
        position("position", &with, &truth),
    ];
    answer.tables = vec![strides::sheet(&ours.walk)];
    answer.fact("stance", options.detector.in_words());
    let length = format!("{:.2} m", published_trace.walk.path_length_m);
    answer.fact("path by the published method", length);
    Ok(())
}

/// A walk placed on the plan.
#[derive(Debug, Clone, Copy)]
pub struct Placed<'a> {
    /// The walk.
    pub trace: &'a Trace,
    /// The alignment of the walk with the plan.
    pub placement: Placement,
}

impl<'a> Placed<'a> {
    /// Aligns a walk with the truth, or leaves it as it is if that is unknown.
    pub fn new(trace: &'a Trace, truth: &[TrackPoint]) -> Self {
        Self { trace, placement: Placement::of(&trace.walk.track, truth) }
    }

    /// A position of the track in the frame of the plan, with its height.
    fn in_room(&self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        let [x, y] = self.placement.onto_plan([x, y]);
        [x, y, z]
    }

    /// The path of the foot.
    pub fn path(&self, name: &str) -> Series {
        let track = self.trace.walk.track.iter();
        let path = track.map(|point| self.placement.onto_plan(point.horizontal()));
        Series::path(name, path).timed(self.times())
    }

    /// The positions of the foot after each stride.
    pub fn strides(&self, name: &str) -> Series {
        let strides = &self.trace.walk.strides;
        let places = strides.iter().map(|stride| {
            let [x, y, _] = stride.position;
            self.placement.onto_plan([x, y])
        });
        Series::points(name, places).timed(strides.iter().map(|stride| seconds(stride.time_us)))
    }

    /// The velocity along an axis of the plan over time; axes are counted from 0.
    pub fn velocity(&self, name: impl Into<String>, axis: usize) -> Series {
        let velocity = |moment: &Moment| {
            let [x, y, z] = moment.velocity;
            let [x, y] = self.placement.turned([x, y]);
            [x, y, z][axis]
        };
        Series::line(name, self.times(), self.trace.moments.iter().map(velocity).collect())
    }

    /// The position along an axis of the plan over time.
    fn position(&self, name: impl Into<String>, axis: usize) -> Series {
        let position = |point: &TrackPoint| {
            let [x, y] = self.placement.onto_plan(point.horizontal());
            [x, y, point.position[2]][axis]
        };
        Series::line(name, self.times(), self.trace.walk.track.iter().map(position).collect())
    }

    /// The stance over time: 1 while the foot is stationary, 0 while it moves, as in the paper.
    pub fn stance(&self, name: &str) -> Series {
        let stances = self.trace.moments.iter().map(|moment| f64::from(u8::from(moment.stance)));
        Series::new(name, Mark::Steps, self.times(), stances.collect())
    }

    fn times(&self) -> Vec<f64> {
        self.trace.walk.track.iter().map(|point| seconds(point.time_us)).collect()
    }
}

/// The specific force over time.
pub fn accelerometer(id: &str, samples: &[Sample]) -> Figure {
    Figure::new(id, "Accelerometer")
        .over_seconds("specific force, g")
        .caption(
            "The three axes of the sensor as logged; at rest gravity alone, spread over all three.",
        )
        .with_all(triad(samples, |sample| sample.specific_force.map(|f| f / STANDARD_GRAVITY)))
}

/// The angular rate over time.
pub fn gyroscope(id: &str, samples: &[Sample]) -> Figure {
    Figure::new(id, "Gyroscope")
        .over_seconds("angular rate, °/s")
        .caption("The three axes of the sensor as logged: the foot pitches down, swings through, and lands on its heel.")
        .with_all(triad(samples, |sample| sample.angular_rate.map(f64::to_degrees)))
}

/// The magnitude of the specific force over time (eq. 2).
pub fn magnitude(id: &str, samples: &[Sample]) -> Figure {
    let magnitude = |sample: &Sample| {
        let [x, y, z] = sample.specific_force;
        x.hypot(y).hypot(z) / STANDARD_GRAVITY
    };
    let magnitudes = samples.iter().map(magnitude).collect();
    Figure::new(id, "Magnitude of the specific force, |a|")
        .over_seconds("|a|, g; 1 = standing, 0 = moving")
        .caption("Gravity is part of |a|: at rest it is 1 g, and in every swing it passes 1 g several times.")
        .with(Series::line("|a|", times(samples), magnitudes).coloured(Colour::Other(5)))
}

/// The paper's threshold: two lines about 1 g over the duration of the log.
pub fn threshold(samples: &[Sample], threshold_g: f64) -> Series {
    let ends = [samples.first(), samples.last()];
    let [from, to] = ends.map(|sample| sample.map_or(f64::NAN, |sample| seconds(sample.time_us)));
    let (low, high) = (1.0 - threshold_g, 1.0 + threshold_g);
    let (x, y) = (vec![from, to, f64::NAN, from, to], vec![high, high, f64::NAN, low, low]);
    Series::new(format!("1 ± {threshold_g:.2} g"), Mark::Dashes, x, y).coloured(Colour::Limit)
}

/// All three velocities over time.
pub fn velocities(id: &str, placed: &Placed<'_>) -> Figure {
    let axis = |i: usize| placed.velocity(AXES[i], i).coloured(COLOURS[i]);
    Figure::new(id, "Velocity with zero-velocity updates")
        .over_seconds("velocity, m/s")
        .caption("A hump a stride, and zero between; the sign tells the direction.")
        .with_all((0..3).map(axis))
}

/// The velocity along x and, behind the legend, the other axes, with and without zero-velocity updates.
pub fn velocity(id: &str, with: &Placed<'_>, without: &Placed<'_>) -> Figure {
    let axis = |i: usize| {
        let without = without
            .velocity(format!("{} without updates", AXES[i]), i)
            .coloured(if i == 0 { Colour::Alarm } else { COLOURS[i] })
            .marked(if i == 0 { Mark::Line } else { Mark::Dashes });
        let with = with.velocity(format!("{} with updates", AXES[i]), i).coloured(COLOURS[i]);
        if i == 0 { [without, with] } else { [without.hidden(), with.hidden()] }
    };
    Figure::new(id, "Velocity with and without zero-velocity updates")
        .over_seconds("velocity, m/s")
        .caption("Without updates the velocity never comes back to zero when the foot stands; with them it does.")
        .with_all((0..3).flat_map(axis))
}

/// The position over time, with the truth as far as it is known.
pub fn position(id: &str, placed: &Placed<'_>, truth: &[TrackPoint]) -> Figure {
    let ours = (0..3).map(|i| placed.position(AXES[i], i).coloured(COLOURS[i]));
    let known = (0..3).filter(|&i| !truth.is_empty() && (i < 2 || is_continuous(truth)));
    let truth = known.map(|i| {
        let (times, values) =
            truth.iter().map(|point| (seconds(point.time_us), point.position[i])).unzip();
        let mark = if is_continuous(truth) { Mark::Dots } else { Mark::Points };
        Series::new(format!("true {}", AXES[i]), mark, times, values).coloured(Colour::Truth)
    });
    Figure::new(id, "Position")
        .over_seconds("position, m")
        .caption("Flat in stance, one step a stride; z stays near zero on a flat floor.")
        .with_all(ours)
        .with_all(truth)
}

/// The plan: the true path and ours, with others behind.
pub fn path(id: &str, truth: &[TrackPoint], ours: &Placed<'_>, others: Vec<Series>) -> Figure {
    let route = (!truth.is_empty()).then(|| {
        Series::path("true way", truth.iter().map(TrackPoint::horizontal))
            .marked(if is_continuous(truth) { Mark::Dashes } else { Mark::LineAndPoints })
            .coloured(Colour::Truth)
    });
    Figure::new(id, "Path on the plan")
        .axes("x, m", "y, m")
        .map()
        .caption(
            "The walked path from above, each stride marked; where the truth is known, tracks are turned onto it.",
        )
        .with_all(route)
        .with_all(others)
        .with(ours.path("ours").coloured(Colour::Ours))
        .with(ours.strides("our strides").coloured(Colour::Ours))
}

/// Whether a truth is known at every sample rather than at footprints, which have no height.
fn is_continuous(truth: &[TrackPoint]) -> bool {
    truth.iter().any(|point| point.position[2].is_finite())
}

fn triad(samples: &[Sample], value: impl Fn(&Sample) -> [f64; 3]) -> [Series; 3] {
    std::array::from_fn(|i| {
        let values = samples.iter().map(|sample| value(sample)[i]).collect();
        Series::line(AXES[i], times(samples), values).coloured(COLOURS[i])
    })
}

fn times(samples: &[Sample]) -> Vec<f64> {
    samples.iter().map(|sample| seconds(sample.time_us)).collect()
}

/// Converts microseconds of the log's clock to seconds.
pub fn seconds(time_us: u64) -> f64 {
    time_us as f64 / 1e6
}
