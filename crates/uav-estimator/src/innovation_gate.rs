/// So many outputs in a row are left out at most: more contradictions are the estimate's fault.
pub(crate) const PATIENCE: u16 = 5;

/// Beyond so many times the usual size of an innovation an output is left out: 6.4 σ of Gaussian noise.
const LIMIT: f64 = 8.0;
/// Innovations over which the usual size is averaged.
const MEMORY: f64 = 64.0;
/// Innovations from which the usual size is known well enough to judge by it.
const FIRST: u16 = 16;

/// A gate for an estimator with a constant gain, which knows no variance: an output is left out whose innovation is
/// many times as large as innovations usually are.
///
/// The usual size is the exponential average of their absolute values, none counted for more than the limit. While an
/// estimate converges its innovations shrink, and none is left out.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(crate) struct InnovationGate {
    usual: f64,
    seen: u16,
    /// In a row.
    rejected: u16,
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
        self.usual += (size.min(limit) - self.usual) / MEMORY;
        if size > limit && self.rejected < PATIENCE {
            self.rejected += 1;
            return false;
        }
        if size > limit {
            // What is usual has changed, or was nothing until now.
            self.usual = size / LIMIT;
        }
        self.rejected = 0;
        true
    }
}
