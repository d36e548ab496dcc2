use embedded_hal::delay::DelayNs;
use embedded_hal::i2c::I2c;
use embedded_io::Write;
use kestirim_health::{Health as Doubts, Reason};
use kestirim_luenberger::{Error as Refusal, Predictor, PredictorGains};
use kestirim_scalar::{Components, Scalar};
use kestirim_telemetry::{EstimateHealth, Flight, Health, State, Transmitter};
use nalgebra::SVector;

use crate::aeroplane::{START, gains};
use crate::{Error, Sensors};

/// The time between two calls of [`App::step`], ms.
pub const INTERVAL_MS: u32 = 10;

const GAINS: PredictorGains<4, 2, 3> = gains(INTERVAL_MS as f64 * 1e-3);

/// The number of steps per transmitted health, which makes one a second.
const STEPS_A_HEALTH: u32 = 1_000 / INTERVAL_MS;

/// A noteworthy event in a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Event {
    /// The observer refused the input or the measurement, and advanced without it.
    Refused(Refusal),
    /// The sensors are back after this many steps without them.
    Recovered(u32),
}

/// The application: `T` is the observer's scalar, `P` the port for telemetry.
pub struct App<T: Scalar, I, A, D, P> {
    sensors: Sensors<I, A, D>,
    observer: Predictor<T, 4, 2, 3>,
    line: Transmitter<P>,
    steps: u32,
    /// The number of consecutive steps without sensors.
    blind: u32,
    accepted: u32,
    rejected: u32,
    failed: u32,
}

impl<T: Scalar, I: I2c, A: I2c, D: DelayNs, P: Write> App<T, I, A, D, P> {
    /// Creates an application whose observer starts at [`START`].
    ///
    /// # Errors
    /// [`Error::Observer`] if the scalar cannot hold the gains.
    pub fn new(sensors: Sensors<I, A, D>, port: P) -> Result<Self, Error<I::Error, P::Error>> {
        let start = SVector::from(START.map(T::from_f32));
        Ok(Self {
            sensors,
            observer: Predictor::new(&GAINS, &start).map_err(Error::Observer)?,
            line: Transmitter::new(port),
            steps: 0,
            blind: 0,
            accepted: 0,
            rejected: 0,
            failed: 0,
        })
    }

    /// Reads the sensors and advances by [`INTERVAL_MS`] with the inputs that the actuators apply from `time_us` (µs)
    /// on: elevator (rad) and throttle. Without sensors the observer advances as if they had measured what was
    /// expected.
    ///
    /// # Errors
    /// [`Error`]: a part of the hardware failed. The others have done their work, and the next call goes on.
    pub fn step(
        &mut self,
        time_us: u64,
        inputs: [f32; 2],
    ) -> Result<Option<Event>, Error<I::Error, P::Error>> {
        self.steps = self.steps.wrapping_add(1);
        let measured = self.sensors.read();
        let event = match measured {
            Ok(outputs) => self.observe(inputs, outputs),
            Err(_) => self.coast(inputs),
        };
        let sent = self.tell(time_us, inputs, measured.as_ref().ok().copied());
        measured.map_err(Error::Sensor)?;
        sent.map_err(Error::Port)?;
        Ok(event)
    }

    /// The state at the time of the next step, in the form of [`State`].
    pub fn estimate(&self) -> [f32; 4] {
        self.observer.estimate().as_array().map(T::to_f32)
    }

    fn observe(&mut self, inputs: [f32; 2], outputs: [f32; 3]) -> Option<Event> {
        let input = SVector::from(inputs.map(T::from_f32));
        let output = SVector::from(outputs.map(T::from_f32));
        let blind = core::mem::take(&mut self.blind);
        match self.observer.step(&input, &output) {
            Ok(()) => {
                self.accepted = self.accepted.saturating_add(1);
                (blind > 0).then_some(Event::Recovered(blind))
            }
            Err(refusal) => {
                self.rejected = self.rejected.saturating_add(1);
                // With inputs that are not numbers nothing can be computed: the estimate stays.
                let _ = self.observer.coast(&input);
                Some(Event::Refused(refusal))
            }
        }
    }

    fn coast(&mut self, inputs: [f32; 2]) -> Option<Event> {
        self.failed = self.failed.saturating_add(1);
        self.blind = self.blind.saturating_add(1);
        let coasted = self.observer.coast(&SVector::from(inputs.map(T::from_f32)));
        coasted.err().map(Event::Refused)
    }

    fn tell(
        &mut self,
        time_us: u64,
        inputs: [f32; 2],
        outputs: Option<[f32; 3]>,
    ) -> Result<(), P::Error> {
        if let Some(outputs) = outputs {
            self.line.send(Flight { time_us, inputs, outputs })?;
        }
        let next_us = time_us.saturating_add(u64::from(INTERVAL_MS) * 1_000);
        let state = self.estimate();
        self.line.send(State { time_us: next_us, state })?;
        if self.steps.is_multiple_of(STEPS_A_HEALTH) {
            let Self { accepted, rejected, failed, .. } = *self;
            self.line.send(Health { time_us, accepted, rejected, failed })?;
            let reasons = Doubts::GOOD.with(Reason::Dropout, self.blind > 0).bits();
            self.line.send(EstimateHealth { time_us, reasons })?;
        }
        Ok(())
    }
}
