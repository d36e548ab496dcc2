//! The tracker of ultra-wideband ranges as a workload for the replay: four or eight calibrated anchors along the walls
//! of a room of 10 m × 8 m.

use kestirim_scalar::Scalar;
use kestirim_uwb_tracker::{Anchor, Config, Outcome, RangeSample, Tracker as Uwb};
use nalgebra::SVector;
use support::{Class, fail};

use crate::four_ranges::Named;
use crate::replay::Tracker;
use crate::stream::Range;

/// Height of the tag, m.
const HEIGHT: f64 = 1.0;
/// The positions of the anchors, dm; the corners come first.
const ANCHORS: [[i32; 3]; 8] = [
    [0, 0, 25],
    [100, 0, 20],
    [100, 80, 25],
    [0, 80, 20],
    [50, 0, 5],
    [100, 40, 2],
    [50, 80, 5],
    [0, 40, 2],
];

/// A tag in the plane.
pub type Plane<T, const A: usize> = Room<T, 2, 4, A>;
/// A tag in space.
pub type Space<T, const A: usize> = Room<T, 3, 6, A>;

/// A tracker of N states in D dimensions among A anchors.
pub struct Room<T: Scalar, const D: usize, const N: usize, const A: usize> {
    tracker: Uwb<T, D, N, A>,
}

impl<T: Scalar, const D: usize, const N: usize, const A: usize> Default for Room<T, D, N, A> {
    fn default() -> Self {
        let anchors = ANCHORS.map(|place| Anchor {
            position: SVector::from(place.map(|dm| T::from_micro(dm * 100_000))),
            bias: T::ZERO,
        });
        let config = Config::calibrated(T::from_f64(HEIGHT));
        match Uwb::new(config, anchors.get(..A).unwrap_or(&anchors)) {
            Ok(tracker) => Self { tracker },
            Err(_) => fail("the anchors fit"),
        }
    }
}

impl<T: Named, const D: usize, const N: usize, const A: usize> Tracker for Room<T, D, N, A> {
    const NAME: &str = match (D, A) {
        (2, 4) => "uwb-tracker-4",
        (2, _) => "uwb-tracker-8",
        _ => "uwb-tracker-space",
    };
    const SCALAR: &str = T::NAME;
    type Record = Range;
    type Input = RangeSample<T>;

    fn input(record: &Range) -> RangeSample<T> {
        RangeSample {
            time_us: record.time_us,
            anchor: record.anchor as usize,
            range: T::from_f32(record.range),
        }
    }

    /// Processes a range. An epoch begins with anchor 0: its range also costs a prediction.
    #[inline(always)]
    fn step(&mut self, sample: &RangeSample<T>) -> Class {
        match self.tracker.range(sample).map(|report| report.outcome) {
            Ok(Outcome::Collected | Outcome::Started) => Class::Start,
            Ok(Outcome::Rejected) | Err(_) => Class::Rejected,
            Ok(_) if sample.anchor == 0 => Class::Predict,
            Ok(_) => Class::Update,
        }
    }

    fn position(&self) -> [f32; 3] {
        let mut place = [0.0; 3];
        if let Some(position) = self.tracker.position() {
            for (coordinate, value) in place.iter_mut().zip(position.iter()) {
                *coordinate = value.to_f32();
            }
        }
        place
    }
}
