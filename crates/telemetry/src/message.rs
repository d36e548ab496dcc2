use postcard::experimental::max_size::MaxSize;
use serde::{Deserialize, Serialize};

/// Declares the kinds of messages: all are plain data.
macro_rules! messages {
    ($($(#[$attribute:meta])* $name:ident { $($(#[$note:meta])* $field:ident: $type:ty,)* })*) => {
        /// Content of a frame.
        #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, MaxSize)]
        #[cfg_attr(feature = "defmt", derive(defmt::Format))]
        #[non_exhaustive]
        pub enum Message {
            $($(#[$attribute])* $name($name),)*
        }

        $(
            $(#[$attribute])*
            #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, MaxSize)]
            #[cfg_attr(feature = "defmt", derive(defmt::Format))]
            pub struct $name {
                $($(#[$note])* pub $field: $type,)*
            }

            impl From<$name> for Message {
                fn from(message: $name) -> Self {
                    Self::$name(message)
                }
            }
        )*
    };
}

impl Message {
    /// The time of a measurement (µs, the sender's clock); `None` for what a sender reports of its estimate or of
    /// itself.
    pub const fn measured_us(&self) -> Option<u64> {
        match self {
            Self::Imu(Imu { time_us, .. })
            | Self::Range(Range { time_us, .. })
            | Self::PathLoss(PathLoss { time_us, .. })
            | Self::Flight(Flight { time_us, .. }) => Some(*time_us),
            Self::Position(_)
            | Self::GlobalPosition(_)
            | Self::State(_)
            | Self::Footprint(_)
            | Self::Health(_)
            | Self::EstimateHealth(_) => None,
        }
    }
}

// The order is part of the format: a new kind goes to the end.
messages! {
    /// A sample of an inertial sensor, in its own axes.
    Imu {
        /// Time (µs, the sender's clock).
        time_us: u64,
        /// Specific force (m/s²); at rest +1 g upwards.
        specific_force: [f32; 3],
        /// Angular rate (rad/s).
        angular_rate: [f32; 3],
    }

    /// A distance to an anchor.
    Range {
        /// Time (µs, the sender's clock).
        time_us: u64,
        /// Number of the anchor.
        anchor: u16,
        /// Range (m).
        range: f32,
    }

    /// A path loss between a drone and a user.
    PathLoss {
        /// Time (µs, the sender's clock).
        time_us: u64,
        /// Position of the drone (m, east, north, up).
        place: [f32; 3],
        /// Path loss (dB).
        loss: f32,
    }

    /// Commands to an aeroplane, and its measurements.
    Flight {
        /// Time (µs, the sender's clock).
        time_us: u64,
        /// Elevator (rad) and throttle.
        inputs: [f32; 2],
        /// Pitch rate (rad/s), airspeed (m/s) and pitch (rad).
        outputs: [f32; 3],
    }

    /// An estimated position near the start or in a room.
    Position {
        /// Time (µs, the sender's clock).
        time_us: u64,
        /// Position (m), in the estimator's local frame, z up.
        position: [f32; 3],
        /// Standard deviation of a horizontal component (m), where the estimator knows it.
        sigma: Option<f32>,
    }

    /// An estimated position on earth.
    GlobalPosition {
        /// Time (µs, the sender's clock).
        time_us: u64,
        /// Position (m), earth-centred and earth-fixed.
        position: [f64; 3],
        /// Standard deviation of a component (m), where the estimator knows it.
        sigma: Option<f32>,
    }

    /// The state of an aeroplane's longitudinal motion, as its observer estimates it.
    State {
        /// Time (µs, the sender's clock).
        time_us: u64,
        /// Angle of attack (rad), pitch rate (rad/s), airspeed (m/s) and pitch (rad).
        state: [f32; 4],
    }

    /// A stride of the instrumented foot: where the foot came to rest.
    Footprint {
        /// Time (µs, the sender's clock).
        time_us: u64,
        /// Position (m), in the tracker's earth frame, z up.
        position: [f32; 3],
        /// Horizontal distance from the previous footprint (m).
        length: f32,
    }

    /// Health of the sender: counts since it started.
    Health {
        /// Time (µs, the sender's clock).
        time_us: u64,
        /// Measurements that the estimator accepted.
        accepted: u32,
        /// Measurements that the estimator rejected.
        rejected: u32,
        /// Readings that a driver did not deliver.
        failed: u32,
    }

    /// Whether the sender's estimate can be relied upon.
    EstimateHealth {
        /// Time (µs, the sender's clock).
        time_us: u64,
        /// The reasons why it cannot, as bits (`kestirim_health::Health::bits`); 0 if it can.
        reasons: u16,
    }
}
