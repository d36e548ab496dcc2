use kestirim_health::Reason;

/// Degree to which an estimate can be relied upon.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum State {
    /// The estimate is as good as its standard deviation says.
    Good = 0,
    /// The estimate is worse than with better data; its stated accuracy still holds approximately.
    Degraded = 1,
    /// The estimate may be wrong by far more than its stated accuracy: do not rely on it.
    Bad = 2,
}

/// Reasons why an estimate is not good: the bits of `kestirim_health.reasons`.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HealthReason {
    /// A sensor reached the end of its range.
    Saturated = 1,
    /// A sensor keeps repeating the same value.
    Stuck = 1 << 1,
    /// Data are missing, or there are too few.
    Dropout = 1 << 2,
    /// More measurements than usual contradict the estimate and were rejected.
    Rejected = 1 << 3,
    /// A quantity that the estimate needs is not observable in the data.
    NotObservable = 1 << 4,
    /// Time stamps run too fast or too slow, some data are later than others, or products belong to another time.
    Time = 1 << 5,
    /// Data seem to be in another unit or to have another sign.
    Units = 1 << 6,
    /// Axes seem to be swapped or mirrored.
    Axes = 1 << 7,
    /// Measurements and geometry contradict each other.
    Geometry = 1 << 8,
    /// One anchor, or two that seem swapped, contradict the others.
    Anchor = 1 << 9,
    /// The height that was given contradicts the measurements.
    Height = 1 << 10,
    /// The innovations of the measurements exceed their bound.
    Innovations = 1 << 11,
    /// The estimate left the range of its number format.
    Range = 1 << 12,
}

// A reason that is added there needs its bit here.
const _: () = assert!(1 << (Reason::ALL.len() - 1) == HealthReason::Range as u32);
const _: () = assert!(1 << Reason::NotObservable as u32 == HealthReason::NotObservable as u32);

/// Whether an estimate can be relied upon, and all reasons why it cannot.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Health {
    /// Degree to which it can be relied upon: the state of the worst reason.
    pub state: State,
    /// The reasons, one bit each: `kestirim_reason`.
    pub reasons: u32,
}

impl From<kestirim_health::Health> for Health {
    fn from(health: kestirim_health::Health) -> Self {
        Self {
            state: match health.state() {
                kestirim_health::State::Good => State::Good,
                kestirim_health::State::Degraded => State::Degraded,
                kestirim_health::State::Bad => State::Bad,
            },
            reasons: health.reasons().fold(0, |bits, reason| bits | 1 << reason as u32),
        }
    }
}
