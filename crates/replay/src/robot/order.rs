//! Sorting of ranges that a log does not hold in the order of time.

use super::{RangeRow, Sensors};

/// The fewest ranges of an anchor that tell the order of a log.
const FEWEST: usize = 10;

impl Sensors {
    /// Sorts ranges by time if the log has all ranges of one anchor before all of another, or the last ones first;
    /// returns a warning that says which.
    ///
    /// Times that go backwards in any other way are left to the tracker, which rejects them.
    pub fn put_in_order(&mut self) -> Option<&'static str> {
        let told = if are_reversed(&self.ranges) {
            "the log has its last ranges first: they are taken in the order of their times"
        } else if are_by_anchor(&self.ranges) {
            "the log has anchor after anchor: ranges are taken in the order of their times"
        } else {
            return None;
        };
        // The sort is stable, so that the place of each range in the log remains traceable.
        self.ranges.sort_by_key(|row| row.time_us);
        Some(told)
    }
}

fn are_reversed(rows: &[RangeRow]) -> bool {
    let [Some(first), Some(last)] = [rows.first(), rows.last()] else { return false };
    rows.len() >= FEWEST
        && first.time_us > last.time_us
        && rows.is_sorted_by(|a, b| a.time_us >= b.time_us)
}

fn are_by_anchor(rows: &[RangeRow]) -> bool {
    let anchors: Vec<&[RangeRow]> = rows.chunk_by(|a, b| a.anchor == b.anchor).collect();
    let is_whole = |rows: &&[RangeRow]| {
        rows.len() >= FEWEST && rows.is_sorted_by(|a, b| a.time_us <= b.time_us)
    };
    let mut heard: Vec<usize> = anchors.iter().map(|rows| rows[0].anchor).collect();
    heard.sort_unstable();
    heard.dedup();
    // Anchors that are heard one after the other are in order already.
    let go_back =
        || anchors.windows(2).any(|pair| pair[1][0].time_us < pair[0][pair[0].len() - 1].time_us);
    anchors.len() >= 2 && heard.len() == anchors.len() && anchors.iter().all(is_whole) && go_back()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ranges of two anchors at each of twenty times.
    fn rows() -> Vec<RangeRow> {
        let row = |k: i64, anchor| RangeRow { time_us: 100_000 * k, anchor, range: Some(1.0) };
        (0..20).flat_map(|k| [row(k, 0), row(k, 1)]).collect()
    }

    /// Whether the order was reported as wrong, and whether ranges are sorted by time afterwards.
    fn ordered(rows: Vec<RangeRow>) -> (bool, bool) {
        let mut sensors = Sensors::ranges(rows);
        let told = sensors.put_in_order().is_some();
        (told, sensors.ranges.is_sorted_by_key(|row| row.time_us))
    }

    #[test]
    fn a_log_by_anchor_or_with_its_end_first_is_put_in_order() {
        assert_eq!(ordered(rows()), (false, true));
        let mut by_anchor = rows();
        by_anchor.sort_by_key(|row| row.anchor);
        assert_eq!(ordered(by_anchor), (true, true));
        let mut reversed = rows();
        reversed.reverse();
        assert_eq!(ordered(reversed), (true, true));
    }

    #[test]
    fn any_other_order_is_left_as_it_is() {
        let mut late = rows();
        late.swap(3, 30);
        assert_eq!(ordered(late), (false, false));
        let mut one_after_the_other = rows();
        one_after_the_other.retain(|row| (row.time_us < 1_000_000) == (row.anchor == 0));
        assert_eq!(ordered(one_after_the_other), (false, true));
    }
}
