//! Order of the states: three coordinates (ECEF, m), the receiver's clock (m), the wet zenith
//! delay (m), and an ambiguity (m) for each satellite.

/// The receiver's clock.
pub(crate) const CLOCK: usize = 3;
/// The wet zenith delay.
pub(crate) const WET: usize = 4;
/// Number of states besides the ambiguities.
pub(crate) const COMMON: usize = 5;

/// Number of states of a [`PppFilter`](crate::PppFilter) for so many satellites at a time. Where satellites of Galileo
/// are among them, their clock takes the room of one.
pub const fn states(satellites: usize) -> usize {
    COMMON.saturating_add(satellites)
}
