//! Logs of ranges, of a moving tag or of one put down at marked points.

use std::collections::BTreeMap;
use std::path::Path;

use kestirim_import::Options;
use kestirim_import::ranging::{self, Labels, keep_one_tag};
use kestirim_replay::robot::{Anchors, Difference, Exchange, RangeRow};

use crate::Error;
use crate::table::{self, Column, Found, Log, Row};
use crate::text::{self, printable};

/// The time between the epochs of a static recording (µs).
const EPOCH_US: i64 = 100_000;
/// The usual range of the time between ranges (s).
const USUAL_STEP_S: [f64; 2] = [2e-3, 2.0];
/// The largest plausible count of epochs.
const LAST_EPOCH: f64 = 1e9;

/// The anchors of the list that the labels of a log refer to.
fn places(labels: &Labels, path: &Path, anchors: &Anchors) -> Result<Vec<Option<usize>>, Error> {
    labels.places(&anchors.names).map_err(|error| table::refused(path, &error))
}

/// The ranges of a log.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct RangeLog {
    /// The ranges, in the order of the log.
    pub rows: Vec<RangeRow>,
    /// Range differences in place of ranges, for a tag that only listens.
    pub differences: Vec<Difference>,
    /// The number of lines with an anchor that is not in the list, which are left out.
    pub unlisted: usize,
    /// The number of lines that mark a missing range by zero or a negative number.
    pub without: usize,
}

impl RangeLog {
    /// Adds a line, with the index of its anchor's name among those of the log.
    fn add(&mut self, time_us: i64, name: usize, range: Option<f64>) {
        let range = range.filter(|range| !range.is_nan());
        self.rows.push(RangeRow { time_us, anchor: name, range });
    }

    /// Replaces the indices of anchor names in the log by indices into the list, and removes values that are not
    /// distances, unless most are not: then they are wrong, and are left to be rejected.
    fn resolve(&mut self, places: &[Option<usize>]) {
        let count = self.rows.len();
        self.rows.retain_mut(|row| {
            let place = places.get(row.anchor).copied().flatten();
            row.anchor = place.unwrap_or_default();
            place.is_some()
        });
        self.unlisted = count - self.rows.len();
        let is_none = |row: &RangeRow| row.range.is_some_and(|range| range <= 0.0);
        let without = self.rows.iter().filter(|row| is_none(row)).count();
        let told = self.rows.iter().filter(|row| row.range.is_some()).count();
        if 2 * without <= told {
            self.without = without;
            for row in self.rows.iter_mut().filter(|row| is_none(row)) {
                row.range = None;
            }
        }
    }
}

/// Reads the log of a moving tag: as printed by its radio, as timestamps, as differences, with a column per anchor, or
/// as a table with columns `t,anchor,range` (s, m).
///
/// # Errors
/// An error that names the file, the line, and what was expected there.
pub fn read_moving(
    path: &Path,
    anchors: &Anchors,
    options: &Options,
) -> Result<(RangeLog, Found), Error> {
    let (mut log, mut labels) = (RangeLog::default(), Labels::default());
    let mut tags = Vec::new();
    let bytes = text::unpacked(path)?;
    if let Some(found) = of_radio(path, &bytes, anchors, options)? {
        return Ok(found);
    }
    let found = table::parse(
        path,
        &bytes,
        &Log { what: "ranges", usual_step_s: Some(USUAL_STEP_S), options },
        |header| Ok((header.require(["t", "anchor", "range"])?, header.find("tag").ok().flatten())),
        |&([t, anchor, range], tag), row| {
            let time_us = row.time_us(t)?;
            let range = optional_range(row, range)?;
            log.add(time_us, labels.index(&row.text(anchor)), range);
            tags.push(tag.map(|tag| row.text(tag).into_owned()).unwrap_or_default());
            Ok(())
        },
    )?;
    let mut rows: Vec<(String, RangeRow)> = tags.into_iter().zip(log.rows).collect();
    keep_one_tag(&mut rows, |(tag, _)| tag, options.topic.as_deref())
        .map_err(|error| table::refused(path, &error))?;
    log.rows = rows.into_iter().map(|(_, row)| row).collect();
    log.resolve(&places(&labels, path, anchors)?);
    Ok((log, found))
}

/// Reads a log with a line or a column per anchor; `None` if it is of another kind.
fn of_radio(
    path: &Path,
    bytes: &[u8],
    anchors: &Anchors,
    options: &Options,
) -> Result<Option<(RangeLog, Found)>, Error> {
    let read = ranging::read(bytes, &anchors.names, options);
    let read = read.map_err(|error| table::refused(path, &error))?;
    Ok(read.map(|read| {
        let row = |range: &ranging::Range| RangeRow {
            time_us: range.time_us,
            anchor: range.anchor,
            range: Some(range.metres),
        };
        let exchange = |it: &ranging::Exchange| RangeRow {
            time_us: it.time_us,
            anchor: it.anchor,
            range: Exchange::new(it.stamps).metres(it.level_dbm),
        };
        let rows = read.ranges.iter().map(row).chain(read.exchanges.iter().map(exchange)).collect();
        let difference = |&ranging::Difference { time_us, anchors, metres }: &_| Difference {
            time_us,
            anchors,
            metres,
        };
        let differences = read.differences.iter().map(difference).collect();
        let found = Found { import: vec![read.conclusion], warnings: read.damage.sentences() };
        (RangeLog { rows, differences, unlisted: read.unlisted, without: 0 }, found)
    }))
}

/// Reads the log of a tag put down at points: CSV with columns `point,k,anchor,range`, where k counts epochs of 0.1 s.
/// The logs are sorted by point.
///
/// # Errors
/// An error that names the file, the line, and what was expected there.
pub fn read_static(
    path: &Path,
    anchors: &Anchors,
    options: &Options,
) -> Result<(BTreeMap<String, RangeLog>, Found), Error> {
    let (mut logs, mut labels) = (BTreeMap::<String, RangeLog>::new(), Labels::default());
    let found = table::read_log(
        path,
        &Log { what: "ranges", usual_step_s: None, options },
        |header| header.require(["point", "k", "anchor", "range"]),
        |&[point, k, anchor, range], row| {
            let epoch = row.number("k", k)?;
            if epoch.fract() != 0.0 || !(0.0..=LAST_EPOCH).contains(&epoch) {
                let found = printable(&row.text(k));
                return Err(row.line.error(format!("expected a count of epochs, found {found}")));
            }
            let range = optional_range(row, range)?;
            let log = logs.entry(row.text(point).into_owned()).or_default();
            log.add(epoch as i64 * EPOCH_US, labels.index(&row.text(anchor)), range);
            Ok(())
        },
    )?;
    let places = places(&labels, path, anchors)?;
    for log in logs.values_mut() {
        log.resolve(&places);
    }
    Ok((logs, found))
}

/// The range in a field; `None` if it is empty. Radios log implausible values: every number is read, and [`RangeLog`]
/// and the tracker refuse what is not a distance.
fn optional_range(row: &Row<'_>, column: Column) -> Result<Option<f64>, Error> {
    if row.is_empty(column) {
        return Ok(None);
    }
    row.any_number(column).map(Some).ok_or_else(|| {
        let found = printable(&row.text(column));
        row.line.error(format!("expected a range or nothing in column range, found {found}"))
    })
}
