//! `kestirim_uwb_tracker::EpochSolver` behind the trackers' face.

use kestirim_scalar::Scalar;
use kestirim_uwb_ranging::Solver;
use kestirim_uwb_tracker::{EpochMethod, EpochSolver, RangeSample};
use nalgebra::SVector;

use super::anchors::MOST;
use super::follow::{Follow, Reception, anchors, place, refused};
use super::motion::{Inertial, Wheels};
use super::options::Setup;
use crate::Error;

/// The freshest range of each anchor, and the position that they make.
#[derive(Debug)]
pub struct EachEpoch<T: Scalar, const D: usize> {
    solver: EpochSolver<T, MOST>,
    height_m: f64,
    position: Option<SVector<T, D>>,
}

impl<T: Scalar, const D: usize> EachEpoch<T, D> {
    /// Linear trilateration or nonlinear least squares.
    ///
    /// # Errors
    /// [`Error::Usage`] if these anchors will not do.
    pub fn new(setup: &Setup, method: EpochMethod) -> Result<Self, Error> {
        let solver = Solver { room: setup.room(), ..Solver::new(T::from_f64(setup.height_m)) };
        let solver = EpochSolver::new(method, solver, &anchors(setup)).map_err(refused)?;
        Ok(Self { solver, height_m: setup.height_m, position: None })
    }
}

impl<T: Scalar, const D: usize> Follow for EachEpoch<T, D> {
    fn set_height(&mut self, height_m: f64) {
        if self.solver.set_height(T::from_f64(height_m)).is_ok() {
            self.height_m = height_m;
        }
    }

    fn range(&mut self, time_us: u64, anchor: usize, range_m: f64) -> Reception {
        let sample = RangeSample { time_us, anchor, range: T::from_f64(range_m) };
        Reception::unweighed(self.solver.range(&sample).is_ok())
    }

    fn inertial(&mut self, _: u64, _: &Inertial) {}

    fn wheels(&mut self, _: u64, _: &Wheels) {}

    fn end_epoch(&mut self, time_us: u64) {
        self.position = self.solver.position(time_us, self.position).ok();
    }

    fn position(&self) -> Option<[f64; 3]> {
        place(&self.position?, self.height_m)
    }
}
