//! Detection of whether a receiver stays where it was found.

use nalgebra::{Matrix3, Vector3};

/// A receiver at rest that is found farther than this many standard deviations from an earlier place, in the direction
/// from there, has moved, or these are wrong: on clean days it is never farther than 1.2.
const FARTHEST: f64 = 4.0;
/// A receiver that is farther from its prediction than this many standard deviations has leapt, unless it is within
/// `LEAP`.
const FARTHEST_LEAP: f64 = 10.0;
/// A distance, m, from the position at rest or at constant velocity, within which no receiver has leapt.
const LEAP: f64 = 100.0;
/// The acceleration by which a moving receiver may have turned or braked meanwhile, m/s²: that of an airliner.
const ACCELERATION: f64 = 5.0;
/// The largest ground speed, m/s: no airliner is faster.
const FASTEST: f64 = 350.0;
/// The longest time, s, for which a gap counts: a receiver that is too far away after a longer one is reported, whether
/// it moved there or not.
const LONGEST: f64 = 300.0;
/// The factor by which the weight of an epoch in the sums decays per epoch.
const KEPT: f64 = 0.9;
/// The number of epochs for which a leap is reported.
const TOLD: u8 = 30;
/// A place is kept once its standard deviation is below this share of that of the place kept before it.
const BETTER: f64 = 0.7;
/// The number of places that are kept: over a factor of three in σ. A receiver that creeps stays close to the newest one,
/// but not to all.
const PLACES: usize = 4;

/// A place where a receiver at rest was found.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct Place {
    /// ECEF, m.
    position: Vector3<f64>,
    covariance: Matrix3<f64>,
}

impl Place {
    /// Whether a position is too far away.
    #[inline(never)] // Not once for each place.
    fn is_left_by(&self, found: &Vector3<f64>) -> bool {
        let away = found - self.position;
        let square = away.norm_squared();
        // Both sides are multiplied by the squared distance.
        square * square > FARTHEST * FARTHEST * away.dot(&(self.covariance * away))
    }
}

/// The history of where a receiver was found.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Rest {
    /// The places of a receiver at rest, each better known than the next.
    places: [Option<Place>; PLACES],
    /// The velocity of a moving receiver between the last two epochs, m/s.
    velocity: Option<Vector3<f64>>,
    /// The time since the last epoch, s.
    elapsed: f64,
    /// The number of further epochs for which a leap is reported.
    leaping: u8,
    /// The number of ambiguities reset in the last epochs because their phases contradicted the place, in which older
    /// epochs count for less.
    anew: f64,
}

impl Rest {
    /// Advances to the next epoch by a time, s.
    pub(crate) fn advance(&mut self, elapsed: f64) {
        self.elapsed = elapsed;
    }

    /// The time since the last epoch, s.
    pub(crate) fn elapsed(&self) -> f64 {
        self.elapsed
    }

    /// Compares the predicted position, with its standard deviation, and the position found. A receiver that `moves` is
    /// predicted where it was, and its first step may be as long as an aircraft's.
    pub(crate) fn follow(
        &mut self,
        predicted: &Vector3<f64>,
        deviation: f64,
        found: &Vector3<f64>,
        moves: bool,
    ) {
        let (step, elapsed) = (found - predicted, self.elapsed.min(LONGEST));
        let mut farthest = LEAP.max(FARTHEST_LEAP * deviation);
        let mut beyond = step.norm();
        if moves && elapsed > 0.0 {
            farthest += 0.5 * ACCELERATION * elapsed * elapsed;
            if beyond < farthest + FASTEST * elapsed {
                beyond = self.velocity.map_or(0.0, |it| beyond.min((step - it * elapsed).norm()));
            }
            self.velocity = Some(step / self.elapsed);
        }
        let leapt = beyond > farthest;
        let told = if leapt { TOLD } else { 0 };
        self.leaping = self.leaping.saturating_sub(1).max(told);
    }

    /// Notes that `anew` of the ambiguities of `satellites` were reset because their phases contradict the place. If
    /// those are most of them, the place is wrong.
    pub(crate) fn restart(&mut self, anew: usize, satellites: usize) {
        self.anew = KEPT * self.anew + anew as f64;
        if 2.0 * self.anew > satellites as f64 {
            (self.anew, self.leaping) = (0.0, u8::MAX);
        }
    }

    /// Notes that a receiver that should be at rest was seen to move.
    pub(crate) fn displace(&mut self) {
        self.leaping = u8::MAX;
    }

    /// Notes where a receiver at rest is found, with the covariance of that.
    pub(crate) fn stay(&mut self, found: &Vector3<f64>, covariance: &Matrix3<f64>) {
        let [newest, second, third, _] = self.places;
        let better = |it: Place| covariance.trace() < BETTER * BETTER * it.covariance.trace();
        if newest.is_none_or(better) && !self.has_moved(found) {
            let place = Place { position: *found, covariance: *covariance };
            self.places = [Some(place), newest, second, third];
        }
    }

    /// Whether the position found contradicts earlier ones.
    pub(crate) fn has_moved(&self, found: &Vector3<f64>) -> bool {
        self.leaping > 0 || self.has_left(found)
    }

    fn has_left(&self, found: &Vector3<f64>) -> bool {
        self.places.iter().flatten().any(|place| place.is_left_by(found))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The covariance of a position that is known alike in all directions.
    fn alike(deviation: f64) -> Matrix3<f64> {
        Matrix3::identity() * (deviation * deviation)
    }

    #[test]
    fn a_place_that_is_known_better_and_better() {
        let mut rest = Rest::default();
        for deviation in [0.09, 0.04, 0.015, 0.01, 0.009] {
            rest.stay(&Vector3::zeros(), &alike(deviation));
        }
        // Compared with 10 mm, as 9 mm are not enough better.
        assert!(!rest.has_moved(&Vector3::new(0.039, 0.0, 0.0)));
        let away = Vector3::new(0.041, 0.0, 0.0);
        assert!(rest.has_moved(&away));
        rest.stay(&away, &alike(0.001));
        assert!(rest.has_moved(&away), "a receiver that moved is not at rest there");
        assert!(!rest.has_moved(&Vector3::zeros()));
    }

    #[test]
    fn a_direction_that_is_known_worse_may_change_more() {
        let mut rest = Rest::default();
        rest.stay(&Vector3::zeros(), &Matrix3::from_diagonal(&Vector3::new(1e-4, 1e-4, 9e-4)));
        assert!(!rest.has_moved(&Vector3::new(0.0, 0.0, 0.1)));
        assert!(rest.has_moved(&Vector3::new(0.05, 0.0, 0.0)));
    }

    #[test]
    fn a_creep_is_seen_though_each_place_is_close_to_the_one_before() {
        let mut rest = Rest::default();
        let at = |step: i32| Vector3::new(0.02 * f64::from(step), 0.0, 0.0);
        let deviations = [0.03, 0.02, 0.014, 0.009];
        for (step, deviation) in (0..).zip(deviations) {
            assert!(!rest.has_moved(&at(step)), "{step}");
            rest.stay(&at(step), &alike(deviation));
        }
        // 60 mm from the second place, of 20 mm, are not enough; 80 mm are, as they are not from the newest one alone.
        assert!(!rest.has_moved(&at(3)) && rest.has_moved(&at(5)));
    }

    #[test]
    fn most_ambiguities_anew_are_a_motion() {
        let mut rest = Rest::default();
        rest.restart(4, 9);
        assert!(!rest.has_moved(&Vector3::zeros()));
        rest.restart(1, 9);
        assert!(rest.has_moved(&Vector3::zeros()));
    }

    #[test]
    fn a_leap_is_told_for_a_while() {
        let mut rest = Rest::default();
        let at = |x: f64| Vector3::new(x, 0.0, 0.0);
        rest.follow(&at(0.0), 1.0, &at(99.0), false);
        rest.follow(&at(0.0), 50.0, &at(499.0), false);
        assert!(!rest.has_moved(&at(0.0)));
        rest.follow(&at(0.0), 50.0, &at(501.0), false);
        for _ in 0..29 {
            rest.follow(&at(501.0), 50.0, &at(501.0), false);
            assert!(rest.has_moved(&at(501.0)));
        }
        rest.follow(&at(501.0), 50.0, &at(501.0), false);
        assert!(!rest.has_moved(&at(501.0)));
    }

    #[test]
    fn an_aircraft_that_turns_or_lands_does_not_leap() {
        let mut rest = Rest::default();
        let mut at = Vector3::zeros();
        let mut step = |rest: &mut Rest, x: f64, y: f64| {
            let found = at + Vector3::new(x, y, 0.0);
            rest.advance(30.0);
            rest.follow(&at, 95.0, &found, true);
            at = found;
            rest.has_moved(&found)
        };
        // 250 m/s, a quarter turn, and a standstill; then a sudden leap of 20 km aside.
        for (x, y) in [(7500.0, 0.0), (7500.0, 0.0), (6000.0, 2500.0), (3000.0, 3000.0), (0.0, 0.0)]
        {
            assert!(!step(&mut rest, x, y), "{x} {y}");
        }
        assert!(step(&mut rest, 0.0, 20_000.0));
        assert!(step(&mut Rest::default(), 0.0, 40_000.0), "the first step, too");
        let mut rest = Rest::default();
        rest.advance(36_000.0);
        rest.follow(&Vector3::zeros(), 3e3, &Vector3::new(1e6, 0.0, 0.0), true);
        assert!(rest.has_moved(&Vector3::zeros()), "a thousand kilometres in a night");
    }
}
