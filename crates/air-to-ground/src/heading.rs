use kestirim_scalar::Scalar;

use crate::Error;

/// The heading of the drone at a measurement, as far as it is known.
///
/// Stored as mean cosines and sines of the heading and of twice the heading, so that several headings can be averaged:
/// the mean gives the average effect of a pattern of degree 2 that turns with the drone.
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
pub struct Heading<T> {
    means: [T; 4],
}

/// A heading as stored, not yet validated.
#[cfg(feature = "serde")]
#[derive(serde::Deserialize)]
struct Unchecked<T> {
    means: [T; 4],
}

#[cfg(feature = "serde")]
impl<T: Scalar> TryFrom<Unchecked<T>> for Heading<T> {
    type Error = Error;

    fn try_from(stored: Unchecked<T>) -> Result<Self, Error> {
        if !T::all_finite(&stored.means) {
            return Err(Error::NotFinite);
        }
        Ok(Self { means: stored.means.map(|mean| mean.clamp(-T::ONE, T::ONE)) })
    }
}

impl<T: Scalar> Heading<T> {
    /// Creates a heading (rad), clockwise from north, the second axis of the plane, to east, the first one.
    ///
    /// # Errors
    /// [`Error::NotFinite`].
    #[inline]
    pub fn new(heading: T) -> Result<Self, Error> {
        if !heading.is_finite() {
            return Err(Error::NotFinite);
        }
        let (sine, cosine) = heading.sin_cos();
        let twice = [cosine * cosine - sine * sine, (sine + sine) * cosine];
        Ok(Self { means: [cosine, sine, twice[0], twice[1]] })
    }

    /// An unknown heading, for which all directions are equally likely.
    #[inline]
    pub fn unknown() -> Self {
        Self { means: [T::ZERO; 4] }
    }

    /// Whether anything is known of the heading.
    #[inline]
    pub fn is_known(&self) -> bool {
        self.means.iter().any(|mean| *mean != T::ZERO)
    }

    /// The weighted mean of two headings; `share` (0 to 1) is the weight of `other`.
    #[inline]
    #[must_use]
    pub fn mean(&self, other: &Self, share: T) -> Self {
        let mut means = self.means;
        for (mean, other) in means.iter_mut().zip(&other.means) {
            *mean += share * (*other - *mean);
        }
        Self { means }
    }

    /// Length of the mean of the headings' unit vectors: 1 if all headings agree.
    pub(crate) fn length(&self) -> T {
        let [cosine, sine, ..] = self.means;
        T::norm(&[cosine, sine])
    }

    /// Rotates a horizontal vector from (east, north) to the drone's (forward, right).
    pub(crate) fn turned(&self, [east, north]: [T; 2]) -> [T; 2] {
        let [cosine, sine, ..] = self.means;
        [east * sine + north * cosine, east * cosine - north * sine]
    }

    /// Rotates the pair (x·y, (x² − y²) / 2) from x, y = east, north to the drone's x, y = forward, right.
    pub(crate) fn turned_twice(&self, [product, difference]: [T; 2]) -> [T; 2] {
        let [.., cosine, sine] = self.means;
        [product * cosine + difference * sine, product * sine - difference * cosine]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use kestirim_scalar::Q16_16;

    fn check<T: Scalar>() {
        for degrees in [-170.0_f64, -90.0, 0.0, 30.0, 77.0, 180.0, 315.0] {
            let radians = degrees.to_radians();
            let heading = Heading::new(T::from_f64(radians)).expect("finite");
            let (sine, cosine) = radians.sin_cos();
            let [east, north] = [0.6, -0.3];
            let expected = [east * sine + north * cosine, east * cosine - north * sine];
            let seen = heading.turned([east, north].map(T::from_f64)).map(T::to_f64);
            let [forward, right] = expected;
            let pair = [east * north, (east * east - north * north) / 2.0].map(T::from_f64);
            let seen_twice = heading.turned_twice(pair).map(T::to_f64);
            let twice = [forward * right, (forward * forward - right * right) / 2.0];
            for (seen, expected) in seen.iter().zip(expected).chain(seen_twice.iter().zip(twice)) {
                assert!((seen - expected).abs() < 5e-4, "{degrees}: {seen} {expected}");
            }
            assert!(heading.is_known());
            // Fore and aft averaged: the gain of a pattern of degree 2 is the same both ways, that of one of degree 1
            // averages to zero.
            let back = Heading::new(T::from_f64(radians - core::f64::consts::PI)).expect("finite");
            let both = heading.mean(&back, T::HALF);
            let first = both.turned([east, north].map(T::from_f64)).map(T::to_f64);
            assert!(first.iter().all(|it| it.abs() < 1e-3), "{both:?}");
            for (seen, expected) in both.turned_twice(pair).iter().zip(twice) {
                assert!((seen.to_f64() - expected).abs() < 1e-3, "{degrees}: {both:?}");
            }
        }
        assert!(!Heading::<T>::unknown().is_known());
        let known = Heading::new(T::ONE).expect("finite");
        assert_eq!(known.mean(&Heading::unknown(), T::ZERO), known);
        assert!(!known.mean(&Heading::unknown(), T::ONE).is_known());
    }

    #[test]
    fn a_vector_turns_with_the_drone_and_headings_have_a_mean() {
        check::<f32>();
        check::<f64>();
        check::<Q16_16>();
        assert_eq!(Heading::new(f64::NAN), Err(Error::NotFinite));
        assert_eq!(Heading::new(f32::INFINITY), Err(Error::NotFinite));
    }
}
