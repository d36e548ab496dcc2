//! The order of the states: three coordinates (ECEF, m), the receiver's clock (m), the wet zenith delay (m), its
//! gradients to the north and east (m) if they are estimated, and an ambiguity (m) for each satellite.

/// The index of the receiver's clock.
pub(crate) const CLOCK: usize = 3;
/// The index of the wet zenith delay.
pub(crate) const WET: usize = 4;
/// The number of states besides gradients and ambiguities.
pub(crate) const COMMON: usize = 5;
/// The indices of the gradients to the north and to the east, where they are estimated.
pub(crate) const GRADIENTS: [usize; 2] = [COMMON, COMMON + 1];

/// The number of states besides ambiguities, where gradients are estimated.
pub(crate) const BEHIND_GRADIENTS: usize = COMMON + GRADIENTS.len();

/// The number of states of a [`PppFilter`](crate::PppFilter) for a number of satellites at a time.
///
/// The clock of each system besides GPS takes the room of one satellite; gradients, if they are estimated, take that of
/// two.
pub const fn states(satellites: usize) -> usize {
    COMMON.saturating_add(satellites)
}
