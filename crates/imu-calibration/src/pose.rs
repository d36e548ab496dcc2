use crate::Error;
use heapless::Vec;
use kestirim_scalar::{Components, Scalar};
use nalgebra::SVector;

/// The mean measurements of a sensor at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: serde::Serialize",
        deserialize = "T: Scalar + serde::Deserialize<'de>"
    ))
)]
pub struct Pose<T: Scalar> {
    /// The mean of the accelerometer (m/s², sensor).
    pub specific_force: SVector<T, 3>,
    /// The mean of the gyroscope (rad/s, sensor).
    pub angular_rate: SVector<T, 3>,
    /// The number of samples in the means.
    pub samples: T,
}

impl<T: Scalar> Pose<T> {
    /// Creates a pose without samples.
    pub fn new() -> Self {
        Self { specific_force: SVector::zeros(), angular_rate: SVector::zeros(), samples: T::ZERO }
    }

    /// Adds a sample: specific force (m/s²) and angular rate (rad/s), as measured.
    ///
    /// # Errors
    /// [`Error::NotFinite`], or [`Error::Full`] where the number type cannot count further; nothing is changed.
    pub fn push(
        &mut self,
        specific_force: &SVector<T, 3>,
        angular_rate: &SVector<T, 3>,
    ) -> Result<(), Error> {
        let samples = self.samples + T::ONE;
        if !samples.is_finite() || samples <= self.samples {
            return Err(Error::Full);
        }
        let towards = |mean: &SVector<T, 3>, new: &SVector<T, 3>| {
            let by = samples.divisor();
            mean.zip_map(new, |mean, new| mean + (new - mean).divided_by(by))
        };
        let next = Self {
            specific_force: towards(&self.specific_force, specific_force),
            angular_rate: towards(&self.angular_rate, angular_rate),
            samples,
        };
        next.check()?;
        *self = next;
        Ok(())
    }

    fn check(&self) -> Result<(), Error> {
        let finite = T::all_finite(self.specific_force.as_array())
            && T::all_finite(self.angular_rate.as_array());
        if finite { Ok(()) } else { Err(Error::NotFinite) }
    }
}

impl<T: Scalar> Default for Pose<T> {
    fn default() -> Self {
        Self::new()
    }
}

/// One of the six sides on which a box can be put down.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Side {
    /// The vertical axis: 0 is x, 1 is y, 2 is z.
    pub axis: u8,
    /// Whether the axis points up, so that the accelerometer shows +g along it.
    pub is_up: bool,
}

/// The bias of a gyroscope, determined at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct GyroscopeBias<T: Scalar> {
    /// The bias (rad/s, sensor).
    pub bias: SVector<T, 3>,
    /// The standard deviation of each component (rad/s): that of the mean of the poses.
    pub sigma: [T; 3],
}

/// A collection of up to N static poses.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Poses<T: Scalar, const N: usize> {
    pub(crate) poses: Vec<Pose<T>, N>,
}

impl<T: Scalar, const N: usize> Poses<T, N> {
    /// A side counts as shown if its axis was within 30° of the vertical: the cosine of that angle.
    const UPRIGHT: f64 = 0.866;

    /// Creates an empty collection.
    pub fn new() -> Self {
        Self { poses: Vec::new() }
    }

    /// Adds a pose.
    ///
    /// # Errors
    /// [`Error::Empty`] for a pose without samples or without force, [`Error::NotFinite`], [`Error::Full`] beyond N;
    /// nothing is changed.
    pub fn add(&mut self, pose: Pose<T>) -> Result<(), Error> {
        pose.check()?;
        if pose.samples < T::ONE || crate::matrix::unit(pose.specific_force.as_array()).is_none() {
            return Err(Error::Empty);
        }
        self.poses.push(pose).map_err(|_| Error::Full)
    }

    /// The number of poses.
    pub fn count(&self) -> usize {
        self.poses.len()
    }

    /// The sides that no pose has shown yet, within 30°: what to do next. All six determine offset and scale.
    pub fn missing(&self) -> impl Iterator<Item = Side> + '_ {
        let sides = [(0, true), (0, false), (1, true), (1, false), (2, true), (2, false)];
        let sides = sides.map(|(axis, is_up)| Side { axis, is_up });
        sides.into_iter().filter(|side| !self.poses.iter().any(|pose| Self::shows(pose, *side)))
    }

    fn shows(pose: &Pose<T>, side: Side) -> bool {
        let Some([x, y, z]) = crate::matrix::unit(pose.specific_force.as_array()) else {
            return false;
        };
        let along = match side.axis {
            0 => x,
            1 => y,
            _ => z,
        };
        let along = if side.is_up { along } else { -along };
        along > T::from_f64(Self::UPRIGHT)
    }

    /// The gyroscope's bias, with its uncertainty from the differences between poses, which is at least that of
    /// `noise`, the standard deviation of a pose's mean (rad/s).
    ///
    /// # Errors
    /// [`Error::TooFew`] without a pose, [`Error::NotPositive`], [`Error::NotFinite`].
    pub fn gyroscope_bias(&self, noise: T) -> Result<GyroscopeBias<T>, Error> {
        if !(noise.is_finite() && noise > T::ZERO) {
            return Err(Error::NotPositive);
        }
        if self.poses.is_empty() {
            return Err(Error::TooFew { found: 0, needed: 1 });
        }
        let (mut count, mut bias, mut spread) = (T::ZERO, [T::ZERO; 3], [T::ZERO; 3]);
        for pose in &self.poses {
            count += T::ONE;
            let rate = *pose.angular_rate.as_array();
            for ((mean, spread), rate) in bias.iter_mut().zip(&mut spread).zip(rate) {
                // Welford's sums.
                let before = rate - *mean;
                *mean += before / count;
                *spread += before * (rate - *mean);
            }
        }
        let sigma = spread.map(|spread| {
            let one = crate::normal::noise(noise, spread, count, T::ONE);
            one / count.sqrt()
        });
        let finite = T::all_finite(&bias) && T::all_finite(&sigma);
        if !finite {
            return Err(Error::NotFinite);
        }
        Ok(GyroscopeBias { bias: SVector::from(bias), sigma })
    }
}

impl<T: Scalar, const N: usize> Default for Poses<T, N> {
    fn default() -> Self {
        Self::new()
    }
}
