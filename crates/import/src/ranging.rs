//! Logs of two-way ranging as radios and their programs write them: a line of text for the ranges to all anchors, or
//! one column for each anchor. A table with one row for each range (`t,anchor,range`) is a [`crate::NamedTable`].
//!
//! | | |
//! |---|---|
//! | TREK1000, `DecaRanging` | `mc 0f 00000663 000005a3 00000512 000004cb 095f c1 00024c24 a0:0`: mm, and ms of the tag's clock, in hexadecimal (TREK1000 User Manual, 8.1.1). `mr` is read if there is no `mc`, `ma` is between anchors |
//! | Qorvo MDEK1001 | `les`: `1151[5.00,8.00,2.25]=6.48 … est[…]`; `lec`: `DIST,4,AN0,1151,5.00,8.00,2.25,6.44,…,POS,…` (DWM1001 Firmware API Guide, shell commands): m |
//! | Makerfabs `MaUWB` | `AT+RANGE=tid:1,mask:0F,seq:128,range:(997,1321,911,738,0,0,0,0),ancid:(0,1,2,3,-1,-1,-1,-1)` (AT command manual): cm |
//! | six timestamps per exchange | `t,anchor,t1,t2,t3,t4,t5,t6`, perhaps with `rx_dbm`: poll, response and final message, each sent and received, as the counter of 40 bits has it, in decimal or as `0x…` |
//! | differences of distances | `t,anchor_a,anchor_b,difference`; Crazyflie's client: `Timestamp,tdoa2.d7-0,tdoa2.d0-1,…` |
//! | one column per anchor | `t,d0,d1,…`, `time_ms,range_A1 [cm],…`; the log of Crazyflie's client: `Timestamp,ranging.distance0,…` |
//!
//! A log of several tags is refused unless an option names one (`topic`): by `T` in `aT:A` of a TREK1000, by `tid`, or by a column
//! `tag`.
//!
//! A line may begin with a time: a number, a date, or a time of day (`12:00:00.250 -> AT+RANGE=…`). A range of zero
//! means none.

mod labels;
mod lines;
mod tables;
mod tags;
mod topics;
mod wide;

use crate::damage::Damage;
use crate::error::Error;
use crate::options::Options;
use crate::text::Text;

pub use self::labels::Labels;
pub use self::tags::keep_one_tag;

/// The usual time between two ranging epochs of a tag lies in this interval, s.
const USUAL_STEP: std::ops::RangeInclusive<f64> = 2e-3..=2.0;

/// The latest plausible time, µs: three centuries, beyond any clock.
const LATEST_US: u64 = 10_000_000_000_000_000;

/// A range to an anchor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    /// Time on the log's clock, µs.
    pub time_us: i64,
    /// The index of the anchor in the list.
    pub anchor: usize,
    /// The range, m.
    pub metres: f64,
}

/// The six timestamps of a two-way ranging exchange: of a poll, a response and a final message, each sent and received.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Exchange {
    /// Time on the log's clock, µs.
    pub time_us: i64,
    /// The index of the anchor in the list.
    pub anchor: usize,
    /// The timestamps, as readings of the two radios' counters, below 2⁴⁰.
    pub stamps: [u64; 6],
    /// The received level as the radio estimates it, dBm.
    pub level_dbm: Option<f64>,
}

/// A difference of distances: how much farther the second of two anchors is than the first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Difference {
    /// Time on the log's clock, µs.
    pub time_us: i64,
    /// The indices of the two anchors in the list.
    pub anchors: [usize; 2],
    /// The difference, m.
    pub metres: f64,
}

/// A log of ranges, of timestamps from which ranges are still to be computed, or of differences.
#[derive(Debug, Clone, PartialEq)]
pub struct Ranging {
    /// The ranges, in the order of the log.
    pub ranges: Vec<Range>,
    /// The exchanges, in the order of the log.
    pub exchanges: Vec<Exchange>,
    /// The differences, in the order of the log.
    pub differences: Vec<Difference>,
    /// The number of measurements that refer to anchors outside the list; they are left out.
    pub unlisted: usize,
    /// What was recognised, in one line.
    pub conclusion: String,
    /// What was skipped.
    pub damage: Damage,
}

/// Measurements to anchors under the log's own names for them.
#[derive(Debug, Default)]
struct Found {
    labels: Labels,
    /// The ranges: time in µs, label, range in m.
    ranges: Vec<(i64, usize, f64)>,
    /// The exchanges: time in µs, label, timestamps, level in dBm.
    exchanges: Vec<(i64, usize, [u64; 6], Option<f64>)>,
    /// The differences: time in µs, labels, difference in m.
    differences: Vec<(i64, [usize; 2], f64)>,
}

impl Found {
    fn add(&mut self, time_us: i64, label: &str, metres: f64) {
        if metres == 0.0 {
            return;
        }
        let label = self.labels.index(label);
        self.ranges.push((time_us, label, metres));
    }

    fn add_exchange(&mut self, time_us: i64, label: &str, stamps: [u64; 6], level: Option<f64>) {
        let label = self.labels.index(label);
        self.exchanges.push((time_us, label, stamps, level));
    }

    fn add_difference(&mut self, time_us: i64, labels: &[String; 2], metres: f64) {
        let labels = [self.labels.index(&labels[0]), self.labels.index(&labels[1])];
        self.differences.push((time_us, labels, metres));
    }

    /// The times of all measurements, µs.
    fn times(&self) -> impl Iterator<Item = i64> {
        let exchanges = self.exchanges.iter().map(|(time_us, ..)| *time_us);
        let differences = self.differences.iter().map(|(time_us, ..)| *time_us);
        self.ranges.iter().map(|(time_us, ..)| *time_us).chain(exchanges).chain(differences)
    }
}

/// Reads a log of ranges to `anchors`; `None` if it is of none of these forms.
///
/// # Errors
/// What was expected and what was found, and which option decides where the log does not tell.
pub fn read(bytes: &[u8], anchors: &[String], options: &Options) -> Result<Option<Ranging>, Error> {
    let read = match topics::read(bytes, anchors, options)? {
        Some(read) => Some(read),
        None => of_text(&Text::new(bytes)?, anchors, options)?,
    };
    let Some((found, conclusion, damage)) = read else { return Ok(None) };
    if found.times().any(|time_us| time_us.unsigned_abs() > LATEST_US) {
        return Err(Error::undecided(
            "expected times in s, found one beyond any clock",
            "--units t=",
        ));
    }
    let places = found.labels.places(anchors)?;
    let all = found.times().count();
    let anchor = |label: usize| places.get(label).copied().flatten();
    let range = |&(time_us, label, metres)| Some(Range { time_us, anchor: anchor(label)?, metres });
    let exchange = |&(time_us, label, stamps, level_dbm)| {
        Some(Exchange { time_us, anchor: anchor(label)?, stamps, level_dbm })
    };
    let difference = |&(time_us, [one, other], metres): &(i64, [usize; 2], f64)| {
        Some(Difference { time_us, anchors: [anchor(one)?, anchor(other)?], metres })
    };
    let ranges: Vec<_> = found.ranges.iter().filter_map(range).collect();
    let exchanges: Vec<_> = found.exchanges.iter().filter_map(exchange).collect();
    let differences: Vec<_> = found.differences.iter().filter_map(difference).collect();
    let unlisted = all - ranges.len() - exchanges.len() - differences.len();
    Ok(Some(Ranging { ranges, exchanges, differences, unlisted, conclusion, damage }))
}

fn of_text(
    text: &Text<'_>,
    anchors: &[String],
    options: &Options,
) -> Result<Option<(Found, String, Damage)>, Error> {
    if let Some(read) = lines::read(text, options)? {
        return Ok(Some(read));
    }
    match tables::read(text, options)? {
        Some(read) => Ok(Some(read)),
        None => wide::read(text, anchors, options),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ranges(text: &str, anchors: &[&str], options: &Options) -> Result<Ranging, String> {
        let anchors: Vec<_> = anchors.iter().map(|&name| name.to_owned()).collect();
        let read = read(text.as_bytes(), &anchors, options).map_err(|error| error.to_string())?;
        read.ok_or_else(|| "nothing known".to_owned())
    }

    /// Fails unless the log holds two epochs, 100 ms apart, with ranges of 1.635 and 1.443 m, then 1.4 and 1.2 m.
    fn assert_read(text: &str, anchors: &[&str], options: &Options) {
        let read = ranges(text, anchors, options).unwrap_or_else(|error| panic!("{text}: {error}"));
        let found: Vec<_> = read.ranges.iter().map(|range| (range.anchor, range.metres)).collect();
        let expected = [(0, 1.635), (1, 1.443), (0, 1.4), (1, 1.2)];
        assert_eq!(found.len(), 4, "{text}");
        for ((anchor, metres), (its, expected)) in found.iter().zip(expected) {
            assert!(*anchor == its && (metres - expected).abs() < 5.1e-3, "{text}: {found:?}");
        }
        let step = read.ranges[2].time_us - read.ranges[0].time_us;
        assert_eq!((step, read.ranges[1].time_us), (100_000, read.ranges[0].time_us), "{text}");
        assert_eq!(read.damage.count(), 0, "{text}");
    }

    #[test]
    fn radios_are_understood() {
        let plain = Options::default();
        let counted = Options { units: "t=10Hz".parse().unwrap(), ..Options::default() };
        let trek = "ma 07 00000000 0000085c 00000659 000006b7 095b 26 00024bed a0:0\n\
                    mr 03 00000600 00000500 00000000 00000000 095f c1 40424042 a0:0\n\
                    mc 03 00000663 000005a3 00000512 000004cb 095f c1 00024c24 a0:0\n\
                    mc 03 00000578 000004b0 00000512 000004cb 0960 c2 00024c88 a0:0\n";
        assert_read(trek, &["0", "1"], &plain);
        assert_read(trek, &["A0", "A1", "A2"], &plain);
        let raw = "mr 03 00000663 000005a3 0 0 095f c1 40424042 a0:0\n\
                   mr 03 00000578 000004b0 0 0 0960 c2 40424042 a0:0\n";
        assert_read(raw, &["a0", "a1"], &counted);
        assert!(ranges(raw, &["a0", "a1"], &plain).unwrap_err().contains("--units t=10Hz"));
        let les = "1151[5.00,8.00,2.25]=1.64 0CA8[0.00,8.00,2.25]=1.44 le_us=2576 est[6.97,8.17,-1.37,53]\n\
                   1151[5.00,8.00,2.25]=1.40 0CA8[0.00,8.00,2.25]=1.20 le_us=2576 est[6.97,8.17,-1.37,53]\n";
        assert_read(les, &["1151", "0ca8"], &counted);
        let lec = "10:00:00.000 DIST,2,AN0,1151,5.00,8.00,2.25,1.64,AN1,0CA8,0.00,8.00,2.25,1.44,POS,7.10,8.24,-1.31,97\n\
                   10:00:00.100 DIST,2,AN0,1151,5.00,8.00,2.25,1.40,AN1,0CA8,0.00,8.00,2.25,1.20,POS,7.10,8.24,-1.31,97\n";
        assert_read(lec, &["1151", "0CA8"], &plain);
        let makerfabs = "[0.500] AT+RANGE=tid:1,mask:03,seq:128,range:(164,144,0,0,0,0,0,0),ancid:(0,1,-1,-1,-1,-1,-1,-1)\n\
                         [0.600] AT+RANGE=tid:1,mask:03,seq:129,range:(140,120,0,0,0,0,0,0),rssi:(0.00,0.00)\n";
        assert_read(makerfabs, &["A0", "A1"], &plain);
        let error = ranges(les, &["7", "8"], &counted).unwrap_err();
        assert_eq!(error, "expected ranges to anchors \"7\", \"8\", found \"1151\", \"0CA8\"");
    }

    #[test]
    fn a_column_an_anchor_is_understood() {
        let plain = Options::default();
        for text in [
            "t,d0,d1,d2\n0.0,1.635,1.443,\n0.1,1.4,1.2,\n",
            "time_ms;range_A0 [cm];range_A1 [cm];range_A2 [cm]\n0;163,5;144,3;0\n100;140,0;120,0;0\n",
            "Timestamp,ranging.distance0,ranging.distance1,ranging.distance2\n0,1.635,1.443,0\n100,1.4,1.2,0\n",
            "t\tA0\tA1\tA2\n0\t1.635\t1.443\tnan\n0.1\t1.4\t1.2\tnan\n",
            "t,dist_0_mm,dist_1_mm,dist_2_mm\n0,1635,1443,0\n0.1,1400,1200,0\n",
        ] {
            assert_read(text, &["A0", "A1", "A2"], &plain);
        }
        let four = "t,d1,d2,d3,d4\n0,1.6,1.4,1.3,1.2\n0.1,1.6,1.4,1.3,1.2\n";
        let error = ranges(four, &["A0", "A1", "A2", "A3"], &plain).unwrap_err();
        assert!(error.contains("counted from 0") && error.contains("counted from 1"), "{error}");
        let read = ranges(four, &["A1", "A2", "A3"], &plain).unwrap();
        assert_eq!((read.ranges.len(), read.unlisted), (6, 2), "an anchor more than listed");
        for text in ["t,anchor,range\n0,A0,1\n", "t,x,y,z\n0,1,2,3\n"] {
            assert_eq!(ranges(text, &["A0", "A1"], &plain).unwrap_err(), "nothing known", "{text}");
        }
    }

    #[test]
    fn stamps_are_understood() {
        let plain = Options::default();
        let ticks = [1_099_511_627_000, 500, 64_000_500, 64_000_570, 191_800_570, 191_802_070];
        let text = |header: &str, row: &str| {
            let row = ticks.iter().fold(row.to_owned(), |row, it| format!("{row},{it}"));
            format!("{header}\n0.0{row},-80\n0.1{row},\n0.2,A1,1,2,,4,5,6,-80\n")
        };
        for header in [
            "t,anchor,t1,t2,t3,t4,t5,t6,rx_dbm",
            "time,anchor_id,T1,T2,T3,T4,T5,T6,RSSI [dBm]",
            "t,anchor,poll_tx,poll_rx,resp_tx,resp_rx,final_tx,final_rx,rx_dbm",
        ] {
            let read = ranges(&text(header, ",A1"), &["A0", "A1"], &plain).unwrap();
            let found: Vec<_> = read.exchanges.iter().map(|it| (it.anchor, it.stamps)).collect();
            assert_eq!(found, [(1, ticks); 2], "{header}");
            let levels: Vec<_> = read.exchanges.iter().map(|it| it.level_dbm).collect();
            assert_eq!(levels, [Some(-80.0), None], "{header}");
            assert!(read.ranges.is_empty() && read.damage.count() == 0, "{header}");
        }
        let hexadecimal = "t,anchor,t1,t2,t3,t4,t5,t6\n0,A0,0xFFFFFFFFFF,1,2,3,4,5\n";
        let read = ranges(hexadecimal, &["A0"], &plain).unwrap();
        assert_eq!(read.exchanges[0].stamps[0], (1 << 40) - 1);
        let beyond = hexadecimal.replace("0xF", "0x1F");
        assert!(ranges(&beyond, &["A0"], &plain).unwrap_err().contains("below 2^40"));
    }

    #[test]
    fn ranges_of_one_of_several_tags_are_read() {
        let plain = Options::default();
        let second = Options { topic: Some("1".to_owned()), ..Options::default() };
        let trek = "mc 01 00000663 0 0 0 095f c1 00024c24 a0:0\nmc 01 00000578 0 0 0 0960 c2 00024c88 a1:0\n";
        let makerfabs = "[0.5] AT+RANGE=tid:0,mask:01,seq:1,range:(164,0)\n[0.6] AT+RANGE=tid:1,mask:01,seq:2,range:(140,0)\n";
        let wide = "0.0,0,1.635,1.443\n0.1,1,1.4,1.2\n";
        let stamps = "0,0,A0,1,2,3,4,5,6\n0.1,1,A0,1,2,3,4,5,6\n";
        let logs = [
            ("", trek),
            ("", makerfabs),
            ("t,tag,d0,d1\n", wide),
            ("t,tag,anchor,t1,t2,t3,t4,t5,t6\n", stamps),
        ];
        for text in logs.map(|(head, lines)| head.to_owned() + &lines.repeat(3)) {
            let text = text.as_str();
            let error = ranges(text, &["A0", "A1"], &plain).unwrap_err();
            assert!(error.contains("of one tag, found those of \"0\", \"1\""), "{error}");
            let read = ranges(text, &["A0", "A1"], &second).unwrap();
            assert!(read.ranges.iter().all(|it| it.metres < 1.5), "{text}: {:?}", read.ranges);
            let count = read.ranges.len() + read.exchanges.len();
            assert!((3..=6).contains(&count), "{text}: {count}");
        }
    }

    #[test]
    fn a_column_with_an_anchors_name_is_no_range() {
        let plain = Options::default();
        let text = "t,anchor0,distance0,anchor1,distance1\n0.0,0,1.635,1,1.443\n0.1,0,1.4,1,1.2\n";
        assert_read(text, &["A0", "A1"], &plain);
        let error = ranges("t,d0,d1,r0,r1\n0,1.6,1.4,-80,-81\n", &["A0", "A1"], &plain);
        let expected =
            "line 1: expected one column of ranges to anchor \"0\", found \"d0\" and \"r0\"";
        assert_eq!(error.unwrap_err(), expected);
    }

    #[test]
    fn an_empty_last_field_between_tabs_is_a_missing_range() {
        let plain = Options::default();
        let text = "t\td0\td1\td2\n0.0\t1.635\t1.443\t\n0.1\t1.4\t1.2\t\n";
        assert_read(text, &["A0", "A1", "A2"], &plain);
    }

    #[test]
    fn the_day_after_midnight_follows() {
        let lec = "23:59:59.950 DIST,1,AN0,1151,5.00,8.00,2.25,1.64,POS,7.1,8.2,-1.3,97\n\
                   00:00:00.050 DIST,1,AN0,1151,5.00,8.00,2.25,1.40,POS,7.1,8.2,-1.3,97\n\
                   00:00:00.000 DIST,1,AN0,1151,5.00,8.00,2.25,1.50,POS,7.1,8.2,-1.3,97\n";
        let wide = "time,d0,d1\n23:59:59.950,1.64,2\n00:00:00.050,1.40,2\n00:00:00.000,1.5,2\n";
        for (text, anchors) in [(lec, &["1151"][..]), (wide, &["A0", "A1"])] {
            let read = ranges(text, anchors, &Options::default()).unwrap();
            let of_first = read.ranges.iter().filter(|it| it.anchor == 0);
            let times: Vec<_> = of_first.map(|it| it.time_us).collect();
            assert_eq!(times, [86_399_950_000, 86_400_050_000, 86_400_000_000], "{text}");
        }
    }

    #[test]
    fn differences_are_understood() {
        let plain = Options::default();
        let expected = [(0, [0, 1], 0.5), (100_000, [1, 2], -1.25)];
        for text in [
            "t,anchor_a,anchor_b,difference\n0,A0,A1,0.5\n0.1,A1,A2,-1.25\n",
            "t,idA,idB,tdoa_meas\n0,0,1,0.5\n0.1,1,2,-1.25\n",
            "time_ms;anchorA;anchorB;difference [cm]\n0;A0;A1;50\n100;A1;A2;-125\n",
            "Timestamp,tdoa2.d0-1,tdoa2.d1-2\n0,0.5,0\n100,0.5,-1.25\n",
        ] {
            let read = ranges(text, &["A0", "A1", "A2"], &plain).unwrap();
            let found = read.differences.iter().map(|it| (it.time_us, it.anchors, it.metres));
            assert_eq!(found.collect::<Vec<_>>(), expected, "{text}");
        }
    }

    #[test]
    fn a_torn_line_is_skipped_and_told() {
        let line = "mc 03 00000663 000005a3 00000512 000004cb 095f c1 00024c24 a0:0\n";
        let text = format!("{}mc 03 0000\n", line.repeat(200));
        let read = ranges(&text, &["0", "1"], &Options::default()).unwrap();
        assert_eq!((read.ranges.len(), read.damage.count()), (400, 1));
        let strict = Options { strict: true, ..Options::default() };
        assert!(ranges(&text, &["0", "1"], &strict).unwrap_err().starts_with("line 201: expected"));
    }
}
