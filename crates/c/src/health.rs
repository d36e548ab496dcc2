use kestirim_health::Reason;

/// How far an estimate can be relied upon.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum State {
    /// As its standard deviation says.
    Good = 0,
    /// Worse than with better data; what is said of its accuracy still holds, more or less.
    Degraded = 1,
    /// It may be wrong by far more than anything says: not to be relied upon.
    Bad = 2,
}

/// Bits of `kestirim_health.reasons`: why an estimate is not good.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HealthReason {
    /// A sensor was at its end.
    Saturated = 1,
    /// A sensor repeated itself.
    Stuck = 1 << 1,
    /// Data are missing, or too few.
    Dropout = 1 << 2,
    /// More measurements than usual contradict the estimate and were left out.
    Rejected = 1 << 3,
    /// What the estimate needs cannot be seen in the data.
    NotObservable = 1 << 4,
    /// Times run too fast or too slow, or products belong to another time.
    Time = 1 << 5,
    /// Data seem to be in another unit, or of another sign.
    Units = 1 << 6,
    /// Axes seem to be swapped or mirrored.
    Axes = 1 << 7,
    /// Measurements and geometry contradict each other.
    Geometry = 1 << 8,
    /// One anchor, or two that seem swapped, contradict the others.
    Anchor = 1 << 9,
    /// The height that was said contradicts the measurements.
    Height = 1 << 10,
    /// What is left of the measurements is beyond its bound.
    Innovations = 1 << 11,
    /// The estimate left the range of its numbers.
    Range = 1 << 12,
}

// A reason that is added there needs its bit here.
const _: () = assert!(1 << (Reason::ALL.len() - 1) == HealthReason::Range as u32);
const _: () = assert!(1 << Reason::NotObservable as u32 == HealthReason::NotObservable as u32);

/// Whether an estimate can be relied upon, and all reasons why not.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Health {
    /// How far: the state of the worst reason.
    pub state: State,
    /// A bit a reason: see `kestirim_health_reason`.
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
