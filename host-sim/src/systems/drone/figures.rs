//! Figures of a flight, measurement by measurement.

mod cloud;
mod knowledge;
mod losses;
pub mod streams;

use kestirim_replay::drone::{EnvironmentKind, Quantity, Track};

use self::losses::Predicted;
use super::recording::Recording;
use super::settings::channel;
use super::simulate::{moving_user, trajectory};
use crate::figure::{Colour, Figure, Mark, Series};
use crate::system::{Answer, Settings};

/// Adds the page's figures, and the measurement that they show.
pub(super) fn draw(recording: &Recording, settings: &Settings, track: &Track, answer: &mut Answer) {
    let now = track.now(settings.number("step"));
    answer.fact("step", format!("{} of {}", now + 1, track.estimates.len()));
    let synthetic = || Some(settings.chosen::<EnvironmentKind>("environment").channel());
    let (channel, plane_m) = match recording {
        Recording::Moving => (synthetic(), Some(moving_user::SIDE_M)),
        Recording::Staying => (synthetic(), Some(trajectory::SIDE_M)),
        // A received level does not tell the path loss.
        Recording::Flight(recorded) if recorded.flight.quantity == Quantity::PathLoss => {
            (channel(settings), None)
        }
        Recording::Flight(_) => (None, None),
    };
    let predicted = Predicted::of(track, channel.as_ref());
    if let Some(share) = Predicted::share(&predicted) {
        let within = format!("{:.0} % of {}", 100.0 * share, predicted.len());
        answer.fact("measured within the predicted 95 % band", within);
    }
    let drawing = Drawing { recording, track, now };
    let errors = track.estimates.iter().map(|estimate| track.error_m(estimate).unwrap_or(f64::NAN));
    let spread = track.estimates.iter().map(|estimate| estimate.sd_m).collect();
    let searched_m2 = match recording {
        Recording::Flight(recorded) => recorded.area.as_ref().map(|area| area.size()),
        Recording::Moving | Recording::Staying => plane_m.map(|side_m| side_m * side_m),
    };
    let known = knowledge::regions(track);
    answer.figures = vec![
        drawing.map(plane_m),
        drawing.over_time(
            "error",
            ("Error", "distance of the estimate from the user, m"),
            ("error", errors.collect()),
        ),
        drawing.over_time("spread", ("Spread of what is believed", "m"), ("spread, m", spread)),
        losses::figure(track, channel.as_ref(), &predicted),
        cloud::at_moments(track, &known),
        knowledge::region(&known),
        knowledge::information(&known, searched_m2),
        knowledge::effective(&known),
    ];
}

/// A track, and the estimate of it that is shown.
struct Drawing<'a> {
    recording: &'a Recording,
    track: &'a Track,
    /// The index of the estimate shown, counted from 0.
    now: usize,
}

impl Drawing<'_> {
    /// The map of the user's plane, with the belief at the estimate shown.
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
                // The border closes at the first corner.
                area.corners().iter().chain(area.corners().first()).copied()
            });
            let border = Series::path("area", border).marked(Mark::Dashes);
            figure = figure.with(border.coloured(Colour::Truth));
        }
        if let Some(cloud) = &shown.cloud {
            figure = cloud::on(figure, cloud);
        }
        let user = track.user(shown).into_iter();
        let next = shown.next.map(|next| {
            marked("next waypoint", next.place, "measure here".to_owned(), Colour::Other(2))
        });
        let others = track.others.iter().filter_map(|other| {
            let name = format!("transmitter {}", other.name);
            Some(marked(&name, other.estimate.as_ref()?.place, other.name.clone(), Colour::Ours))
        });
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
            .with_all(next)
            .with_all(others)
    }

    /// A figure of a named value after each measurement.
    fn over_time(
        &self,
        id: &str,
        (title, label): (&str, &str),
        (name, values): (&str, Vec<f64>),
    ) -> Figure {
        let times: Vec<f64> =
            self.track.estimates.iter().map(|it| self.track.seconds(it)).collect();
        let highest = values.iter().copied().fold(0.0, f64::max);
        let now = Series::path("now", [[times[self.now], 0.0], [times[self.now], highest]]);
        Figure::new(id, title)
            .over_seconds(label)
            .caption(
                "The broken line is now. What needs the truth is not shown where nobody knows it.",
            )
            .with(Series::line(name, times, values).coloured(Colour::Ours))
            .with(now.marked(Mark::Dashes).coloured(Colour::Truth))
    }
}

/// A single labelled position.
fn marked(name: &str, place: [f64; 2], label: String, colour: Colour) -> Series {
    Series::points(name, [place]).labelled(vec![label]).coloured(colour)
}
