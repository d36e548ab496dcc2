//! Runs filters over a recording: one, or all for comparison.

use kestirim_replay::gnss::{Epoch, FilterKind, Followed, Order, Pass, Recording, follow};
use nalgebra::Vector3;
use rayon::prelude::*;

use super::settings::Setup;
use crate::system::Detail;
use crate::{Error, output};

/// The results of the filters on a recording; at least one of them found a position.
#[derive(Debug, Clone)]
pub struct Track {
    /// The results of each requested filter, in the order of tables.
    pub filters: Vec<(FilterKind, Followed)>,
    /// The index of the filter that is shown in detail.
    main: usize,
    /// The results of that filter smoothed with those of a backward run, if requested.
    pub smoothed: Option<Followed>,
}

impl Track {
    /// Runs one filter or all. The outcome of each observation is kept for [`Setup::main`] if every detail is wanted.
    ///
    /// # Errors
    /// [`Error::File`] if no epoch has a solution, [`Error::Usage`] if there is no epoch.
    pub fn of(recording: &Recording, setup: &Setup, detail: Detail) -> Result<Self, Error> {
        let epochs = recording.epochs(setup.until);
        if epochs.is_empty() {
            let [first, _] = recording.span();
            let sentence = format!("--until is before the first epoch, which is at {first} s");
            return Err(Error::Usage(sentence));
        }
        let (chosen, main) = (setup.filter.filters(), setup.main());
        let passes = chosen.len() + usize::from(setup.is_smoothed);
        let progress = output::late_progress((epochs.len() * passes) as u64, "epochs");
        let receiver = recording.receiver(setup.corrections);
        let run = |filter: FilterKind, order: Order| {
            let with_residuals =
                detail == Detail::Every && filter == main && order == Order::Forwards;
            let Setup { systems, method, ambiguities, .. } = *setup;
            let pass = Pass { systems, order, method, ambiguities, with_residuals };
            follow(recording, epochs, &receiver, setup.config(filter), pass, &mut || progress.inc())
        };
        let forwards = || -> Vec<_> {
            chosen.par_iter().map(|&filter| (filter, run(filter, Order::Forwards))).collect()
        };
        let backwards = || setup.is_smoothed.then(|| run(main, Order::Backwards));
        let (filters, backwards) = rayon::join(forwards, backwards);
        if filters.iter().all(|(_, followed)| followed.fixes.is_empty()) {
            return Err(unsolved(recording, epochs, &filters));
        }
        let main = chosen.iter().position(|filter| *filter == main).unwrap_or_default();
        let smoothed = backwards.map(|backwards| filters[main].1.smoothed(&backwards));
        Ok(Self { filters, main, smoothed })
    }

    /// The filter that is shown in detail.
    pub fn main(&self) -> &Followed {
        &self.filters[self.main].1
    }

    /// The results that are written as the track: the smoothed ones, if requested.
    pub fn best(&self) -> &Followed {
        self.smoothed.as_ref().unwrap_or_else(|| self.main())
    }

    /// The point relative to which positions are shown (ECEF, m): the truth, or else the last position.
    pub fn about(&self, truth: Option<&Vector3<f64>>) -> Vector3<f64> {
        let filters = self.filters.iter().map(|(_, followed)| followed);
        let last = std::iter::once(self.main()).chain(filters).find_map(|it| it.fixes.last());
        truth.copied().or(last.map(|fix| fix.position)).unwrap_or_default()
    }
}

/// The error that there is no position at all.
fn unsolved(recording: &Recording, epochs: &[Epoch], filters: &[(FilterKind, Followed)]) -> Error {
    let [from, to] = recording.orbits_span;
    let ends = [epochs.first(), epochs.last()];
    let [begin, last] = ends.map(|epoch| epoch.map_or(0.0, |epoch| recording.seconds(epoch)));
    let why = if last < from || begin > to {
        format!(
            ": the orbits are of another time, from {from} s to {to} s, the observations from {begin} s to {last} s"
        )
    } else {
        let outage = filters.last().and_then(|(_, followed)| followed.outages.first());
        outage.map_or_else(String::new, |outage| format!(": {outage}"))
    };
    let problem = format!("none of its {} epochs has a solution{why}", epochs.len());
    Error::File { path: recording.path.clone(), problem }
}
