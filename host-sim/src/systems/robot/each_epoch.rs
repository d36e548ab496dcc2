//! Positions from the ranges of one moment, without memory: the paper's "unfiltered".

use kestirim_scalar::Scalar;
use kestirim_uwb_ranging::{Observation, Solver, Trilateration};
use nalgebra::SVector;

use super::follow::{Follow, Reception};
use super::motion::{Inertial, Wheels};
use super::options::Setup;

/// A range older than this says nothing about now, µs.
const FRESH_US: u64 = 1_000_000;
/// What no radio measures, m.
const PLAUSIBLE: std::ops::RangeInclusive<f64> = -1.0..=200.0;

/// Least squares of the freshest range of each anchor.
#[derive(Debug)]
pub struct EachEpoch<T: Scalar, const D: usize> {
    anchors: Vec<SVector<T, 3>>,
    biases: Vec<f64>,
    last: Vec<Option<(u64, T)>>,
    solver: Solver<T>,
    height_m: f64,
    linear: bool,
    position: Option<SVector<T, D>>,
}

impl<T: Scalar, const D: usize> EachEpoch<T, D> {
    /// Linear trilateration or nonlinear least squares.
    pub fn new(setup: &Setup, linear: bool) -> Self {
        let count = setup.anchors.len();
        let solver = Solver { room: setup.room(), ..Solver::new(T::from_f64(setup.height_m)) };
        Self {
            anchors: setup.anchors.iter().map(|at| SVector::from(at.map(T::from_f64))).collect(),
            biases: (0..count).map(|anchor| setup.bias(anchor)).collect(),
            last: vec![None; count],
            solver,
            height_m: setup.height_m,
            linear,
            position: None,
        }
    }

    fn fresh(&self, time_us: u64) -> (Vec<SVector<T, 3>>, Vec<T>) {
        let pairs = self.anchors.iter().zip(&self.last);
        let fresh = pairs.filter_map(|(&anchor, last)| {
            let (heard_us, range) = (*last)?;
            (time_us.saturating_sub(heard_us) <= FRESH_US).then_some((anchor, range))
        });
        fresh.unzip()
    }
}

/// Trilateration for a number of anchors that is known only now.
fn trilaterated<T: Scalar, const D: usize>(
    anchors: &[SVector<T, 3>],
    ranges: &[T],
    height: T,
) -> Option<SVector<T, D>> {
    fn with<T: Scalar, const A: usize, const D: usize>(
        anchors: &[SVector<T, 3>],
        ranges: &[T],
        height: T,
    ) -> Option<SVector<T, D>> {
        let anchors = <[SVector<T, 3>; A]>::try_from(anchors).ok()?;
        let ranges = <&[T; A]>::try_from(ranges).ok()?;
        Trilateration::<T, A, D>::new(anchors).ok()?.position(ranges, height).ok()
    }
    macro_rules! first_of {
        ($($count:literal)*) => {
            match anchors.len() {
                $($count => with::<T, $count, D>(anchors, ranges, height),)*
                _ => None,
            }
        };
    }
    first_of!(3 4 5 6 7 8 9 10 11 12 13 14 15 16)
}

impl<T: Scalar, const D: usize> Follow for EachEpoch<T, D> {
    fn set_height(&mut self, height_m: f64) {
        self.height_m = height_m;
        self.solver.height = T::from_f64(height_m);
    }

    fn range(&mut self, time_us: u64, anchor: usize, range_m: f64) -> Reception {
        let (Some(last), Some(bias)) = (self.last.get_mut(anchor), self.biases.get(anchor)) else {
            return Reception::unweighed(false);
        };
        let newer = last.is_none_or(|(heard_us, _)| heard_us < time_us);
        let plausible = PLAUSIBLE.contains(&range_m) && newer;
        if plausible {
            *last = Some((time_us, T::from_f64(range_m - bias)));
        }
        Reception::unweighed(plausible)
    }

    fn inertial(&mut self, _: u64, _: &Inertial) {}

    fn wheels(&mut self, _: u64, _: &Wheels) {}

    fn end_epoch(&mut self, time_us: u64) {
        let (anchors, ranges) = self.fresh(time_us);
        self.position = if self.linear {
            trilaterated(&anchors, &ranges, self.solver.height)
        } else {
            let variance = T::from_f64(0.01);
            let pairs = anchors.into_iter().zip(ranges);
            let observations: Vec<_> =
                pairs.map(|(anchor, range)| Observation { anchor, range, variance }).collect();
            self.solver.solve(&observations, self.position).ok().map(|fix| fix.position)
        };
    }

    fn position(&self) -> Option<[f64; 3]> {
        let position = self.position?;
        let coordinate = |axis| position.get(axis).map(|coordinate: &T| coordinate.to_f64());
        Some([coordinate(0)?, coordinate(1)?, coordinate(2).unwrap_or(self.height_m)])
    }
}
