//! The aircraft, and what of them is measured.

use clap::ValueEnum;
use kestirim_observer_design::{Discrete, zero_order_hold};
use kestirim_uav_longitudinal::{self as uav, StateSpace};
use serde::Serialize;

/// States, as they are shown.
pub const STATES: [&str; 4] = ["α", "q", "V", "θ"];
/// What they are.
pub const STATE_NAMES: [&str; 4] = ["angle of attack", "pitch rate", "airspeed", "pitch"];
/// Their units.
pub const STATE_UNITS: [&str; 4] = ["rad", "rad/s", "m/s", "rad"];
/// As parts of the names of figures.
pub const STATE_SLUGS: [&str; 4] = ["alpha", "pitch-rate", "airspeed", "pitch"];
/// As columns of a stream.
pub const STREAM_COLUMNS: [&str; 4] = ["alpha_rad", "q_rad_s", "v_m_s", "theta_rad"];

/// An aircraft.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, ValueEnum)]
pub enum Plant {
    /// P1, the Aerosonde
    #[value(name = "P1")]
    P1,
    /// P2, what the thesis says of its aircraft
    #[default]
    #[value(name = "P2")]
    P2,
    /// P3, the Navion
    #[value(name = "P3")]
    P3,
}

impl Plant {
    /// All.
    pub const ALL: [Self; 3] = [Self::P1, Self::P2, Self::P3];

    /// In continuous time.
    pub fn model(self) -> StateSpace {
        match self {
            Self::P1 => uav::aerosonde().expect("the Aerosonde flies"),
            Self::P2 => uav::thesis_like(),
            Self::P3 => uav::navion(),
        }
    }

    /// With inputs that are held for `interval` seconds.
    pub fn discrete(self, interval: f64) -> Discrete<4, 2> {
        let StateSpace { a, b } = self.model();
        zero_order_hold(&a, &b, interval).expect("finite matrices")
    }

    /// For a table.
    pub fn name(self) -> &'static str {
        match self {
            Self::P1 => "P1 Aerosonde",
            Self::P2 => "P2 thesis-like",
            Self::P3 => "P3 Navion",
        }
    }
}

/// What is measured: the last so many states.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, ValueEnum)]
pub enum Outputs {
    /// All states, as in the thesis
    #[default]
    #[value(name = "all")]
    Full,
    /// q, V, θ: gyroscope, pitot tube, attitude reference
    #[value(name = "q-V-theta")]
    RateAirspeedPitch,
    /// V, θ
    #[value(name = "V-theta")]
    AirspeedPitch,
}

impl Outputs {
    /// All.
    pub const ALL: [Self; 3] = [Self::Full, Self::RateAirspeedPitch, Self::AirspeedPitch];

    /// How many.
    pub fn count(self) -> usize {
        match self {
            Self::Full => 4,
            Self::RateAirspeedPitch => 3,
            Self::AirspeedPitch => 2,
        }
    }

    /// For a table.
    pub fn name(self) -> &'static str {
        match self {
            Self::Full => "all",
            Self::RateAirspeedPitch => "q V θ",
            Self::AirspeedPitch => "V θ",
        }
    }
}

/// Calls a function that is generic over the number of outputs with the C of these outputs.
macro_rules! with_outputs {
    ($outputs:expr, $function:expr $(, $argument:expr)*) => {
        match $outputs {
            $crate::systems::uav::simulate::plant::Outputs::Full => {
                $function(&kestirim_uav_longitudinal::full_state() $(, $argument)*)
            }
            $crate::systems::uav::simulate::plant::Outputs::RateAirspeedPitch => {
                $function(&kestirim_uav_longitudinal::rate_airspeed_and_pitch() $(, $argument)*)
            }
            $crate::systems::uav::simulate::plant::Outputs::AirspeedPitch => {
                $function(&kestirim_uav_longitudinal::airspeed_and_pitch() $(, $argument)*)
            }
        }
    };
}
pub(in crate::systems::uav) use with_outputs;
