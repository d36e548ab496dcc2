//! From messages to the estimator, and what came of it to whoever looks on.

use kestirim_telemetry::{Flight, Imu, Message, PathLoss, Range};

use super::clock::{Clock, Verdict};
use super::estimator::{Estimator, Outcome, Plan};
use super::state::State;
use crate::Error;

/// Feeds an estimator.
#[derive(Debug)]
pub(super) struct Feed {
    plan: Plan,
    estimator: Option<Box<dyn Estimator>>,
    clock: Clock,
}

impl Feed {
    /// With a fresh estimator.
    pub(super) fn new(plan: Plan) -> Result<Self, Error> {
        let estimator = plan.build()?;
        Ok(Self { plan, estimator, clock: Clock::default() })
    }

    /// Takes in a message. What cannot be true is counted and no more.
    pub(super) fn take(&mut self, message: &Message, state: &mut State) -> Result<(), Error> {
        let Some(time_us) = measured(message) else {
            state.tell(message);
            return Ok(());
        };
        let outcome = match self.clock.judge(time_us) {
            Verdict::Odd => Outcome::Refused,
            Verdict::Anew => {
                state.restart();
                self.estimator = self.plan.build()?;
                self.measure(message)
            }
            Verdict::Fits => self.measure(message),
        };
        state.measure(time_us, message, outcome, self.estimator.as_deref());
        Ok(())
    }

    fn measure(&mut self, message: &Message) -> Outcome {
        self.estimator.as_mut().map_or(Outcome::NotMine, |estimator| estimator.take(message))
    }

    /// Nothing more is there for now.
    pub(super) fn settle(&mut self) {
        if let Some(estimator) = &mut self.estimator {
            estimator.settle();
        }
    }

    /// Nothing more will come.
    pub(super) fn finish(&mut self) {
        if let Some(estimator) = &mut self.estimator {
            estimator.finish();
        }
    }

    /// Shows how the estimator is doing.
    pub(super) fn show(&self, state: &mut State) {
        if let Some(estimator) = &self.estimator {
            state.show(estimator.as_ref());
        }
    }
}

/// When a measurement was made, if it is one.
fn measured(message: &Message) -> Option<u64> {
    match message {
        Message::Imu(Imu { time_us, .. })
        | Message::Range(Range { time_us, .. })
        | Message::PathLoss(PathLoss { time_us, .. })
        | Message::Flight(Flight { time_us, .. }) => Some(*time_us),
        _ => None,
    }
}
