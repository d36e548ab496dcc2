//! Smoothing of a walk: the correction at each stance is distributed over the swing before it.

use super::{Moment, Walk};

/// The interval between samples beyond which nothing is known of the motion, s, as in `kestirim_pedestrian`.
const GAP: f64 = 0.06;

/// Distributes the correction at the end of each swing over that swing.
///
/// A velocity that is wrong by e when the foot stands again has drifted there, whether by tilt or by noise, in
/// proportion to time, and the position with its square. The filter corrects only the position at the end; here the way
/// there is corrected, so that no foot jumps as it lands. Positions in stance remain as they are, and so does a swing
/// with a gap.
pub(super) fn smooth(walk: &mut Walk, moments: &mut [Moment]) {
    let mut stood = None;
    for landing in 0..walk.track.len().min(moments.len()) {
        if !moments[landing].stance {
            continue;
        }
        if let Some(stood) = stood.replace(landing).filter(|stood| stood + 1 < landing) {
            take_back(walk, moments, stood, landing);
        }
    }
}

/// Smooths a swing from the last sample of a stance to the first of the next.
fn take_back(walk: &mut Walk, moments: &mut [Moment], stood: usize, landing: usize) {
    let seconds = |from: usize, to: usize| {
        walk.track[to].time_us.saturating_sub(walk.track[from].time_us) as f64 * 1e-6
    };
    let (swing, last) = (seconds(stood, landing), seconds(landing - 1, landing));
    let has_gap = (stood..landing).any(|index| seconds(index, index + 1) > GAP);
    if swing <= 0.0 || has_gap {
        return;
    }
    let (before, after) = (moments[landing - 1].velocity, moments[landing].velocity);
    let led = |axis: usize| walk.track[landing - 1].position[axis] + before[axis] * last;
    let jump = [0, 1, 2].map(|axis| walk.track[landing].position[axis] - led(axis));
    let shares: Vec<_> =
        (stood + 1..landing).map(|index| (index, seconds(stood, index) / swing)).collect();
    for (index, share) in shares {
        for axis in 0..3 {
            walk.track[index].position[axis] += share * share * jump[axis];
            moments[index].velocity[axis] += share * (after[axis] - before[axis]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pedestrian::TrackPoint;

    #[test]
    fn a_drift_is_taken_back_where_it_grew() {
        // A foot that moves at 1 m/s for a second, with a velocity that drifts by 0.2 m/s, and then stands.
        let drift = 0.2;
        let at = |k: u32| f64::from(k) / 100.0;
        let (mut walk, mut moments) = (Walk::default(), Vec::new());
        for k in 0..=101 {
            let (t, swings) = (at(k), (1..=100).contains(&k));
            let x = if k > 100 { 1.0 } else { t + 0.5 * drift * t * t };
            let velocity = if swings { 1.0 + drift * t } else { 1.0 };
            let point = TrackPoint { time_us: u64::from(k) * 10_000, position: [x, 0.0, 0.0] };
            walk.track.push(point);
            moments.push(Moment {
                velocity: [velocity, 0.0, 0.0],
                orientation: [1.0, 0.0, 0.0, 0.0],
                stance: !swings,
            });
        }
        // The position at landing: the length of the swing and of one more sample.
        walk.track[101].position[0] = 1.01;
        smooth(&mut walk, &mut moments);
        for k in 0..=101 {
            let [x, _, _] = walk.track[k as usize].position;
            assert!((x - at(k)).abs() < 2e-3, "{x} m at {} s", at(k));
            let [speed, _, _] = moments[k as usize].velocity;
            assert!((speed - 1.0).abs() < 5e-3, "{speed} m/s at {} s", at(k));
        }
    }
}
