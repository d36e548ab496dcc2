//! Samples of each satellite.

use std::collections::BTreeSet;

use crate::error::Warning;
use crate::text::Text;
use crate::time::GpsTime;

/// Times closer than this are the same instant written twice, s.
const SAME: f64 = 1e-3;

/// Samples by satellite number.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct PerSatellite<S>(Vec<Vec<S>>);

impl<S> Default for PerSatellite<S> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

impl<S> PerSatellite<S> {
    pub(crate) fn push(&mut self, prn: u8, sample: S) {
        let place = usize::from(prn);
        if self.0.len() <= place {
            self.0.resize_with(place + 1, Vec::new);
        }
        self.0[place].push(sample);
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.0.iter().all(Vec::is_empty)
    }

    pub(crate) fn of(&self, prn: u8) -> &[S] {
        self.0.get(usize::from(prn)).map_or(&[], Vec::as_slice)
    }

    pub(crate) fn numbers(&self) -> impl Iterator<Item = u8> {
        (0..=u8::MAX).zip(&self.0).filter(|(_, samples)| !samples.is_empty()).map(|(prn, _)| prn)
    }

    /// Merges the samples of files in chronological order. Of two samples of the same instant, that of the file that
    /// begins later stays, `complete`d by the other.
    pub(crate) fn merge(
        mut files: Vec<Self>,
        time: impl Fn(&S) -> GpsTime,
        mut complete: impl FnMut(&S, &mut S),
    ) -> Self {
        let seconds = |sample: &S| time(sample).since(GpsTime::new(51_544, 0.0));
        let begin =
            |file: &Self| file.0.iter().flatten().map(seconds).fold(f64::INFINITY, f64::min);
        files.sort_by(|a, b| begin(a).total_cmp(&begin(b)));
        let mut merged = Self::default();
        for (prn, samples) in files.into_iter().flat_map(|file| (0..=u8::MAX).zip(file.0)) {
            for sample in samples {
                merged.push(prn, sample);
            }
        }
        for samples in &mut merged.0 {
            // The sort is stable: of equal times the one read later stays last.
            samples.sort_by(|a, b| seconds(a).total_cmp(&seconds(b)));
            samples.dedup_by(|later, earlier| {
                let same = seconds(later) - seconds(earlier) < SAME;
                if same {
                    complete(earlier, later);
                    std::mem::swap(earlier, later);
                }
                same
            });
        }
        merged
    }
}

/// Instants at which files contradict each other.
#[derive(Debug, Default)]
pub(crate) struct Differing(BTreeSet<(i32, i64)>);

impl Differing {
    pub(crate) fn add(&mut self, time: GpsTime) {
        self.0.insert((time.day(), (time.second() * 1e3) as i64));
    }

    /// A warning if files differ at more instants than those at which one day ends and the next begins.
    pub(crate) fn warning(&self, texts: &[Text], what: &str) -> Option<Warning> {
        let count = self.0.len();
        let first = texts.first().filter(|_| texts.len() > 1 && count > texts.len())?;
        Some(first.warning(format!(
            "this file and the others differ in {what} at {count} times, the one that begins later is taken: of two services?"
        )))
    }
}
