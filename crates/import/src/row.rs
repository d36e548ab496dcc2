//! Iterates over the fields of a line without collecting them.

use crate::dialect::{Dialect, Separator};
use crate::number;

/// The rest of a line.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Row<'a> {
    dialect: Dialect,
    /// The line without surrounding blanks.
    line: &'a [u8],
    /// The position where the next field begins.
    at: usize,
    /// Whether another field follows, which may be empty.
    has_more: bool,
}

impl<'a> Row<'a> {
    /// A line without surrounding blanks.
    pub(crate) const fn new(dialect: Dialect, line: &'a [u8]) -> Self {
        Self { dialect, line, at: 0, has_more: true }
    }

    /// Whether nothing is left except perhaps a separator at the end of the line.
    pub(crate) const fn is_at_end(&self) -> bool {
        !self.has_more || self.at == self.line.len()
    }

    /// The next number as [`Dialect::number`] would read it. Nothing is consumed if the dialect has decimal commas or a
    /// quotation mark stands here.
    #[inline(always)]
    pub(crate) fn number(&mut self) -> Option<f64> {
        if self.dialect.decimal_comma || !self.has_more {
            return None;
        }
        let is_blank = |byte: &u8| byte.is_ascii_whitespace() && !self.dialect.separates(*byte);
        let begin = self.behind_blanks(self.at, is_blank);
        let (number, length) = number::leading(self.line.get(begin..)?)?;
        self.go_behind(begin + length).then_some(number)
    }

    /// The next field without surrounding blanks; `None` if there is none, or if it contains a quotation mark, because
    /// quoted text may hold a separator.
    pub(crate) fn field(&mut self) -> Option<&'a [u8]> {
        let rest = self.line.get(self.at..).filter(|_| self.has_more)?;
        let ends = |byte: &u8| *byte == b'"' || self.dialect.separates(*byte);
        let field = rest.get(..rest.iter().position(ends).unwrap_or(rest.len()))?;
        self.go_behind(self.at + field.len()).then(|| field.trim_ascii())
    }

    /// Advances behind the separator at the end of a field, or to the end of the line; not if anything else follows.
    #[inline(always)]
    fn go_behind(&mut self, end: usize) -> bool {
        let are_blanks = self.dialect.separator == Separator::Blanks;
        let next = if are_blanks {
            self.behind_blanks(end, u8::is_ascii_whitespace)
        } else {
            self.behind_blanks(end, |byte| *byte == b' ')
        };
        match self.line.get(next) {
            None => (self.at, self.has_more) = (next, false),
            Some(_) if are_blanks && self.dialect.separates(self.line[end]) => self.at = next,
            Some(&byte) if !are_blanks && self.dialect.separates(byte) => self.at = next + 1,
            Some(_) => return false,
        }
        true
    }

    #[inline(always)]
    fn behind_blanks(&self, from: usize, is_blank: impl Fn(&u8) -> bool) -> usize {
        let mut at = from;
        while self.line.get(at).is_some_and(&is_blank) {
            at += 1;
        }
        at
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(dialect: Dialect, line: &str) -> Row<'_> {
        Row::new(dialect, line.as_bytes())
    }

    #[test]
    fn fields_follow_each_other() {
        let comma = Dialect::new(Separator::Comma, false);
        let mut it = row(comma, "1.5 , a b,,-2");
        assert_eq!((it.number(), it.number()), (Some(1.5), None));
        assert_eq!(
            (it.field(), it.number(), it.field()),
            (Some(&b"a b"[..]), None, Some(&b""[..]))
        );
        assert_eq!((it.number(), it.has_more, it.field()), (Some(-2.0), false, None));
        let mut ended = row(comma, "1,");
        assert_eq!((ended.number(), ended.is_at_end(), ended.number()), (Some(1.0), true, None));
        assert_eq!(row(comma, "2 3,4").number(), None);
        assert_eq!(row(comma, "\"a,b\",4").field(), None);
        let mut blanks = row(Dialect::new(Separator::Blanks, false), "1 \t2,5");
        assert_eq!((blanks.number(), blanks.number()), (Some(1.0), None));
        assert_eq!((blanks.field(), blanks.has_more), (Some(&b"2,5"[..]), false));
    }
}
