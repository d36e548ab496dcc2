//! Strictly increasing times.

/// The latest plausible time, µs: three centuries, beyond any clock.
const LATEST: f64 = 1e16;

/// The indices of the longest strictly increasing subsequence of times; invalid times are left out.
pub(super) fn growing(times: &[f64]) -> Vec<usize> {
    let is_time = |time: &f64| time.abs() <= LATEST;
    if times.windows(2).all(|pair| pair[0] < pair[1]) && times.iter().all(is_time) {
        return (0..times.len()).collect();
    }
    // The last index of the best sequence of each length, and the predecessor of each index.
    let mut ends: Vec<usize> = Vec::new();
    let mut before = vec![None; times.len()];
    for (place, time) in times.iter().enumerate().filter(|(_, time)| is_time(time)) {
        let length = ends.partition_point(|&end| times[end] < *time);
        before[place] = length.checked_sub(1).map(|shorter| ends[shorter]);
        match ends.get_mut(length) {
            // Of equal times the first is kept.
            Some(end) if times[*end] == *time => {}
            Some(end) => *end = place,
            None => ends.push(place),
        }
    }
    let mut kept = Vec::with_capacity(ends.len());
    let mut place = ends.last().copied();
    while let Some(at) = place {
        kept.push(at);
        place = before[at];
    }
    kept.reverse();
    kept
}

#[cfg(test)]
mod tests {
    use super::growing;

    #[test]
    fn the_fewest_are_left_out() {
        assert_eq!(growing(&[1.0, 2.0, 3.0]), [0, 1, 2]);
        assert_eq!(growing(&[1.0, 9e9, 2.0, f64::NAN, 1e19, 0.5, 3.0, 3.0, 4.0]), [0, 2, 6, 8]);
        assert_eq!(growing(&[]), [0; 0]);
    }
}
