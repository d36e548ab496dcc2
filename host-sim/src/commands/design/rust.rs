//! The answers as Rust constants.

use std::collections::BTreeSet;
use std::io::{self, Write};

use kestirim_design::Solution;
use nalgebra::DMatrix;

use super::answer::Answer;
use super::report::Report;
use super::steady::Steady;

/// Writes every matrix as an array of rows. Refused cases become comments.
pub(super) fn write(file: &mut dyn Write, report: &Report) -> io::Result<()> {
    writeln!(file, "// Written by `host-sim design --rust`; rows of matrices, SI units.")?;
    let mut used = BTreeSet::new();
    for (section, answers) in &report.sections {
        for answered in answers {
            let id = answered.name();
            let mut constant = |suffix: &str, what: &str, matrix: &DMatrix<f64>| {
                let name =
                    unique(&format!("{}_{suffix}", constant_case(&answered.name())), &mut used);
                write_constant(file, &name, &format!("{what}: {id} ({section})"), matrix)
            };
            match &answered.answer {
                Answer::Refused { error } => {
                    writeln!(file, "\n// {id} ({section}) was refused: {error}")?;
                }
                Answer::Flights { flights, refused } => {
                    for Steady { airspeed, trim, a, b, c, d, .. } in flights {
                        let speed = airspeed.to_string().replace('.', "_");
                        let matrices = [
                            ("A", of_rows(a)),
                            ("B", of_rows(b)),
                            ("C", of_rows(c)),
                            ("D", of_rows(d)),
                            ("X", of_rows(&[trim.x])),
                            ("U", of_rows(&[trim.u])),
                            ("Y", of_rows(&[trim.y])),
                        ];
                        for (letter, matrix) in matrices {
                            let what = format!("{letter} at {airspeed} m/s");
                            constant(&format!("{letter}_{speed}"), &what, &matrix)?;
                        }
                    }
                    for problem in refused {
                        writeln!(file, "\n// {id} ({section}) was refused: {problem}")?;
                    }
                }
                Answer::Solved(Solution::Gain { gain, .. }) => {
                    constant("L", "Gain of the observer in predictor form", gain)?;
                }
                Answer::Solved(Solution::Filter { filter_gain, predictor_gain, .. }) => {
                    constant("K", "Gain of the steady Kalman filter's update", filter_gain)?;
                    constant(
                        "L",
                        "Gain of the steady Kalman filter in predictor form",
                        predictor_gain,
                    )?;
                }
                Answer::Solved(Solution::Discrete { a, b }) => {
                    constant("A", "Transition matrix", a)?;
                    constant("B", "Input matrix", b)?;
                }
                Answer::Solved(Solution::Covariance { covariance }) => {
                    constant("P", "Covariance of the observer's error", covariance)?;
                }
            }
        }
    }
    Ok(())
}

fn of_rows<const C: usize>(rows: &[[f64; C]]) -> DMatrix<f64> {
    DMatrix::from_row_iterator(rows.len(), C, rows.iter().flatten().copied())
}

fn write_constant(
    file: &mut dyn Write,
    name: &str,
    what: &str,
    matrix: &DMatrix<f64>,
) -> io::Result<()> {
    let (rows, columns) = matrix.shape();
    writeln!(file, "\n/// {what}.\npub const {name}: [[f64; {columns}]; {rows}] = [")?;
    for row in matrix.row_iter() {
        let numbers: Vec<_> = row.iter().map(|value| format!("{value:?}")).collect();
        writeln!(file, "    [{}],", numbers.join(", "))?;
    }
    writeln!(file, "];")
}

/// Converts a text to an identifier of capital letters, digits and underscores.
fn constant_case(id: &str) -> String {
    let mut name = String::new();
    for character in id.chars() {
        if character.is_ascii_alphanumeric() {
            name.push(character.to_ascii_uppercase());
        } else if !name.ends_with('_') && !name.is_empty() {
            name.push('_');
        }
    }
    let name = name.trim_end_matches('_');
    if name.starts_with(|first: char| first.is_ascii_alphabetic()) {
        name.to_owned()
    } else {
        format!("CASE_{name}")
    }
}

/// The name, with a number appended if it was already used.
fn unique(name: &str, used: &mut BTreeSet<String>) -> String {
    let numbered = (2..).map(|count| format!("{name}_{count}"));
    let free = std::iter::once(name.to_owned()).chain(numbered).find(|name| !used.contains(name));
    let free = free.unwrap_or_else(|| name.to_owned());
    used.insert(free.clone());
    free
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_constants() {
        assert_eq!(
            constant_case("P2 thesis-like h=0.01 C=[V,theta]"),
            "P2_THESIS_LIKE_H_0_01_C_V_THETA"
        );
        assert_eq!(constant_case("1 § x"), "CASE_1_X");
        let mut used = BTreeSet::new();
        assert_eq!([unique("A", &mut used), unique("A", &mut used)], ["A", "A_2"]);
    }
}
