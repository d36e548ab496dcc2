//! Extended models, which describe more than A, B and C, and the filter for them.

use kestirim_kalman::Innovation;
use kestirim_scalar::{Q16_16, Scalar};
use kestirim_uav_estimator::{self as uav, Drift, Gust, Output, Reference};
use nalgebra::SMatrix;

use super::augmented::{AIRSPEED, Augmented, MOVING};
use super::estimators::{Assumed, Estimate, Followed, sized};
use super::{Error, Log, Model, Options};
use crate::ScalarKind;

/// The names of outputs that refer to the ground.
const GROUND: [&str; 2] = ["V_ground", "climb"];
/// The strengths of gusts that are tried, relative to the model's; the innovations decide.
const GUSTS: [f64; 6] = [0.0, 0.125, 0.25, 0.5, 1.0, 2.0];
/// The limit of an outlier's normalised innovation squared in the log-likelihood.
const MOST_NIS: f64 = 50.0;

/// The part of a model beyond A, B and C.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Extended {
    /// The rows of D, one per output.
    pub direct: Vec<[f64; 2]>,
    /// The value of each output in the steady flight.
    pub steady: Vec<f64>,
    /// Whether each output is proportional to the dynamic pressure.
    pub scaled: Vec<bool>,
    /// Spectral density of white noise on ẋ, units²·s; `None` leaves it to the noise of the inputs.
    pub process: Option<SMatrix<f64, 4, 4>>,
    /// Standard deviations of the inputs' noise, per sample; `None` stands for those of usual inputs, or for zero if
    /// there is a process noise.
    pub inputs: Option<[f64; 2]>,
    /// Standard deviations of the outputs' noise; `None` stands for those of usual sensors.
    pub sigmas: Option<Vec<f64>>,
    /// The biases of outputs.
    pub biases: Vec<(usize, Drift)>,
    /// Gusts along and across: standard deviations (m/s) and lengths (m).
    pub gust: Option<([f64; 2], [f64; 2])>,
    /// A head wind, m/s.
    pub wind: Option<Drift>,
    /// The density of the air, relative to that of the steady flight; used if an output measures it.
    pub density: Option<Drift>,
    /// Unknown parts of the states' derivatives, by the state.
    pub forces: Vec<(usize, Drift)>,
    /// Models at rising airspeeds, this one among them, between which the filter blends; empty if this is the only one.
    /// All describe outputs and unknowns alike.
    pub grid: Vec<Model>,
}

/// A quantity that a filter estimates in addition to the four states.
#[derive(Debug, Clone, PartialEq)]
pub struct Beside {
    /// The name of the quantity.
    pub name: String,
    /// The value at the end, in SI units.
    pub value: f64,
    /// The standard deviation of the value.
    pub sigma: f64,
    /// The standard deviation that the model states for it.
    pub said: f64,
}

/// Runs the filter, with gusts `gust` times as strong as the model says, or as strong as the innovations support.
///
/// # Errors
/// [`Error::Estimator`] or [`Error::Sample`].
pub(super) fn follow(
    model: &Model,
    extended: &Extended,
    log: &Log,
    options: &Options,
    scalar: ScalarKind,
    gust: Option<f64>,
) -> Result<Followed, Error> {
    let tried = match &gust {
        Some(gust) => std::slice::from_ref(gust),
        None if extended.gust.is_some() => &GUSTS[..],
        None => &[1.0],
    };
    let mut best: Result<(f64, Followed), Error> = Err(Error::TooShort);
    for &gust in tried {
        let flight = Flight { model, extended, log, options, gust };
        let next = match scalar {
            ScalarKind::F32 => flight.follow::<f32>(),
            ScalarKind::F64 => flight.follow::<f64>(),
            ScalarKind::Fixed => flight.follow::<Q16_16>(),
        };
        // A strength of gusts may be too much (in fixed point) where another is right.
        match (&best, &next) {
            (Ok((most, _)), Ok((support, _))) if support > most => best = next,
            (Err(_), _) => best = next,
            _ => {}
        }
    }
    best.map(|(_, followed)| followed)
}

/// A flight to be followed, with gusts `gust` times as strong as the model says.
struct Flight<'a> {
    model: &'a Model,
    extended: &'a Extended,
    log: &'a Log,
    options: &'a Options,
    gust: f64,
}

impl Flight<'_> {
    /// Runs the filter; returns the log-likelihood of the innovations, and the result.
    fn follow<T: Scalar>(&self) -> Result<(f64, Followed), Error> {
        let Self { model, extended, log, options, gust } = *self;
        let parts = Parts::of(model, &log.outputs, options, gust).ok_or(uav::Error::NoRoom)?;
        let mut filter = Augmented::<T>::new(model, &log.outputs, options, gust, log.interval_s)?;
        let mut followed = Followed::new(log);
        let mut outside = Outside::of(model);
        let mut support = 0.0;
        for (index, sample) in log.samples.iter().enumerate() {
            let innovations = filter.take(&sized(sample));
            let innovations = innovations.map_err(|source| Error::Sample { index, source })?;
            for Innovation { variance, nis, .. } in innovations.iter().flatten() {
                support -= 0.5 * (nis.min(MOST_NIS) + variance.ln());
            }
            let (state, sigma) = (filter.filter().estimate(), filter.filter().sigma());
            let estimate = Estimate {
                t_us: sample.t_us,
                state: state.fixed_rows::<4>(0).into(),
                sigma: Some(sigma.fixed_rows::<4>(0).into()),
            };
            outside.meet(state[AIRSPEED], sigma[AIRSPEED]);
            followed.judge(&innovations);
            let innovations = innovations.map(|innovation| innovation.map(|it| it.innovation));
            followed.add(estimate, innovations, filter.rejected(), filter.health());
        }
        let (state, sigma) = (filter.filter().estimate(), filter.filter().sigma());
        let duration = log.samples.len() as f64 * log.interval_s;
        let name = |output: usize| model.outputs[log.outputs[output]].0.clone();
        let told = parts.told(name, duration);
        let told = told.into_iter().map(|(place, name, said)| {
            let (value, sigma) = (state[place], sigma[place]);
            Beside { name, value, sigma, said }
        });
        followed.beside = told.collect();
        followed.beyond = outside.told();
        followed.gust = extended.gust.map(|(sigmas, _)| sigmas.map(|sigma| gust * sigma));
        Ok((support, followed))
    }
}

/// Detection of airspeeds beyond those of a grid, or far from that of a single model.
struct Outside {
    /// The airspeed from which estimates deviate, m/s.
    origin: f64,
    /// Each end, and how far beyond it the model ceases to hold, downwards negative, m/s.
    ends: Vec<[f64; 2]>,
    /// The share of estimates that must be beyond for the model to be doubted.
    share: f64,
    /// The number of estimates beyond, and of all estimates.
    count: [usize; 2],
    /// The furthest estimate, and the end that it is beyond, m/s.
    furthest: Option<[f64; 2]>,
}

impl Outside {
    /// How far a single model holds, as a share of its airspeed: there the lift of a linear model is off by 3 (ΔV/V)²,
    /// 4 %.
    const ALONE: f64 = 0.12;
    /// The share of a flight for which a single model may be outside that range, as in a dive or a climb.
    const SHARE: f64 = 0.25;

    fn of(model: &Model) -> Self {
        let airspeed = |model: &Model| model.trim.map_or(0.0, |(state, _)| state[AIRSPEED]);
        let grid = model.extended.iter().flat_map(|extended| &extended.grid);
        let airspeeds: Vec<f64> = grid.map(airspeed).collect();
        let origin = airspeed(model);
        let (ends, share) = match (airspeeds.first_chunk(), airspeeds.last_chunk()) {
            (Some([first, second]), Some([last_but_one, last])) => {
                let apart = [first - second, last - last_but_one];
                (vec![[*first, 0.5 * apart[0]], [*last, 0.5 * apart[1]]], 0.0)
            }
            _ if origin > 0.0 => {
                let far = Self::ALONE * origin;
                (vec![[origin, -far], [origin, far]], Self::SHARE)
            }
            _ => (Vec::new(), 0.0),
        };
        Self { origin, ends, share, count: [0; 2], furthest: None }
    }

    /// Examines an estimate, unless it is too uncertain.
    fn meet(&mut self, deviation: f64, sigma: f64) {
        let airspeed = self.origin + deviation;
        self.count[1] += 1;
        for [end, far] in &self.ends {
            let by = (airspeed - end) * far.signum();
            if by > far.abs() && sigma < far.abs() {
                self.count[0] += 1;
                let most = self.furthest.map_or(0.0, |[airspeed, end]| (airspeed - end).abs());
                if by > most {
                    self.furthest = Some([airspeed, *end]);
                }
            }
        }
    }

    /// The furthest estimate and its end, if so many are beyond that the model is doubted.
    fn told(&self) -> Option<[f64; 2]> {
        let [beyond, all] = self.count.map(|count| count as f64);
        self.furthest.filter(|_| beyond > self.share * all)
    }
}

/// The parts from which a filter is built, for the given outputs of a model and strength of gusts.
#[derive(Debug, Clone, PartialEq)]
pub struct Parts {
    /// The log's outputs.
    pub outputs: Vec<Output>,
    /// Spectral density of white noise on ẋ, units²·s.
    pub process: SMatrix<f64, 4, 4>,
    /// The quantities estimated in addition to the four states, in the order of their states.
    pub unknown: Vec<Unknown>,
    /// Standard deviations of the inputs' noise.
    pub inputs: [f64; 2],
}

/// A quantity that is estimated in addition to the four states.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Unknown {
    /// Gusts along and across.
    Gust(Gust),
    /// A part of this state's derivative.
    Force(usize, Drift),
    /// A bias of this output of the log.
    Bias(usize, Drift),
    /// A head wind.
    Wind(Drift),
    /// The density of the air.
    Density(Drift),
}

impl Unknown {
    /// Whether it moves the four states, and the number of its own states.
    pub const fn moves(&self) -> (bool, usize) {
        match self {
            Self::Gust(_) => (true, 2),
            Self::Force(..) => (true, 1),
            Self::Bias(..) | Self::Wind(_) | Self::Density(_) => (false, 1),
        }
    }
}

impl Parts {
    /// The parts as the model describes them and the options change them; `None` for a model that describes no more
    /// than A, B and C.
    pub fn of(model: &Model, outputs: &[usize], options: &Options, gust: f64) -> Option<Self> {
        let extended = model.extended.as_deref()?;
        let Assumed { inputs, outputs: sigmas } = Assumed::of(model, outputs, options);
        let airspeed = model.trim.map_or(f64::INFINITY, |(state, _)| state[2]);
        let is_ground = |output: usize| GROUND.contains(&model.outputs[output].0.as_str());
        let known = outputs.iter().zip(sigmas).map(|(&output, sigma)| {
            let reference = if extended.scaled[output] {
                Reference::Pressure { steady: extended.steady[output], airspeed }
            } else if is_ground(output) {
                Reference::Ground
            } else {
                Reference::Air
            };
            let (row, direct) = (model.outputs[output].1, extended.direct[output]);
            Output { row, direct, sigma, reference }
        });
        let gust = extended.gust.map(|(sigmas, lengths)| {
            let sigmas = sigmas.map(|sigma| gust * sigma);
            Unknown::Gust(Gust { sigmas, lengths, airspeed })
        });
        let forces = extended.forces.iter().map(|&(state, drift)| Unknown::Force(state, drift));
        // A sensor that is not in the log has no bias.
        let biases = extended.biases.iter().filter_map(|&(output, drift)| {
            Some(Unknown::Bias(outputs.iter().position(|it| *it == output)?, drift))
        });
        let wind = extended.wind.filter(|_| outputs.iter().any(|&output| is_ground(output)));
        // An output that depends on the airspeed alone: a dynamic pressure.
        let sees_density = |&output: &usize| {
            let [alpha, rate, _, pitch] = model.outputs[output].1;
            extended.scaled[output] && [alpha, rate, pitch] == [0.0; 3]
        };
        let density = extended.density.filter(|_| outputs.iter().any(sees_density));
        let beside = biases.chain(wind.map(Unknown::Wind)).chain(density.map(Unknown::Density));
        Some(Self {
            outputs: known.collect(),
            process: extended.process.unwrap_or_default() * options.ratio,
            unknown: gust.into_iter().chain(forces).chain(beside).collect(),
            inputs,
        })
    }

    /// The index, the name and the model's standard deviation after `duration` seconds of each additional quantity.
    fn told(&self, name: impl Fn(usize) -> String, duration: f64) -> Vec<(usize, String, f64)> {
        let said = |drift: &Drift| drift.sigma.hypot(drift.rate * duration.sqrt());
        let (mut next, mut all) = ([4, MOVING], Vec::new());
        for unknown in &self.unknown {
            let place = &mut next[usize::from(!unknown.moves().0)];
            let told = match unknown {
                Unknown::Gust(Gust { sigmas: [along, across], .. }) => {
                    all.push((*place, "gust along".to_owned(), *along));
                    *place += 1;
                    ("gust across".to_owned(), *across)
                }
                Unknown::Force(state, drift) => {
                    (format!("force on {}", super::STATE_COLUMNS[*state]), said(drift))
                }
                Unknown::Bias(output, drift) => (format!("bias of {}", name(*output)), said(drift)),
                Unknown::Wind(drift) => ("head wind".to_owned(), said(drift)),
                Unknown::Density(drift) => ("density".to_owned(), said(drift)),
            };
            all.push((*place, told.0, told.1));
            *place += 1;
        }
        all
    }
}
