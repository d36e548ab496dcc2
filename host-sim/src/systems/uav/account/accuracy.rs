//! Estimates against the truth.

use serde::Serialize;

use crate::metrics::{error_over_sigma, rms};
use crate::systems::uav::track::Track;

/// How good the estimates are.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Accuracy {
    /// Lines whose time is one of the truth's.
    pub samples: usize,
    /// Root mean square errors of α, q, V, θ, where their truth is known.
    pub rmse: [Option<f64>; 4],
    /// The same over the second half of the log.
    pub late_rmse: [Option<f64>; 4],
    /// Those of the second half over the root mean square standard deviations; none of an observer, which knows none.
    pub error_over_sigma: [Option<f64>; 4],
}

impl Accuracy {
    /// Of a flight, if there is a truth.
    pub fn of(Track { flight, followed, .. }: &Track) -> Option<Self> {
        flight.truth.as_ref()?;
        let estimates = &followed.estimates;
        let errors = flight.errors(estimates);
        let middle = estimates.get(estimates.len() / 2).map_or(0, |estimate| estimate.t_us);
        let since = |begin: i64| {
            std::array::from_fn(|column| {
                let counted = errors.iter().filter(|(t_us, _)| *t_us >= begin);
                let errors: Vec<f64> = counted.filter_map(|(_, errors)| errors[column]).collect();
                (!errors.is_empty()).then(|| rms(&errors))
            })
        };
        let sigmas: Vec<_> = estimates.iter().filter_map(|it| Some((it.t_us, it.sigma?))).collect();
        let ratio = |column: usize| {
            let late = errors.iter().filter(|(t_us, _)| *t_us >= middle);
            error_over_sigma(late.filter_map(|(t_us, errors)| {
                let place = sigmas.binary_search_by_key(t_us, |(t_us, _)| *t_us).ok()?;
                Some((errors[column]?, sigmas[place].1[column]))
            }))
        };
        Some(Self {
            samples: errors.len(),
            rmse: since(i64::MIN),
            late_rmse: since(middle),
            error_over_sigma: std::array::from_fn(ratio),
        })
    }
}
