//! `kestirim_uwb_tracker::PublishedTracker` behind the trackers' interface.

use kestirim_scalar::Scalar;
use kestirim_uwb_tracker::{Anchor, PublishedConfig, PublishedOutcome, PublishedTracker};
use nalgebra::SVector;

use super::{Follow, Reception, of_the_plane, place, sample};
use crate::robot::{Error, Event, Setup};
use crate::stored::{behind, read};
use crate::{Number, Stored};

/// The noise that the filter uses.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Noise {
    /// R and Q stay as they are: the plain filter.
    Fixed,
    /// R and Q are adapted by eqs 18 and 19.
    Adapted,
}

/// The start of the filter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Beginning {
    /// The initial position; `None` begins at the first trilateration.
    pub start: Option<[f64; 2]>,
    /// The noise that the filter uses.
    pub noise: Noise,
}

impl Beginning {
    /// A start at the first trilateration, as in practice.
    pub const HONEST: Self = Self { start: None, noise: Noise::Adapted };
}

/// The filter of N states in D dimensions for A anchors.
#[derive(Debug)]
pub(super) struct Published<T: Scalar, const D: usize, const N: usize, const A: usize = 4> {
    tracker: PublishedTracker<T, D, N, A>,
    height_m: f64,
}

impl<T: Number, const D: usize, const N: usize> Published<T, D, N> {
    /// Builds the filter for the number of anchors in the setup.
    ///
    /// # Errors
    /// [`Error::CountOfAnchors`] for fewer than three or more than eight.
    pub(super) fn boxed(setup: &Setup, beginning: Beginning) -> Result<Box<dyn Follow>, Error> {
        macro_rules! first_of {
            ($($count:literal)*) => {
                match setup.anchors.len() {
                    $($count => {
                        Ok(Box::new(Published::<T, D, N, $count>::new(setup, beginning)?))
                    })*
                    _ => Err(Error::CountOfAnchors),
                }
            };
        }
        first_of!(3 4 5 6 7 8)
    }
}

impl<T: Scalar, const D: usize, const N: usize, const A: usize> Published<T, D, N, A> {
    fn new(setup: &Setup, beginning: Beginning) -> Result<Self, Error> {
        let anchors =
            <[Anchor<T>; A]>::try_from(setup.anchors()).map_err(|_| Error::CountOfAnchors)?;
        let height = T::from_f64(setup.height_m);
        let config = match beginning.noise {
            Noise::Fixed => PublishedConfig::plain(height),
            Noise::Adapted => PublishedConfig::adaptive(height),
        };
        let start = beginning
            .start
            .map(|[x, y]| SVector::from_fn(|axis, _| T::from_f64([x, y, setup.height_m][axis])));
        let tracker = PublishedTracker::new(PublishedConfig { start, ..config }, &anchors)?;
        Ok(Self { tracker, height_m: setup.height_m })
    }
}

impl<T: Number, const D: usize, const N: usize, const A: usize> Follow for Published<T, D, N, A> {
    fn take(&mut self, time_us: u64, event: &Event) -> Reception {
        let number = T::from_f64;
        let taken = match *event {
            Event::Range(ref range) => self.tracker.range(&sample(time_us, range)).is_ok(),
            Event::Inertial(inertial) => {
                let push = |push: [f64; 3]| std::array::from_fn(|axis| number(push[axis]));
                self.tracker.push(inertial.push.map(push));
                true
            }
            Event::Height { metres, .. } => {
                let set = self.tracker.set_height(number(metres)).is_ok();
                if set {
                    self.height_m = metres;
                }
                set
            }
            // An epoch that eq. 18 makes impossible is left out.
            Event::EpochEnd { .. } => {
                !matches!(self.tracker.end_epoch(time_us), PublishedOutcome::Refused(_))
            }
            // Other events are not used.
            _ => true,
        };
        Reception::unweighed(taken)
    }

    fn position(&self) -> Option<[f64; 3]> {
        place(&self.tracker.position()?, self.height_m)
    }

    fn spread(&self) -> Option<[f64; 3]> {
        self.tracker.estimate().and_then(|estimate| of_the_plane(&estimate.covariance))
    }

    fn snapshot(&self) -> Option<Vec<u8>> {
        Some(behind([self.height_m.to_bits()], &self.tracker.stored()?))
    }

    fn restore(&mut self, snapshot: &[u8]) -> Option<()> {
        let ([height], tracker) = read(snapshot)?;
        self.tracker = Stored::restored(tracker)?;
        self.height_m = f64::from_bits(height);
        Some(())
    }
}
