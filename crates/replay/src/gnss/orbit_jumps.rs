//! Detection of orbit samples that lie off the curve through their neighbours: a lost digit, a wrong day, an
//! unannounced manoeuvre.

use kestirim_gnss_ppp::OrbitSample;

/// The number of samples that define a curve with one to spare.
const POINTS: usize = 9;
/// The binomial coefficients of eight: the weights of nine samples in their eighth difference.
const SHARES: [f64; POINTS] = [1.0, 8.0, 28.0, 56.0, 70.0, 56.0, 28.0, 8.0, 1.0];
/// The places of a sample among the nine, the best ones first: at the ends little is known of it.
const PLACES: [usize; 5] = [4, 3, 5, 2, 6];
/// The distance from the polynomial of its neighbours beyond which a sample is wrong, m; eccentric Galileo satellites
/// reach 13 m at steps of a quarter of an hour.
const FARTHEST: f64 = 30.0;
/// The longest step between samples that are examined, s: coarser ones tell nothing.
const LONGEST_STEP: f64 = 901.0;

/// A sample that can be examined: its index, its place among the nine, and its distance from the polynomial of the
/// others, m.
type Misfit = (usize, usize, f64);

/// Removes samples that are off the curve, the worst first; what is around a gap is then not used either. Of the first
/// two samples and of the last two before an end or a gap little is known: they go with the third if that looks off.
/// Returns how many were removed, and how far off the worst looked, m.
pub(super) fn remove(samples: &mut Vec<OrbitSample>) -> Option<(usize, f64)> {
    let (mut count, mut farthest) = (0, 0.0);
    let mut from = 0;
    loop {
        let misfits = (from..samples.len()).filter_map(|index| misfit(samples, index));
        // The first sample that is off, and the worst of those that it affects.
        let Some((first, ..)) = misfits.clone().find(|it| it.2 > FARTHEST) else { break };
        let near = misfits.take_while(|it| it.0 < first + POINTS);
        let Some((worst, place, most)) = near.max_by(|a, b| a.2.total_cmp(&b.2)) else { break };
        let gone = match place {
            2 => worst - 2..worst + 1,
            6 => worst..worst + 3,
            _ => worst..worst + 1,
        };
        count += gone.len();
        samples.drain(gone);
        farthest = most.max(farthest);
        from = first.saturating_sub(POINTS);
    }
    (count > 0).then_some((count, farthest))
}

/// The distance of a sample from the polynomial through eight others around it; `None` if they are not equidistant.
fn misfit(samples: &[OrbitSample], index: usize) -> Option<Misfit> {
    PLACES.into_iter().find_map(|place| {
        let first = index.checked_sub(place)?;
        let window: &[OrbitSample; POINTS] = samples.get(first..)?.first_chunk()?;
        let step = window[1].second - window[0].second;
        let is_even = |pair: &[OrbitSample]| (pair[1].second - pair[0].second - step).abs() < 1e-3;
        if step > LONGEST_STEP || !window.windows(2).all(is_even) {
            return None;
        }
        let signed = window.iter().zip(SHARES).enumerate();
        let difference: nalgebra::Vector3<f64> = signed
            .map(|(k, (sample, share))| sample.position * if k % 2 == 0 { share } else { -share })
            .sum();
        Some((index, place, difference.norm() / SHARES[place]))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;

    /// A day of a satellite on a circular orbit, every quarter of an hour; some samples are off by the given distance,
    /// m.
    fn orbit(off: &[(usize, f64)]) -> Vec<OrbitSample> {
        let sample = |k: usize| {
            let second = 900.0 * k as f64;
            let (sine, cosine) = (second * std::f64::consts::TAU / 43_000.0).sin_cos();
            let by = off.iter().find(|(at, _)| *at == k).map_or(0.0, |(_, by)| *by);
            let position = Vector3::new(26.6e6 * cosine, 26.6e6 * sine, by);
            OrbitSample { second, position }
        };
        (0..96).map(sample).collect()
    }

    fn left(off: &[(usize, f64)]) -> (Option<(usize, f64)>, Vec<usize>) {
        let mut samples = orbit(off);
        let found = remove(&mut samples);
        let left: Vec<_> = samples.iter().map(|sample| (sample.second / 900.0) as usize).collect();
        (found, (0..96).filter(|k| !left.contains(k)).collect())
    }

    #[test]
    fn only_what_is_off_is_taken_out() {
        assert_eq!(left(&[]), (None, vec![]));
        assert_eq!(left(&[(40, 10.0)]), (None, vec![]));
        let (found, gone) = left(&[(40, 1000.0), (80, -40.0)]);
        assert_eq!(gone, [40, 80]);
        let (count, farthest) = found.expect("both");
        assert!(count == 2 && (farthest - 1000.0).abs() < 1.0, "{farthest}");
        // At the ends it could be any of the three.
        for k in 0..3 {
            assert_eq!(left(&[(k, 2000.0)]).1, [0, 1, 2]);
            assert_eq!(left(&[(95 - k, 2000.0)]).1, [93, 94, 95]);
        }
    }

    #[test]
    fn what_is_next_to_a_gap_is_looked_at_from_the_other_side() {
        // Samples beside both may go with them.
        let (_, gone) = left(&[(40, 1000.0), (41, 800.0)]);
        assert!([40, 41].iter().all(|k| gone.contains(k)) && gone.len() <= 4, "{gone:?}");
        let mut few = orbit(&[]);
        few.truncate(8);
        assert_eq!(remove(&mut few), None);
    }
}
