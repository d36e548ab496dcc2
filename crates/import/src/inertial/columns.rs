//! Which columns are time, accelerometer and gyroscope, and which units are claimed for them.

use super::by_name::{sensors_by_name, time_by_name};
use super::conclusion::Source;
use crate::error::{Error, quoted};
use crate::formats::{Description, Format};
use crate::layout::Kind;
use crate::names::{self, Meaning};
use crate::options::{Columns as Picks, Options, Pick, ROLES, TimeUnit};
use crate::table::Table;
use crate::unit::{Quantity, Unit};

/// What is claimed about a unit.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Claim {
    /// The unit is stated.
    Said(Unit, Source),
    /// The unit is usual: it applies unless the data contradict it.
    Usual(Unit, Source),
    /// No unit is claimed.
    None,
}

impl Claim {
    fn or(self, other: impl FnOnce() -> Self) -> Self {
        if self == Self::None { other() } else { self }
    }
}

/// The column that an axis is read from, possibly with its sign reversed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Axis {
    pub(crate) column: usize,
    pub(crate) is_negative: bool,
}

/// The columns of an inertial log.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Columns {
    /// The time column; `None` if samples are only numbered.
    pub(crate) time: Option<usize>,
    /// The axes of the accelerometer, then those of the gyroscope.
    pub(crate) sensors: [Axis; 6],
    /// The claims about the units of acceleration, rate and time.
    pub(crate) claims: [Claim; 3],
    /// Whether options select the sensors' columns.
    pub(crate) axes_are_said: bool,
    /// Whether options select any column.
    pub(crate) are_said: bool,
    /// How the columns were determined.
    pub(crate) source: Source,
}

/// The header of this project's own logs, whose units are s, m/s² and rad/s.
const PLAIN: [&str; 7] = ROLES;

impl Columns {
    /// Finds the columns of a table.
    ///
    /// # Errors
    /// Which column is missing, or which two match the same role, and the option that decides.
    pub(crate) fn find(
        table: &Table,
        format: Option<Format>,
        options: &Options,
    ) -> Result<Self, Error> {
        let description = format.map(Format::description);
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
            are_said: picks.picks.iter().any(Option::is_some),
            source,
        };
        if is_bare(table, options) && description.is_none_or(|known| known.is_a_guess) {
            columns.source = Source::Data;
        }
        columns.claims = claims(table, options, description, &columns, &meanings, is_plain);
        Ok(columns)
    }
}

/// Whether a table has no names at all and no option says which column is which.
///
/// The usual order is then assumed, and the units are left to the data, which contradict it if it is wrong.
fn is_bare(table: &Table, options: &Options) -> bool {
    let is_said = options.columns.picks.iter().any(Option::is_some);
    !table.has_names() && table.columns.len() >= ROLES.len() && options.format.is_none() && !is_said
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
            _ => options.units.time.as_ref().map(|unit| match unit {
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
            _ => Claim::Usual(Unit::new(1.0, "s"), Source::Header),
        };
        said.or(by_format).or(by_header).or(usual)
    })
}

/// The claim that a format makes about a unit.
fn claim_of(known: &Description, quantity: Quantity, table: &Table, time: Option<usize>) -> Claim {
    let text = match quantity {
        Quantity::Acceleration => known.acceleration,
        Quantity::Rate => known.rate,
        _ => {
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

/// The claim that the column names make about a unit, if they agree.
fn claim_of_header(
    table: &Table,
    columns: &Columns,
    meanings: &[Option<Meaning>],
    quantity: Quantity,
) -> Claim {
    let of = |column: usize| Unit::clone(meanings.get(column)?.as_ref()?.unit.as_ref()?).into();
    let of = |column: usize| -> Option<Unit> { of(column) };
    let unit = match quantity {
        Quantity::Acceleration => of(columns.sensors[0].column),
        Quantity::Rate => of(columns.sensors[3].column),
        _ => columns.time.and_then(|time| {
            let is_number = table.columns[time].kind == Kind::Number;
            if is_number { of(time) } else { Some(Unit::new(1e-6, "dates or times of day")) }
        }),
    };
    // The unit may stand at the first axis alone, or at each axis.
    let others = match quantity {
        Quantity::Acceleration => &columns.sensors[1..3],
        Quantity::Rate => &columns.sensors[4..6],
        _ => &[][..],
    };
    let disagrees =
        others.iter().any(|axis| of(axis.column).is_some_and(|other| Some(other) != unit));
    unit.filter(|_| !disagrees).map_or(Claim::None, |unit| Claim::Said(unit, Source::Header))
}

/// The column that an option selects, if one does.
pub(super) fn pick(table: &Table, picks: &Picks, role: usize) -> Result<Option<Axis>, Error> {
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

/// The names of a table's columns, for an error message.
pub(super) fn found(table: &Table) -> String {
    const MOST: usize = 12;
    let names: Vec<_> = table.columns.iter().map(|column| column.name.as_str()).collect();
    let dots = if names.len() > MOST { ", …" } else { "" };
    let list = names[..names.len().min(MOST)].join(", ").replace(char::is_control, "?");
    let list: String = list.chars().take(200).collect();
    if table.has_names() {
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
    // A format without names gives column numbers.
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
