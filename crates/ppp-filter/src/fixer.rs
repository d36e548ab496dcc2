//! Integer ambiguity resolution beside the filter, which keeps its own float ambiguities.

mod held;
mod pairs;
mod phase_bias;
mod wide_lane;

use heapless::Vec;
use kestirim_gnss_ppp::Geodetic;
use kestirim_kalman::Gaussian;
use kestirim_scalar::Components;
use nalgebra::{Matrix3, Vector3};

use self::held::Held;
use self::pairs::{Pair, search};
pub use self::phase_bias::PhaseBias;
use self::wide_lane::{Candidate, WideLane};
use crate::running::Running;
use crate::{Health, PppFilter, SatelliteObservation, Solution};

/// The elevation mask of ambiguity resolution, rad (15°): weather and antennas leave errors of up to half a cycle at
/// lower elevations.
const ELEVATION_MASK: f64 = 0.262;
/// Observations of less weight are ignored.
const LEAST_WEIGHT: f64 = 0.5;
/// The minimum number of held pairs for a solution.
const FEWEST_HELD: usize = 5;
/// The held integers are dropped if the mean square of their misfit, in reported variances, exceeds this.
const LARGEST_HELD_MISFIT: f64 = 2.0;
/// The variance with which integer ambiguities are applied, m².
const WHOLE: f64 = 1e-6;

/// A position with integer ambiguities.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct FixedSolution {
    /// The position of the marker, ECEF, m.
    pub position: Vector3<f64>,
    /// The covariance of the position in east, north, up, m², if the integers are right.
    pub covariance_enu: Matrix3<f64>,
    /// The number of between-satellite ambiguities that are fixed to integers.
    pub fixed: usize,
    /// The ratio test of the integers found last: the squared distance of the second nearest divided by that of the
    /// nearest.
    pub ratio: f64,
    /// The success rate of the integers found last: their probability if the filter's covariance is true.
    pub success_rate: f64,
}

/// Resolves integer ambiguities between satellites (PPP-AR).
///
/// Wide lanes come from averaged codes and phases, then narrow lanes by LAMBDA, partially, tested, and held while their
/// phases are continuous. The filter is only read.
///
/// It must see every epoch of one filter. With GPS and Galileo it fixes some ambiguities after ten minutes; with one
/// system alone hardly ever enough.
#[derive(Clone, Debug)]
pub struct AmbiguityFixer<const N: usize> {
    /// The wide lanes, indexed by the state of their satellite's ambiguity.
    wide_lanes: [Option<WideLane>; N],
    held: Held<N>,
}

impl<const N: usize> Default for AmbiguityFixer<N> {
    fn default() -> Self {
        Self::new()
    }
}

impl<const N: usize> AmbiguityFixer<N> {
    /// Creates a fixer that awaits its first epoch.
    pub const fn new() -> Self {
        Self { wide_lanes: [None; N], held: Held::NONE }
    }

    /// The position with integer ambiguities after the filter processed `observations` and returned `solution`; `None`
    /// while they are not determined well enough.
    ///
    /// `bias` gives the phase bias of a satellite by its number, if known. The receiver's antenna must be calibrated.
    pub fn fix<R>(
        &mut self,
        filter: &PppFilter<N, R>,
        solution: &Solution<N>,
        observations: &[SatelliteObservation<'_>],
        bias: impl Fn(u8) -> Option<PhaseBias>,
    ) -> Option<FixedSolution> {
        let running = filter.running.as_ref()?;
        let candidates = self.follow(running, filter, solution, observations, bias);
        if matches!(solution.health, Health::Contradicted(_)) {
            self.held = Held::NONE;
            return None;
        }
        let whole = wide_lane::whole(&candidates);
        if let Some(found) = search(&running.estimate, &whole, self.held.validation.is_some()) {
            self.held.take(&found);
        }
        let validation = self.held.validation?;
        let pairs = self.held.pairs(&whole);
        if pairs.len() < FEWEST_HELD {
            return None;
        }
        let repetition = running.repetition(filter.config());
        let mut doubted = running.estimate;
        doubted.covariance.scale(repetition);
        let misfit = constrain(&mut doubted, &pairs, Pair::model_variance())?;
        if misfit > LARGEST_HELD_MISFIT {
            self.held = Held::NONE;
            return None;
        }
        let mut estimate = running.estimate;
        constrain(&mut estimate, &pairs, WHOLE)?;
        let formal = Matrix3::from_fn(|i, j| estimate.covariance.get(i, j).unwrap_or(0.0));
        let of = |axis: usize| estimate.mean.as_array().get(axis).copied().unwrap_or(0.0);
        let position = Vector3::new(of(0), of(1), of(2));
        let rotation = Geodetic::from_ecef(&position).enu_from_ecef();
        Some(FixedSolution {
            position,
            covariance_enu: rotation * (formal * repetition) * rotation.transpose(),
            fixed: pairs.len(),
            ratio: validation.ratio,
            success_rate: validation.success_rate,
        })
    }

    /// Averages wide lanes, and returns the satellites whose wide lanes are known.
    fn follow(
        &mut self,
        running: &Running<N>,
        filter: &PppFilter<N, impl Sized>,
        solution: &Solution<N>,
        observations: &[SatelliteObservation<'_>],
        bias: impl Fn(u8) -> Option<PhaseBias>,
    ) -> Vec<Candidate, N> {
        let interval = running.interval.unwrap_or(1.0);
        let mut candidates = Vec::new();
        for report in &solution.satellites {
            let satellite = report.satellite;
            let observed = observations.iter().find(|it| it.satellite == satellite);
            let (Some(observed), Some(state)) = (observed, running.find(satellite)) else {
                continue;
            };
            let Some(place) = self.wide_lanes.get_mut(state) else { continue };
            let known = place.filter(|it| it.satellite == satellite && report.slipped.is_none());
            if known.is_none() {
                self.held.release(state);
            }
            let mut wide_lane = known.unwrap_or(WideLane::new(satellite));
            *place = Some(wide_lane);
            let carriers = observed.carriers;
            let Some(bias) = bias(satellite) else { continue };
            if report.code.weight > LEAST_WEIGHT {
                let phase = running.repaired(observed);
                let cycles = carriers.melbourne_wuebbena(phase, observed.code) + bias.wide_lane;
                let (sine, _) = libm::sincos(report.direction.elevation);
                wide_lane.take(cycles, wide_lane::variance(filter.config(), carriers, sine));
            }
            *place = Some(wide_lane);
            let elevation = report.direction.elevation;
            if report.phase.weight < LEAST_WEIGHT || elevation < ELEVATION_MASK {
                continue;
            }
            let Some([wide, sigma]) = wide_lane.known(interval) else { continue };
            let bias = bias.ionosphere_free;
            let _ = candidates.push(Candidate {
                satellite,
                state,
                carriers,
                elevation,
                bias,
                wide,
                sigma,
            });
        }
        candidates
    }
}

/// Applies integer ambiguities to an estimate. Returns the mean square of their innovations, in variances; `None` if a
/// number is not finite.
fn constrain<const N: usize>(
    estimate: &mut Gaussian<f64, N>,
    pairs: &Vec<(Pair, i64), N>,
    variance: f64,
) -> Option<f64> {
    let mut sum = 0.0;
    for (pair, integer) in pairs {
        let off = pair.length(*integer as f64) - pair.found(estimate);
        sum += estimate.update(&pair.row(), off, variance).ok()?.nis;
    }
    Some(sum / pairs.len() as f64)
}
