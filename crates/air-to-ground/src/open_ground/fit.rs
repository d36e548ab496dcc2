use kestirim_arithmetic::vectors::{Kernel, Vectors};
use kestirim_scalar::Scalar;

use super::Supposition;
use super::abreast::{Abreast, FREEDOM, WAVERING_DB};
use super::lanes::Lanes;
use super::normal::Normal;
use super::sight::{PATTERN_DB, Row, Sight, decibels, mean_square, used};

/// Number of steps of the fit, after which a further one changes no level by a tenth of a decibel.
const STEPS: usize = 5;
/// Largest change of the level in a step, dB.
const LONGEST_DB: f64 = 10.0;
/// Levels this far above the floor count as signals, dB.
const ABOVE_DB: f64 = 2.0;
/// Least number of signals from which the fit is started; with fewer, all levels are used.
const FEWEST: usize = 3;

/// The fit of the measurements under a supposition and a place.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct GroundFit<T> {
    /// ln ∫ likelihood · prior d(level, exponent, pattern), up to a constant that is the same everywhere.
    pub log_evidence: T,
    /// The level received at one metre, dB.
    pub level: T,
    /// The path-loss exponent.
    pub exponent: T,
}

impl<T: Scalar> GroundFit<T> {
    /// The level (dB), and its standard deviation, that a further measurement would show under the supposition of this
    /// fit: `from` there, at `height` above the transmitter, if that is at `place`.
    ///
    /// The antennas' gain in that direction counts as noise, since a fit does not provide it.
    pub fn expected(
        &self,
        supposition: &Supposition<T>,
        place: [T; 2],
        from: [T; 2],
        height: T,
    ) -> (T, T) {
        let distance = T::norm(&[from[0] - place[0], from[1] - place[1], height]).max(T::EPSILON);
        let signal = self.level - self.exponent * decibels(distance.ln());
        let [Lanes([level]), Lanes([share])] =
            Abreast::new(&[*supposition]).received(Lanes([signal]));
        let pattern = T::from_f64(PATTERN_DB) * mean_square::<T>(supposition.pattern).sqrt();
        // The variance of Student's distribution is that of its scale, times ν / (ν − 2).
        let scale = supposition.scale * T::from_f64(FREEDOM / (FREEDOM - 2.0)).sqrt();
        (level, T::norm(&[share * scale, share * pattern, T::from_f64(WAVERING_DB)]))
    }
}

/// Number of suppositions that are fitted side by side: one in each lane of a processor's vectors, if it has some.
const LANES: usize = if cfg!(feature = "vectors") { 4 } else { 1 };

/// The fit of the measurements under a supposition.
pub(super) fn one<T: Scalar, const P: usize>(
    sight: &Sight<T, P>,
    supposition: &Supposition<T>,
    power: T,
) -> GroundFit<T> {
    let [fit] = Fit { sight, suppositions: &[*supposition], power }.run();
    fit
}

/// Passes the fits under all suppositions of some patterns to `told`, with their index.
pub(super) fn each<T: Scalar, const P: usize>(
    sight: &Sight<T, P>,
    suppositions: &[Supposition<T>],
    is_asked: impl Fn(&Supposition<T>) -> bool,
    power: T,
    told: &mut impl FnMut(usize, &Supposition<T>, GroundFit<T>),
) {
    // In fixed point, whose products no vectors speed up, one at a time.
    let lanes = if T::IS_FLOAT { LANES } else { 1 };
    let mut index = 0;
    while let Some(first) = suppositions.get(index) {
        let group = suppositions.iter().skip(index).take(lanes);
        let group = group.take_while(|it| it.pattern == first.pattern);
        let count = group.clone().count();
        if !is_asked(first) {
            // Of another kind, whose sight has other parameters.
        } else if T::IS_FLOAT && count > 1 {
            let mut abreast = [*first; LANES];
            for (lane, supposition) in abreast.iter_mut().zip(group.clone()) {
                *lane = *supposition;
            }
            let fits = Vectors::widest().run(Fit { sight, suppositions: &abreast, power });
            for ((index, supposition), fit) in (index..).zip(group).zip(fits) {
                told(index, supposition, fit);
            }
        } else {
            told(index, first, one(sight, first, power));
        }
        index += count;
    }
}

/// The fits of the measurements under suppositions of one pattern. They are computed side by side, so that a processor
/// with vectors does the same step of several at a time.
struct Fit<'a, T, const P: usize, const W: usize> {
    sight: &'a Sight<T, P>,
    suppositions: &'a [Supposition<T>; W],
    power: T,
}

impl<T: Scalar, const P: usize, const W: usize> Kernel for Fit<'_, T, P, W> {
    type Output = [GroundFit<T>; W];

    #[inline(always)]
    fn run(self) -> Self::Output {
        let Self { sight, suppositions, power } = self;
        let used = suppositions.first().map_or(0, |it| used(it.pattern));
        let abreast = Abreast::new(suppositions);
        let mut parameters = [Lanes::all(T::ZERO); P];
        parameters[0] = Lanes(suppositions.each_ref().map(|it| start(sight, it) / sight.level[1]));
        for _ in 0..STEPS {
            let mut normal = Normal::new(used, &parameters);
            for row in sight.rows() {
                normal.add(row, &abreast.seen(row, &parameters, used, power));
            }
            normal.decompose();
            let change = normal.solve();
            let longest = T::from_f64(LONGEST_DB);
            let share = change[0].map(|level| {
                let far = level.abs() * sight.level[1];
                if far > longest { longest / far } else { T::ONE }
            });
            for (parameter, change) in parameters.iter_mut().zip(change) {
                *parameter += share * change;
            }
        }
        let mut normal = Normal::new(used, &parameters);
        let mut log_likelihood = Lanes::all(T::ZERO);
        let mut squares = Lanes::all(T::ZERO);
        for row in sight.rows() {
            let seen = abreast.seen(row, &parameters, used, power);
            log_likelihood += seen.log_density();
            normal.add(row, &seen);
        }
        for parameter in parameters.iter().take(used) {
            squares += *parameter * *parameter;
        }
        normal.decompose();
        let log_evidence = log_likelihood * power - squares * T::HALF - normal.log_determinant();
        core::array::from_fn(|lane| {
            let [level, exponent] = sight.named(&parameters.map(|parameter| parameter.0[lane]));
            GroundFit { log_evidence: log_evidence.0[lane], level, exponent }
        })
    }
}

/// The mean excess of the signals over what is expected, dB.
fn start<T: Scalar, const P: usize>(sight: &Sight<T, P>, supposition: &Supposition<T>) -> T {
    let is_signal = |row: &&Row<T, P>| {
        supposition.floor.is_none_or(|floor| row.level > floor + T::from_f64(ABOVE_DB))
    };
    let mean = |signals: bool| {
        let (mut mean, mut count) = (T::ZERO, 0);
        for row in sight.rows().iter().filter(|row| !signals || is_signal(row)) {
            count += 1;
            mean += (row.level - row.expected - mean) / T::from_binary(count, 0);
        }
        (mean, count as usize)
    };
    let (of_signals, count) = mean(true);
    if count < FEWEST { mean(false).0 } else { of_signals }
}
