//! Responses of linear systems.

use crate::Error;
use crate::discretise::zero_order_hold;
use crate::number::{
    complex, extend, extend_complex, finite, power_of_two, round_complex, shifted,
};
use crate::solve::solve;
use nalgebra::{Complex, SMatrix, SVector};

/// The system ẋ = A x + B u, y = C x + D u, in continuous time.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct StateSpace<const N: usize, const M: usize, const P: usize> {
    /// A, N × N.
    pub a: SMatrix<f64, N, N>,
    /// B, N × M.
    pub b: SMatrix<f64, N, M>,
    /// C, P × N.
    pub c: SMatrix<f64, P, N>,
    /// D, P × M.
    pub d: SMatrix<f64, P, M>,
}

impl<const N: usize, const M: usize, const P: usize> StateSpace<N, M, P> {
    /// A system whose inputs reach its outputs only through its states: D = 0.
    pub fn new(a: SMatrix<f64, N, N>, b: SMatrix<f64, N, M>, c: SMatrix<f64, P, N>) -> Self {
        Self { a, b, c, d: SMatrix::zeros() }
    }

    /// The transfer function G(s) = C (s I − A)⁻¹ B + D.
    ///
    /// # Errors
    /// [`Error::Singular`] at a pole of the system, [`Error::NotFinite`].
    pub fn transfer(&self, s: Complex<f64>) -> Result<SMatrix<Complex<f64>, P, M>, Error> {
        if !s.re.is_finite() || !s.im.is_finite() || !self.is_finite() {
            return Err(Error::NotFinite);
        }
        let resolvent = -shifted(&complex(&extend(&self.a)), extend_complex(s));
        let states = solve(&resolvent, &complex(&extend(&self.b))).ok_or(Error::Singular)?;
        let response = complex(&extend(&self.c)) * states + complex(&extend(&self.d));
        let response = response.map(round_complex);
        let finite = response.iter().all(|gain| gain.re.is_finite() && gain.im.is_finite());
        if finite { Ok(response) } else { Err(Error::NotFinite) }
    }

    /// The frequency response G(jω), with ω in rad/s; at 0 it is the static gain.
    ///
    /// A Bode diagram shows its modulus and argument; its [`singular_values`] include the smallest and the largest
    /// gain over all directions of the input.
    ///
    /// # Errors
    /// As [`StateSpace::transfer`].
    pub fn frequency_response(&self, omega: f64) -> Result<SMatrix<Complex<f64>, P, M>, Error> {
        self.transfer(Complex { re: 0.0, im: omega })
    }

    /// The outputs at 0, h, 2h … s after `input` was switched on, starting from rest; exact for any
    /// interval.
    ///
    /// # Errors
    /// [`Error::Interval`], [`Error::NotFinite`].
    pub fn step_response(
        &self,
        input: &SVector<f64, M>,
        interval: f64,
    ) -> Result<Response<N, P>, Error> {
        let discrete = zero_order_hold(&self.a, &self.b, interval)?;
        let drive = discrete.b * input;
        self.response(discrete.a, SVector::zeros(), drive, self.d * input)
    }

    /// The outputs at 0, h, 2h … s after a pulse of area `input`, without the pulse passed on by D.
    ///
    /// # Errors
    /// As [`StateSpace::step_response`].
    pub fn impulse_response(
        &self,
        input: &SVector<f64, M>,
        interval: f64,
    ) -> Result<Response<N, P>, Error> {
        let discrete = zero_order_hold(&self.a, &self.b, interval)?;
        self.response(discrete.a, self.b * input, SVector::zeros(), SVector::zeros())
    }

    fn response(
        &self,
        transition: SMatrix<f64, N, N>,
        state: SVector<f64, N>,
        drive: SVector<f64, N>,
        through: SVector<f64, P>,
    ) -> Result<Response<N, P>, Error> {
        if !self.is_finite() || !finite(&state) || !finite(&drive) || !finite(&through) {
            return Err(Error::NotFinite);
        }
        Ok(Response { transition, outputs: self.c, state, drive, through })
    }

    fn is_finite(&self) -> bool {
        finite(&self.a) && finite(&self.b) && finite(&self.c) && finite(&self.d)
    }
}

/// A response, sample by sample, without an end.
#[derive(Clone, Debug)]
pub struct Response<const N: usize, const P: usize> {
    transition: SMatrix<f64, N, N>,
    outputs: SMatrix<f64, P, N>,
    state: SVector<f64, N>,
    drive: SVector<f64, N>,
    through: SVector<f64, P>,
}

impl<const N: usize, const P: usize> Iterator for Response<N, P> {
    type Item = SVector<f64, P>;

    fn next(&mut self) -> Option<Self::Item> {
        let output = self.outputs * self.state + self.through;
        self.state = self.transition * self.state + self.drive;
        Some(output)
    }
}

/// Limit on the sweeps over all pairs of columns; five or six are usual.
const SWEEPS: u32 = 30;

/// The singular values of a matrix, largest first; zeros fill up where it has more columns than rows.
///
/// Computed by one-sided Jacobi rotations, which give small values as accurately as large ones.
pub fn singular_values<const P: usize, const M: usize>(
    matrix: &SMatrix<Complex<f64>, P, M>,
) -> [f64; M] {
    // Scaled by a power of two, so that no square overflows or underflows.
    let largest = matrix.iter().map(|value| value.re.abs().max(value.im.abs())).fold(0.0, f64::max);
    let scale = power_of_two(largest);
    let mut columns = matrix.map(|value| value / scale);
    for _ in 0..SWEEPS {
        let mut rotated = false;
        for first in 0..M {
            for second in first + 1..M {
                rotated |= orthogonalise(&mut columns, first, second);
            }
        }
        if !rotated {
            break;
        }
    }
    let mut values = [0.0; M];
    for (index, value) in values.iter_mut().enumerate() {
        *value = scale * libm::sqrt(columns.column(index).iter().map(Complex::norm_sqr).sum());
    }
    values.sort_unstable_by(|a, b| b.total_cmp(a));
    values
}

/// Makes two columns orthogonal by a rotation; returns whether they were not.
fn orthogonalise<const P: usize, const M: usize>(
    columns: &mut SMatrix<Complex<f64>, P, M>,
    first: usize,
    second: usize,
) -> bool {
    let (mut alpha, mut beta, mut gamma) = (0.0, 0.0, Complex { re: 0.0, im: 0.0 });
    for row in 0..P {
        let (a, b) = (columns[(row, first)], columns[(row, second)]);
        alpha += a.norm_sqr();
        beta += b.norm_sqr();
        gamma += a.conj() * b;
    }
    let modulus = libm::hypot(gamma.re, gamma.im);
    if modulus <= 2.0 * f64::EPSILON * libm::sqrt(alpha * beta) {
        return false;
    }
    let phase = gamma / modulus;
    let zeta = (beta - alpha) / (2.0 * modulus);
    let tangent = libm::copysign(1.0, zeta) / (zeta.abs() + libm::hypot(1.0, zeta));
    let cosine = 1.0 / libm::hypot(1.0, tangent);
    let sine = cosine * tangent;
    for row in 0..P {
        let (a, b) = (columns[(row, first)], columns[(row, second)] * phase.conj());
        columns[(row, first)] = a * cosine - b * sine;
        columns[(row, second)] = a * sine + b * cosine;
    }
    true
}
