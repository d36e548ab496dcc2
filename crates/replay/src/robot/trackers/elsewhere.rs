//! Rooms far from the origin of their coordinates, such as those of a map.
//!
//! Single precision is too coarse there (3 cm at 500 km), and fixed point ends at 2 km: tracking is therefore relative
//! to an origin nearby, in whole metres.

use super::{Follow, Reception};
use crate::robot::{Event, Setup};

/// The largest coordinates in the plane that are used as they are, m: single precision resolves 31 µm there.
const NEAR: f64 = 500.0;

/// The nearby origin, m, if the anchors are far from their own.
pub(super) fn origin(setup: &Setup) -> Option<[f64; 2]> {
    let is_far = setup.anchors.iter().any(|[x, y, _]| x.abs().max(y.abs()) > NEAR);
    let count = setup.anchors.len() as f64;
    let mean = |axis: usize| setup.anchors.iter().map(|anchor| anchor[axis]).sum::<f64>() / count;
    is_far.then(|| [0, 1].map(|axis| mean(axis).round()))
}

/// The setup relative to this origin.
pub(super) fn about(setup: &Setup, [x, y]: [f64; 2]) -> Setup {
    let mut near = setup.clone();
    for anchor in &mut near.anchors {
        *anchor = [anchor[0] - x, anchor[1] - y, anchor[2]];
    }
    near.room = near.room.map(|[x0, y0, x1, y1]| [x0 - x, y0 - y, x1 - x, y1 - y]);
    near
}

/// A tracker relative to a nearby origin.
#[derive(Debug)]
pub(super) struct Elsewhere {
    pub(super) tracker: Box<dyn Follow>,
    pub(super) origin: [f64; 2],
}

impl Follow for Elsewhere {
    fn take(&mut self, time_us: u64, event: &Event) -> Reception {
        self.tracker.take(time_us, event)
    }

    fn position(&self) -> Option<[f64; 3]> {
        let ([x, y, z], [x0, y0]) = (self.tracker.position()?, self.origin);
        Some([x0 + x, y0 + y, z])
    }

    fn spread(&self) -> Option<[f64; 3]> {
        self.tracker.spread()
    }

    fn height_variance(&self) -> Option<f64> {
        self.tracker.height_variance()
    }

    fn mirror(&self) -> Option<[f64; 3]> {
        self.tracker.mirror()
    }

    fn health(&self) -> kestirim_health::Health {
        self.tracker.health()
    }

    fn snapshot(&self) -> Option<Vec<u8>> {
        self.tracker.snapshot()
    }

    fn restore(&mut self, snapshot: &[u8]) -> Option<()> {
        self.tracker.restore(snapshot)
    }
}
