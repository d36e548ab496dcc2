//! The other place that the ranges of too few anchors allow: behind the line through two, or the plane through three.

use crate::Config;
use crate::link::Link;
use kestirim_kalman::Gaussian;
use kestirim_scalar::{Components, Scalar};
use kestirim_uwb_ranging::expected_range;
use nalgebra::SVector;

/// So many standard deviations from the line, a tag may have crossed it or turned back.
const REACH: f64 = 3.0;
/// By so many standard deviations a range must fit one of both places better.
const CLEAR: f64 = 3.0;

/// Anchors in whose line, or plane, a tag was seen by them alone: on which side of it the tag is now is not known. Their
/// numbers.
pub(crate) type Mirror<const D: usize> = SVector<u16, D>;

/// The anchors heard, if they are as many as coordinates, and the tag may be in their line.
///
/// Beside the line by d, a range of length r is longer than from the line by d²/(2 r) alone, so that the reach is √(2 r σ) for
/// ranges, and the position's own.
pub(crate) fn reached<T: Scalar, const D: usize, const N: usize>(
    estimate: &Gaussian<T, N>,
    config: &Config<T>,
    links: &[Link<T>],
    heard: impl Iterator<Item = usize>,
) -> Option<Mirror<D>> {
    let mut mirror = Mirror::<D>::zeros();
    let mut count = 0;
    for anchor in heard {
        *mirror.as_array_mut().get_mut(count)? = u16::try_from(anchor).ok()?;
        count += 1;
    }
    if count < D {
        return None;
    }
    let position = SVector::<T, D>::from_fn(|axis, _| estimate.mean.as_array()[axis]);
    let beside = beside(&mirror, links, &position)?;
    let distance = T::norm(beside.as_array());
    let mut far = T::ZERO;
    for &anchor in &mirror {
        let place = &links.get(usize::from(anchor))?.anchor.position;
        far = far.max(expected_range(&position, config.height, place).distance);
    }
    let excess = config.range_sigma.hypot(config.bias_sigma) * T::from_f64(REACH);
    let reach = (far + far).sqrt() * excess.sqrt();
    let is_near = distance <= reach || {
        let sigma = sigma(estimate, &beside.as_array().map(|it| it / distance))?;
        distance <= sigma * T::from_f64(REACH)
    };
    is_near.then_some(mirror)
}

/// Standard deviation of the position in a direction, m.
fn sigma<T: Scalar, const D: usize, const N: usize>(
    estimate: &Gaussian<T, N>,
    direction: &[T; D],
) -> Option<T> {
    let mut variance = T::ZERO;
    for (row, &one) in direction.iter().enumerate() {
        for (column, &other) in direction.iter().enumerate() {
            variance += one * estimate.covariance.get(row, column)? * other;
        }
    }
    Some(variance.max(T::ZERO).sqrt())
}

/// From the place behind the line, or plane, to this one, m; none where the anchors make none.
pub(crate) fn across<T: Scalar, const D: usize>(
    mirror: &Mirror<D>,
    links: &[Link<T>],
    position: &SVector<T, D>,
) -> Option<SVector<T, D>> {
    let beside = beside(mirror, links, position)?;
    Some(beside + beside)
}

/// Whether a range that left this innovation (m, with its variance) tells that the tag is not at the other place.
pub(crate) fn tells<T: Scalar, const D: usize>(
    across: &SVector<T, D>,
    (position, height): (&SVector<T, D>, T),
    anchor: &SVector<T, 3>,
    (innovation, variance): (T, T),
) -> bool {
    let distance = |place: &SVector<T, D>| expected_range(place, height, anchor).distance;
    let there = innovation + distance(position) - distance(&(position - across));
    there.abs() - innovation.abs() > variance.sqrt() * T::from_f64(CLEAR)
}

/// From the nearest point of the line, or plane, to a place, m.
fn beside<T: Scalar, const D: usize>(
    mirror: &Mirror<D>,
    links: &[Link<T>],
    position: &SVector<T, D>,
) -> Option<SVector<T, D>> {
    let place = |anchor: u16| {
        let place = links.get(usize::from(anchor))?.anchor.position;
        Some(SVector::<T, D>::from_fn(|axis, _| place.as_array()[axis]))
    };
    let mut anchors = mirror.iter();
    let first = place(*anchors.next()?)?;
    let mut beside = position - first;
    let mut along = [SVector::<T, D>::zeros(); D];
    for (count, &anchor) in anchors.enumerate() {
        let mut side = place(anchor)? - first;
        let length = T::norm(side.as_array());
        for known in along.get(..count)? {
            remove(&mut side, known);
        }
        let rest = T::norm(side.as_array());
        // They stand above each other, or in a line.
        if rest <= length * T::from_f64(0.05) {
            return None;
        }
        side.as_array_mut().iter_mut().for_each(|it| *it /= rest);
        remove(&mut beside, &side);
        *along.get_mut(count)? = side;
    }
    Some(beside)
}

/// Takes away what of a vector is along a unit vector.
fn remove<T: Scalar, const D: usize>(from: &mut SVector<T, D>, unit: &SVector<T, D>) {
    let along = T::dot(from.as_array(), unit.as_array());
    for (one, other) in from.iter_mut().zip(unit) {
        *one -= along * *other;
    }
}
