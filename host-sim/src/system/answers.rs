//! A cache of the last answers: zooming in, or comparing two of them, does not compute them again.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::account::Answer;
use super::settings::Settings;

/// The number of answers kept: as many as are compared.
const MOST: usize = 2;
/// The most points of an answer that is kept while another is computed or shown: some 80 MB.
const MOST_POINTS: usize = 5_000_000;

/// Answers by their settings, the most recently used one last.
#[derive(Debug, Default)]
pub(super) struct Answers(Mutex<VecDeque<(Settings, Arc<Answer>)>>);

impl Answers {
    /// The cached answer to these settings. If there is none, large answers are dropped to make room for the new one.
    pub(super) fn of(&self, settings: &Settings) -> Option<Arc<Answer>> {
        let mut answers = self.lock();
        let Some(place) = answers.iter().position(|(known, _)| known == settings) else {
            drop(answers);
            self.forget_large();
            return None;
        };
        let latest = answers.remove(place)?;
        let answer = Arc::clone(&latest.1);
        answers.push_back(latest);
        Some(answer)
    }

    /// Drops answers that take much memory: they can be computed again.
    pub(super) fn forget_large(&self) {
        self.lock().retain(|(_, answer)| answer.points() <= MOST_POINTS);
    }

    /// Stores an answer and returns it.
    pub(super) fn keep(&self, settings: &Settings, answer: Answer) -> Arc<Answer> {
        let answer = Arc::new(answer);
        let mut answers = self.lock();
        answers.retain(|(known, _)| known != settings);
        answers.push_back((settings.clone(), Arc::clone(&answer)));
        if answers.len() > MOST {
            answers.pop_front();
        }
        answer
    }

    fn lock(&self) -> MutexGuard<'_, VecDeque<(Settings, Arc<Answer>)>> {
        // A panic in another thread cannot leave the contents inconsistent.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::system::Setting;

    #[test]
    fn the_two_that_were_last_asked_for_are_kept() {
        let of = |value: f64| {
            let table = vec![Setting::number("rate", "rate", "Hz", [1.0, 9.0, 1.0], 5.0)];
            let sent = serde_json::json!({ "rate": value });
            Settings::sent(table, sent.as_object().expect("an object")).expect("settings")
        };
        let answer = |command: &str| Answer { command: command.to_owned(), ..Answer::default() };
        let answers = Answers::default();
        assert_eq!(answers.of(&of(1.0)), None);
        answers.keep(&of(1.0), answer("one"));
        answers.keep(&of(2.0), answer("two"));
        assert_eq!(answers.of(&of(1.0)).map(|it| it.command.clone()).as_deref(), Some("one"));
        answers.keep(&of(3.0), answer("three"));
        let known = [1.0, 2.0, 3.0].map(|value| answers.of(&of(value)).is_some());
        assert_eq!(known, [true, false, true]);
    }
}
