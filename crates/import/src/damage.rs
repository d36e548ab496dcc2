//! Lines or records of a log that cannot be samples: skipped, counted and told.

use crate::error::{Complaint, Error};
use crate::part::Part;

/// The share of a log that may be skipped. A hundredth is more than a logger loses on a good day, and less than the share
/// of a wrongly understood log whose lines seem damaged.
const SHARE: f64 = 0.01;
/// How many lines may be skipped of a log however short: one accident tears up to three lines (its end, a line beside it,
/// and what joins them).
const FEWEST: usize = 3;
/// How many lines are named of each kind.
const NAMED: usize = 3;

/// What is wrong with a line or a record.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Fault {
    /// The last one ends before its last field.
    Cut,
    /// A line has more or fewer fields than the header, or than the other lines; a record is not of the file's format.
    Torn,
    /// A field of a column that is needed holds no number.
    Foreign,
    /// It is the same as the one before.
    Doubled,
    /// Its time is before that of one before it, or far after that of all that follow.
    OutOfOrder,
    /// No sensor can have said it.
    OutOfRange,
    /// A reader cannot use it.
    Unusable,
}

impl Fault {
    fn words(self, part: Part) -> &'static str {
        match self {
            Self::Cut => "cut off",
            Self::Torn if part == Part::Record => "torn (unreadable)",
            Self::Torn => "torn (another number of fields)",
            Self::Foreign => "without a number where one is needed",
            Self::Doubled => "doubled",
            Self::OutOfOrder => "out of the order of time",
            Self::OutOfRange => "beyond any sensor's range",
            Self::Unusable => "unusable",
        }
    }
}

/// How many lines or records have a [`Fault`], and the first of them.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Loss {
    /// What they are.
    pub part: Part,
    /// What is wrong with them.
    pub fault: Fault,
    /// How many there are.
    pub count: usize,
    /// Up to three of them, in the order of the log.
    pub lines: Vec<usize>,
}

impl std::fmt::Display for Loss {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let (count, words) = (self.count, self.fault.words(self.part));
        let (noun, verb) = (self.part.noun(count), if count == 1 { "was" } else { "were" });
        let place = self.part.place(&self.lines, count > self.lines.len());
        write!(f, "{count} {noun} {words} {verb} skipped: {place}")
    }
}

/// What was skipped of a log.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Damage {
    /// A kind of fault each.
    pub losses: Vec<Loss>,
    /// Whether the last line has no line break: its last number may have lost digits.
    pub end_may_be_cut: bool,
    pub(crate) first: Option<Complaint>,
    /// What the log is made of.
    pub(crate) part: Part,
}

impl Damage {
    /// None yet.
    pub(crate) fn of(part: Part) -> Self {
        Self { part, ..Self::default() }
    }

    /// The same, of another part.
    pub(crate) fn named(mut self, part: Part) -> Self {
        self.losses.iter_mut().for_each(|loss| loss.part = part);
        self.first.iter_mut().for_each(|first| first.part = part);
        Self { part, end_may_be_cut: false, ..self }
    }

    /// That of several texts together; what is added then is of the first one.
    pub(crate) fn joined<const N: usize>(parts: [Self; N]) -> Self {
        let mut all = Self::of(parts.first().map_or(Part::Line, |first| first.part));
        for part in parts {
            all.losses.extend(part.losses);
            all.first = all.first.or(part.first);
        }
        all
    }

    /// How many lines or records were skipped.
    pub fn count(&self) -> usize {
        self.losses.iter().map(|loss| loss.count).sum()
    }

    /// A sentence for each kind of fault, with the numbers of lines or records.
    pub fn sentences(&self) -> Vec<String> {
        let cut = "the log does not end with a line break: its end may be cut";
        let cut = self.end_may_be_cut.then(|| cut.to_owned());
        self.losses.iter().map(Loss::to_string).chain(cut).collect()
    }

    /// How many lines may be skipped of a log of so many rows.
    pub(crate) fn allowed(rows: usize) -> usize {
        FEWEST.max((rows as f64 * SHARE) as usize)
    }

    /// Counts a line or record; the complaint is put in words if it is the first one.
    pub fn add(&mut self, fault: Fault, line: usize, problem: impl FnOnce() -> String) {
        self.add_some(fault, line, 1, problem);
    }

    /// Counts as many as were lost at one place.
    pub(crate) fn add_some(
        &mut self,
        fault: Fault,
        line: usize,
        count: usize,
        problem: impl FnOnce() -> String,
    ) {
        let part = self.part;
        if self.first.as_ref().is_none_or(|first| line < first.line) {
            self.first = Some(Complaint { part, line, problem: problem() });
        }
        let at = self.losses.iter().position(|loss| (loss.part, loss.fault) == (part, fault));
        let at = at.unwrap_or_else(|| {
            self.losses.push(Loss { part, fault, count: 0, lines: Vec::new() });
            self.losses.len() - 1
        });
        let loss = &mut self.losses[at];
        loss.count += count;
        if loss.lines.len() < NAMED {
            loss.lines.push(line);
        }
    }

    /// Accepts what may be skipped of so many rows; nothing if `strict`.
    ///
    /// # Errors
    /// [`Error::Line`] or [`Error::Part`] at the first damaged one if `strict`; [`Error::Damaged`] if there are too many.
    pub fn accept(&self, rows: usize, strict: bool) -> Result<(), Error> {
        let Some(first) = &self.first else { return Ok(()) };
        let (allowed, found) = (Self::allowed(rows), self.count());
        // Of a log of three lines not all three may be skipped.
        if strict || rows <= found {
            return Err(first.clone().into());
        }
        if found > allowed {
            return Err(Error::Damaged { allowed, rows, found, first: first.clone() });
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn damage(lines: usize) -> Damage {
        let mut damage = Damage::default();
        for line in 0..lines {
            damage.add(Fault::Torn, line + 2, || "expected 7 fields, found 6".to_owned());
        }
        damage
    }

    #[test]
    fn a_hundredth_may_be_skipped_and_three_lines_of_a_short_log() {
        assert!(damage(3).accept(10, false).is_ok());
        assert!(damage(4).accept(10, false).is_err());
        assert!(damage(10).accept(1000, false).is_ok());
        let error = damage(11).accept(1000, false).unwrap_err().to_string();
        assert!(
            error.starts_with("expected at most 10 damaged lines of 1000, found 11"),
            "{error}"
        );
        let error = damage(1).accept(1000, true).unwrap_err().to_string();
        assert_eq!(error, "line 2: expected 7 fields, found 6");
    }

    #[test]
    fn three_lines_are_named() {
        assert_eq!(
            damage(5).sentences(),
            ["5 lines torn (another number of fields) were skipped: lines 2, 3, 4, …"]
        );
        assert_eq!(
            damage(1).sentences(),
            ["1 line torn (another number of fields) was skipped: line 2"]
        );
    }
}
