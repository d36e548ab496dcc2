//! Wide lanes: the difference of both carriers' integer ambiguities, from averaged codes and phases.

use heapless::Vec;
use kestirim_gnss_ppp::{Carriers, Constellation};

use crate::Config;

/// The correlation time of code errors (multipath), s.
const CODE_CORRELATION: f64 = 60.0;
/// The minimum number of epochs in a mean.
const FEWEST_EPOCHS: u16 = 5;
/// The largest distance of a mean from an integer, cycles.
const FARTHEST: f64 = 0.25;
/// The distance of a mean from an integer, plus this many standard deviations, must be within half a cycle.
const DEVIATIONS: f64 = 2.0;
/// The variance added to that of a mean when the receiver's fractional part is estimated, cycles².
const FLOOR: f64 = 0.01;

/// The running mean of a satellite's wide lane since its phase was reset.
#[derive(Clone, Copy, Debug)]
pub(super) struct WideLane {
    pub(super) satellite: u8,
    /// The sum of the inverse variances, cycles⁻².
    weight: f64,
    mean: f64,
    epochs: u16,
}

impl WideLane {
    pub(super) const fn new(satellite: u8) -> Self {
        Self { satellite, weight: 0.0, mean: 0.0, epochs: 0 }
    }

    /// Adds the wide lane of an epoch, cycles, with its variance.
    pub(super) fn take(&mut self, cycles: f64, variance: f64) {
        self.epochs = self.epochs.saturating_add(1);
        self.weight += 1.0 / variance;
        self.mean += (cycles - self.mean) / (variance * self.weight);
    }

    /// The mean and its standard deviation, cycles, if there are enough epochs, which are `interval` apart, s.
    pub(super) fn known(&self, interval: f64) -> Option<[f64; 2]> {
        let repeated = 1.0 + 2.0 * CODE_CORRELATION / interval;
        (self.epochs >= FEWEST_EPOCHS).then(|| [self.mean, libm::sqrt(repeated / self.weight)])
    }
}

/// The variance of an epoch's wide lane at an elevation given by its sine, cycles²: that of the codes, of which the
/// ionosphere-free one is three times as noisy as a single one.
pub(super) fn variance(config: &Config<impl Sized>, carriers: Carriers, sine: f64) -> f64 {
    let [first, second] = carriers.frequency();
    let one = config.code.variance(sine) / 9.0;
    let share = (first * first + second * second) / ((first + second) * (first + second));
    one * share / (carriers.wide_lane() * carriers.wide_lane())
}

/// A satellite whose ambiguity may be an integer.
#[derive(Clone, Copy, Debug)]
pub(super) struct Candidate {
    pub(super) satellite: u8,
    pub(super) state: usize,
    pub(super) carriers: Carriers,
    pub(super) elevation: f64,
    /// The bias by which the ionosphere-free phase is too long, m.
    pub(super) bias: f64,
    /// The wide lane, cycles: first the mean, later the integer.
    pub(super) wide: f64,
    /// The standard deviation of the mean, cycles.
    pub(super) sigma: f64,
}

/// The candidates whose wide lane is an integer apart from the receiver's fractional part, which is common to a system.
pub(super) fn whole<const N: usize>(candidates: &Vec<Candidate, N>) -> Vec<Candidate, N> {
    let mut whole = Vec::new();
    for system in [Constellation::Gps, Constellation::Galileo] {
        let of_system = || candidates.iter().filter(|it| it.carriers.constellation() == system);
        let (mut sine, mut cosine) = (0.0, 0.0);
        for candidate in of_system() {
            let angle = core::f64::consts::TAU * candidate.wide;
            let weight = 1.0 / (candidate.sigma * candidate.sigma + FLOOR);
            let (up, along) = libm::sincos(angle);
            sine += weight * up;
            cosine += weight * along;
        }
        let fraction = libm::atan2(sine, cosine) / core::f64::consts::TAU;
        for candidate in of_system() {
            let beside = candidate.wide - fraction;
            let wide = libm::round(beside);
            let off = (beside - wide).abs();
            if off < FARTHEST && off + DEVIATIONS * candidate.sigma < 0.5 {
                // There is room for as many as there are candidates.
                let _ = whole.push(Candidate { wide, ..*candidate });
            }
        }
    }
    whole
}

#[cfg(test)]
mod tests {
    extern crate std;

    use super::*;
    use crate::Motion;

    fn candidate(satellite: u8, carriers: Carriers, wide: f64, sigma: f64) -> Candidate {
        let state = usize::from(satellite % 30);
        Candidate { satellite, state, carriers, elevation: 1.0, bias: 0.0, wide, sigma }
    }

    #[test]
    fn wide_lanes_are_whole_beside_the_receivers_own_fraction() {
        let mut candidates = Vec::<Candidate, 12>::new();
        for (satellite, wide, sigma) in
            [(1, 7.43, 0.05), (2, -3.61, 0.05), (3, 12.38, 0.05), (4, 5.9, 0.05), (5, 1.4, 0.4)]
        {
            let _ = candidates.push(candidate(satellite, Carriers::L1L2, wide, sigma));
        }
        for (satellite, wide) in [(101, 2.9), (102, 3.95)] {
            let _ = candidates.push(candidate(satellite, Carriers::E1E5a, wide, 0.05));
        }
        let found = whole(&candidates);
        let integers: std::vec::Vec<_> = found.iter().map(|it| (it.satellite, it.wide)).collect();
        // The fourth is half a cycle off, the fifth is too uncertain.
        assert_eq!(integers, [(1, 7.0), (2, -4.0), (3, 12.0), (101, 3.0), (102, 4.0)]);
    }

    #[test]
    fn a_mean_is_as_good_as_its_epochs() {
        let config = Config::new(Motion::Static);
        let [high, low] = [1.0, 0.2].map(|sine| variance(&config, Carriers::L1L2, sine));
        assert!(high < low && (high.sqrt() - 0.248).abs() < 1e-2, "{}", high.sqrt());
        let mut mean = WideLane::new(1);
        for epoch in 0..40 {
            assert_eq!(mean.known(30.0).is_some(), epoch >= 5);
            mean.take(if epoch % 2 == 0 { 3.1 } else { 2.9 }, high);
        }
        let [cycles, sigma] = mean.known(30.0).expect("forty epochs");
        assert!((cycles - 3.0).abs() < 1e-9);
        assert!((sigma - (5.0 * high / 40.0).sqrt()).abs() < 1e-12);
    }
}
