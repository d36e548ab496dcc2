//! The warning, given once, that nothing arrives from a log.

use std::time::{Duration, Instant};

/// The silence after which the warning is given.
const QUIET: Duration = Duration::from_secs(10);

/// A period without messages.
#[derive(Debug)]
pub(super) struct Silence {
    since: Instant,
    is_told: bool,
}

impl Silence {
    /// Starts a period of silence.
    pub(super) fn begin(now: Instant) -> Self {
        Self { since: now, is_told: false }
    }

    /// Notes that nothing has arrived, for the reason `why` if known, and returns the warning when it is due.
    pub(super) fn goes_on(&mut self, now: Instant, why: Option<&str>) -> Option<String> {
        if self.is_told || now.duration_since(self.since) < QUIET {
            return None;
        }
        self.is_told = true;
        let none = "nothing was sent to it, or all of it was followed before";
        let why = why.unwrap_or(none);
        Some(format!("nothing came for {} s: {why}", QUIET.as_secs()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_silence_is_told_once_and_with_its_reason() {
        let start = Instant::now();
        let mut silence = Silence::begin(start);
        let why = Some("stream not found");
        let told: Vec<_> = (0..30)
            .filter_map(|second| silence.goes_on(start + Duration::from_secs(second), why))
            .collect();
        assert_eq!(told, ["nothing came for 10 s: stream not found"]);
        let mut silence = Silence::begin(start + Duration::from_secs(30));
        assert_eq!(silence.goes_on(start + Duration::from_secs(39), None), None);
        assert!(silence.goes_on(start + Duration::from_secs(40), None).is_some());
    }
}
