//! The aircraft, and what of them is measured.

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

/// What is measured: the last so many states.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub enum Outputs {
    /// All states, as in the thesis
    #[default]
    #[cfg_attr(feature = "clap", value(name = "all"))]
    Full,
    /// q, V, θ: gyroscope, pitot tube, attitude reference
    #[cfg_attr(feature = "clap", value(name = "q-V-theta"))]
    RateAirspeedPitch,
    /// V, θ
    #[cfg_attr(feature = "clap", value(name = "V-theta"))]
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

/// Calls a function that is generic over the number of outputs with the C of these [`Outputs`](crate::uav::plant::Outputs).
#[macro_export]
macro_rules! with_outputs {
    ($outputs:expr, $function:expr $(, $argument:expr)*) => {
        match $outputs {
            $crate::uav::plant::Outputs::Full => {
                $function(&$crate::uav::full_state() $(, $argument)*)
            }
            $crate::uav::plant::Outputs::RateAirspeedPitch => {
                $function(&$crate::uav::rate_airspeed_and_pitch() $(, $argument)*)
            }
            $crate::uav::plant::Outputs::AirspeedPitch => {
                $function(&$crate::uav::airspeed_and_pitch() $(, $argument)*)
            }
        }
    };
}
