//! Consistency of ranges and anchors: the residuals of least squares, as they are and with one thing changed.

mod explanation;

use std::collections::BTreeSet;

use kestirim_health::Reason;
use nalgebra::{Matrix3, Vector3};

use self::explanation::{CONTRADICTION_M, Tried};
use super::KnownHeight;
use super::moments::{self, Moment};
use crate::Finding;
use crate::metrics::median;
use crate::robot::{Anchors, Range};

/// The residual, m and as a share of the usual range, from which on a contradiction that nothing explains is a fault of
/// the geometry; walls and people alone may cause smaller ones.
const UNEXPLAINED_M: f64 = 1.5;
const UNEXPLAINED_SHARE: f64 = 0.02;
/// The residual from which on a contradiction that nothing explains is a doubt, m, in addition to the share of the
/// usual range: sound recordings of four anchors leave up to 0.34 m, and with an anchor that is misplaced by a metre
/// most cases that are off by more than 3 σ leave more than 0.4 m.
const DOUBT_M: f64 = 0.35;
/// The residual from which on a single change that explains it is reported, although walls and people might cause as
/// much, m.
const SUSPICION_M: f64 = 0.15;
/// The residual from which on a contradiction without a range to spare is reported, m. Three anchors in the plane, or
/// four in space, leave one range beyond the unknowns: enough to see a contradiction, too few to find its cause.
/// Positions are then wrong by a multiple of it.
const NOTHING_TO_SPARE_M: f64 = 0.2;

/// The mean distance of anchors from a plane, or a line, up to which their ranges tell hardly more of its two sides
/// than their own errors, m.
const FLAT_M: f64 = 0.2;

/// A finding if a tag has the same ranges as its mirror image: where the anchors of a tag in space lie in one plane, or
/// those of a tag in the plane stand in one line, unless the room is known.
pub(super) fn mirror(anchors: &Anchors, height: KnownHeight, room: bool) -> Option<Finding> {
    let is_in_space = height == KnownHeight::Unknown;
    let fewest = if is_in_space { 1 } else { 3 };
    if anchors.positions.len() < fewest {
        return None;
    }
    let [from_line, from_plane] = flatness(&anchors.positions)?;
    let (least, shape, doubtful, remedy) = if is_in_space {
        let remedy = "say the height (--height), or hang an anchor well outside the plane";
        (from_plane, "plane", "height", remedy)
    } else {
        let remedy = "say the room (--room), or hang an anchor well beside the line";
        (from_line, "line", "position", remedy)
    };
    (least < FLAT_M && (is_in_space || !room)).then(|| {
        Finding::fault(
            "geometry",
            Reason::Geometry,
            format!("all anchors are within {:.0} cm of one {shape}", 100.0 * least),
            format!(
                "a tag has the same ranges on both sides of it, so the {doubtful} may be the mirror image's"
            ),
            remedy,
        )
    })
}

/// The root mean square distance of places from a line in the plane, and from a plane in space, m; `None` without
/// finite places.
pub(super) fn flatness(places: &[[f64; 3]]) -> Option<[f64; 2]> {
    if places.is_empty() || !places.iter().flatten().all(|it| it.is_finite()) {
        return None;
    }
    let count = places.len() as f64;
    let places = || places.iter().map(|place| Vector3::from(*place));
    let centre = places().sum::<Vector3<f64>>() / count;
    let spread = places().map(|place| place - centre).map(|it| it * it.transpose() / count);
    let spread = spread.sum::<Matrix3<f64>>();
    let in_plane = spread.fixed_view::<2, 2>(0, 0).into_owned();
    let least = [in_plane.symmetric_eigenvalues().min(), spread.symmetric_eigenvalues().min()];
    Some(least.map(|least| least.max(0.0).sqrt()))
}

/// The finding about the geometry; `None` if there are too few ranges at a time to contradict each other.
pub(super) fn check(
    anchors: &Anchors,
    parts: &[Vec<Range>],
    height: KnownHeight,
    is_calibrated: bool,
) -> Option<Finding> {
    let (height, is_given) = match height {
        // A tag whose height changes with time does not move in a plane.
        KnownHeight::Varying => return None,
        KnownHeight::Unknown | KnownHeight::NotFound => (None, false),
        KnownHeight::Found(metres) => (Some(metres), false),
        KnownHeight::Said(metres) => (Some(metres), true),
    };
    let places: Vec<Vector3<f64>> =
        anchors.positions.iter().map(|place| Vector3::from(*place)).collect();
    let at_once = moments::at_once(parts);
    let mut moments = at_once.clone();
    let left = |moments: &[Moment]| {
        Tried { moments, anchors: &places, height }.left(Moment::clone, &places, height)
    };
    let first = left(&moments).or_else(|| {
        moments = moments::interpolated(parts);
        left(&moments)
    });
    let Some(left) = first else {
        return [at_once, moments]
            .iter()
            .find_map(|moments| Tried { moments, anchors: &places, height }.too_far());
    };
    let agree =
        || Finding::note("geometry", format!("ranges and anchors agree within {left:.2} m"));
    let needed = if height.is_some() { 3 } else { 4 };
    let heard: BTreeSet<usize> = moments.iter().flatten().map(|(anchor, _)| *anchor).collect();
    let tried = Tried { moments: &moments, anchors: &places, height };
    let is_contradiction_of_few =
        !is_calibrated && heard.len() == needed && left >= NOTHING_TO_SPARE_M;
    // A height that was found from the ranges may be wrong by as much.
    let is_of_height = left < CONTRADICTION_M && !is_given && !is_contradiction_of_few;
    if left < SUSPICION_M {
        return Some(agree());
    }
    let consequence = "positions may be wrong by as much";
    if let Some((reason, remedy)) = tried.too_short(left, heard.len(), &anchors.names) {
        let found = format!("ranges and anchors disagree by {left:.2} m");
        return Some(Finding::fault("geometry", reason, found, consequence, remedy));
    }
    if is_of_height {
        return Some(agree());
    }
    let found = format!("ranges and anchors disagree by {left:.1} m");
    if let Some((reason, remedy)) = tried.explanation(left, heard.len(), is_given, &anchors.names) {
        return Some(match reason {
            Some(reason) => Finding::fault("geometry", reason, found, consequence, remedy),
            None => Finding::note("geometry", format!("{found}; {remedy}")),
        });
    }
    if is_contradiction_of_few {
        let consequence = "with no range to spare, positions may be wrong by a multiple";
        let remedy = if is_given || height.is_none() {
            "calibrate the anchors (--calibration), or add one"
        } else {
            "say the height (--height), or add an anchor"
        };
        let found = format!("ranges to {needed} anchors contradict each other by {left:.2} m");
        return Some(Finding::fault("geometry", Reason::Geometry, found, consequence, remedy));
    }
    let ranges: Vec<f64> = moments.iter().flatten().map(|(_, range)| *range).collect();
    let of_far = UNEXPLAINED_SHARE * median(&ranges);
    if left < DOUBT_M + of_far {
        return Some(agree());
    }
    if left < UNEXPLAINED_M + of_far {
        let found = format!("ranges and anchors disagree by {left:.2} m");
        let remedy =
            "measure the anchors' places again, calibrate them (--calibration), or add one";
        return Some(Finding::fault("geometry", Reason::NotObservable, found, consequence, remedy));
    }
    let remedy = "look at the anchors' places and names, at the unit, and at what stands between";
    Some(Finding::fault("geometry", Reason::Geometry, found, consequence, remedy))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn told(places: &[[f64; 3]], height: KnownHeight) -> bool {
        let names = (0..places.len()).map(|k| k.to_string()).collect();
        mirror(&Anchors { names, positions: places.to_vec() }, height, false).is_some()
    }

    #[test]
    fn anchors_in_a_line_or_a_plane_have_a_mirror_image() {
        let line = [[0.0, 0.0, 2.0], [3.0, 3.02, 2.4], [5.0, 4.98, 1.0]];
        let corner = [[0.0, 0.0, 2.0], [3.0, 0.0, 2.0], [0.0, 4.0, 2.0], [3.0, 4.0, 2.0]];
        for height in [KnownHeight::Said(1.0), KnownHeight::Found(1.0), KnownHeight::Varying] {
            assert!(told(&line, height) && !told(&corner, height), "{height:?}");
        }
        assert!(told(&corner, KnownHeight::Unknown));
        let raised = corner.map(|[x, y, z]| [x, y, if x > 0.0 && y > 0.0 { z - 1.5 } else { z }]);
        assert!(!told(&raised, KnownHeight::Unknown));
        assert!(!told(&line[..2], KnownHeight::Said(1.0)), "of two anchors all know");
    }

    /// The reason found for ranges of a tag that is carried through a room with anchors in its corners, 1 m below them.
    fn reason(change: impl Fn(f64) -> f64, places: &[[f64; 3]]) -> Option<Reason> {
        reason_among(change, places, places)
    }

    /// The reason found if the anchors stand at places other than the listed ones.
    fn reason_among(
        change: impl Fn(f64) -> f64,
        places: &[[f64; 3]],
        listed: &[[f64; 3]],
    ) -> Option<Reason> {
        let names = (0..places.len()).map(|k| k.to_string()).collect();
        let anchors = Anchors { names, positions: listed.to_vec() };
        let range = |k: usize, anchor: usize| {
            let turn = 0.1 * k as f64;
            let tag = Vector3::new(3.0 + 2.0 * turn.cos(), 2.5 + 1.5 * turn.sin(), 1.0);
            let noise = 0.02 * (1.7 * k as f64 + 2.9 * anchor as f64).sin();
            let metres = change((tag - Vector3::from(places[anchor])).norm() + noise);
            Range { time_us: 100_000 * k as i64, anchor, metres }
        };
        let part = (0..100).flat_map(|k| (0..places.len()).map(move |anchor| (k, anchor)));
        let part = part.map(|(k, anchor)| range(k, anchor)).collect();
        check(&anchors, &[part], KnownHeight::Said(1.0), false)?.reason
    }

    #[test]
    fn one_of_many_anchors_that_stands_elsewhere_is_told() {
        let around = |k: usize| {
            let turn = k as f64 * std::f64::consts::TAU / 8.0;
            [3.0 + 4.0 * turn.cos(), 2.5 + 4.0 * turn.sin(), 2.0]
        };
        let places: Vec<_> = (0..8).map(around).collect();
        assert_eq!(reason(|metres| metres, &places), None);
        let mut listed = places.clone();
        listed[0][0] += 1.2;
        assert_eq!(reason_among(|metres| metres, &places, &listed), Some(Reason::Anchor));
        // A smaller change, among noise, is told only if it makes ranges too short: those that are too long count as obstructed.
        let noisy = |metres: f64| metres + 0.1 * (97.0 * metres).sin();
        for (by, told) in [(0.7, true), (-0.7, false), (0.0, false)] {
            let mut listed = places.clone();
            listed[0][0] += by;
            let reason = reason_among(noisy, &places, &listed);
            assert_eq!(reason, told.then_some(Reason::Anchor), "{by} m");
        }
    }

    #[test]
    fn another_unit_is_told_and_a_delay_of_antennas_is_not_unless_there_are_three_anchors() {
        let corners = [[0.0, 0.0, 2.0], [6.0, 0.0, 2.0], [6.0, 5.0, 2.0], [0.0, 5.0, 2.0]];
        for places in [&corners[..3], &corners] {
            for delay in [-0.3, 0.0, 0.3] {
                let told = (places.len() == 3 && delay != 0.0).then_some(Reason::Geometry);
                assert_eq!(reason(|metres| metres + delay, places), told, "{delay} m");
            }
            assert_eq!(reason(|metres| metres / 0.3048, places), Some(Reason::Units));
        }
        for excess in [1.0, 2.0] {
            let told = reason(|metres| metres + excess, &corners);
            assert_eq!(told, Some(Reason::NotObservable), "{excess} m");
        }
        for factor in [0.5, 2.0, 100.0, 1000.0] {
            assert_eq!(reason(|metres| factor * metres, &corners), Some(Reason::Units), "{factor}");
        }
    }
}
