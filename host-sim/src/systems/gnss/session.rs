//! One filter, or all, on one recording.

use std::fmt::Write;
use std::path::Path;

use kestirim_gnss_ppp::Corrections;
use nalgebra::Vector3;
use rayon::prelude::*;

use super::accounts::{Circumstances, Report};
use super::comparison::Comparison;
use super::follow::{Followed, Tally, follow};
use super::model::Epoch;
use super::options::{FilterKind, Mode, Setup};
use super::recording::{Recording, names};
use crate::metrics::median;
use crate::output::LateProgress;
use crate::{Error, output};

/// A recording, and how positions are to be made of it.
#[derive(Debug, Clone, Copy)]
pub struct Session<'a> {
    /// The file of observations, as named by the user.
    pub log: &'a Path,
    /// What was recorded.
    pub recording: &'a Recording,
    /// The part of it that counts: one epoch at least.
    pub epochs: &'a [Epoch],
    /// Whether the receiver may move, and how it is filtered.
    pub setup: Setup,
    /// What is corrected.
    pub corrections: Corrections,
    /// Where the marker really is, ECEF, m.
    pub truth: Option<&'a Vector3<f64>>,
}

impl Session<'_> {
    /// Runs one filter; `with_residuals` keeps what became of each observation.
    ///
    /// # Errors
    /// [`Error::File`] if no epoch has a solution.
    pub fn one(
        &self,
        filter: FilterKind,
        with_residuals: bool,
    ) -> Result<(Report, Followed), Error> {
        let progress = output::late_progress(self.epochs.len() as u64, "epochs");
        let followed = self.follow(filter, with_residuals, &progress);
        let warnings = [self.warnings(&followed), outages(&followed)].concat();
        let report = self.report(filter, &followed, warnings);
        Ok((report.ok_or_else(|| self.unsolved(&followed))?, followed))
    }

    /// Runs all filters; those without a position are left out.
    ///
    /// # Errors
    /// [`Error::File`] if no epoch has a solution.
    pub fn all(&self) -> Result<Comparison, Error> {
        let steps = self.epochs.len() * FilterKind::ALL.len();
        let progress = output::late_progress(steps as u64, "epochs");
        let followed: Vec<_> = FilterKind::ALL
            .into_par_iter()
            .map(|filter| (filter, self.follow(filter, false, &progress)))
            .collect();
        let reports = followed
            .iter()
            .filter_map(|(filter, followed)| self.report(*filter, followed, outages(followed)));
        let filters: Vec<_> = reports.collect();
        // What of the recording serves is the same for all filters.
        let [.., (_, last)] = &*followed else { return Err(self.unsolved(&Followed::default())) };
        if filters.is_empty() {
            return Err(self.unsolved(last));
        }
        let warnings = [self.warnings(last), outages_of_all(&followed)].concat();
        let epochs = self.epochs.len();
        Ok(Comparison { system: "gnss", mode: self.mode(), epochs, filters, warnings })
    }

    fn follow(
        &self,
        filter: FilterKind,
        with_residuals: bool,
        progress: &LateProgress,
    ) -> Followed {
        let receiver = self.recording.receiver(self.corrections);
        let config = self.setup.config(filter);
        follow(self.recording, self.epochs, &receiver, config, with_residuals, || progress.inc())
    }

    fn report(
        &self,
        filter: FilterKind,
        followed: &Followed,
        warnings: Vec<String>,
    ) -> Option<Report> {
        let circumstances = Circumstances {
            filter,
            printed: self.setup.printed,
            mode: self.mode(),
            corrections: self.corrections,
            begin: self.begin(),
            truth: self.truth,
        };
        Report::new(followed, circumstances, warnings)
    }

    const fn mode(&self) -> Mode {
        Mode::of(self.setup.motion)
    }

    fn begin(&self) -> f64 {
        self.recording.seconds(&self.epochs[0])
    }

    /// What a user should know of the files, and of how they fit each other.
    fn warnings(&self, followed: &Followed) -> Vec<String> {
        let mut warnings = self.recording.warnings.clone();
        let mut lacking = |what: &str, count: fn(&Tally) -> usize| {
            let some = followed.satellites.iter().filter(|(_, tally)| count(tally) > 0);
            let total: usize = some.clone().map(|(_, tally)| count(tally)).sum();
            if total > 0 {
                let names = names(some.map(|(&prn, _)| prn));
                let plural = if total == 1 { "" } else { "s" };
                warnings.push(format!("{total} observation{plural} without {what}: {names}"));
            }
        };
        lacking("an orbit", |tally| tally.no_orbit);
        lacking("a clock", |tally| tally.no_clock);
        warnings.extend(self.gaps());
        warnings
    }

    /// A sentence about epochs that are missing.
    fn gaps(&self) -> Option<String> {
        let steps: Vec<f64> =
            self.epochs.windows(2).map(|pair| pair[1].time.since(pair[0].time)).collect();
        let rounded = |seconds: f64| (1e3 * seconds).round() / 1e3;
        let usual = rounded(median(&steps));
        let long = || steps.iter().enumerate().filter(|(_, step)| **step > 1.5 * usual);
        let (first, _) = long().next()?;
        let longest = rounded(long().map(|(_, step)| *step).fold(0.0, f64::max));
        let at = rounded(self.recording.seconds(&self.epochs[first]));
        let (count, plural) = (long().count(), if long().count() == 1 { "" } else { "s" });
        Some(format!(
            "{count} gap{plural} between epochs every {usual} s: the first after {at} s, the longest of \
             {longest} s"
        ))
    }

    /// The complaint that there is no position at all.
    fn unsolved(&self, followed: &Followed) -> Error {
        let mut problem = format!("none of its {} epochs has a solution", followed.epochs);
        if let Some(outage) = followed.outages.first() {
            // Writing to a text does not fail.
            let _ = write!(problem, ": {outage}");
        }
        let [from, to] = self.recording.orbits_span;
        let last = self.epochs.last().map_or(0.0, |epoch| self.recording.seconds(epoch));
        if last < from || self.begin() > to {
            let _ = write!(
                problem,
                "; the orbits are of another time, from {from} s to {to} s where the observations are from {} \
                 s to {last} s",
                self.begin()
            );
        }
        Error::File { path: self.log.to_path_buf(), problem }
    }
}

fn outages(followed: &Followed) -> Vec<String> {
    followed.outages.warnings().collect()
}

/// Sentences about epochs without a solution, with the names of the filters unless that is true of all.
fn outages_of_all(followed: &[(FilterKind, Followed)]) -> Vec<String> {
    let mut sentences: Vec<(String, Vec<&str>)> = Vec::new();
    for (filter, followed) in followed {
        for outage in outages(followed) {
            match sentences.iter_mut().find(|(sentence, _)| *sentence == outage) {
                Some((_, names)) => names.push(filter.name()),
                None => sentences.push((outage, vec![filter.name()])),
            }
        }
    }
    let named = |(sentence, names): (String, Vec<&str>)| {
        if names.len() == followed.len() {
            sentence
        } else {
            format!("{}: {sentence}", names.join(", "))
        }
    };
    sentences.into_iter().map(named).collect()
}
