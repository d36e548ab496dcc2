//! The answers to cases.

use kestirim_design::{self as design, MOST_STATES, MOST_WIDE, Observed, Solution};
use nalgebra::DMatrix;
use serde::Serialize;
use serde_json::Value;

use super::case::{Case, Problem};
use super::steady::{self, Steady};

/// A case and its answer.
#[derive(Debug, Clone, Serialize)]
pub struct Answered {
    /// The identifier of the case, as given in the file.
    pub id: Value,
    /// The answer.
    #[serde(flatten)]
    pub answer: Answer,
    /// The fields of the case that were not used.
    #[serde(skip)]
    pub unused: Vec<String>,
}

impl Answered {
    /// Answers a case. An error in the case becomes its answer.
    pub(super) fn new(value: &Value, answer: fn(&Case) -> Result<Answer, Problem>) -> Self {
        let id = value.get("id").cloned().unwrap_or_default();
        let mut unused = Vec::new();
        let answered = Case::new(value).and_then(|case| {
            let answer = answer(&case)?;
            unused = case.unused();
            Ok(answer)
        });
        let answer = answered.unwrap_or_else(|error| Answer::Refused { error });
        Self { id, answer, unused }
    }

    /// The name of the case for people, escaped so that it stays on one line whatever it holds.
    pub fn name(&self) -> String {
        let name = self.id.as_str().map_or_else(|| self.id.to_string(), str::to_owned);
        let legible = |character: char| !character.escape_debug().to_string().starts_with("\\u");
        name.chars()
            .map(
                |character| {
                    if legible(character) && !character.is_control() { character } else { '?' }
                },
            )
            .collect()
    }
}

/// A solution, or the reason why there is none.
#[derive(Debug, Clone, Serialize)]
#[serde(untagged)]
pub enum Answer {
    /// The requested solution.
    Solved(Solution),
    /// Steady flights at the requested airspeeds.
    Flights {
        /// The flights, one for each airspeed at which the aircraft can fly.
        flights: Vec<Steady>,
        /// The reasons why the other airspeeds have no flight.
        #[serde(skip_serializing_if = "Vec::is_empty")]
        refused: Vec<String>,
    },
    /// The case was refused.
    Refused {
        /// The reason, in one sentence.
        error: String,
    },
}

type Section = (&'static str, fn(&Case) -> Result<Answer, Problem>);

/// The sections of a file, each with the function that answers its cases.
pub(super) const SECTIONS: [Section; 8] = [
    ("pole_placement", placement),
    ("must_reject", placement),
    ("dare", riccati),
    ("dare_reject", riccati),
    ("c2d", discretisation),
    ("lyapunov", covariance),
    ("reduced_order", reduced_order),
    ("airframe", airframe),
];

fn airframe(case: &Case) -> Result<Answer, Problem> {
    let (flights, refused) = steady::flights(case)?;
    Ok(Answer::Flights { flights, refused })
}

fn placement(case: &Case) -> Result<Answer, Problem> {
    let a = case.square("A", MOST_STATES)?;
    let c = case.outputs("C", a.nrows(), MOST_WIDE)?;
    let states: Vec<_> = (0..a.nrows()).collect();
    told(design::place(&a, &c, &case.poles(a.nrows())?, &states))
}

/// Answers a case of a reduced-order observer: the unmeasured states are observed through their effect on the measured
/// ones, which gives a pair (A, C) of its own.
fn reduced_order(case: &Case) -> Result<Answer, Problem> {
    let a = case.square("A", MOST_STATES)?;
    let measured = case.states("measured", a.nrows())?;
    let unmeasured = case.states("unmeasured", a.nrows())?;
    if measured.is_empty()
        || unmeasured.is_empty()
        || measured.iter().any(|state| unmeasured.contains(state))
    {
        return Err("measured, unmeasured: expected some of each, and none that is both".to_owned());
    }
    let part = |rows: &[usize]| a.select_rows(rows).select_columns(&unmeasured);
    told(design::place(
        &part(&unmeasured),
        &part(&measured),
        &case.poles(unmeasured.len())?,
        &unmeasured,
    ))
}

fn riccati(case: &Case) -> Result<Answer, Problem> {
    let a = case.square("A", MOST_STATES)?;
    let c = case.outputs("C", a.nrows(), MOST_WIDE)?;
    let q = case.matrix_of("Q", a.nrows(), a.nrows())?;
    let r = case.matrix_of("R", c.nrows(), c.nrows())?;
    told(design::riccati(&a, &c, &q, &r))
}

fn discretisation(case: &Case) -> Result<Answer, Problem> {
    let a = case.square("A", MOST_STATES)?;
    let b = case.inputs("B", a.nrows(), MOST_WIDE)?;
    told(design::discretise(&a, &b, case.number("h")?))
}

/// Answers a case of P = F P Fᵀ + B Qu Bᵀ + L R Lᵀ with F = A − L C, or with Q instead of B Qu Bᵀ; without L, of P = A
/// P Aᵀ + Q.
fn covariance(case: &Case) -> Result<Answer, Problem> {
    let a = case.square("A", MOST_STATES)?;
    let states = a.nrows();
    if !case.has("L") {
        return told(design::lyapunov(&a, &case.matrix_of("Q", states, states)?));
    }
    let process = if case.has("Q_input") {
        let b = case.inputs("B", states, MOST_WIDE)?;
        let q = case.matrix_of("Q_input", b.ncols(), b.ncols())?;
        [b, q]
    } else {
        [DMatrix::identity(states, states), case.matrix_of("Q", states, states)?]
    };
    let c = case.outputs("C", states, MOST_WIDE)?;
    let gain = case.matrix_of("L", states, c.nrows())?;
    let r = case.matrix_of("R", c.nrows(), c.nrows())?;
    told(design::error_covariance(&Observed { a, c, gain, process, r }))
}

/// Converts a design error to a sentence.
fn told(designed: Result<Solution, design::Error>) -> Result<Answer, Problem> {
    designed.map(Answer::Solved).map_err(|error| error.to_string())
}
