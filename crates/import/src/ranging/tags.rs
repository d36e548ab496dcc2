//! The tags whose ranges one log holds.

use crate::error::{Error, listed, quoted};
use crate::options::Options;

/// The percentage of a log's lines that a tag must have: a digit that was garbled is no tag.
const LEAST: usize = 1;

/// The distinct tags of a log, in order of appearance, with their numbers of lines.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Tags(Vec<(String, usize)>);

impl Tags {
    /// Notes the tag of a line; a blank is none.
    pub fn note(&mut self, tag: &str) {
        let tag = tag.trim();
        if tag.is_empty() {
            return;
        }
        match self.0.iter_mut().find(|(known, _)| known == tag) {
            Some((_, count)) => *count += 1,
            None => self.0.push((tag.to_owned(), 1)),
        }
    }

    /// The tag to read: the one that an option names (`topic`), or the only one; `None` if the log names none.
    ///
    /// # Errors
    /// If there are several and no option chooses, or if there is none of that name.
    pub fn wanted(&self, options: &Options) -> Result<Option<&str>, Error> {
        let all: usize = self.0.iter().map(|(_, count)| count).sum();
        let many = self.0.iter().filter(|(_, count)| 100 * count >= LEAST * all);
        let tags: Vec<&str> = many.map(|(tag, _)| tag.as_str()).collect();
        let found = || {
            let all: Vec<_> = tags.iter().map(|tag| quoted(tag)).collect();
            listed(all.iter().map(String::as_str))
        };
        match (&options.topic, &tags[..]) {
            (_, []) => Ok(None),
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
            (None, [tag]) => Ok(Some(*tag)),
            (None, [first, ..]) => {
                let problem = format!("expected the ranges of one tag, found those of {}", found());
                Err(Error::undecided(problem, format!("--topic {first}")))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_of_several_tags_must_be_chosen() {
        let plain = Options::default();
        let second = Options { topic: Some("t2".to_owned()), ..Options::default() };
        let mut tags = Tags::default();
        assert_eq!(tags.wanted(&second).ok(), Some(None));
        tags.note(" T1 ");
        tags.note("");
        tags.note("T1");
        assert_eq!(tags.wanted(&plain).ok(), Some(Some("T1")));
        assert!(tags.wanted(&second).is_err());
        tags.note("T2");
        let problem = tags.wanted(&plain).unwrap_err().to_string();
        let expected =
            "expected the ranges of one tag, found those of \"T1\", \"T2\"; --topic T1 decides";
        assert_eq!(problem, expected);
        assert_eq!(tags.wanted(&second).ok(), Some(Some("T2")));
        (0..200).for_each(|_| tags.note("T1"));
        assert_eq!(tags.wanted(&plain).ok(), Some(Some("T1")), "a garbled line");
    }
}
