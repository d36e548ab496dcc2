//! Figures of each anchor's ranges over time: residuals and rejections.

use kestirim_replay::robot::{Setup, Trace};

use super::Shown;
use crate::figure::{Colour, Figure, Mark, Series};
use crate::systems::robot::links::{Judged, of_anchors};

/// The 95 % quantile of χ² with one degree of freedom.
const CHI_SQUARE_1: f64 = 3.841;
/// The window over which shares of rejected ranges are computed (µs).
const LATELY_US: i64 = 10_000_000;
/// The number of anchors beyond which the lines of their standard deviations are hidden initially.
const FEW: usize = 4;

/// The ranges by anchor, with the times at which they are shown.
#[derive(Debug, Clone)]
pub struct Links<'a> {
    shown: &'a Shown<'a>,
    anchors: Vec<Vec<Judged>>,
}

impl<'a> Links<'a> {
    /// Groups the ranges of all traces by anchor.
    pub fn new(shown: &'a Shown<'a>, setup: &Setup) -> Self {
        Self { shown, anchors: of_anchors(shown.recording, setup, shown.traces) }
    }

    /// The residuals of each anchor's ranges, with twice their standard deviation on either side.
    pub fn residuals(&self, id: &str) -> Figure {
        let centimetres = |metres: f64| 100.0 * metres;
        let taken = |it: &Judged| it.residual_m.filter(|_| it.taken).map(centimetres);
        let mut figure = Figure::new(id, "Residuals")
            .over_seconds("residual of a range, cm")
            .caption(
                "What was measured less what was expected, anchor by anchor, before the range is taken in (of methods \
                 that solve each epoch by itself: after); 95 % lie between the broken lines of ±2σ if the model is right. An anchor that measures too long lies above zero.",
            );
        figure.series.extend(
            self.names().map(|(anchor, name)| self.over_time(name, Mark::Dots, anchor, taken)),
        );
        figure.series.push(self.left_out(|it| it.residual_m.map(centimetres)));
        for (sign, words) in [(2.0, "+2σ"), (-2.0, "−2σ")] {
            for (anchor, name) in self.names() {
                let bound = |it: &Judged| it.sigma_m.map(|sigma| sign * centimetres(sigma));
                let line = self.over_time(format!("{name} {words}"), Mark::Dashes, anchor, bound);
                figure.series.push(Series { hidden: self.anchors.len() > FEW, ..line });
            }
        }
        figure
    }

    /// The normalised innovations squared of each anchor, with the 95 % bound.
    pub fn nis(&self, id: &str) -> Figure {
        let taken = |it: &Judged| it.nis.filter(|_| it.taken);
        let bound = |_: usize, trace: &Trace| {
            let ends = [trace.epochs.first(), trace.epochs.last()].into_iter().flatten();
            ends.map(|epoch| (epoch.time_us, CHI_SQUARE_1)).collect()
        };
        Figure::new(id, "NIS")
            .over_seconds("NIS of a range")
            .logarithmic()
            .showing(None, Some([1e-2, 1e3]))
            .caption(
                "Normalised innovations squared: 95 % are below the line if the model is right. An anchor of which more are above it is \
                 worse than the tracker believes.",
            )
            .with_all(self.names().map(|(anchor, name)| self.over_time(name, Mark::Dots, anchor, taken)))
            .with(self.left_out(|it| it.nis))
            .with(self.shown.over_time("95 %", Mark::Dashes, bound).coloured(Colour::Limit))
    }

    /// The recent share of rejected ranges of each anchor.
    pub fn rejections(&self, id: &str) -> Figure {
        let share = |(anchor, name): (usize, &str)| {
            let ranges = self.anchors.get(anchor).map_or(&[][..], Vec::as_slice);
            let (mut first, mut rejected) = (0, 0);
            let points = ranges.iter().enumerate().map(|(last, it)| {
                rejected += usize::from(!it.taken);
                while let Some(old) = ranges.get(first).filter(|old| is_over(old, it)) {
                    rejected -= usize::from(!old.taken);
                    first += 1;
                }
                (*it, 100.0 * rejected as f64 / (last + 1 - first) as f64)
            });
            self.line(name, Mark::Line, anchor, points)
        };
        Figure::new(id, "Ranges left out")
            .over_seconds("left out of the last 10 s, %")
            .showing(None, Some([0.0, 100.0]))
            .caption(
                "The share of each anchor's ranges that the tracker left out of the last ten seconds: a line that stands above the others \
                 is an anchor behind something, or one whose place is wrong.",
            )
            .with_all(self.names().map(share))
    }

    fn names(&self) -> impl Iterator<Item = (usize, &str)> {
        self.shown.recording.anchors.names.iter().map(String::as_str).enumerate()
    }

    /// A quantity of an anchor's ranges over time, where it is known.
    fn over_time(
        &self,
        name: impl Into<String>,
        mark: Mark,
        anchor: usize,
        value: impl Fn(&Judged) -> Option<f64>,
    ) -> Series {
        let ranges = self.anchors.get(anchor).into_iter().flatten();
        let points = ranges.filter_map(|it| Some((*it, value(it)?)));
        self.line(name, mark, anchor, points)
    }

    /// Points over time in an anchor's colour, with a gap after each part.
    fn line(
        &self,
        name: impl Into<String>,
        mark: Mark,
        anchor: usize,
        points: impl Iterator<Item = (Judged, f64)>,
    ) -> Series {
        let (mut xs, mut ys) = (Vec::new(), Vec::new());
        let mut before = None;
        for (judged, value) in points {
            if before.is_some_and(|part| part != judged.part) {
                xs.push(xs.last().copied().unwrap_or_default());
                ys.push(f64::NAN);
            }
            before = Some(judged.part);
            xs.push(self.shown.seconds(judged.part, judged.time_us));
            ys.push(value);
        }
        Series::new(name, mark, xs, ys).coloured(Colour::Other(anchor))
    }

    /// The rejected ranges of all anchors.
    fn left_out(&self, value: impl Fn(&Judged) -> Option<f64>) -> Series {
        let rejected = self.anchors.iter().flatten().filter(|it| !it.taken);
        let point = |it: &Judged| Some((self.shown.seconds(it.part, it.time_us), value(it)?));
        let mut points: Vec<_> = rejected.filter_map(point).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (xs, ys) = points.into_iter().unzip();
        Series::new("left out", Mark::Crosses, xs, ys).coloured(Colour::Alarm)
    }
}

/// Whether a range is outside the window, or of another part.
fn is_over(old: &Judged, now: &Judged) -> bool {
    old.part != now.part || old.time_us < now.time_us - LATELY_US
}
