//! The zeros of a model, from each input to each output.

use kestirim_observer_design::{Complex, Discrete, eigenvalues};
use kestirim_replay::uav::Model;
use kestirim_uav_estimator::Dynamics;
use kestirim_uav_longitudinal::StateSpace;
use nalgebra::{RowSVector, SMatrix, SVector};

use crate::figure::{Colour, Figure, Mark, Series};

/// The names of the inputs.
const INPUTS: [&str; 2] = ["δe", "δt"];
/// The relative size, compared with its summands, below which a leading coefficient counts as zero.
const NOTHING: f64 = 1e-10;
/// The ratio to the magnitude of the farthest pole beyond which zeros are outside the initial view.
const FAR: f64 = 3.0;

/// The poles and zeros of a model in the complex plane.
pub(super) fn figure(model: &Model, outputs: &[usize], poles: &[[f64; 2]]) -> Figure {
    let farthest =
        |points: &[[f64; 2]]| points.iter().map(|[re, im]| re.hypot(*im)).fold(0.0, f64::max);
    let reach = FAR * farthest(poles);
    let mut shown = farthest(poles);
    let mut all = Vec::new();
    for (place, &output) in outputs.iter().enumerate() {
        for (input, name) in INPUTS.iter().enumerate() {
            let zeros = of(model, input, output);
            let near: Vec<_> =
                zeros.iter().copied().filter(|[re, im]| re.hypot(*im) < reach).collect();
            shown = shown.max(farthest(&near));
            let series = Series::points(format!("{name} → {}", model.outputs[output].0), zeros);
            let series = series.coloured(Colour::Other(place));
            // The zeros of the elevator are those relevant for handling qualities.
            all.push(if input == 0 { series } else { series.hidden() });
        }
    }
    let range = (shown > 0.0).then_some([-1.1 * shown, 1.1 * shown]);
    Figure::new("zeros", "Poles and zeros of the model")
        .axes("real part, 1/s", "imaginary part, 1/s")
        .showing(range, range)
        .caption(
            "Crosses are poles, dots the zeros from an input to an output: a zero on a pole hides it from that output; one to the \
             right of 0 makes the output begin the wrong way.",
        )
        .with_all(all)
        .with(
            Series::points("poles", poles.iter().copied())
                .marked(Mark::Crosses)
                .coloured(Colour::Truth),
        )
}

/// The zeros of c (s I − A)⁻¹ b + d for one input and one output (1/s): those of this pair alone, not the transmission
/// zeros of the whole system, of which there are none if there are more outputs than inputs.
///
/// For a discrete-time model they are the logarithms of its zeros divided by its interval; zeros added by sampling
/// (left of the imaginary axis in the z plane: Åström, Hagander & Sternby, Automatica 20 (1984)) correspond to no
/// continuous ones.
pub(super) fn of(model: &Model, input: usize, output: usize) -> Vec<[f64; 2]> {
    let row = RowSVector::from(model.outputs[output].1);
    let direct = model.extended.as_ref().map_or(0.0, |it| it.direct[output][input]);
    match &model.dynamics {
        Dynamics::Continuous(StateSpace { a, b }) => {
            let zeros = of_pair(a, &b.column(input).into_owned(), &row, direct);
            zeros.into_iter().map(|zero| [zero.re, zero.im]).collect()
        }
        Dynamics::Discrete { step: Discrete { a, b }, interval } => {
            // In terms of (z − 1) / h, as A is almost the identity.
            let rates = (a - SMatrix::identity()) / *interval;
            let b = b.column(input) / *interval;
            let continuous = |zero: Complex<f64>| {
                let z = [1.0 + zero.re * interval, zero.im * interval];
                (z[0] > 0.0)
                    .then(|| [z[0].hypot(z[1]).ln(), z[1].atan2(z[0])].map(|it| it / interval))
            };
            of_pair(&rates, &b, &row, direct).into_iter().filter_map(continuous).collect()
        }
    }
}

/// The roots of the numerator, whose coefficients follow from the algorithm of Faddeev and Le Verrier.
fn of_pair(
    a: &SMatrix<f64, 4, 4>,
    b: &SVector<f64, 4>,
    c: &RowSVector<f64, 4>,
    direct: f64,
) -> Vec<Complex<f64>> {
    // adj(s I − A) = Σ Bₖ s³⁻ᵏ, det(s I − A) = Σ pₖ s⁴⁻ᵏ.
    let mut adjugate = SMatrix::<f64, 4, 4>::identity();
    let (mut numerator, mut sizes) = (vec![direct], vec![direct.abs()]);
    for k in 1..=4 {
        let seen = c * adjugate * b;
        let size = c.abs() * adjugate.abs() * b.abs();
        let product = a * adjugate;
        let denominator = -product.trace() / f64::from(k);
        numerator.push(seen[0] + direct * denominator);
        sizes.push(size[0] + (direct * denominator).abs());
        adjugate = product + SMatrix::identity() * denominator;
    }
    let is_something = |(value, size): (&f64, &f64)| value.abs() > NOTHING * size;
    let leading = numerator.iter().zip(&sizes).position(is_something);
    leading.map_or_else(Vec::new, |first| roots(&numerator[first..]))
}

/// The roots of a polynomial, highest power first, as the eigenvalues of its companion matrix.
fn roots(coefficients: &[f64]) -> Vec<Complex<f64>> {
    match coefficients.len() {
        2 => companion::<1>(coefficients),
        3 => companion::<2>(coefficients),
        4 => companion::<3>(coefficients),
        5 => companion::<4>(coefficients),
        _ => Vec::new(),
    }
}

fn companion<const N: usize>(coefficients: &[f64]) -> Vec<Complex<f64>> {
    let matrix = SMatrix::<f64, N, N>::from_fn(|row, column| match row {
        0 => -coefficients[column + 1] / coefficients[0],
        _ => f64::from(u8::from(row == column + 1)),
    });
    eigenvalues(&matrix).map(Vec::from).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use kestirim_observer_design::zero_order_hold;
    use kestirim_replay::uav::Plant;

    fn sorted(mut zeros: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
        zeros.sort_by(|a, b| (a[0], a[1]).partial_cmp(&(b[0], b[1])).unwrap());
        zeros
    }

    fn assert_close(found: Vec<[f64; 2]>, known: &[[f64; 2]], most: f64) {
        let found = sorted(found);
        assert_eq!(found.len(), known.len(), "{found:?} {known:?}");
        for (found, known) in found.iter().flatten().zip(known.iter().flatten()) {
            assert!((found - known).abs() < most, "{found} {known}");
        }
    }

    /// A model in controllable canonical form: y / u = (numerator, from s³ on) / ((s + 1) (s + 2) (s² + 2 s + 5)), from
    /// either input.
    fn canonical(numerator: [f64; 4]) -> Model {
        let a = SMatrix::from_row_slice(&[
            0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, -10.0, -19.0, -13.0, -5.0,
        ]);
        let b = SMatrix::from_fn(|row, _| f64::from(u8::from(row == 3)));
        let [third, second, first, constant] = numerator;
        let outputs = vec![("y".to_owned(), [constant, first, second, third])];
        let dynamics = Dynamics::Continuous(StateSpace { a, b });
        Model { dynamics, outputs, ..Model::of(Plant::P2) }
    }

    #[test]
    fn zeros_are_the_roots_of_a_known_numerator() {
        // 2 (s − 3) (s² + 2 s + 10), 7 (s + 4), 5.
        for (numerator, known) in [
            ([2.0, -2.0, 8.0, -60.0], &[[-1.0, -3.0], [-1.0, 3.0], [3.0, 0.0]][..]),
            ([0.0, 0.0, 7.0, 28.0], &[[-4.0, 0.0]]),
            ([0.0, 0.0, 0.0, 5.0], &[]),
            ([0.0; 4], &[]),
        ] {
            assert_close(of(&canonical(numerator), 0, 0), known, 1e-9);
        }
    }

    #[test]
    fn sampling_moves_no_zero_and_adds_none_of_its_own() {
        let mut model = canonical([0.0, 1.0, 5.0, 6.0]);
        let Dynamics::Continuous(StateSpace { a, b }) = model.dynamics else {
            panic!("continuous")
        };
        let interval = 0.002;
        let step = zero_order_hold(&a, &b, interval).unwrap();
        model.dynamics = Dynamics::Discrete { step, interval };
        // The zeros of a sampled system equal those of the continuous one to the order of the interval.
        assert_close(of(&model, 1, 0), &[[-3.0, 0.0], [-2.0, 0.0]], 0.02);
    }

    #[test]
    fn a_direct_part_makes_as_many_zeros_as_poles() {
        // 1 + 1 / ((s + 1) (s + 2) …): zeros are the roots of the denominator plus 1.
        let Model { dynamics: Dynamics::Continuous(StateSpace { a, b }), .. } = canonical([0.0; 4])
        else {
            panic!("continuous")
        };
        let c = RowSVector::from([1.0, 0.0, 0.0, 0.0]);
        for zero in of_pair(&a, &b.column(0).into_owned(), &c, 1.0) {
            let all = ((zero + 1.0) * (zero + 2.0)) * (zero * zero + zero * 2.0 + 5.0) + 1.0;
            assert!(all.re.hypot(all.im) < 1e-9, "{all}");
        }
    }
}
