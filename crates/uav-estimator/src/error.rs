use core::fmt;

/// The reason why an estimator was not built, or refused a step. The estimate is unchanged.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Error {
    /// An argument is NaN or infinite, or a number is out of range for the scalar.
    NotFinite,
    /// The sample is not later than the previous one. If it is more than a second older, the clock was set back
    /// instead.
    OutOfOrder,
    /// A discrete-time model cannot be stepped over this interval: it is not a multiple of the model's own (to within
    /// a tenth of it), or more than 100,000 of them.
    WrongInterval {
        /// The model's own interval, s.
        own: f64,
        /// The interval asked for, s.
        found: f64,
    },
    /// All states of a model are used, or the output or state to be acted on does not exist.
    NoRoom,
    /// Local models are not in the order of their airspeeds, or differ in states, outputs or origin.
    Grid,
    /// The model's transition matrix has no inverse, which the current form of the observer requires.
    Singular,
    /// The design was refused.
    Design(kestirim_observer_design::Error),
    /// The observer refused its gains or a step.
    Observer(kestirim_luenberger::Error),
    /// The Kalman filter refused a step.
    Estimate(kestirim_kalman::Error),
}

impl From<kestirim_observer_design::Error> for Error {
    fn from(error: kestirim_observer_design::Error) -> Self {
        Self::Design(error)
    }
}

impl From<kestirim_luenberger::Error> for Error {
    fn from(error: kestirim_luenberger::Error) -> Self {
        Self::Observer(error)
    }
}

impl From<kestirim_kalman::Error> for Error {
    fn from(error: kestirim_kalman::Error) -> Self {
        Self::Estimate(error)
    }
}

impl fmt::Display for Error {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotFinite => formatter.write_str("a number is not finite"),
            Self::OutOfOrder => formatter.write_str("the sample is not later than the one before"),
            Self::WrongInterval { own, found } => {
                write!(formatter, "the model is for intervals of {own} s, found one of {found} s")
            }
            Self::NoRoom => formatter.write_str("there is no room for another state"),
            Self::Grid => formatter.write_str(
                "the models are not in the order of their airspeeds, or of other states or outputs",
            ),
            Self::Singular => formatter.write_str("the model's transition has no inverse"),
            Self::Design(error) => error.fmt(formatter),
            Self::Observer(error) => error.fmt(formatter),
            Self::Estimate(error) => error.fmt(formatter),
        }
    }
}

impl core::error::Error for Error {
    fn source(&self) -> Option<&(dyn core::error::Error + 'static)> {
        match self {
            Self::Design(error) => Some(error),
            Self::Observer(error) => Some(error),
            Self::Estimate(error) => Some(error),
            _ => None,
        }
    }
}
