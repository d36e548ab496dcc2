//! Figures of a flight, frame by frame.

use super::super::film::Frame;
use super::super::scenario::EnvironmentKind;
use crate::explore::Answer;
use crate::figure::{Colour, Figure, Mark, Series};
use crate::metrics::mean;

/// A line over all steps: its name, its colour, and its value in a frame.
type Line<'a> = (&'a str, Colour, &'a dyn Fn(&Frame) -> f64);

/// A film, and which of its frames is looked at.
pub(super) struct Film<'a> {
    /// All.
    pub(super) frames: &'a [Frame],
    /// Counted from 0.
    pub(super) now: usize,
    /// Side of the square in which the user is, m.
    pub(super) side_m: f64,
    /// By whose channel losses are expected.
    pub(super) environment: EnvironmentKind,
}

impl<'a> Film<'a> {
    /// Looking at a step, counted from 1, or the last one before it.
    pub(super) fn new(
        frames: &'a [Frame],
        step: f64,
        side_m: f64,
        environment: EnvironmentKind,
    ) -> Self {
        let now = (step as usize).clamp(1, frames.len().max(1)) - 1;
        Self { frames, now, side_m, environment }
    }

    /// All facts and figures.
    pub(super) fn tell(&self, answer: &mut Answer) {
        let Some(frame) = self.frames.get(self.now) else { return };
        let errors: Vec<f64> = self.frames.iter().map(Frame::error_m).collect();
        answer.fact("step", format!("{} of {}", self.now + 1, self.frames.len()));
        answer.fact("error now", format!("{:.1} m", frame.error_m()));
        answer.fact("mean error of all steps", format!("{:.1} m", mean(&errors)));
        answer.fact("spread of the cloud", format!("{:.1} m", frame.cloud.spread()));
        answer.fact("effective particles", format!("{:.0}", frame.cloud.effective));
        answer.fact("loss measured", format!("{:.1} dB", frame.loss_db));
        if let Some(expected) = frame.expected_db(self.environment, frame.estimate) {
            answer.fact("loss expected at the estimate", format!("{expected:.1} dB"));
        }
        answer.figures.push(self.map(frame));
        answer.figures.push(self.over_steps(
            "error",
            ("Error", "distance of the estimate from the user, m"),
            [("error", Colour::Ours, &|frame: &Frame| frame.error_m())],
        ));
        answer.figures.push(self.over_steps(
            "spread",
            ("Spread of the cloud, and how many particles count", "m; particles"),
            [
                ("spread, m", Colour::Ours, &|frame: &Frame| frame.cloud.spread()),
                ("effective particles", Colour::Other(1), &|frame| frame.cloud.effective),
            ],
        ));
        answer.figures.push(self.losses());
    }

    /// The plane in which the user is, as it is believed to be now.
    fn map(&self, frame: &Frame) -> Figure {
        let so_far = self.frames.iter().take(self.now + 1);
        let drones = so_far.clone().map(|frame| [frame.drone[0], frame.drone[1]]);
        let users = so_far.clone().map(|frame| frame.user);
        let estimates = so_far.map(|frame| frame.estimate);
        let [x, y, height] = frame.drone;
        let room = 0.02 * self.side_m;
        let plane = Some([-room, self.side_m + room]);
        let figure = Figure::new("map", "Where the user is")
            .axes("x, m", "y, m")
            .map()
            .caption("Particles after this step's measurement; tracks up to it.")
            .showing(plane, plane);
        frame
            .cloud
            .on(figure)
            .with(Series::path("drone", drones).coloured(Colour::Other(1)))
            .with(Series::path("user", users).coloured(Colour::Truth))
            .with(Series::path("estimates", estimates).coloured(Colour::Ours).hidden())
            .with(marked("drone now", [x, y], format!("{height:.0} m"), Colour::Other(1)))
            .with(marked("user now", frame.user, "user".to_owned(), Colour::Alarm))
            .with(marked("estimate now", frame.estimate, String::new(), Colour::Ours))
    }

    fn over_steps<const N: usize>(
        &self,
        id: &str,
        (title, label): (&str, &str),
        lines: [Line<'_>; N],
    ) -> Figure {
        let values = |of: &dyn Fn(&Frame) -> f64| self.frames.iter().map(of).collect::<Vec<_>>();
        let all: Vec<_> =
            lines.into_iter().map(|(name, colour, of)| (name, colour, values(of))).collect();
        let highest = all.iter().flat_map(|(.., values)| values).copied().fold(0.0, f64::max);
        let now = step(self.now);
        let figure =
            Figure::new(id, title).axes("step", label).caption("All steps; the line is now.");
        let lines = all.into_iter().map(|(name, colour, values)| {
            Series::line(name, self.steps(), values).coloured(colour)
        });
        let now = Series::path("now", [[now, 0.0], [now, highest]]);
        figure.with_all(lines).with(now.marked(Mark::Dashes).coloured(Colour::Truth))
    }

    fn losses(&self) -> Figure {
        let expected = |place: fn(&Frame) -> [f64; 2]| -> Vec<f64> {
            let of = |frame: &Frame| frame.expected_db(self.environment, place(frame));
            self.frames.iter().map(|frame| of(frame).unwrap_or(f64::NAN)).collect()
        };
        let measured = self.frames.iter().map(|frame| frame.loss_db).collect();
        let at_user = Series::line("expected at the user", self.steps(), expected(|f| f.user));
        let at_estimate =
            Series::line("expected at the estimate", self.steps(), expected(|f| f.estimate));
        Figure::new("path-loss", "Path loss")
            .axes("step", "path loss, dB")
            .caption("What is expected is the channel's mean, with and without a line of sight.")
            .with(
                Series::new("measured", Mark::Dots, self.steps(), measured)
                    .coloured(Colour::Other(4)),
            )
            .with(at_user.coloured(Colour::Truth))
            .with(at_estimate.coloured(Colour::Ours))
    }

    fn steps(&self) -> Vec<f64> {
        (0..self.frames.len()).map(step).collect()
    }
}

/// Steps are counted from 1.
fn step(index: usize) -> f64 {
    index as f64 + 1.0
}

/// A single place with a word beside it.
pub(super) fn marked(name: &str, place: [f64; 2], label: String, colour: Colour) -> Series {
    Series::points(name, [place]).labelled(vec![label]).coloured(colour)
}
