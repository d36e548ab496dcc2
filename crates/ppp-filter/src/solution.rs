use heapless::Vec;
use kestirim_gnss_ppp::{Direction, GpsTime, Slip};
use kestirim_robust_kalman::Decision;
use kestirim_scalar::Columns;
use nalgebra::{Matrix3, Vector3};

/// Reason for which a satellite's ambiguity began anew.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Slipped {
    /// The satellite was not observed before.
    New,
    /// A slip in its own observations.
    Seen(Slip),
    /// The phase contradicted all others for several epochs.
    Contradicted,
}

/// Quality of a solution.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Health {
    /// The ambiguities are not known yet: decimetres to metres.
    Converging,
    /// Ambiguities are known: the standard deviation of the position is below 10 cm.
    Converged,
    /// Hardly more observations are left than unknowns: no fault could be seen.
    Unchecked,
    /// The observations contradict the solution, or each other, or what was found before: times, products, codes or
    /// the model are wrong, and the standard deviations with them. Not to be relied upon.
    Contradicted(Contradiction),
}

impl Health {
    /// The same in the words of all systems. That ambiguities are not known yet is no fault.
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
    /// More than a tenth of the observations was rejected, for ten epochs, or more than a fifth.
    Rejections,
    /// What is left of the observations is far beyond their noise: 2.6 times for ten epochs, or 2.8 times.
    Residuals,
    /// A receiver at rest is more than four standard deviations from where it was found before, or any receiver leapt
    /// farther than ten standard deviations of its prediction, one that moves even if it had gone on as before. Or the phases of at least
    /// eight satellites of one at rest changed from one epoch to the next as those of a receiver that was moved by ten standard
    /// deviations.
    Motion,
}

/// Decisions about one satellite's observations.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SatelliteReport {
    /// Number of the satellite.
    pub satellite: u8,
    /// Direction from the receiver.
    pub direction: Direction,
    /// Weight, residual and reason of the code.
    pub code: Decision<f64>,
    /// The same of the phase.
    pub phase: Decision<f64>,
    /// Whether and why its ambiguity was begun anew.
    pub slipped: Option<Slipped>,
}

/// Solution of one epoch.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Solution<const N: usize> {
    /// Time of the epoch by the receiver's clock.
    pub time: GpsTime,
    /// The marker, ECEF, m, free of tides.
    pub position: Vector3<f64>,
    /// Covariance of the position, ECEF, m².
    pub covariance: Matrix3<f64>,
    /// The same in east, north, up.
    pub covariance_enu: Matrix3<f64>,
    /// Receiver clock minus GPS time, m.
    pub clock: f64,
    /// Wet zenith delay, m.
    pub wet_delay: f64,
    /// Gradients of the troposphere to the north and to the east, m; zero where they are not estimated.
    pub gradients: [f64; 2],
    /// Quality of the solution.
    pub health: Health,
    /// By how many milliseconds the phases of all satellites jumped against their codes in this epoch. That is repaired.
    pub milliseconds: i32,
    /// Decisions about each satellite above the elevation mask.
    pub satellites: Vec<SatelliteReport, N>,
}

impl<const N: usize> Solution<N> {
    /// Standard deviations to the east, north and up, m.
    pub fn deviations_enu(&self) -> [f64; 3] {
        [0, 1, 2].map(|axis| {
            let row = self.covariance_enu.as_columns().get(axis);
            libm::sqrt(row.and_then(|row| row.get(axis)).copied().unwrap_or(0.0))
        })
    }
}
