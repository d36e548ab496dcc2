use kestirim_gnss_ppp::{Pattern, SatelliteState};

/// One satellite as the receiver observed it in an epoch, and where it was.
///
/// Only complete observations serve: both codes and both phases.
#[derive(Clone, Copy, Debug)]
pub struct Sighting<'a> {
    /// Which GPS satellite (PRN).
    pub satellite: u8,
    /// Codes on L1 and L2, m (P1 and P2, to which the clocks of the IGS refer).
    pub code: [f64; 2],
    /// Carrier phases on L1 and L2, cycles.
    pub phase: [f64; 2],
    /// Whether the receiver says that it lost lock since the last epoch that had a solution.
    pub lock_lost: bool,
    /// The satellite when it sent what was received.
    pub state: SatelliteState,
    /// Its antenna on L1 and L2, where known.
    pub antenna: Option<[Pattern<'a>; 2]>,
}

impl Sighting<'_> {
    pub(crate) fn is_finite(&self) -> bool {
        self.code.iter().chain(&self.phase).all(|value| value.is_finite())
    }
}
