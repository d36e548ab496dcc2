//! Continuous-time poles, from discrete-time matrices.

use kestirim_observer_design::{Complex, Discrete, eigenvalues, riccati};
use kestirim_replay::uav::{Assumed, Deviations, Model, Options, rows};
use kestirim_uav_estimator::Step;
use nalgebra::{SMatrix, SVector};

use super::{KALMAN, LUENBERGER};
use crate::Error;
use crate::figure::{Colour, Figure, Mark, Series};

/// The poles of x⁺ = A x at this interval (s), in 1/s; empty if an eigenvalue is zero or none was found.
pub(super) fn of(a: &SMatrix<f64, 4, 4>, interval: f64) -> Vec<[f64; 2]> {
    let continuous = |pole: Complex<f64>| {
        let rate = pole.re.hypot(pole.im).ln() / interval;
        [rate, pole.im.atan2(pole.re) / interval]
    };
    let all = eigenvalues(a).map(|poles| poles.map(continuous).to_vec()).unwrap_or_default();
    all.into_iter().filter(|pole| pole.iter().all(|part| part.is_finite())).collect()
}

/// Poles in the complex plane.
pub(super) fn figure(plant: &[[f64; 2]], kalman: &[[f64; 2]], luenberger: &[[f64; 2]]) -> Figure {
    let marks = |name: &str, poles: &[[f64; 2]], colour| {
        Series::points(name, poles.iter().copied()).coloured(colour)
    };
    Figure::new("poles", "Poles")
        .axes("real part, 1/s", "imaginary part, 1/s")
        .caption("The further to the left a pole, the sooner what it belongs to is over.")
        .with(marks("plant", plant, Colour::Truth).marked(Mark::Crosses))
        .with(marks(LUENBERGER.0, luenberger, LUENBERGER.1))
        .with(marks(KALMAN.0, kalman, KALMAN.1))
}

/// The poles of a flight's model.
pub(super) fn of_model(flight: &Deviations) -> Result<Vec<[f64; 2]>, Error> {
    let interval = flight.log.interval_s;
    let step = flight.model.dynamics.over(interval, interval, &SVector::zeros());
    let step = step.map_err(|error| Error::Usage(error.to_string()))?;
    Ok(of(&step.transition.a, interval))
}

/// The poles of a logged flight: those of the model, of the settled filter, and of the observer, if there is one.
pub(super) fn of_log(
    flight: &Deviations,
    options: &Options,
    observed: bool,
) -> Result<Figure, Error> {
    let (model, outputs) = (&flight.model, &flight.log.outputs);
    let (interval, assumed) = (flight.log.interval_s, Assumed::of(model, outputs, options));
    let step = model.dynamics.over(interval, interval, &assumed.inputs.into());
    let step = step.map_err(|error| Error::Usage(error.to_string()))?;
    // A filter with further states has other poles.
    let filter = match outputs.len() {
        _ if model.extended.is_some() => None,
        1 => settled::<1>(model, outputs, &step, &assumed),
        2 => settled::<2>(model, outputs, &step, &assumed),
        3 => settled::<3>(model, outputs, &step, &assumed),
        _ => settled::<4>(model, outputs, &step, &assumed),
    };
    let filter = filter.map_or_else(Vec::new, |a| of(&a, interval));
    let observer = options.poles.map(|pole| [pole.re, pole.im]);
    let observer = if observed { &observer[..] } else { &[] };
    Ok(figure(&of(&step.transition.a, interval), &filter, observer))
}

/// A − L C of the steady state that a time-varying filter settles at.
fn settled<const P: usize>(
    model: &Model,
    outputs: &[usize],
    Step { transition: Discrete { a, .. }, noise }: &Step,
    assumed: &Assumed,
) -> Option<SMatrix<f64, 4, 4>> {
    let c = rows::<P>(model, outputs);
    let mut r = SMatrix::<f64, P, P>::identity();
    for (output, sigma) in assumed.outputs.iter().take(P).enumerate() {
        r[(output, output)] = sigma * sigma;
    }
    Some(a - riccati(a, &c, noise, &r).ok()?.predictor_gain * c)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::systems::uav::simulate::scenario::INTERVAL_S;
    use kestirim_replay::uav::Plant;

    #[test]
    fn discrete_poles_are_those_of_continuous_time() {
        let model = Plant::P1.model();
        let mut found = of(&Plant::P1.discrete(INTERVAL_S).a, INTERVAL_S);
        let mut known: Vec<_> = eigenvalues(&model.a).unwrap().map(|p| [p.re, p.im]).into();
        for poles in [&mut found, &mut known] {
            poles.sort_by(|a, b| (a[0], a[1]).partial_cmp(&(b[0], b[1])).unwrap());
        }
        assert_eq!(found.len(), 4);
        for (found, known) in found.iter().flatten().zip(known.iter().flatten()) {
            assert!((found - known).abs() < 1e-9, "{found} {known}");
        }
    }
}
