//! Which columns are time, accelerometer and gyroscope, and what is claimed of their units.

use super::conclusion::Source;
use crate::error::{Error, quoted};
use crate::formats::Description;
use crate::layout::Kind;
use crate::names::{self, Meaning};
use crate::options::{Columns as Picks, Options, Pick, ROLES, TimeUnit};
use crate::table::Table;
use crate::unit::{Quantity, Unit};

/// What is claimed of a unit.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Claim {
    /// Somebody says so.
    Said(Unit, Source),
    /// It is so unless the data disagree.
    Usual(Unit, Source),
    /// Nothing is.
    None,
}

impl Claim {
    fn or(self, other: impl FnOnce() -> Self) -> Self {
        if self == Self::None { other() } else { self }
    }
}

/// Where a value comes from: a column, as it is or turned round.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Axis {
    pub(crate) column: usize,
    pub(crate) is_negative: bool,
}

/// The columns of a log.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Columns {
    /// None if the place of a sample in the log is its time.
    pub(crate) time: Option<usize>,
    /// Of the accelerometer, then of the gyroscope.
    pub(crate) sensors: [Axis; 6],
    /// Of acceleration, rate and time.
    pub(crate) claims: [Claim; 3],
    /// Whether options say which columns the gyroscope's are.
    pub(crate) axes_are_said: bool,
    /// What told which columns they are.
    pub(crate) source: Source,
}

/// The header of today's own logs, whose units are s, m/s² and rad/s.
const PLAIN: [&str; 7] = ROLES;

impl Columns {
    /// Finds the columns of a table.
    ///
    /// # Errors
    /// Which column is missing, or which two claim to be the same, and what decides.
    pub(crate) fn find(table: &Table, options: &Options) -> Result<Self, Error> {
        let format = options.format.or_else(|| crate::formats::Format::of(table));
        let description = format.map(crate::formats::Format::description);
        let source = format.map_or(Source::Header, Source::Format);
        let meanings: Vec<_> = table
            .columns
            .iter()
            .map(|column| meaning_of(&column.name, column.unit.as_deref()))
            .collect();
        let picks = &options.columns;
        let sensors = match description {
            Some(known) => sensors_of_format(table, known, picks)?,
            None if is_bare(table, options) => sensors_by_place(),
            None => sensors_by_name(table, &meanings, picks)?,
        };
        let counted = matches!(options.units.time, Some(TimeUnit::Rate(_)));
        let time = match (description, pick(table, picks, 0)?) {
            (_, Some(axis)) => Some(axis.column),
            (_, None) if counted => None,
            (Some(known), None) => Some(time_of_format(table, known)?),
            (None, None) if is_bare(table, options) => Some(0),
            (None, None) => Some(time_by_name(table, &meanings)?),
        };
        let is_plain = format.is_none()
            && PLAIN.iter().all(|name| table.columns.iter().any(|column| column.name == *name))
            && picks.picks.iter().all(Option::is_none);
        let mut columns = Self {
            time,
            sensors,
            claims: [Claim::None, Claim::None, Claim::None],
            axes_are_said: picks.picks[1..].iter().any(Option::is_some),
            source,
        };
        if is_bare(table, options) {
            columns.source = Source::Data;
        }
        columns.claims = claims(table, options, description, &columns, &meanings, is_plain);
        Ok(columns)
    }
}

/// Whether a table has no names at all, and nobody says which column is which. Then the usual order is supposed: its units
/// are left to the data, which show it wrong if it is.
fn is_bare(table: &Table, options: &Options) -> bool {
    let is_said = options.columns.picks.iter().any(Option::is_some);
    table.header.is_none()
        && table.columns.len() >= ROLES.len()
        && options.format.is_none()
        && !is_said
}

fn sensors_by_place() -> [Axis; 6] {
    std::array::from_fn(|place| Axis { column: place + 1, is_negative: false })
}

fn meaning_of(name: &str, unit: Option<&str>) -> Option<Meaning> {
    let mut meaning = names::meaning(name)?;
    if meaning.unit.is_none() {
        meaning.unit = unit.and_then(|unit| Unit::read(meaning.quantity, unit));
    }
    Some(meaning)
}

fn claims(
    table: &Table,
    options: &Options,
    description: Option<&Description>,
    columns: &Columns,
    meanings: &[Option<Meaning>],
    is_plain: bool,
) -> [Claim; 3] {
    let quantities = [Quantity::Acceleration, Quantity::Rate, Quantity::Time];
    quantities.map(|quantity| {
        let said = match quantity {
            Quantity::Acceleration => options.units.acceleration.clone(),
            Quantity::Rate => options.units.rate.clone(),
            Quantity::Time => options.units.time.as_ref().map(|unit| match unit {
                TimeUnit::Clock(unit) => unit.clone(),
                TimeUnit::Rate(rate) => Unit::new(1.0 / rate, format!("samples of {rate} Hz")),
            }),
        };
        let said = said.map_or(Claim::None, |unit| Claim::Said(unit, Source::Option));
        let by_format = || {
            description.map_or(Claim::None, |known| claim_of(known, quantity, table, columns.time))
        };
        let by_header = || claim_of_header(table, columns, meanings, quantity);
        let usual = || match quantity {
            _ if !is_plain => Claim::None,
            Quantity::Acceleration => Claim::Usual(Unit::new(1.0, "m/s²"), Source::Header),
            Quantity::Rate => Claim::Usual(Unit::new(1.0, "rad/s"), Source::Header),
            Quantity::Time => Claim::Usual(Unit::new(1.0, "s"), Source::Header),
        };
        said.or(by_format).or(by_header).or(usual)
    })
}

/// What a format says of a unit.
fn claim_of(known: &Description, quantity: Quantity, table: &Table, time: Option<usize>) -> Claim {
    let text = match quantity {
        Quantity::Acceleration => known.acceleration,
        Quantity::Rate => known.rate,
        Quantity::Time => {
            let name = time.map(|time| table.columns[time].name.as_str());
            known.time.iter().find(|(time, _)| Some(*time) == name).map_or("", |(_, unit)| unit)
        }
    };
    let source = Source::Format(known.format);
    match Unit::read_scaled(quantity, text) {
        Some(unit) if known.is_a_guess => Claim::Usual(unit, source),
        Some(unit) => Claim::Said(unit, source),
        None => Claim::None,
    }
}

/// What the names say of a unit, if they all say the same.
fn claim_of_header(
    table: &Table,
    columns: &Columns,
    meanings: &[Option<Meaning>],
    quantity: Quantity,
) -> Claim {
    let of = |column: usize| Unit::clone(meanings.get(column)?.as_ref()?.unit.as_ref()?).into();
    let of = |column: usize| -> Option<Unit> { of(column) };
    let unit = match quantity {
        Quantity::Time => columns.time.and_then(|time| {
            let is_number = table.columns[time].kind == Kind::Number;
            if is_number { of(time) } else { Some(Unit::new(1e-6, "dates or times of day")) }
        }),
        Quantity::Acceleration => of(columns.sensors[0].column),
        Quantity::Rate => of(columns.sensors[3].column),
    };
    // A unit stands at the first axis alone, or at each.
    let others = match quantity {
        Quantity::Time => &[][..],
        Quantity::Acceleration => &columns.sensors[1..3],
        Quantity::Rate => &columns.sensors[4..6],
    };
    let disagrees =
        others.iter().any(|axis| of(axis.column).is_some_and(|other| Some(other) != unit));
    unit.filter(|_| !disagrees).map_or(Claim::None, |unit| Claim::Said(unit, Source::Header))
}

/// The column that an option picks, if one does.
fn pick(table: &Table, picks: &Picks, role: usize) -> Result<Option<Axis>, Error> {
    let Some(Pick { name, is_negative }) = &picks.picks[role] else { return Ok(None) };
    let bare = |column: &str| names::split_unit(column).0.to_lowercase();
    let same =
        |test: &dyn Fn(&str) -> bool| table.columns.iter().position(|column| test(&column.name));
    let column = same(&|column| column == name)
        .or_else(|| same(&|column| column.to_lowercase() == name.to_lowercase()))
        .or_else(|| same(&|column| bare(column) == name.to_lowercase()))
        .or_else(|| {
            name.parse::<usize>().ok()?.checked_sub(1).filter(|&at| at < table.columns.len())
        });
    let column = column.ok_or_else(|| {
        Error::options(format!(
            "expected a column {} for {}, found {}",
            quoted(name),
            ROLES[role],
            found(table)
        ))
    })?;
    if table.columns[column].kind == Kind::Words {
        return Err(Error::options(format!(
            "expected numbers in column {}, found words",
            quoted(name)
        )));
    }
    Ok(Some(Axis { column, is_negative: *is_negative }))
}

/// The names of a table's columns, for a complaint.
fn found(table: &Table) -> String {
    const MOST: usize = 12;
    let names: Vec<_> = table.columns.iter().map(|column| column.name.as_str()).collect();
    let dots = if names.len() > MOST { ", …" } else { "" };
    let list = names[..names.len().min(MOST)].join(", ").replace(char::is_control, "?");
    let list: String = list.chars().take(200).collect();
    if table.header.is_some() {
        format!("{list}{dots}")
    } else {
        format!("{} columns without a header", names.len())
    }
}

fn sensors_of_format(
    table: &Table,
    known: &Description,
    picks: &Picks,
) -> Result<[Axis; 6], Error> {
    let mut sensors = [Axis { column: 0, is_negative: false }; 6];
    for (i, name) in known.sensors.iter().enumerate() {
        sensors[i] = match pick(table, picks, i + 1)? {
            Some(axis) => axis,
            None => Axis { column: column_of_format(table, known, name)?, is_negative: false },
        };
    }
    Ok(sensors)
}

fn column_of_format(table: &Table, known: &Description, name: &str) -> Result<usize, Error> {
    // A format without names tells places.
    let place = name.parse::<usize>().ok().map(|number| number - 1);
    let place = place.or_else(|| table.columns.iter().position(|column| column.name == name));
    place.filter(|&place| place < table.columns.len()).ok_or_else(|| {
        Error::log(format!("expected a column {name} of {}, found {}", known.title, found(table)))
    })
}

fn time_of_format(table: &Table, known: &Description) -> Result<usize, Error> {
    let filled = |column: usize| !table.columns[column].values.iter().all(|value| value.is_nan());
    let places = known.time.iter().filter(|(_, unit)| !unit.is_empty());
    let mut places = places.filter_map(|(name, _)| column_of_format(table, known, name).ok());
    places.find(|&column| filled(column)).ok_or_else(|| {
        Error::undecided(
            format!("expected times in {}, found samples that are only counted", known.title),
            "their rate, --units t=100Hz,",
        )
    })
}

fn time_by_name(table: &Table, meanings: &[Option<Meaning>]) -> Result<usize, Error> {
    let is_time = |&place: &usize| {
        meanings[place].as_ref().is_some_and(|meaning| meaning.quantity == Quantity::Time)
            && table.columns[place].kind != Kind::Words
            && table.columns[place].values.iter().any(|value| value.is_finite())
    };
    let times: Vec<_> = (0..meanings.len()).filter(is_time).collect();
    // The plain name first, then one whose unit is known, then in the order of the table of names.
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

fn sensors_by_name(
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

/// The three columns that share a name of the sensor, if there is one such name.
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
