//! Walks from record to record, over stretches that cannot be read.

use crate::damage::Fault;

/// The framing of records.
pub(super) trait Framing {
    /// The length of the record that these bytes may begin, which may exceed theirs; `None` if they cannot begin one.
    /// Records of unknown kinds are only accepted directly behind readable ones (`is_in_sequence`).
    fn length(&self, bytes: &[u8], is_in_sequence: bool) -> Option<usize>;

    /// Whether a record may begin with these bytes, which directly follow another record; used to confirm that one.
    fn follows(&self, bytes: &[u8]) -> bool;

    /// The offset, of at least one byte, at which a record may begin next.
    fn candidate(&self, bytes: &[u8]) -> Option<usize>;
}

/// One step of a walk.
#[derive(Debug, PartialEq)]
pub(super) enum Step<'a> {
    /// A record.
    Record(&'a [u8]),
    /// Bytes that cannot be read.
    Lost(Fault, &'a [u8]),
}

/// A walk through the records in bytes.
#[derive(Debug)]
pub(super) struct Walk<'a> {
    rest: &'a [u8],
    /// The number of the last step, from 1.
    pub(super) number: usize,
}

impl<'a> Walk<'a> {
    /// Begins a walk after `number` records.
    pub(super) fn new(bytes: &'a [u8], number: usize) -> Self {
        Self { rest: bytes, number }
    }

    /// The next step; `None` at the end.
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

/// The length of the complete record that these bytes begin with, if another record or the end follows it.
fn whole(framing: &impl Framing, bytes: &[u8], is_in_sequence: bool) -> Option<usize> {
    let length = framing.length(bytes, is_in_sequence).filter(|&length| length > 0)?;
    let rest = bytes.get(length..)?;
    (rest.is_empty() || framing.follows(rest)).then_some(length)
}
