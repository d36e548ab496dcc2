#![doc = include_str!("../README.md")]
#![no_std]

mod antenna;
mod bias;
mod calibration;
mod clock;
mod common_bias;
mod descent;
mod dilution;
mod downlink;
mod error;
mod height;
mod least_squares;
mod quartiles;
mod range;
mod room;
mod search;
mod survey;
mod symmetric;
mod ticks;
mod timestamp;
mod trilateration;
mod two_way;

pub use antenna::AntennaDelay;
pub use bias::LevelBias;
pub use calibration::Calibration;
pub use clock::{Channel, ClockOffset, DataRate};
pub use dilution::{dilution_of_precision, position_error, weighted_dilution};
pub use downlink::{Broadcast, Difference, Downlink, Heard};
pub use error::Error;
pub use height::{Height, HeightSearch};
pub use least_squares::{Fix, Huber, Observation, Solver};
pub use quartiles::Quartiles;
pub use range::{ExpectedRange, expected_range};
pub use room::Room;
pub use search::Search;
pub use survey::{Survey, survey};
pub use timestamp::{METRES_PER_TICK, SPEED_OF_LIGHT, TICKS_PER_SECOND, Ticks, Timestamp};
pub use trilateration::{Trilateration, trilaterate};
pub use two_way::{DoubleSided, SingleSided};
