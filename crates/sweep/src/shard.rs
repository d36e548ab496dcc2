//! Shards: the parts of a plan that are computed separately.

use std::fmt;
use std::ops::Range;
use std::str::FromStr;

/// The environment variables by which job engines tell a task its number, the first number and the number of tasks.
const ENGINES: [(&str, Option<&str>, Option<&str>); 3] = [
    ("HQ_TASK_ID", None, None),
    ("SLURM_ARRAY_TASK_ID", Some("SLURM_ARRAY_TASK_MIN"), Some("SLURM_ARRAY_TASK_COUNT")),
    ("JOB_COMPLETION_INDEX", None, None),
];

/// Shard `index` of `count`: a contiguous range of rows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shard {
    /// The number of the shard, counted from 0.
    pub index: u64,
    /// The number of shards.
    pub count: u64,
}

impl Shard {
    /// A shard; `None` if `index` is not below `count`.
    pub fn new(index: u64, count: u64) -> Option<Self> {
        (index < count).then_some(Self { index, count })
    }

    /// The range of this shard among `rows` rows. The sizes of shards differ by at most one row, and together they
    /// cover all rows.
    pub fn range(self, rows: u64) -> Range<u64> {
        let part = |index: u64| {
            (u128::from(rows) * u128::from(index) / u128::from(self.count.max(1))) as u64
        };
        part(self.index)..part(self.index + 1)
    }

    /// The shard that an engine's variables name, and the name of the variable; `None` without an engine. The number of
    /// shards is `count` if given, else what the engine says.
    ///
    /// # Errors
    /// One sentence, if the variable does not hold the number of a shard, or the number of shards is unknown.
    pub fn of_engine(
        variable: impl Fn(&str) -> Option<String>,
        count: Option<u64>,
    ) -> Result<Option<(Self, &'static str)>, String> {
        let number = |name: &str| {
            let text = variable(name);
            text.map(|text| text.trim().parse::<u64>().map_err(|_| wrong(name, &text))).transpose()
        };
        for (name, first, all) in ENGINES {
            let Some(id) = number(name)? else { continue };
            // A plan that says how many shards there are counts them from 0, whichever of them are asked for again.
            let (first, count) = match count {
                Some(count) => (0, Some(count)),
                None => {
                    (first.map_or(Ok(None), number)?.unwrap_or(0), all.map_or(Ok(None), number)?)
                }
            };
            let count = count.ok_or_else(|| {
                format!(
                    "{name} is {id}, but of how many? Say shards = N in the plan, or --shard {id}/N"
                )
            })?;
            let shard = id.checked_sub(first).and_then(|index| Self::new(index, count));
            let shard = shard.ok_or_else(|| {
                format!("{name} is {id}, but there are {count} shards, counted from {first}")
            })?;
            return Ok(Some((shard, name)));
        }
        Ok(None)
    }
}

fn wrong(name: &str, text: &str) -> String {
    format!("{name} is {text:?}, expected a whole number")
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers = text.split_once('/').and_then(|(index, count)| {
            Self::new(index.trim().parse().ok()?, count.trim().parse().ok()?)
        });
        numbers.ok_or_else(|| "expected I/N, from 0/N to N-1/N".to_owned())
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.index, self.count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn shards_are_all_rows_once(rows in any::<u64>(), count in 1_u64..500) {
            let mut next = 0;
            for index in 0..count {
                let range = Shard::new(index, count).unwrap().range(rows);
                prop_assert_eq!(range.start, next);
                let size = range.end - range.start;
                prop_assert!(size == rows / count || size == rows / count + 1);
                next = range.end;
            }
            prop_assert_eq!(next, rows);
        }
    }

    #[test]
    fn what_is_no_shard_is_refused() {
        assert_eq!("2/7".parse::<Shard>(), Ok(Shard { index: 2, count: 7 }));
        for text in ["7/7", "1", "-1/7", "1/0", "a/b", "0/7/9", ""] {
            assert!(text.parse::<Shard>().is_err(), "{text}");
        }
    }

    fn engine(variables: &[(&str, &str)], count: Option<u64>) -> Result<Option<String>, String> {
        let variable = |name: &str| {
            let found = variables.iter().find(|(of, _)| *of == name);
            found.map(|(_, text)| (*text).to_owned())
        };
        Ok(Shard::of_engine(variable, count)?.map(|(shard, _)| shard.to_string()))
    }

    #[test]
    fn engines_tell_which_shard() {
        let shard = |text: &str| Ok(Some(text.to_owned()));
        assert_eq!(engine(&[], Some(7)), Ok(None));
        assert_eq!(engine(&[("HQ_TASK_ID", "3")], Some(7)), shard("3/7"));
        assert_eq!(engine(&[("JOB_COMPLETION_INDEX", "0")], Some(7)), shard("0/7"));
        let slurm = |id, first, all| {
            let min = ("SLURM_ARRAY_TASK_MIN", first);
            [("SLURM_ARRAY_TASK_ID", id), min, ("SLURM_ARRAY_TASK_COUNT", all)]
        };
        assert_eq!(engine(&slurm("3", "1", "7"), None), shard("2/7"));
        // Two of seven are done again: the engine's count is of those two.
        assert_eq!(engine(&slurm("5", "3", "2"), Some(7)), shard("5/7"));
        assert!(engine(&slurm("5", "3", "2"), None).is_err());
        assert!(engine(&[("HQ_TASK_ID", "3")], None).unwrap_err().contains("shards = N"));
        assert!(engine(&[("HQ_TASK_ID", "7")], Some(7)).is_err());
        assert!(engine(&[("HQ_TASK_ID", "x")], Some(7)).is_err());
    }
}
