use crate::gate::Gate;

/// Ratio to the usual size of an innovation beyond which an output contradicts the estimate: 6.4 σ of Gaussian noise.
const LIMIT: f64 = 8.0;
/// Number of innovations over which the usual size is averaged.
const MEMORY: f64 = 64.0;
/// Number of innovations after which the usual size is known well enough.
const FIRST: u8 = 16;

/// A gate for an estimator with a constant gain, which has no variance: it rejects outputs whose innovation is many
/// times as large as usual.
///
/// The usual size is the exponential average of the absolute values, where a spike counts no more than the limit.
/// While an estimate converges, its innovations shrink, and none is rejected.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct InnovationGate {
    gate: Gate,
    usual: f64,
    seen: u8,
}

impl InnovationGate {
    /// Whether the last innovations contradicted the estimate so often that they are used all the same.
    pub(crate) const fn is_open(&self) -> bool {
        self.gate.is_open()
    }

    /// Whether an output with this innovation is to be used.
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
