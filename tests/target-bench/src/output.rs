//! What an image told: lines of `key=value`.

use anyhow::{Context, Result};

/// Everything an image told, in its order.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Output {
    lines: Vec<(String, String)>,
}

/// Where a tracker believed to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Position {
    /// Microseconds since the start of the stream.
    pub time_us: i64,
    /// Metres, told to the micrometre.
    pub metres: [f64; 3],
}

/// Instructions of the steps of one class.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cost {
    /// How many steps there were.
    pub steps: u64,
    /// Instructions of the shortest.
    pub min: u64,
    /// Instructions of the longest.
    pub max: u64,
    /// Instructions of all together.
    pub total: u64,
}

impl Cost {
    /// Instructions of a step on average.
    pub fn mean(&self) -> f64 {
        self.total as f64 / self.steps as f64
    }

    /// The cost of the steps of two classes together.
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
    /// Takes lines of `key=value` apart.
    pub(crate) fn parse(told: &str) -> Result<Self> {
        let pair = |line: &str| {
            let (key, value) =
                line.split_once('=').with_context(|| format!("not key=value: {line:?}"))?;
            Ok((key.to_owned(), value.to_owned()))
        };
        Ok(Self { lines: told.lines().map(pair).collect::<Result<_>>()? })
    }

    /// The value of a key that was told once.
    ///
    /// # Errors
    /// The key was not told.
    pub fn text(&self, key: &str) -> Result<&str> {
        self.all(key).next().with_context(|| format!("the image did not tell {key}"))
    }

    /// The numbers of a key that was told once.
    ///
    /// # Errors
    /// The key was not told, or not with `N` numbers.
    pub fn numbers<const N: usize>(&self, key: &str) -> Result<[i64; N]> {
        numbers(self.text(key)?)
    }

    /// The cost of the steps of one class, if there were any; `meter` is the name that the meter
    /// reported under.
    ///
    /// # Errors
    /// The cost was not told as four counts.
    pub fn cost(&self, meter: &str, class: &str) -> Result<Option<Cost>> {
        let Some(value) = self.all(&format!("{meter}.{class}")).next() else {
            return Ok(None);
        };
        let [steps, min, max, total] = numbers(value)?.map(|number: i64| number as u64);
        Ok(Some(Cost { steps, min, max, total }))
    }

    /// The numbers of every line of a key.
    ///
    /// # Errors
    /// The key was told, but not with `N` numbers.
    pub fn rows<const N: usize>(&self, key: &str) -> Result<Vec<[i64; N]>> {
        self.all(key).map(numbers).collect()
    }

    /// The positions that a replaying image told.
    ///
    /// # Errors
    /// A position was not told as four numbers.
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
