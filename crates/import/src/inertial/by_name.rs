//! Finds columns by their names.

use super::columns::{Axis, found, pick};
use crate::error::{Error, quoted};
use crate::layout::Kind;
use crate::names::Meaning;
use crate::options::Columns as Picks;
use crate::table::Table;
use crate::unit::Quantity;

/// The time column: the plain name is preferred, then names with known units.
pub(super) fn time_by_name(table: &Table, meanings: &[Option<Meaning>]) -> Result<usize, Error> {
    let is_time = |&place: &usize| {
        meanings[place].as_ref().is_some_and(|meaning| meaning.quantity == Quantity::Time)
            && table.columns[place].kind != Kind::Words
            && table.columns[place].values.iter().any(|value| value.is_finite())
    };
    let times: Vec<_> = (0..meanings.len()).filter(is_time).collect();
    // The plain name first, then names with a known unit, then the order of the table of names.
    let rank = |&place: &usize| {
        let alias = meanings[place].as_ref().map(|meaning| (meaning.unit.is_none(), meaning.alias));
        (table.columns[place].name != "t", alias)
    };
    let best = times.iter().copied().min_by_key(rank);
    if let Some(best) = best {
        let twin = times
            .iter()
            .find(|&&other| other != best && table.columns[other].name == table.columns[best].name);
        if twin.is_some() {
            return Err(two(table, &table.columns[best].name));
        }
    }
    best.ok_or_else(|| {
        Error::undecided(
            format!("expected a column of time such as t, found {}", found(table)),
            "--columns t=NAME, or for samples of a known rate --units t=100Hz,",
        )
    })
}

fn two(table: &Table, name: &str) -> Error {
    Error::line(table.header.unwrap_or(1), format!("expected one column {name}, found two"))
}

/// The columns of accelerometer and gyroscope, three each that share a name.
pub(super) fn sensors_by_name(
    table: &Table,
    meanings: &[Option<Meaning>],
    picks: &Picks,
) -> Result<[Axis; 6], Error> {
    let mut sensors = [Axis { column: 0, is_negative: false }; 6];
    for (from, quantity) in [(0, Quantity::Acceleration), (3, Quantity::Rate)] {
        let picked = [1, 2, 3].map(|role| pick(table, picks, from + role));
        let [x, y, z] = picked;
        let picked = [x?, y?, z?];
        let by_name = if picked.iter().all(Option::is_some) {
            [0; 3]
        } else {
            sensor_by_name(table, meanings, quantity, picked)?
        };
        for axis in 0..3 {
            sensors[from + axis] =
                picked[axis].unwrap_or(Axis { column: by_name[axis], is_negative: false });
        }
    }
    Ok(sensors)
}

/// The three columns that share a name of the sensor, if exactly one such name exists.
fn sensor_by_name(
    table: &Table,
    meanings: &[Option<Meaning>],
    quantity: Quantity,
    picked: [Option<Axis>; 3],
) -> Result<[usize; 3], Error> {
    let (sensor, role) = match quantity {
        Quantity::Acceleration => ("an accelerometer", "a"),
        _ => ("a gyroscope", "g"),
    };
    let option = format!("--columns {role}x=NAME,{role}y=NAME,{role}z=NAME");
    let of = |alias: usize, axis: usize| {
        let is_it = move |meaning: &Option<Meaning>| {
            meaning.as_ref().is_some_and(|meaning| {
                (meaning.quantity, meaning.alias, meaning.axis) == (quantity, alias, axis)
            })
        };
        meanings.iter().enumerate().filter(move |(_, meaning)| is_it(meaning)).map(|(at, _)| at)
    };
    let mut aliases: Vec<_> =
        meanings.iter().flatten().filter(|m| m.quantity == quantity).map(|m| m.alias).collect();
    aliases.sort_unstable();
    aliases.dedup();
    let is_whole = |alias: &usize| {
        (0..3).all(|axis| picked[axis].is_some() || of(*alias, axis).next().is_some())
    };
    let whole: Vec<_> = aliases.iter().copied().filter(is_whole).collect();
    // The plain names, `ax` and `gx`, are the first alias.
    let alias = match whole[..] {
        [alias] => alias,
        [0, ..] => 0,
        [] => {
            let missing = aliases.first().and_then(|&alias| {
                (0..3).find(|&axis| picked[axis].is_none() && of(alias, axis).next().is_none())
            });
            let what = match missing {
                Some(axis) => {
                    format!("a column {role}{} beside the others of {sensor}", &"xyz"[axis..=axis])
                }
                None => format!("columns of {sensor} such as {role}x, {role}y, {role}z"),
            };
            return Err(Error::undecided(
                format!("expected {what}, found {}", found(table)),
                option,
            ));
        }
        _ => {
            let problem = format!(
                "expected columns of one sensor that is {sensor}, found those of {}",
                whole.len()
            );
            return Err(Error::undecided(problem, option));
        }
    };
    let mut columns = [0; 3];
    for axis in (0..3).filter(|&axis| picked[axis].is_none()) {
        let mut places = of(alias, axis);
        let place = places.next().unwrap_or_default();
        if let Some(other) = places.next() {
            let [one, other] = [place, other].map(|place| table.columns[place].name.as_str());
            if one == other {
                return Err(two(table, one));
            }
            let problem = format!(
                "expected one column {role}{}, found {} and {}",
                &"xyz"[axis..=axis],
                quoted(one),
                quoted(other)
            );
            return Err(Error::undecided(problem, option));
        }
        columns[axis] = place;
    }
    Ok(columns)
}
