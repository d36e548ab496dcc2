use kestirim_gnss_ppp::{Carriers, Pattern, SatelliteState};

/// Clocks that are interpolated over longer hide gradients of the troposphere, s.
const COARSE_CLOCKS: f64 = 300.0;

/// Observation of one satellite in an epoch, and the satellite's state.
///
/// Only complete observations serve: both codes and both phases.
#[derive(Clone, Copy, Debug)]
pub struct SatelliteObservation<'a> {
    /// Number of the satellite, which no other has: a GPS satellite's PRN, a Galileo satellite's number and 100, say.
    pub satellite: u8,
    /// The two carriers on which it is observed.
    pub carriers: Carriers,
    /// Codes on both, m (of GPS P1 and P2, to which the clocks of the IGS refer).
    pub code: [f64; 2],
    /// Carrier phases on both, cycles.
    pub phase: [f64; 2],
    /// Whether the receiver reports a loss of lock since the last epoch that had a solution.
    pub lock_lost: bool,
    /// The satellite's state at the time of transmission.
    pub state: SatelliteState,
    /// Its antenna on both, where known.
    pub antenna: Option<[Pattern<'a>; 2]>,
}

impl SatelliteObservation<'_> {
    /// Whether the satellite's clock is interpolated over more than five minutes: what it does meanwhile looks like a gradient of
    /// the troposphere ([`Config::gradient`](crate::Config::gradient)).
    pub fn hides_gradients(&self) -> bool {
        self.state.clock_interval > COARSE_CLOCKS
    }

    pub(crate) fn is_finite(&self) -> bool {
        self.code.iter().chain(&self.phase).all(|value| value.is_finite())
    }
}
