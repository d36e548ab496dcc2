use kestirim_arithmetic::vectors::Kernel;
use kestirim_scalar::Scalar;

use crate::blocks::{BLOCK, Block, Points, gather, on_vectors};
use crate::likelihood::Closure;
use crate::{Error, Likelihood};

/// Number of partial sums, for vector instructions and the same rounding on every machine.
const LANES: usize = 4;

/// Result of an update by a measurement.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Update<T> {
    /// Effective number of particles (Σw)²/Σw², from one to all.
    pub effective: T,
    /// Logarithm of the density of the measurement, given all earlier measurements.
    pub log_evidence: T,
}

/// Logarithms of the weights, the largest of them zero; that of a weight of zero is −∞ or the lower limit of fixed
/// point.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: serde::Serialize",
        deserialize = "T: Scalar + serde::Deserialize<'de>"
    ))
)]
pub(crate) struct Weights<T, const N: usize> {
    #[cfg_attr(feature = "serde", serde(with = "kestirim_snapshot::arrays"))]
    log: [T; N],
    #[cfg_attr(feature = "serde", serde(deserialize_with = "used::<_, N>"))]
    count: usize,
    /// Σw, Σw².
    sum: T,
    square_sum: T,
}

/// Deserialises the number of points in use: at least one, at most N.
#[cfg(feature = "serde")]
fn used<'de, D: serde::Deserializer<'de>, const N: usize>(
    deserializer: D,
) -> Result<usize, D::Error> {
    let count = kestirim_snapshot::arrays::count::<D, N>(deserializer)?;
    if count > 0 { Ok(count) } else { Err(serde::de::Error::custom("no points")) }
}

/// ln 0, the logarithm of a weight of zero.
#[inline(always)]
pub(crate) fn never<T: Scalar>() -> T {
    T::ZERO.ln()
}

impl<T: Scalar, const N: usize> Weights<T, N> {
    /// `count` equal weights.
    #[inline]
    pub(crate) fn equal(count: usize) -> Self {
        const { assert!(N as u64 <= T::MAX_WHOLE as u64, "the numbers hold the sum of N weights") };
        let mut weights = Self { log: [T::ZERO; N], count: 0, sum: T::ZERO, square_sum: T::ZERO };
        weights.equalise(count);
        weights
    }

    #[inline]
    pub(crate) fn equalise(&mut self, count: usize) {
        self.count = count.min(N);
        for log in self.log.iter_mut().take(self.count) {
            *log = T::ZERO;
        }
        self.sum = T::from_binary(self.count as i32, 0);
        self.square_sum = self.sum;
    }

    #[inline(always)]
    pub(crate) fn count(&self) -> usize {
        // The compiler cannot know that the count never exceeds N, and would check every index.
        self.count.min(N)
    }

    /// The logarithms of the block from index `base` on; `None` beyond the last.
    #[inline(always)]
    pub(crate) fn block(&self, base: usize) -> Option<&[T]> {
        let end = base.saturating_add(BLOCK).min(self.count);
        self.log.get(base..end).filter(|block| !block.is_empty())
    }

    #[inline(always)]
    pub(crate) fn logs(&self) -> &[T] {
        self.log.get(..self.count).unwrap_or(&self.log)
    }

    /// The index of the largest weight.
    #[inline]
    pub(crate) fn heaviest(&self) -> usize {
        // The largest logarithm is exactly zero.
        self.logs().iter().position(|log| *log == T::ZERO).unwrap_or(0)
    }

    /// The weight at `index`, relative to the largest.
    #[inline(always)]
    pub(crate) fn of(&self, index: usize) -> T {
        self.log[index].exp()
    }

    /// The sum of the weights.
    #[inline(always)]
    pub(crate) fn sum(&self) -> T {
        self.sum
    }

    #[inline(always)]
    pub(crate) fn effective(&self) -> T {
        self.sum * (self.sum / self.square_sum)
    }

    /// Multiplies each weight by a likelihood; a likelihood that is zero, infinite or NaN makes the weight zero.
    ///
    /// # Errors
    /// [`Error::Degenerate`] if all weights would be zero; none has changed then.
    #[inline(always)]
    pub(crate) fn update<const D: usize>(
        &mut self,
        points: &impl Points<T, D>,
        log_likelihood: impl Fn([T; D]) -> T,
    ) -> Result<Update<T>, Error> {
        self.multiply(points, &Closure(log_likelihood))
    }

    /// [`Weights::update`] on the widest vectors of the processor.
    ///
    /// # Errors
    /// As [`Weights::update`].
    #[inline(always)]
    pub(crate) fn weigh<const D: usize>(
        &mut self,
        points: &impl Points<T, D>,
        likelihood: &impl Likelihood<T, D>,
    ) -> Result<Update<T>, Error> {
        on_vectors::<T, _>(Weighing { weights: self, points, likelihood })
    }

    #[inline(always)]
    fn multiply<const D: usize>(
        &mut self,
        points: &impl Points<T, D>,
        likelihood: &impl Likelihood<T, D>,
    ) -> Result<Update<T>, Error> {
        let never = never::<T>();
        let mut room = [[T::ZERO; BLOCK]; D];
        let (mut largest, mut base) = (never, 0);
        while let Some(logs) = self.block(base) {
            let block = points.load(base, logs.len(), &mut room);
            let mut fresh = [never; BLOCK];
            for (index, (slot, &log)) in fresh.iter_mut().zip(logs).enumerate() {
                let gain = likelihood.logarithm(gather(&block, index));
                let value = log + gain;
                *slot = if gain.is_finite() && value.is_finite() { value } else { never };
            }
            let peak = largest_of(fresh);
            if peak > never && largest == never {
                // First block with a positive weight: only now may the weights before it be set to zero.
                self.log.iter_mut().take(base).for_each(|log| *log = never);
            }
            largest = if peak > largest { peak } else { largest };
            if largest > never {
                for (log, value) in self.log.iter_mut().take(self.count).skip(base).zip(fresh) {
                    *log = value;
                }
            }
            base += BLOCK;
        }
        if largest == never {
            return Err(Error::Degenerate);
        }
        let before = self.sum;
        self.normalise(largest);
        let log_evidence = largest + (self.sum / before).ln();
        Ok(Update { effective: self.effective(), log_evidence })
    }

    /// Sums Σ aᵢ·bᵢ of R × C pairs, where `factors` gives the pairs of each weight (the largest is one) and its point.
    #[inline(always)]
    pub(crate) fn sums<const D: usize, const R: usize, const C: usize>(
        &self,
        points: &impl Points<T, D>,
        factors: impl Fn(T, [T; D]) -> [[(T, T); C]; R],
    ) -> [[T; C]; R] {
        let mut lanes = [[[T::accumulator(); LANES]; C]; R];
        let mut room = [[T::ZERO; BLOCK]; D];
        let mut weight = [T::ZERO; BLOCK];
        let mut base = 0;
        while let Some(logs) = self.block(base) {
            let block = points.load(base, logs.len(), &mut room);
            for (weight, &log) in weight.iter_mut().zip(logs) {
                *weight = log.exp();
            }
            // Unused places of the last block have no weight.
            weight.iter_mut().skip(logs.len()).for_each(|weight| *weight = T::ZERO);
            let mut first = 0;
            while first < logs.len() && first <= BLOCK - LANES {
                for lane in 0..LANES {
                    let pairs = factors(weight[first + lane], gather(&block, first + lane));
                    for row in 0..R {
                        for column in 0..C {
                            let (a, b) = pairs[row][column];
                            lanes[row][column][lane] = T::mac(lanes[row][column][lane], a, b);
                        }
                    }
                }
                first += LANES;
            }
            base += BLOCK;
        }
        lanes.map(|row| {
            row.map(|[a, b, c, d]| (T::finish(a) + T::finish(b)) + (T::finish(c) + T::finish(d)))
        })
    }

    /// Subtracts the largest logarithm from all, and sums up the weights.
    #[inline(always)]
    fn normalise(&mut self, largest: T) {
        let never = never::<T>();
        for log in self.log.iter_mut().take(self.count) {
            let value = *log - largest;
            // At the lower limit of fixed point, the difference would move away from it.
            *log = if *log > never { value } else { never };
        }
        let [[sum, square_sum]] =
            self.sums(&Nowhere, |weight, []| [[(weight, T::ONE), (weight, weight)]]);
        self.sum = sum;
        self.square_sum = square_sum;
    }
}

/// An update by a measurement, as a kernel for vectors.
pub(crate) struct Weighing<'a, T, P, L, const D: usize, const N: usize> {
    pub(crate) weights: &'a mut Weights<T, N>,
    pub(crate) points: &'a P,
    pub(crate) likelihood: &'a L,
}

impl<T, P, L, const D: usize, const N: usize> Kernel for Weighing<'_, T, P, L, D, N>
where
    T: Scalar,
    P: Points<T, D>,
    L: Likelihood<T, D>,
{
    type Output = Result<Update<T>, Error>;

    #[inline(always)]
    fn run(self) -> Self::Output {
        self.weights.multiply(self.points, self.likelihood)
    }
}

/// Points without coordinates, for sums over weights alone.
struct Nowhere;

impl<T> Points<T, 0> for Nowhere {
    #[inline(always)]
    fn load<'a>(&'a self, _: usize, _: usize, _: &'a mut Block<T, 0>) -> [&'a [T; BLOCK]; 0] {
        []
    }
}

/// The largest value of a block, by halving it lane by lane.
#[inline(always)]
fn largest_of<T: Scalar>(mut values: [T; BLOCK]) -> T {
    let mut half = BLOCK / 2;
    while half > 0 {
        for lane in 0..half {
            let (a, b) = (values[lane], values[lane + half]);
            values[lane] = if b > a { b } else { a };
        }
        half /= 2;
    }
    values[0]
}
