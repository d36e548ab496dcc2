use kestirim_air_to_ground::{FreeSpace, Measurement};
use kestirim_scalar::Scalar;

use crate::level_step::health;
use crate::{Area, BeaconEstimate, Error, Health, Thinned};

/// Searches an area of up to N corners, over open ground, for a transmitter, from any number of measurements, of
/// which up to M are kept.
///
/// Combines [`Area`], [`Thinned`] and the posterior of [`Beacon`](crate::Beacon). 16·M + 8·N bytes in single
/// precision.
///
/// ```
/// use kestirim_air_to_ground::{FreeSpace, Measurement};
/// use kestirim_user_locator::{Area, BeaconSearch};
///
/// let area = Area::<f32, 8>::new(&[[0.0, 0.0], [400.0, 0.0], [400.0, 300.0]])?;
/// // Of the transmitter's level nothing is known.
/// let mut search = BeaconSearch::<f32, 40, 8>::new(FreeSpace::new(None), area);
/// for (place, level) in [([0.0, 0.0], -72.0), ([200.0, 0.0], -66.5), ([400.0, 0.0], -68.0)] {
///     search.measure(&Measurement::new(place, 40.0, -level)?);
/// }
/// let found = search.estimate::<500>()?;
/// println!("{:?} m, ± {} m", found.place, found.sigma());
/// # Ok::<(), kestirim_user_locator::Error>(())
/// ```
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: serde::Serialize",
        deserialize = "T: Scalar + serde::Deserialize<'de>"
    ))
)]
pub struct BeaconSearch<T, const M: usize, const N: usize> {
    channel: FreeSpace<T>,
    area: Area<T, N>,
    measurements: Thinned<Measurement<T>, M>,
}

impl<T: Scalar, const M: usize, const N: usize> BeaconSearch<T, M, N> {
    /// Creates a search in an area, before its first measurement.
    #[inline]
    pub fn new(channel: FreeSpace<T>, area: Area<T, N>) -> Self {
        const { assert!(M <= 128, "the channel reads no more") };
        Self { channel, area, measurements: Thinned::new() }
    }

    /// Adds a measurement, whose loss is the negative received level.
    #[inline]
    pub fn measure(&mut self, measurement: &Measurement<T>) {
        self.measurements.push(*measurement);
    }

    /// The measurements kept, in order.
    #[inline]
    pub fn measurements(&self) -> &[Measurement<T>] {
        self.measurements.as_slice()
    }

    /// The area in which the transmitter is searched.
    #[inline]
    pub fn area(&self) -> &Area<T, N> {
        &self.area
    }

    /// The posterior of the transmitter's place in the area, on a lattice of L points over its bounding box.
    ///
    /// # Errors
    /// [`Error::Filter`] with `Degenerate` if no point of the lattice lies inside and explains the measurements.
    pub fn estimate<const L: usize>(&self) -> Result<BeaconEstimate<T, L>, Error> {
        let inside = |place| self.area.contains(place);
        BeaconEstimate::of(self.channel, self.measurements(), self.area.region(), inside)
    }

    /// Whether a place belongs to the smallest region that contains the transmitter with this probability (0 to 1).
    /// The estimate must be from the same measurements.
    pub fn credible<const L: usize>(
        &self,
        estimate: &BeaconEstimate<T, L>,
        place: [T; 2],
        probability: T,
    ) -> bool {
        self.area.contains(place) && estimate.is_credible(self.measurements(), place, probability)
    }

    /// Whether an estimate from these measurements is reliable: reports `innovations` if their levels show a step
    /// ([`LevelStep`](crate::LevelStep)) as seen from the estimated place.
    pub fn health<const L: usize>(&self, estimate: &BeaconEstimate<T, L>) -> Health {
        health(self.measurements(), estimate.place)
    }
}
