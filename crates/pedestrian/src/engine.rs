use crate::alignment::STANDARD_GRAVITY;
use crate::clock::{Clock, Tick};
use crate::detector::{Motion, Verdict};
use crate::freshness::{Freshness, Worth};
use crate::health::Health;
use crate::navigator::{Navigator, Step, ZeroVelocity, velocity_of_rolling};
use crate::sample::Size;
use crate::stride::Strides;
use crate::{Alignment, Config, Error, Estimate, ImuSample, Stride, Warnings};
use kestirim_attitude::Orientation;
use kestirim_scalar::{Components, Scalar};
use nalgebra::SVector;

/// All of a tracker but the decision when the foot stands, which the caller brings.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Engine<T: Scalar, N> {
    config: Config<T>,
    clock: Clock,
    freshness: Freshness<T>,
    pub(crate) alignment: Alignment<T>,
    /// `None` where the motion is not known: before the first stance, and from a loss to the next one.
    navigator: Option<N>,
    lost: Lost<T>,
    /// The last position that a foot can have come to (m, earth).
    place: SVector<T, 3>,
    strides: Strides<T>,
    health: Health<T>,
    was_stance: bool,
    /// Whether this stance has shown that gravity is where the navigator has it.
    upright: bool,
    /// Stances in a row that showed it elsewhere.
    contradictions: u8,
}

/// What is kept of a motion that is not known: the heading, as far as the gyroscope shows it.
#[derive(Clone, Copy, Debug)]
struct Lost<T: Scalar> {
    orientation: Orientation<T>,
    /// The first sample since (µs); `None` before the first stance, which may be any.
    since_us: Option<u32>,
}

impl<T: Scalar> Lost<T> {
    /// Below this SHOE statistic, (rad/s)², the foot stands, whatever was before …
    const CALM: f64 = 0.1;
    /// … and after so long (µs) where the detector says so, which has seen a whole stride then.
    const PATIENCE_US: u32 = 1_500_000;

    /// Whether a stance can be relied upon to level the foot.
    fn is_over(&self, time_us: u32, verdict: &Verdict<T>) -> bool {
        verdict.stance
            && self.since_us.is_none_or(|since_us| {
                verdict.statistic < T::from_f64(Self::CALM)
                    || time_us.wrapping_sub(since_us) > Self::PATIENCE_US
            })
    }

    /// The orientation that the specific force of a stance shows, with the heading that is left, if there was one.
    fn levelled(&self, force: &SVector<T, 3>) -> Option<Orientation<T>> {
        let kept = self.since_us.and_then(|_| self.orientation.levelled(force));
        kept.or_else(|| Orientation::from_specific_force(force))
    }
}

/// What a sample is to the tracker.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Taken<T: Scalar> {
    /// The state of before is that of now.
    Nothing(Estimate<T>),
    /// A motion, on which a verdict is wanted.
    Motion(Motion<T>),
}

impl<T: Scalar, N: Navigator<T>> Engine<T, N> {
    /// No foot is faster (m/s).
    const FASTEST: f64 = 50.0;
    /// A stance with a SHOE statistic below this, (rad/s)², shows gravity within some twenty degrees …
    const SHOWS_GRAVITY: f64 = 0.3;
    /// … and where so many in a row show it elsewhere, the orientation is lost.
    const CONTRADICTIONS: u8 = 2;

    pub(crate) fn new(config: Config<T>) -> Self {
        Self {
            config,
            clock: Clock::default(),
            freshness: Freshness::new(),
            alignment: Alignment::new(config.sensor),
            navigator: None,
            lost: Lost { orientation: Orientation::identity(), since_us: None },
            place: SVector::zeros(),
            strides: Strides::new(),
            health: Health::new(),
            was_stance: false,
            upright: false,
            contradictions: 0,
        }
    }

    /// Whether the sample can be taken, and what its time means. Changes nothing.
    #[inline]
    pub(crate) fn examine(&self, sample: &ImuSample<T>) -> Result<(Tick<T>, Size), Error> {
        Ok((self.clock.tick(sample.time_us)?, sample.check()?))
    }

    /// Notes that a sample was refused. No estimate changes by it.
    #[cold]
    pub(crate) fn refuse(&mut self, time_us: u64, error: Error) {
        if error == Error::TimeBackwards {
            self.clock.refuse(time_us);
        }
    }

    /// The sample as a detector wants it.
    #[inline]
    pub(crate) fn motion(&self, sample: &ImuSample<T>) -> Motion<T> {
        let force = sample.specific_force - self.alignment.accelerometer_bias();
        Motion {
            time_us: sample.time_us as u32,
            force_g: force * T::from_f64(1.0 / STANDARD_GRAVITY),
            angular_rate: sample.angular_rate - self.alignment.gyro_bias(),
        }
    }

    /// Takes an examined sample that measured something as a motion; one that did not is taken for missing.
    #[inline]
    pub(crate) fn take(&mut self, sample: &ImuSample<T>, tick: Tick<T>) -> Taken<T> {
        if tick == Tick::Duplicate {
            return Taken::Nothing(self.estimate(sample.time_us, self.was_stance, None));
        }
        let motion = self.motion(sample);
        let worth = self.freshness.update(sample, &motion);
        let Worth::New { frozen, resumed } = worth else {
            return Taken::Nothing(self.miss(sample.time_us, worth));
        };
        if frozen && self.freshness.is_stuck(sample.time_us) {
            self.health.stuck();
        }
        if resumed || matches!(tick, Tick::Elapsed { lost: true, .. }) {
            self.lose(sample.time_us);
        }
        if let Some(gravity) = self.alignment.update(sample, frozen) {
            self.health.standstill(gravity, self.config.sensor);
        }
        Taken::Motion(motion)
    }

    /// A sample came that is none.
    #[cold]
    fn miss(&mut self, time_us: u64, worth: Worth) -> Estimate<T> {
        if worth == Worth::Zero {
            self.health.dropout();
        } else {
            self.health.stuck();
        }
        if self.clock.is_lost(time_us) {
            self.lose(time_us);
        }
        self.estimate(time_us, self.was_stance, None)
    }

    /// The motion is not known any more: the foot is where it was seen last, until a stance levels it anew.
    #[cold]
    fn lose(&mut self, time_us: u64) {
        if let Some(navigator) = self.navigator.take() {
            let orientation = navigator.orientation();
            let known = T::all_finite(&orientation.quaternion());
            self.lost.orientation = if known { orientation } else { Orientation::identity() };
        }
        self.lost.since_us = Some(time_us as u32);
        self.was_stance = false;
        self.contradictions = 0;
    }

    /// Takes a sample as a motion and with the verdict on it. The first stance levels the foot.
    #[inline]
    pub(crate) fn advance(
        &mut self,
        sample: &ImuSample<T>,
        (tick, size): (Tick<T>, Size),
        motion: &Motion<T>,
        verdict: Verdict<T>,
    ) -> Estimate<T> {
        self.clock.set(sample.time_us);
        if size.large_force {
            self.health.large_force(&sample.specific_force);
        }
        if size.large_rate {
            self.health.large_rate(&sample.angular_rate);
        }
        let step = match tick {
            Tick::Elapsed { interval, gap, .. } => {
                if gap {
                    self.health.gap();
                }
                Some(Step {
                    interval,
                    force_g: motion.force_g,
                    angular_rate: motion.angular_rate,
                    turn: motion.angular_rate * interval,
                })
            }
            _ => None,
        };
        if self.navigator.is_none() {
            self.find(sample, step.as_ref(), &verdict);
        }
        let mut stance = false;
        let mut stride = None;
        if let Some(navigator) = &mut self.navigator {
            stance = verdict.stance;
            if let Some(step) = step {
                navigator.propagate(&step, stance);
                if !is_a_foots(&navigator.velocity(), T::from_f64(Self::FASTEST)) {
                    return self.run_away(sample.time_us);
                }
                if stance {
                    let orientation = navigator.orientation();
                    if !self.was_stance {
                        self.upright = false;
                        self.health.landing(&navigator.velocity());
                    }
                    let statistic = verdict.statistic;
                    if !self.upright
                        && statistic > T::ZERO
                        && statistic < T::from_f64(Self::SHOWS_GRAVITY)
                    {
                        self.upright = true;
                        if is_upright(&orientation.to_earth(&step.force_g)) {
                            self.contradictions = 0;
                        } else {
                            self.contradictions += 1;
                            self.health.contradiction();
                        }
                    }
                    let velocity = velocity_of_rolling(
                        &orientation,
                        &step.angular_rate,
                        self.config.contact_height,
                    );
                    navigator.zero_velocity(&ZeroVelocity {
                        velocity,
                        statistic,
                        interval: step.interval,
                        landing: !self.was_stance,
                    });
                    if !is_a_foots(&navigator.velocity(), T::from_f64(Self::FASTEST)) {
                        return self.run_away(sample.time_us);
                    }
                }
            }
            let position = navigator.position();
            if !T::all_finite(position.as_array()) {
                return self.leave_range(sample.time_us);
            }
            self.place = position;
            stride = self.strides.update(sample.time_us, position, stance);
            self.was_stance = stance;
            if self.contradictions >= Self::CONTRADICTIONS {
                self.lose(sample.time_us);
            }
        }
        self.estimate(sample.time_us, stance, stride)
    }

    /// Begins to navigate where the foot stands; until then, the gyroscope keeps the heading.
    #[cold]
    fn find(&mut self, sample: &ImuSample<T>, step: Option<&Step<T>>, verdict: &Verdict<T>) {
        let lost = &mut self.lost;
        if lost.since_us.is_some()
            && let Some(step) = step
        {
            lost.orientation = lost.orientation.turned_in_body(&step.turn).renormalised();
        }
        if lost.is_over(sample.time_us as u32, verdict) {
            let sensor = self.config.sensor;
            self.navigator = lost
                .levelled(&sample.specific_force)
                .map(|orientation| N::start(sensor, self.place, orientation));
        }
    }

    /// The motion is no foot's.
    #[cold]
    fn run_away(&mut self, time_us: u64) -> Estimate<T> {
        self.health.contradiction();
        self.lose(time_us);
        self.estimate(time_us, false, None)
    }

    /// The place is none that a number can hold.
    #[cold]
    fn leave_range(&mut self, time_us: u64) -> Estimate<T> {
        self.health.out_of_range();
        self.lose(time_us);
        self.estimate(time_us, false, None)
    }

    /// The state after the last sample, again.
    #[inline]
    pub(crate) fn estimate(
        &self,
        time_us: u64,
        stance: bool,
        stride: Option<Stride<T>>,
    ) -> Estimate<T> {
        let (position, velocity, orientation) = match &self.navigator {
            Some(navigator) => {
                (navigator.position(), navigator.velocity(), navigator.orientation())
            }
            None => (self.place, SVector::zeros(), self.lost.orientation),
        };
        Estimate { time_us, position, velocity, orientation, stance, stride }
    }

    pub(crate) fn finish(&mut self) -> Option<Stride<T>> {
        self.strides.finish()
    }

    pub(crate) fn path_length(&self) -> T {
        self.strides.path_length()
    }

    pub(crate) fn warnings(&self) -> Warnings {
        let warnings = self.health.warnings();
        let out_of_range = warnings.out_of_range || self.strides.is_out_of_range();
        Warnings { out_of_range, ..warnings }
    }
}

/// Whether every component of a velocity is below the limit; that of a NaN is not.
#[inline]
fn is_a_foots<T: Scalar>(velocity: &SVector<T, 3>, limit: T) -> bool {
    velocity.as_array().iter().all(|component| component.abs() < limit)
}

/// Whether a specific force (g, earth) is within thirty degrees of upwards.
fn is_upright<T: Scalar>(force_g: &SVector<T, 3>) -> bool {
    let [x, y, z] = *force_g.as_array();
    z > T::ZERO && T::dot(&[x, y], &[x, y]) < z * z * T::from_f64(1.0 / 3.0)
}
