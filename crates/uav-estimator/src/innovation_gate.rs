use crate::gate::Gate;

/// Beyond so many times the usual size of an innovation an output contradicts the estimate: 6.4 σ of Gaussian noise.
const LIMIT: f64 = 8.0;
/// Innovations over which the usual size is averaged.
const MEMORY: f64 = 64.0;
/// Innovations from which the usual size is known well enough to judge by it.
const FIRST: u8 = 16;

/// A gate for an estimator with a constant gain, which knows no variance: an output is left out whose innovation is
/// many times as large as innovations usually are.
///
/// The usual size is the exponential average of their absolute values, a spike not counted for more than the limit.
/// While an estimate converges its innovations shrink, and none is left out.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct InnovationGate {
    gate: Gate,
    usual: f64,
    seen: u8,
}

impl InnovationGate {
    /// Whether an output with this innovation is to be taken in.
    pub(crate) fn admits(&mut self, innovation: f64) -> bool {
        let size = innovation.abs();
        if self.seen < FIRST {
            self.seen += 1;
            self.usual += (size - self.usual) / f64::from(self.seen);
            return true;
        }
        let limit = LIMIT * self.usual;
        let is_admitted = self.gate.admits(size > limit);
        let counted = if self.gate.is_open() { size } else { size.min(limit) };
        self.usual += (counted - self.usual) / MEMORY;
        is_admitted
    }
}
