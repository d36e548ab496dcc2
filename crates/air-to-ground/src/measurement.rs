use kestirim_scalar::Scalar;

use crate::Error;

/// A path loss measured from the air, checked for plausibility.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(
        try_from = "Unchecked<T>",
        bound(
            serialize = "T: serde::Serialize",
            deserialize = "T: Scalar + serde::Deserialize<'de>"
        )
    )
)]
pub struct Measurement<T> {
    place: [T; 2],
    height: T,
    loss: T,
}

/// A measurement as stored, not yet validated.
#[cfg(feature = "serde")]
#[derive(serde::Deserialize)]
struct Unchecked<T> {
    place: [T; 2],
    height: T,
    loss: T,
}

#[cfg(feature = "serde")]
impl<T: Scalar> TryFrom<Unchecked<T>> for Measurement<T> {
    type Error = Error;

    fn try_from(stored: Unchecked<T>) -> Result<Self, Error> {
        Self::new(stored.place, stored.height, stored.loss)
    }
}

impl<T: Scalar> Measurement<T> {
    /// Creates a measurement of a `loss` (dB) by a drone above `place` (m, in the plane of the user), at `height` (m)
    /// above the user.
    ///
    /// # Errors
    /// [`Error::NotFinite`]; [`Error::NotPositive`] for a height that is not positive; [`Error::ImplausibleLoss`]
    /// beyond ±300 dB (a level of unknown offset may be negative).
    #[inline]
    pub fn new(place: [T; 2], height: T, loss: T) -> Result<Self, Error> {
        if !T::all_finite(&[place[0], place[1], height, loss]) {
            return Err(Error::NotFinite);
        }
        if height <= T::ZERO {
            return Err(Error::NotPositive);
        }
        if loss.abs() > T::from_micro(300_000_000) {
            return Err(Error::ImplausibleLoss);
        }
        Ok(Self { place, height, loss })
    }

    /// Horizontal position of the drone, m.
    #[inline(always)]
    pub fn place(&self) -> [T; 2] {
        self.place
    }

    /// Height of the drone above the user, m.
    #[inline(always)]
    pub fn height(&self) -> T {
        self.height
    }

    /// Measured path loss, dB.
    #[inline(always)]
    pub fn loss(&self) -> T {
        self.loss
    }

    /// The measurement corrected for a transmitter that is weaker than assumed by `level` (dB).
    #[inline(always)]
    pub fn less(&self, level: T) -> Self {
        Self { loss: self.loss - level, ..*self }
    }

    /// Horizontal distance from the drone to a user, m.
    #[inline(always)]
    pub fn horizontal_distance(&self, user: [T; 2]) -> T {
        T::norm(&[user[0] - self.place[0], user[1] - self.place[1]])
    }
}
