//! From matrices whose size is known when the file is read to those whose size is known to the compiler.

use kestirim_observer_design::{self as design, Complex, Mode};
use nalgebra::{DMatrix, SMatrix};

use crate::{Error, Solution};

/// The most states the program was built for.
pub const MOST_STATES: usize = 12;
/// The most outputs and inputs.
pub const MOST_WIDE: usize = 16;

type Wide<const N: usize> = SMatrix<f64, MOST_WIDE, N>;

/// Calls a function for the number of states.
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

/// The observer gain L that places the poles of A − L C, and how well; `states` is what A's states are called, as errors
/// count them.
///
/// # Errors
/// [`Error`]: what is wrong with the size, or with the matrices.
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
    let (a, outputs): (SMatrix<f64, N, N>, Wide<N>) = (fixed(a), fixed(c));
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

/// The steady Kalman filter of x⁺ = A x + w, y = C x + v with covariances Q and R.
///
/// # Errors
/// [`Error`]: what is wrong with the size, or with the matrices.
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
    let outputs: Wide<N> = fixed(c);
    let settled = design::riccati(&fixed::<N, N>(a), &outputs, &fixed(q), &noise(r))?;
    Ok(Solution::Filter {
        prior: first_columns(&settled.prior, N),
        filter_gain: first_columns(&settled.filter_gain, c.nrows()),
        predictor_gain: first_columns(&settled.predictor_gain, c.nrows()),
        doublings: settled.doublings,
    })
}

/// A and B with inputs that are held for an interval.
///
/// # Errors
/// [`Error`]: what is wrong with the size, or with the matrices.
pub fn discretise(a: &DMatrix<f64>, b: &DMatrix<f64>, interval: f64) -> Result<Solution, Error> {
    sized!(a.nrows(), discretise_sized(a, b, interval))
}

fn discretise_sized<const N: usize>(a: &DMatrix<f64>, b: &DMatrix<f64>, interval: f64) -> Outcome {
    let discrete = design::zero_order_hold::<N, MOST_WIDE>(&fixed(a), &fixed(b), interval)?;
    Ok(Solution::Discrete {
        a: first_columns(&discrete.a, N),
        b: first_columns(&discrete.b, b.ncols()),
    })
}

/// P = F P Fᵀ + Q.
///
/// # Errors
/// [`Error`]: what is wrong with the size, or with the matrices.
pub fn lyapunov(f: &DMatrix<f64>, q: &DMatrix<f64>) -> Result<Solution, Error> {
    sized!(f.nrows(), lyapunov_sized(f, q))
}

fn lyapunov_sized<const N: usize>(f: &DMatrix<f64>, q: &DMatrix<f64>) -> Outcome {
    let covariance = design::lyapunov::<N>(&fixed(f), &fixed(q))?;
    Ok(Solution::Covariance { covariance: first_columns(&covariance, N) })
}

/// An observer and the noise that it lives with.
#[derive(Debug, Clone, PartialEq)]
pub struct Observed {
    /// The transition.
    pub a: DMatrix<f64>,
    /// What is measured.
    pub c: DMatrix<f64>,
    /// L of the predictor form.
    pub gain: DMatrix<f64>,
    /// Where the process noise enters, and its covariance.
    pub process: [DMatrix<f64>; 2],
    /// Covariance of the measurements' noise.
    pub r: DMatrix<f64>,
}

/// The covariance at which the error of an observer settles.
///
/// # Errors
/// [`Error`]: what is wrong with the size, or with the matrices.
pub fn error_covariance(observed: &Observed) -> Result<Solution, Error> {
    sized!(observed.a.nrows(), error_covariance_sized(observed))
}

fn error_covariance_sized<const N: usize>(
    Observed { a, c, gain, process, r }: &Observed,
) -> Outcome {
    let (a, outputs): (SMatrix<f64, N, N>, Wide<N>) = (fixed(a), fixed(c));
    let [input, q] = process;
    let (input, q): (SMatrix<f64, N, MOST_WIDE>, SMatrix<f64, MOST_WIDE, MOST_WIDE>) =
        (fixed(input), fixed(q));
    let covariance =
        design::error_covariance((&a, &outputs), &fixed(gain), (&input, &q), &noise(r))?;
    Ok(Solution::Covariance { covariance: first_columns(&covariance, N) })
}

/// The matrix with zeros beside and below it: outputs that see nothing, inputs that do nothing.
fn fixed<const R: usize, const C: usize>(matrix: &DMatrix<f64>) -> SMatrix<f64, R, C> {
    SMatrix::from_fn(|row, column| matrix.get((row, column)).copied().unwrap_or(0.0))
}

/// The noise of outputs, that of the ones that see nothing being 1.
fn noise(r: &DMatrix<f64>) -> SMatrix<f64, MOST_WIDE, MOST_WIDE> {
    let mut noise: SMatrix<f64, MOST_WIDE, MOST_WIDE> = fixed(r);
    for output in r.nrows()..MOST_WIDE {
        noise[(output, output)] = 1.0;
    }
    noise
}

fn first_columns<const R: usize, const C: usize>(
    matrix: &SMatrix<f64, R, C>,
    columns: usize,
) -> DMatrix<f64> {
    DMatrix::from_fn(R, columns, |row, column| matrix[(row, column)])
}
