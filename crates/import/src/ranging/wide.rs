//! Tables with one column for each anchor.

use super::labels::place;
use super::tags::TagColumn;
use super::{Found, USUAL_STEP, keep_one_tag};
use crate::clock::unit_of_range_times;
use crate::damage::{Damage, Fault};
use crate::error::{Error, quoted};
use crate::heading::Heading;
use crate::named::NamedTable;
use crate::names::split_unit;
use crate::options::Options;
use crate::text::{Text, letters};
use crate::unit::{Quantity, Unit};

/// The smallest number of range columns; a table with fewer is taken for something else.
const FEWEST: usize = 2;
/// The words that may precede an anchor's name in that of a column.
const BEFORE: [&str; 10] =
    ["ranging.distance", "distance", "ranging", "range", "dist", "anchor", "rng", "anc", "d", "r"];

/// Those among them that may also precede the number of a column with the anchor's name.
const NAMES: [&str; 2] = ["anchor", "anc"];

/// A column of ranges.
struct Ranges {
    at: usize,
    label: String,
    scale: f64,
    /// The word for a range that precedes the label, if there is one.
    stem: Option<&'static str>,
    /// Whether the anchor is in the list.
    is_listed: bool,
}

/// Reads a table with one column for each anchor; `None` if it is not one.
pub(super) fn read(
    text: &Text<'_>,
    anchors: &[String],
    options: &Options,
) -> Result<Option<(Found, String, Damage)>, Error> {
    let found = NamedTable::find(text, options, |heading| {
        let time = heading.find("t").ok().flatten();
        let ranges = columns(heading, anchors, options);
        let is_wide = ranges.iter().filter(|it| it.is_listed).count() >= FEWEST
            && !heading.names().iter().any(|name| name == "anchor");
        let tag = TagColumn::find(heading);
        time.filter(|_| is_wide).map(|time| (time, tag, ranges)).ok_or(())
    });
    let Some(Ok((table, (time, tag, columns)))) = found else { return Ok(None) };
    one_each(&table.heading, &columns, anchors)?;
    let mut damage = Damage { end_may_be_cut: !text.ends_with_line_break(), ..Damage::default() };
    let (mut rows, mut total, mut are_moments) = (Vec::new(), 0, false);
    for (line, fields) in table.rows() {
        total += 1;
        let field = fields.get(time.column).map(AsRef::as_ref).unwrap_or_default();
        let moment = table.moment(field);
        are_moments |= moment.is_some();
        let seconds = moment.or_else(|| table.count(field));
        let (true, Some(seconds)) = (fields.len() == table.heading.names().len(), seconds) else {
            damage.add(Fault::Torn, line, || {
                let (expected, found) = (table.heading.names().len(), fields.len());
                let field = quoted(&letters(field));
                format!("expected {expected} fields with a time, found {found} and {field}")
            });
            continue;
        };
        let range = |column: &Ranges| {
            let metres = table.number(fields.get(column.at)?)? * column.scale;
            metres.is_finite().then_some(metres)
        };
        rows.push((tag.of(&fields), seconds, columns.iter().map(range).collect::<Vec<_>>()));
    }
    damage.accept(total, options.strict)?;
    keep_one_tag(&mut rows, |(tag, ..)| tag, options.topic.as_deref())?;
    let (unit, from) = match &time.unit {
        _ if are_moments => (Unit::new(1.0, "s"), "from the data"),
        Some(unit) => (unit.clone(), "header"),
        None => (
            unit_of_range_times(rows.iter().map(|(_, time, _)| *time), USUAL_STEP)?,
            "from the data",
        ),
    };
    let mut found = Found::default();
    for (_, time, ranges) in &rows {
        for (column, range) in columns.iter().zip(ranges) {
            if let Some(range) = range {
                found.add((time * unit.scale * 1e6).round() as i64, &column.label, *range);
            }
        }
    }
    let names: Vec<_> =
        columns.iter().map(|column| table.heading.names()[column.at].as_str()).collect();
    let conclusion = format!("a column an anchor ({}), time in {unit}: {from}", names.join(", "));
    Ok(Some((found, conclusion, damage)))
}

/// The columns whose names refer to an anchor of the list, alone or behind a word for a range; and those with other
/// numbers behind the same word, which are ranges to unlisted anchors.
fn columns(heading: &Heading<'_>, anchors: &[String], options: &Options) -> Vec<Ranges> {
    let said = options.units.of("range");
    let names = heading.names().iter().enumerate();
    let column = |(at, name): (usize, &String)| {
        let (base, unit) = taken_apart(name);
        let below = heading.unit_below(at, Quantity::Length).ok().flatten();
        let scale = said.as_ref().or(unit.as_ref()).or(below.as_ref()).map_or(1.0, |it| it.scale);
        let (label, stem, is_listed) = label(base, anchors)?;
        Some(Ranges { at, label, scale, stem, is_listed })
    };
    let mut columns: Vec<_> = names.filter_map(column).collect();
    let listed = columns.iter().filter(|it| it.is_listed).map(|it| it.stem);
    let stems: Vec<_> = listed.flatten().collect();
    columns.retain(|it| it.is_listed || it.stem.is_some_and(|stem| stems.contains(&stem)));
    // Beside `distance0`, a column `anchor0` names the anchor that it is to.
    let has_other = columns.iter().any(|it| it.stem.is_some_and(|stem| !NAMES.contains(&stem)));
    columns.retain(|it| !(has_other && it.stem.is_some_and(|stem| NAMES.contains(&stem))));
    columns
}

/// Refuses two columns of one anchor.
fn one_each(heading: &Heading<'_>, columns: &[Ranges], anchors: &[String]) -> Result<(), Error> {
    for (place, column) in columns.iter().enumerate() {
        let own = self::place(&column.label, anchors);
        let is_same = |it: &&Ranges| {
            it.label == column.label || own.is_some() && self::place(&it.label, anchors) == own
        };
        if let Some(other) = columns[..place].iter().find(is_same) {
            let [one, other] = [other, column].map(|it| quoted(&heading.names()[it.at]));
            let label = quoted(&column.label);
            return Err(Error::line(
                heading.line,
                format!("expected one column of ranges to anchor {label}, found {one} and {other}"),
            ));
        }
    }
    Ok(())
}

/// Splits a name from the unit in brackets or behind it.
fn taken_apart(name: &str) -> (&str, Option<Unit>) {
    let (base, bracket) = split_unit(name);
    if let Some(unit) = bracket.and_then(|text| Unit::read(Quantity::Length, text)) {
        return (base, Some(unit));
    }
    match name.rsplit_once(['_', ' ']) {
        Some((base, text)) if Unit::read(Quantity::Length, text).is_some() => {
            (base, Unit::read(Quantity::Length, text))
        }
        _ => (name, None),
    }
}

/// The anchor that a column's name refers to, the word for a range before it, and whether the anchor is in the list.
fn label(name: &str, anchors: &[String]) -> Option<(String, Option<&'static str>, bool)> {
    let is_anchor = |text: &str| anchors.iter().any(|anchor| anchor.eq_ignore_ascii_case(text));
    let bare = |text: &str| text.trim_matches(|letter: char| !letter.is_alphanumeric()).to_owned();
    if is_anchor(name) {
        return Some((name.to_owned(), None, true));
    }
    let lower = name.to_ascii_lowercase();
    BEFORE.iter().find_map(|before| {
        let behind =
            bare(name.get(lower.strip_prefix(before).map(|rest| lower.len() - rest.len())?..)?);
        let is_number = !behind.is_empty() && behind.bytes().all(|byte| byte.is_ascii_digit());
        let is_listed = is_anchor(&behind) || is_number && place(&behind, anchors).is_some();
        (is_listed || is_number).then_some((behind, Some(*before), is_listed))
    })
}
