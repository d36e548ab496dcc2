//! Passes messages to the estimator, and its results to the state.

use std::sync::Arc;

use kestirim_telemetry::Message;

use super::clock::{Clock, Verdict};
use super::state::State;
use crate::Error;
use crate::system::{Online, Outcome, Plan};

/// Feeds an estimator with messages.
#[derive(Debug)]
pub(super) struct Feed {
    plan: Option<Arc<dyn Plan>>,
    estimator: Option<Box<dyn Online>>,
    clock: Clock,
}

impl Feed {
    /// A feed with a fresh estimator.
    pub(super) fn new(plan: Option<Arc<dyn Plan>>) -> Result<Self, Error> {
        let estimator = plan.as_deref().map(Plan::build).transpose()?;
        Ok(Self { plan, estimator, clock: Clock::default() })
    }

    /// Processes a message. An implausible one is only counted.
    pub(super) fn take(&mut self, message: &Message, state: &mut State) -> Result<(), Error> {
        let Some(time_us) = message.measured_us() else {
            state.tell(message);
            return Ok(());
        };
        let outcome = match self.clock.judge(time_us) {
            Verdict::Odd => Outcome::Refused,
            Verdict::Anew => {
                self.rebuild(state)?;
                self.measure(message)
            }
            Verdict::Fits => self.measure(message),
        };
        state.measure(time_us, message, outcome, self.estimator.as_deref());
        Ok(())
    }

    /// Restarts after the sender reports that it was switched on again.
    pub(super) fn begin_anew(&mut self, state: &mut State) -> Result<(), Error> {
        self.clock = Clock::default();
        self.rebuild(state)
    }

    fn rebuild(&mut self, state: &mut State) -> Result<(), Error> {
        state.restart();
        self.estimator = self.plan.as_deref().map(Plan::build).transpose()?;
        Ok(())
    }

    fn measure(&mut self, message: &Message) -> Outcome {
        self.estimator.as_mut().map_or(Outcome::NotMine, |estimator| estimator.take(message))
    }

    /// Performs lengthy work while no more input is waiting.
    pub(super) fn settle(&mut self) {
        if let Some(estimator) = &mut self.estimator {
            estimator.settle();
        }
    }

    /// Ends the stream.
    ///
    /// # Errors
    /// Those of [`Online::finish`].
    pub(super) fn finish(&mut self) -> Result<(), Error> {
        self.estimator.as_mut().map_or(Ok(()), |estimator| estimator.finish())
    }

    /// Updates the shown state from the estimator.
    pub(super) fn show(&self, state: &mut State) {
        if let Some(estimator) = &self.estimator {
            state.show(estimator.as_ref());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::options::Following;
    use super::*;
    use crate::system::{AnySystem, Files, Panel, Settings};
    use crate::systems::ALL;
    use kestirim_health::{Health, Reason};
    use kestirim_telemetry::{
        EstimateHealth, Footprint, GlobalPosition, Imu, PathLoss, Position, Range,
    };

    /// The systems whose estimators are built without files and use messages.
    fn systems() -> impl Iterator<Item = Following> {
        let of_telemetry = ALL.iter().filter(|system| !system.hears_bytes());
        of_telemetry.filter_map(|system| following(*system))
    }

    fn following(system: &'static dyn AnySystem) -> Option<Following> {
        Following::of(system, &Settings::new(system.settings()), &Files::default()).ok()
    }

    /// A system whose estimator uses messages like this.
    fn taking(message: &Message) -> Following {
        let takes = |following: &Following| {
            let online = following.plan.as_deref().map(|plan| plan.build().unwrap());
            online.is_some_and(|mut online| online.take(message) != Outcome::NotMine)
        };
        systems().find(takes).expect("a system that takes this")
    }

    fn feed(following: &Following) -> (Feed, State) {
        (Feed::new(following.plan.clone()).unwrap(), State::new(following))
    }

    fn still(time_us: u64) -> Message {
        let (specific_force, angular_rate) = ([0.0, 0.0, 9.81], [0.0; 3]);
        Imu { time_us, specific_force, angular_rate }.into()
    }

    #[test]
    fn a_sender_that_begins_anew_is_followed_anew() -> Result<(), Error> {
        let (mut feed, mut state) = feed(&taking(&still(0)));
        let mut send = |from_us: u64, count: u64, state: &mut State| {
            (0..count).try_for_each(|step| feed.take(&still(from_us + step * 10_000), state))
        };
        send(1_000_000_000, 100, &mut state)?;
        send(u64::MAX - 10_000, 2, &mut state)?;
        assert_eq!((state.counts.taken, state.counts.refused), (100, 2));
        send(0, 100, &mut state)?;
        assert_eq!((state.counts.taken, state.counts.refused), (151, 51));
        assert_eq!(state.counts.restarts, 1);
        assert!(state.warnings().iter().any(|warning| warning.contains("anew")));
        Ok(())
    }

    #[test]
    fn a_system_always_shows_the_same_figures() -> Result<(), Error> {
        for following in systems().chain([Following::NONE]) {
            let (mut feed, mut state) = feed(&following);
            let ids = |state: &State| -> Vec<String> {
                state.answer().figures.into_iter().map(|figure| figure.id).collect()
            };
            let before = ids(&state);
            for step in 0..200_u64 {
                feed.take(&still(step * 10_000), &mut state)?;
                let (anchor, range) = ((step % 4) as u16, 3.0);
                feed.take(&Range { time_us: step * 10_000, anchor, range }.into(), &mut state)?;
            }
            feed.settle();
            feed.show(&mut state);
            assert_eq!(ids(&state), before);
            assert!(before.len() >= 2);
            let listens = following.plan.is_some() && !following.panels.contains(&Panel::Losses);
            assert_eq!(state.counts.taken > 0, listens);
        }
        Ok(())
    }

    #[test]
    fn what_the_sender_says_of_itself_is_drawn_if_it_can_be_true() -> Result<(), Error> {
        let (mut feed, mut state) = feed(&Following::NONE);
        let place = |x| Position { time_us: 0, position: [x, 1.0, 0.0], sigma: None }.into();
        for message in [place(1.0), place(f32::NAN), place(2.0), place(1e30)] {
            feed.take(&message, &mut state)?;
        }
        let foot = Footprint { time_us: 0, position: [0.5, 0.5, f32::NAN], length: 1.0 };
        feed.take(&foot.into(), &mut state)?;
        assert_eq!(state.counts.refused, 2);
        assert_eq!(state.senders_path.iter().collect::<Vec<_>>(), [[1.0, 1.0], [2.0, 1.0]]);
        assert_eq!(state.footprints.iter().count(), 1);
        Ok(())
    }

    #[test]
    fn what_the_sender_doubts_is_told() -> Result<(), Error> {
        let (mut feed, mut state) = feed(&Following::NONE);
        let later = Reason::ALL.iter().fold(1, |bits, reason| bits + Health::from(*reason).bits());
        for (reasons, words, is_warned) in [
            (0, "good", false),
            (Health::from(Reason::Dropout).bits(), "degraded: dropout", false),
            (Health::from(Reason::Axes).bits(), "bad: axes", true),
            (later, "a reason that this version does not know", true),
        ] {
            feed.take(&EstimateHealth { time_us: 0, reasons }.into(), &mut state)?;
            let facts = state.answer().facts;
            let told = facts.iter().find(|(name, _)| name == "the sender's own estimate");
            assert_eq!(told.map(|(_, words)| words.as_str()), Some(words));
            let warned = |warning: &String| warning.contains("its own estimate");
            assert_eq!(state.warnings().iter().any(warned), is_warned, "{words}");
        }
        Ok(())
    }

    #[test]
    fn places_on_earth_are_drawn_east_and_north_of_the_first() -> Result<(), Error> {
        let (mut feed, mut state) = feed(&Following::NONE);
        let radius = 6_378_137.0;
        // On the equator at longitude 0, east is y and north is z.
        for position in [[radius, 0.0, 0.0], [radius, 3.0, 4.0], [f64::NAN; 3]] {
            let message = GlobalPosition { time_us: 0, position, sigma: None };
            feed.take(&message.into(), &mut state)?;
        }
        assert_eq!(state.counts.refused, 1);
        let path: Vec<_> = state.senders_path.iter().collect();
        assert_eq!(path.len(), 2);
        assert!((path[1][0] - 3.0).abs() < 1e-6 && (path[1][1] - 4.0).abs() < 1e-6, "{path:?}");
        Ok(())
    }

    #[test]
    fn a_user_is_found_in_the_end_from_any_number_of_losses() -> Result<(), Error> {
        let heard = PathLoss { time_us: 0, place: [0.0, 0.0, 50.0], loss: 90.0 };
        let (mut feed, mut state) = feed(&taking(&heard.into()));
        for step in 0..1000_u64 {
            let place = [0.013, 0.021].map(|rate| 200.0 * (step as f64 * rate).sin());
            let place = [place[0], place[1], 50.0];
            let distance = (place[0] - 60.0).hypot(place[1] + 40.0).hypot(place[2]);
            let loss = 38.5 + 20.0 * distance.log10();
            let (place, loss) = (place.map(|metres| metres as f32), loss as f32);
            let message = PathLoss { time_us: step * 100_000, place, loss };
            feed.take(&message.into(), &mut state)?;
        }
        assert_eq!(state.position, None);
        feed.finish()?;
        feed.show(&mut state);
        let [x, y, _] = state.position.unwrap();
        assert!((x - 60.0).hypot(y + 40.0) < 5.0, "{x} {y}");
        Ok(())
    }
}
