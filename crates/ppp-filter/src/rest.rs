//! Whether a receiver stays where it was found.

use nalgebra::Vector3;

/// A receiver at rest that is found farther from where it was known, in standard deviations of that, has moved, or those are
/// wrong: on clean days it is never farther than 0.9.
const FARTHEST: f64 = 4.0;
/// Any receiver that is farther from where it was predicted has leapt …
const FARTHEST_LEAP: f64 = 10.0;
/// … but not if it is only so far, m, from where it would be if it stood, or went on as before, …
const LEAP: f64 = 100.0;
/// … and may have turned or braked meanwhile, m/s²: what an airliner does.
const ACCELERATION: f64 = 5.0;
/// No airliner is faster over the ground, m/s.
const FASTEST: f64 = 350.0;
/// A gap counts as no longer than this, s: whoever is farther after it is told of, whether it went there or not.
const LONGEST: f64 = 300.0;
/// What remains of an epoch in the sums after the next one.
const KEPT: f64 = 0.9;
/// For how many epochs a leap is told of.
const TOLD: u8 = 30;
/// The place that is known is replaced once the deviation is below this share of its own.
const BETTER: f64 = 0.8;

/// Where a receiver was found.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Rest {
    /// Of a receiver at rest: where, ECEF, m, and the standard deviation.
    place: Option<(Vector3<f64>, f64)>,
    /// Of one that moves: its velocity between the last two epochs, m/s.
    velocity: Option<Vector3<f64>>,
    /// Time since the last epoch, s.
    elapsed: f64,
    /// For how many epochs it is still told that a receiver leapt.
    leaping: u8,
    /// Ambiguities that began anew in the last epochs because their phases contradicted the place, each epoch counted
    /// for less than the next.
    anew: f64,
}

impl Rest {
    /// The next epoch is so much later, s.
    pub(crate) fn advance(&mut self, elapsed: f64) {
        self.elapsed = elapsed;
    }

    /// Time since the last epoch, s.
    pub(crate) fn elapsed(&self) -> f64 {
        self.elapsed
    }

    /// A receiver came from where it was predicted, with a standard deviation, to where it was found. One that `moves` is
    /// predicted where it was, and its first step may be any aircraft's.
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

    /// Of so many satellites some ambiguities begin anew because their phases contradict the place. If those are most
    /// of them, it is the place that is wrong.
    pub(crate) fn restart(&mut self, anew: usize, satellites: usize) {
        self.anew = KEPT * self.anew + anew as f64;
        if 2.0 * self.anew > satellites as f64 {
            (self.anew, self.leaping) = (0.0, u8::MAX);
        }
    }

    /// A receiver that is said to rest was seen to move.
    pub(crate) fn displace(&mut self) {
        self.leaping = u8::MAX;
    }

    /// A receiver at rest is found somewhere, with a standard deviation that tells where it is.
    pub(crate) fn stay(&mut self, found: &Vector3<f64>, deviation: f64) {
        let better = self.place.is_none_or(|(_, known)| deviation < BETTER * known);
        if better && !self.has_left(found) {
            self.place = Some((*found, deviation));
        }
    }

    /// Whether what is found contradicts what was found before.
    pub(crate) fn has_moved(&self, found: &Vector3<f64>) -> bool {
        self.leaping > 0 || self.has_left(found)
    }

    fn has_left(&self, found: &Vector3<f64>) -> bool {
        self.place.is_some_and(|(place, known)| (found - place).norm() > FARTHEST * known)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_that_is_known_better_and_better() {
        let mut rest = Rest::default();
        for deviation in [0.09, 0.04, 0.015, 0.01, 0.009] {
            rest.stay(&Vector3::zeros(), deviation);
        }
        // Compared with 10 mm, as 9 mm are not enough better.
        assert!(!rest.has_moved(&Vector3::new(0.039, 0.0, 0.0)));
        let away = Vector3::new(0.041, 0.0, 0.0);
        assert!(rest.has_moved(&away));
        rest.stay(&away, 0.001);
        assert!(rest.has_moved(&away), "what moved is no place to stay");
        assert!(!rest.has_moved(&Vector3::zeros()));
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
        // 250 m/s, a turn by a quarter, and a standstill; then 20 km aside at once.
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
