//! Estimates against the truth.

use serde::Serialize;

use crate::metrics::rms;
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
}

impl Accuracy {
    /// Of a flight, if there is a truth.
    pub fn of(Track { flight, followed }: &Track) -> Option<Self> {
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
        Some(Self { samples: errors.len(), rmse: since(i64::MIN), late_rmse: since(middle) })
    }
}
