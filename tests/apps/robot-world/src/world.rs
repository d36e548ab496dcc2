//! The simulated time and surroundings.

use core::cell::RefCell;

use embedded_hal::delay::DelayNs;

use crate::anchors::Anchors;
use crate::bno055::Bno055;
use crate::dw1000::Dw1000;

/// The ticks of the radio's counter in 10 µs, 15.65 ps each.
const TICKS_IN_10_US: u64 = 638_976;
/// The counter at the start of a stream: it wraps 2 ms later, in the middle of an exchange.
const BEGIN: u64 = (1 << 40) - 2 * 100 * TICKS_IN_10_US;

/// The number of ticks in an interval in µs.
pub(crate) const fn ticks(us: u64) -> u64 {
    us * TICKS_IN_10_US / 10
}

/// The measurements of the devices in one tick of the robot's clock.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// The time since the start of the stream, µs.
    pub time_us: u64,
    /// The range to the anchor whose turn it is, m; NaN if it is silent.
    pub range: f32,
    /// The acceleration in the body axes, cm/s².
    pub acceleration: [i16; 3],
}

/// The surroundings of a robot: the devices on its buses, and the anchors on the air.
#[derive(Debug)]
pub struct World(RefCell<State>);

#[derive(Debug)]
pub(crate) struct State {
    /// The radio's counter without wrapping, which is the time of the whole simulation.
    pub(crate) now: u64,
    pub(crate) radio: Dw1000,
    pub(crate) imu: Bno055,
    pub(crate) anchors: Anchors,
}

impl World {
    /// The surroundings just after power-on.
    pub const fn new() -> Self {
        Self(RefCell::new(State {
            now: 0,
            radio: Dw1000::new(),
            imu: Bno055::new(),
            anchors: Anchors::new(),
        }))
    }

    /// Advances to the time of a sample, if that is in the future, and lets the devices measure it. A stream begins 17
    /// s after power-on.
    pub fn advance(&self, sample: &Sample) {
        self.with(|state| {
            state.now = state.now.max(BEGIN + ticks(sample.time_us));
            state.anchors.range = sample.range;
            state.imu.acceleration = sample.acceleration;
        });
    }

    /// Runs `act` on the state; `None` if a device accessed another one during its own access, which never happens.
    pub(crate) fn with<T>(&self, act: impl FnOnce(&mut State) -> T) -> Option<T> {
        self.0.try_borrow_mut().ok().map(|mut state| act(&mut state))
    }
}

impl Default for World {
    fn default() -> Self {
        Self::new()
    }
}

impl DelayNs for &World {
    fn delay_ns(&mut self, ns: u32) {
        self.with(|state| state.now += ticks(u64::from(ns)).div_ceil(1000));
    }
}
