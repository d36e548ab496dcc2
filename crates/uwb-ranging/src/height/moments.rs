use super::CANDIDATES;
use super::candidate::Candidate;
use kestirim_scalar::Scalar;

/// Number of heights between two candidates at which the probability is evaluated.
const BETWEEN: i32 = 8;

/// Mean and standard deviation of the height, and its place among the candidates.
pub(super) struct Moments<T> {
    pub(super) metres: T,
    pub(super) sigma: T,
    pub(super) position_sigma: T,
    place: T,
}

impl<T: Scalar> Moments<T> {
    /// Mean and standard deviation over the candidates from `first` to `last`.
    pub(super) fn of<const A: usize>(
        candidates: &[Candidate<T, A>; CANDIDATES],
        places: T,
        costs: &[T; CANDIDATES],
        (first, last): (usize, usize),
    ) -> Option<Self> {
        let places = places.divisor();
        let step = T::from_f64(1.0 / f64::from(BETWEEN));
        // Weights, and weighted moments of the place counted in candidates and in metres of the position's path.
        let (mut sum, mut mean, mut variance) = (T::ZERO, T::ZERO, T::ZERO);
        let (mut way_mean, mut way_variance) = (T::ZERO, T::ZERO);
        let mut way = T::ZERO;
        for index in first..last {
            let (here, next) = (*costs.get(index)?, *costs.get(index + 1)?);
            let before = index.checked_sub(1).and_then(|index| costs.get(index));
            let after = costs.get(index + 2);
            let length = candidates.get(index + 1)?.apart.divided_by(places).sqrt();
            for part in 0..BETWEEN {
                // The middle of each part.
                let share = step * (T::from_micro(part * 1_000_000) + T::HALF);
                let cost = between(before.copied(), here, next, after.copied(), share);
                let weight = (-T::HALF * cost.max(T::ZERO).min(T::from_f64(40.0))).exp();
                let at = T::from_micro(index as i32 * 1_000_000) + share;
                let along = way + length * share;
                sum += weight;
                let more = weight / sum;
                let (off, way_off) = (at - mean, along - way_mean);
                mean += more * off;
                way_mean += more * way_off;
                variance += more * (off * (at - mean) - variance);
                way_variance += more * (way_off * (along - way_mean) - way_variance);
            }
            way += length;
        }
        let (low, high) = (candidates.first()?.height, candidates.get(1)?.height);
        let spacing = high - low;
        Some(Self {
            metres: low + mean * spacing,
            sigma: variance.max(T::ZERO).sqrt() * spacing,
            position_sigma: way_variance.max(T::ZERO).sqrt(),
            place: mean,
        })
    }

    /// Interpolates values given per candidate at the mean height.
    pub(super) fn at<const A: usize>(&self, of: &[[T; A]; CANDIDATES]) -> Option<[T; A]> {
        let whole = |index: usize| T::from_micro(index as i32 * 1_000_000);
        let index = (0..CANDIDATES - 1).rfind(|&index| whole(index) <= self.place)?;
        let share = self.place - whole(index);
        let (low, high) = (of.get(index)?, of.get(index + 1)?);
        let mut between = *low;
        for (value, &high) in between.iter_mut().zip(high) {
            *value += share * (high - *value);
        }
        Some(between)
    }
}

/// A cubic between two costs, with the slopes of the parabolas through their neighbours (Catmull and Rom 1974).
fn between<T: Scalar>(before: Option<T>, here: T, next: T, after: Option<T>, share: T) -> T {
    let rise = next - here;
    let leaving = before.map_or(rise, |before| (next - before) * T::HALF);
    let arriving = after.map_or(rise, |after| (after - here) * T::HALF);
    let rest = T::ONE - share;
    let (bend, counter) = (leaving - rise, rise - arriving);
    here + rise * share + share * rest * (bend * rest + counter * share)
}
