use crate::ImuSample;
use kestirim_attitude::Orientation;
use kestirim_scalar::{Components, Scalar};
use nalgebra::SVector;

/// What an axis of a gyroscope did not see, because the body turned faster about it than it can measure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MissedTurn<T: Scalar> {
    /// The most likely rotation, a vector in body axes as they stand now (rad).
    pub turn: SVector<T, 3>,
    /// What the specific force has changed the velocity by since (m/s, earth, gravity not taken off).
    pub pushed: SVector<T, 3>,
}

/// A step as it was integrated.
pub(crate) struct Turned<'a, T: Scalar> {
    /// As it was measured (rad/s).
    pub(crate) rate: &'a SVector<T, 3>,
    /// Whether a component is large.
    pub(crate) large: bool,
    /// s.
    pub(crate) interval: T,
    /// What the specific force changed the velocity by (m/s, earth).
    pub(crate) pushed: SVector<T, 3>,
}

/// Finds the ends of a gyroscope's range in the stream, and what was beyond them.
///
/// A calibrated unit that clips does not repeat a value: bias, scale and the other axes move its plateau by some per
/// mille, and each axis has two ends of its own. What tells a plateau from the top of a swing is its corners: going on
/// with the slopes by which it is entered and left, the curve would have risen far above it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Clipping<T: Scalar> {
    /// The positive and the negative end of each axis.
    ends: [[End<T>; 2]; 3],
    /// The rates before the newest (rad/s).
    before: [SVector<T, 3>; 2],
    /// A plateau has begun and not been judged yet.
    is_open: bool,
}

/// One end of an axis.
#[derive(Clone, Copy, Debug)]
struct End<T: Scalar> {
    /// The largest rate that two samples in a row have reached (rad/s).
    level: T,
    /// That this level is one.
    evidence: u8,
    run: Run<T>,
}

/// A stretch of samples at an end.
#[derive(Clone, Copy, Debug)]
struct Run<T: Scalar> {
    /// Samples; zero between two stretches.
    count: u8,
    /// How long (s).
    duration: T,
    /// By how much the rate grew from sample to sample before it (rad/s).
    rising: T,
    /// How the body has turned since its middle, as far as that was measured (rad).
    turned: SVector<T, 3>,
    /// What the specific force has changed the velocity by since then (m/s, earth).
    pushed: SVector<T, 3>,
    /// The stretch is over: with the next sample it is known how the rate falls.
    is_over: bool,
}

impl<T: Scalar> Run<T> {
    fn none() -> Self {
        let (zero, nothing) = (T::ZERO, SVector::zeros());
        let (turned, pushed) = (nothing, nothing);
        Self { count: 0, duration: zero, rising: zero, turned, pushed, is_over: false }
    }

    /// Moves on by a step, of which this share comes after the middle.
    fn move_on(&mut self, step: &Turned<'_, T>, share: T) {
        self.turned += step.rate * (step.interval * share);
        self.pushed += step.pushed * share;
    }
}

impl<T: Scalar> End<T> {
    /// Share of the largest rate from which on a sample may be clipped.
    const NEAR: f64 = 0.98;
    /// A level that grows by more was none.
    const GROWTH: f64 = 1.02;
    /// A plateau that goes on as it is entered and left would rise by more than this share of its level, where the top of
    /// a parabola rises by 0.02 and a flatter one by 0.04.
    const CORNERS: f64 = 0.05;
    /// One that rises by more than this has sharp corners: it weighs twice …
    const SHARP: f64 = 0.1;
    /// … if it is brief (s), for a foot may turn evenly for a while, …
    const BRIEF: f64 = 0.06;
    /// … and if samples come more often (s): else an impact looks the same.
    const RESOLVED: f64 = 0.0075;
    /// Evidence at the same level that is no chance: strides differ.
    const ENOUGH: u8 = 4;
    /// A swing falls at most so many times as steeply as it rises, and the other way round: what is steeper is an impact.
    const STEEPER: f64 = 2.0;
    /// A foot's swing bends within this time (s): a longer plateau would be no higher.
    const BEND: f64 = 0.08;
    /// No foot turns so fast for so long (s): the sensor is stuck.
    const LONGEST: f64 = 0.3;

    fn new() -> Self {
        Self { level: T::from_f64(ImuSample::<T>::LARGE_RATE), evidence: 0, run: Run::none() }
    }

    fn is_clipped(&self) -> bool {
        self.evidence >= Self::ENOUGH
    }

    /// Takes the newest rate towards this end and the two before it; a stretch that is over, and the angle missed in it
    /// (rad).
    #[inline]
    fn update(&mut self, rate: T, before: [T; 2], step: &Turned<'_, T>) -> Option<(Run<T>, T)> {
        if self.run.is_over {
            self.run.move_on(step, T::ONE);
            let run = core::mem::replace(&mut self.run, Run::none());
            return self.judge(run, (before[0] - rate).max(T::ZERO));
        }
        if rate < self.level * T::from_f64(Self::NEAR) {
            if self.run.count > 0 {
                self.run.is_over = true;
                self.run.move_on(step, T::ONE);
            }
            return None;
        }
        self.rise(rate.min(before[0]));
        if self.run.count == 0 {
            self.run.rising = (before[0] - before[1]).max(T::ZERO);
        }
        self.run.count = self.run.count.saturating_add(1);
        self.run.duration += step.interval;
        self.run.move_on(step, T::HALF);
        None
    }

    /// Two samples in a row have reached this rate.
    #[inline]
    fn rise(&mut self, sustained: T) {
        if sustained > self.level * T::from_f64(Self::GROWTH) {
            self.evidence = 0;
            self.run = Run::none();
        }
        self.level = self.level.max(sustained);
    }

    /// What a stretch weighs that would have risen by eight times so much (rad/s), had it gone on.
    fn weight(&self, run: &Run<T>, rise: T) -> u8 {
        let corners = rise * T::from_f64(1.0 / 8.0);
        let interval = run.duration / T::from_micro(i32::from(run.count.max(1)) * 1_000_000);
        let brief = run.duration < T::from_f64(Self::BRIEF);
        let resolved = interval < T::from_f64(Self::RESOLVED);
        if corners > self.level * T::from_f64(Self::SHARP) && run.count > 1 && brief && resolved {
            2
        } else {
            u8::from(corners > self.level * T::from_f64(Self::CORNERS) && run.count > 2)
        }
    }

    /// Judges a stretch that is over, after which the rate fell by so much from sample to sample.
    fn judge(&mut self, run: Run<T>, falling: T) -> Option<(Run<T>, T)> {
        if run.duration > T::from_f64(Self::LONGEST) {
            return None;
        }
        // The cubic that begins and ends with these slopes rises by an eighth of their sum times the duration, and
        // encloses a twelfth of the same times the duration.
        let steeper = T::from_f64(Self::STEEPER);
        let slopes = run.rising.min(falling * steeper) + falling.min(run.rising * steeper);
        let rise = slopes * T::from_micro(i32::from(run.count) * 1_000_000);
        self.evidence = self.evidence.saturating_add(self.weight(&run, rise));
        let bend = run.duration.min(T::from_f64(Self::BEND));
        self.is_clipped().then(|| (run, rise * bend * T::from_f64(1.0 / 12.0)))
    }
}

impl<T: Scalar> Clipping<T> {
    pub(crate) fn new() -> Self {
        Self { ends: [[End::new(); 2]; 3], before: [SVector::zeros(); 2], is_open: false }
    }

    /// Keeps the ends of the range and forgets the stream, to begin it again.
    pub(crate) fn rewound(mut self) -> Self {
        self.before = [SVector::zeros(); 2];
        self.forget();
        for end in self.ends.iter_mut().flatten() {
            // The same plateaus come once more.
            end.evidence = if end.is_clipped() { end.evidence } else { 0 };
        }
        self
    }

    /// Samples are missing: what was begun is not known.
    pub(crate) fn forget(&mut self) {
        for end in self.ends.iter_mut().flatten() {
            end.run = Run::none();
        }
        self.is_open = false;
    }

    /// Takes the next step, and tells `miss` what was missed in a stretch that is now over.
    #[inline]
    pub(crate) fn update(&mut self, step: &Turned<'_, T>, miss: impl FnMut(&MissedTurn<T>)) {
        if step.large || self.is_open {
            self.at_ends(step, miss);
        }
        self.before = [*step.rate, self.before[0]];
    }

    #[inline(never)]
    fn at_ends(&mut self, step: &Turned<'_, T>, mut miss: impl FnMut(&MissedTurn<T>)) {
        let [before, earlier] = [*self.before[0].as_array(), *self.before[1].as_array()];
        self.is_open = false;
        for axis in 0..3 {
            let (rate, before) = (step.rate.as_array()[axis], [before[axis], earlier[axis]]);
            let [positive, negative] = &mut self.ends[axis];
            for (end, sign) in [(positive, T::ONE), (negative, -T::ONE)] {
                let before = before.map(|rate| rate * sign);
                if let Some((run, angle)) = end.update(rate * sign, before, step) {
                    // It was missed about the axis as that stood in the middle of the stretch.
                    let mut about = SVector::<T, 3>::zeros();
                    about.as_array_mut()[axis] = angle * sign;
                    let since = Orientation::identity().turned_in_body(&run.turned);
                    miss(&MissedTurn { turn: since.to_body(&about), pushed: run.pushed });
                }
                self.is_open |= end.run.count > 0;
            }
        }
    }
}
