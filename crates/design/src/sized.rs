//! Conversion of matrices whose size is known at run time to those whose size the compiler knows.

use kestirim_observer_design::{self as design, Complex, Mode};
use nalgebra::{DMatrix, SMatrix};

use crate::{Error, Solution};

/// Largest number of states that the program was built for.
pub const MOST_STATES: usize = 12;
/// Largest number of outputs and of inputs.
pub const MOST_WIDE: usize = 16;

type Wide<const N: usize> = SMatrix<f64, MOST_WIDE, N>;

/// Calls a function that is generic over the number of states.
macro_rules! sized {
    ($states:expr, $function:ident($($argument:expr),*)) => {
        sized!($states, $function($($argument),*), 1 2 3 4 5 6 7 8 9 10 11 12)
    };
    ($states:expr, $function:ident $arguments:tt, $($count:literal)*) => {
        match $states {
            $($count => sized!(@call $function::<$count> $arguments),)*
            other => Err(Error::States(other)),
        }
    };
    (@call $function:ident::<$count:literal>($($argument:expr),*)) => {
        $function::<$count>($($argument),*)
    };
}

type Outcome = Result<Solution, Error>;

/// The observer gain L that places the poles of A − L C, and its accuracy. `states` holds the numbers by which errors
/// refer to the states of A.
///
/// # Errors
/// [`Error`] if the sizes or the matrices are wrong.
pub fn place(
    a: &DMatrix<f64>,
    c: &DMatrix<f64>,
    poles: &[Complex<f64>],
    states: &[usize],
) -> Result<Solution, Error> {
    sized!(a.nrows(), place_sized(a, c, poles, states))
}

fn place_sized<const N: usize>(
    a: &DMatrix<f64>,
    c: &DMatrix<f64>,
    poles: &[Complex<f64>],
    states: &[usize],
) -> Result<Solution, Error> {
    let wanted = <[Complex<f64>; N]>::try_from(poles);
    let wanted = wanted.ok().filter(|_| states.len() == N).ok_or(Error::Poles { states: N })?;
    let (a, outputs): (SMatrix<f64, N, N>, Wide<N>) = (fixed(a, [N; 2])?, outputs(c)?);
    match design::place(&a, &outputs, &wanted) {
        Ok(placement) => Ok(Solution::Gain {
            gain: first_columns(&placement.gain, c.nrows()),
            pole_error: placement.error,
            digits_lost: placement.digits_lost(),
        }),
        Err(design::Error::Unobservable(worst)) => {
            let hidden = design::hidden_modes(&a, &outputs).unwrap_or([None; N]);
            let modes = if hidden.iter().all(Option::is_none) {
                vec![worst]
            } else {
                hidden.into_iter().flatten().collect()
            };
            let as_named = |mode: Mode| Mode { state: states[mode.state], ..mode };
            Err(Error::Unobservable(modes.into_iter().map(as_named).collect()))
        }
        Err(error) => Err(error.into()),
    }
}

/// Gains and prior covariance of the steady Kalman filter of x⁺ = A x + w, y = C x + v with covariances Q and R.
///
/// # Errors
/// [`Error`] if the sizes or the matrices are wrong.
pub fn riccati(
    a: &DMatrix<f64>,
    c: &DMatrix<f64>,
    q: &DMatrix<f64>,
    r: &DMatrix<f64>,
) -> Result<Solution, Error> {
    sized!(a.nrows(), riccati_sized(a, c, q, r))
}

fn riccati_sized<const N: usize>(
    a: &DMatrix<f64>,
    c: &DMatrix<f64>,
    q: &DMatrix<f64>,
    r: &DMatrix<f64>,
) -> Outcome {
    let (a, q) = (fixed::<N, N>(a, [N; 2])?, fixed(q, [N; 2])?);
    let settled = design::riccati(&a, &outputs(c)?, &q, &noise(r, c.nrows())?)?;
    Ok(Solution::Filter {
        prior: first_columns(&settled.prior, N),
        filter_gain: first_columns(&settled.filter_gain, c.nrows()),
        predictor_gain: first_columns(&settled.predictor_gain, c.nrows()),
        doublings: settled.doublings,
    })
}

/// A and B in discrete time, for inputs that are held over an interval.
///
/// # Errors
/// [`Error`] if the sizes or the matrices are wrong.
pub fn discretise(a: &DMatrix<f64>, b: &DMatrix<f64>, interval: f64) -> Result<Solution, Error> {
    sized!(a.nrows(), discretise_sized(a, b, interval))
}

fn discretise_sized<const N: usize>(a: &DMatrix<f64>, b: &DMatrix<f64>, interval: f64) -> Outcome {
    let (a, inputs) = (fixed(a, [N; 2])?, fixed(b, [N, b.ncols()])?);
    let discrete = design::zero_order_hold::<N, MOST_WIDE>(&a, &inputs, interval)?;
    Ok(Solution::Discrete {
        a: first_columns(&discrete.a, N),
        b: first_columns(&discrete.b, b.ncols()),
    })
}

/// The covariance P that solves P = F P Fᵀ + Q.
///
/// # Errors
/// [`Error`] if the sizes or the matrices are wrong.
pub fn lyapunov(f: &DMatrix<f64>, q: &DMatrix<f64>) -> Result<Solution, Error> {
    sized!(f.nrows(), lyapunov_sized(f, q))
}

fn lyapunov_sized<const N: usize>(f: &DMatrix<f64>, q: &DMatrix<f64>) -> Outcome {
    let covariance = design::lyapunov::<N>(&fixed(f, [N; 2])?, &fixed(q, [N; 2])?)?;
    Ok(Solution::Covariance { covariance: first_columns(&covariance, N) })
}

/// An observer together with the noise of its process and its measurements.
#[derive(Debug, Clone, PartialEq)]
pub struct Observed {
    /// A, the transition.
    pub a: DMatrix<f64>,
    /// C, the output matrix.
    pub c: DMatrix<f64>,
    /// L, the gain of the predictor form.
    pub gain: DMatrix<f64>,
    /// The matrix by which the process noise enters, and the covariance of that noise.
    pub process: [DMatrix<f64>; 2],
    /// R, the covariance of the measurement noise.
    pub r: DMatrix<f64>,
}

/// The covariance at which the error of an observer settles.
///
/// # Errors
/// [`Error`] if the sizes or the matrices are wrong.
pub fn error_covariance(observed: &Observed) -> Result<Solution, Error> {
    sized!(observed.a.nrows(), error_covariance_sized(observed))
}

fn error_covariance_sized<const N: usize>(
    Observed { a, c, gain, process, r }: &Observed,
) -> Outcome {
    let (a, outputs): (SMatrix<f64, N, N>, Wide<N>) = (fixed(a, [N; 2])?, outputs(c)?);
    let gain = fixed(gain, [N, c.nrows()])?;
    let [input, q] = process;
    let (input, q): (SMatrix<f64, N, MOST_WIDE>, SMatrix<f64, MOST_WIDE, MOST_WIDE>) =
        (fixed(input, [N, input.ncols()])?, fixed(q, [input.ncols(); 2])?);
    let covariance =
        design::error_covariance((&a, &outputs), &gain, (&input, &q), &noise(r, c.nrows())?)?;
    Ok(Solution::Covariance { covariance: first_columns(&covariance, N) })
}

/// A matrix of the expected size, padded with zeros on the right and below: outputs that see nothing, inputs that do nothing.
fn fixed<const R: usize, const C: usize>(
    matrix: &DMatrix<f64>,
    [rows, columns]: [usize; 2],
) -> Result<SMatrix<f64, R, C>, Error> {
    let expected = [rows.min(R), columns.min(C)];
    if <[usize; 2]>::from(matrix.shape()) != expected {
        return Err(Error::Size { found: matrix.shape().into(), expected });
    }
    Ok(SMatrix::from_fn(|row, column| matrix.get((row, column)).copied().unwrap_or(0.0)))
}

/// The output matrix, of at most [`MOST_WIDE`] outputs.
fn outputs<const N: usize>(c: &DMatrix<f64>) -> Result<Wide<N>, Error> {
    fixed(c, [c.nrows(), N])
}

/// The noise covariance of so many outputs; that of the padding outputs is 1.
fn noise(r: &DMatrix<f64>, outputs: usize) -> Result<SMatrix<f64, MOST_WIDE, MOST_WIDE>, Error> {
    let mut noise: SMatrix<f64, MOST_WIDE, MOST_WIDE> = fixed(r, [outputs; 2])?;
    for output in outputs..MOST_WIDE {
        noise[(output, output)] = 1.0;
    }
    Ok(noise)
}

fn first_columns<const R: usize, const C: usize>(
    matrix: &SMatrix<f64, R, C>,
    columns: usize,
) -> DMatrix<f64> {
    DMatrix::from_fn(R, columns, |row, column| matrix[(row, column)])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The size that is found wrong, and the expected one.
    fn refused(answer: Result<Solution, Error>) -> [[usize; 2]; 2] {
        match answer {
            Err(Error::Size { found, expected }) => [found, expected],
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn matrices_of_other_sizes_are_refused() {
        let of = DMatrix::<f64>::identity;
        let (a, c) = (nalgebra::dmatrix![1.0, 1.0; 0.0, 1.0], of(1, 2));
        let (q, r) = (of(2, 2), of(1, 1));
        assert!(riccati(&a, &c, &q, &r).is_ok());
        // More outputs or inputs than there is room for.
        assert_eq!(refused(discretise(&a, &of(2, 17), 0.1)), [[2, 17], [2, 16]]);
        assert_eq!(refused(riccati(&a, &of(17, 2), &q, &of(17, 17))), [[17, 2], [16, 2]]);
        // Sizes that contradict each other.
        assert_eq!(refused(riccati(&a, &of(1, 3), &q, &r)), [[1, 3], [1, 2]]);
        assert_eq!(refused(riccati(&a, &of(2, 2), &q, &r)), [[1, 1], [2, 2]]);
        assert_eq!(refused(riccati(&a, &c, &of(1, 2), &r)), [[1, 2], [2, 2]]);
        assert_eq!(refused(lyapunov(&of(2, 1), &a)), [[2, 1], [2, 2]]);
        assert_eq!(refused(discretise(&a, &of(1, 1), 0.1)), [[1, 1], [2, 1]]);
        let gain = of(2, 2);
        let process = [of(2, 1), of(2, 2)];
        let observed = Observed { a: a.clone(), c, gain, process, r };
        assert_eq!(refused(error_covariance(&observed)), [[2, 2], [2, 1]]);
        let observed = Observed { gain: of(2, 1), ..observed };
        assert_eq!(refused(error_covariance(&observed)), [[2, 2], [1, 1]]);
    }
}
