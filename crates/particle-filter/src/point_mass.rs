use kestirim_scalar::Scalar;

use crate::blocks::{BLOCK, Block, Points};
use crate::moments::bounds;
use crate::particles::check;
use crate::sequence::{Steps, lattice_point, placed};
use crate::weights::{Weights, never};
use crate::{Error, Likelihood, Moments, Region, Update};

/// A posterior on up to N fixed points: the golden lattice in a box of D dimensions.
///
/// The most accurate filter of this crate for small static problems: its points are fixed, so that it needs no randomness, and
/// the mean over a smooth posterior is right to many digits as soon as the lattice is finer than the
/// posterior. When it no longer is, [`PointMass::finer`] lays another where the weight is; that takes the
/// measurements once more. Points are computed, not stored: 4·N bytes in single precision.
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
    /// Equal weights all over a region.
    #[inline]
    pub fn new(region: &Region<T, D>) -> Self {
        const { assert!(0 < D && 0 < N && N <= 1 << 24, "points in a box") };
        Self { region: *region, weights: Weights::equal(N) }
    }

    /// Equal weights on a lattice of `count` points.
    ///
    /// # Errors
    /// [`Error::NotPositive`] for none, [`Error::TooMany`] for more than N.
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

    /// A point of the lattice.
    #[inline]
    pub fn point(&self, index: usize) -> Option<[T; D]> {
        (index < self.len()).then(|| Lattice::new(&self.region, self.len()).at(index as u32))
    }

    /// Logarithms of the weights; the largest is zero, that of a weight of zero −∞ (the lower rail in fixed
    /// point).
    #[inline]
    pub fn log_weights(&self) -> &[T] {
        self.weights.logs()
    }

    /// The number of the point of the largest weight.
    #[inline]
    pub fn heaviest(&self) -> usize {
        self.weights.heaviest()
    }

    /// Effective number of points (Σw)²/Σw².
    #[inline]
    pub fn effective(&self) -> T {
        self.weights.effective()
    }

    /// Weighs each point by the likelihood of a measurement: `log_likelihood` of its place.
    ///
    /// # Errors
    /// [`Error::Degenerate`] if no point explains the measurement; then nothing has changed.
    #[inline(always)]
    pub fn update(&mut self, log_likelihood: impl Fn([T; D]) -> T) -> Result<Update<T>, Error> {
        self.weights.update(&Lattice::new(&self.region, self.len()), log_likelihood)
    }

    /// [`PointMass::update`] by a likelihood that is inlined: on the widest vectors of the processor where feature
    /// `vectors` is on, with the same result on all.
    ///
    /// # Errors
    /// As [`PointMass::update`].
    #[inline(always)]
    pub fn weigh(&mut self, likelihood: &impl Likelihood<T, D>) -> Result<Update<T>, Error> {
        self.weights.weigh(&Lattice::new(&self.region, self.len()), likelihood)
    }

    /// A lattice over the box around all weights that are more than exp(−`depth`) of the largest, with a point's
    /// room on each side; none if it would hardly be smaller than this one. Its weights are equal: it is to be
    /// updated by all measurements so far.
    pub fn finer(&self, depth: T) -> Option<Self> {
        let region = self.heavy_region(depth)?;
        Some(Self { region, weights: Weights::equal(self.len()) })
    }

    /// The box around what has weight, if it is worth while: smaller than nine tenths of the old one.
    fn heavy_region(&self, depth: T) -> Option<Region<T, D>> {
        let points = Lattice::new(&self.region, self.len());
        let (mut low, mut high) = bounds(&self.weights, &points, |log| log > -depth);
        // As much room as a point has: N^(−1/D) of the side.
        let share =
            (-T::from_binary(self.len() as i32, 0).ln() / T::from_binary(D as i32, 0)).exp();
        let (old, mut volume) = (self.region.width(), T::ONE);
        for axis in 0..D {
            let room = old[axis] * share;
            low[axis] = (low[axis] - room).max(self.region.low()[axis]);
            high[axis] = (high[axis] + room).min(self.region.high()[axis]);
            volume *= (high[axis] - low[axis]) / old[axis].max(T::EPSILON);
        }
        let smaller = volume < T::from_f64(0.9);
        Region::new(low, high).ok().filter(|_| smaller)
    }

    /// Weighted mean and spread.
    #[inline]
    pub fn moments(&self) -> Moments<T, D> {
        Moments::of(&self.weights, &Lattice::new(&self.region, self.len()))
    }

    /// The logarithm, relative to the largest weight, of the density above which `mass` (0 to 1) of the
    /// posterior lies: the border of its credible region.
    ///
    /// By bisection to a thousandth: O(16·N).
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
