//! The accuracy of estimates relative to the truth.

use serde::Serialize;

use crate::metrics::{error_over_sigma, rms};
use crate::systems::uav::track::Track;

/// The accuracy of the estimates of a flight.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Accuracy {
    /// The number of lines at times of the truth.
    pub samples: usize,
    /// The root mean square errors of α, q, V, θ, if their truth is known.
    pub rmse: [Option<f64>; 4],
    /// The root mean square errors over the second half of the log.
    pub late_rmse: [Option<f64>; 4],
    /// The root mean square errors over the second half divided by the root mean square standard deviations; `None` for
    /// an observer, which has none.
    pub error_over_sigma: [Option<f64>; 4],
}

impl Accuracy {
    /// The accuracy of a flight, if there is a truth.
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
