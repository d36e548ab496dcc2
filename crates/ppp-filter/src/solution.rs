use heapless::Vec;
use kestirim_gnss_ppp::{Direction, GpsTime, Slip};
use kestirim_robust_kalman::Decision;
use kestirim_scalar::Columns;
use nalgebra::{Matrix3, Vector3};

/// The reason why a satellite's ambiguity was reset.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Slipped {
    /// The satellite was not observed before.
    New,
    /// A slip was seen in the satellite's own observations.
    Seen(Slip),
    /// The phase contradicted all others for several epochs.
    Contradicted,
}

/// The quality of a solution.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Health {
    /// The ambiguities are not known yet: errors of decimetres to metres.
    Converging,
    /// The ambiguities are known: the standard deviation of the position is below 10 cm.
    Converged,
    /// Hardly more observations are left than unknowns: no fault could be detected.
    Unchecked,
    /// The observations contradict the solution, or each other, or earlier solutions: times, products, codes or the
    /// model are wrong, and the standard deviations with them. Not to be relied upon.
    Contradicted(Contradiction),
}

impl Health {
    /// The health in the terms common to all systems. Ambiguities that are not known yet are no fault.
    pub fn in_short(self) -> kestirim_health::Health {
        use kestirim_health::Reason;
        match self {
            Self::Converging | Self::Converged => kestirim_health::Health::GOOD,
            Self::Unchecked => Reason::NotObservable.into(),
            Self::Contradicted(Contradiction::Rejections) => {
                kestirim_health::Health::from(Reason::Innovations).with(Reason::Rejected, true)
            }
            Self::Contradicted(_) => Reason::Innovations.into(),
        }
    }
}

/// Why a solution is not to be relied upon.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Contradiction {
    /// More than a tenth of the observations was rejected for ten epochs, or more than a fifth at once.
    Rejections,
    /// The residuals are far beyond the noise: 2.6 times for ten epochs, or 2.8 times at once.
    Residuals,
    /// A receiver is not where it should be.
    ///
    /// A receiver at rest is more than four standard deviations from where it was found before; or any receiver leapt
    /// farther than ten standard deviations of its prediction, a moving one even relative to constant velocity; or the
    /// phases of at least eight satellites of a receiver at rest changed from one epoch to the next like those of a
    /// receiver that moved by ten standard deviations.
    Motion,
}

/// The decisions about one satellite's observations.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SatelliteReport {
    /// The satellite's number.
    pub satellite: u8,
    /// The direction from the receiver.
    pub direction: Direction,
    /// The weight, residual and reason of the code.
    pub code: Decision<f64>,
    /// The weight, residual and reason of the phase.
    pub phase: Decision<f64>,
    /// Whether and why the satellite's ambiguity was reset.
    pub slipped: Option<Slipped>,
}

/// The solution of one epoch.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Solution<const N: usize> {
    /// The time of the epoch by the receiver's clock.
    pub time: GpsTime,
    /// The position of the marker, ECEF, m, free of tides.
    pub position: Vector3<f64>,
    /// The covariance of the position, ECEF, m².
    pub covariance: Matrix3<f64>,
    /// The covariance of the position in east, north, up, m².
    pub covariance_enu: Matrix3<f64>,
    /// Receiver clock minus GPS time, m.
    pub clock: f64,
    /// The wet zenith delay, m.
    pub wet_delay: f64,
    /// The troposphere's gradients to the north and to the east, m; zero where they are not estimated.
    pub gradients: [f64; 2],
    /// The quality of the solution.
    pub health: Health,
    /// The milliseconds by which the phases of all satellites jumped against their codes in this epoch. The jump is
    /// repaired.
    pub milliseconds: i32,
    /// The decisions about each satellite above the elevation mask.
    pub satellites: Vec<SatelliteReport, N>,
}

impl<const N: usize> Solution<N> {
    /// The standard deviations to the east, north and up, m.
    pub fn deviations_enu(&self) -> [f64; 3] {
        [0, 1, 2].map(|axis| {
            let row = self.covariance_enu.as_columns().get(axis);
            libm::sqrt(row.and_then(|row| row.get(axis)).copied().unwrap_or(0.0))
        })
    }
}
