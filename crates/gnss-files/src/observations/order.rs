//! The order of epochs.

use crate::time::GpsTime;

/// Selects the epochs to keep so that each is later than the one before: as many as possible, and the first of
/// duplicates.
///
/// A single epoch with a wrong time thus costs only itself, whether it precedes or follows all others.
pub(super) fn in_order(times: &[GpsTime]) -> Vec<bool> {
    // For each length (index plus one) the last epoch of the ordered subsequence of that length that ends earliest.
    let mut ends: Vec<usize> = Vec::new();
    let mut before = Vec::with_capacity(times.len());
    for (index, time) in times.iter().enumerate() {
        let length = ends.partition_point(|&end| times[end] < *time);
        before.push(length.checked_sub(1).map(|length| ends[length]));
        match ends.get_mut(length) {
            Some(end) if *time < times[*end] => *end = index,
            Some(_) => {}
            None => ends.push(index),
        }
    }
    let mut kept = vec![false; times.len()];
    let mut at = ends.last().copied();
    while let Some(index) = at {
        kept[index] = true;
        at = before[index];
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    fn kept(seconds: &[f64]) -> Vec<f64> {
        let times: Vec<_> = seconds.iter().map(|it| GpsTime::new(59_025, *it)).collect();
        let kept = in_order(&times);
        seconds.iter().zip(kept).filter(|(_, kept)| *kept).map(|(it, _)| *it).collect()
    }

    #[test]
    fn an_epoch_of_a_wrong_time_costs_itself() {
        assert_eq!(kept(&[]), [0.0; 0]);
        for wrong in [[9e4, 0.0_f64, 30.0, 60.0], [0.0, 9e4, 30.0, 60.0], [0.0, 30.0, -9e4, 60.0]] {
            let right: Vec<_> = wrong.into_iter().filter(|it| it.abs() < 100.0).collect();
            assert_eq!(kept(&wrong), right, "{wrong:?}");
        }
        assert_eq!(kept(&[9e4, 9.1e4, 0.0, 30.0, 60.0]), [0.0, 30.0, 60.0]);
    }

    #[test]
    fn of_what_is_told_twice_the_first_is_kept() {
        let times = [0.0, 30.0, 60.0].map(|it| GpsTime::new(59_025, it));
        let twice = [times, times].concat();
        assert_eq!(in_order(&twice), [true, true, true, false, false, false]);
    }
}
