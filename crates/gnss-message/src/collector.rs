use crate::Ephemeris;

/// A part of a navigation message, N of which make an ephemeris.
pub trait Part<const N: usize>: Copy {
    /// The number of the part: those from 1 to N make the ephemeris.
    fn number(&self) -> u8;

    /// The ephemeris of parts 1 to N, in this order. `None` if they are of different issues.
    fn ephemeris(parts: &[Self; N]) -> Option<Ephemeris>;
}

/// The longest time between two parts that belong together, s: numbers of issues repeat.
const SILENCE: f64 = 300.0;

/// Collects the parts of one satellite's message, in whatever order they come.
#[derive(Debug, Clone, Copy)]
pub struct Collector<P, const N: usize> {
    parts: [Option<P>; N],
    /// When the last part came.
    heard: f64,
}

impl<P: Part<N>, const N: usize> Collector<P, N> {
    /// A collector without any part.
    pub const fn new() -> Self {
        Self { parts: [None; N], heard: 0.0 }
    }

    /// Takes a part that came at a time, s by any clock. Returns the ephemeris once all its parts have come, and forgets them.
    /// Parts of other numbers, such as almanacs, change nothing; of two issues the newer part replaces the older. A part that came
    /// more than five minutes after the last one, of whatever number, is not joined with those before.
    pub fn take(&mut self, part: P, now: f64) -> Option<Ephemeris> {
        let is_continued = (now - self.heard).abs() <= SILENCE;
        self.heard = now;
        if !is_continued {
            self.parts = [None; N];
        }
        let place = usize::from(part.number()).checked_sub(1)?;
        *self.parts.get_mut(place)? = Some(part);
        let mut parts = [part; N];
        for (part, collected) in parts.iter_mut().zip(self.parts) {
            *part = collected?;
        }
        let ephemeris = P::ephemeris(&parts)?;
        self.parts = [None; N];
        Some(ephemeris)
    }
}

impl<P: Part<N>, const N: usize> Default for Collector<P, N> {
    fn default() -> Self {
        Self::new()
    }
}
