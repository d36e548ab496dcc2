//! The output of an image: lines of `key=value`.

use anyhow::{Context, Result};

/// The entire output of an image, in order.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Output {
    lines: Vec<(String, String)>,
}

/// A position estimate of a tracker.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Position {
    /// The time since the start of the stream, µs.
    pub time_us: i64,
    /// The position, m, with a resolution of a micrometre.
    pub metres: [f64; 3],
}

/// The number of instructions of the steps of one class.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cost {
    /// The number of steps.
    pub steps: u64,
    /// The instructions of the shortest step.
    pub min: u64,
    /// The instructions of the longest step.
    pub max: u64,
    /// The instructions of all steps together.
    pub total: u64,
}

impl Cost {
    /// The mean number of instructions of a step.
    pub fn mean(&self) -> f64 {
        self.total as f64 / self.steps as f64
    }

    /// Combines the costs of two classes of steps.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self {
            steps: self.steps + other.steps,
            min: self.min.min(other.min),
            max: self.max.max(other.max),
            total: self.total + other.total,
        }
    }
}

impl Output {
    /// Parses lines of `key=value`.
    pub(crate) fn parse(told: &str) -> Result<Self> {
        let pair = |line: &str| {
            let (key, value) =
                line.split_once('=').with_context(|| format!("not key=value: {line:?}"))?;
            Ok((key.to_owned(), value.to_owned()))
        };
        Ok(Self { lines: told.lines().map(pair).collect::<Result<_>>()? })
    }

    /// The value of a key that occurs once.
    ///
    /// # Errors
    /// The key is missing.
    pub fn text(&self, key: &str) -> Result<&str> {
        self.all(key).next().with_context(|| format!("the image did not tell {key}"))
    }

    /// The numbers of a key that occurs once.
    ///
    /// # Errors
    /// The key is missing, or does not have `N` numbers.
    pub fn numbers<const N: usize>(&self, key: &str) -> Result<[i64; N]> {
        numbers(self.text(key)?)
    }

    /// The cost of the steps of one class, if there were any; `meter` is the name under which the meter reported it.
    ///
    /// # Errors
    /// The cost does not consist of four counts.
    pub fn cost(&self, meter: &str, class: &str) -> Result<Option<Cost>> {
        let Some(value) = self.all(&format!("{meter}.{class}")).next() else {
            return Ok(None);
        };
        let [steps, min, max, total] = numbers(value)?.map(|number: i64| number as u64);
        Ok(Some(Cost { steps, min, max, total }))
    }

    /// The numbers in every line of a key.
    ///
    /// # Errors
    /// A line of the key does not have `N` numbers.
    pub fn rows<const N: usize>(&self, key: &str) -> Result<Vec<[i64; N]>> {
        self.all(key).map(numbers).collect()
    }

    /// The positions that a replaying image printed.
    ///
    /// # Errors
    /// A position does not consist of four numbers.
    pub fn positions(&self) -> Result<Vec<Position>> {
        let position = |value| {
            let [time_us, metres @ ..] = numbers::<4>(value)?;
            Ok(Position { time_us, metres: metres.map(|micrometres| micrometres as f64 * 1e-6) })
        };
        self.all("position").map(position).collect()
    }

    fn all(&self, key: &str) -> impl Iterator<Item = &str> {
        self.lines.iter().filter(move |(told, _)| told == key).map(|(_, value)| value.as_str())
    }
}

fn numbers<const N: usize>(value: &str) -> Result<[i64; N]> {
    let numbers: Vec<i64> = value
        .split_whitespace()
        .map(str::parse)
        .collect::<Result<_, _>>()
        .with_context(|| format!("not numbers: {value:?}"))?;
    let count = numbers.len();
    numbers.try_into().ok().with_context(|| format!("{count} numbers instead of {N}: {value:?}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_taken_apart() {
        let output = Output::parse(
            "name=walk\nposition=500000 1000000 -250000 0\nstep.predict=2 3 5 8\nstep.stack=96\n",
        )
        .unwrap();
        assert_eq!(output.text("name").unwrap(), "walk");
        assert_eq!(output.numbers("step.stack").unwrap(), [96]);
        assert_eq!(
            output.positions().unwrap(),
            [Position { time_us: 500_000, metres: [1.0, -0.25, 0.0] }]
        );
        let cost = output.cost("step", "predict").unwrap().unwrap();
        assert_eq!(cost, Cost { steps: 2, min: 3, max: 5, total: 8 });
        assert_eq!(output.cost("step", "update").unwrap(), None);
    }

    #[test]
    fn a_wrong_line_is_refused() {
        assert!(Output::parse("a line without a value\n").is_err());
        let output = Output::parse("position=1 2 3\n").unwrap();
        assert!(output.positions().is_err());
        assert!(output.text("name").is_err());
    }
}
