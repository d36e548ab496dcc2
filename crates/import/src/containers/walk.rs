//! A walk from record to record, over stretches that cannot be read.

use crate::damage::Fault;

/// How records are told apart.
pub(super) trait Framing {
    /// The length of a record that begins with these bytes, if one may; it may be longer than they are. Records of kinds
    /// that are not known only follow readable ones (`is_in_sequence`).
    fn length(&self, bytes: &[u8], is_in_sequence: bool) -> Option<usize>;

    /// Whether a record may begin with these bytes, which follow another one that may tell what this one is.
    fn follows(&self, bytes: &[u8]) -> bool;

    /// Where a record may begin next, at least one byte on.
    fn candidate(&self, bytes: &[u8]) -> Option<usize>;
}

/// What comes next.
#[derive(Debug, PartialEq)]
pub(super) enum Step<'a> {
    /// A record.
    Record(&'a [u8]),
    /// Bytes that cannot be read.
    Lost(Fault, &'a [u8]),
}

/// A walk through bytes.
#[derive(Debug)]
pub(super) struct Walk<'a> {
    rest: &'a [u8],
    /// The number of the last step, from 1.
    pub(super) number: usize,
}

impl<'a> Walk<'a> {
    /// Begins behind so many records.
    pub(super) fn new(bytes: &'a [u8], number: usize) -> Self {
        Self { rest: bytes, number }
    }

    /// The next step; none at the end.
    pub(super) fn next(&mut self, framing: &impl Framing) -> Option<Step<'a>> {
        if self.rest.is_empty() {
            return None;
        }
        self.number += 1;
        if let Some(length) = whole(framing, self.rest, true) {
            let (record, rest) = self.rest.split_at_checked(length)?;
            self.rest = rest;
            return Some(Step::Record(record));
        }
        let mut skipped = 0;
        while let Some(rest) = self.rest.get(skipped..)
            && let Some(on) = framing.candidate(rest)
        {
            skipped += on.max(1);
            let Some((lost, rest)) = self.rest.split_at_checked(skipped) else { break };
            if whole(framing, rest, false).is_some() {
                self.rest = rest;
                return Some(Step::Lost(Fault::Torn, lost));
            }
        }
        let lost = std::mem::take(&mut self.rest);
        let is_cut = framing.length(lost, true).is_some_and(|length| length > lost.len());
        Some(Step::Lost(if is_cut { Fault::Cut } else { Fault::Torn }, lost))
    }
}

/// The length of a whole record that begins with these bytes and that another one or the end follows.
fn whole(framing: &impl Framing, bytes: &[u8], is_in_sequence: bool) -> Option<usize> {
    let length = framing.length(bytes, is_in_sequence).filter(|&length| length > 0)?;
    let rest = bytes.get(length..)?;
    (rest.is_empty() || framing.follows(rest)).then_some(length)
}
