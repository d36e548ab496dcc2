//! Figures that only a simulated flight allows: the noise-free case, and the effect of other settings.

use kestirim_replay::uav::{EstimatorKind, Noise, Options, faster};
use kestirim_simulate::with_outputs;
use nalgebra::SMatrix;

use super::{KALMAN, LUENBERGER, poles};
use crate::figure::{Colour, Figure, Mark, Series};
use crate::system::Answer;
use crate::systems::uav::account::states::{caught, times};
use crate::systems::uav::settings::Simulation;
use crate::systems::uav::simulate::design::{Kind, settled};
use crate::systems::uav::simulate::flight::{Flight, Moment};
use crate::systems::uav::simulate::scenario::{INTERVAL_S, SAMPLES};

/// The factors of Q/R and of the poles in the sweep, as powers of 10^(1/4): from a tenth to ten.
const FACTORS: std::ops::RangeInclusive<i32> = -4..=4;

/// Adds the times to catch the plant without noise, the poles, and the errors with other settings.
pub(super) fn draw(simulation: &Simulation, options: &Options, answer: &mut Answer) {
    let flight = &simulation.flight;
    let quiet = Flight { noise: Noise::NONE, samples: SAMPLES, ..*flight };
    let kinds = [EstimatorKind::Luenberger, EstimatorKind::Kalman]
        .map(|estimator| simulation.kind(&options.with(estimator)));
    for (kind, (name, _)) in kinds.iter().zip([LUENBERGER, KALMAN]) {
        if let Ok(moments) = quiet.follow(kind, options.scalar, simulation.seed) {
            let errors: Vec<_> = moments.iter().map(Moment::error).collect();
            answer.fact(
                format!("{name}, caught without noise after (s)"),
                times(Some(caught(&errors))),
            );
        }
    }
    answer.figures.push(with_outputs!(flight.outputs, poles_of, flight, &kinds));
    answer.figures.push(with_outputs!(flight.outputs, against, simulation, options));
}

fn poles_of<const P: usize>(c: &SMatrix<f64, P, 4>, flight: &Flight, kinds: &[Kind; 2]) -> Figure {
    let plant = flight.plant.discrete(INTERVAL_S);
    let of = |kind: &Kind| {
        let gain = kind.gain(&plant, c);
        gain.map(|gain| poles::of(&(plant.a - gain * c), INTERVAL_S)).unwrap_or_default()
    };
    let [luenberger, kalman] = kinds.each_ref().map(of);
    poles::figure(&poles::of(&plant.a, INTERVAL_S), &kalman, &luenberger)
}

/// The steady-state errors by Lyapunov's equation, for other values of Q/R or poles.
fn against<const P: usize>(
    c: &SMatrix<f64, P, 4>,
    simulation: &Simulation,
    options: &Options,
) -> Figure {
    let (plant, assumed) = (simulation.flight.plant.discrete(INTERVAL_S), simulation.assumed);
    let worst = |kind: &Kind| -> Result<f64, kestirim_observer_design::Error> {
        let best = settled(c, &plant, &Kind::Matched(assumed), &assumed)?;
        let errors = settled(c, &plant, kind, &assumed)?;
        Ok(errors.iter().zip(best).map(|(error, best)| error / best).fold(0.0, f64::max))
    };
    let sweep = |kind: &dyn Fn(f64) -> Kind| {
        let factors = FACTORS.map(|step| 10_f64.powf(f64::from(step) / 4.0));
        factors.filter_map(|factor| Some([factor, worst(&kind(factor)).ok()?])).collect::<Vec<_>>()
    };
    let filters = sweep(&|factor| {
        let options = Options { ratio: options.ratio * factor, ..*options };
        Kind::Matched(Noise { inputs: options.weighted(assumed.inputs), ..assumed })
    });
    let observers = sweep(&|factor| Kind::Luenberger(faster(options.poles, factor)));
    let drawn = |points, (name, colour): (&str, Colour)| {
        Series::path(name, points).marked(Mark::LineAndPoints).coloured(colour)
    };
    let mut figure = Figure::new("against", "Poles and Q/R against error")
        .axes("times the poles, times Q/R", "worst state's settled RMSE / best possible")
        .caption(
            "Settled errors under the noise that the filter assumes at Q/R × 1; at 1 here are the settings \
             as they stand.",
        )
        .logarithmic()
        .with(drawn(observers, LUENBERGER))
        .with(drawn(filters, KALMAN));
    figure.x.logarithmic = true;
    figure
}
