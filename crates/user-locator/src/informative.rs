use heapless::Vec;
use kestirim_air_to_ground::{GroundFit, Supposition};
use kestirim_particle_filter::PointMass;
use kestirim_scalar::Scalar;

use crate::{Area, Waypoint};

/// Number of places that represent the posterior.
const STANDING: usize = 32;
/// Number of waypoints that are compared.
const WAYPOINTS: usize = 64;
/// Outer nodes (in standard deviations) and weights of the three-point Gauss-Hermite rule, for the levels that may be
/// measured.
const NODE: f64 = 1.732_050_807_568_877_2;
const WEIGHTS: [f64; 2] = [1.0 / 6.0, 2.0 / 3.0];
/// Limit of a level's deviation, in standard deviations: anything beyond is equally unlikely.
const FARTHEST: f64 = 100.0;

/// The waypoint at which one more measurement is expected to reduce the uncertainty of the transmitter's place most.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Informative<T> {
    /// The place to measure at.
    pub waypoint: Waypoint<T>,
    /// The expected ratio of the uncertainty after that measurement to that before: from 0 to 1, where 1 means no
    /// gain.
    pub left: T,
}

/// A place at which the transmitter may be, with the supposition and the fit that predict levels from it.
pub(crate) struct Standing<T> {
    pub(crate) place: [T; 2],
    pub(crate) supposition: Supposition<T>,
    pub(crate) fit: GroundFit<T>,
}

/// Places that represent a posterior, each an equal part of its weight.
pub(crate) fn standing<T: Scalar, const L: usize>(
    posterior: &PointMass<T, 2, L>,
    mut explained: impl FnMut([T; 2]) -> Option<(Supposition<T>, GroundFit<T>)>,
) -> Vec<Standing<T>, STANDING> {
    let mut all = Vec::new();
    let weights = || posterior.log_weights().iter().map(|log| log.exp());
    // The mean weight, so that the sum does not overflow in fixed point.
    let mut mean = T::ZERO;
    for (index, weight) in weights().enumerate() {
        mean += (weight - mean) / T::from_binary(index as i32 + 1, 0);
    }
    let stride =
        mean * T::from_binary(posterior.len() as i32, 0) / T::from_binary(STANDING as i32, 0);
    let mut left = stride * T::HALF;
    for (index, weight) in weights().enumerate() {
        left -= weight;
        while left < T::ZERO && !all.is_full() {
            left += stride;
            if let Some(place) = posterior.point(index)
                && let Some((supposition, fit)) = explained(place)
            {
                // The loop ends when it is full.
                let _ = all.push(Standing { place, supposition, fit });
            }
        }
    }
    all
}

/// Of waypoints all over an area, the one after whose measurement the smallest mean distance from the posterior's
/// mean is expected; `None` if no place represents the posterior, or no waypoint is inside.
pub(crate) fn most_informative<T: Scalar, const N: usize>(
    all: &[Standing<T>],
    area: &Area<T, N>,
    height: T,
) -> Option<Informative<T>> {
    let before = spread(all, &[T::ONE; STANDING]);
    if before <= T::ZERO {
        return None;
    }
    let lattice = PointMass::<T, 2, WAYPOINTS>::new(area.region());
    let mut best: Option<(T, [T; 2])> = None;
    for place in (0..WAYPOINTS).filter_map(|index| lattice.point(index)) {
        if !area.contains(place) {
            continue;
        }
        let after = after(all, place, height);
        if best.is_none_or(|(least, _)| after < least) {
            best = Some((after, place));
        }
    }
    let (after, place) = best?;
    Some(Informative { waypoint: Waypoint { place, height }, left: (after / before).min(T::ONE) })
}

/// The expected spread after a measurement from a waypoint: the mean over all levels that may be measured there.
fn after<T: Scalar>(all: &[Standing<T>], waypoint: [T; 2], height: T) -> T {
    let mut levels = Vec::<(T, T), STANDING>::new();
    for Standing { place, supposition, fit } in all {
        // It has the same capacity.
        let _ = levels.push(fit.expected(supposition, *place, waypoint, height));
    }
    // Constants one by one, so that no double-precision code reaches a target.
    let (node, outer, inner) =
        (T::from_f64(NODE), T::from_f64(WEIGHTS[0]), T::from_f64(WEIGHTS[1]));
    let mut sum = T::ZERO;
    for (level, sigma) in &levels {
        for (node, share) in [(-node, outer), (T::ZERO, inner), (node, outer)] {
            let measured = *level + node * *sigma;
            let mut weights = Vec::<T, STANDING>::new();
            for (level, sigma) in &levels {
                let off = ((measured - *level) / *sigma).abs().min(T::from_f64(FARTHEST));
                let _ = weights.push((-(off * off * T::HALF)).exp() / *sigma);
            }
            sum += share * spread(all, &weights);
        }
    }
    sum / T::from_binary(levels.len().max(1) as i32, 0)
}

/// Mean distance of weighted places from their mean.
fn spread<T: Scalar>(all: &[Standing<T>], weights: &[T]) -> T {
    let (mut total, mut mean) = (T::ZERO, [T::ZERO; 2]);
    let weighed = || all.iter().zip(weights).filter(|(_, weight)| **weight > T::ZERO);
    // Means step by step, since sums of places would overflow in fixed point.
    for (Standing { place, .. }, weight) in weighed() {
        total += *weight;
        for (mean, place) in mean.iter_mut().zip(place) {
            *mean += *weight / total * (*place - *mean);
        }
    }
    let (mut total, mut spread) = (T::ZERO, T::ZERO);
    for (Standing { place, .. }, weight) in weighed() {
        total += *weight;
        let distance = T::norm(&[place[0] - mean[0], place[1] - mean[1]]);
        spread += *weight / total * (distance - spread);
    }
    spread
}
