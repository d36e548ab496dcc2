//! Tables whose rows are not ranges: the six timestamps of an exchange, or how much farther one anchor is than another.

use std::borrow::Cow;

use super::tags::TagColumn;
use super::{Found, USUAL_STEP, keep_one_tag};
use crate::clock::unit_of_range_times;
use crate::damage::{Damage, Fault};
use crate::error::{Error, quoted};
use crate::heading::{Heading, Place};
use crate::named::NamedTable;
use crate::options::Options;
use crate::text::{Text, letters};
use crate::unit::Unit;

/// The columns of the timestamps: poll, response and final message, each sent and received.
const STAMPS: [&str; 6] = ["t1", "t2", "t3", "t4", "t5", "t6"];
/// The names that Crazyflie's client gives to the difference of two anchors.
const CRAZYFLIE: [&str; 2] = ["tdoa2.d", "tdoa3.d"];
/// The end of the counter's range of 40 bits.
const END: u64 = 1 << 40;

/// The columns of a table.
#[derive(Debug)]
enum Form {
    Stamps {
        anchor: Place,
        stamps: Box<[Place; 6]>,
        level: Option<Place>,
    },
    Differences {
        anchors: [Place; 2],
        difference: Place,
    },
    /// One column for each pair of anchors.
    Pairs(Vec<(usize, [String; 2])>),
}

/// Reads such a table; `None` if it is not one.
pub(super) fn read(
    text: &Text<'_>,
    options: &Options,
) -> Result<Option<(Found, String, Damage)>, Error> {
    let found = NamedTable::find(text, options, |heading| {
        let time = heading.find("t").ok().flatten();
        let tag = TagColumn::find(heading);
        time.zip(form(heading)).map(|(time, form)| (time, tag, form)).ok_or(())
    });
    let Some(Ok((table, (time, tag, form)))) = found else { return Ok(None) };
    let mut damage = Damage { end_may_be_cut: !text.ends_with_line_break(), ..Damage::default() };
    let (mut rows, mut total, mut are_moments) = (Vec::new(), 0, false);
    for (line, fields) in table.rows() {
        total += 1;
        let field = fields.get(time.column).map(AsRef::as_ref).unwrap_or_default();
        let moment = table.moment(field);
        are_moments |= moment.is_some();
        let seconds = moment.or_else(|| table.count(field));
        let is_whole = fields.len() == table.heading.names().len();
        let said = seconds.filter(|_| is_whole).zip(said(&table, &form, &fields));
        let Some((seconds, said)) = said else {
            damage.add(Fault::Torn, line, || {
                let words: Vec<_> = fields.iter().map(|field| letters(field)).collect();
                format!("expected {}, found {}", form.row(), quoted(&words.join(" ")))
            });
            continue;
        };
        rows.push((tag.of(&fields), seconds, said));
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
    let mut before = Vec::new();
    for (_, seconds, said) in rows {
        let time_us = (seconds * unit.scale * 1e6).round() as i64;
        match said {
            Said::Nothing => {}
            Said::Exchange { anchor, stamps, level_dbm } => {
                found.add_exchange(time_us, &anchor, stamps, level_dbm);
            }
            Said::Differences(differences) => {
                // A client that logs several values at its own rate repeats those that are not new.
                let are_many = differences.len() > 1;
                for difference in &differences {
                    if !(are_many && before.contains(difference)) {
                        let (anchors, metres) = difference;
                        found.add_difference(time_us, anchors, *metres);
                    }
                }
                before = differences;
            }
        }
    }
    Ok(Some((found, format!("{}, time in {unit}: {from}", form.title()), damage)))
}

/// The content of a row.
#[derive(Debug)]
enum Said {
    /// A row without data: a message was lost.
    Nothing,
    Exchange {
        anchor: String,
        stamps: [u64; 6],
        level_dbm: Option<f64>,
    },
    Differences(Vec<([String; 2], f64)>),
}

impl Form {
    fn title(&self) -> String {
        match self {
            Self::Stamps { level: None, .. } => "six stamps of each exchange".to_owned(),
            Self::Stamps { level: Some(level), .. } => {
                format!("six stamps of each exchange, corrected by the level {}", level.name)
            }
            Self::Differences { .. } | Self::Pairs(_) => {
                "how much farther the second anchor is than the first".to_owned()
            }
        }
    }

    fn row(&self) -> &'static str {
        match self {
            Self::Stamps { .. } => "a time, an anchor and six whole numbers below 2^40",
            Self::Differences { .. } => "a time, two anchors and a difference",
            Self::Pairs(_) => "a time and differences",
        }
    }
}

fn form(heading: &Heading<'_>) -> Option<Form> {
    let find = |name| heading.find(name).ok().flatten();
    if let (Some(one), Some(other), Some(difference)) =
        (find("anchor_a"), find("anchor_b"), find("difference"))
    {
        return Some(Form::Differences { anchors: [one, other], difference });
    }
    let stamps: Vec<_> = STAMPS.iter().filter_map(|name| find(name)).collect();
    if let (Some(anchor), Ok(stamps)) = (find("anchor"), <[Place; 6]>::try_from(stamps)) {
        return Some(Form::Stamps { anchor, stamps: Box::new(stamps), level: find("rx_dbm") });
    }
    let pair = |(at, name): (usize, &String)| {
        let behind = CRAZYFLIE.iter().find_map(|before| name.strip_prefix(before))?;
        let (one, other) = behind.split_once('-')?;
        let are_numbers = [one, other].iter().all(|it| it.parse::<u8>().is_ok());
        are_numbers.then(|| (at, [one.to_owned(), other.to_owned()]))
    };
    let pairs: Vec<_> = heading.names().iter().enumerate().filter_map(pair).collect();
    (!pairs.is_empty()).then_some(Form::Pairs(pairs))
}

/// The content of a row; `None` if it is damaged.
fn said(table: &NamedTable<'_>, form: &Form, fields: &[Cow<'_, [u8]>]) -> Option<Said> {
    let field = |at: usize| fields.get(at).map(AsRef::as_ref).unwrap_or_default();
    let number = |at: usize| table.number(field(at)).filter(|number| number.is_finite());
    match form {
        Form::Stamps { anchor, stamps, level } => {
            if stamps.iter().any(|stamp| field(stamp.column).is_empty()) {
                return Some(Said::Nothing);
            }
            let mut read = [0; 6];
            for (read, place) in read.iter_mut().zip(stamps.iter()) {
                *read = stamp(table, field(place.column))?;
            }
            let level_dbm = level.as_ref().and_then(|place| number(place.column));
            let anchor = letters(field(anchor.column));
            Some(Said::Exchange { anchor, stamps: read, level_dbm })
        }
        Form::Differences { anchors, difference } => {
            if field(difference.column).is_empty() {
                return Some(Said::Nothing);
            }
            let metres = number(difference.column)? * difference.scale();
            let names = [0, 1].map(|i| letters(field(anchors[i].column)));
            Some(Said::Differences(vec![(names, metres)]))
        }
        Form::Pairs(pairs) => {
            let heard = pairs.iter().filter_map(|(at, names)| Some((names.clone(), number(*at)?)));
            Some(Said::Differences(heard.filter(|(_, metres)| *metres != 0.0).collect()))
        }
    }
}

/// A reading of the counter, in decimal or as `0x…`.
fn stamp(table: &NamedTable<'_>, field: &[u8]) -> Option<u64> {
    let words = letters(field);
    let words = words.trim();
    let ticks = if let Some(digits) = words.strip_prefix("0x").or_else(|| words.strip_prefix("0X"))
    {
        u64::from_str_radix(digits, 16).ok()?
    } else {
        let number = table.number(field)?;
        let is_whole = number.fract() == 0.0 && (0.0..END as f64).contains(&number);
        if !is_whole {
            return None;
        }
        number as u64
    };
    (ticks < END).then_some(ticks)
}
