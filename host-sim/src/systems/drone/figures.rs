//! What a flight looks like, measurement by measurement.

mod cloud;
pub mod streams;

use kestirim_air_to_ground::Channel;
use kestirim_replay::drone::{EnvironmentKind, Estimate, Quantity, Track};

use super::recording::Recording;
use super::settings::{channel, expected_loss_db};
use super::simulate::{moving_user, trajectory};
use crate::figure::{Colour, Figure, Mark, Series};
use crate::system::{Answer, Settings};

/// The page's figures, and which measurement they show.
pub(super) fn draw(recording: &Recording, settings: &Settings, track: &Track, answer: &mut Answer) {
    let now = track.now(settings.number("step"));
    answer.fact("step", format!("{} of {}", now + 1, track.estimates.len()));
    let synthetic = || Some(settings.chosen::<EnvironmentKind>("environment").channel());
    let (channel, plane_m) = match recording {
        Recording::Moving => (synthetic(), Some(moving_user::SIDE_M)),
        Recording::Staying => (synthetic(), Some(trajectory::SIDE_M)),
        // A level says nothing of what is lost in between.
        Recording::Flight(recorded) if recorded.flight.quantity == Quantity::PathLoss => {
            (channel(settings), None)
        }
        Recording::Flight(_) => (None, None),
    };
    let drawing = Drawing { recording, track, now, channel };
    let errors = track.estimates.iter().map(|estimate| track.error_m(estimate).unwrap_or(f64::NAN));
    let spread = track.estimates.iter().map(|estimate| estimate.sd_m).collect();
    let error = [("error", Colour::Ours, errors.collect())];
    let mut spreads = vec![("spread, m", Colour::Ours, spread)];
    if plane_m.is_some() {
        let effective = track.estimates.iter().map(|it| it.effective().unwrap_or(f64::NAN));
        spreads.push(("effective particles", Colour::Other(1), effective.collect()));
    }
    answer.figures = vec![
        drawing.map(plane_m),
        drawing.over_time("error", ("Error", "distance of the estimate from the user, m"), error),
        drawing.over_time(
            "spread",
            ("Spread of what is believed, and how many particles count", "m; particles"),
            spreads,
        ),
        drawing.losses(),
    ];
}

/// A track, and which of its estimates is looked at.
struct Drawing<'a> {
    recording: &'a Recording,
    track: &'a Track,
    /// Counted from 0.
    now: usize,
    /// By whose channel losses are expected, if that is known.
    channel: Option<Channel<f64>>,
}

impl Drawing<'_> {
    /// The plane in which the user is, as it is believed to be now.
    fn map(&self, plane_m: Option<f64>) -> Figure {
        let track = self.track;
        let begin = track.stops.first().map_or(0.0, |stop| stop.t);
        let so_far = &track.estimates[..=self.now];
        let shown = &so_far[self.now];
        let stop = track.stop(shown);
        let stops = &track.stops[..=shown.stop];
        let flown = Series::path("drone", stops.iter().map(|stop| stop.place));
        let users = so_far.iter().filter_map(|it| Some((track.seconds(it), track.user(it)?)));
        let (user_times, users): (Vec<_>, Vec<_>) = users.unzip();
        let plane = plane_m.map(|side_m| [-0.02 * side_m, 1.02 * side_m]);
        let mut figure = Figure::new("map", "Where the user is")
            .axes("x, m", "y, m")
            .map()
            .caption(
                "Particles or points of the posterior after this measurement; tracks up to it.",
            )
            .showing(plane, plane);
        if let Recording::Flight(recorded) = self.recording {
            let border = recorded.area.iter().flat_map(|area| {
                // Back to the first corner.
                area.corners().iter().chain(area.corners().first()).copied()
            });
            let border = Series::path("area", border).marked(Mark::Dashes);
            figure = figure.with(border.coloured(Colour::Truth));
        }
        if let Some(cloud) = &shown.cloud {
            figure = cloud::on(figure, cloud);
        }
        let user = track.user(shown).into_iter();
        let estimates = so_far.iter().map(|estimate| estimate.place);
        figure
            .with(flown.timed(stops.iter().map(|it| it.t - begin)).coloured(Colour::Other(1)))
            .with(Series::path("user", users).timed(user_times).coloured(Colour::Truth))
            .with(
                Series::path("estimates", estimates)
                    .timed(so_far.iter().map(|it| track.seconds(it)))
                    .coloured(Colour::Ours)
                    .hidden(),
            )
            .with(marked(
                "drone now",
                stop.place,
                format!("{:.0} m", stop.height),
                Colour::Other(1),
            ))
            .with_all(user.map(|user| marked("user now", user, "user".to_owned(), Colour::Alarm)))
            .with(marked("estimate now", shown.place, String::new(), Colour::Ours))
    }

    /// Values after each measurement, each with a name and a colour.
    fn over_time(
        &self,
        id: &str,
        (title, label): (&str, &str),
        lines: impl IntoIterator<Item = (&'static str, Colour, Vec<f64>)>,
    ) -> Figure {
        let times: Vec<f64> =
            self.track.estimates.iter().map(|it| self.track.seconds(it)).collect();
        let lines: Vec<_> = lines.into_iter().collect();
        let highest = lines.iter().flat_map(|(.., values)| values).copied().fold(0.0, f64::max);
        let now = Series::path("now", [[times[self.now], 0.0], [times[self.now], highest]]);
        let lines = lines.into_iter().map(|(name, colour, values)| {
            Series::line(name, times.clone(), values).coloured(colour)
        });
        Figure::new(id, title)
            .over_seconds(label)
            .caption(
                "The broken line is now. What needs the truth is not shown where nobody knows it.",
            )
            .with_all(lines)
            .with(now.marked(Mark::Dashes).coloured(Colour::Truth))
    }

    /// What was measured, and what the channel expects where it is known.
    fn losses(&self) -> Figure {
        let track = self.track;
        let begin = track.stops.first().map_or(0.0, |stop| stop.t);
        let (times, losses) = track.stops.iter().map(|stop| (stop.t - begin, stop.loss)).unzip();
        let expected = |name: &str, place: &dyn Fn(&Estimate) -> Option<[f64; 2]>, colour| {
            let channel = self.channel.as_ref()?;
            let points = track.estimates.iter().filter_map(|estimate| {
                let stop = track.stop(estimate);
                let loss = expected_loss_db(channel, &stop, place(estimate)?)?;
                Some([track.seconds(estimate), loss])
            });
            let (times, losses) = points.map(|[t, loss]| (t, loss)).unzip();
            Some(Series::line(name, times, losses).coloured(colour))
        };
        let at_user = expected("expected at the user", &|it| track.user(it), Colour::Truth);
        let at_estimate = expected("expected at the estimate", &|it| Some(it.place), Colour::Ours);
        Figure::new("path-loss", "Path loss")
            .over_seconds("path loss, or negative level, dB")
            .caption("What is expected is the channel's mean, with and without a line of sight.")
            .with(Series::new("measured", Mark::Dots, times, losses).coloured(Colour::Other(4)))
            .with_all(at_user)
            .with_all(at_estimate)
    }
}

/// A single place with a word beside it.
fn marked(name: &str, place: [f64; 2], label: String, colour: Colour) -> Series {
    Series::points(name, [place]).labelled(vec![label]).coloured(colour)
}
