use crate::ImuSample;
use kestirim_attitude::Orientation;
use kestirim_scalar::{Components, Scalar};
use nalgebra::SVector;

/// The rotation that an axis of a gyroscope missed, because the body turned faster about it than the axis can measure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MissedTurn<T: Scalar> {
    /// The most likely rotation vector, in the current body axes (rad).
    pub turn: SVector<T, 3>,
    /// The velocity change by the specific force since then (m/s, earth, gravity not subtracted).
    pub pushed: SVector<T, 3>,
}

/// A step as it was integrated.
pub(crate) struct Turned<'a, T: Scalar> {
    /// The measured rate (rad/s).
    pub(crate) rate: &'a SVector<T, 3>,
    /// The interval (s).
    pub(crate) interval: T,
    /// The velocity change by the specific force (m/s, earth).
    pub(crate) pushed: SVector<T, 3>,
}

/// Finds the ends of a gyroscope's range in the stream, and the rotation beyond them.
///
/// A calibrated unit that clips does not repeat a value: bias, scale and the other axes shift its plateau by up to
/// two per cent, and each axis has two ends of its own. A plateau differs from the top of a swing by its corners: continued
/// with the slopes at its beginning and end, the curve would have risen far above it.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Clipping<T: Scalar> {
    axes: [Axis<T>; 3],
    /// The two rates before the newest (rad/s).
    before: [SVector<T, 3>; 2],
    /// Whether a plateau has begun that has not been judged yet.
    is_open: bool,
}

/// The two ends of an axis.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct Axis<T: Scalar> {
    positive: End<T>,
    negative: End<T>,
    run: Run<T>,
}

/// One end of an axis.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct End<T> {
    /// The largest rate that two consecutive samples have reached (rad/s).
    level: T,
    /// The evidence that this level is an end of the range.
    evidence: u8,
}

/// A stretch of samples at an end.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct Run<T: Scalar> {
    /// The number of samples; zero between two stretches.
    count: u8,
    /// Whether the stretch is at the negative end.
    is_negative: bool,
    /// The duration of the stretch (s).
    duration: T,
    /// The increase of the rate from sample to sample before the stretch (rad/s).
    rising: T,
    /// The measured rotation of the body since the middle of the stretch (rad).
    turned: SVector<T, 3>,
    /// The velocity change by the specific force since the middle of the stretch (m/s, earth).
    pushed: SVector<T, 3>,
    /// Whether the stretch is over: the next sample shows how the rate falls.
    is_over: bool,
}

impl<T: Scalar> Run<T> {
    fn none() -> Self {
        let (zero, turned, pushed) = (T::ZERO, SVector::zeros(), SVector::zeros());
        let (count, is_negative, is_over) = (0, false, false);
        Self { count, is_negative, duration: zero, rising: zero, turned, pushed, is_over }
    }

    /// Advances by a step, of which `share` follows the middle.
    fn move_on(&mut self, step: &Turned<'_, T>, share: T) {
        self.turned += step.rate * (step.interval * share);
        self.pushed += step.pushed * share;
    }
}

impl<T: Scalar> End<T> {
    /// The share of the largest rate from which on a sample may be clipped.
    const NEAR: f64 = 0.98;
    /// A level that grows by more than this factor was no end of the range.
    const GROWTH: f64 = 1.02;
    /// A plateau is clipped if, continued with the slopes at its ends, it would rise by more than this share of its
    /// level; the top of a parabola rises by 0.02 and a flatter one by 0.04.
    const CORNERS: f64 = 0.05;
    /// A plateau that would rise by more than this share has sharp corners: it weighs twice, if it is brief and
    /// resolved.
    const SHARP: f64 = 0.1;
    /// The longest brief plateau (s), for a foot may turn evenly for a while.
    const BRIEF: f64 = 0.06;
    /// The longest sampling interval that resolves corners (s): with a longer one an impact looks the same.
    const RESOLVED: f64 = 0.0075;
    /// The evidence at the same level that excludes chance, as strides differ.
    const ENOUGH: u8 = 4;
    /// The largest ratio between the slopes of a swing's rise and fall: what is steeper is an impact.
    const STEEPER: f64 = 2.0;
    /// The time within which a foot's swing bends (s): a longer plateau would rise no higher.
    const BEND: f64 = 0.08;
    /// The longest plateau (s): no foot turns so fast for longer, so the sensor is stuck.
    const LONGEST: f64 = 0.3;

    fn new() -> Self {
        Self { level: T::from_f64(ImuSample::<T>::LARGE_RATE), evidence: 0 }
    }

    fn is_clipped(&self) -> bool {
        self.evidence >= Self::ENOUGH
    }

    /// Keeps a known end, and discards other evidence: the same plateaus will recur.
    fn rewound(self) -> Self {
        Self { evidence: if self.is_clipped() { self.evidence } else { 0 }, ..self }
    }

    fn is_near(&self, rate: T) -> bool {
        rate >= self.level * T::from_f64(Self::NEAR)
    }

    /// Processes a rate that two consecutive samples have reached; returns whether the previous level was no end of the
    /// range.
    fn rise(&mut self, sustained: T) -> bool {
        let was_none = sustained > self.level * T::from_f64(Self::GROWTH);
        if was_none {
            self.evidence = 0;
        }
        self.level = self.level.max(sustained);
        was_none
    }

    /// The weight of a stretch that would have risen by an eighth of `rise` (rad/s), had it continued.
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

    /// Judges a finished stretch, after which the rate fell by `falling` from sample to sample; returns the angle
    /// missed in it (rad).
    fn judge(&mut self, run: &Run<T>, falling: T) -> Option<T> {
        if run.duration > T::from_f64(Self::LONGEST) {
            return None;
        }
        // The cubic with these slopes at its ends rises by an eighth of their sum times the duration, and encloses a
        // twelfth of that sum times the duration squared.
        let steeper = T::from_f64(Self::STEEPER);
        let slopes = run.rising.min(falling * steeper) + falling.min(run.rising * steeper);
        let rise = slopes * T::from_micro(i32::from(run.count) * 1_000_000);
        self.evidence = self.evidence.saturating_add(self.weight(run, rise));
        let bend = run.duration.min(T::from_f64(Self::BEND));
        self.is_clipped().then(|| rise * bend * T::from_f64(1.0 / 12.0))
    }
}

impl<T: Scalar> Axis<T> {
    fn new() -> Self {
        Self { positive: End::new(), negative: End::new(), run: Run::none() }
    }

    /// Processes the newest rate and the two before it; returns a finished stretch and the angle missed in it (rad).
    fn update(&mut self, rate: T, before: [T; 2], step: &Turned<'_, T>) -> Option<(Run<T>, T)> {
        let is_negative = if self.run.count > 0 { self.run.is_negative } else { rate < T::ZERO };
        let (end, sign) =
            if is_negative { (&mut self.negative, -T::ONE) } else { (&mut self.positive, T::ONE) };
        let (rate, before) = (rate * sign, before.map(|rate| rate * sign));
        if self.run.is_over {
            self.run.move_on(step, T::ONE);
            let run = core::mem::replace(&mut self.run, Run::none());
            let angle = end.judge(&run, (before[0] - rate).max(T::ZERO))?;
            return Some((run, angle * sign));
        }
        if end.is_near(rate) {
            if end.rise(rate.min(before[0])) {
                self.run = Run::none();
            }
            if self.run.count == 0 {
                self.run.is_negative = is_negative;
                self.run.rising = (before[0] - before[1]).max(T::ZERO);
            }
            self.run.count = self.run.count.saturating_add(1);
            self.run.duration += step.interval;
            self.run.move_on(step, T::HALF);
        } else if self.run.count > 0 {
            self.run.is_over = true;
            self.run.move_on(step, T::ONE);
        }
        None
    }
}

impl<T: Scalar> Clipping<T> {
    pub(crate) fn new() -> Self {
        Self { axes: [Axis::new(); 3], before: [SVector::zeros(); 2], is_open: false }
    }

    /// Keeps the ends of the range and forgets the stream, to restart it.
    pub(crate) fn rewound(mut self) -> Self {
        self.before = [SVector::zeros(); 2];
        self.forget();
        for axis in &mut self.axes {
            axis.positive = axis.positive.rewound();
            axis.negative = axis.negative.rewound();
        }
        self
    }

    /// The last remembered rate (rad/s).
    pub(crate) fn last(&self) -> SVector<T, 3> {
        self.before[0]
    }

    /// Forgets unfinished stretches, after missing samples.
    pub(crate) fn forget(&mut self) {
        for axis in &mut self.axes {
            axis.run = Run::none();
        }
        self.is_open = false;
    }

    /// Whether a step at this rate, `large` or not, must be passed to [`Self::show`]: all others change nothing.
    #[inline]
    pub(crate) fn concerns(&self, rate: &SVector<T, 3>, large: bool) -> bool {
        self.is_open || large && self.is_near(rate)
    }

    /// Whether an axis is near one of its ends.
    #[inline(never)] // Few rates are large.
    fn is_near(&self, rate: &SVector<T, 3>) -> bool {
        let mut axes = self.axes.iter().zip(rate.as_array());
        axes.any(|(axis, rate)| {
            let end = if *rate < T::ZERO { &axis.negative } else { &axis.positive };
            end.is_near(rate.abs())
        })
    }

    /// Remembers a rate (rad/s), whether shown or not.
    #[inline]
    pub(crate) fn remember(&mut self, rate: &SVector<T, 3>) {
        self.before = [*rate, self.before[0]];
    }

    /// Processes a step and passes to `miss` what was missed in a stretch that is now over.
    pub(crate) fn show(&mut self, step: &Turned<'_, T>, mut miss: impl FnMut(&MissedTurn<T>)) {
        let [before, earlier] = [*self.before[0].as_array(), *self.before[1].as_array()];
        self.is_open = false;
        for (index, axis) in self.axes.iter_mut().enumerate() {
            let (rate, before) = (step.rate.as_array()[index], [before[index], earlier[index]]);
            if let Some((run, angle)) = axis.update(rate, before, step) {
                // The rotation was missed about the axis as it was in the middle of the stretch.
                let mut about = SVector::<T, 3>::zeros();
                about.as_array_mut()[index] = angle;
                // From the identity it is the same as in the body, and linked already.
                let since = Orientation::identity().turned_in_earth(&run.turned);
                miss(&MissedTurn { turn: since.to_body(&about), pushed: run.pushed });
            }
            self.is_open |= axis.run.count > 0;
        }
    }
}

#[cfg(test)]
mod tests;
