use kestirim_scalar::Scalar;

use crate::TrackEstimate;

/// How high to fly.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Height<T> {
    /// Always so high, m.
    Fixed(T),
    /// Five times the deviation of a coordinate, between these two, m: high to find a user, low to see where they are. A loss tells
    /// a distance best from a third of the height beside the user, and the better the lower.
    Between(T, T),
}

/// Where to measure next.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Waypoint<T> {
    /// Place, m.
    pub place: [T; 2],
    /// Height, m.
    pub height: T,
}

/// Circles about where the user will be.
///
/// Right above the user a loss does not change with the direction in which they go; the thesis' drone, which
/// flies there, is blind. The circle is as wide as the estimate is uncertain.
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
    /// Beginning in the east, 0.6 rad at a time.
    #[inline]
    pub fn new(height: Height<T>) -> Self {
        Self { height, advance: T::from_f64(0.6), angle: T::ZERO }
    }

    /// Where to be `interval` (s) after the estimate.
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
