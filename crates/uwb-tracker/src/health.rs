use kestirim_scalar::Scalar;

/// State of a tracker's position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum State {
    /// No position has been found yet.
    Initialising,
    /// Ranges come in and fit.
    Tracking,
    /// No range came for a second: the position is extrapolated.
    Coasting,
    /// The position has become worthless: the next ranges make a new one.
    Lost,
}

/// Health of a tracker.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Health<T> {
    /// State of the position.
    pub state: State,
    /// Mean NIS of the last twenty ranges or so that were taken in: 1 when the model is right.
    pub nis: T,
    /// Ranges taken in so far.
    pub taken: u32,
    /// Ranges left out so far.
    pub rejected: u32,
    /// Positions begun anew after the first.
    pub restarts: u16,
    /// Anchors heard within the last second.
    pub heard: u8,
    /// Dilution of precision of those anchors; none if they do not determine a position.
    pub dilution: Option<T>,
    /// Standard deviation of the position, root of its variances' sum, m: the filter's own, and that of the anchors'
    /// constant errors; none without a position.
    pub position_sigma: Option<T>,
    /// The latter alone, m: [`Config::bias_sigma`](crate::Config::bias_sigma) times the dilution of the anchors heard.
    pub bias_sigma: T,
    /// Whether the tag stands still, as far as IMU or wheels tell.
    pub still: bool,
}

/// Counters of a tracker.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Counters<T> {
    pub(crate) nis: T,
    pub(crate) taken: u32,
    pub(crate) rejected: u32,
    /// Two for each that was rejected lately, less one for each that was taken in.
    pub(crate) distrust: u16,
    pub(crate) starts: u16,
    /// Failed attempts to find a position.
    pub(crate) tries: u8,
}

impl<T: Scalar> Counters<T> {
    pub(crate) fn new() -> Self {
        Self { nis: T::ONE, taken: 0, rejected: 0, distrust: 0, starts: 0, tries: 0 }
    }

    #[inline(always)]
    pub(crate) fn take(&mut self, nis: T) {
        self.nis += (nis - self.nis) * T::from_f64(0.05);
        self.taken = self.taken.wrapping_add(1);
        self.distrust = self.distrust.saturating_sub(1);
    }

    #[inline]
    pub(crate) fn reject(&mut self) {
        self.rejected = self.rejected.wrapping_add(1);
        self.distrust = self.distrust.saturating_add(2);
    }
}
