//! From matrices whose size is known when the file is read to those whose size is known to the compiler.

use kestirim_observer_design::{self as design, Complex, Error, Mode};
use nalgebra::{DMatrix, SMatrix};

use super::case::Problem;
use super::solution::Solution;

/// The most states the program was built for.
pub(super) const MOST_STATES: usize = 12;
/// The most outputs and inputs.
pub(super) const MOST_WIDE: usize = 16;

type Wide<const N: usize> = SMatrix<f64, MOST_WIDE, N>;

/// Calls a function for the number of states.
macro_rules! sized {
    ($states:expr, $function:ident($($argument:expr),*)) => {
        sized!($states, $function($($argument),*), 1 2 3 4 5 6 7 8 9 10 11 12)
    };
    ($states:expr, $function:ident $arguments:tt, $($count:literal)*) => {
        match $states {
            $($count => sized!(@call $function::<$count> $arguments),)*
            other => Err(format!("expected 1 to {MOST_STATES} states, found {other}")),
        }
    };
    (@call $function:ident::<$count:literal>($($argument:expr),*)) => {
        $function::<$count>($($argument),*)
    };
}

type Outcome = Result<Solution, Problem>;

/// Places poles for the `states` that A is about, as the file counts them.
pub(super) fn place(
    a: &DMatrix<f64>,
    c: &DMatrix<f64>,
    poles: &[Complex<f64>],
    states: &[usize],
) -> Result<Solution, Problem> {
    sized!(a.nrows(), place_sized(a, c, poles, states))
}

fn place_sized<const N: usize>(
    a: &DMatrix<f64>,
    c: &DMatrix<f64>,
    poles: &[Complex<f64>],
    states: &[usize],
) -> Result<Solution, Problem> {
    let mut wanted = [Complex::default(); N];
    wanted.copy_from_slice(poles);
    let (a, outputs): (SMatrix<f64, N, N>, Wide<N>) = (fixed(a), fixed(c));
    match design::place(&a, &outputs, &wanted) {
        Ok(placement) => Ok(Solution::Gain {
            gain: first_columns(&placement.gain, c.nrows()),
            pole_error: placement.error,
            digits_lost: placement.digits_lost(),
        }),
        Err(Error::Unobservable(worst)) => {
            let hidden = design::hidden_modes(&a, &outputs).unwrap_or([None; N]);
            let modes = if hidden.iter().all(Option::is_none) {
                vec![worst]
            } else {
                hidden.into_iter().flatten().collect()
            };
            let name = |mode: Mode| Mode { state: states[mode.state], ..mode }.to_string();
            let names: Vec<_> = modes.into_iter().map(name).collect();
            let plural = if names.len() == 1 { "" } else { "s" };
            Err(format!("no output sees the mode{plural} {}", names.join(", ")))
        }
        Err(error) => Err(error.to_string()),
    }
}

pub(super) fn riccati(
    a: &DMatrix<f64>,
    c: &DMatrix<f64>,
    q: &DMatrix<f64>,
    r: &DMatrix<f64>,
) -> Result<Solution, Problem> {
    sized!(a.nrows(), riccati_sized(a, c, q, r))
}

fn riccati_sized<const N: usize>(
    a: &DMatrix<f64>,
    c: &DMatrix<f64>,
    q: &DMatrix<f64>,
    r: &DMatrix<f64>,
) -> Outcome {
    let outputs: Wide<N> = fixed(c);
    let settled =
        design::riccati(&fixed::<N, N>(a), &outputs, &fixed(q), &noise(r)).map_err(sentence)?;
    Ok(Solution::Filter {
        prior: first_columns(&settled.prior, N),
        filter_gain: first_columns(&settled.filter_gain, c.nrows()),
        predictor_gain: first_columns(&settled.predictor_gain, c.nrows()),
        doublings: settled.doublings,
    })
}

pub(super) fn discretise(
    a: &DMatrix<f64>,
    b: &DMatrix<f64>,
    interval: f64,
) -> Result<Solution, Problem> {
    sized!(a.nrows(), discretise_sized(a, b, interval))
}

fn discretise_sized<const N: usize>(a: &DMatrix<f64>, b: &DMatrix<f64>, interval: f64) -> Outcome {
    let discrete = design::zero_order_hold::<N, MOST_WIDE>(&fixed(a), &fixed(b), interval)
        .map_err(sentence)?;
    Ok(Solution::Discrete {
        a: first_columns(&discrete.a, N),
        b: first_columns(&discrete.b, b.ncols()),
    })
}

pub(super) fn lyapunov(f: &DMatrix<f64>, q: &DMatrix<f64>) -> Result<Solution, Problem> {
    sized!(f.nrows(), lyapunov_sized(f, q))
}

fn lyapunov_sized<const N: usize>(f: &DMatrix<f64>, q: &DMatrix<f64>) -> Outcome {
    let covariance = design::lyapunov::<N>(&fixed(f), &fixed(q)).map_err(sentence)?;
    Ok(Solution::Covariance { covariance: first_columns(&covariance, N) })
}

/// An observer and the noise that it lives with.
pub(super) struct Observed {
    pub(super) a: DMatrix<f64>,
    pub(super) c: DMatrix<f64>,
    pub(super) gain: DMatrix<f64>,
    /// Where the process noise enters, and its covariance.
    pub(super) process: [DMatrix<f64>; 2],
    pub(super) r: DMatrix<f64>,
}

pub(super) fn error_covariance(observed: &Observed) -> Result<Solution, Problem> {
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
        design::error_covariance((&a, &outputs), &fixed(gain), (&input, &q), &noise(r))
            .map_err(sentence)?;
    Ok(Solution::Covariance { covariance: first_columns(&covariance, N) })
}

fn sentence(error: Error) -> Problem {
    error.to_string()
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
