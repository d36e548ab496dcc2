//! Counters of the fleet.

use serde::{Deserialize, Serialize};

/// What happened to the frames of a device, or of all devices.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Counts {
    /// Frames that were processed.
    pub(super) frames: u64,
    /// Missing sequence numbers.
    pub(super) lost: u64,
    /// Frames that were duplicates or arrived behind later ones.
    pub(super) dropped: u64,
    /// Frames of another sender with the same device number, or of one that does not count its boots.
    pub(super) another: u64,
    /// Measurements that the estimators used.
    pub(super) taken: u64,
    /// Measurements that the estimators refused.
    pub(super) refused: u64,
    /// The number of times that devices were switched on again.
    pub(super) restarts: u64,
    /// Estimates that were produced.
    pub(super) estimates: u64,
}

impl Counts {
    /// The metric name, description and value of each counter.
    pub(super) fn named(&self) -> [(&'static str, &'static str, u64); 8] {
        [
            ("frames", "Frames that were followed", self.frames),
            ("lost", "Numbers that did not come", self.lost),
            ("dropped", "Frames that came twice, or behind later ones", self.dropped),
            ("another", "Frames of another sender with the same device number", self.another),
            ("taken", "Measurements that the estimators took in", self.taken),
            ("refused", "Measurements that the estimators refused", self.refused),
            ("restarts", "How often devices were switched on again", self.restarts),
            ("estimates", "Estimates that were made", self.estimates),
        ]
    }

    /// Adds the counts of another.
    pub(super) fn add(&mut self, other: &Self) {
        self.frames += other.frames;
        self.lost += other.lost;
        self.dropped += other.dropped;
        self.another += other.another;
        self.taken += other.taken;
        self.refused += other.refused;
        self.restarts += other.restarts;
        self.estimates += other.estimates;
    }
}
