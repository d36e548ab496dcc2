use crate::Ephemeris;

/// A part of a navigation message, N of which make an ephemeris.
pub trait Part<const N: usize>: Copy {
    /// The number of the part: those from 1 to N make the ephemeris.
    fn number(&self) -> u8;

    /// The ephemeris of parts 1 to N, in this order. `None` if they are of different issues.
    fn ephemeris(parts: &[Self; N]) -> Option<Ephemeris>;
}

/// Collects the parts of one satellite's message, in whatever order they come.
#[derive(Debug, Clone, Copy)]
pub struct Collector<P, const N: usize>([Option<P>; N]);

impl<P: Part<N>, const N: usize> Collector<P, N> {
    /// A collector without any part.
    pub const fn new() -> Self {
        Self([None; N])
    }

    /// Takes a part. Returns the ephemeris once all its parts have come, and forgets them. Parts of other numbers, such as
    /// almanacs, change nothing; of two issues the newer part replaces the older.
    pub fn take(&mut self, part: P) -> Option<Ephemeris> {
        let place = usize::from(part.number()).checked_sub(1)?;
        *self.0.get_mut(place)? = Some(part);
        let mut parts = [part; N];
        for (part, collected) in parts.iter_mut().zip(self.0) {
            *part = collected?;
        }
        let ephemeris = P::ephemeris(&parts)?;
        self.0 = [None; N];
        Some(ephemeris)
    }
}

impl<P: Part<N>, const N: usize> Default for Collector<P, N> {
    fn default() -> Self {
        Self::new()
    }
}
