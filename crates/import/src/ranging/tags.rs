//! The tags whose ranges one log holds.

use crate::error::{Error, listed, quoted};
use crate::options::Options;

/// The share of a log's lines, in percent, and the number of lines that a tag must have: a digit that was garbled is no tag.
const SHARE: usize = 1;
const FEWEST: usize = 3;

/// The distinct tags of a log, with their numbers of lines.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Tags {
    known: Vec<(String, usize)>,
    /// The number of lines, with a tag or without.
    lines: usize,
}

impl Tags {
    /// Notes the tag of a line, which may be blank.
    pub fn note(&mut self, tag: &str) {
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

    /// The tag whose lines are read: the one that an option names (`topic`), or the only one; `None` if all lines are, as most name
    /// none, or words without a digit, which are remarks.
    ///
    /// # Errors
    /// If there are several and no option chooses, or if there is none of that name.
    pub fn wanted(&self, options: &Options) -> Result<Option<&str>, Error> {
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
        match (&options.topic, &tags[..]) {
            (Some(said), _) => {
                let chosen = tags.iter().find(|tag| tag.eq_ignore_ascii_case(said.trim()));
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

    /// Whether a line with this tag is read, if that one is wanted: lines without a tag are.
    pub fn reads(wanted: Option<&str>, tag: &str) -> bool {
        let tag = tag.trim();
        tag.is_empty() || wanted.is_none_or(|wanted| wanted == tag)
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
        let plain = Options::default();
        let second = Options { topic: Some("t2".to_owned()), ..Options::default() };
        let both = tags(&[("T2", 10), (" T1 ", 40)]);
        let expected =
            "expected the ranges of one tag, found those of \"T1\", \"T2\"; --topic T1 decides";
        assert_eq!(both.wanted(&plain).unwrap_err().to_string(), expected);
        assert_eq!(both.wanted(&second).ok(), Some(Some("T2")));
        assert!(tags(&[("T1", 1)]).wanted(&second).is_err());
        assert!(Tags::reads(Some("T2"), "") && !Tags::reads(Some("T2"), "T1"));
    }

    #[test]
    fn a_remark_or_a_garbled_line_is_no_tag() {
        let plain = Options::default();
        assert_eq!(tags(&[]).wanted(&plain).ok(), Some(None));
        assert_eq!(tags(&[("", 50), ("lap 1", 2)]).wanted(&plain).ok(), Some(None));
        assert_eq!(tags(&[("LOS", 50), ("NLOS", 40)]).wanted(&plain).ok(), Some(None));
        assert_eq!(tags(&[("1", 50), ("7", 1)]).wanted(&plain).ok(), Some(Some("1")));
        assert_eq!(tags(&[("1", 900), ("7", 8)]).wanted(&plain).ok(), Some(Some("1")));
        assert!(tags(&[("1", 900), ("7", 20)]).wanted(&plain).is_err());
    }
}
