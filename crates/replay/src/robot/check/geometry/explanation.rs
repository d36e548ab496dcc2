//! Explanations that would make ranges and anchors agree: one thing changed at a time.

use kestirim_health::Reason;
use kestirim_uwb_ranging::{Fix, Observation, Search, Solver};
use nalgebra::Vector3;

use crate::Finding;
use crate::metrics::median;
use crate::robot::check::moments::Moment;

/// The residual from which on ranges and anchors contradict each other, m: beyond biases of 30 cm and a wall.
pub(super) const CONTRADICTION_M: f64 = 0.6;
/// The fewest moments from which a residual is computed.
const FEWEST: usize = 12;
/// The number of anchors among which a misplaced one is averaged out, but stands out more clearly; the residual is then
/// judged from `OF_MANY_M` on, m.
const MANY: usize = 6;
const OF_MANY_M: f64 = 0.3;
/// The factor by which a change that explains a contradiction must reduce the residual.
const EXPLAINS: f64 = 3.0;
/// The largest residual that such a change may leave, m.
const EXPLAINED_M: f64 = 0.35;
/// The factor by which a change must reduce a residual that walls and people might cause as well: three anchors have
/// only one range to spare, and noise alone reduces it by less.
const CLEARLY: f64 = 6.0;
/// The factor by which leaving out an anchor of many must reduce the residual if its ranges are shorter than the others allow.
/// Sound recordings of eight anchors reach 1.3.
const EXPLAINS_SHORT: f64 = 1.6;
/// The residual from which on a range is too short, m, and the share of the moments in which it must be. An obstacle lengthens
/// ranges, and the tracker takes those that are longer than others allow for obstructed: a single anchor whose ranges are too
/// short would decide over all others.
const SHORT_M: f64 = -0.3;
const OFTEN: f64 = 0.25;
/// The standard deviation of the bias common to all anchors, m.
const COMMON_BIAS_M: f64 = 0.5;
/// The residual by which a common excess may be worse than a height and still explain as well, m: radios have an excess
/// more often.
const AS_WELL_M: f64 = 0.05;
/// The height differences that are tried against the given height, m.
const HEIGHTS: [f64; 6] = [-1.5, -1.0, -0.5, 0.5, 1.0, 1.5];
/// The common excesses of all ranges that are tried, beyond what a common bias of half a metre explains, m.
const EXCESSES: [f64; 4] = [1.0, 1.5, 2.0, 3.0];
/// The units and factors that ranges may have instead of metres, and the remedies. (Yards are shorter by no more than a
/// usual antenna delay.)
const SCALES: [(f64, &str, &str); 5] = [
    (1e-3, "in millimetres", ": --units range=mm"),
    (1e-2, "in centimetres", ": --units range=cm"),
    (0.3048, "in feet", ": --units range=ft"),
    (0.5, "halved", ": they may be those of there and back"),
    (2.0, "doubled", ": they may have been halved twice"),
];

/// The scale below which ranges become so short that they fit any anchors that are close together.
const SMALLEST: f64 = 0.1;
/// Smaller scales are tried only for ranges longer than this many times the distance of the farthest anchor from the
/// middle of all.
const FAR: f64 = 10.0;

/// Ranges and anchors to which changes are applied.
pub(super) struct Tried<'a> {
    pub(super) moments: &'a [Moment],
    pub(super) anchors: &'a [Vector3<f64>],
    pub(super) height: Option<f64>,
}

impl Tried<'_> {
    /// The median of the residuals over the moments, m.
    pub(super) fn left(
        &self,
        change: impl Fn(&Moment) -> Moment,
        anchors: &[Vector3<f64>],
        height: Option<f64>,
    ) -> Option<f64> {
        let each = self
            .moments
            .iter()
            .filter_map(|moment| Some(fit(&observations(&change(moment), anchors), height)?.left));
        let each: Vec<f64> = each.collect();
        (each.len() >= FEWEST).then(|| median(&each))
    }

    /// The single change with which ranges and the `heard` anchors agree, if there is one: the reason, if positions
    /// suffer, and the remedy.
    pub(super) fn explanation(
        &self,
        left: f64,
        heard: usize,
        height_is_given: bool,
        names: &[String],
    ) -> Option<(Option<Reason>, String)> {
        let is_contradiction = left >= CONTRADICTION_M;
        let is_of_many = heard >= MANY && left >= OF_MANY_M;
        let explains = if is_contradiction || is_of_many { EXPLAINS } else { CLEARLY };
        let explained = |with: f64| (with < EXPLAINED_M && with * explains < left).then_some(with);
        // Without one of four anchors three remain, with one range to spare; of three anchors there is only one to
        // begin with.
        let is_clear = is_contradiction || self.anchors.len() > 4;
        if let Some((with, (how, what))) = self.another_unit()
            && let Some(with) = explained(with)
        {
            return Some((Some(Reason::Units), format!("{how} {}{what}", agree(with))));
        }
        let swapped: Vec<_> = self
            .swapped()
            .into_iter()
            .filter_map(|(with, pair)| Some((explained(with)?, pair)))
            .collect();
        if let Some((best, [a, b])) = swapped.first() {
            let of_both = |[a, b]: [usize; 2]| format!("{} and {}", names[a], names[b]);
            let agree = agree(*best);
            let as_well = swapped.iter().skip(1).find(|(with, _)| *with < best + AS_WELL_M);
            let remedy = match as_well {
                None => format!("with {} swapped {agree}", of_both([*a, *b])),
                // In a rectangle, both give rooms that are mirror images of each other, with the same distances.
                Some((_, other)) => format!(
                    "with {} swapped {agree}, with {} as well: look at a plan, one room may mirror the other",
                    of_both([*a, *b]),
                    of_both(*other)
                ),
            };
            return Some((Some(Reason::Anchor), remedy));
        }
        if let Some((with, by)) = self.shifted().filter(|_| is_clear)
            && let Some(with) = explained(with)
        {
            let remedy = format!(
                "with each anchor {by} places on in the list {}: look from which number both count",
                agree(with)
            );
            return Some((Some(Reason::Anchor), remedy));
        }
        let higher = (is_contradiction && height_is_given).then(|| self.higher()).flatten();
        let longer = is_contradiction.then(|| self.longer()).flatten();
        if let Some((with, by)) = longer
            && higher.is_none_or(|(of_height, _)| with < of_height + AS_WELL_M)
            && let Some(with) = explained(with)
        {
            let remedy = format!(
                "with all ranges {by:.1} m too long {}: calibrate the anchors (--calibration)",
                agree(with)
            );
            // With six or more anchors the tracker estimates the common excess itself; with fewer, a part of it goes
            // into positions.
            let reason = (heard < MANY).then_some(Reason::NotObservable);
            return Some((reason, remedy));
        }
        if let Some((with, by)) = higher
            && let Some(with) = explained(with)
        {
            let remedy = format!("with the tag {by:+.1} m higher {}: --height", agree(with));
            return Some((Some(Reason::Height), remedy));
        }
        if let Some((with, anchor)) = self.without_one().filter(|_| is_clear)
            && let Some(with) = explained(with)
        {
            let remedy = format!(
                "without {} the others {}: look where it stands, and what it measures",
                names[anchor],
                agree(with).trim_start_matches("they ")
            );
            return Some((Some(Reason::Anchor), remedy));
        }
        None
    }

    /// The anchor of `heard` whose ranges are too short for the others, if it is one of many, and how the others agree.
    pub(super) fn too_short(
        &self,
        left: f64,
        heard: usize,
        names: &[String],
    ) -> Option<(Reason, String)> {
        let (with, anchor) = self.without_one().filter(|_| heard >= MANY)?;
        if with * EXPLAINS_SHORT > left {
            return None;
        }
        let excess = self.moments.iter().filter_map(|moment| {
            let (_, range) = moment.iter().find(|(it, _)| *it == anchor)?;
            let others: Moment = moment.iter().copied().filter(|(it, _)| *it != anchor).collect();
            let fitted = fit(&observations(&others, self.anchors), self.height)?;
            Some(range - (fitted.place - self.anchors.get(anchor)?).norm() - fitted.common)
        });
        let excess: Vec<f64> = excess.collect();
        let short = excess.iter().filter(|excess| **excess < SHORT_M).count();
        (short as f64 > OFTEN * excess.len() as f64).then(|| {
            let agree = agree(with);
            let others = agree.trim_start_matches("they ");
            let name = &names[anchor];
            let remedy = format!(
                "ranges to {name} are too short for the others, which {others}: look where it stands, or calibrate it"
            );
            (Reason::Anchor, remedy)
        })
    }

    /// The finding about ranges for which least squares find no place at all: ranges in millimetres or centimetres are
    /// so long.
    pub(super) fn too_far(&self) -> Option<Finding> {
        let (with, (how, what)) = self.another_unit().filter(|(with, _)| *with < EXPLAINED_M)?;
        let found = "ranges and anchors agree on no place".to_owned();
        let remedy = format!("{how} {}{what}", agree(with));
        Some(Finding::fault("geometry", Reason::Units, found, "there is no position", remedy))
    }

    /// The residual with the ranges in the unit that fits best, with its name and the remedy.
    fn another_unit(&self) -> Option<(f64, (&'static str, &'static str))> {
        let ranges: Vec<f64> = self.moments.iter().flatten().map(|(_, range)| *range).collect();
        let centre = self.anchors.iter().sum::<Vector3<f64>>() / self.anchors.len().max(1) as f64;
        let spread = self.anchors.iter().map(|it| (it - centre).norm()).fold(0.0, f64::max);
        let is_far = median(&ranges) > FAR * spread;
        let each = SCALES.into_iter().filter(|(by, ..)| is_far || *by > SMALLEST).filter_map(
            |(by, how, what)| {
                let change =
                    |moment: &Moment| moment.iter().map(|(a, range)| (*a, range * by)).collect();
                Some((self.left(change, self.anchors, self.height)?, (how, what)))
            },
        );
        each.min_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// The residual with all ranges shortened by the common excess that fits best, and that excess, m.
    fn longer(&self) -> Option<(f64, f64)> {
        let each = EXCESSES.into_iter().filter_map(|by| {
            let change =
                |moment: &Moment| moment.iter().map(|(a, range)| (*a, range - by)).collect();
            Some((self.left(change, self.anchors, self.height)?, by))
        });
        each.min_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// The residuals with any two anchors swapped, the best first.
    fn swapped(&self) -> Vec<(f64, [usize; 2])> {
        let count = self.anchors.len();
        let pairs = (0..count).flat_map(|a| (a + 1..count).map(move |b| [a, b]));
        let each = pairs.filter_map(|pair| {
            let mut anchors = self.anchors.to_vec();
            anchors.swap(pair[0], pair[1]);
            Some((self.left(Moment::clone, &anchors, self.height)?, pair))
        });
        let mut each: Vec<_> = each.collect();
        each.sort_by(|a, b| a.0.total_cmp(&b.0));
        each
    }

    /// The residual with the log counting the anchors from another number than the list, at the best shift.
    fn shifted(&self) -> Option<(f64, usize)> {
        let each = (1..self.anchors.len()).filter_map(|by| {
            let mut anchors = self.anchors.to_vec();
            anchors.rotate_right(by);
            Some((self.left(Moment::clone, &anchors, self.height)?, by))
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

/// The agreement after a change, in words.
fn agree(with: f64) -> String {
    format!("they would agree within {with:.2} m")
}

fn observations(moment: &Moment, anchors: &[Vector3<f64>]) -> Vec<Observation<f64>> {
    let observation = |&(anchor, range): &(usize, f64)| {
        Some(Observation { anchor: *anchors.get(anchor)?, range, variance: 1.0 })
    };
    moment.iter().filter_map(observation).collect()
}

/// Least squares over the ranges of a moment.
struct Fit {
    /// The residual per redundant range, m.
    left: f64,
    place: Vector3<f64>,
    /// The excess that all ranges have in common, m.
    common: f64,
}

/// The fit to a moment; `None` without redundancy.
fn fit(observations: &[Observation<f64>], height: Option<f64>) -> Option<Fit> {
    let count = observations.len();
    let unknown = if height.is_some() { 2 } else { 3 };
    let with_bias = count > unknown + 1;
    let spare = count.checked_sub(unknown + usize::from(with_bias)).filter(|spare| *spare > 0)?;
    let solver = Solver {
        common_bias: with_bias.then_some(COMMON_BIAS_M),
        ..Solver::new(height.unwrap_or_default())
    };
    let (cost, place, common) = if let Some(height) = height {
        let fix = best::<2>(&solver, observations)?;
        (fix.cost, fix.position.push(height), fix.common_bias)
    } else {
        let fix = best::<3>(&solver, observations)?;
        (fix.cost, fix.position, fix.common_bias)
    };
    Some(Fit { left: (cost / spare as f64).sqrt(), place, common })
}

/// The best-fitting position, as accurate as the sizes of residuals ask for: to a centimetre.
fn best<const D: usize>(
    solver: &Solver<f64>,
    observations: &[Observation<f64>],
) -> Option<Fix<f64, D>> {
    Search::new(None).advance(solver, observations, usize::MAX).ok()?.copied()
}
