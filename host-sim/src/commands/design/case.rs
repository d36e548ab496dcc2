//! A case as given in the file.

use std::cell::RefCell;
use std::collections::BTreeSet;

use nalgebra::{Complex, DMatrix};
use serde_json::{Map, Value};

/// The field that identifies a case.
const NAME: &str = "id";

/// The fields of a case. Each is validated when it is requested.
pub(super) struct Case<'a> {
    fields: &'a Map<String, Value>,
    asked: RefCell<BTreeSet<String>>,
    left: RefCell<Vec<String>>,
}

/// A sentence that describes what is wrong with a case.
pub(super) type Problem = String;

impl<'a> Case<'a> {
    pub(super) fn new(value: &'a Value) -> Result<Self, Problem> {
        let fields = value.as_object().ok_or("expected an object")?;
        Ok(Self { fields, asked: RefCell::default(), left: RefCell::default() })
    }

    /// Records a part of a field as unused.
    pub(super) fn leave(&self, path: &str) {
        self.left.borrow_mut().push(path.to_owned());
    }

    /// The paths of fields that were not used.
    pub(super) fn unused(&self) -> Vec<String> {
        let asked = self.asked.borrow();
        let is_unused = |name: &&String| !asked.contains(*name) && *name != NAME;
        let fields = self.fields.keys().filter(is_unused).cloned();
        fields.chain(self.left.borrow().iter().cloned()).collect()
    }

    pub(super) fn field(&self, name: &str) -> Result<&'a Value, Problem> {
        self.asked.borrow_mut().insert(name.to_owned());
        self.fields.get(name).ok_or_else(|| format!("{name} is missing"))
    }

    pub(super) fn has(&self, name: &str) -> bool {
        self.fields.contains_key(name)
    }

    /// A number; null is read as NaN.
    pub(super) fn number(&self, name: &str) -> Result<f64, Problem> {
        number(self.field(name)?).ok_or_else(|| format!("{name}: expected a number"))
    }

    /// A list of rows of equal length; null is read as NaN.
    pub(super) fn matrix(&self, name: &str) -> Result<DMatrix<f64>, Problem> {
        let wrong =
            || format!("{name}: expected a list of rows of numbers, all of the same length");
        let row =
            |value: &Value| -> Option<Vec<f64>> { value.as_array()?.iter().map(number).collect() };
        let rows = self.field(name)?.as_array().ok_or_else(wrong)?;
        let rows: Vec<Vec<f64>> = rows.iter().map(row).collect::<Option<_>>().ok_or_else(wrong)?;
        let columns = rows.first().map_or(0, Vec::len);
        if columns == 0 || rows.iter().any(|row| row.len() != columns) {
            return Err(wrong());
        }
        Ok(DMatrix::from_row_iterator(rows.len(), columns, rows.into_iter().flatten()))
    }

    /// A matrix of a given size.
    pub(super) fn matrix_of(
        &self,
        name: &str,
        rows: usize,
        columns: usize,
    ) -> Result<DMatrix<f64>, Problem> {
        of_size(name, self.matrix(name)?, rows, columns)
    }

    /// The square state matrix A, with at most as many states as the program was built for.
    pub(super) fn square(&self, name: &str, most: usize) -> Result<DMatrix<f64>, Problem> {
        let matrix = self.matrix(name)?;
        let (rows, columns) = matrix.shape();
        if rows != columns {
            return Err(format!(
                "{name}: expected as many rows as columns, found {rows} × {columns}"
            ));
        }
        if rows > most {
            return Err(format!("{name}: expected at most {most} states, found {rows}"));
        }
        Ok(matrix)
    }

    /// A matrix with a column per state, and at most as many outputs (rows) as the program was built for.
    pub(super) fn outputs(
        &self,
        name: &str,
        states: usize,
        most: usize,
    ) -> Result<DMatrix<f64>, Problem> {
        let matrix = self.matrix(name)?;
        let outputs = matrix.nrows();
        if outputs > most {
            return Err(format!("{name}: expected at most {most} outputs, found {outputs}"));
        }
        of_size(name, matrix, outputs, states)
    }

    /// A matrix with a row per state, and at most as many inputs (columns) as the program was built for.
    pub(super) fn inputs(
        &self,
        name: &str,
        states: usize,
        most: usize,
    ) -> Result<DMatrix<f64>, Problem> {
        let matrix = self.matrix(name)?;
        let inputs = matrix.ncols();
        if inputs > most {
            return Err(format!("{name}: expected at most {most} inputs, found {inputs}"));
        }
        of_size(name, matrix, states, inputs)
    }

    /// The poles, one per state: pairs of real and imaginary part, or real numbers.
    pub(super) fn poles(&self, states: usize) -> Result<Vec<Complex<f64>>, Problem> {
        let wrong = || "poles: expected a list of pairs of numbers".to_owned();
        let pole = |value: &Value| match value.as_array().map(Vec::as_slice) {
            Some([re, im]) => Some(Complex::new(number(re)?, number(im)?)),
            Some(_) => None,
            None => number(value).map(Complex::from),
        };
        let list = self.field("poles")?.as_array().ok_or_else(wrong)?;
        let poles: Vec<_> = list.iter().map(pole).collect::<Option<_>>().ok_or_else(wrong)?;
        if poles.len() != states {
            return Err(format!(
                "poles: expected {states}, one for each state, found {}",
                poles.len()
            ));
        }
        Ok(poles)
    }

    /// Indices of states, counted from 0.
    pub(super) fn states(&self, name: &str, count: usize) -> Result<Vec<usize>, Problem> {
        let wrong = || {
            format!("{name}: expected a list of different states, counted from 0, below {count}")
        };
        let list = self.field(name)?.as_array().ok_or_else(wrong)?;
        let index = |value: &Value| value.as_u64().and_then(|index| usize::try_from(index).ok());
        let states: Vec<usize> = list.iter().map(index).collect::<Option<_>>().ok_or_else(wrong)?;
        let different =
            states.iter().collect::<std::collections::BTreeSet<_>>().len() == states.len();
        if states.iter().all(|&state| state < count) && different {
            Ok(states)
        } else {
            Err(wrong())
        }
    }
}

fn number(value: &Value) -> Option<f64> {
    if value.is_null() { Some(f64::NAN) } else { value.as_f64() }
}

fn of_size(
    name: &str,
    matrix: DMatrix<f64>,
    rows: usize,
    columns: usize,
) -> Result<DMatrix<f64>, Problem> {
    let (found_rows, found_columns) = matrix.shape();
    if (found_rows, found_columns) == (rows, columns) {
        return Ok(matrix);
    }
    Err(format!(
        "{name}: expected {rows} × {columns} numbers, found {found_rows} × {found_columns}"
    ))
}
