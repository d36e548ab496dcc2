//! Finds the columns that a reader asks for, under the names that people commonly use.

use crate::error::{Error, listed, quoted};
use crate::names::{Named, meaning, named};
use crate::options::Options;
use crate::unit::{Quantity, Unit};

/// A column that some reader asks for, and its other names.
#[derive(Debug)]
struct Known {
    name: &'static str,
    quantity: Option<Quantity>,
    /// The other names: in lower case, without separators between words and without units.
    aliases: &'static [&'static str],
    /// Whether another name than its own counts only with a unit.
    needs_unit: bool,
}

const fn of(quantity: Quantity, name: &'static str, aliases: &'static [&'static str]) -> Known {
    Known { name, quantity: Some(quantity), aliases, needs_unit: false }
}

const fn named_only(name: &'static str, aliases: &'static [&'static str]) -> Known {
    Known { name, quantity: None, aliases, needs_unit: false }
}

/// A column of a flight: without a unit, a pitch may well be in degrees.
const fn of_flight(
    quantity: Quantity,
    name: &'static str,
    aliases: &'static [&'static str],
) -> Known {
    Known { name, quantity: Some(quantity), aliases, needs_unit: true }
}

/// The columns that readers ask for; [`crate::names`] knows time and the axes of an inertial sensor.
const KNOWN: &[Known] = &[
    named_only(
        "anchor",
        &[
            "anchorid",
            "anchorname",
            "anc",
            "ancid",
            "beacon",
            "beaconid",
            "node",
            "nodeid",
            "id",
            "name",
        ],
    ),
    of(Quantity::Length, "range", &["range", "distance", "dist", "d", "r"]),
    named_only("anchor_a", &["anchora", "ida", "firstanchor"]),
    named_only("anchor_b", &["anchorb", "idb", "secondanchor"]),
    of(
        Quantity::Length,
        "difference",
        &["difference", "diff", "tdoa", "tdoameas", "distancediff", "distancedifference"],
    ),
    named_only("t1", &["t1", "polltx", "polltxts", "pollsent"]),
    named_only("t2", &["t2", "pollrx", "pollrxts", "pollreceived"]),
    named_only("t3", &["t3", "resptx", "resptxts", "responsesent"]),
    named_only("t4", &["t4", "resprx", "resprxts", "responsereceived"]),
    named_only("t5", &["t5", "finaltx", "finaltxts", "finalsent"]),
    named_only("t6", &["t6", "finalrx", "finalrxts", "finalreceived"]),
    of(Quantity::Level, "rx_dbm", &["rx", "rxlevel", "rxpower", "rssi"]),
    of(Quantity::Length, "x", &["x", "posx", "positionx", "xpos", "xposition", "px"]),
    of(Quantity::Length, "y", &["y", "posy", "positiony", "ypos", "yposition", "py"]),
    of(Quantity::Length, "z", &["z", "posz", "positionz", "zpos", "zposition", "pz"]),
    of(Quantity::Length, "h", &["h", "height", "alt", "altitude", "agl", "relalt"]),
    of(Quantity::Angle, "lat", &["lat", "latitude", "gpslat", "gpslatitude"]),
    of(
        Quantity::Angle,
        "lon",
        &["lon", "lng", "long", "longitude", "gpslon", "gpslng", "gpslongitude"],
    ),
    of(Quantity::Angle, "heading", &["heading", "hdg", "compass", "compassheading"]),
    of(Quantity::Level, "rssi_db", &["rssi", "rss", "signal", "level", "power", "rxpower"]),
    of(Quantity::Level, "path_loss_db", &["pathloss", "loss", "pl"]),
    named_only(
        "user",
        &[
            "user",
            "userid",
            "transmitter",
            "transmitterid",
            "txid",
            "emitter",
            "collar",
            "tag",
            "tagid",
        ],
    ),
    named_only("tag", &["tag", "tagid", "tid"]),
    of(
        Quantity::Speed,
        "v_left",
        &["vleft", "vl", "left", "leftspeed", "speedleft", "leftvelocity", "velocityleft"],
    ),
    of(
        Quantity::Speed,
        "v_right",
        &["vright", "vr", "right", "rightspeed", "speedright", "rightvelocity", "velocityright"],
    ),
    of(Quantity::Length, "track", &["track", "trackwidth", "wheeltrack", "axletrack"]),
    of_flight(Quantity::Inclination, "alpha", &["alpha", "aoa", "angleofattack"]),
    of_flight(Quantity::Rate, "q", &["q", "pitchrate"]),
    of_flight(Quantity::Speed, "V", &["v", "tas", "airspeed", "trueairspeed"]),
    of_flight(Quantity::Inclination, "theta", &["theta", "pitch", "pitchangle"]),
    of_flight(Quantity::Inclination, "delta_e", &["deltae", "elevator"]),
    of_flight(Quantity::Share, "delta_t", &["deltat", "throttle"]),
];

/// What readers ask for under this name.
fn known(name: &str) -> Option<&'static Known> {
    KNOWN.iter().find(|known| known.name == name)
}

/// The names that options may assign columns and units to, beside time and the axes.
pub(crate) fn names() -> impl Iterator<Item = (&'static str, Option<Quantity>)> {
    KNOWN.iter().map(|known| (known.name, known.quantity))
}

/// A column that was found in a table.
#[derive(Debug, Clone, PartialEq)]
pub struct Place {
    /// The index of the column, from 0.
    pub column: usize,
    /// The name in the header.
    pub name: String,
    /// The unit, if the header or an option gives it.
    pub unit: Option<Unit>,
    /// Whether an option reverses the sign.
    pub is_negative: bool,
}

impl Place {
    /// The factor that converts the column's values to the SI unit.
    pub fn scale(&self) -> f64 {
        let scale = self.unit.as_ref().map_or(1.0, |unit| unit.scale);
        if self.is_negative { -scale } else { scale }
    }
}

/// The column names of a table.
#[derive(Debug, Clone)]
pub struct Heading<'a> {
    /// The line of the header, from 1.
    pub line: usize,
    names: Vec<String>,
    /// The units in a line below the header, one for each column, or none at all.
    units: Vec<Option<String>>,
    options: &'a Options,
}

impl<'a> Heading<'a> {
    pub(crate) fn new(line: usize, names: Vec<String>, options: &'a Options) -> Self {
        Self { line, names, units: Vec::new(), options }
    }

    /// The same header with a line of units below it.
    pub(crate) fn with_units(self, units: Vec<Option<String>>) -> Self {
        Self { units, ..self }
    }

    /// The column names as they are written in the header.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// The column of this name, if there is one: chosen by an option, by an exact match, or by a known alias.
    ///
    /// # Errors
    /// [`Error::Line`] if two columns match, or if the column that an option names is missing; if the line of units has a unit that is
    /// not known for it, or another than its name.
    pub fn find(&self, name: &str) -> Result<Option<Place>, Error> {
        let Some((column, named)) = self.column(name)? else { return Ok(None) };
        let said = self.options.columns.of(name);
        let unit = match self.options.units.of(name) {
            Some(unit) => Some(unit),
            None => self.unit(name, column, named)?,
        };
        Ok(Some(Place {
            column,
            name: self.names[column].clone(),
            unit,
            is_negative: said.is_some_and(|pick| pick.is_negative),
        }))
    }

    /// The column of this name and the unit in its own name.
    fn column(&self, name: &str) -> Result<Option<(usize, Option<Unit>)>, Error> {
        let said = self.options.columns.of(name);
        let wanted = said.map_or(name, |pick| pick.name.as_str());
        let exact: Vec<_> = (0..self.names.len()).filter(|&i| self.names[i] == wanted).collect();
        match (exact[..].first(), exact.len(), said) {
            (Some(&column), 1, _) => {
                let named = said.and_then(|_| self.named(name, column)?.unit);
                return Ok(Some((column, named)));
            }
            (Some(_), _, _) => {
                return Err(Error::line(
                    self.line,
                    format!("expected one column {wanted}, found two"),
                ));
            }
            (None, _, Some(said)) => {
                let problem =
                    format!("expected a column {}, found {}", quoted(&said.name), self.all());
                return Err(Error::line(self.line, problem));
            }
            (None, _, None) => {}
        }
        let mut found = (0..self.names.len()).filter_map(|i| Some((i, self.named(name, i)?)));
        let Some((column, Named { unit: named })) = found.next() else { return Ok(None) };
        if let Some((other, _)) = found.next() {
            let (one, other) = (quoted(&self.names[column]), quoted(&self.names[other]));
            let problem = format!(
                "expected one column {name}, found {one} and {other}; --columns {name}= decides"
            );
            return Err(Error::line(self.line, problem));
        }
        Ok(Some((column, named)))
    }

    /// The unit of the wanted column: that in its name, or that in the line of units.
    fn unit(
        &self,
        wanted: &str,
        column: usize,
        named: Option<Unit>,
    ) -> Result<Option<Unit>, Error> {
        let quantity = match known(wanted) {
            Some(known) => known.quantity,
            None => meaning(wanted).map(|meaning| meaning.quantity),
        };
        let Some(quantity) = quantity else { return Ok(named) };
        let below = self.unit_below(column, quantity).map_err(|written| {
            let (name, written) = (quoted(&self.names[column]), quoted(written));
            let problem = format!(
                "expected a unit that is known below {name}, found {written}; --units {wanted}= decides"
            );
            Error::line(self.line, problem)
        })?;
        match (&named, &below) {
            (Some(named), Some(below)) if named.scale != below.scale => {
                let problem = format!(
                    "expected one unit of {}, found {named} in its name and {below} below; --units {wanted}= decides",
                    quoted(&self.names[column])
                );
                Err(Error::line(self.line, problem))
            }
            _ => Ok(named.or(below)),
        }
    }

    /// The unit of a column in the line of units; what is written there if it is no unit of this quantity.
    pub(crate) fn unit_below(
        &self,
        column: usize,
        quantity: Quantity,
    ) -> Result<Option<Unit>, &str> {
        let Some(Some(written)) = self.units.get(column) else { return Ok(None) };
        Unit::read(quantity, written).map(Some).ok_or(written)
    }

    /// Whether a column may be the wanted one, and the unit that its name contains.
    fn named(&self, wanted: &str, column: usize) -> Option<Named> {
        let name = &self.names[column];
        if let Some(known) = known(wanted) {
            let has_unit = |found: &Named| !known.needs_unit || found.unit.is_some();
            return named(name, known.quantity, known.aliases).filter(has_unit);
        }
        let (own, its) = (meaning(wanted)?, meaning(name)?);
        let same = own.quantity == its.quantity && own.axis == its.axis;
        same.then_some(Named { unit: its.unit })
    }

    /// The columns of these names.
    ///
    /// # Errors
    /// As [`Self::find`]; [`Error::Line`] too if one is missing.
    pub fn require<const N: usize>(&self, names: [&str; N]) -> Result<[Place; N], Error> {
        let mut places = Vec::with_capacity(N);
        for name in names {
            places.push(self.find(name)?.ok_or_else(|| self.lacks(name))?);
        }
        places.try_into().map_err(|_| Error::line(self.line, "expected a header, found none"))
    }

    /// The error for a missing column of this name.
    pub fn lacks(&self, name: &str) -> Error {
        let problem = format!("expected a header with a column {name}, found {}", self.all());
        Error::line(self.line, problem)
    }

    /// The names of all columns, for an error message.
    fn all(&self) -> String {
        listed(self.names.iter().map(String::as_str))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn find(names: &[&str], wanted: &str, options: &Options) -> Result<Option<Place>, Error> {
        let names = names.iter().map(|&name| name.to_owned()).collect();
        Heading::new(1, names, options).find(wanted)
    }

    #[test]
    fn columns_are_found_as_people_name_them() {
        let options = Options::default();
        for (name, wanted, unit) in [
            ("range", "range", None),
            ("Distance [cm]", "range", Some("cm")),
            ("dist_mm", "range", Some("mm")),
            ("Range (m)", "range", Some("m")),
            ("d (ft)", "range", Some("ft")),
            ("AnchorID", "anchor", None),
            ("timestamp_ms", "t", Some("ms")),
            ("RSSI [dBm]", "rssi_db", Some("dB")),
            ("rssi_dbm", "rssi_db", Some("dB")),
            ("pos_x [m]", "x", Some("m")),
            ("altitude (ft)", "h", Some("ft")),
            ("Latitude [deg]", "lat", Some("°")),
            ("lon", "lon", None),
            ("left_speed (cm/s)", "v_left", Some("cm/s")),
            ("AccX [g]", "ax", Some("g")),
            ("alpha [deg]", "alpha", Some("°")),
            ("q_dps", "q", Some("°/s")),
            ("pitch_rate [deg/s]", "q", Some("°/s")),
            ("True Airspeed (m/s)", "V", Some("m/s")),
            ("elevator_deg", "delta_e", Some("°")),
            ("throttle [%]", "delta_t", Some("%")),
        ] {
            let place = find(&["other", name], wanted, &options).unwrap();
            let place = place.unwrap_or_else(|| panic!("{name}"));
            assert_eq!(place.column, 1, "{name}");
            assert_eq!(place.unit.map(|unit| unit.name).as_deref(), unit, "{name}");
        }
        for (name, wanted) in [
            ("T", "t"),
            ("range_x", "range"),
            ("xy", "x"),
            ("lax", "ax"),
            ("pitch", "theta"),
            ("ALPHA", "alpha"),
            ("pitch [m]", "theta"),
        ] {
            assert_eq!(find(&[name], wanted, &options), Ok(None), "{name}");
        }
    }

    #[test]
    fn an_exact_name_or_an_option_decides() {
        let options = Options::default();
        assert_eq!(find(&["d", "range"], "range", &options).unwrap().unwrap().column, 1);
        let error = find(&["d", "dist"], "range", &options).unwrap_err().to_string();
        assert_eq!(
            error,
            "line 1: expected one column range, found \"d\" and \"dist\"; --columns range= decides"
        );
        let said = Options {
            columns: "range=dist".parse().unwrap(),
            units: "range=cm".parse().unwrap(),
            ..Options::default()
        };
        let place = find(&["d", "dist"], "range", &said).unwrap().unwrap();
        assert_eq!((place.column, place.scale()), (1, 0.01));
        assert!(find(&["d"], "range", &said).unwrap_err().to_string().contains("\"dist\""));
        assert!(find(&["x", "x"], "x", &options).unwrap_err().to_string().contains("found two"));
    }
}
