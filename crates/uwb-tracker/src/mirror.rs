//! The mirror image that the ranges of too few anchors allow: behind the line through two, or the plane through three;
//! or that of all anchors, if they are collinear or coplanar.

use crate::Config;
use crate::link::Link;
use kestirim_kalman::Gaussian;
use kestirim_scalar::{Components, Scalar};
use kestirim_uwb_ranging::expected_range;
use nalgebra::SVector;

/// Distance from the line, in standard deviations, within which a tag may have crossed it or turned back.
const REACH: f64 = 3.0;
/// Number of standard deviations by which a range must fit one position better than the other.
const CLEAR: f64 = 3.0;
/// Horizontal distance below which anchors count as one above the other, m.
const NEAREST: f64 = 0.05;
/// Distance within which anchors count as lying in a line, in standard deviations of a range: they distinguish its two sides by
/// less than their errors, and the first position may be on either side.
const FLAT_LINE: f64 = 3.0;
/// Distance within which anchors count as lying in a plane, likewise. Those that stand out of it by more tell its two sides
/// apart in time.
const FLAT_PLANE: f64 = 1.0;
/// Margin by which a position may be outside of the room, m, as in the search for a position.
pub(crate) const ROOM_MARGIN: f64 = 0.5;

/// Indices of the anchors in whose line, or plane, a tag was seen by them alone: on which side of it the tag is now is
/// unknown.
pub(crate) type Mirror<const D: usize> = SVector<u16, D>;

/// The mirror of the anchors heard (indices and ranges, m), if there are D of them and the tag may be in their line.
///
/// At a distance d from the line, a range of length r is longer than on it by only d²/(2 r): a constant error b looks
/// like √(2 r b). The tag may be this far, plus the position's own uncertainty, from its apparent position.
pub(crate) fn reached<T: Scalar, const D: usize, const N: usize>(
    estimate: &Gaussian<T, N>,
    config: &Config<T>,
    links: &[Link<T>],
    heard: impl Iterator<Item = (usize, T)>,
) -> Option<Mirror<D>> {
    let mut mirror = Mirror::<D>::zeros();
    let (mut count, mut far) = (0, T::ZERO);
    // Not `for`, which a filter compiles to two loops.
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

/// Anchors that define the line or plane in which all anchors lie, by ranges with this standard deviation (m); `None` if one of
/// them distinguishes its two sides.
#[inline(never)] // Called once per tracker.
pub(crate) fn flat<T: Scalar, const D: usize>(
    links: &[Link<T>],
    range_sigma: T,
) -> Option<Mirror<D>> {
    let near = range_sigma * T::from_f64(if D == 2 { FLAT_LINE } else { FLAT_PLANE });
    let mut chosen = Mirror::<D>::zeros();
    // The anchor farthest from those chosen before makes the line or plane most certain.
    for count in 1..=D {
        let farthest = outside::<T, D>(chosen.as_array().get(..count)?, links, near);
        match (chosen.as_array_mut().get_mut(count), farthest) {
            (Some(next), Some(anchor)) => *next = anchor,
            // A plane through nearly collinear anchors is too uncertain to mirror at.
            (None, None) => {
                return across(&chosen, links, &SVector::<T, D>::zeros()).map(|_| chosen);
            }
            _ => return None,
        }
    }
    None
}

/// The anchor farthest from the line or plane through some others; `None` if all are this `near` (m).
#[inline(never)] // Called a few times: one copy is enough.
fn outside<T: Scalar, const D: usize>(chosen: &[u16], links: &[Link<T>], near: T) -> Option<u16> {
    let (mut far, mut farthest) = (near, None);
    for (anchor, link) in links.iter().enumerate() {
        let from = beside::<T, D>(chosen, links, &place(link));
        let distance = from.map_or(T::ZERO, |from| T::norm(from.as_array()));
        if distance > far {
            (far, farthest) = (distance, Some(anchor as u16));
        }
    }
    farthest
}

/// Largest distance of the tag from its apparent position, m.
pub(crate) fn spread<T: Scalar, const N: usize>(estimate: &Gaussian<T, N>) -> T {
    let variances = estimate.covariance.variances();
    let variance = variances.iter().take(N / 2).fold(T::ZERO, |sum, &variance| sum + variance);
    variance.sqrt() * T::from_f64(REACH)
}

/// Vector from the mirror image behind the line or plane to the position, m; `None` where the anchors define no line
/// or plane.
pub(crate) fn across<T: Scalar, const D: usize>(
    mirror: &Mirror<D>,
    links: &[Link<T>],
    position: &SVector<T, D>,
) -> Option<SVector<T, D>> {
    let beside = beside(mirror.as_array(), links, position)?;
    Some(beside + beside)
}

/// [`across`], unless the mirror image is outside of the room.
pub(crate) fn across_in_room<T: Scalar, const D: usize>(
    mirror: &Mirror<D>,
    config: &Config<T>,
    links: &[Link<T>],
    position: &SVector<T, D>,
) -> Option<SVector<T, D>> {
    let across = across(mirror, links, position)?;
    let (other, margin) = (position - across, T::from_f64(ROOM_MARGIN));
    config.room.is_none_or(|room| room.contains(&other, margin)).then_some(across)
}

/// Whether a range with this innovation (m) and variance excludes the mirror image.
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

/// Position of an anchor in the tag's dimensions, m.
fn place<T: Scalar, const D: usize>(link: &Link<T>) -> SVector<T, D> {
    SVector::from_fn(|axis, _| link.anchor.position.as_array()[axis])
}

/// Vector to a position from the nearest point of the line or plane through these anchors, m; with one anchor, from
/// it.
#[inline(never)] // Rare, and called from several places.
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
        // They are above each other, or collinear.
        if rest <= (length * T::from_f64(0.05)).max(T::from_f64(NEAREST)) {
            return None;
        }
        side.as_array_mut().iter_mut().for_each(|it| *it /= rest);
        remove(&mut beside, &side);
        *along.get_mut(count)? = side;
    }
    Some(beside)
}

/// Subtracts a vector's component along a unit vector.
fn remove<T: Scalar, const D: usize>(from: &mut SVector<T, D>, unit: &SVector<T, D>) {
    let along = T::dot(from.as_array(), unit.as_array());
    for (one, other) in from.iter_mut().zip(unit) {
        *one -= along * *other;
    }
}
