//! Damaged lines or records of a log: they are skipped, counted and reported.

use crate::error::{Complaint, Error};
use crate::part::Part;

/// The share of a log that may be skipped: 0.01 is more than a logger usually loses, and less than the share of a
/// misunderstood log whose lines seem damaged.
const SHARE: f64 = 0.01;
/// The number of lines that may be skipped of any log, however short: one accident tears up to three lines (its end, a
/// line beside it, and what joins them).
const FEWEST: usize = 3;
/// The number of lines named for each kind of fault.
const NAMED: usize = 3;

/// What is wrong with a line or a record.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Fault {
    /// The log ends before the last field of its last line or record.
    Cut,
    /// A line has more or fewer fields than the header, or than the other lines; a record is not of the file's format.
    Torn,
    /// A required column holds no number.
    Foreign,
    /// The line or record repeats the one before it.
    Doubled,
    /// Its time precedes that of an earlier one, or lies far beyond those of all that follow.
    OutOfOrder,
    /// Its values exceed what any sensor can measure.
    OutOfRange,
    /// The line or record is well-formed, but the reader cannot use it.
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

/// The number of lines or records with a certain [`Fault`], and the first few of them.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Loss {
    /// Whether lines or records are counted.
    pub part: Part,
    /// What is wrong with these lines or records.
    pub fault: Fault,
    /// The number of lines or records with this fault.
    pub count: usize,
    /// The numbers of up to three of them, in the order of the log.
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

/// Everything that was skipped of a log.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Damage {
    /// One entry for each kind of fault.
    pub losses: Vec<Loss>,
    /// Whether the last line lacks its line break, so that its last number may have lost digits.
    pub end_may_be_cut: bool,
    pub(crate) first: Option<Complaint>,
    /// What the log consists of: lines or records.
    pub(crate) part: Part,
}

impl Damage {
    /// No damage yet, to be counted in `part`s.
    pub(crate) fn of(part: Part) -> Self {
        Self { part, ..Self::default() }
    }

    /// The same damage, attributed to another kind of part.
    pub(crate) fn named(mut self, part: Part) -> Self {
        self.losses.iter_mut().for_each(|loss| loss.part = part);
        self.first.iter_mut().for_each(|first| first.part = part);
        Self { part, end_may_be_cut: false, ..self }
    }

    /// Joins the damage of several texts; damage that is added later counts as the first text's.
    pub(crate) fn joined<const N: usize>(parts: [Self; N]) -> Self {
        let mut all = Self::of(parts.first().map_or(Part::Line, |first| first.part));
        for part in parts {
            all.losses.extend(part.losses);
            all.first = all.first.or(part.first);
        }
        all
    }

    /// The total number of lines or records that were skipped.
    pub fn count(&self) -> usize {
        self.losses.iter().map(|loss| loss.count).sum()
    }

    /// One sentence for each kind of fault, with the numbers of the lines or records.
    pub fn sentences(&self) -> Vec<String> {
        let cut = "the log does not end with a line break: its end may be cut";
        let cut = self.end_may_be_cut.then(|| cut.to_owned());
        self.losses.iter().map(Loss::to_string).chain(cut).collect()
    }

    /// The number of lines that may be skipped of a log with `rows` rows.
    pub(crate) fn allowed(rows: usize) -> usize {
        FEWEST.max((rows as f64 * SHARE) as usize)
    }

    /// Counts one line or record; `problem` is called only for the first one.
    pub fn add(&mut self, fault: Fault, line: usize, problem: impl FnOnce() -> String) {
        self.add_some(fault, line, 1, problem);
    }

    /// Counts `count` lines or records that were lost at one place.
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

    /// Accepts the damage if few enough of the rows are affected; if `strict`, only if there is none.
    ///
    /// # Errors
    /// [`Error::Line`] or [`Error::Part`] at the first damaged one if `strict`; [`Error::Damaged`] if there are too
    /// many.
    pub fn accept(&self, rows: usize, strict: bool) -> Result<(), Error> {
        let Some(first) = &self.first else { return Ok(()) };
        let (allowed, found) = (Self::allowed(rows), self.count());
        // A log of three lines must not lose all three.
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
