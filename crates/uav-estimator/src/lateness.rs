use kestirim_kalman::Innovation;

/// Number of samples of the exponential average relative to which an expected output's movement is measured.
const LAG: f32 = 16.0;
/// Number of samples over which the sums decay exponentially: ten seconds at 100 Hz.
const MEMORY: f32 = 1000.0;
/// Normalised innovations squared from here on are ignored: a spike says nothing about timing.
const LARGEST_NIS: f32 = 10.0;
/// Squared movements, in units of the innovations' variance, from here on are jumps, after which the average
/// restarts.
const LARGEST_MOVEMENT: f32 = 1e4;
/// Smallest mean squared movement: with less, a wrong noise level can look like lateness.
const LEAST_MOVEMENT: f32 = 1.0;
/// Smallest significant correlation, in standard deviations. In 432 clean flights of 10 to 60 s the largest was 3.1.
const SIGNIFICANT: f32 = 6.0;
/// Smallest lateness that is reported, in samples of the innovations. A filter follows late outputs: a quarter of the
/// lateness remains in the innovations.
const LATE: f32 = 0.75;

/// Detects late outputs or inputs: the innovations are then proportional to the rate of change of the expected
/// output.
///
/// An output that is late by τ differs from its prediction by −τ times its derivative; late inputs look like early
/// outputs. Innovations of a correct model are white and independent of earlier predictions, so the sum of products
/// is a martingale, whose variance is the sum of their squares.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Lateness<const P: usize> {
    /// Exponential averages of the expected outputs.
    #[cfg_attr(feature = "serde", serde(with = "kestirim_snapshot::arrays"))]
    usual: [f32; P],
    /// Decaying sums, in units of the innovations' variances: innovation times movement, the square of that, and the
    /// movement squared.
    product: f32,
    variance: f32,
    moved: f32,
    /// Decaying number of outputs in the sums.
    count: f32,
}

impl<const P: usize> Lateness<P> {
    pub(crate) const NONE: Self =
        Self { usual: [0.0; P], product: 0.0, variance: 0.0, moved: 0.0, count: 0.0 };

    /// Adds the outputs of a sample.
    pub(crate) fn count(
        &mut self,
        measured: &[Option<f64>; P],
        innovations: &[Option<Innovation<f64>>; P],
    ) {
        const KEPT: f32 = 1.0 - 1.0 / MEMORY;
        for sum in [&mut self.product, &mut self.variance, &mut self.moved, &mut self.count] {
            *sum *= KEPT;
        }
        for (usual, (measured, innovation)) in
            self.usual.iter_mut().zip(measured.iter().zip(innovations))
        {
            let (Some(measured), Some(innovation)) = (measured, innovation) else { continue };
            let beyond = innovation.innovation as f32;
            let expected = *measured as f32 - beyond;
            let moved = expected - *usual;
            let scaled = moved / innovation.variance as f32;
            let (squared, product) = (moved * scaled, beyond * scaled);
            // A NaN fails this comparison, too.
            if squared < LARGEST_MOVEMENT {
                *usual += moved * (1.0 / LAG);
            } else {
                *usual = if expected.is_finite() { expected } else { 0.0 };
                continue;
            }
            if (innovation.nis as f32) < LARGEST_NIS {
                self.product += product;
                self.variance += product * product;
                self.moved += squared;
                self.count += 1.0;
            }
        }
    }

    /// Whether the lateness is significant and large enough to be reported.
    pub(crate) fn is_told(&self) -> bool {
        const LEAST: f32 = LATE / LAG;
        self.moved > LEAST_MOVEMENT * self.count
            && self.product.abs() > LEAST * self.moved
            && self.product * self.product > SIGNIFICANT * SIGNIFICANT * self.variance
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Innovations of unit variance, with noise, of a sine that is late by `late` samples.
    fn told(late: f64, amplitude: f64, wild: impl Fn(usize) -> Option<[f64; 3]>) -> bool {
        let mut lateness = Lateness::<1>::NONE;
        for at in 0..3000 {
            let turned = at as f64 * 0.03;
            let noise = 1.7 * libm::sin((at * at) as f64);
            let expected = amplitude * libm::sin(turned);
            let beyond = noise - late * 0.03 * amplitude * libm::cos(turned);
            let usual = [expected, beyond, 1.0];
            let [expected, innovation, variance] = wild(at).unwrap_or(usual);
            let nis = innovation * innovation / variance;
            let innovation = Innovation { innovation, variance, nis };
            lateness.count(&[Some(expected + innovation.innovation)], &[Some(innovation)]);
        }
        lateness.is_told()
    }

    #[test]
    fn what_is_late_or_early_is_told() {
        let usual = |_: usize| None;
        for late in [2.0, -2.0] {
            assert!(told(late, 10.0, usual), "{late}");
            assert!(!told(late, 0.5, usual), "nothing moves");
        }
        assert!(!told(0.0, 10.0, usual));
        assert!(!told(0.2, 100.0, usual), "a fifth of a sample");
    }

    #[test]
    fn no_number_is_the_end_of_it() {
        let wild = |number: f64, at: usize| (at < 200).then_some([number, -number, 1.0]);
        for number in [0.0, 1e30, 1e200, f64::MAX, f64::MIN_POSITIVE] {
            assert!(told(2.0, 10.0, |at| wild(number, at)), "{number}");
            assert!(!told(0.0, 10.0, |at| wild(number, at)), "{number}");
            let none = |at: usize| (at < 200).then_some([1.0, 0.0, 1.0 / number]);
            assert!(told(2.0, 10.0, none), "a variance of {}", 1.0 / number);
        }
    }
}
