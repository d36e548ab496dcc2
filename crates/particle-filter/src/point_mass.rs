use kestirim_scalar::Scalar;

use crate::blocks::{BLOCK, Block, Points};
use crate::moments::bounds;
use crate::particles::check;
use crate::sequence::{Steps, lattice_point, placed};
use crate::weights::{Weights, never};
use crate::{Error, Likelihood, Moments, Region, Update};

/// A posterior on up to N fixed points: the golden lattice in a box of D dimensions.
///
/// The most accurate filter of this crate for small static problems. Its points are fixed, so it needs no randomness,
/// and the mean over a smooth posterior is correct to many digits as long as the lattice is finer than the posterior.
/// When it no longer is, [`PointMass::finer`] lays another lattice where the weight is, to which the measurements must
/// be applied once more. Points are computed, not stored: 4·N bytes in single precision.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: serde::Serialize",
        deserialize = "T: Scalar + serde::Deserialize<'de>"
    ))
)]
pub struct PointMass<T, const D: usize, const N: usize> {
    region: Region<T, D>,
    weights: Weights<T, N>,
}

impl<T: Scalar, const D: usize, const N: usize> PointMass<T, D, N> {
    /// Equal weights on a lattice of N points over a region.
    #[inline]
    pub fn new(region: &Region<T, D>) -> Self {
        const { assert!(0 < D && 0 < N, "points in a box") };
        Self { region: *region, weights: Weights::equal(N) }
    }

    /// Equal weights on a lattice of `count` points over a region.
    ///
    /// # Errors
    /// [`Error::NotPositive`] if `count` is zero, [`Error::TooMany`] if it is above N.
    #[inline]
    pub fn with_count(count: usize, region: &Region<T, D>) -> Result<Self, Error> {
        check(count, N)?;
        Ok(Self { region: *region, weights: Weights::equal(count) })
    }

    /// The number of points.
    #[inline]
    pub fn len(&self) -> usize {
        self.weights.count()
    }

    /// Always false: there is at least one point.
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The box that the lattice fills.
    #[inline]
    pub fn region(&self) -> &Region<T, D> {
        &self.region
    }

    /// The coordinates of a point of the lattice; `None` beyond the last one.
    #[inline]
    pub fn point(&self, index: usize) -> Option<[T; D]> {
        (index < self.len()).then(|| Lattice::new(&self.region, self.len()).at(index as u32))
    }

    /// Logarithms of the weights; the largest is zero, and that of a weight of zero is −∞ (the lower limit in fixed
    /// point).
    #[inline]
    pub fn log_weights(&self) -> &[T] {
        self.weights.logs()
    }

    /// The index of the point of the largest weight.
    #[inline]
    pub fn heaviest(&self) -> usize {
        self.weights.heaviest()
    }

    /// The sum of the weights Σw, the largest of which is one.
    #[inline]
    pub fn sum(&self) -> T {
        self.weights.sum()
    }

    /// Effective number of points (Σw)²/Σw².
    #[inline]
    pub fn effective(&self) -> T {
        self.weights.effective()
    }

    /// Multiplies the weight of each point by the likelihood of a measurement, given `log_likelihood` of its
    /// coordinates.
    ///
    /// # Errors
    /// [`Error::Degenerate`] if no point explains the measurement; nothing has changed then.
    #[inline(always)]
    pub fn update(&mut self, log_likelihood: impl Fn([T; D]) -> T) -> Result<Update<T>, Error> {
        self.weights.update(&Lattice::new(&self.region, self.len()), log_likelihood)
    }

    /// [`PointMass::update`] with a likelihood that is inlined: with feature `vectors` on the widest vectors of the
    /// processor, with the same result on all.
    ///
    /// # Errors
    /// As [`PointMass::update`].
    #[inline(always)]
    pub fn weigh(&mut self, likelihood: &impl Likelihood<T, D>) -> Result<Update<T>, Error> {
        self.weights.weigh(&Lattice::new(&self.region, self.len()), likelihood)
    }

    /// A finer lattice over the bounding box of all weights above exp(−`depth`) of the largest, with the spacing of a
    /// point added on each side; `None` if its volume would not be below nine tenths of this one's. Its weights are
    /// equal, so all measurements so far must be applied to it.
    pub fn finer(&self, depth: T) -> Option<Self> {
        let region = self.heavy_region(depth)?;
        Some(Self { region, weights: Weights::equal(self.len()) })
    }

    /// The bounding box of the relevant weights; `None` unless its volume is below nine tenths of the old one.
    fn heavy_region(&self, depth: T) -> Option<Region<T, D>> {
        let points = Lattice::new(&self.region, self.len());
        let (mut low, mut high) = bounds(&self.weights, &points, |log| log > -depth);
        // The spacing of points as a share of the side: N^(−1/D).
        let (old, mut volume) = (self.region.width(), T::ONE);
        // An axis without width has nothing to become smaller.
        let axes = old.iter().filter(|&&width| width > T::ZERO).count().max(1);
        let share =
            (-T::from_binary(self.len() as i32, 0).ln() / T::from_binary(axes as i32, 0)).exp();
        for axis in 0..D {
            let room = old[axis] * share;
            low[axis] = (low[axis] - room).max(self.region.low()[axis]);
            high[axis] = (high[axis] + room).min(self.region.high()[axis]);
            if old[axis] > T::ZERO {
                volume *= (high[axis] - low[axis]) / old[axis];
            }
        }
        let smaller = volume < T::from_f64(0.9);
        Region::new(low, high).ok().filter(|_| smaller)
    }

    /// Weighted mean and covariance of the points.
    #[inline]
    pub fn moments(&self) -> Moments<T, D> {
        Moments::of(&self.weights, &Lattice::new(&self.region, self.len()))
    }

    /// The logarithmic density, relative to the largest weight, above which `mass` (0 to 1) of the
    /// posterior lies: the border of its credible region.
    ///
    /// Found by bisection to a thousandth: O(16·N).
    pub fn density_level(&self, mass: T) -> T {
        let wanted = self.weights.sum() * mass;
        let (mut above, mut below) = (T::ZERO, -T::from_f64(32.0));
        for _ in 0..16 {
            let level = above * T::HALF + below * T::HALF;
            let mut sum = T::ZERO;
            for (index, &log) in self.weights.logs().iter().enumerate() {
                if log > never() && log >= level {
                    sum += self.weights.of(index.min(N - 1));
                }
            }
            if sum >= wanted { below = level } else { above = level }
        }
        below
    }
}

/// The points of the golden lattice in a region.
struct Lattice<T, const D: usize> {
    low: [T; D],
    width: [T; D],
    steps: Steps,
}

impl<T: Scalar, const D: usize> Lattice<T, D> {
    #[inline(always)]
    fn new(region: &Region<T, D>, count: usize) -> Self {
        Self { low: *region.low(), width: region.width(), steps: Steps::of(count) }
    }

    #[inline(always)]
    fn at(&self, index: u32) -> [T; D] {
        placed(lattice_point(index, self.steps), &self.low, &self.width)
    }
}

impl<T: Scalar, const D: usize> Points<T, D> for Lattice<T, D> {
    #[inline(always)]
    fn load<'a>(
        &'a self,
        base: usize,
        used: usize,
        room: &'a mut Block<T, D>,
    ) -> [&'a [T; BLOCK]; D] {
        for index in 0..used.min(BLOCK) {
            let point = self.at((base + index) as u32);
            for axis in 0..D {
                room[axis][index] = point[axis];
            }
        }
        room.each_ref()
    }
}
