//! Splits bytes into lines of text, whatever the encoding and the line breaks.

use std::borrow::Cow;

use crate::Error;

/// The number of bytes that are looked at to recognise the encoding.
const BEGINNING: usize = 4096;

/// A log's text in memory, as bytes: a garbled line is no reason to refuse the others, so only the names in a header
/// need to be UTF-8.
#[derive(Debug, Clone)]
pub struct Text<'a> {
    bytes: Cow<'a, [u8]>,
    line_break: u8,
}

impl<'a> Text<'a> {
    /// Takes the bytes of a file: UTF-8 or another superset of ASCII, or UTF-16 of either byte order. A byte order mark
    /// is dropped. Lines end with `\n`, `\r\n`, or with `\r` if there are hardly any `\n`.
    ///
    /// # Errors
    /// [`Error::Log`] if there is no text at all.
    pub fn new(bytes: &'a [u8]) -> Result<Self, Error> {
        let bytes = match bytes {
            [0xff, 0xfe, rest @ ..] => Cow::Owned(utf16(rest, u16::from_le_bytes)),
            [0xfe, 0xff, rest @ ..] => Cow::Owned(utf16(rest, u16::from_be_bytes)),
            [0xef, 0xbb, 0xbf, rest @ ..] => Cow::Borrowed(rest),
            _ => match zeros_of_utf16(bytes) {
                Some(1) => Cow::Owned(utf16(bytes, u16::from_le_bytes)),
                Some(_) => Cow::Owned(utf16(bytes, u16::from_be_bytes)),
                None => Cow::Borrowed(bytes),
            },
        };
        if bytes.trim_ascii().is_empty() {
            return Err(Error::log("expected a log, found an empty file"));
        }
        let beginning = &bytes[..bytes.len().min(BEGINNING)];
        let count = |byte: u8| memchr::memchr_iter(byte, beginning).count();
        let line_break = if count(b'\r') > 2 * count(b'\n') { b'\r' } else { b'\n' };
        Ok(Self { bytes, line_break })
    }

    /// The lines, numbered from 1, without surrounding blanks, but with tabs, between which a field may be empty; blank ones are
    /// left out but counted.
    pub fn lines(&self) -> impl Iterator<Item = Line<'_>> {
        let mut ends = memchr::memchr_iter(self.line_break, &self.bytes);
        let (mut start, mut number) = (0, 0);
        let all = std::iter::from_fn(move || {
            let rest = self.bytes.get(start..).filter(|rest| !rest.is_empty())?;
            let end = ends.next().unwrap_or(start + rest.len());
            let bytes = without_blanks(&self.bytes[start..end]);
            start = end + 1;
            number += 1;
            Some(Line { number, bytes })
        });
        all.filter(|line| !line.bytes.trim_ascii().is_empty())
    }

    /// The line of this number, without surrounding blanks; empty beyond the last one.
    pub fn line(&self, number: usize) -> &[u8] {
        self.lines().find(|line| line.number == number).map_or(b"", |line| line.bytes)
    }

    /// The number of line breaks.
    pub(crate) fn breaks(&self) -> usize {
        memchr::memchr_iter(self.line_break, &self.bytes).count()
    }

    /// The length, bytes.
    pub(crate) fn len(&self) -> usize {
        self.bytes.len()
    }

    /// Whether the text ends with a line break, so that the last line is not cut off.
    pub fn ends_with_line_break(&self) -> bool {
        self.bytes.last() == Some(&self.line_break)
    }
}

/// A line of a [`Text`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Line<'a> {
    /// The number of the line, from 1.
    pub number: usize,
    /// The bytes of the line, without surrounding blanks and line break.
    pub bytes: &'a [u8],
}

/// A line without blanks and line breaks at its ends, but with tabs.
pub(crate) fn without_blanks(line: &[u8]) -> &[u8] {
    let is_blank = |byte: &u8| byte.is_ascii_whitespace() && *byte != b'\t';
    let begin = line.iter().position(|byte| !is_blank(byte)).unwrap_or(line.len());
    let end = line.iter().rposition(|byte| !is_blank(byte)).map_or(begin, |last| last + 1);
    &line[begin..end]
}

/// The position of the zero bytes in UTF-16 text that is mostly ASCII: 1 for little endian, 0 for big endian.
fn zeros_of_utf16(bytes: &[u8]) -> Option<usize> {
    let beginning = &bytes[..bytes.len().min(BEGINNING)];
    let pairs = beginning.len() / 2;
    let zeros = |from: usize| beginning.iter().skip(from).step_by(2).filter(|&&b| b == 0).count();
    let (even, odd) = (zeros(0), zeros(1));
    // Nine of ten letters: some are not ASCII, such as °.
    let most = |count: usize| pairs >= 2 && count * 10 >= pairs * 9;
    match (most(even), most(odd)) {
        (true, false) if odd * 10 < pairs => Some(0),
        (false, true) if even * 10 < pairs => Some(1),
        _ => None,
    }
}

fn utf16(bytes: &[u8], unit: fn([u8; 2]) -> u16) -> Vec<u8> {
    let (pairs, _) = bytes.as_chunks::<2>();
    let letters = char::decode_utf16(pairs.iter().map(|pair| unit(*pair)));
    let text: String = letters.map(|letter| letter.unwrap_or('\u{fffd}')).collect();
    text.into_bytes()
}

/// Decodes bytes as UTF-8, or else as Latin-1, in which older programs write ° and ².
pub(crate) fn letters(bytes: &[u8]) -> String {
    match std::str::from_utf8(bytes) {
        Ok(text) => text.to_owned(),
        Err(_) => bytes.iter().map(|&byte| char::from(byte)).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(bytes: &[u8]) -> Vec<(usize, String)> {
        let text = Text::new(bytes).unwrap();
        text.lines().map(|line| (line.number, letters(line.bytes))).collect()
    }

    #[test]
    fn every_encoding_gives_the_same_lines() {
        let text = "t [ms],a [°]\r\n\r\n 1,2\n";
        let expected = vec![(1, "t [ms],a [°]".to_owned()), (3, "1,2".to_owned())];
        assert_eq!(lines(text.as_bytes()), expected);
        assert_eq!(lines(format!("\u{feff}{text}").as_bytes()), expected);
        for mark in ["", "\u{feff}"] {
            let units: Vec<u16> = format!("{mark}{text}").encode_utf16().collect();
            let little: Vec<u8> = units.iter().flat_map(|unit| unit.to_le_bytes()).collect();
            let big: Vec<u8> = units.iter().flat_map(|unit| unit.to_be_bytes()).collect();
            assert_eq!(lines(&little), expected);
            assert_eq!(lines(&big), expected);
        }
        assert_eq!(lines(b"t [ms],a [\xb0]\r\r 1,2\r"), expected);
    }

    #[test]
    fn a_line_is_found_by_its_number() {
        let text = Text::new(b"a\n\nb").unwrap();
        assert_eq!((text.line(3), text.line(2), text.line(9)), (&b"b"[..], &b""[..], &b""[..]));
        assert!(!text.ends_with_line_break());
    }

    #[test]
    fn nothing_is_no_log() {
        for bytes in [&b""[..], b"\n \r\n", b"\xef\xbb\xbf", b"\xff\xfe"] {
            assert_eq!(
                Text::new(bytes).unwrap_err().to_string(),
                "expected a log, found an empty file"
            );
        }
    }
}
