use core::cell::Cell;

use heapless::Vec;
use kestirim_air_to_ground::{
    GroundFit, Heading, Measurement, OpenGround, SUPPOSITIONS, Supposition,
};
use kestirim_particle_filter::{Error as FilterError, PointMass};
use kestirim_scalar::Scalar;

use crate::informative::{Informative, most_informative, standing};
use crate::level_step::health;
use crate::{Area, ByPlace, Error, Health};

/// The power of the likelihood that gives regions their coverage: shadowing is alike along some tens of metres, and a flight's
/// measurements are some ten to twenty metres apart.
const REGION_POWER: f64 = 0.8;
/// A supposition that is nowhere likelier than e⁻⁸ of the likeliest adds nothing.
const UNLIKELY: f64 = 8.0;
/// One in so many points of the lattice tells which suppositions these are.
const SCOUTS: usize = 4;
/// What weighs less than e⁻¹² of the heaviest point is outside of a finer lattice.
const DEPTH: f64 = 12.0;
/// A lattice whose weight is on fewer of its points than this part is laid anew.
const FEWEST: f64 = 0.1;

/// Searches an area of up to N corners, over open ground, for a transmitter of which nothing is known, from any number of
/// received levels, thinned by place to M: level, path-loss exponent, antennas, noise and the receiver's floor are
/// estimated or integrated over ([`OpenGround`]).
///
/// Dearer than [`BeaconSearch`](crate::BeaconSearch), which believes free space: on a computer an estimate takes some
/// tenths of a second. 36·M + 8·N bytes in single precision.
///
/// ```
/// use kestirim_air_to_ground::{Measurement, OpenGround};
/// use kestirim_user_locator::{Area, GroundSearch};
///
/// let area = Area::<f32, 8>::new(&[[0.0, 0.0], [400.0, 0.0], [400.0, 300.0]])?;
/// let mut search = GroundSearch::<f32, 40, 8>::new(OpenGround::new(None), area);
/// for (place, level) in [([0.0, 0.0], -72.0), ([200.0, 0.0], -66.5), ([400.0, 0.0], -68.0)] {
///     search.measure(&Measurement::new(place, 40.0, -level)?);
/// }
/// let found = search.estimate::<200>()?;
/// println!("{:?} m, ± {} m, exponent {}", found.place, found.sigma, found.fit.exponent);
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
pub struct GroundSearch<T, const M: usize, const N: usize> {
    channel: OpenGround<T>,
    area: Area<T, N>,
    measurements: ByPlace<T, M>,
}

/// Estimate of a [`GroundSearch`].
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: serde::Serialize",
        deserialize = "T: Scalar + serde::Deserialize<'de>"
    ))
)]
pub struct GroundEstimate<T, const L: usize> {
    /// The place, m: the mean of the posterior that takes measurements for independent.
    pub place: [T; 2],
    /// Root mean square distance of the transmitter from it, by the other posterior, m.
    pub sigma: T,
    /// The likeliest of what is supposed of antennas, receiver and noise, at the likeliest place.
    pub supposition: Supposition<T>,
    /// Level and exponent there.
    pub fit: GroundFit<T>,
    /// The posterior that allows for correlated shadowing: regions, and the uncertainty of the place.
    pub posterior: PointMass<T, 2, L>,
    /// All that is likely enough.
    likely: Vec<Supposition<T>, SUPPOSITIONS>,
}

/// What a posterior is computed from.
struct Evidence<'a, T, const N: usize> {
    channel: OpenGround<T>,
    area: &'a Area<T, N>,
    measurements: &'a [Measurement<T>],
    headings: &'a [Heading<T>],
    power: T,
}

impl<T: Scalar, const M: usize, const N: usize> GroundSearch<T, M, N> {
    /// A search in an area before its first measurement.
    #[inline]
    pub fn new(channel: OpenGround<T>, area: Area<T, N>) -> Self {
        const { assert!(M <= 128, "the channel reads no more") };
        Self { channel, area, measurements: ByPlace::new() }
    }

    /// Takes in a measurement, of which the loss is the negative received level.
    #[inline]
    pub fn measure(&mut self, measurement: &Measurement<T>) {
        self.measure_with_heading(measurement, &Heading::unknown());
    }

    /// Takes in a measurement with the drone's heading: what an antenna that turns with the drone does to levels is then
    /// estimated, too, and is no error of the place.
    #[inline]
    pub fn measure_with_heading(&mut self, measurement: &Measurement<T>, heading: &Heading<T>) {
        self.measurements.push(measurement, heading);
    }

    /// The measurements by place.
    #[inline]
    pub fn measurements(&self) -> &[Measurement<T>] {
        self.measurements.as_slice()
    }

    /// Area in which the transmitter is searched.
    #[inline]
    pub fn area(&self) -> &Area<T, N> {
        &self.area
    }

    fn evidence(&self, power: T) -> Evidence<'_, T, N> {
        Evidence {
            channel: self.channel,
            area: &self.area,
            measurements: self.measurements(),
            headings: self.measurements.headings(),
            power,
        }
    }

    /// Posterior of the transmitter in the area, on a lattice of L points over its bounding box.
    ///
    /// # Errors
    /// [`Error::Filter`] with `Degenerate` if no point of the lattice lies inside and explains the measurements.
    pub fn estimate<const L: usize>(&self) -> Result<GroundEstimate<T, L>, Error> {
        let sharp = self.evidence(T::ONE);
        let likely = sharp.likely::<L>()?;
        let posterior = sharp.posterior::<L>(&likely)?;
        let place = posterior.moments().mean();
        let heaviest = posterior.point(posterior.heaviest()).unwrap_or(place);
        let (supposition, fit) = sharp.best(&likely, heaviest).ok_or(FilterError::Degenerate)?;
        let posterior = self.evidence(T::from_f64(REGION_POWER)).posterior::<L>(&likely)?;
        let moments = posterior.moments();
        let [x, y] = moments.mean();
        // About the place that is told, which is not quite its mean.
        let sigma = T::norm(&[moments.spread(), x - place[0], y - place[1]]);
        Ok(GroundEstimate { place, sigma, supposition, fit, posterior, likely })
    }

    /// Whether a place belongs to the smallest region that holds the transmitter with this probability (0 to 1). The
    /// estimate must be that of the same measurements.
    pub fn credible<const L: usize>(
        &self,
        estimate: &GroundEstimate<T, L>,
        place: [T; 2],
        probability: T,
    ) -> bool {
        let evidence = self.evidence(T::from_f64(REGION_POWER));
        let posterior = &estimate.posterior;
        let Some(heaviest) = posterior.point(posterior.heaviest()) else { return false };
        let density = |place| evidence.log_likelihood(&estimate.likely, place, |_, _| ());
        self.area.contains(place)
            && density(place) - density(heaviest) >= posterior.density_level(probability)
    }

    /// Where in the area to measure next, so high (m) above the transmitter; none if nothing is left to be learned. The
    /// estimate must be that of the same measurements.
    ///
    /// Of 64 waypoints all over the area that one after which the transmitter's place is expected to be known best: the mean
    /// over all levels that may be measured there, from 32 places that stand for the posterior (Lindley, *On a measure of the information
    /// provided by an experiment*, 1956, with the spread in the place of the entropy). Costs some hundred thousand exponentials.
    pub fn next_waypoint<const L: usize>(
        &self,
        estimate: &GroundEstimate<T, L>,
        height: T,
    ) -> Option<Informative<T>> {
        let evidence = self.evidence(T::from_f64(REGION_POWER));
        let explained = |place| evidence.best(&estimate.likely, place);
        most_informative(&standing(&estimate.posterior, explained), &self.area, height)
    }

    /// Whether an estimate from these measurements can be relied upon: `innovations` where their levels step
    /// ([`LevelStep`](crate::LevelStep)), seen from its place.
    pub fn health<const L: usize>(&self, estimate: &GroundEstimate<T, L>) -> Health {
        health(self.measurements(), estimate.place)
    }
}

impl<T: Scalar, const N: usize> Evidence<'_, T, N> {
    fn log_likelihood(
        &self,
        suppositions: &[Supposition<T>],
        place: [T; 2],
        told: impl FnMut(usize, T),
    ) -> T {
        if self.area.contains(place) {
            let Self { channel, measurements, headings, power, .. } = self;
            channel.log_likelihood(measurements, headings, place, *power, suppositions, told)
        } else {
            T::ZERO.ln()
        }
    }

    /// The suppositions that are likely enough anywhere, seen from a coarse lattice.
    fn likely<const L: usize>(&self) -> Result<Vec<Supposition<T>, SUPPOSITIONS>, FilterError> {
        let mut all = Vec::<_, SUPPOSITIONS>::new();
        for supposition in self.channel.suppositions(self.measurements, self.headings) {
            // There is room for all.
            let _ = all.push(supposition);
        }
        let best = Cell::new([T::ZERO.ln(); SUPPOSITIONS]);
        let count = (L / SCOUTS).max(1);
        let mut scouts = PointMass::<T, 2, L>::with_count(count, self.area.region())?;
        // Nothing is known if none of so few lies inside.
        let _ = scouts.update(|place| {
            self.log_likelihood(&all, place, |index, log| {
                let mut logs = best.get();
                if let Some(most) = logs.get_mut(index) {
                    *most = most.max(log);
                }
                best.set(logs);
            })
        });
        let best = best.get();
        let most = best.into_iter().fold(T::ZERO.ln(), T::max);
        let mut likely = Vec::new();
        for (supposition, log) in all.iter().zip(best) {
            if log >= most - T::from_f64(UNLIKELY) {
                // There is room for all.
                let _ = likely.push(*supposition);
            }
        }
        Ok(likely)
    }

    /// On a lattice that is laid anew where the weight is, until it is as fine as the posterior.
    fn posterior<const L: usize>(
        &self,
        suppositions: &[Supposition<T>],
    ) -> Result<PointMass<T, 2, L>, FilterError> {
        let weigh = |place| self.log_likelihood(suppositions, place, |_, _| ());
        let mut posterior = PointMass::<T, 2, L>::new(self.area.region());
        posterior.update(weigh)?;
        let fewest = T::from_binary(L as i32, 0) * T::from_f64(FEWEST);
        while posterior.effective() <= fewest {
            let Some(mut finer) = posterior.finer(T::from_f64(DEPTH)) else { break };
            finer.update(weigh)?;
            posterior = finer;
        }
        Ok(posterior)
    }

    /// The likeliest supposition at a place.
    fn best(
        &self,
        suppositions: &[Supposition<T>],
        place: [T; 2],
    ) -> Option<(Supposition<T>, GroundFit<T>)> {
        let mut best: Option<(Supposition<T>, GroundFit<T>)> = None;
        for supposition in suppositions {
            let Self { measurements, headings, power, .. } = *self;
            let fit = self.channel.fit(measurements, headings, place, supposition, power);
            let log = |(supposition, fit): &(Supposition<T>, GroundFit<T>)| {
                fit.log_evidence + supposition.log_prior
            };
            let found = (*supposition, fit);
            if best.as_ref().is_none_or(|best| log(&found) > log(best)) {
                best = Some(found);
            }
        }
        best
    }
}
