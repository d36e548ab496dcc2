//! Ranges by anchor: residuals and rejections.

use std::cmp::Ordering;

use kestirim_replay::robot::{Epoch, Range, Reception, Setup, Trace};
use kestirim_uwb_ranging::expected_range;
use serde::Serialize;

use super::recording::Recording;
use crate::metrics::median;
use crate::system::Sheet;

/// A range, and the tracker's assessment of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Judged {
    /// The part of the recording, counted from 0.
    pub part: usize,
    /// The time of the log's clock (µs).
    pub time_us: i64,
    /// The innovation (m); for a tracker that does not weigh ranges individually, the excess of the range over the
    /// distance to the position found with it.
    pub residual_m: Option<f64>,
    /// The standard deviation of the innovation (m), for a tracker that weighs ranges individually.
    pub sigma_m: Option<f64>,
    /// The normalised innovation squared.
    pub nis: Option<f64>,
    /// Whether the range was accepted.
    pub taken: bool,
}

/// The ranges of each anchor, in the order of the anchors, then of time.
pub fn of_anchors(recording: &Recording, setup: &Setup, traces: &[Trace]) -> Vec<Vec<Judged>> {
    let mut links = vec![Vec::new(); recording.anchors.names.len()];
    for (part, trace) in traces.iter().enumerate() {
        for (range, reception) in &trace.ranges {
            if let Some(link) = links.get_mut(range.anchor) {
                link.push(judged(part, setup, &trace.epochs, range, reception));
            }
        }
    }
    links
}

fn judged(
    part: usize,
    setup: &Setup,
    epochs: &[Epoch],
    range: &Range,
    reception: &Reception,
) -> Judged {
    let seen = reception.innovation;
    let fitted = || {
        let epoch = epochs.binary_search_by_key(&range.time_us, |epoch| epoch.time_us).ok()?;
        let (place, anchor) = (epochs.get(epoch)?.position?, setup.anchors.get(range.anchor)?);
        let expected = expected_range::<f64, 3>(&place.into(), 0.0, &(*anchor).into()).distance;
        Some(range.metres - setup.bias(range.anchor) - expected)
    };
    Judged {
        part,
        time_us: range.time_us,
        residual_m: seen.map(|seen| seen.innovation).or_else(fitted),
        sigma_m: seen.map(|seen| seen.variance.max(0.0).sqrt()),
        nis: seen.map(|seen| seen.nis),
        taken: reception.taken,
    }
}

/// Statistics of an anchor's ranges.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Link {
    /// The name of the anchor.
    pub anchor: String,
    /// The number of ranges.
    pub ranges: usize,
    /// The number of ranges per second, from the first to the last in each part.
    pub rate_hz: Option<f64>,
    /// The share of rejected ranges, from 0 to 1.
    pub rejected_share: Option<f64>,
    /// The median of the residuals (m).
    pub median_m: Option<f64>,
    /// The median absolute deviation of the residuals from their median (m).
    pub mad_m: Option<f64>,
    /// The mean NIS of the accepted ranges.
    pub nis: Option<f64>,
    /// The longest time between two ranges (s).
    pub longest_gap_s: Option<f64>,
}

impl Link {
    /// The statistics of all anchors.
    pub fn all(recording: &Recording, setup: &Setup, traces: &[Trace]) -> Vec<Self> {
        let links = of_anchors(recording, setup, traces);
        let named = recording.anchors.names.iter().zip(links);
        named.map(|(name, ranges)| Self::new(name, &ranges)).collect()
    }

    fn new(anchor: &str, ranges: &[Judged]) -> Self {
        let gaps = ranges.windows(2).filter(|pair| pair[0].part == pair[1].part);
        let gaps: Vec<f64> =
            gaps.map(|pair| (pair[1].time_us - pair[0].time_us) as f64 * 1e-6).collect();
        let seconds = gaps.iter().fold(0.0, |sum, gap| sum + gap);
        let left_over: Vec<f64> =
            ranges.iter().filter_map(|it| it.residual_m).filter(|it| it.is_finite()).collect();
        let median_m = (!left_over.is_empty()).then(|| median(&left_over));
        let mad_m = median_m.map(|middle| {
            median(&left_over.iter().map(|it| (it - middle).abs()).collect::<Vec<_>>())
        });
        let nis: Vec<f64> = ranges.iter().filter(|it| it.taken).filter_map(|it| it.nis).collect();
        let share = |count: usize| count as f64 / ranges.len() as f64;
        Self {
            anchor: anchor.to_owned(),
            ranges: ranges.len(),
            rate_hz: (seconds > 0.0).then(|| gaps.len() as f64 / seconds),
            rejected_share: (!ranges.is_empty())
                .then(|| share(ranges.iter().filter(|it| !it.taken).count())),
            median_m,
            mad_m,
            nis: (!nis.is_empty()).then(|| nis.iter().sum::<f64>() / nis.len() as f64),
            longest_gap_s: gaps.iter().copied().reduce(f64::max),
        }
    }
}

/// The table of anchors, those with the largest share of rejected ranges first.
pub fn table(links: &[Link]) -> Sheet {
    let mut links: Vec<_> = links.iter().collect();
    links
        .sort_by(|a, b| b.rejected_share.partial_cmp(&a.rejected_share).unwrap_or(Ordering::Equal));
    let header = [
        "anchor",
        "ranges",
        "rate, Hz",
        "left out, %",
        "median of residuals, cm",
        "MAD of residuals, cm",
        "mean NIS",
        "longest gap, s",
    ];
    let rows = links.into_iter().map(|link| {
        let number = |value: Option<f64>, digits: usize| {
            value.map_or_else(String::new, |value| format!("{value:.digits$}"))
        };
        let of = |value: Option<f64>| number(value.map(|value| 100.0 * value), 1);
        vec![
            link.anchor.clone(),
            link.ranges.to_string(),
            number(link.rate_hz, 2),
            of(link.rejected_share),
            of(link.median_m),
            of(link.mad_m),
            number(link.nis, 2),
            number(link.longest_gap_s, 2),
        ]
    });
    Sheet::new("links", "Links", &header)
        .caption(
            "Anchor by anchor, most left out first. A median far from zero is a bias or a wrong place, a wide spread (MAD, median \
             absolute deviation) an obstacle; the NIS of what was taken in is 1 if the tracker knows the anchor's noise.",
        )
        .with(rows)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::system::ScalarKind;
    use crate::systems::robot::recording::Driven;
    use crate::systems::robot::settings::of_the_office;
    use crate::systems::robot::track::track;
    use kestirim_replay::robot::{Event, TrackerKind};

    /// A run along the straight line in whose second half one in `one_in` ranges of an anchor is 3 m too long.
    fn with_a_bad_anchor(one_in: usize) -> Recording {
        let mut recording = Recording::synthetic(Driven::Line, 0);
        let events = &mut recording.parts[0].events;
        let middle = events.len() / 2;
        let bad = events[middle..].iter_mut().filter_map(|event| match event {
            Event::Range(range @ Range { anchor: 2, .. }) => Some(range),
            _ => None,
        });
        bad.step_by(one_in).for_each(|range| range.metres += 3.0);
        recording
    }

    #[test]
    fn the_bad_anchor_stands_out() {
        // A range that is too long only sometimes is rejected; a bias that is always there is finally accepted, with
        // little weight.
        for one_in in [3, 1] {
            let (recording, setup) = (with_a_bad_anchor(one_in), of_the_office(ScalarKind::F32));
            let traces = track(&recording, &setup).unwrap();
            let links = Link::all(&recording, &setup, &traces);
            assert_eq!(links.len(), 4);
            for (place, link) in links.iter().enumerate() {
                let found = match one_in {
                    1 => link.median_m.unwrap() > 1.0,
                    _ => link.rejected_share.unwrap() > 0.03,
                };
                assert_eq!(found, place == 2, "one in {one_in}: {link:?}");
            }
            let table = table(&links);
            assert_eq!(table.rows[0][0], recording.anchors.names[2]);
            assert!(table.rows.iter().all(|row| row.len() == table.header.len()), "{table:?}");
            let count: usize = links.iter().map(|link| link.ranges).sum();
            assert_eq!(count, traces[0].ranges.len());
            let left_out = links.iter().map(|it| it.rejected_share.unwrap() * it.ranges as f64);
            assert_eq!(left_out.sum::<f64>().round() as usize, traces[0].rejected());
        }
    }

    #[test]
    fn trilateration_leaves_over_what_its_position_does_not_explain() {
        let recording = with_a_bad_anchor(1);
        let setup = Setup { tracker: TrackerKind::Lsq, ..of_the_office(ScalarKind::F64) };
        let traces = track(&recording, &setup).unwrap();
        let links = of_anchors(&recording, &setup, &traces);
        let all = || links.iter().flatten();
        assert!(all().all(|it| it.taken && it.sigma_m.is_none() && it.nis.is_none()));
        let largest = all().filter_map(|it| it.residual_m).fold(0.0, |a: f64, b| a.max(b.abs()));
        assert!((1.0..3.0).contains(&largest), "{largest} m");
    }

    #[test]
    fn rate_and_gap_are_of_one_part_each_and_no_range_tells_nothing() {
        let range = |part, time_us| Judged {
            part,
            time_us,
            residual_m: Some(time_us as f64 * 1e-6),
            sigma_m: None,
            nis: None,
            taken: true,
        };
        let ranges = [range(0, 0), range(0, 500_000), range(0, 2_000_000), range(1, 0)];
        let link = Link::new("A", &ranges);
        assert_eq!((link.rate_hz, link.longest_gap_s), (Some(1.0), Some(1.5)));
        assert_eq!((link.median_m, link.mad_m), (Some(0.25), Some(0.25)));
        assert_eq!(Link::new("A", &[]), Link { anchor: "A".to_owned(), ..Link::default() });
    }
}
