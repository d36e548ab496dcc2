use crate::alignment::STANDARD_GRAVITY;
use crate::clipping::{Clipping, Turned};
use crate::clock::{Clock, Tick};
use crate::detector::{Motion, Verdict};
use crate::health::Health;
use crate::navigator::{Navigator, Step, ZeroVelocity, coning, velocity_of_rolling};
use crate::sample::Size;
use crate::stride::Strides;
use crate::{Alignment, Config, Error, Estimate, ImuSample, SensorClass, Stride, Warnings};
use kestirim_attitude::Orientation;
use kestirim_scalar::{Components, Scalar};
use nalgebra::SVector;

/// A tracker without the stance decision, which the caller provides.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Engine<T: Scalar, N> {
    config: Config<T>,
    clock: Clock,
    pub(crate) alignment: Alignment<T>,
    navigator: Option<N>,
    strides: Strides<T>,
    health: Health<T>,
    was_stance: bool,
    /// The turn of the body in the preceding step (rad); zero after a gap, in which it is unknown.
    turn: SVector<T, 3>,
    /// The distance by which landings have moved the foot since the last stride (m).
    moved: T,
    /// Whether a swing ended with a velocity that only a lost tilt explains; a calm stance will level the foot.
    is_tilted: bool,
    pub(crate) clipping: Clipping<T>,
}

impl<T: Scalar, N: Navigator<T>> Engine<T, N> {
    /// The SHOE statistic, (rad/s)², below which a stance shows the direction of gravity.
    const CALM: f64 = 0.1;
    /// Repeated rates are skipped for less than this (s): a longer step is not integrated as a whole.
    const HELD: f64 = 0.15;
    /// A landing that moves the foot by less than this is no jump (m): a stance may flicker.
    const JUMP: f64 = 0.03;
    /// The time without samples for which a lost tilt counts (s).
    const UNSEEN: f64 = 0.2;

    pub(crate) fn new(config: Config<T>) -> Self {
        Self {
            config,
            clock: Clock::default(),
            alignment: Alignment::new(config.sensor),
            clipping: Clipping::new(),
            navigator: None,
            strides: Strides::new(),
            health: Health::new(),
            was_stance: false,
            turn: SVector::zeros(),
            moved: T::ZERO,
            is_tilted: false,
        }
    }

    /// Checks whether the sample can be processed, and interprets its time. Changes nothing.
    #[inline]
    pub(crate) fn examine(&self, sample: &ImuSample<T>) -> Result<(Tick<T>, Size), Error> {
        let (tick, size) = (self.clock.tick(sample.time_us)?, sample.check()?);
        let tick = match tick {
            // Its next reading is used for the time since; a foot that turns evenly is not delayed for long.
            Tick::Elapsed { interval, .. }
                if self.is_held(&sample.angular_rate) && interval < T::from_f64(Self::HELD) =>
            {
                Tick::Duplicate
            }
            tick => tick,
        };
        Ok((tick, size))
    }

    /// Whether a foot turns at exactly the rate of the preceding sample: its sensor was not read again.
    #[inline]
    fn is_held(&self, rate: &SVector<T, 3>) -> bool {
        let ([x, y, z], [a, b, c]) = (*rate.as_array(), *self.clipping.last().as_array());
        x == a && y == b && z == c && turns(rate)
    }

    /// Learns from an examined sample what is constant in the whole stream: biases, and ends of ranges.
    pub(crate) fn learn(&mut self, sample: &ImuSample<T>, (tick, size): (Tick<T>, Size)) {
        if tick == Tick::Duplicate {
            return;
        }
        self.clock.set(sample.time_us);
        self.alignment.update(sample);
        if let Tick::Elapsed { interval, missing } = tick {
            if missing.is_some() {
                self.clipping.forget();
            }
            if self.clipping.concerns(&sample.angular_rate, size.large_rate) {
                let (rate, pushed) = (&sample.angular_rate, SVector::zeros());
                self.clipping.show(&Turned { rate, interval, pushed }, |_| ());
            }
            self.clipping.remember(&sample.angular_rate);
        }
    }

    /// Keeps what was learnt and forgets the stream, to restart it.
    pub(crate) fn rewind(&mut self) {
        self.clock = Clock::default();
        self.alignment = self.alignment.rewound();
        self.clipping = self.clipping.rewound();
    }

    /// Converts the sample to the input of a detector.
    #[inline]
    pub(crate) fn motion(&self, sample: &ImuSample<T>) -> Motion<T> {
        let force = sample.specific_force - self.alignment.accelerometer_bias();
        Motion {
            time_us: sample.time_us as u32,
            force_g: force * T::from_f64(1.0 / STANDARD_GRAVITY),
            angular_rate: sample.angular_rate - self.alignment.gyro_bias(),
        }
    }

    /// Processes an examined sample, as a motion and with the verdict on it. The first stance levels the foot.
    #[inline]
    pub(crate) fn advance(
        &mut self,
        sample: &ImuSample<T>,
        (tick, size): (Tick<T>, Size),
        motion: &Motion<T>,
        verdict: Verdict<T>,
    ) -> Option<Stride<T>> {
        self.clock.set(sample.time_us);
        if size.large_force {
            self.health.large_force(&sample.specific_force);
        }
        if size.large_rate {
            self.health.large_rate(&sample.angular_rate);
        }
        if let Some(gravity) = self.alignment.update(sample) {
            self.health.standstill(gravity, self.alignment.knows_bias(), self.config.sensor);
        }
        if self.navigator.is_none() && verdict.stance {
            self.navigator = Orientation::from_specific_force(&sample.specific_force)
                .map(|orientation| N::start(self.config.sensor, orientation));
        }
        let mut stride = None;
        if let Some(navigator) = &mut self.navigator {
            if let Tick::Elapsed { interval, missing } = tick {
                let mut turn = motion.angular_rate * interval;
                let mut next = turn;
                if let Some(missing) = missing {
                    let before = self.clipping.last() - self.alignment.gyro_bias();
                    (turn, next) =
                        (across(&before, &motion.angular_rate, interval), SVector::zeros());
                    self.health.gap();
                    self.clipping.forget();
                    // The motion of the axis meanwhile is unknown.
                    self.turn = SVector::zeros();
                    if !(self.was_stance && stands(&motion.angular_rate, missing)) {
                        self.strides.miss(missing, verdict.stance);
                    }
                }
                let last = core::mem::replace(&mut self.turn, next);
                let mut step = Step {
                    interval,
                    force_g: motion.force_g,
                    angular_rate: motion.angular_rate,
                    turn,
                };
                // A standing foot hardly turns.
                if !verdict.stance {
                    step.turn += coning(&last, &turn);
                }
                let before = navigator.velocity();
                navigator.propagate(&step, verdict.stance);
                if self.clipping.concerns(&sample.angular_rate, size.large_rate) {
                    let told = (&mut self.health, &mut self.strides);
                    bridge(
                        &mut self.clipping,
                        told,
                        navigator,
                        &sample.angular_rate,
                        interval,
                        &before,
                    );
                }
                self.clipping.remember(&sample.angular_rate);
                if verdict.stance {
                    let landing = !self.was_stance;
                    if landing && !is_within(navigator) {
                        self.health.out_of_range();
                    }
                    if landing
                        && self.health.landing(&navigator.velocity(), interval, self.config.sensor)
                    {
                        self.is_tilted = true;
                        // Something in the swing was missed: a stall, an impact, a turn.
                        self.strides.miss(T::from_f64(Self::UNSEEN), true);
                    }
                    if self.is_tilted && self.config.levels {
                        level(navigator, &sample.specific_force, self.config.sensor);
                        self.is_tilted = verdict.statistic > T::from_f64(Self::CALM);
                    }
                    let velocity = velocity_of_rolling(
                        &navigator.orientation(),
                        &step.angular_rate,
                        self.config.contact_height,
                    );
                    let landed = landing.then(|| navigator.position());
                    navigator.zero_velocity(&ZeroVelocity {
                        velocity,
                        statistic: verdict.statistic,
                        interval,
                        landing,
                    });
                    if let Some(landed) = landed {
                        let [x, y, _] = *(navigator.position() - landed).as_array();
                        let moved = x.hypot(y);
                        if moved > T::from_f64(Self::JUMP) {
                            self.moved += moved;
                        }
                    }
                }
            }
            stride = self.strides.update(sample.time_us, navigator.position(), verdict.stance);
            if let Some(stride) = &mut stride {
                stride.gravity_off = self.alignment.gravity_off();
                let moved = core::mem::replace(&mut self.moved, T::ZERO);
                self.health.stride(stride.length, moved);
            }
        }
        self.was_stance = verdict.stance;
        stride
    }

    /// The state after the last sample, with the stride that it completed.
    #[inline]
    pub(crate) fn estimate(&self, time_us: u64, stride: Option<Stride<T>>) -> Estimate<T> {
        let (position, velocity, orientation) = match &self.navigator {
            Some(navigator) => {
                (navigator.position(), navigator.velocity(), navigator.orientation())
            }
            None => (SVector::zeros(), SVector::zeros(), Orientation::identity()),
        };
        let stance = self.was_stance;
        Estimate { time_us, position, velocity, orientation, stance, stride }
    }

    pub(crate) fn finish(&mut self) -> Option<Stride<T>> {
        let gravity_off = self.alignment.gravity_off();
        self.strides.finish().map(|stride| Stride { gravity_off, ..stride })
    }

    pub(crate) fn path_length(&self) -> T {
        self.strides.path_length()
    }

    pub(crate) fn warnings(&self) -> Warnings {
        let warnings = self.health.warnings();
        let is_beyond =
            self.strides.path_length() == T::MAX || !self.navigator.as_ref().is_none_or(is_within);
        Warnings { out_of_range: warnings.out_of_range || is_beyond, ..warnings }
    }
}

/// Whether position and velocity are within the range of the numbers: fixed point saturates at its largest value.
fn is_within<T: Scalar, N: Navigator<T>>(navigator: &N) -> bool {
    let (position, velocity) = (navigator.position(), navigator.velocity());
    T::all_finite(position.as_array()) && T::all_finite(velocity.as_array())
}

/// Passes a step to the detection of clipping, and advances by what was missed at the ends of the range.
#[inline(never)] // Seldom called: its locals stay off every sample's stack.
fn bridge<T: Scalar, N: Navigator<T>>(
    clipping: &mut Clipping<T>,
    (health, strides): (&mut Health<T>, &mut Strides<T>),
    navigator: &mut N,
    rate: &SVector<T, 3>,
    interval: T,
    before: &SVector<T, 3>,
) {
    let [x, y, z] = *(navigator.velocity() - before).as_array();
    let fall = interval * T::from_f64(STANDARD_GRAVITY);
    let turned = Turned { rate, interval, pushed: SVector::from([x, y, z + fall]) };
    clipping.show(&turned, |missed| {
        health.clipped();
        strides.bridge(&missed.turn);
        navigator.miss(missed);
    });
}

/// The turn of the body where samples are missing (rad), as if its rate had changed linearly.
#[cold]
#[inline(never)] // Seldom called: its locals stay off every sample's stack.
fn across<T: Scalar>(before: &SVector<T, 3>, after: &SVector<T, 3>, interval: T) -> SVector<T, 3> {
    (before + after) * (interval * T::HALF)
}

/// Whether a foot that stood before `missing` seconds without samples, and turns at this rate after them, has stood all
/// the time.
fn stands<T: Scalar>(rate: &SVector<T, 3>, missing: T) -> bool {
    // Shorter than a swing (s).
    missing < T::from_f64(0.4) && !turns(rate)
}

/// Whether a body turns at a rate that no standing foot has.
fn turns<T: Scalar>(rate: &SVector<T, 3>) -> bool {
    // rad/s
    rate.as_array().iter().any(|rate| rate.abs() >= T::HALF)
}

/// Levels a foot to the gravity that its stance shows, keeping its heading.
#[cold]
#[inline(never)] // It is seldom called: its locals stay off every sample's stack.
fn level<T: Scalar, N: Navigator<T>>(
    navigator: &mut N,
    force: &SVector<T, 3>,
    sensor: SensorClass,
) {
    if let Some(orientation) = navigator.orientation().levelled(force) {
        navigator.restart(sensor, orientation);
    }
}

#[cfg(test)]
mod tests;
