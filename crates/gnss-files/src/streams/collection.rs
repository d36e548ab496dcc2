//! Parts of messages, which come one after the other.

use std::collections::BTreeMap;

use crate::navigation::Ephemeris;

/// Parts of satellites' messages, until N of one make an ephemeris.
#[derive(Debug)]
pub(super) struct Collection<P, const N: usize>(BTreeMap<u8, [Option<P>; N]>);

impl<P: Copy, const N: usize> Collection<P, N> {
    /// None of any satellite.
    pub(super) const fn new() -> Self {
        Self(BTreeMap::new())
    }

    /// Takes in a part of a satellite by its number, from 1 on; an ephemeris if that can be made of all parts now.
    pub(super) fn take(
        &mut self,
        satellite: u8,
        (number, part): (u64, P),
        ephemeris: impl FnOnce([P; N]) -> Option<Ephemeris>,
    ) -> Option<Ephemeris> {
        let place = usize::try_from(number).ok()?.checked_sub(1)?;
        let parts = self.0.entry(satellite).or_insert([None; N]);
        *parts.get_mut(place)? = Some(part);
        let whole: Vec<P> = parts.iter().flatten().copied().collect();
        let ephemeris = ephemeris(whole.try_into().ok()?)?;
        *parts = [None; N];
        Some(ephemeris)
    }
}
