//! The report that `host-sim design` prints.

use std::fmt;

use kestirim_design::Solution;
use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};

use super::answer::{Answer, Answered};
use super::steady::{Steady, Trim};
use crate::output;

/// The answers by section, in the order of the program.
#[derive(Debug, Clone)]
pub struct Report {
    /// The name and the answers of each section present in the file.
    pub sections: Vec<(&'static str, Vec<Answered>)>,
}

impl Report {
    /// Warnings for the user beside the answers.
    pub(super) fn warnings(&self) -> Vec<String> {
        let answers = || self.sections.iter().flat_map(|(_, answers)| answers);
        let unused = answers().filter(|answered| !answered.unused.is_empty());
        let mut warnings: Vec<_> = unused
            .map(|answered| {
                format!("{}: not used: {}", answered.name(), answered.unused.join(", "))
            })
            .collect();
        let is_refused = |answered: &Answered| matches!(answered.answer, Answer::Refused { .. });
        if answers().next().is_none() || answers().all(is_refused) {
            warnings.push("no case has an answer".to_owned());
        }
        warnings
    }
}

impl Serialize for Report {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(self.sections.len()))?;
        for (name, answers) in &self.sections {
            map.serialize_entry(name, answers)?;
        }
        map.end()
    }
}

impl fmt::Display for Report {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (name, answers) in &self.sections {
            let mut table = output::table();
            table.set_header([*name, "answer"]);
            for answered in answers {
                table.add_row([answered.name(), summary(&answered.answer)]);
            }
            writeln!(formatter, "{table}\n")?;
        }
        Ok(())
    }
}

fn summary(answer: &Answer) -> String {
    match answer {
        Answer::Refused { error } => format!("refused: {error}"),
        Answer::Flights { flights, refused } => {
            let refused = refused.iter().map(|problem| format!("refused: {problem}"));
            flights.iter().map(flight).chain(refused).collect::<Vec<_>>().join("\n")
        }
        Answer::Solved(Solution::Gain { gain, pole_error, digits_lost }) => {
            format!(
                "worst pole off by {pole_error:.1e} of itself ({digits_lost:.1} digits lost)\nL = {}",
                rows(gain)
            )
        }
        Answer::Solved(Solution::Filter { filter_gain, doublings, .. }) => {
            format!("{doublings} doublings\nK = {}", rows(filter_gain))
        }
        Answer::Solved(Solution::Discrete { a, b }) => {
            format!("Ad = {}\nBd = {}", rows(a), rows(b))
        }
        Answer::Solved(Solution::Covariance { covariance }) => {
            let deviations: Vec<_> =
                covariance.diagonal().iter().map(|value| format!("{:.4e}", value.sqrt())).collect();
            format!("RMSE {}", deviations.join(" "))
        }
    }
}

fn flight(flight: &Steady) -> String {
    let Trim { x: [alpha, ..], u: [elevator, throttle], .. } = flight.trim;
    let upper = flight.eigenvalues.iter().filter(|[_, im]| *im >= 0.0);
    let modes: Vec<_> = upper.map(|[re, im]| format!("{re:.3} ± {im:.3}i")).collect();
    format!(
        "{} m/s: α {alpha:.4}, δe {elevator:.4} rad, δt {throttle:.4}; {} 1/s",
        flight.airspeed,
        modes.join(", ")
    )
}

fn rows(matrix: &nalgebra::DMatrix<f64>) -> String {
    let row = |row: nalgebra::RowDVector<f64>| {
        let numbers: Vec<_> = row.iter().map(|value| format!("{value:.6}")).collect();
        numbers.join(" ")
    };
    let rows: Vec<_> = matrix.row_iter().map(|view| row(view.into_owned())).collect();
    rows.join("\n    ")
}
