use core::fmt;

/// Reason for which an estimator was not built, or refused a step. An estimate is as it was before the call.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Error {
    /// An argument is NaN or infinite, or a number is beyond what the scalar holds.
    NotFinite,
    /// The sample is not later than the one before, by a second at most: by more, the clock was set back.
    OutOfOrder,
    /// The gap of so many seconds is longer than a million usual intervals.
    Gap(f64),
    /// A model of discrete time cannot be stepped over this interval: it is no multiple of the model's own
    /// (within a tenth of it), or more than 100,000 of them.
    WrongInterval {
        /// The model's own interval, s.
        own: f64,
        /// The interval asked for, s.
        found: f64,
    },
    /// All states that a filter has room for are taken, or the output or state that something is to act on is not there.
    NoRoom,
    /// Local models do not stand in the order of their airspeeds, or have not the same states, outputs and origin.
    Grid,
    /// The model's transition has no inverse, which the current form of the observer needs.
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
            Self::Gap(gap) => write!(formatter, "no estimate outlives a gap of {gap} s"),
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
