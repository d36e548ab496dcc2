//! The last answers that were given: who looks closer, or compares two, does not wait for them again.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::account::Answer;
use super::settings::Settings;

/// As many as are compared.
const MOST: usize = 2;
/// Points of an answer that is kept while something else is looked at: some 80 MB.
const MOST_POINTS: usize = 5_000_000;

/// The latest at the end.
#[derive(Debug, Default)]
pub(super) struct Answers(Mutex<VecDeque<(Settings, Arc<Answer>)>>);

impl Answers {
    /// What was answered to these settings. If it has to be found anew there is room for it.
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

    /// Lets go of what takes much memory: it can be found again.
    pub(super) fn forget_large(&self) {
        self.lock().retain(|(_, answer)| answer.points() <= MOST_POINTS);
    }

    /// Keeps an answer, and gives it back.
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
        // Nothing is left half done in there.
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
