use core::ffi::{CStr, c_char};

/// Outcome of a call. If it is not `KESTIRIM_STATUS_OK`, nothing was changed and no result was written.
#[repr(i32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// The call succeeded.
    Ok = 0,
    /// A pointer is null.
    NullPointer = 1,
    /// A pointer is not aligned for its type.
    Misaligned = 2,
    /// The memory is too small for the object, or the buffer for the snapshot.
    TooSmall = 3,
    /// The memory holds no object of this type: it was never initialised, or has been overwritten.
    NotInitialised = 4,
    /// An enumerated argument has an unknown value, or a setting or a number is out of its range.
    InvalidArgument = 5,
    /// There is no estimate yet, or it was lost.
    NoEstimate = 6,
    /// A number is NaN, infinite, or out of the range of the fixed-point format.
    NotFinite = 7,
    /// A measurement has a value that no sensor can have measured.
    Implausible = 8,
    /// The sample is not later than the last one, or is too old for the estimate.
    OutOfOrder = 9,
    /// The measurement was already processed.
    Duplicate = 10,
    /// No anchor has this number.
    NoSuchAnchor = 11,
    /// There are more anchors, corners, satellites or samples than there is room for.
    TooMany = 12,
    /// There are fewer anchors, satellites or words of a navigation message than are needed.
    TooFew = 13,
    /// The measurements contradict each other, or no position explains them.
    Contradictory = 14,
    /// The time since the last sample is not a multiple of the model's interval; or no ephemeris or product covers the time.
    Gap = 15,
    /// The geometry determines no position, the corners enclose no area, or a matrix is singular.
    Geometry = 16,
    /// The estimator refused the step for another reason.
    Refused = 17,
    /// The bytes are not a snapshot.
    NoSnapshot = 18,
    /// The snapshot is of another type of object, another version of this library, or another number format (`float` or
    /// fixed point).
    ForeignSnapshot = 19,
    /// The snapshot was not written completely, or has been altered.
    DamagedSnapshot = 20,
    /// The checksum of the navigation message is wrong, or the message is of another kind.
    DamagedMessage = 21,
    /// The satellite declares its signals unhealthy, or predicts no accuracy.
    Unhealthy = 22,
    /// The satellite does not broadcast the group delay for the observed carriers.
    NoGroupDelay = 23,
}

impl Status {
    /// All statuses with their names.
    const NAMES: [(Self, &'static CStr); 24] = [
        (Self::Ok, c"ok"),
        (Self::NullPointer, c"a pointer is null"),
        (Self::Misaligned, c"a pointer is not aligned"),
        (Self::TooSmall, c"the memory is too small"),
        (Self::NotInitialised, c"the memory holds no such object"),
        (Self::InvalidArgument, c"a choice or a setting is not valid"),
        (Self::NoEstimate, c"there is no estimate"),
        (Self::NotFinite, c"a number is not finite"),
        (Self::Implausible, c"no sensor measures this"),
        (Self::OutOfOrder, c"the sample is older than the one before"),
        (Self::Duplicate, c"the same measurement came before"),
        (Self::NoSuchAnchor, c"there is no anchor of this number"),
        (Self::TooMany, c"there are more than there is room for"),
        (Self::TooFew, c"there are fewer than are needed"),
        (Self::Contradictory, c"the measurements contradict each other"),
        (Self::Gap, c"the interval is not the model's, or no orbit covers it"),
        (Self::Geometry, c"the geometry determines nothing"),
        (Self::Refused, c"the estimator refused the step"),
        (Self::NoSnapshot, c"the bytes are no snapshot"),
        (Self::ForeignSnapshot, c"the snapshot is of another object, version or number format"),
        (Self::DamagedSnapshot, c"the snapshot is damaged"),
        (Self::DamagedMessage, c"the navigation message is damaged"),
        (Self::Unhealthy, c"the satellite calls itself unhealthy"),
        (Self::NoGroupDelay, c"the group delay between the carriers is not broadcast"),
    ];
}

/// The meaning of a status in plain English, as a string with static lifetime; "unknown status" for a number that is
/// not a status.
#[allow(unsafe_code)] // The symbol is this library's: all begin with its name.
#[unsafe(no_mangle)]
pub extern "C" fn kestirim_status_name(status: i32) -> *const c_char {
    let mut names = Status::NAMES.iter();
    let name = names.find(|(of, _)| *of as i32 == status);
    name.map_or(c"unknown status", |(_, name)| *name).as_ptr()
}

impl From<kestirim_kalman::Error> for Status {
    fn from(error: kestirim_kalman::Error) -> Self {
        match error {
            kestirim_kalman::Error::NotFinite => Self::NotFinite,
            _ => Self::Refused,
        }
    }
}

impl From<kestirim_pedestrian::Error> for Status {
    fn from(error: kestirim_pedestrian::Error) -> Self {
        use kestirim_pedestrian::Error;
        match error {
            Error::NotFinite => Self::NotFinite,
            Error::Implausible => Self::Implausible,
            Error::TimeBackwards => Self::OutOfOrder,
            _ => Self::Refused,
        }
    }
}

impl From<kestirim_uwb_tracker::Error> for Status {
    fn from(error: kestirim_uwb_tracker::Error) -> Self {
        use kestirim_uwb_tracker::Error;
        match error {
            Error::NotFinite => Self::NotFinite,
            Error::ImplausibleRange | Error::ImplausibleMotion => Self::Implausible,
            Error::NoSuchAnchor => Self::NoSuchAnchor,
            Error::TooManyAnchors => Self::TooMany,
            Error::TooFewAnchors => Self::TooFew,
            Error::Duplicate => Self::Duplicate,
            Error::OutOfOrder => Self::OutOfOrder,
            Error::Estimate(error) => error.into(),
            _ => Self::Refused,
        }
    }
}

impl From<kestirim_uav_estimator::Error> for Status {
    fn from(error: kestirim_uav_estimator::Error) -> Self {
        use kestirim_uav_estimator::Error;
        match error {
            Error::NotFinite
            | Error::Design(kestirim_observer_design::Error::NotFinite)
            | Error::Observer(kestirim_luenberger::Error::NotFinite) => Self::NotFinite,
            Error::OutOfOrder => Self::OutOfOrder,
            Error::WrongInterval { .. } => Self::Gap,
            Error::Singular => Self::Geometry,
            Error::Estimate(error) => error.into(),
            _ => Self::Refused,
        }
    }
}

impl From<kestirim_uav_longitudinal::Error> for Status {
    fn from(error: kestirim_uav_longitudinal::Error) -> Self {
        use kestirim_uav_longitudinal::Error;
        match error {
            Error::NotFinite => Self::NotFinite,
            Error::NotPositive => Self::InvalidArgument,
            Error::Singular => Self::Geometry,
            _ => Self::Refused,
        }
    }
}

impl From<kestirim_air_to_ground::Error> for Status {
    fn from(error: kestirim_air_to_ground::Error) -> Self {
        use kestirim_air_to_ground::Error;
        match error {
            Error::NotFinite => Self::NotFinite,
            Error::NotPositive => Self::InvalidArgument,
            Error::ImplausibleLoss => Self::Implausible,
            _ => Self::Refused,
        }
    }
}

impl From<kestirim_user_locator::Error> for Status {
    fn from(error: kestirim_user_locator::Error) -> Self {
        use kestirim_particle_filter::Error as FilterError;
        use kestirim_user_locator::Error;
        match error {
            Error::Channel(error) => error.into(),
            Error::NotFinite | Error::Filter(FilterError::NotFinite) => Self::NotFinite,
            Error::TooManyCorners | Error::Filter(FilterError::TooMany) => Self::TooMany,
            Error::NoArea => Self::Geometry,
            Error::Filter(FilterError::Degenerate) => Self::Contradictory,
            _ => Self::Refused,
        }
    }
}

impl From<kestirim_ppp_filter::Error> for Status {
    fn from(error: kestirim_ppp_filter::Error) -> Self {
        use kestirim_ppp_filter::Error;
        match error {
            Error::TooFewSatellites => Self::TooFew,
            Error::PoorGeometry => Self::Geometry,
            Error::TimeNotAdvancing => Self::OutOfOrder,
            Error::Contradictory => Self::Contradictory,
            Error::InvalidConfiguration => Self::InvalidArgument,
            Error::NotFinite => Self::NotFinite,
            _ => Self::Refused,
        }
    }
}

impl From<kestirim_snapshot::Error> for Status {
    fn from(error: kestirim_snapshot::Error) -> Self {
        use kestirim_snapshot::Error;
        match error {
            Error::BufferTooShort => Self::TooSmall,
            Error::NoSnapshot => Self::NoSnapshot,
            Error::Foreign(_) => Self::ForeignSnapshot,
            _ => Self::DamagedSnapshot,
        }
    }
}
