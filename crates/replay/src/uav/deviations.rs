//! A logged flight as deviations from its model's steady flight.

use kestirim_health::Reason;
use nalgebra::SVector;

use super::estimators::{self, Assumed, Estimate, Followed};
use super::extended;
use super::{Error, EstimatorKind, Log, Model, Options, Truth};
use crate::ScalarKind;

/// A flight as deviations from its model's steady flight.
#[derive(Debug, Clone, PartialEq)]
pub struct Deviations {
    /// The model of the aircraft.
    pub model: Model,
    /// The log, in deviations.
    pub log: Log,
    /// The true states, as in their file.
    pub truth: Option<Truth>,
    /// The state and input that were subtracted from the log.
    origin: ([f64; 4], [f64; 2]),
    /// Whether the log had absolute values.
    absolute: bool,
    /// The median airspeed of the log and that of the model's steady flight, m/s, if the log looks absolute but is not
    /// declared to be.
    pub looks_absolute: Option<[f64; 2]>,
}

impl Deviations {
    /// Deviations of a log; if its values are `absolute`, the model's trim is subtracted from them.
    ///
    /// # Errors
    /// [`Error::NoTrim`] if values are `absolute` and the model has none; [`Error::GridOfDeviations`] if they are not, and it is
    /// a grid.
    pub fn new(
        model: Model,
        mut log: Log,
        truth: Option<Truth>,
        absolute: bool,
    ) -> Result<Self, Error> {
        let origin = model.origin(absolute)?;
        let looks_absolute = match model.trim {
            Some((state, _)) if !absolute => looks_absolute(&log, &model, state[2]),
            _ => None,
        };
        subtract(&mut log, &model, absolute, origin);
        Ok(Self { model, log, truth, origin, absolute, looks_absolute })
    }

    /// Deviations of a simulated flight, which consists of deviations already.
    pub fn simulated(model: Model, log: Log, truth: Truth) -> Self {
        let (truth, origin) = (Some(truth), ([0.0; 4], [0.0; 2]));
        Self { model, log, truth, origin, absolute: false, looks_absolute: None }
    }

    /// The names of the outputs in the log.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.log.outputs.iter().map(|&output| self.model.outputs[output].0.as_str())
    }

    /// Runs an estimator along the flight.
    ///
    /// # Errors
    /// [`Error::Estimator`] if it cannot be built, [`Error::Sample`] if it refuses a sample, [`Error::BeyondRange`] if a
    /// Kalman filter in fixed point does not hold a number, [`Error::GridOfObserver`].
    pub fn follow(&self, options: &Options) -> Result<Followed, Error> {
        let followed = self.followed(options);
        match options.scalar {
            ScalarKind::Fixed => followed.map_err(|error| error.of_fixed_point(&self.log)),
            ScalarKind::F32 | ScalarKind::F64 => followed,
        }
    }

    fn followed(&self, options: &Options) -> Result<Followed, Error> {
        let assumed = Assumed::of(&self.model, &self.log.outputs, options);
        let kalman = |scalar| match &self.model.extended {
            Some(extended) => {
                extended::follow(&self.model, extended, &self.log, options, scalar, None)
            }
            None => estimators::kalman(&self.model, &self.log, &assumed, scalar),
        };
        match options.estimator {
            EstimatorKind::Kalman => kalman(options.scalar),
            EstimatorKind::Luenberger if self.model.is_grid() => Err(Error::GridOfObserver),
            EstimatorKind::Luenberger => {
                let (poles, scalar) = (options.poles, options.scalar);
                let mut followed = estimators::observer(&self.model, &self.log, poles, scalar)?;
                // An observer does not know how large innovations may be. Whether model and measurements agree does not
                // depend on it: the filter beside it tells.
                if let Ok(judge) = kalman(ScalarKind::F64) {
                    followed.normalised.clone_from(&judge.normalised);
                    for (health, judged) in followed.healths.iter_mut().zip(&judge.healths) {
                        for reason in [Reason::Innovations, Reason::Time] {
                            *health = health.with(reason, judged.has(reason));
                        }
                    }
                }
                Ok(followed)
            }
        }
    }

    /// Runs a Kalman filter in doubles along the flight, with gusts (of a model that has any) as strong as another
    /// flight of the model found them.
    ///
    /// # Errors
    /// [`Error::Estimator`] if it cannot be built, [`Error::Sample`] if it refuses a sample.
    pub fn follow_as(&self, found: &Followed, options: &Options) -> Result<Followed, Error> {
        let scalar = ScalarKind::F64;
        let Some(extended) = &self.model.extended else {
            let assumed = Assumed::of(&self.model, &self.log.outputs, options);
            return estimators::kalman(&self.model, &self.log, &assumed, scalar);
        };
        let times = extended.gust.zip(found.gust).map(|((said, _), found)| {
            let (said, found) = (said[0].hypot(said[1]), found[0].hypot(found[1]));
            if said > 0.0 { found / said } else { 1.0 }
        });
        let gust = Some(times.unwrap_or(1.0));
        extended::follow(&self.model, extended, &self.log, options, scalar, gust)
    }

    /// The first lines of the flight, at most `lines`.
    pub fn beginning(&self, lines: usize) -> Self {
        let samples: Vec<_> = self.log.samples.iter().take(lines).cloned().collect();
        let end = samples.last().map_or(i64::MIN, |sample| sample.t_us);
        let truth = self.truth.as_ref().map(|truth| {
            truth.iter().take_while(|(t_us, _)| *t_us <= end).copied().collect::<Truth>()
        });
        let log = Log { outputs: self.log.outputs.clone(), samples, ..self.log };
        Self { model: self.model.clone(), log, truth, ..*self }
    }

    /// An estimate in the values of the log.
    pub fn absolute(&self, estimate: &Estimate) -> SVector<f64, 4> {
        estimate.state + SVector::from(self.origin.0)
    }

    /// The inputs of the log as they were before the trim was subtracted.
    pub fn inputs(&self) -> impl Iterator<Item = (i64, [f64; 2])> {
        let steady = self.origin.1;
        let absolute = move |input: [f64; 2]| std::array::from_fn(|i| input[i] + steady[i]);
        self.log.samples.iter().map(move |sample| (sample.t_us, absolute(sample.input)))
    }

    /// The measurements of the log as they were before the trim was subtracted: the value of each output, if measured.
    pub fn measured(&self) -> impl Iterator<Item = (i64, Vec<Option<f64>>)> {
        let steady: Vec<f64> = self.log.outputs.iter().map(|&o| self.steady(o)).collect();
        self.log.samples.iter().map(move |sample| {
            let values = sample.measured.iter().zip(&steady);
            (sample.t_us, values.map(|(value, steady)| value.map(|v| v + steady)).collect())
        })
    }

    fn steady(&self, output: usize) -> f64 {
        self.model.shown(output, self.absolute, &self.origin.0)
    }

    /// The errors at times that log and truth share: estimated minus true, for the states that are known.
    pub fn errors(&self, estimates: &[Estimate]) -> Vec<(i64, [Option<f64>; 4])> {
        let Some(truth) = &self.truth else { return Vec::new() };
        let error = |estimate: &Estimate| {
            let place = truth.binary_search_by_key(&estimate.t_us, |(t, _)| *t).ok()?;
            let (state, known) = (self.absolute(estimate), truth[place].1);
            let each = |column: usize| known[column].map(|known| state[column] - known);
            Some((estimate.t_us, std::array::from_fn(each)))
        };
        estimates.iter().filter_map(error).collect()
    }
}

/// The median airspeed and the steady one, if the median is nearer to the steady one than to zero.
fn looks_absolute(log: &Log, model: &Model, airspeed: f64) -> Option<[f64; 2]> {
    let column = log.outputs.iter().position(|&output| model.outputs[output].0 == "V")?;
    let mut values: Vec<f64> =
        log.samples.iter().filter_map(|sample| sample.measured[column]).collect();
    values.sort_by(f64::total_cmp);
    let middle = *values.get(values.len() / 2)?;
    (middle > 0.5 * airspeed).then_some([middle, airspeed])
}

fn subtract(log: &mut Log, model: &Model, absolute: bool, (state, input): ([f64; 4], [f64; 2])) {
    let shown = |&output: &usize| model.shown(output, absolute, &state);
    let shown: Vec<f64> = log.outputs.iter().map(shown).collect();
    for sample in &mut log.samples {
        sample.input = std::array::from_fn(|i| sample.input[i] - input[i]);
        for (measured, steady) in sample.measured.iter_mut().zip(&shown) {
            *measured = measured.map(|measured| measured - steady);
        }
    }
}
