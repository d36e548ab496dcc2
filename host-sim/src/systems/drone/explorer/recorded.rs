//! A recorded flight.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::super::area::{self, Area};
use super::super::flight::{self, Flight};
use super::super::scenario::EnvironmentKind;
use super::super::search::Estimate;
use super::super::survey::Survey;
use super::figures::marked;
use super::remembered::Remembered;
use super::{ENVIRONMENTS, environment};
use crate::Error;
use crate::explore::{Answer, Control, Explorer, Settings};
use crate::figure::{Colour, Figure, Mark, Series};
use crate::metrics::distance;

/// A flight as far as it is used, and where the user is after each measurement.
type Found = (Survey, Vec<Estimate>);

/// What was read, and what was last found in it.
#[derive(Debug)]
pub(super) struct Recorded {
    log: PathBuf,
    flight: Flight,
    area: Option<Box<Area>>,
    truth: Option<[f64; 2]>,
    last: Remembered<Option<EnvironmentKind>, Found>,
}

impl Recorded {
    /// Reads the files.
    ///
    /// # Errors
    /// The file, the line, and what was expected there.
    pub(super) fn open(
        log: &Path,
        area: Option<&Path>,
        truth: Option<&Path>,
    ) -> Result<Self, Error> {
        let (flight, log) = (flight::read(log)?, log.to_path_buf());
        let area = area.map(area::read).transpose()?;
        let truth = truth.map(flight::read_truth).transpose()?;
        let recorded = Self { log, flight, area, truth, last: Remembered::default() };
        // What is asked for first; and what is too short to be used is told now.
        recorded.found(None)?;
        Ok(recorded)
    }

    /// What is found after each measurement.
    fn found(&self, environment: Option<EnvironmentKind>) -> Result<Arc<Found>, Error> {
        self.last.of(environment, |&environment| {
            let (flight, area) = (self.flight.clone(), self.area.clone());
            let survey = Survey::new(&self.log, flight, self.truth, area, environment)?;
            let estimates = survey.find(&survey.search(false).with_clouds());
            if estimates.is_empty() { Err(survey.nowhere()) } else { Ok((survey, estimates)) }
        })
    }
}

impl Explorer for Recorded {
    fn controls(&self) -> Vec<Control> {
        let most = self.flight.stops.len().max(2) as f64;
        let mut environments = vec![("open", "nothing: open ground")];
        environments.extend(ENVIRONMENTS);
        vec![
            Control::playable("step", "measurement", "", [1.0, most, 1.0], most),
            Control::choice("environment", "what is built", &environments),
        ]
    }

    fn answer(&self, settings: &Settings) -> Result<Answer, Error> {
        let built = settings.choice("environment") != "open";
        let run = self.found(built.then(|| environment(settings)))?;
        let (survey, estimates) = &*run;
        let mut answer = Answer { warnings: survey.warnings.clone(), ..Answer::default() };
        if estimates.len() < survey.flight.stops.len() {
            let left_out = "some measurements are explained by no place: left out";
            answer.warnings.push(left_out.to_owned());
        }
        let now = (settings.number("step") as usize).clamp(1, estimates.len()) - 1;
        let found = &estimates[now];
        answer.fact("measurement", format!("{} of {}", now + 1, estimates.len()));
        answer.fact("place", format!("{:.1} m, {:.1} m", found.place[0], found.place[1]));
        answer.fact("standard deviation", format!("{:.1} m", found.sd_m));
        if let Some(level) = found.level_db {
            answer.fact("level", format!("{level:.1} dB"));
        }
        if let Some(truth) = self.truth {
            answer.fact("error", format!("{:.1} m", distance(found.place, truth)));
        }
        let begin = survey.flight.stops.first().map_or(0.0, |stop| stop.t);
        let times: Vec<f64> = estimates.iter().map(|found| found.t - begin).collect();
        answer.figures.push(map(survey, estimates, now));
        let errors = self.truth.map_or_else(Vec::new, |truth| {
            estimates.iter().map(|found| distance(found.place, truth)).collect()
        });
        answer.figures.push(over_time(
            ("error", "Error", "distance of the estimate from the truth, m"),
            &times,
            errors,
            now,
        ));
        let spread = estimates.iter().map(|found| found.sd_m).collect();
        answer.figures.push(over_time(
            ("spread", "Standard deviation", "standard deviation of the place, m"),
            &times,
            spread,
            now,
        ));
        let stops = &survey.flight.stops;
        let (times, losses) = stops.iter().map(|stop| (stop.t - begin, stop.loss)).unzip();
        answer.figures.push(
            Figure::new("path-loss", "Path loss")
                .axes("t, s", "path loss, or negative level, dB")
                .with(
                    Series::new("measured", Mark::Dots, times, losses).coloured(Colour::Other(4)),
                ),
        );
        Ok(answer)
    }
}

fn map(survey: &Survey, estimates: &[Estimate], now: usize) -> Figure {
    let found = &estimates[now];
    let so_far = survey.flight.stops.iter().filter(|stop| stop.t <= found.t);
    let border = survey.area.iter().flat_map(|area| {
        // Back to the first corner.
        area.corners().iter().chain(area.corners().first()).copied()
    });
    let mut figure = Figure::new("map", "Where the user is")
        .axes("x, m", "y, m")
        .map()
        .caption("Points of the posterior after this measurement; the flight up to it.")
        .with(Series::path("area", border).marked(Mark::Dashes).coloured(Colour::Truth));
    if let Some(cloud) = &found.cloud {
        figure = cloud.on(figure);
    }
    let truth = survey.truth.into_iter();
    figure
        .with(Series::path("drone", so_far.map(|stop| stop.place)).coloured(Colour::Other(1)))
        .with_all(truth.map(|truth| marked("user", truth, "user".to_owned(), Colour::Alarm)))
        .with(marked("estimate now", found.place, String::new(), Colour::Ours))
}

fn over_time(
    (id, title, label): (&str, &str, &str),
    times: &[f64],
    values: Vec<f64>,
    now: usize,
) -> Figure {
    let highest = values.iter().copied().fold(0.0, f64::max);
    let now = Series::path("now", [[times[now], 0.0], [times[now], highest]]);
    Figure::new(id, title)
        .axes("t, s", label)
        .caption("Nothing is shown where the truth is not known.")
        .with(Series::line(title, times.to_vec(), values))
        .with(now.marked(Mark::Dashes).coloured(Colour::Truth))
}
