//! The settings of the estimation of a flight.

pub(super) mod firmware;
pub mod text;

use clap::ValueEnum;
use kestirim_replay::uav::{EstimatorKind, MIDDLE, Noise, Options, Plant, faster};

use super::recording::Recording;
use super::simulate::design::Kind;
use super::simulate::flight::Flight;
use super::simulate::plant::Outputs;
use super::simulate::scenario::{INTERVAL_S, Inputs, NEAR, START};
use crate::system::{Idle, ScalarKind, Setting, Settings};

/// The settings that apply to a single estimator.
const OF_THE_FILTER: [&str; 4] = ["input-noise", "output-noise", "ratio", "gain"];
const OF_THE_OBSERVER: [&str; 2] = ["poles", "faster"];
/// The settings that apply to a synthetic flight only.
const SYNTHETIC: [&str; 7] =
    ["outputs", "gain", "noise", "sigma", "wrong-start", "duration", "seed"];
/// The requirement of `--absolute`, in words.
pub(super) const NEEDS_TRIM: &str = "needs a model with a trim: P1, or a file that has one";
/// The standard deviation that a filter assumes if there is no noise.
const LEAST_SIGMA: f64 = 1e-3;

/// The available settings.
pub(super) fn table() -> Vec<Setting> {
    let mut all = vec![
        Setting::one_of("estimator", "Which estimator", &EstimatorKind::default()),
        Setting::one_of("model", "Model of the aircraft", &Plant::default()),
        Setting::text(
            "poles",
            "Poles of the observer, 1/s, such as -12,-14,-16,-18 or -3+2i,-3-2i,-5,-6 [default: -3,-3.5,-4,-4.5]",
            "P,P,P,P",
            |poles| text::poles(poles).map(drop),
        ),
        Setting::decades("faster", "All poles of the observer, times", "", [0.1, 10.0], 1.0),
        Setting::switch(
            "absolute",
            "Log and truth hold absolute values: the model's trim is taken from them [default: deviations]",
            false,
        ),
        Setting::text(
            "input-noise",
            "For the filter: standard deviations of what reaches the aircraft beside δe (rad) and δt [default: those of \
             usual sensors, or of the synthetic flight]",
            "E,T",
            |sigmas| text::two_numbers(sigmas).map(drop),
        ),
        Setting::text(
            "output-noise",
            "For the filter: standard deviations of the model's outputs alpha,q,V,theta, or of those of its file \
             [default: those of usual sensors, or of the synthetic flight]",
            "A,Q,V,T",
            |sigmas| text::four_numbers(sigmas).map(drop),
        ),
        Setting::decades(
            "ratio",
            "Q/R of the filter, times that of the noise",
            "",
            [1e-6, 1e6],
            1.0,
        ),
        Setting::one_of("scalar", "Number type of the estimator", &ScalarKind::F64),
    ];
    all = all.into_iter().map(Setting::live).collect();
    all.extend([
        Setting::one_of("outputs", "What is measured", &Outputs::default()),
        Setting::one_of("gain", "Gain of the filter", &GainKind::default()),
        Setting::one_of("noise", "Noise of a synthetic flight", &NoiseKind::default()),
        Setting::decades(
            "sigma",
            "Standard deviation of noise of equal size",
            "",
            [1e-4, 1.0],
            0.01,
        ),
        Setting::number(
            "wrong-start",
            "How wrong the estimate is at the start, times the thesis' near start",
            "",
            [0.0, 4.0, 0.1],
            1.0,
        ),
        Setting::number("duration", "Length of a synthetic flight", "s", [1.0, 60.0, 1.0], 10.0),
        Setting::number("seed", "Seed of the noise", "", [0.0, 99.0, 1.0], 0.0),
    ]);
    all
}

/// Why a setting has no effect given the recording and the other settings.
pub(super) fn idle(recording: Option<&Recording>, settings: &Settings, name: &str) -> Option<Idle> {
    let estimator = settings.chosen("estimator");
    let noise = settings.chosen("noise");
    let foreign = |of: &[&str], reason| of.contains(&name).then(|| Idle::foreign(reason));
    let of_the_recording = match recording {
        None if name == "absolute" && settings.is_given("model") => untrimmed(settings),
        None => None,
        Some(Recording::Synthetic(_)) => foreign(&["absolute"], "is for --log"),
        Some(Recording::Logged(logged)) => match (&logged.model, name) {
            (Some(_), "model") => Some(Idle::implied("is what its file says")),
            (Some(model), "absolute") => model.trim.is_none().then(|| Idle::foreign(NEEDS_TRIM)),
            (None, "absolute") => untrimmed(settings),
            _ => foreign(&SYNTHETIC, "is for --synthetic constant or sine"),
        },
    };
    of_the_recording
        .or_else(|| match estimator {
            EstimatorKind::Kalman => foreign(&OF_THE_OBSERVER, "is for --estimator luenberger"),
            EstimatorKind::Luenberger => foreign(&OF_THE_FILTER, "is for --estimator kalman"),
        })
        .or_else(|| match (noise, name) {
            (NoiseKind::Equal, _) => None,
            (_, "sigma") => Some(Idle::foreign("is for --noise equal")),
            (NoiseKind::None, "seed") => {
                Some(Idle::implied("changes nothing where there is no noise"))
            }
            _ => None,
        })
}

/// Why the states of a known aircraft cannot be counted from its trim.
fn untrimmed(settings: &Settings) -> Option<Idle> {
    (settings.chosen::<Plant>("model") != Plant::P1).then(|| Idle::foreign(NEEDS_TRIM))
}

/// The gain of a Kalman filter.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
pub enum GainKind {
    /// Constant, as in the thesis
    #[default]
    Constant,
    /// Time-varying, knows how wrong it starts
    Varying,
}

/// The noise of a synthetic flight.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
enum NoiseKind {
    /// Of equal size, as in the thesis
    #[default]
    Equal,
    /// Of real sensors: 0.5°, 0.5 m/s
    Sensors,
    /// None
    None,
}

/// The options of the estimator.
pub fn options(settings: &Settings) -> Options {
    let list = |name| settings.text(name);
    let poles = list("poles").and_then(|poles| text::poles(&poles).ok());
    Options {
        estimator: settings.chosen("estimator"),
        poles: faster(poles.unwrap_or(MIDDLE), settings.decided("faster")),
        inputs: list("input-noise").and_then(|sigmas| text::two_numbers(&sigmas).ok()),
        outputs: list("output-noise").and_then(|sigmas| text::four_numbers(&sigmas).ok()),
        ratio: settings.decided("ratio"),
        scalar: settings.chosen("scalar"),
    }
}

/// A synthetic flight and its filter.
#[derive(Debug, Clone, PartialEq)]
pub struct Simulation {
    /// The flight to simulate.
    pub flight: Flight,
    /// The noise that the filter assumes, before its own Q/R is applied.
    pub assumed: Noise,
    /// The kind of gain of the filter.
    pub gain: GainKind,
    /// The seed of the noise.
    pub seed: u64,
}

impl Simulation {
    /// The simulation according to the settings.
    pub fn of(settings: &Settings, inputs: Inputs) -> Self {
        let equal = |sigma: f64| Noise { name: "equal", inputs: [sigma; 2], outputs: [sigma; 4] };
        let (noise, usual) = match settings.chosen("noise") {
            NoiseKind::Sensors => (Noise::SENSORS, Noise::SENSORS),
            NoiseKind::None => (Noise::NONE, equal(LEAST_SIGMA)),
            NoiseKind::Equal => {
                (equal(settings.decided("sigma")), equal(settings.decided("sigma")))
            }
        };
        let options = self::options(settings);
        let wrong = settings.decided("wrong-start");
        let flight = Flight {
            plant: settings.chosen("model"),
            outputs: settings.chosen("outputs"),
            inputs,
            noise,
            truth: START,
            start: std::array::from_fn(|i| START[i] + wrong * (NEAR[i] - START[i])),
            samples: (settings.decided("duration") / INTERVAL_S).round() as usize,
        };
        let assumed = Noise {
            inputs: options.inputs.unwrap_or(usual.inputs),
            outputs: options.outputs.unwrap_or(usual.outputs),
            ..usual
        };
        let (gain, seed) = (settings.chosen("gain"), settings.decided("seed") as u64);
        Self { flight, assumed, gain, seed }
    }

    /// The kind of estimator that the options select.
    pub fn kind(&self, options: &Options) -> Kind {
        let believed = Noise { inputs: options.weighted(self.assumed.inputs), ..self.assumed };
        match (options.estimator, self.gain) {
            (EstimatorKind::Luenberger, _) => Kind::Luenberger(options.poles),
            (EstimatorKind::Kalman, GainKind::Varying) => Kind::TimeVarying(believed),
            (EstimatorKind::Kalman, GainKind::Constant) => Kind::Matched(believed),
        }
    }
}
