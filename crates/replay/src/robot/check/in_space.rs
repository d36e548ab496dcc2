//! Checks that a tag that is assumed to keep its height does so, with a tracker in space.

use kestirim_health::{Health, Reason};

use super::geometry;
use crate::Finding;
use crate::robot::{Dimensions, Event, Setup, track};

/// The span within which eight of ten heights of a tag at one height lie, m.
const SPAN_M: f64 = 0.5;
/// The span within which eight of ten heights of a tag at one height lie, in standard deviations, if that is larger:
/// for a normal distribution it is 2.6, and the errors of the anchors change with the place.
const SPAN_SIGMAS: f64 = 5.0;
/// The fewest anchors that tell a height.
const FEWEST_ANCHORS: usize = 4;
/// The mean distance of anchors from a plane up to which they tell no height, m: the tracker follows the tag's mirror
/// image at times.
const FLAT_M: f64 = 0.3;
/// The fewest positions from which heights are judged.
const FEWEST: usize = 50;

/// The finding that the tag's height changes; `None` if it does not, or the anchors do not tell heights. `known` is the
/// setup of a tracker in the plane.
pub(super) fn height(known: &Setup, parts: &[&[Event]]) -> Option<Finding> {
    let [_, from_plane] = geometry::flatness(&known.anchors)?;
    if known.anchors.len() < FEWEST_ANCHORS || from_plane < FLAT_M {
        return None;
    }
    let setup = Setup { dimensions: Dimensions::Three, ..known.clone() };
    let traces: Vec<_> = parts.iter().filter_map(|events| track(&setup, events).ok()).collect();
    let (mut heights, mut sigmas, mut positions) = (Vec::new(), Vec::new(), 0);
    for epoch in traces.iter().flat_map(|trace| &trace.epochs) {
        let Some([_, _, z]) = epoch.position else { continue };
        positions += 1;
        if let [.., Some(sigma)] = epoch.sigmas_m()
            && epoch.health == Health::GOOD
        {
            heights.push(z);
            sigmas.push(sigma);
        }
    }
    if heights.len() < FEWEST || 2 * heights.len() < positions {
        return None;
    }
    heights.sort_by(f64::total_cmp);
    sigmas.sort_by(f64::total_cmp);
    let [low, high] = [1, 9].map(|tenths| heights[heights.len() * tenths / 10]);
    let limit = SPAN_M.max(SPAN_SIGMAS * sigmas[sigmas.len() / 2]);
    (high - low > limit).then(|| {
        Finding::fault(
            "height",
            Reason::Height,
            format!("the tag's height changes: in space it is between {low:.1} and {high:.1} m"),
            "in the plane, positions are wrong where it is not as high as supposed",
            "--dim 3, or a file of heights (--height)",
        )
    })
}
