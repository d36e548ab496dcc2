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

/// The power to which the likelihood is raised so that regions have their nominal coverage: shadowing is correlated
/// over some tens of metres, and a flight's measurements are some ten to twenty metres apart.
const REGION_POWER: f64 = 0.8;
/// Suppositions whose largest log-likelihood is this far below the best one's are dropped.
const UNLIKELY: f64 = 8.0;
/// The fraction of the lattice's points (one in this many) with which likely suppositions are selected.
const SCOUTS: usize = 4;
/// Points whose log-weight is this far below the heaviest one's lie outside of a finer lattice.
const DEPTH: f64 = 12.0;
/// A lattice is refined when its effective number of points is at most this fraction of them.
const FEWEST: f64 = 0.1;

/// Searches an area of up to N corners, over open ground, for a transmitter of which nothing is known.
///
/// It takes any number of received levels, thinned by place to M: level, path-loss exponent, antennas, noise and the
/// receiver's floor are estimated or integrated over ([`OpenGround`]).
///
/// More expensive than [`BeaconSearch`](crate::BeaconSearch), which assumes free space: on a computer an estimate
/// takes some tenths of a second. 36·M + 8·N bytes in single precision.
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

/// The estimate of a [`GroundSearch`].
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
    /// The estimated place, m: the mean of the posterior that treats measurements as independent.
    pub place: [T; 2],
    /// Root mean square distance of the transmitter from `place`, by the posterior that allows for correlation, m.
    pub sigma: T,
    /// The likeliest supposition on antennas, receiver and noise, at the likeliest place.
    pub supposition: Supposition<T>,
    /// The fitted level and exponent at the likeliest place.
    pub fit: GroundFit<T>,
    /// The posterior that allows for correlated shadowing, for regions and for the uncertainty of the place.
    pub posterior: PointMass<T, 2, L>,
    /// All suppositions that are likely enough.
    likely: Vec<Supposition<T>, SUPPOSITIONS>,
}

/// The data from which a posterior is computed.
struct Evidence<'a, T, const N: usize> {
    channel: OpenGround<T>,
    area: &'a Area<T, N>,
    measurements: &'a [Measurement<T>],
    headings: &'a [Heading<T>],
    power: T,
}

impl<T: Scalar, const M: usize, const N: usize> GroundSearch<T, M, N> {
    /// Creates a search in an area, before its first measurement.
    #[inline]
    pub fn new(channel: OpenGround<T>, area: Area<T, N>) -> Self {
        const { assert!(M <= 128, "the channel reads no more") };
        Self { channel, area, measurements: ByPlace::new() }
    }

    /// Adds a measurement, whose loss is the negative received level.
    #[inline]
    pub fn measure(&mut self, measurement: &Measurement<T>) {
        self.measure_with_heading(measurement, &Heading::unknown());
    }

    /// Adds a measurement with the drone's heading: the effect on levels of an antenna that turns with the drone is
    /// then estimated, too, instead of causing an error of the place.
    #[inline]
    pub fn measure_with_heading(&mut self, measurement: &Measurement<T>, heading: &Heading<T>) {
        self.measurements.push(measurement, heading);
    }

    /// The measurements, merged by place.
    #[inline]
    pub fn measurements(&self) -> &[Measurement<T>] {
        self.measurements.as_slice()
    }

    /// The area in which the transmitter is searched.
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

    /// The posterior of the transmitter's place in the area, on a lattice of L points over its bounding box.
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
        // The deviation from the reported place, which is not quite this posterior's mean.
        let sigma = T::norm(&[moments.spread(), x - place[0], y - place[1]]);
        Ok(GroundEstimate { place, sigma, supposition, fit, posterior, likely })
    }

    /// Whether a place belongs to the smallest region that contains the transmitter with this probability (0 to 1).
    /// The estimate must be from the same measurements.
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

    /// The place in the area at which to measure next, at `height` (m) above the transmitter; `None` if nothing
    /// remains to be learned. The estimate must be from the same measurements.
    ///
    /// Of 64 waypoints all over the area, it is the one after which the smallest uncertainty of the transmitter's
    /// place is expected: the mean over all levels that may be measured there, from 32 places that represent the
    /// posterior (Lindley, *On a measure of the information provided by an experiment*, 1956, with the spread in
    /// place of the entropy). Costs some hundred thousand exponentials.
    pub fn next_waypoint<const L: usize>(
        &self,
        estimate: &GroundEstimate<T, L>,
        height: T,
    ) -> Option<Informative<T>> {
        let evidence = self.evidence(T::from_f64(REGION_POWER));
        let explained = |place| evidence.best(&estimate.likely, place);
        most_informative(&standing(&estimate.posterior, explained), &self.area, height)
    }

    /// Whether an estimate from these measurements is reliable: reports `innovations` if their levels show a step
    /// ([`LevelStep`](crate::LevelStep)) as seen from the estimated place.
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

    /// The suppositions that are likely enough at any place, judged on a coarse lattice.
    fn likely<const L: usize>(&self) -> Result<Vec<Supposition<T>, SUPPOSITIONS>, FilterError> {
        let mut all = Vec::<_, SUPPOSITIONS>::new();
        for supposition in self.channel.suppositions(self.measurements, self.headings) {
            // There is room for all.
            let _ = all.push(supposition);
        }
        let best = Cell::new([T::ZERO.ln(); SUPPOSITIONS]);
        let count = (L / SCOUTS).max(1);
        let mut scouts = PointMass::<T, 2, L>::with_count(count, self.area.region())?;
        // Nothing is learned if none of these few points lies inside.
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

    /// The posterior on a lattice that is refined where the weight is, until it resolves the posterior.
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
