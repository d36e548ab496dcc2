//! Figures of a recording and its track.

pub mod dilution;
pub mod links;
pub mod plan;
pub mod streams;

use kestirim_replay::robot::{Event, Setup, Trace, TrackerKind};

use self::links::Links;
use self::plan::{around, rectangle, room};
use super::links::{Link, table};
use super::recording::Recording;
use super::track::{Tracks, track};
use crate::Error;
use crate::figure::{Colour, Figure, Mark, Series};
use crate::metrics::distance;
use crate::system::Answer;

/// The number of ellipses along a track.
const ELLIPSES: usize = 30;
/// The pause between the points of a static recording (s).
const PAUSE_S: f64 = 0.5;

/// Adds the page's figures and its table, with trilateration alone for comparison.
pub(super) fn draw(
    recording: &Recording,
    setup: &Setup,
    tracks: &Tracks,
    answer: &mut Answer,
) -> Result<(), Error> {
    let unfiltered = Setup { tracker: TrackerKind::Lsq, ..setup.clone() };
    let unfiltered = track(recording, &unfiltered)?;
    let (shown, raw) = (Shown::new(recording, &tracks.traces), Shown::new(recording, &unfiltered));
    let smoothed = tracks.smoothed_traces();
    let smoothed = smoothed.as_deref().map(|traces| Shown::new(recording, traces));
    let room = setup.room.map(|corners| rectangle("room", corners).coloured(Colour::Limit));
    let positions = raw.track("trilateration alone", Mark::Dots).coloured(Colour::Published);
    let mut errors = vec![
        raw.error("trilateration alone").coloured(Colour::Published),
        shown.error("tracker").coloured(Colour::Ours),
    ];
    let mut others: Vec<_> = room.into_iter().chain([positions]).collect();
    if let Some(smoothed) = &smoothed {
        others.push(smoothed.track("smoothed", smoothed.line()).coloured(Colour::Other(5)));
        errors.push(smoothed.error("smoothed").coloured(Colour::Other(5)));
    }
    errors.push(shown.sigma("σ of the tracker").coloured(Colour::Other(3)));
    let links = Links::new(&shown, setup);
    answer.tables = vec![table(&Link::all(recording, setup, &tracks.traces))];
    answer.figures = vec![
        shown.plan("plan", others),
        shown.dilution("dilution", setup),
        shown.ranges("ranges"),
        links.residuals("residuals"),
        links.nis("nis"),
        links.rejections("rejections"),
        shown.dilution_over_time("hdop", setup),
        shown.position("position"),
        self::errors("error", errors),
    ];
    Ok(())
}

/// A recording, its traces, and the times at which its parts are shown.
#[derive(Debug, Clone)]
pub struct Shown<'a> {
    recording: &'a Recording,
    traces: &'a [Trace],
    /// The offset that is added to the log's clock in each part (s).
    shifts_s: Vec<f64>,
}

impl<'a> Shown<'a> {
    /// Arranges a recording for display: points that were recorded separately are shown one after the other.
    pub fn new(recording: &'a Recording, traces: &'a [Trace]) -> Self {
        let mut begin_s = 0.0;
        let mut shifts_s = Vec::with_capacity(recording.parts.len());
        for part in &recording.parts {
            shifts_s.push(begin_s);
            let last_us = part.events.iter().map(Event::time_us).max().unwrap_or_default();
            begin_s += last_us as f64 * 1e-6 + PAUSE_S;
        }
        Self { recording, traces, shifts_s }
    }

    /// The time at which an event of a part is shown (s).
    fn seconds(&self, part: usize, time_us: i64) -> f64 {
        time_us as f64 * 1e-6 + self.shifts_s.get(part).copied().unwrap_or_default()
    }

    /// A series over time with a gap after each part.
    fn over_time(
        &self,
        name: impl Into<String>,
        mark: Mark,
        points: impl Fn(usize, &Trace) -> Vec<(i64, f64)>,
    ) -> Series {
        let (mut xs, mut ys) = (Vec::new(), Vec::new());
        for (index, trace) in self.traces.iter().enumerate() {
            for (time_us, value) in points(index, trace) {
                xs.push(self.seconds(index, time_us));
                ys.push(value);
            }
            xs.push(xs.last().copied().unwrap_or_default());
            ys.push(f64::NAN);
        }
        Series::new(name, mark, xs, ys)
    }

    /// Every estimated position, with its time, and its covariance if the tracker has one.
    pub fn track(&self, name: &str, mark: Mark) -> Series {
        let (mut places, mut times, mut spreads) = (Vec::new(), Vec::new(), Vec::new());
        for (part, trace) in self.traces.iter().enumerate() {
            for epoch in &trace.epochs {
                places.push(epoch.position.map_or([f64::NAN; 2], |[x, y, _]| [x, y]));
                times.push(self.seconds(part, epoch.time_us));
                spreads.push(epoch.spread.unwrap_or([f64::NAN; 3]));
            }
            // A gap after each part.
            places.push([f64::NAN; 2]);
            times.push(times.last().copied().unwrap_or_default());
            spreads.push([f64::NAN; 3]);
        }
        let is_known = spreads.iter().any(|[xx, ..]| xx.is_finite());
        let series = Series::path(name, places).marked(mark).timed(times);
        if is_known { series.uncertain(spreads) } else { series }
    }

    /// Ellipses that contain 95 % of the positions if the tracker's covariance is right.
    fn ellipses(&self) -> Series {
        let mut points = Vec::new();
        for trace in self.traces {
            let every =
                if self.traces.len() > 1 { usize::MAX } else { trace.epochs.len() / ELLIPSES };
            let last = trace.epochs.len().saturating_sub(1);
            for (index, epoch) in trace.epochs.iter().enumerate() {
                let chosen = index == last || (index + 1).is_multiple_of(every.max(1));
                if let (true, Some([x, y, _]), Some(spread)) =
                    (chosen, epoch.position, epoch.spread)
                {
                    points.extend(around([x, y], spread));
                    points.push([f64::NAN; 2]);
                }
            }
        }
        Series::path("95 % ellipses", points).coloured(Colour::Other(3))
    }

    /// The plan: anchors, the true path, the track with its ellipses, and others behind it.
    pub fn plan(&self, id: &str, others: Vec<Series>) -> Figure {
        room(id, self.recording)
            .caption("Anchors, the true path where it is known, and the track; ellipses hold 95 % if the covariance is right.")
            .with_all(others)
            .with(self.track("track", Mark::Line).coloured(Colour::Ours))
            .with(self.ellipses())
    }

    /// The ranges of each anchor; crosses are those that the tracker rejected.
    pub fn ranges(&self, id: &str) -> Figure {
        let of = |anchor: usize, taken: bool| {
            move |_: usize, trace: &Trace| -> Vec<(i64, f64)> {
                let of_anchor = trace.ranges.iter().filter(move |(range, reception)| {
                    range.anchor == anchor && reception.taken == taken
                });
                of_anchor.map(|(range, _)| (range.time_us, range.metres)).collect()
            }
        };
        let names = &self.recording.anchors.names;
        let mut figure = Figure::new(id, "Ranges")
            .over_seconds("range, m")
            .caption("What each anchor measured; a cross is a range that the tracker left out.");
        for (anchor, name) in names.iter().enumerate() {
            let taken = self.over_time(name.clone(), Mark::Dots, of(anchor, true));
            figure.series.push(taken.coloured(Colour::Other(anchor)));
        }
        let (mut xs, mut ys) = (Vec::new(), Vec::new());
        for anchor in 0..names.len() {
            let left_out = self.over_time("", Mark::Crosses, of(anchor, false));
            xs.extend(left_out.x);
            ys.extend(left_out.y);
        }
        figure.with(Series::new("left out", Mark::Crosses, xs, ys).coloured(Colour::Alarm))
    }

    /// The standard deviation of the position over time, as far as the tracker has one.
    fn sigma(&self, name: &str) -> Series {
        let sigma = |_: usize, trace: &Trace| {
            let epochs = trace.epochs.iter();
            epochs.filter_map(|e| Some((e.time_us, 100.0 * e.sigma_m()?))).collect()
        };
        self.over_time(name, self.line(), sigma)
    }

    /// The coordinates over time, with the truth if it is known.
    pub fn position(&self, id: &str) -> Figure {
        let ours = ["x", "y", "z"].into_iter().enumerate().map(|(axis, name)| {
            let of = move |_: usize, trace: &Trace| {
                let coordinate = |position: [f64; 3]| position[axis];
                let epochs = trace.epochs.iter();
                epochs.map(|e| (e.time_us, e.position.map_or(f64::NAN, coordinate))).collect()
            };
            self.over_time(name, Mark::Line, of).coloured(Colour::Other(axis))
        });
        let known = self.recording.parts.iter().any(|part| part.truth.is_some());
        let truth = ["true x", "true y"].into_iter().enumerate().filter(|_| known);
        let truth = truth.map(|(axis, name)| {
            let of = move |part: usize, trace: &Trace| {
                let epochs = trace.epochs.iter();
                let truth = |time_us| Some(self.truth(part, time_us)?[axis]);
                epochs.map(|e| (e.time_us, truth(e.time_us).unwrap_or(f64::NAN))).collect()
            };
            self.over_time(name, Mark::Dashes, of).coloured(Colour::Truth)
        });
        Figure::new(id, "Position")
            .over_seconds("position, m")
            .caption("Coordinates in the room; z is as given unless the tracker estimates it.")
            .with_all(truth)
            .with_all(ours)
    }

    /// The mark of a track: a line, or points if each part has a single position.
    pub fn line(&self) -> Mark {
        let is_single = |trace: &Trace| trace.epochs.len() < 2;
        if self.traces.iter().all(is_single) { Mark::Points } else { Mark::Line }
    }

    /// The horizontal error over time; empty if the truth is not known.
    pub fn error(&self, name: &str) -> Series {
        let of = |part: usize, trace: &Trace| {
            let error = |position: Option<[f64; 3]>, time_us| {
                let ([x, y, _], truth) = (position?, self.truth(part, time_us)?);
                Some(100.0 * distance([x, y], truth))
            };
            let epochs = trace.epochs.iter();
            epochs.filter_map(|e| Some((e.time_us, error(e.position, e.time_us)?))).collect()
        };
        self.over_time(name, self.line(), of)
    }

    fn truth(&self, part: usize, time_us: i64) -> Option<[f64; 2]> {
        self.recording.parts.get(part)?.truth.as_ref()?.at(time_us)
    }
}

/// The errors of one or more trackers over time.
pub fn errors(id: &str, series: impl IntoIterator<Item = Series>) -> Figure {
    Figure::new(id, "Error")
        .over_seconds("horizontal error, cm")
        .caption("The distance from the true place, where that is known.")
        .with_all(series)
}
