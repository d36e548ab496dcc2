//! The aircraft, and the choice of measured states.

/// The symbols of the states.
pub const STATES: [&str; 4] = ["α", "q", "V", "θ"];
/// The names of the states.
pub const STATE_NAMES: [&str; 4] = ["angle of attack", "pitch rate", "airspeed", "pitch"];
/// The units of the states.
pub const STATE_UNITS: [&str; 4] = ["rad", "rad/s", "m/s", "rad"];
/// The states as parts of the names of figures.
pub const STATE_SLUGS: [&str; 4] = ["alpha", "pitch-rate", "airspeed", "pitch"];
/// The states as columns of a stream.
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
    /// All choices of outputs.
    pub const ALL: [Self; 3] = [Self::Full, Self::RateAirspeedPitch, Self::AirspeedPitch];

    /// The number of outputs.
    pub fn count(self) -> usize {
        match self {
            Self::Full => 4,
            Self::RateAirspeedPitch => 3,
            Self::AirspeedPitch => 2,
        }
    }

    /// The name for tables.
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
