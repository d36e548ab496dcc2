//! Integers that were found, held while their phases are continuous.

use heapless::Vec;
use kestirim_gnss_ppp::Constellation;

use super::pairs::{Found, Pair, Validation};
use super::wide_lane::Candidate;

/// A satellite's integers relative to another satellite of its system: of the wide lane and on the first carrier.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Whole {
    satellite: u8,
    constellation: Constellation,
    wide: f64,
    first: i64,
}

/// The held integers, indexed by the state of their ambiguity.
#[derive(Clone, Copy, Debug)]
pub(super) struct Held<const N: usize> {
    integers: [Option<Whole>; N],
    /// The validation of the integers found last, if there are any.
    pub(super) validation: Option<Validation>,
}

impl<const N: usize> Held<N> {
    pub(super) const NONE: Self = Self { integers: [None; N], validation: None };

    /// Releases the integer of a phase that is reset.
    pub(super) fn release(&mut self, state: usize) {
        if let Some(place) = self.integers.get_mut(state) {
            *place = None;
        }
    }

    /// Adds integers that were found. If they contradict the held ones, either set is wrong, and nothing is held any
    /// more.
    pub(super) fn take(&mut self, found: &Found<N>) {
        for system in [Constellation::Gps, Constellation::Galileo] {
            if !self.take_system(system, found) {
                *self = Self::NONE;
                return;
            }
        }
        self.validation = Some(found.validation);
    }

    fn take_system(&mut self, system: Constellation, found: &Found<N>) -> bool {
        let pairs = found.pairs.iter().zip(&found.integers);
        let pairs =
            || pairs.clone().filter(|(pair, _)| pair.one.carriers.constellation() == system);
        let Some((Pair { reference, .. }, _)) = pairs().next() else { return true };
        let others =
            pairs().map(|(pair, &integer)| (&pair.one, pair.one.wide - reference.wide, integer));
        let all = || core::iter::once((reference, 0.0, 0)).chain(others.clone());
        let common = all().find_map(|(candidate, wide, first)| {
            let held = self.of(candidate)?;
            Some((held.wide - wide, held.first.wrapping_sub(first)))
        });
        if common.is_none() {
            for place in &mut self.integers {
                *place = place.filter(|held| held.constellation != system);
            }
        }
        let (more_wide, more) = common.unwrap_or_default();
        for (candidate, wide, first) in all() {
            let (wide, first) = (wide + more_wide, first.wrapping_add(more));
            let Candidate { satellite, .. } = *candidate;
            let whole = Whole { satellite, constellation: system, wide, first };
            if self.of(candidate).is_some_and(|held| held != whole) {
                return false;
            }
            if let Some(place) = self.integers.get_mut(candidate.state) {
                *place = Some(whole);
            }
        }
        true
    }

    fn of(&self, candidate: &Candidate) -> Option<Whole> {
        let held = self.integers.get(candidate.state).copied().flatten();
        held.filter(|held| held.satellite == candidate.satellite)
    }

    /// The pairs with held integers, and with the wide lanes that are held, too.
    pub(super) fn pairs(&self, candidates: &Vec<Candidate, N>) -> Vec<(Pair, i64), N> {
        let mut known: Vec<Candidate, N> = Vec::new();
        for candidate in candidates {
            if let Some(Whole { wide, .. }) = self.of(candidate) {
                let _ = known.push(Candidate { wide, ..*candidate });
            }
        }
        let mut pairs = Vec::new();
        // Iterated by reference, as consuming a vector may panic.
        for pair in &Pair::all::<N>(&known.iter()) {
            if let (Some(one), Some(reference)) = (self.of(&pair.one), self.of(&pair.reference)) {
                let _ = pairs.push((*pair, one.first.wrapping_sub(reference.first)));
            }
        }
        pairs
    }
}

#[cfg(test)]
mod tests {
    use kestirim_gnss_ppp::Carriers;

    use super::*;

    fn candidates(wide: [f64; 4]) -> Vec<Candidate, 12> {
        let mut candidates = Vec::new();
        for (index, wide) in wide.into_iter().enumerate() {
            let _ = candidates.push(Candidate {
                satellite: index as u8 + 1,
                state: 5 + index,
                carriers: Carriers::L1L2,
                elevation: 1.0 - 0.1 * index as f64,
                bias: 0.0,
                wide,
                sigma: 0.1,
            });
        }
        candidates
    }

    fn found(candidates: &[Candidate], integers: [i64; 3]) -> Found<12> {
        let integers = integers.into_iter().collect();
        let validation = Validation { ratio: 3.0, success_rate: 0.999 };
        Found { pairs: Pair::all(&candidates.iter()), integers, validation }
    }

    fn integers(held: &Held<12>, candidates: &Vec<Candidate, 12>) -> Vec<i64, 12> {
        held.pairs(candidates).iter().map(|(_, integer)| *integer).collect()
    }

    #[test]
    fn integers_are_held_while_their_phases_go_on() {
        let mut all = candidates([7.0, 3.0, 2.0, 5.0]);
        let mut held = Held::<12>::NONE;
        held.take(&found(&all, [4, -2, 9]));
        assert_eq!(integers(&held, &all), [4, -2, 9]);
        // Another satellite is the highest, and the wide lanes have another fractional part.
        all = candidates([8.0, 4.0, 3.0, 6.0]);
        all[1].elevation = 1.2;
        held.take(&found(&all, [-4, -6, 5]));
        assert_eq!(integers(&held, &all), [-4, -6, 5]);
        held.release(6);
        assert_eq!(integers(&held, &all), [-2, 9]);
    }

    #[test]
    fn of_two_that_contradict_each_other_none_is_held() {
        let all = candidates([7.0, 3.0, 2.0, 5.0]);
        for wrong in [found(&all, [4, -1, 9]), found(&candidates([7.0, 3.0, 2.0, 6.0]), [4, -2, 9])]
        {
            let mut held = Held::<12>::NONE;
            held.take(&found(&all, [4, -2, 9]));
            held.take(&wrong);
            assert!(held.validation.is_none() && held.pairs(&all).is_empty());
        }
    }
}
