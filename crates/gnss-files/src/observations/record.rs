//! Observations as returned by the reader.

use std::collections::BTreeMap;

use super::signals::{Carriers, Raw, Signals};
use crate::error::Warning;
use crate::time::GpsTime;

/// Observations of satellites on two carriers by one receiver.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Observations {
    /// The name of the station's marker.
    pub marker: String,
    /// The receiver's type.
    pub receiver: String,
    /// Type and radome of the antenna in 20 columns, as an ANTEX file names it.
    pub antenna: String,
    /// The marker's approximate position: ECEF, m.
    pub approximate_position: Option<[f64; 3]>,
    /// The position of the antenna's reference point above, east and north of the marker, m.
    pub antenna_delta_hen: [f64; 3],
    /// The epochs, in chronological order.
    pub epochs: Vec<Epoch>,
    /// The signals taken from each satellite, by its number.
    pub signals: BTreeMap<u8, Signals>,
    /// A warning that counts the observed satellites of systems that are not read.
    pub unserved: Option<Warning>,
    /// Warnings about the file.
    pub warnings: Vec<Warning>,
}

/// Observations of one instant.
#[derive(Debug, Clone, PartialEq)]
pub struct Epoch {
    /// The instant, by the receiver's clock.
    pub time: GpsTime,
    /// Whether the receiver lost power since the preceding epoch.
    pub power_failure: bool,
    /// The satellites in the order of the file, each once.
    pub satellites: Vec<Observed>,
}

/// Observations of one satellite in one epoch, on two carriers.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Observed {
    /// The satellite's number: the number of its name (PRN) for GPS, plus 100 for Galileo, plus 150 for GLONASS, plus
    /// 180 for BeiDou.
    pub prn: u8,
    /// The carriers.
    pub carriers: Carriers,
    /// Pseudoranges, m.
    pub code: [Option<f64>; 2],
    /// Carrier phases, cycles.
    pub phase: [Option<f64>; 2],
    /// Whether the receiver lost lock on the phase since the preceding epoch (bit 0 of the loss-of-lock indicator).
    pub loss_of_lock: [bool; 2],
}

impl Observed {
    /// Subtracts biases, m, from the codes.
    pub(super) fn shorten(&mut self, biases: [f64; 2]) {
        for (code, bias) in self.code.iter_mut().zip(biases) {
            *code = code.map(|code| code - bias);
        }
    }

    /// Extracts the observations of the chosen signals from all those of a satellite in an epoch.
    pub(super) fn of(prn: u8, signals: &Signals, raw: &[Raw]) -> Self {
        let mut observed = Self { prn, carriers: signals.carriers, ..Self::default() };
        for &Raw { signal, value, lock_lost } in raw {
            let of = if signal.phase { signals.phase } else { signals.code };
            let Some(band) = of.iter().position(|chosen| *chosen == Some(signal)) else {
                continue;
            };
            if signal.phase {
                observed.phase[band] = Some(value);
                observed.loss_of_lock[band] = lock_lost;
            } else {
                observed.code[band] = Some(value);
            }
        }
        observed
    }
}
