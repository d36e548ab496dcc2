use kestirim_scalar::Scalar;

use crate::TrackEstimate;

/// The height of the flight above the user.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Height<T> {
    /// A constant height, m.
    Fixed(T),
    /// Five times the standard deviation of a coordinate, between these two limits, m: high while the user is
    /// searched for, low to locate them precisely. A loss determines the distance best at a horizontal distance of a
    /// third of the height, and the better the lower the drone flies.
    Between(T, T),
}

/// Place and height for the next measurement.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Waypoint<T> {
    /// Place, m.
    pub place: [T; 2],
    /// Height, m.
    pub height: T,
}

/// A flight plan of circles around the predicted place of the user.
///
/// Directly above the user, the loss does not depend on the direction in which they move; the thesis' drone, which
/// flies there, cannot observe it. The radius follows the uncertainty of the estimate.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Orbit<T> {
    height: Height<T>,
    /// Angle from one waypoint to the next, rad.
    advance: T,
    angle: T,
}

impl<T: Scalar> Orbit<T> {
    /// Creates a plan with 0.6 rad from one waypoint to the next, anticlockwise; the first is 0.6 rad from the east.
    #[inline]
    pub fn new(height: Height<T>) -> Self {
        Self { height, advance: T::from_f64(0.6), angle: T::ZERO }
    }

    /// The waypoint `interval` (s) after the estimate.
    pub fn next(&mut self, estimate: &TrackEstimate<T>, interval: T) -> Waypoint<T> {
        let (height, least) = match self.height {
            Height::Fixed(height) => (height, height * T::from_f64(0.3)),
            Height::Between(low, high) => {
                let height = (estimate.spread * T::from_f64(3.5)).clamp(low, high);
                (height, height * T::from_f64(0.3))
            }
        };
        let radius = (estimate.spread * T::from_f64(core::f64::consts::FRAC_1_SQRT_2))
            .clamp(least, T::from_f64(1000.0));
        self.angle += self.advance;
        if self.angle > T::PI {
            self.angle -= T::PI + T::PI;
        }
        let (sine, cosine) = self.angle.sin_cos();
        let [x, y] = estimate.place;
        let [vx, vy] = estimate.velocity;
        let place = [x + vx * interval + radius * cosine, y + vy * interval + radius * sine];
        Waypoint { place, height }
    }
}
