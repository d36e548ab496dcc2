//! Tables whose columns are found by name: logs of ranges, levels and wheels, and lists of places.
//!
//! The first line that holds the wanted names is the header, whatever separates them; the names decide, never the
//! separator. Below it may stand a line of units.

use std::borrow::Cow;
use std::cell::Cell;

use crate::counter::Counter;
use crate::dialect::{Dialect, Separator};
use crate::heading::Heading;
use crate::layout::units_line;
use crate::moment::{self, Days};
use crate::options::Options;
use crate::text::{Text, letters};

/// The largest number of lines above the header.
const ABOVE: usize = 60;
/// The number of rows that are looked at to detect how numbers are written.
const SAMPLE: usize = 400;

/// A table with a header.
#[derive(Debug)]
pub struct NamedTable<'a> {
    text: &'a Text<'a>,
    /// The lines down to the header, or to a line of units below it.
    above: usize,
    /// The header.
    pub heading: Heading<'a>,
    /// The dialect of the table.
    pub dialect: Dialect,
    days: Cell<Days>,
    counter: Cell<Counter>,
}

impl<'a> NamedTable<'a> {
    /// Finds the header: the first line, with the first separator, in which `columns` finds all that it needs. Returns
    /// the table with what `columns` found, or else its error for the first line; `None` if there is no line.
    pub fn find<T, E>(
        text: &'a Text<'a>,
        options: &'a Options,
        columns: impl Fn(&Heading<'a>) -> Result<T, E>,
    ) -> Option<Result<(Self, T), E>> {
        const SEPARATORS: [Separator; 4] =
            [Separator::Comma, Separator::Semicolon, Separator::Tab, Separator::Blanks];
        let mut first = None;
        let mut lines = text.lines().take(ABOVE).peekable();
        while let Some(line) = lines.next() {
            let below = lines.peek();
            let headings = SEPARATORS.into_iter().map(|separator| {
                let dialect = Dialect::new(separator, false);
                let fields = |line: &[u8]| -> Vec<_> {
                    dialect.fields(bare(line)).iter().map(|field| letters(field)).collect()
                };
                let heading = Heading::new(line.number, fields(line.bytes), options);
                let units = below.and_then(|line| Some((line, units_line(fields(line.bytes))?)));
                match units {
                    Some((below, units)) => (dialect, below.number, heading.with_units(units)),
                    None => (dialect, line.number, heading),
                }
            });
            let mut best: Option<(usize, Self, T)> = None;
            let mut worst: Option<(usize, E)> = None;
            for (dialect, above, heading) in headings {
                let names = heading.names().len();
                match columns(&heading) {
                    Ok(found) => {
                        let table = Self {
                            text,
                            above,
                            heading,
                            dialect,
                            days: Cell::default(),
                            counter: Cell::default(),
                        };
                        let fits = table.fitting_rows();
                        if best.as_ref().is_none_or(|(most, ..)| fits > *most) {
                            best = Some((fits, table, found));
                        }
                    }
                    // The error of the separator that yields most names is kept.
                    Err(error) if worst.as_ref().is_none_or(|(most, _)| names > *most) => {
                        worst = Some((names, error));
                    }
                    Err(_) => {}
                }
            }
            if let Some((_, mut table, found)) = best {
                table.dialect.decimal_comma = table.has_decimal_commas();
                return Some(Ok((table, found)));
            }
            first = first.or(worst.map(|(_, error)| error));
        }
        first.map(Err)
    }

    /// The number and fields of each line below the header, and below a line of units, that is not a comment.
    pub fn rows(&self) -> impl Iterator<Item = (usize, Vec<Cow<'_, [u8]>>)> {
        let below = self.text.lines().filter(|line| line.number > self.above);
        let rows = below.filter(|line| !self.dialect.is_comment(line.bytes));
        rows.map(|line| (line.number, self.fields(line.bytes)))
    }

    /// The fields of a line, which may end with a separator.
    fn fields<'b>(&self, bytes: &'b [u8]) -> Vec<Cow<'b, [u8]>> {
        let mut fields = self.dialect.fields(bytes);
        let ends = fields.len() == self.heading.names().len() + 1;
        if ends && fields.last().is_some_and(|last| last.is_empty()) {
            fields.pop();
        }
        fields
    }

    /// How many of the first rows have as many fields as the header.
    fn fitting_rows(&self) -> usize {
        let width = self.heading.names().len();
        self.rows().take(SAMPLE).filter(|(_, fields)| fields.len() == width).count()
    }

    /// Whether most of the numbers that have a decimal sign have a comma.
    fn has_decimal_commas(&self) -> bool {
        if self.dialect.separator == Separator::Comma {
            return false;
        }
        let comma = Dialect::new(self.dialect.separator, true);
        let (mut commas, mut points) = (0, 0);
        for (_, fields) in self.rows().take(SAMPLE) {
            for field in fields {
                if field.contains(&b',') {
                    commas += usize::from(comma.number(&field).is_some());
                } else if field.contains(&b'.') {
                    points += usize::from(self.dialect.number(&field).is_some());
                }
            }
        }
        commas > points
    }

    /// The number in a field; it may be infinite or NaN.
    pub fn number(&self, field: &[u8]) -> Option<f64> {
        self.dialect.number(field)
    }

    /// Whether a field holds a date with a time, or a time of day.
    pub fn is_moment(&self, field: &[u8]) -> bool {
        moment::read(field).is_some()
    }

    /// The date with a time, or time of day, in a field, in s since 1970 or since the midnight before the first one: to be called
    /// for one row after the other.
    pub fn moment(&self, field: &[u8]) -> Option<f64> {
        let moment = moment::read(field)?;
        let mut days = self.days.get();
        let seconds = days.seconds(moment);
        self.days.set(days);
        Some(seconds)
    }

    /// The finite number in a field of a clock that counts, continued where the clock begins anew, at midnight or at the end of 32
    /// bits: to be called for one row after the other.
    pub fn count(&self, field: &[u8]) -> Option<f64> {
        let number = self.number(field).filter(|number| number.is_finite())?;
        let mut counter = self.counter.get();
        let continued = counter.continued(number);
        self.counter.set(counter);
        Some(continued)
    }
}

/// A line without leading comment marks: a header may be a comment.
fn bare(line: &[u8]) -> &[u8] {
    let mut line = line;
    while let [b'#' | b'%' | b'/' | b' ', rest @ ..] = line {
        line = rest;
    }
    line
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_names_find_the_header() {
        for (text, decimal_comma) in [
            ("t,anchor,range\n0.5,A 1,2.5\n", false),
            ("t;anchor;range\n0,5;A 1;2,5\n", true),
            ("made by x;y\n# t\tanchor\trange\n0.5\tA 1\t2.5\t\n", false),
            ("site: 3\n\nrange,t,anchor,\n2.5,0.5,\"A 1\",\n", false),
        ] {
            let text = Text::new(text.as_bytes()).unwrap();
            let options = Options::default();
            let (table, places) = NamedTable::find(&text, &options, |heading| {
                heading.require(["t", "anchor", "range"])
            })
            .unwrap()
            .unwrap();
            assert_eq!(table.dialect.decimal_comma, decimal_comma);
            let (_, fields) = table.rows().next().unwrap();
            let [t, anchor, range] = places.map(|place| fields[place.column].clone());
            assert_eq!((table.number(&t), table.number(&range)), (Some(0.5), Some(2.5)));
            assert_eq!(&*anchor, b"A 1");
        }
        let text = Text::new(b"t,anchor,range\n[ms],-,[ft]\n0.5,1,2\n").unwrap();
        let options = Options::default();
        let found = NamedTable::find(&text, &options, |heading| heading.require(["t", "range"]));
        let (table, places) = found.unwrap().unwrap();
        assert_eq!(places.map(|place| place.scale()), [1e-3, 0.3048]);
        assert_eq!(table.rows().map(|(line, _)| line).collect::<Vec<_>>(), [3]);
        // One unit is enough; what contradicts the name, or is unknown, is no guess.
        let text = Text::new(b"t,x,y [m]\n,,ft\n0.5,1,2\n").unwrap();
        let sentence = |text: &Text<'_>, name| {
            let found = NamedTable::find(text, &options, |heading| heading.require([name]));
            found.unwrap().map(|(_, [place])| place.scale()).map_err(|error| error.to_string())
        };
        assert_eq!(sentence(&text, "x"), Ok(1.0));
        let error = sentence(&text, "y").unwrap_err();
        assert_eq!(
            error,
            "line 1: expected one unit of \"y [m]\", found m in its name and ft below; --units y= decides"
        );
        let text = Text::new(b"t,anchor,range\ns,-,yd\n0.5,1,2\n").unwrap();
        let error = sentence(&text, "range").unwrap_err();
        assert!(error.contains("known below \"range\", found \"yd\"; --units range="), "{error}");
        // Numbers are a row, though a share is written in parts of 1.
        let text = Text::new(b"t,x,y\n1,1,1\n").unwrap();
        let table = NamedTable::find(&text, &options, |heading| heading.require(["t", "x"]));
        assert_eq!(table.unwrap().unwrap().0.rows().count(), 1);
        let text = Text::new(b"t,anchor\n1,2\n").unwrap();
        let options = Options::default();
        let error = NamedTable::find(&text, &options, |heading| heading.require(["t", "range"]));
        let error = error.unwrap().map(|_| ()).unwrap_err().to_string();
        assert_eq!(error, "line 1: expected a header with a column range, found t, anchor");
    }
}
