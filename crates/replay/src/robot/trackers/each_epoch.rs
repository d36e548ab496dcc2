//! `kestirim_uwb_tracker::EpochSolver` behind the trackers' interface.

use kestirim_scalar::Scalar;
use kestirim_uwb_ranging::Solver;
use kestirim_uwb_tracker::{EpochMethod, EpochSolver};
use nalgebra::SVector;

use super::{Follow, Reception, place, sample};
use crate::robot::{Error, Event, MOST, Setup};

/// A tracker that computes the position from the latest range of each anchor.
#[derive(Debug)]
pub(super) struct EachEpoch<T: Scalar, const D: usize> {
    solver: EpochSolver<T, MOST>,
    height_m: f64,
    position: Option<SVector<T, D>>,
}

impl<T: Scalar, const D: usize> EachEpoch<T, D> {
    /// A tracker with linear trilateration or nonlinear least squares.
    ///
    /// # Errors
    /// [`Error::Anchors`] if the anchors are unsuitable.
    pub(super) fn new(setup: &Setup, method: EpochMethod) -> Result<Self, Error> {
        let solver = Solver { room: setup.room(), ..Solver::new(T::from_f64(setup.height_m)) };
        let solver = EpochSolver::new(method, solver, &setup.anchors())?;
        Ok(Self { solver, height_m: setup.height_m, position: None })
    }
}

impl<T: Scalar, const D: usize> Follow for EachEpoch<T, D> {
    fn take(&mut self, time_us: u64, event: &Event) -> Reception {
        let taken = match *event {
            Event::Range(ref range) => self.solver.range(&sample(time_us, range)).is_ok(),
            Event::Height { metres, .. } => {
                let set = self.solver.set_height(T::from_f64(metres)).is_ok();
                if set {
                    self.height_m = metres;
                }
                set
            }
            Event::EpochEnd { .. } => {
                self.position = self.solver.position(time_us, self.position).ok();
                true
            }
            // Other events are not used.
            _ => true,
        };
        Reception::unweighed(taken)
    }

    fn position(&self) -> Option<[f64; 3]> {
        place(&self.position?, self.height_m)
    }
}
