//! How a table is written: its column separator and its decimal sign.

use std::borrow::Cow;

use crate::moment;
use crate::number;
use crate::text::{Text, without_blanks};

/// The number of lines that are looked at to detect the dialect.
const SAMPLE: usize = 400;
/// The largest number of fields of a line; longer lines are not split any further.
const MOST_FIELDS: usize = 1000;

/// The separator between columns.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Separator {
    /// `,`
    Comma,
    /// `;`
    Semicolon,
    /// A tab.
    Tab,
    /// Any number of blanks and tabs.
    Blanks,
}

/// How a table is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Dialect {
    /// The separator between columns.
    pub separator: Separator,
    /// Whether the decimal sign is a comma (`0,5`) instead of a point (`0.5`).
    pub decimal_comma: bool,
}

impl std::fmt::Display for Dialect {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let separator = match self.separator {
            Separator::Comma => "commas",
            Separator::Semicolon => "semicolons",
            Separator::Tab => "tabulators",
            Separator::Blanks => "blanks",
        };
        let decimal = if self.decimal_comma { ", decimal commas" } else { "" };
        write!(f, "{separator}{decimal}")
    }
}

impl Dialect {
    /// All dialects, in order of preference where two of them read equally many numbers.
    const ALL: [Self; 8] = [
        Self::new(Separator::Comma, false),
        Self::new(Separator::Semicolon, false),
        Self::new(Separator::Tab, false),
        Self::new(Separator::Blanks, false),
        Self::new(Separator::Comma, true),
        Self::new(Separator::Semicolon, true),
        Self::new(Separator::Tab, true),
        Self::new(Separator::Blanks, true),
    ];

    /// A dialect with this separator and this decimal sign.
    pub const fn new(separator: Separator, decimal_comma: bool) -> Self {
        Self { separator, decimal_comma }
    }

    /// The dialect in which most numbers of the first lines can be read, and the number of columns; `None` if there are
    /// no rows of numbers.
    pub fn find(text: &Text<'_>) -> Option<(Self, usize)> {
        let lines: Vec<_> = text.lines().take(SAMPLE).map(|line| line.bytes).collect();
        let mut best = None;
        for dialect in Self::ALL {
            let (numbers, width) = dialect.numbers(&lines);
            if numbers > best.map_or(0, |(numbers, _, _)| numbers) {
                best = Some((numbers, dialect, width));
            }
        }
        best.map(|(_, dialect, width)| (dialect, width))
    }

    /// The number of numbers in the rows of the most frequent width, and that width.
    fn numbers(self, lines: &[&[u8]]) -> (usize, usize) {
        // Width, number of rows, number of numbers.
        let mut widths: Vec<[usize; 3]> = Vec::new();
        for line in lines.iter().filter(|line| !self.is_comment(line)) {
            let (width, numbers) = self.row(line);
            if !(2..=MOST_FIELDS).contains(&width) || numbers * 2 < width {
                continue;
            }
            match widths.iter_mut().find(|known| known[0] == width) {
                Some([_, rows, sum]) => (*rows, *sum) = (*rows + 1, *sum + numbers),
                None => widths.push([width, 1, numbers]),
            }
        }
        let most = widths.into_iter().max_by_key(|&[width, rows, _]| (rows, width));
        most.map_or((0, 0), |[width, _, numbers]| (numbers, width))
    }

    /// The number of fields of a line, and how many of them are numbers or times.
    pub(crate) fn row(self, line: &[u8]) -> (usize, usize) {
        let fields = self.fields(line);
        let is_value =
            |field: &&Cow<'_, [u8]>| self.number(field).is_some() || moment::read(field).is_some();
        // A line may end with a separator.
        let ends = fields.len() > 2 && fields.last().is_some_and(|field| field.is_empty());
        (fields.len() - usize::from(ends), fields.iter().filter(is_value).count())
    }

    /// Whether a line is a comment: it begins with `#`, `%`, `//` or `;`.
    pub fn is_comment(self, line: &[u8]) -> bool {
        match line.trim_ascii_start() {
            [b'#' | b'%', ..] | [b'/', b'/', ..] => true,
            [b';', ..] => self.separator != Separator::Semicolon,
            _ => false,
        }
    }

    /// The bytes that separate fields; most dialects have only one, which is then given twice.
    const fn separators(self) -> [u8; 2] {
        match self.separator {
            Separator::Comma => [b','; 2],
            Separator::Semicolon => [b';'; 2],
            Separator::Tab => [b'\t'; 2],
            Separator::Blanks => [b' ', b'\t'],
        }
    }

    /// Whether a byte separates fields.
    pub(crate) fn separates(self, byte: u8) -> bool {
        let [one, other] = self.separators();
        byte == one || byte == other
    }

    /// A line without surrounding blanks, which do not separate fields.
    pub(crate) fn trimmed(self, line: &[u8]) -> &[u8] {
        match self.separator {
            Separator::Tab => without_blanks(line),
            _ => line.trim_ascii(),
        }
    }

    /// The fields of a line, without surrounding blanks and quotation marks; only the first ones if there are more than
    /// 1000.
    pub fn fields(self, line: &[u8]) -> Vec<Cow<'_, [u8]>> {
        // Most lines have at most eight fields: growing the list would be most of the work.
        let mut fields = Vec::with_capacity(8);
        let mut rest = self.trimmed(line);
        loop {
            let (field, length) = self.field(rest);
            fields.push(field);
            let Some(after) = rest.get(length + 1..) else { return fields };
            if fields.len() > MOST_FIELDS {
                return fields;
            }
            rest = match self.separator {
                Separator::Blanks => after.trim_ascii_start(),
                _ => after,
            };
            if rest.is_empty() && self.separator == Separator::Blanks {
                return fields;
            }
        }
    }

    /// The first field, and the position of its separator.
    fn field(self, rest: &[u8]) -> (Cow<'_, [u8]>, usize) {
        let blanks = rest.iter().take_while(|&&b| b == b' ').count();
        if (self.separator != Separator::Blanks || blanks == 0)
            && let Some((field, length)) = rest.get(blanks..).and_then(quoted_field)
        {
            let end = blanks + length;
            let after = rest[end..].iter().position(|&byte| self.separates(byte));
            return (field, after.map_or(rest.len(), |after| end + after));
        }
        let end = rest.iter().position(|&byte| self.separates(byte)).unwrap_or(rest.len());
        (Cow::Borrowed(rest[..end].trim_ascii()), end)
    }

    /// The value of a field, if it is a number; it may be infinite or NaN.
    pub fn number(self, field: &[u8]) -> Option<f64> {
        const LONGEST: usize = 64;
        if !self.decimal_comma || !field.contains(&b',') {
            // A point beside decimal commas groups thousands, or the table mixes two notations.
            let plain = !self.decimal_comma || !field.contains(&b'.');
            return number::whole(field).filter(|_| plain);
        }
        let mut copy = [0; LONGEST];
        let copy = copy.get_mut(..field.len())?;
        copy.copy_from_slice(field);
        let at = field.iter().position(|&byte| byte == b',')?;
        let between_digits = at > 0 && field.get(at + 1).is_some_and(u8::is_ascii_digit);
        copy[at] = b'.';
        number::whole(copy).filter(|_| between_digits && !field.contains(&b'.'))
    }
}

/// The text in quotation marks at the beginning, with `""` for `"`, and its length including the marks.
fn quoted_field(text: &[u8]) -> Option<(Cow<'_, [u8]>, usize)> {
    let inside = text.strip_prefix(b"\"")?;
    let mut field = Vec::new();
    let mut at = 0;
    loop {
        let length = inside[at..].iter().position(|&byte| byte == b'"')?;
        field.extend_from_slice(&inside[at..at + length]);
        at += length + 1;
        if inside.get(at) != Some(&b'"') {
            return Some((Cow::Owned(field.trim_ascii().to_vec()), at + 1));
        }
        field.push(b'"');
        at += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn find(text: &str) -> Option<(Dialect, usize)> {
        Dialect::find(&Text::new(text.as_bytes()).unwrap())
    }

    #[test]
    fn the_dialect_is_found() {
        for (text, separator, decimal_comma, width) in [
            ("a,b,c\n1,2.5,3\n", Separator::Comma, false, 3),
            ("a, b\n1, 2\n", Separator::Comma, false, 2),
            ("a;b\n1;2.5\n", Separator::Semicolon, false, 2),
            ("a;b\n0,5;2\n", Separator::Semicolon, true, 2),
            ("a\tb\n0,5\t2\n", Separator::Tab, true, 2),
            ("a\tb c\td\n1\t2\t-3e-5\n", Separator::Tab, false, 3),
            ("1  2\t3\n", Separator::Blanks, false, 3),
            ("0,5 2,5 3\n", Separator::Blanks, true, 3),
            ("\"a\",\"b\"\n\"0,5\",\"2,5\"\n", Separator::Comma, true, 2),
            ("t,a\n2024-01-01 10:00:00.5,1\n", Separator::Comma, false, 2),
            ("1,2,\n3,4,\n", Separator::Comma, false, 2),
        ] {
            let expected = Some((Dialect::new(separator, decimal_comma), width));
            assert_eq!(find(text), expected, "{text}");
        }
        assert_eq!(find("once upon a time\n"), None);
    }

    #[test]
    fn fields_are_trimmed_and_unquoted() {
        let comma = Dialect::new(Separator::Comma, false);
        let fields = comma.fields(br#" a , "b, ""c""" ,,"x"#);
        let fields: Vec<_> = fields.iter().map(|field| String::from_utf8_lossy(field)).collect();
        assert_eq!(fields, ["a", r#"b, "c""#, "", "\"x"]);
        assert_eq!(Dialect::new(Separator::Blanks, false).fields(b"1 \t 2  ").len(), 2);
    }

    #[test]
    fn numbers_are_whole_fields() {
        let point = Dialect::new(Separator::Semicolon, false);
        let comma = Dialect::new(Separator::Semicolon, true);
        for text in ["1", "-0.5", "+2", "1e-3", ".5", "5."] {
            let expected = text.parse::<f64>().ok();
            assert_eq!(point.number(text.as_bytes()), expected, "{text}");
            let with_comma = text.replace('.', ",");
            let expected = expected.filter(|_| !".5 5.".contains(text) || !text.contains('.'));
            assert_eq!(comma.number(with_comma.as_bytes()), expected, "{with_comma}");
        }
        for text in ["", "-", "1x", "0x1", "1 2", "1,2,3", "1.234,5", "12:30"] {
            assert_eq!(point.number(text.as_bytes()), None, "{text}");
            assert_eq!(comma.number(text.as_bytes()), None, "{text}");
        }
    }
}
