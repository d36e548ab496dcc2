//! Whether ranges and anchors can belong together: what least squares leave over, as it is and with one thing changed.

use kestirim_health::Reason;
use kestirim_uwb_ranging::{Observation, Solver};
use nalgebra::{Matrix3, Vector3};

use super::KnownHeight;
use crate::Finding;
use crate::metrics::median;
use crate::robot::{Anchors, Range};

/// So many moments are looked at, spread over the recording.
const MOMENTS: usize = 80;
/// Fewer say nothing.
const FEWEST: usize = 12;
/// Ranges of so long make a moment, µs: a robot moves 10 cm meanwhile.
const WINDOW_US: i64 = 200_000;
/// What the ranges leave over is a contradiction from here on, m: beyond biases of 30 cm and a wall.
const CONTRADICTION_M: f64 = 0.6;
/// … and one that nothing explains, where walls and people alone may do as much, from here on, m and of the usual range.
const UNEXPLAINED_M: f64 = 1.5;
const UNEXPLAINED_SHARE: f64 = 0.02;
/// A change explains it if it leaves so much less, …
const EXPLAINS: f64 = 3.0;
/// … and no more than this, m.
const EXPLAINED_M: f64 = 0.35;
/// Where walls and people might do as much, a unit or two exchanged anchors are told from here on, m, …
const SUSPICION_M: f64 = 0.15;
/// … if they leave so much less: three anchors have but one range to spare, and noise alone leaves less than that.
const CLEARLY: f64 = 6.0;
/// The standard deviation that all anchors' common bias may have, m.
const COMMON_BIAS_M: f64 = 0.5;
/// Heights that are tried against the one that was said, m.
const HEIGHTS: [f64; 6] = [-1.5, -1.0, -0.5, 0.5, 1.0, 1.5];
const FOOT: f64 = 0.3048;

/// Anchors that are no farther from a plane than so on average lie in it: places are measured to centimetres, m.
const FLAT_M: f64 = 0.05;

/// The ranges of a moment: a range an anchor.
type Moment = Vec<(usize, f64)>;

/// Whether a tag in space has the ranges of another: its mirror image, where the anchors lie in one plane.
pub(super) fn mirror(anchors: &Anchors) -> Option<Finding> {
    if anchors.positions.is_empty() || !anchors.positions.iter().flatten().all(|it| it.is_finite())
    {
        return None;
    }
    let count = anchors.positions.len() as f64;
    let places = || anchors.positions.iter().map(|place| Vector3::from(*place));
    let centre = places().sum::<Vector3<f64>>() / count;
    let spread = places().map(|place| place - centre).map(|it| it * it.transpose() / count);
    let least = spread.sum::<Matrix3<f64>>().symmetric_eigenvalues().min().max(0.0).sqrt();
    (least < FLAT_M).then(|| {
        Finding::fault(
            "geometry",
            Reason::Geometry,
            format!("all anchors lie in one plane, within {:.0} cm", 100.0 * least),
            "a tag has the same ranges on both sides of it, so the height may be the mirror image's",
            "say the height (--height), or hang an anchor well outside the plane",
        )
    })
}

/// What the geometry shows; nothing if there are too few ranges at a time to contradict each other.
pub(super) fn check(
    anchors: &Anchors,
    parts: &[Vec<Range>],
    height: KnownHeight,
) -> Option<Finding> {
    let (height, is_given) = match height {
        // A tag whose height changes with time is no plane's.
        KnownHeight::Varying => return None,
        KnownHeight::Unknown | KnownHeight::NotFound => (None, false),
        KnownHeight::Found(metres) => (Some(metres), false),
        KnownHeight::Said(metres) => (Some(metres), true),
    };
    let moments = moments(parts);
    let places: Vec<Vector3<f64>> =
        anchors.positions.iter().map(|place| Vector3::from(*place)).collect();
    let tried = Tried { moments: &moments, anchors: &places, height };
    let left = tried.left(Moment::clone, &places, height)?;
    let agree =
        || Finding::note("geometry", format!("ranges and anchors agree within {left:.2} m"));
    // A height that was found from the ranges may be wrong by as much.
    if left < SUSPICION_M || (left < CONTRADICTION_M && !is_given) {
        return Some(agree());
    }
    let explains = if left < CONTRADICTION_M { CLEARLY } else { EXPLAINS };
    let name = |anchor: usize| anchors.names[anchor].as_str();
    let found = format!("ranges and anchors disagree by {left:.1} m");
    let explained =
        |with: Option<f64>| with.filter(|with| *with < EXPLAINED_M && *with * explains < left);
    let consequence = "positions may be wrong by as much";
    if let Some(with) = explained(tried.scaled(FOOT)) {
        let remedy = format!("in feet they would agree within {with:.2} m: --units range=ft");
        return Some(Finding::fault("geometry", Reason::Units, found, consequence, remedy));
    }
    if let Some((with, [a, b])) =
        tried.swapped().filter(|(with, _)| explained(Some(*with)).is_some())
    {
        let remedy =
            format!("with {} and {} swapped they would agree within {with:.2} m", name(a), name(b));
        return Some(Finding::fault("geometry", Reason::Anchor, found, consequence, remedy));
    }
    if left < CONTRADICTION_M {
        return Some(agree());
    }
    if let Some((with, by)) =
        tried.higher().filter(|(with, _)| is_given && explained(Some(*with)).is_some())
    {
        let remedy =
            format!("with the tag {by:+.1} m higher they would agree within {with:.2} m: --height");
        return Some(Finding::fault("geometry", Reason::Height, found, consequence, remedy));
    }
    if let Some((with, anchor)) =
        tried.without_one().filter(|(with, _)| explained(Some(*with)).is_some())
    {
        let remedy = format!(
            "without {} the others would agree within {with:.2} m: look where it stands, and what it measures",
            name(anchor)
        );
        return Some(Finding::fault("geometry", Reason::Anchor, found, consequence, remedy));
    }
    let ranges: Vec<f64> = moments.iter().flatten().map(|(_, range)| *range).collect();
    if left < UNEXPLAINED_M + UNEXPLAINED_SHARE * median(&ranges) {
        return Some(Finding::note("geometry", found));
    }
    let remedy = "look at the anchors' places and names, at the unit, and at what stands between";
    Some(Finding::fault("geometry", Reason::Geometry, found, consequence, remedy))
}

/// Moments at which several anchors were heard, spread over the recording.
fn moments(parts: &[Vec<Range>]) -> Vec<Moment> {
    let mut all = Vec::new();
    for ranges in parts {
        let mut begin = 0;
        for i in 1..=ranges.len() {
            let is_over =
                i == ranges.len() || ranges[i].time_us - ranges[begin].time_us > WINDOW_US;
            if is_over {
                all.push(moment(&ranges[begin..i]));
                begin = i;
            }
        }
    }
    all.retain(|moment| moment.len() >= 3);
    let every = (all.len() / MOMENTS).max(1);
    all.into_iter().step_by(every).collect()
}

/// The last range of each anchor.
fn moment(ranges: &[Range]) -> Moment {
    let mut moment: Moment = Vec::new();
    for range in ranges.iter().rev() {
        let is_new = moment.iter().all(|(anchor, _)| *anchor != range.anchor);
        if is_new && range.metres.is_finite() && range.metres > 0.0 {
            moment.push((range.anchor, range.metres));
        }
    }
    moment
}

/// What is tried.
struct Tried<'a> {
    moments: &'a [Moment],
    anchors: &'a [Vector3<f64>],
    height: Option<f64>,
}

impl Tried<'_> {
    /// The median over the moments of what is left, m.
    fn left(
        &self,
        change: impl Fn(&Moment) -> Moment,
        anchors: &[Vector3<f64>],
        height: Option<f64>,
    ) -> Option<f64> {
        let each = self.moments.iter().filter_map(|moment| {
            let observations = change(moment).into_iter().filter_map(|(anchor, range)| {
                Some(Observation { anchor: *anchors.get(anchor)?, range, variance: 1.0 })
            });
            let observations: Vec<_> = observations.collect();
            left_over(&observations, height)
        });
        let each: Vec<f64> = each.collect();
        (each.len() >= FEWEST).then(|| median(&each))
    }

    fn scaled(&self, by: f64) -> Option<f64> {
        let change = |moment: &Moment| moment.iter().map(|(a, range)| (*a, range * by)).collect();
        self.left(change, self.anchors, self.height)
    }

    fn swapped(&self) -> Option<(f64, [usize; 2])> {
        let count = self.anchors.len();
        let pairs = (0..count).flat_map(|a| (a + 1..count).map(move |b| [a, b]));
        let each = pairs.filter_map(|pair| {
            let mut anchors = self.anchors.to_vec();
            anchors.swap(pair[0], pair[1]);
            Some((self.left(Moment::clone, &anchors, self.height)?, pair))
        });
        each.min_by(|a, b| a.0.total_cmp(&b.0))
    }

    fn higher(&self) -> Option<(f64, f64)> {
        let height = self.height?;
        let each = HEIGHTS.into_iter().filter_map(|by| {
            Some((self.left(Moment::clone, self.anchors, Some(height + by))?, by))
        });
        each.min_by(|a, b| a.0.total_cmp(&b.0))
    }

    fn without_one(&self) -> Option<(f64, usize)> {
        let each = (0..self.anchors.len()).filter_map(|left_out| {
            let change = |moment: &Moment| {
                moment.iter().copied().filter(|(anchor, _)| *anchor != left_out).collect()
            };
            Some((self.left(change, self.anchors, self.height)?, left_out))
        });
        each.min_by(|a, b| a.0.total_cmp(&b.0))
    }
}

/// What least squares leave over of ranges, m, by how many they are beyond the unknowns; none if they are not.
fn left_over(observations: &[Observation<f64>], height: Option<f64>) -> Option<f64> {
    let count = observations.len();
    let unknown = if height.is_some() { 2 } else { 3 };
    let with_bias = count > unknown + 1;
    let spare = count.checked_sub(unknown + usize::from(with_bias)).filter(|spare| *spare > 0)?;
    let solver = Solver {
        common_bias: with_bias.then_some(COMMON_BIAS_M),
        ..Solver::new(height.unwrap_or_default())
    };
    let cost = match height {
        Some(_) => solver.solve::<2>(observations, None).ok()?.cost,
        None => solver.solve::<3>(observations, None).ok()?.cost,
    };
    Some((cost / spare as f64).sqrt())
}
