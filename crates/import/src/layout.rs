//! The beginning of a table: its header, a line of units, its first row.

use std::borrow::Cow;

use crate::dialect::{Dialect, Separator};
use crate::error::Error;
use crate::moment::{self, Moment};
use crate::text::{Text, letters};
use crate::unit;

/// The number of rows that are looked at to detect what a column holds.
const SAMPLE: usize = 200;

/// What a column holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Kind {
    /// Numbers.
    Number,
    /// Dates with times, as microseconds since 1970.
    Date,
    /// Times of day, as microseconds since midnight.
    TimeOfDay,
    /// Anything else; it is not kept.
    Words,
}

/// The layout of a table's beginning.
#[derive(Debug, Clone)]
pub(crate) struct Layout {
    pub(crate) dialect: Dialect,
    /// The line of the header, if there is one.
    pub(crate) header: Option<usize>,
    /// The line of the first row.
    pub(crate) first_row: usize,
    pub(crate) names: Vec<String>,
    pub(crate) units: Vec<Option<String>>,
    pub(crate) kinds: Vec<Kind>,
    /// The line number and words directly above the rows, if these are not a header with as many names as columns.
    pub(crate) other_header: Option<(usize, Vec<String>)>,
}

impl Layout {
    pub(crate) fn find(text: &Text<'_>) -> Result<Self, Error> {
        let nothing = || Error::log("expected a table of numbers, found none");
        let (dialect, width) = Dialect::find(text).ok_or_else(nothing)?;
        let is_row = |bytes: &[u8]| {
            let (fields, numbers) = dialect.row(bytes);
            !dialect.is_comment(bytes) && fields == width && numbers * 2 >= width
        };
        let first = text.lines().find(|line| is_row(line.bytes)).ok_or_else(nothing)?;
        let above: Vec<_> = text.lines().take_while(|line| line.number < first.number).collect();
        let names = |bytes: &[u8]| header_names(dialect, width, bytes, width / 2 + 1);
        let mut layout = Self {
            dialect,
            header: None,
            first_row: first.number,
            names: (1..=width).map(|number| number.to_string()).collect(),
            units: vec![None; width],
            kinds: kinds(text, dialect, width, first.number),
            other_header: None,
        };
        // A line of units follows the names; a header may be the last comment. Between them and the first whole row may be others,
        // such as those with a note in a column that is mostly empty.
        let is_data = |bytes: &[u8]| {
            let (fields, numbers) = dialect.row(bytes);
            fields > 1 && numbers * 2 >= fields
        };
        let lines = above.iter().rev().skip_while(|line| is_data(line.bytes));
        let mut lines = lines.map(|line| (line.number, line.bytes));
        let mut nearest = lines.next();
        if let (Some(units), Some((number, bytes))) = (
            nearest.and_then(|(_, bytes)| units_line(header_names(dialect, width, bytes, 2)?)),
            lines.next(),
        ) && names(bytes).is_some()
        {
            layout.units = units;
            nearest = Some((number, bytes));
        }
        if let Some((number, bytes)) = nearest {
            match names(bytes) {
                Some(names) => (layout.header, layout.names) = (Some(number), names),
                None => layout.other_header = Some((number, any_names(bytes))),
            }
        }
        Ok(layout)
    }
}

/// The names in a header of `width` columns, if the line is one: no field is a number, and at least `least` fields are
/// not empty.
fn header_names(dialect: Dialect, width: usize, bytes: &[u8], least: usize) -> Option<Vec<String>> {
    let mut bytes = bytes;
    while let [b'#' | b'%' | b'/' | b' ' | b';', rest @ ..] = bytes {
        bytes = rest;
    }
    // Names may contain blanks, and their separator may differ from that of the numbers.
    let separators = [dialect.separator, Separator::Tab, Separator::Comma, Separator::Semicolon];
    separators.into_iter().find_map(|separator| {
        let fields = Dialect::new(separator, false).fields(bytes);
        let fields = match fields.split_last() {
            Some((last, fields)) if fields.len() == width && last.is_empty() => fields,
            _ => &fields,
        };
        let named = fields.iter().filter(|field| !field.is_empty()).count();
        let is_number = |field: &Cow<'_, [u8]>| fast_float2::parse::<f64, _>(field).is_ok();
        let is_header = fields.len() == width && named >= least && !fields.iter().any(is_number);
        is_header.then(|| fields.iter().map(|field| letters(field)).collect())
    })
}

/// The words of a line, whatever separates them.
fn any_names(bytes: &[u8]) -> Vec<String> {
    let text = letters(bytes);
    let words = text.split([',', ';', '\t', ' ']).map(|word| word.trim().to_owned());
    words.filter(|word| !word.is_empty()).collect()
}

/// The units of a line that consists of units, and of no number, and of which at least half of the words are known. (Some units are
/// written as numbers: 1e7.)
pub(crate) fn units_line(fields: Vec<String>) -> Option<Vec<Option<String>>> {
    let fields: Vec<_> = fields
        .into_iter()
        .map(|field| field.trim_matches(['[', ']', '(', ')']).to_owned())
        .map(|field| Some(field).filter(|field| !field.is_empty() && field != "-"))
        .collect();
    let words = || fields.iter().flatten();
    let is_number = |word: &String| fast_float2::parse::<f64, _>(word).is_ok();
    let known = words().filter(|word| unit::is_known(word)).count();
    let is_row = words().any(|word| is_number(word) && !unit::is_known(word));
    (known > 0 && known * 2 >= words().count() && !is_row).then_some(fields)
}

/// What most rows hold in each column.
fn kinds(text: &Text<'_>, dialect: Dialect, width: usize, first_row: usize) -> Vec<Kind> {
    let mut counts = vec![[0_usize; 4]; width];
    let rows = text.lines().skip_while(|line| line.number < first_row);
    for line in rows.filter(|line| !dialect.is_comment(line.bytes)).take(SAMPLE) {
        for (count, field) in counts.iter_mut().zip(dialect.fields(line.bytes)) {
            let kind = match moment::read(&field) {
                _ if field.is_empty() => continue,
                _ if dialect.number(&field).is_some() => 0,
                Some(Moment::Date(_)) => 1,
                Some(Moment::OfDay(_)) => 2,
                None => 3,
            };
            count[kind] += 1;
        }
    }
    let kind = |count: [usize; 4]| {
        let most = count.iter().max().copied().unwrap_or(0);
        let place = count.iter().position(|&count| count == most).unwrap_or(0);
        [Kind::Number, Kind::Date, Kind::TimeOfDay, Kind::Words][place]
    };
    counts.into_iter().map(kind).collect()
}
