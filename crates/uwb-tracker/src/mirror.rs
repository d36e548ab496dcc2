//! The other place that the ranges of too few anchors allow: behind the line through two, or the plane through three; and those of
//! all, if all are in one line or plane.

use crate::Config;
use crate::link::Link;
use kestirim_kalman::Gaussian;
use kestirim_scalar::{Components, Scalar};
use kestirim_uwb_ranging::expected_range;
use nalgebra::SVector;

/// So many standard deviations from the line, a tag may have crossed it or turned back.
const REACH: f64 = 3.0;
/// By so many standard deviations a range must fit the place better than the other one.
const CLEAR: f64 = 3.0;
/// Anchors that are nearer to each other in the plane stand above each other, m.
const NEAREST: f64 = 0.05;
/// Anchors that are no farther from a line, or plane, are in it, m: what they tell of its two sides is less than their errors.
const FLAT: f64 = 0.1;
/// A place outside of the room by no more may still be in it, m, as where a position is looked for.
pub(crate) const ROOM_MARGIN: f64 = 0.5;

/// Anchors in whose line, or plane, a tag was seen by them alone: on which side of it the tag is now is not known. Their
/// numbers.
pub(crate) type Mirror<const D: usize> = SVector<u16, D>;

/// The anchors heard (their numbers and ranges, m), if they are as many as coordinates, and the tag may be in their line.
///
/// Beside the line by d, a range of length r is longer than on it by d²/(2 r) alone: a constant error of b looks like
/// √(2 r b). As much, and the position's own deviation, may be between the tag and where it seems to be.
pub(crate) fn reached<T: Scalar, const D: usize, const N: usize>(
    estimate: &Gaussian<T, N>,
    config: &Config<T>,
    links: &[Link<T>],
    heard: impl Iterator<Item = (usize, T)>,
) -> Option<Mirror<D>> {
    let mut mirror = Mirror::<D>::zeros();
    let (mut count, mut far) = (0, T::ZERO);
    // Not `for`, of which a filter makes two loops.
    heard.for_each(|(anchor, range)| {
        if let Some(place) = mirror.as_array_mut().get_mut(count) {
            *place = anchor as u16;
        }
        far = far.max(range);
        count += 1;
    });
    if count != D {
        return None;
    }
    let position = SVector::<T, D>::from_fn(|axis, _| estimate.mean.as_array()[axis]);
    let distance = T::norm(beside(mirror.as_array(), links, &position)?.as_array());
    let bent = (far + far).sqrt() * config.bias_sigma.sqrt();
    (distance <= bent + spread(estimate)).then_some(mirror)
}

/// Anchors through which a line goes, or a plane, in which all are: none if one of them tells its two sides apart.
#[inline(never)] // Once a tracker.
pub(crate) fn flat<T: Scalar, const D: usize>(links: &[Link<T>]) -> Option<Mirror<D>> {
    let mut chosen = Mirror::<D>::zeros();
    // The farthest from those that were chosen before makes it least uncertain.
    for count in 1..=D {
        let farthest = outside::<T, D>(chosen.as_array().get(..count)?, links);
        match (chosen.as_array_mut().get_mut(count), farthest) {
            (Some(next), Some(anchor)) => *next = anchor,
            // A plane through anchors that are almost in a line is none to be behind.
            (None, None) => {
                return across(&chosen, links, &SVector::<T, D>::zeros()).map(|_| chosen);
            }
            _ => return None,
        }
    }
    None
}

/// The anchor that is farthest outside of the line, or plane, through some; none if all are in it.
#[inline(never)] // Asked for a few times: one copy is enough.
fn outside<T: Scalar, const D: usize>(chosen: &[u16], links: &[Link<T>]) -> Option<u16> {
    let (mut far, mut farthest) = (T::from_f64(FLAT), None);
    for (anchor, link) in links.iter().enumerate() {
        let from = beside::<T, D>(chosen, links, &place(link));
        let distance = from.map_or(T::ZERO, |from| T::norm(from.as_array()));
        if distance > far {
            (far, farthest) = (distance, Some(anchor as u16));
        }
    }
    farthest
}

/// As far as the tag may be from where it seems to be, m.
pub(crate) fn spread<T: Scalar, const N: usize>(estimate: &Gaussian<T, N>) -> T {
    let variances = estimate.covariance.variances();
    let variance = variances.iter().take(N / 2).fold(T::ZERO, |sum, &variance| sum + variance);
    variance.sqrt() * T::from_f64(REACH)
}

/// From the place behind the line, or plane, to this one, m; none where the anchors make none.
pub(crate) fn across<T: Scalar, const D: usize>(
    mirror: &Mirror<D>,
    links: &[Link<T>],
    position: &SVector<T, D>,
) -> Option<SVector<T, D>> {
    let beside = beside(mirror.as_array(), links, position)?;
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

/// Where an anchor is in the tag's dimensions, m.
fn place<T: Scalar, const D: usize>(link: &Link<T>) -> SVector<T, D> {
    SVector::from_fn(|axis, _| link.anchor.position.as_array()[axis])
}

/// From the nearest point of the line, or plane, through these anchors to a place, m; of one anchor, from it.
#[inline(never)] // Rare, and asked for in several places.
fn beside<T: Scalar, const D: usize>(
    anchors: &[u16],
    links: &[Link<T>],
    position: &SVector<T, D>,
) -> Option<SVector<T, D>> {
    let place = |anchor: &u16| links.get(usize::from(*anchor)).map(place);
    let (first, others) = anchors.split_first()?;
    let first = place(first)?;
    let mut beside = position - first;
    let mut along = [SVector::<T, D>::zeros(); D];
    for (count, anchor) in others.iter().enumerate() {
        let mut side = place(anchor)? - first;
        let length = T::norm(side.as_array());
        for known in along.get(..count)? {
            remove(&mut side, known);
        }
        let rest = T::norm(side.as_array());
        // They stand above each other, or in a line.
        if rest <= (length * T::from_f64(0.05)).max(T::from_f64(NEAREST)) {
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
