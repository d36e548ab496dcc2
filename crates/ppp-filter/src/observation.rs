use kestirim_gnss_ppp::{Carriers, Pattern, SatelliteState};

/// Satellite clocks interpolated over a longer interval hide gradients of the troposphere, s.
const COARSE_CLOCKS: f64 = 300.0;

/// The observation of one satellite in an epoch, and the satellite's state.
///
/// Only complete observations are used: both codes and both phases.
#[derive(Clone, Copy, Debug)]
pub struct SatelliteObservation<'a> {
    /// The satellite's number, unique among all systems: for example the PRN of a GPS satellite, and the number plus
    /// 100 of a Galileo satellite.
    pub satellite: u8,
    /// The two carriers on which the satellite is observed.
    pub carriers: Carriers,
    /// The codes on both carriers, m (for GPS P1 and P2, to which the clocks of the IGS refer).
    pub code: [f64; 2],
    /// The carrier phases on both carriers, cycles.
    pub phase: [f64; 2],
    /// Whether the receiver reports a loss of lock since the epoch whose solution last listed this satellite.
    pub lock_lost: bool,
    /// The satellite's state at the time of transmission.
    pub state: SatelliteState,
    /// The satellite's antenna on both carriers, where known.
    pub antenna: Option<[Pattern<'a>; 2]>,
}

impl SatelliteObservation<'_> {
    /// Whether the satellite's clock is interpolated over more than five minutes, so that its variation looks like a
    /// gradient of the troposphere ([`Config::gradient`](crate::Config::gradient)).
    pub fn hides_gradients(&self) -> bool {
        self.state.clock_interval > COARSE_CLOCKS
    }

    pub(crate) fn is_finite(&self) -> bool {
        let is_accuracy = self.state.accuracy.is_finite() && self.state.accuracy >= 0.0;
        is_accuracy && self.code.iter().chain(&self.phase).all(|value| value.is_finite())
    }
}
