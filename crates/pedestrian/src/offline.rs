use crate::clock::Tick;
use crate::detector::{RecentMinimum, Shoe, SwingLevel, Verdict};
use crate::engine::Engine;
use crate::navigator::Navigator;
use crate::{Config, Error, Estimate, ImuSample, Stride, Warnings};
use kestirim_scalar::Scalar;

/// Tracks a foot through a recorded walk, looking ahead.
///
/// Two things are better known afterwards: the biases, from every standstill of the recording, and the stances, whose
/// SHOE statistic is compared with the smallest within 0.6 s before and after.
///
/// An iterator over the estimates, one per sample; the memory needed is the recording and one number per sample, both
/// provided by the caller.
#[derive(Debug)]
pub struct OfflineTracker<'a, T: Scalar, N> {
    engine: Engine<T, N>,
    samples: &'a [ImuSample<T>],
    statistic: &'a [T],
    minimum: RecentMinimum<T>,
    /// The statistic below which the foot always stands, (rad/s)².
    floor: T,
    next: usize,
    ahead: usize,
}

impl<'a, T: Scalar, N: Navigator<T>> OfflineTracker<'a, T, N> {
    /// The threshold as a multiple of the smallest SHOE statistic around a sample.
    const FACTOR: f64 = 1.5;
    /// The statistic, (rad/s)², below which the foot always stands; for a slow walker only a share of it.
    const FLOOR: f64 = 0.15;
    /// Half of the span over which the smallest statistic is searched (µs).
    const LOOK_US: u64 = 600_000;
    /// The full span over which the smallest statistic is searched, in bins.
    const LOOK_BINS: usize = 12;

    /// Prepares a walk. `statistic` is working memory for the SHOE statistic, with an entry per sample.
    ///
    /// # Errors
    /// The index of the first sample that no tracker can process, and why. (A missing entry of `statistic` counts as
    /// such a sample: [`Error::NoMemory`].)
    pub fn new(
        config: Config<T>,
        samples: &'a [ImuSample<T>],
        statistic: &'a mut [T],
    ) -> Result<Self, (usize, Error)> {
        if statistic.len() < samples.len() {
            return Err((statistic.len(), Error::NoMemory));
        }
        let mut engine = Engine::<T, N>::new(config);
        for (index, sample) in samples.iter().enumerate() {
            let examined = engine.examine(sample).map_err(|error| (index, error))?;
            engine.learn(sample, examined);
        }
        engine.rewind();
        centred_statistic(&engine, samples, statistic);
        // The level of the whole walk, or of the last twenty minutes of a long one.
        let mut swing = SwingLevel::<T, 1_000>::new();
        for (sample, &statistic) in samples.iter().zip(&*statistic) {
            swing.push(sample.time_us as u32, statistic);
        }
        let floor = swing.share() * T::from_f64(Self::FLOOR);
        let minimum = RecentMinimum::new(Self::LOOK_BINS);
        Ok(Self { engine, samples, statistic, minimum, floor, next: 0, ahead: 0 })
    }

    /// Ends the walk: the stride that led to the stance the foot is in, if any.
    pub fn finish(&mut self) -> Option<Stride<T>> {
        self.engine.finish()
    }

    /// The length of the horizontal path walked so far, from stance to stance (m).
    pub fn path_length(&self) -> T {
        self.engine.path_length()
    }

    /// Suspicious findings about the stream so far.
    pub fn warnings(&self) -> Warnings {
        self.engine.warnings()
    }

    /// The smallest SHOE statistic around `time_us`, (rad/s)².
    fn minimum_around(&mut self, time_us: u64) -> T {
        while let (Some(sample), Some(&statistic)) =
            (self.samples.get(self.ahead), self.statistic.get(self.ahead))
        {
            if sample.time_us > time_us.saturating_add(Self::LOOK_US) {
                break;
            }
            self.minimum.push(sample.time_us as u32, statistic);
            self.ahead += 1;
        }
        self.minimum.smallest()
    }
}

impl<T: Scalar, N: Navigator<T>> Iterator for OfflineTracker<'_, T, N> {
    type Item = Estimate<T>;

    fn next(&mut self) -> Option<Estimate<T>> {
        let (sample, &statistic) = (self.samples.get(self.next)?, self.statistic.get(self.next)?);
        self.next += 1;
        let minimum = self.minimum_around(sample.time_us);
        // Every sample was examined when the walk was prepared.
        let examined = self.engine.examine(sample).ok()?;
        let mut stride = None;
        if examined.0 != Tick::Duplicate {
            let bound = (minimum * T::from_f64(Self::FACTOR)).max(self.floor);
            let verdict = Verdict { stance: statistic < bound, statistic };
            let motion = self.engine.motion(sample);
            stride = self.engine.advance(sample, examined, &motion, verdict);
        }
        Some(self.engine.estimate(sample.time_us, stride))
    }
}

/// Computes the statistic T of the window around each sample, instead of the one that ends at it.
fn centred_statistic<T: Scalar, N: Navigator<T>>(
    engine: &Engine<T, N>,
    samples: &[ImuSample<T>],
    statistic: &mut [T],
) {
    let mut shoe = Shoe::default();
    let mut centred = 0;
    let mut last = T::MAX;
    for sample in samples {
        last = shoe.update(&engine.motion(sample));
        let middle_us = sample.time_us.saturating_sub(u64::from(Shoe::<T>::WINDOW_US / 2));
        while samples.get(centred).is_some_and(|sample| sample.time_us <= middle_us) {
            if let Some(entry) = statistic.get_mut(centred) {
                *entry = last;
            }
            centred += 1;
        }
    }
    for entry in statistic.iter_mut().skip(centred) {
        *entry = last;
    }
}
