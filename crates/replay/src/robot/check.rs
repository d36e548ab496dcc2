//! Checks of the ranges of a tag before it is tracked.

mod geometry;
mod in_space;
mod inertial;
mod jumps;
mod moments;
mod steps_back;
mod stuck;
mod together;
mod wheels;

use kestirim_health::Reason;

use super::{Anchors, Event, Range, Setup};
use crate::Finding;
use crate::metrics::standard_deviation;

/// The fewest ranges with the same largest value, and the smallest share (`CUT_SHARE`), from which on ranges were cut
/// there.
const CUT: usize = 20;
const CUT_SHARE: f64 = 0.03;

/// What is known of the tag's height.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum KnownHeight {
    /// Unknown, and estimated along with the position, for a tag in space.
    Unknown,
    /// Unknown, for a tag in the plane: the ranges do not tell it.
    NotFound,
    /// Given by the user, m.
    Said(f64),
    /// Found from the ranges, or assumed, m.
    Found(f64),
    /// Changing with time.
    Varying,
}

/// The findings about the parts of a recording: of a tag whose height and room may be known, among anchors whose ranges
/// are too long by `biases` (m) if they are calibrated.
pub fn check<'a>(
    anchors: &Anchors,
    parts: impl IntoIterator<Item = &'a [Event]>,
    height: KnownHeight,
    room_is_known: bool,
    biases: Option<&[f64]>,
) -> Vec<Finding> {
    let mut findings = Vec::new();
    let parts: Vec<&[Event]> = parts.into_iter().collect();
    let is_difference = |event: &&Event| matches!(event, Event::Difference(_));
    let differences = parts.iter().map(|part| part.iter().filter(is_difference).count());
    let differences: usize = differences.sum();
    if differences > 0 {
        findings.push(Finding::note("differences", format!("{differences} of distances")));
        findings.extend(geometry::mirror(anchors, height, room_is_known));
        return findings;
    }
    let at = |metres: f64| {
        let plain = Setup::new(&anchors.positions, metres);
        Setup { biases: biases.map(<[f64]>::to_vec), ..plain }
    };
    let tracked = match height {
        KnownHeight::Said(metres) | KnownHeight::Found(metres) => {
            let setup = at(metres);
            [in_space::height(&setup, &parts), wheels::find(&setup, &parts)]
        }
        KnownHeight::Varying => [None, wheels::find(&at(anchors.mean_height()), &parts)],
        KnownHeight::Unknown | KnownHeight::NotFound => [None, None],
    };
    findings.extend(together::find(&parts));
    findings.extend(steps_back::find(&parts));
    findings.extend(inertial::find(&parts));
    let parts: Vec<Vec<Range>> = parts.into_iter().map(ranges).collect();
    let name = |anchor: usize| anchors.names.get(anchor).map_or("", String::as_str);
    findings.extend(links(&parts, anchors.names.len(), &name));
    let cut_at = cut_at(&parts);
    findings.extend(cut_at.map(cut));
    let cut_at = cut_at.map(|(_, metres)| metres);
    findings.extend(parts.iter().find_map(|ranges| stuck::one(ranges, cut_at, &name)));
    findings.extend(parts.iter().find_map(|ranges| stuck::all(ranges, cut_at)));
    findings.extend(jumps::find(&parts, &name));
    let freed = biases.map(|biases| freed(&parts, biases));
    let ranges = freed.as_ref().unwrap_or(&parts);
    findings.extend(geometry::check(anchors, ranges, height, biases.is_some()));
    findings.extend(geometry::mirror(anchors, height, room_is_known));
    findings.extend(tracked.into_iter().flatten());
    findings
}

fn ranges(events: &[Event]) -> Vec<Range> {
    let range = |event: &Event| match event {
        Event::Range(range) => Some(*range),
        _ => None,
    };
    events.iter().filter_map(range).collect()
}

/// The ranges without the biases of their anchors.
fn freed(parts: &[Vec<Range>], biases: &[f64]) -> Vec<Vec<Range>> {
    let free = |range: &Range| {
        let bias = biases.get(range.anchor).copied().unwrap_or_default();
        Range { metres: range.metres - bias, ..*range }
    };
    parts.iter().map(|ranges| ranges.iter().map(free).collect()).collect()
}

/// The rate at which each anchor is heard, and anchors whose values are not ranges.
fn links<'a>(
    parts: &[Vec<Range>],
    anchors: usize,
    name: &impl Fn(usize) -> &'a str,
) -> Vec<Finding> {
    let seconds: f64 = parts
        .iter()
        .filter_map(|ranges| {
            let times = ranges.iter().map(|range| range.time_us);
            Some((times.clone().max()? - times.min()?) as f64 * 1e-6)
        })
        .sum();
    let mut findings = Vec::new();
    let mut rates = Vec::new();
    for anchor in 0..anchors {
        let its: Vec<f64> =
            parts.iter().flatten().filter(|it| it.anchor == anchor).map(|it| it.metres).collect();
        if its.is_empty() {
            findings.push(Finding::note("anchors", format!("{} is never heard", name(anchor))));
            continue;
        }
        rates.push(format!("{} at {:.1} Hz", name(anchor), its.len() as f64 / seconds.max(1e-3)));
        let wrong = its.iter().filter(|metres| !metres.is_finite() || **metres <= 0.0).count();
        if wrong * 10 > its.len() {
            findings.push(Finding::fault(
                "ranges",
                Reason::Units,
                format!("{} of {} ranges to {} are no distances", wrong, its.len(), name(anchor)),
                "they are left out",
                "look at the antenna delay: a range must be above zero",
            ));
        }
    }
    let heard = if rates.is_empty() {
        "no anchor is heard".to_owned()
    } else {
        format!("anchors {}", rates.join(", "))
    };
    findings.insert(0, Finding::note("rate", heard));
    findings
}

/// The number of ranges that were cut at a largest value, and that value, m.
fn cut_at(parts: &[Vec<Range>]) -> Option<(usize, f64)> {
    let all: Vec<&Range> = parts.iter().flatten().filter(|it| it.metres.is_finite()).collect();
    let metres: Vec<f64> = all.iter().map(|it| it.metres).collect();
    let most = metres.iter().copied().fold(0.0, f64::max);
    let at_most: Vec<usize> =
        all.iter().filter(|it| it.metres == most).map(|it| it.anchor).collect();
    let is_often = at_most.len() >= CUT && at_most.len() as f64 >= CUT_SHARE * metres.len() as f64;
    // A tag that stands still gives the same range to one anchor again and again.
    let of_several = at_most.iter().any(|anchor| *anchor != at_most[0]);
    let is_cut = is_often && of_several && standard_deviation(&metres) > stuck::MOVING_M;
    is_cut.then_some((at_most.len(), most))
}

fn cut((count, metres): (usize, f64)) -> Finding {
    Finding::fault(
        "cut",
        Reason::Saturated,
        format!("{count} ranges are exactly {metres} m, the largest of all"),
        "what is farther away looks nearer than it is",
        "look at the largest range that the radio or the logger can give",
    )
}
