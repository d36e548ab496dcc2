use kestirim_scalar::Scalar;
use nalgebra::SVector;

/// Bounds of the tag's position: a box whose sides are parallel to the room's axes (m).
///
/// Three anchors cannot distinguish a tag from its mirror image; only the walls can.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Room<T> {
    /// Smallest x, y and z, m.
    pub low: [T; 3],
    /// Largest x, y and z, m.
    pub high: [T; 3],
}

impl<T: Scalar> Room<T> {
    /// A room between two opposite corners in the plane (m), unbounded in height.
    pub fn plane(x0: T, y0: T, x1: T, y1: T) -> Self {
        Self { low: [x0.min(x1), y0.min(y1), T::MIN], high: [x0.max(x1), y0.max(y1), T::MAX] }
    }

    /// Whether the first D coordinates of `position` are inside, or outside by no more than `margin` (m).
    pub fn contains<const D: usize>(&self, position: &SVector<T, D>, margin: T) -> bool {
        position.iter().zip(self.low.iter().zip(&self.high)).all(|(&coordinate, (&low, &high))| {
            low - margin <= coordinate && coordinate <= high + margin
        })
    }
}
