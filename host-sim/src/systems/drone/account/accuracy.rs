//! Errors of the estimates relative to the truth.

use kestirim_replay::drone::{Estimate, Track};
use serde::Serialize;

use crate::metrics::error_over_sigma;

/// The interval at which errors are reported, in seconds.
const MINUTE_S: f64 = 60.0;

/// The accuracy of the estimates of a flight.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(super) struct Accuracy {
    /// The distance of the last estimate from the truth (m).
    error_m: f64,
    /// The distance from the truth after each minute since the first measurement.
    error_after_s: Vec<ErrorAfter>,
    /// Whether the last 90 % region contains the truth.
    in_90_percent_region: Option<bool>,
    /// The last error divided by the standard deviation reported with it.
    error_over_sigma: Option<f64>,
}

/// An error at a given time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
struct ErrorAfter {
    /// The time since the first measurement (s).
    s: f64,
    /// The distance of the estimate from the truth (m).
    error_m: f64,
}

impl Accuracy {
    /// The accuracy of a series of estimates; `None` if the truth is not known.
    pub(super) fn of(track: &Track, estimates: &[Estimate]) -> Option<Self> {
        let (first, last) = (estimates.first()?, estimates.last()?);
        let begin = track.stop(first).t;
        let since = |estimate: &Estimate| track.stop(estimate).t - begin;
        let minutes = (since(last) / MINUTE_S).ceil().clamp(1.0, 1000.0) as u32;
        let error_after_s = (1..=minutes).filter_map(|minute| {
            let s = f64::from(minute) * MINUTE_S;
            let last = estimates.iter().rev().find(|estimate| since(estimate) <= s)?;
            Some(ErrorAfter { s, error_m: track.error_m(last)? })
        });
        Some(Self {
            error_m: track.error_m(last)?,
            error_after_s: error_after_s.collect(),
            in_90_percent_region: last.covered,
            error_over_sigma: error_over_sigma([(track.error_m(last)?, last.sd_m)]),
        })
    }

    /// The names and values as text.
    pub(super) fn in_words(&self) -> Vec<(String, String)> {
        let mut words = vec![("error".to_owned(), format!("{:.1} m", self.error_m))];
        words.extend(self.error_after_s.iter().map(|ErrorAfter { s, error_m }| {
            (format!("error after {s} s"), format!("{error_m:.1} m"))
        }));
        words.extend(self.in_90_percent_region.map(|inside| {
            let inside = if inside { "yes" } else { "no" };
            ("in the 90 % region".to_owned(), inside.to_owned())
        }));
        words
    }
}
