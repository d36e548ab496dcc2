//! Samples that share a time: packets of a radio, or a clock that is too coarse.

use super::raw::Raw;
use crate::error::Error;

/// The smallest number of samples from which anything is concluded.
const FEWEST: usize = 100;
/// The mean number of samples per time from which shared times are neither an accident nor doubled rows.
const SHARED: usize = 4;

/// Refuses samples that share times, because the time of each is unknown.
///
/// # Errors
/// [`Error::Undecided`] if four or more samples have the same time, on average.
pub(super) fn refuse_shared_times(raw: &[Raw]) -> Result<(), Error> {
    let times = 1 + raw.windows(2).filter(|pair| pair[0].time != pair[1].time).count();
    if raw.len() < FEWEST || raw.len() < SHARED * times {
        return Ok(());
    }
    let each = raw.len() as f64 / times as f64;
    Err(Error::undecided(
        format!("expected a time for each sample, found {each:.0} samples at a time"),
        "their rate, such as --units t=200Hz,",
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn packets_with_one_time_are_refused_and_doubled_rows_are_not() {
        let raw = |k: u32, shared: u32| Raw {
            time: f64::from(k / shared),
            force: [f64::from(k), 0.0, 9.8],
            rate: [0.0; 3],
        };
        for (shared, is_refused) in [(1, false), (2, false), (3, false), (4, true), (10, true)] {
            let raw: Vec<_> = (0..400).map(|k| raw(k, shared)).collect();
            let refused = refuse_shared_times(&raw).map_err(|error| error.to_string());
            assert_eq!(refused.is_err(), is_refused, "{shared} samples at a time: {refused:?}");
        }
    }
}
