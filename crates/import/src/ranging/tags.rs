//! The tags whose ranges one log holds.

use std::borrow::Cow;

use crate::error::{Error, listed, quoted};
use crate::heading::Heading;
use crate::text::letters;

/// The share of a log's lines, in percent, and the number of lines that a tag must have: a digit that was garbled is no tag.
const SHARE: usize = 1;
const FEWEST: usize = 3;

/// Keeps the lines of one tag, and those without a tag: of the tag that an option names (`said`), or of the only one. All lines are
/// kept if most name no tag, or words without a digit, which are remarks.
///
/// # Errors
/// If there are several tags and no option chooses, or if there is none of that name.
pub fn keep_one_tag<E>(
    lines: &mut Vec<E>,
    tag_of: impl Fn(&E) -> &str,
    said: Option<&str>,
) -> Result<(), Error> {
    let mut tags = Tags::default();
    for line in &*lines {
        tags.note(tag_of(line));
    }
    if let Some(wanted) = tags.wanted(said)? {
        lines.retain(|line| ["", wanted].contains(&tag_of(line).trim()));
    }
    Ok(())
}

/// Whether an option means this tag.
pub(super) fn is_named(tag: &str, said: &str) -> bool {
    tag.eq_ignore_ascii_case(said.trim())
}

/// The column with the tag of each row, if there is one.
#[derive(Debug, Clone, Copy)]
pub(super) struct TagColumn(Option<usize>);

impl TagColumn {
    pub(super) fn find(heading: &Heading<'_>) -> Self {
        Self(heading.find("tag").ok().flatten().map(|tag| tag.column))
    }

    /// The tag of a row; blank without the column.
    pub(super) fn of(self, fields: &[Cow<'_, [u8]>]) -> String {
        self.0.and_then(|place| fields.get(place)).map(|tag| letters(tag)).unwrap_or_default()
    }
}

/// The distinct tags of a log, with their numbers of lines.
#[derive(Default)]
struct Tags {
    known: Vec<(String, usize)>,
    /// The number of lines, with a tag or without.
    lines: usize,
}

impl Tags {
    /// Notes the tag of a line, which may be blank.
    fn note(&mut self, tag: &str) {
        self.lines += 1;
        let tag = tag.trim();
        if tag.is_empty() {
            return;
        }
        match self.known.iter_mut().find(|(known, _)| known == tag) {
            Some((_, count)) => *count += 1,
            None => self.known.push((tag.to_owned(), 1)),
        }
    }

    /// The tag whose lines are kept; `None` if all are.
    fn wanted(&self, said: Option<&str>) -> Result<Option<&str>, Error> {
        let named: usize = self.known.iter().map(|(_, count)| count).sum();
        let is_name = |tag: &str| tag.bytes().any(|byte| byte.is_ascii_digit());
        if 2 * named <= self.lines || !self.known.iter().all(|(tag, _)| is_name(tag)) {
            return Ok(None);
        }
        let least = if self.known.len() == 1 { 1 } else { FEWEST.max(named * SHARE / 100) };
        let mut tags: Vec<_> = self.known.iter().filter(|(_, count)| *count >= least).collect();
        tags.sort_by_key(|(_, count)| usize::MAX - count);
        let tags: Vec<&str> = tags.into_iter().map(|(tag, _)| tag.as_str()).collect();
        let found = || {
            let all: Vec<_> = tags.iter().map(|tag| quoted(tag)).collect();
            listed(all.iter().map(String::as_str))
        };
        match (said, &tags[..]) {
            (Some(said), _) => {
                let chosen = tags.iter().find(|tag| is_named(tag, said));
                let none = || {
                    let (said, found) = (quoted(said), found());
                    Error::options(format!(
                        "expected ranges of tag {said}, found those of {found} (--topic)"
                    ))
                };
                chosen.map(|tag| Some(*tag)).ok_or_else(none)
            }
            (None, []) => Ok(None),
            (None, [tag]) => Ok(Some(*tag)),
            (None, [most, ..]) => {
                let problem = format!("expected the ranges of one tag, found those of {}", found());
                Err(Error::undecided(problem, format!("--topic {most}")))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tags(all: &[(&str, usize)]) -> Tags {
        let mut tags = Tags::default();
        for (tag, count) in all {
            (0..*count).for_each(|_| tags.note(tag));
        }
        tags
    }

    #[test]
    fn one_of_several_tags_must_be_chosen() {
        let second = Some("t2");
        let both = tags(&[("T2", 10), (" T1 ", 40)]);
        let expected =
            "expected the ranges of one tag, found those of \"T1\", \"T2\"; --topic T1 decides";
        assert_eq!(both.wanted(None).unwrap_err().to_string(), expected);
        assert_eq!(both.wanted(second).ok(), Some(Some("T2")));
        assert!(tags(&[("T1", 1)]).wanted(second).is_err());
        let mut lines = vec!["T2"; 5];
        lines.extend(["T1"; 5]);
        lines.extend([""; 2]);
        keep_one_tag(&mut lines, |tag| tag, second).unwrap();
        assert_eq!(lines, ["T2", "T2", "T2", "T2", "T2", "", ""]);
    }

    #[test]
    fn a_remark_or_a_garbled_line_is_no_tag() {
        assert_eq!(tags(&[]).wanted(None).ok(), Some(None));
        assert_eq!(tags(&[("", 50), ("lap 1", 2)]).wanted(None).ok(), Some(None));
        assert_eq!(tags(&[("LOS", 50), ("NLOS", 40)]).wanted(None).ok(), Some(None));
        assert_eq!(tags(&[("1", 50), ("7", 1)]).wanted(None).ok(), Some(Some("1")));
        assert_eq!(tags(&[("1", 900), ("7", 8)]).wanted(None).ok(), Some(Some("1")));
        assert!(tags(&[("1", 900), ("7", 20)]).wanted(None).is_err());
    }
}
