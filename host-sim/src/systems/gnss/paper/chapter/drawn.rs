//! Station-days of the experiment, run again with full details.

use kestirim_ppp_filter::Motion;
use kestirim_replay::gnss::{BEGINNING, FilterKind, Followed, Recording};
use nalgebra::Vector3;
use rayon::prelude::*;

use crate::Error;
use crate::figure::Figure;
use crate::metrics::median;
use crate::stream::Stream;
use crate::system::Detail;
use crate::systems::gnss::figures::{self, streams};
use crate::systems::gnss::paper::experiment::{PROCESS_NOISE, Report};
use crate::systems::gnss::recording;
use crate::systems::gnss::settings::Setup;
use crate::systems::gnss::simulate::{Day, Rates};
use crate::systems::gnss::track::Track;

/// The number of station-days drawn; the paper draws three.
const DRAWN: usize = 3;
/// The filters that the paper gives kinematic solutions for, and ours.
const MOVING: [FilterKind; 3] = [FilterKind::Ikf, FilterKind::Adaptive, FilterKind::Default];

/// The filters' results on the first few station-days.
pub(super) struct Days {
    /// The position (ECEF, m) and all static filters of each station-day.
    standing: Vec<(Vector3<f64>, Filters)>,
    /// The kinematic filters of the first station-day.
    moving: Filters,
}

type Filters = Vec<(FilterKind, Followed)>;

impl Days {
    /// Runs the filters.
    ///
    /// # Errors
    /// [`Error::File`] if one finds no position.
    pub(super) fn follow(report: &Report) -> Result<Self, Error> {
        let count = report.trials.min(DRAWN);
        let days: Vec<_> = (0..count as u64)
            .into_par_iter()
            .map(|index| {
                let day = Day::new(report.seed, index, &Rates::RECORDING);
                (day.marker, recording::of_day(day))
            })
            .collect();
        let standing: Result<_, Error> = days
            .par_iter()
            .map(|(marker, day)| Ok((*marker, filters(day, Motion::Static, &FilterKind::ALL)?)))
            .collect();
        let moving = match days.first() {
            Some((_, day)) => {
                filters(day, Motion::Kinematic { process_noise: PROCESS_NOISE }, &MOVING)?
            }
            None => Vec::new(),
        };
        Ok(Self { standing: standing?, moving })
    }

    /// The paper's figure 3: the residuals of the codes.
    pub(super) fn residuals(&self) -> impl Iterator<Item = Figure> {
        let filters = self.standing.first().into_iter().flat_map(|(_, filters)| filters);
        filters.map(|(filter, followed)| {
            let id = format!("gnss-figure-3-{}", filter.name());
            let title = format!(
                "Figure 3: residuals of the codes, {} ({} rejected)",
                filter.title(),
                followed.rejected.code
            );
            let figure = figures::residuals::left(Figure::new(id, title), followed, |report| &report.code);
            figure.showing(None, Some([-34.0, 34.0])).caption(
                "Residuals over √(Qᵥ/γ), without the rejected codes: outliers stand out of the plain filter's, some \
                 out of the t-test's, and none out of the others'; near ones are thinned.",
            )
        })
    }

    /// The paper's figure 4: errors of static filters, each with the day's number.
    pub(super) fn standing(&self) -> impl Iterator<Item = (usize, Figure)> {
        (1..).zip(&self.standing).map(|(day, (marker, filters))| {
            let figure = Figure::new(
                format!("gnss-figure-4-{day}"),
                format!("Figure 4: 3-D error of static filters, station-day {day}"),
            );
            let figure = figures::errors(figure, of(filters), marker).caption(
                "Slips that nothing shows spoil the plain filter for hours; worst first (IKF, which UKF equals) and \
                 the default leave them out.",
            );
            (day, figure)
        })
    }

    /// The paper's figure 5: errors of kinematic filters.
    pub(super) fn moving(&self) -> Figure {
        let figure =
            Figure::new("gnss-figure-5", "Figure 5: 3-D error of kinematic filters, station-day 1");
        figures::errors(figure, of(&self.moving), &self.place()).caption(
            "Slips that the paper's filters do not know pull the receiver away until the satellite sets; the default \
             begins those ambiguities anew.",
        )
    }

    /// A figure of our own: whether the default filter reports its accuracy correctly.
    pub(super) fn trusted(&self) -> Figure {
        let figure = Figure::new(
            "gnss-deviation",
            "Standard deviations that the default reports, and its error",
        );
        let Some(followed) = self.best() else { return figure };
        let place = self.place();
        let reported = followed.fixes.iter().zip(&followed.deviations);
        let ratios = reported.skip_while(|(fix, _)| fix.t < BEGINNING).map(|(fix, deviations)| {
            (fix.position - place).norm() / Vector3::from(*deviations).norm()
        });
        let ratio = median(&ratios.collect::<Vec<_>>());
        figures::position::deviations(figure, followed, Some(&place)).caption(format!(
            "After the first hour the error is {ratio:.1} times the deviation in three dimensions (median)."
        ))
    }

    /// The streams of the first day with the default filter.
    pub(super) fn streams(&self) -> Vec<Stream> {
        self.best().map_or_else(Vec::new, |it| streams::streams(it, &self.place(), true))
    }

    fn place(&self) -> Vector3<f64> {
        self.standing.first().map_or_else(Vector3::zeros, |(marker, _)| *marker)
    }

    fn best(&self) -> Option<&Followed> {
        let (_, filters) = self.standing.first()?;
        filters.iter().find(|(filter, _)| *filter == FilterKind::Default).map(|(_, it)| it)
    }
}

fn of(filters: &Filters) -> impl Iterator<Item = (FilterKind, &Followed)> {
    filters.iter().map(|(filter, followed)| (*filter, followed))
}

fn filters(
    recording: &Recording,
    motion: Motion,
    filters: &[FilterKind],
) -> Result<Filters, Error> {
    let follow = |&filter: &FilterKind| {
        Ok(Track::of(recording, &Setup::new(filter, motion), Detail::Every)?.filters)
    };
    let each: Vec<Filters> = filters.par_iter().map(follow).collect::<Result<_, Error>>()?;
    Ok(each.concat())
}
