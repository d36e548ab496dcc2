//! `host-sim replay uav`: a recorded flight becomes estimates of all states.

use std::path::{Path, PathBuf};

use kestirim_observer_design::Complex;
use nalgebra::SVector;

use super::accounts::{Accuracy, Report, Residual};
use super::design::MIDDLE;
use super::follow::{self, Assumed, Estimate, Followed};
use super::log::{self, Flight, Truth};
use super::model::{Model, STATE_COLUMNS};
use super::options::{EstimatorKind, four_numbers, poles, two_numbers};
use crate::metrics::rms;
use crate::{Error, output};

/// Options of the command.
#[derive(Debug, Clone, clap::Args)]
pub struct Replay {
    /// The flight: CSV with columns t,`delta_e`,`delta_t` and some of alpha,q,V,theta (s, rad, rad/s, m/s); an empty
    /// field was not measured
    #[arg(long, value_name = "FILE")]
    pub log: PathBuf,
    /// P1 (Aerosonde), P2 (the thesis), P3 (Navion), or a JSON file with A, B and perhaps C, outputs, trim, h
    #[arg(long, value_name = "P1|P2|P3|FILE")]
    pub model: PathBuf,
    /// What was really flown: CSV with columns t and some of alpha,q,V,theta; serves accuracy alone
    #[arg(long, value_name = "FILE")]
    pub truth: Option<PathBuf>,
    /// Which estimator
    #[arg(long, value_name = "NAME", value_enum, default_value_t)]
    pub estimator: EstimatorKind,
    /// Of the observer, 1/s, such as -12,-14,-16,-18 or -3+2i,-3-2i,-5,-6 [default: -3,-3.5,-4,-4.5]
    #[arg(long, value_name = "P,P,P,P", value_parser = poles, allow_hyphen_values = true)]
    pub poles: Option<[Complex<f64>; 4]>,
    /// Log and truth hold absolute values: the model's trim is taken from them [default: deviations]
    #[arg(long)]
    pub absolute: bool,
    /// For the filter: standard deviations of what reaches the aircraft beside δe (rad) and δt
    #[arg(long, value_name = "E,T", value_parser = two_numbers)]
    pub input_noise: Option<[f64; 2]>,
    /// For the filter: standard deviations of the model's outputs alpha,q,V,theta, or of those of its file
    #[arg(long, value_name = "A,Q,V,T", value_parser = four_numbers)]
    pub output_noise: Option<[f64; 4]>,
    /// Write t,alpha,q,V,theta of each line to this file
    #[arg(long, value_name = "OUT.csv")]
    pub track: Option<PathBuf>,
    /// Print one JSON object instead of a table
    #[arg(long)]
    pub json: bool,
}

impl Replay {
    /// Reads, estimates, compares, writes and prints.
    ///
    /// # Errors
    /// Whatever is wrong with the options or the files; then nothing is printed.
    pub fn run(&self) -> Result<(), Error> {
        let report = self.report()?;
        output::warn_of(&self.log, &report.warnings);
        output::show(&report, self.json)
    }

    /// What [`Replay::run`] prints.
    ///
    /// # Errors
    /// As there.
    pub fn report(&self) -> Result<Report, Error> {
        let inputs = [Some(&self.log), Some(&self.model), self.truth.as_ref()];
        output::refuse_overwriting("--track", self.track.as_deref(), inputs.into_iter().flatten())?;
        let kalman = self.estimator == EstimatorKind::Kalman;
        if kalman && self.poles.is_some() {
            return Err(Error::Usage("--poles are for --estimator luenberger".to_owned()));
        }
        if !kalman && (self.input_noise.is_some() || self.output_noise.is_some()) {
            return Err(Error::Usage("noise is for --estimator kalman".to_owned()));
        }
        let model = Model::read(&self.model)?;
        let origin = model.origin(self.absolute)?;
        let names: Vec<&str> = model.outputs.iter().map(|(name, _)| name.as_str()).collect();
        let mut flight = log::read(&self.log, &names)?;
        let mut warnings = Vec::new();
        if let (false, Some(trim)) = (self.absolute, model.trim) {
            warnings.extend(looks_absolute(&flight, &model, trim.0[2]));
        }
        subtract(&mut flight, &model, origin);
        let truth = self.truth.as_deref().map(log::read_truth).transpose()?;
        let followed = self.followed(&model, &flight)?;
        let absolute = |estimate: &Estimate| estimate.state + SVector::from(origin.0);
        let missing = flight.samples.iter().flat_map(|sample| &sample.measured);
        let missing = missing.filter(|measured| measured.is_none()).count();
        if flight.gaps > 0 {
            warnings.push(format!(
                "{} gaps are longer than one and a half intervals of {} s",
                flight.gaps, flight.interval_s
            ));
        }
        let accuracy = truth.map(|truth| accuracy(&followed.estimates, absolute, &truth));
        if accuracy.as_ref().is_some_and(|accuracy| accuracy.samples == 0) {
            warnings.push("no time of the truth is one of the log's".to_owned());
        }
        if let Some(path) = &self.track {
            write_track(path, &followed.estimates, absolute)?;
        }
        let last = followed.estimates.last().map(absolute).unwrap_or_default();
        let innovations =
            flight.outputs.iter().zip(&followed.innovations).map(|(&output, innovations)| {
                Residual {
                    output: names[output].to_owned(),
                    measured: innovations.len(),
                    rms: rms(innovations),
                }
            });
        Ok(Report {
            system: "uav",
            estimator: self.estimator,
            samples: flight.samples.len(),
            interval_s: flight.interval_s,
            gaps: flight.gaps,
            missing,
            innovations: innovations.collect(),
            estimate: last.into(),
            warnings,
            accuracy,
        })
    }

    fn followed(&self, model: &Model, flight: &Flight) -> Result<Followed, Error> {
        let followed = match self.estimator {
            EstimatorKind::Kalman => {
                let usual = Assumed::of_sensors(model, &flight.outputs);
                let given = |all: [f64; 4]| flight.outputs.iter().map(|&o| all[o]).collect();
                let assumed = Assumed {
                    inputs: self.input_noise.unwrap_or(usual.inputs),
                    outputs: self.output_noise.map_or(usual.outputs, given),
                };
                follow::kalman(model, flight, &assumed)
            }
            EstimatorKind::Luenberger => {
                let default = MIDDLE.map(|re| Complex { re, im: 0.0 });
                follow::observer(model, flight, self.poles.unwrap_or(default))
            }
        };
        followed.map_err(|problem| Error::File { path: self.log.clone(), problem })
    }
}

/// Whether airspeeds are nearer to the steady one than to nothing.
fn looks_absolute(flight: &Flight, model: &Model, airspeed: f64) -> Option<String> {
    let column = flight.outputs.iter().position(|&output| model.outputs[output].0 == "V")?;
    let mut values: Vec<f64> =
        flight.samples.iter().filter_map(|sample| sample.measured[column]).collect();
    values.sort_by(f64::total_cmp);
    let middle = *values.get(values.len() / 2)?;
    (middle > 0.5 * airspeed).then(|| {
        format!("V is {middle} m/s where deviations from {airspeed} m/s are expected (--absolute)")
    })
}

fn subtract(flight: &mut Flight, model: &Model, (state, input): ([f64; 4], [f64; 2])) {
    let outputs = flight.outputs.iter();
    let steady: Vec<f64> = outputs.map(|&output| model.output(output, &state)).collect();
    for sample in &mut flight.samples {
        sample.input = std::array::from_fn(|i| sample.input[i] - input[i]);
        for (measured, steady) in sample.measured.iter_mut().zip(&steady) {
            *measured = measured.map(|measured| measured - steady);
        }
    }
}

/// Errors at the times that log and truth share.
fn accuracy(
    estimates: &[Estimate],
    absolute: impl Fn(&Estimate) -> SVector<f64, 4>,
    truth: &Truth,
) -> Accuracy {
    let mut errors: [Vec<f64>; 4] = Default::default();
    let mut late: [Vec<f64>; 4] = Default::default();
    let middle = estimates.get(estimates.len() / 2).map_or(0, |estimate| estimate.t_us);
    let mut samples = 0;
    for estimate in estimates {
        let Ok(place) = truth.binary_search_by_key(&estimate.t_us, |(t, _)| *t) else { continue };
        samples += 1;
        let state = absolute(estimate);
        for (column, known) in truth[place].1.iter().enumerate() {
            let Some(known) = known else { continue };
            errors[column].push(state[column] - known);
            if estimate.t_us >= middle {
                late[column].push(state[column] - known);
            }
        }
    }
    let each = |errors: &[Vec<f64>; 4]| {
        errors.each_ref().map(|errors| (!errors.is_empty()).then(|| rms(errors)))
    };
    Accuracy { samples, rmse: each(&errors), late_rmse: each(&late) }
}

fn write_track(
    path: &Path,
    estimates: &[Estimate],
    absolute: impl Fn(&Estimate) -> SVector<f64, 4>,
) -> Result<(), Error> {
    output::write_file(path, |file| {
        let mut table = csv::Writer::from_writer(file);
        table.write_field("t")?;
        table.write_record(STATE_COLUMNS)?;
        for estimate in estimates {
            table.write_field(format!("{:.6}", estimate.t_us as f64 / 1e6))?;
            table.write_record(absolute(estimate).iter().map(|number| format!("{number:.9}")))?;
        }
        table.flush()
    })
}
