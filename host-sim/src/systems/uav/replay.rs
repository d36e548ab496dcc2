//! `host-sim replay uav`: a recorded flight becomes estimates of all states.

use std::path::{Path, PathBuf};

use kestirim_observer_design::Complex;

use super::accounts::{Report, Residual};
use super::design::MIDDLE;
use super::follow::Estimate;
use super::model::STATE_COLUMNS;
use super::options::{EstimatorKind, four_numbers, poles, two_numbers};
use super::recording::Recording;
use super::streams::streams;
use crate::metrics::rms;
use crate::{Error, mcap, output};

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
    /// Write inputs, sensors, estimate and truth to this MCAP file, for viewers such as Foxglove and Rerun
    #[arg(long, value_name = "OUT.mcap")]
    pub mcap: Option<PathBuf>,
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
        let inputs =
            [Some(&self.log), Some(&self.model), self.truth.as_ref()].into_iter().flatten();
        let outputs = [("--track", self.track.as_deref()), ("--mcap", self.mcap.as_deref())];
        output::refuse_clashes(&outputs, &inputs)?;
        let kalman = self.estimator == EstimatorKind::Kalman;
        if kalman && self.poles.is_some() {
            return Err(Error::Usage("--poles are for --estimator luenberger".to_owned()));
        }
        if !kalman && (self.input_noise.is_some() || self.output_noise.is_some()) {
            return Err(Error::Usage("noise is for --estimator kalman".to_owned()));
        }
        let recording =
            Recording::read(&self.log, &self.model, self.truth.as_deref(), self.absolute)?;
        let mut warnings = recording.warnings();
        let followed = match self.estimator {
            EstimatorKind::Kalman => recording.kalman(self.input_noise, self.output_noise),
            EstimatorKind::Luenberger => {
                let default = MIDDLE.map(|re| Complex { re, im: 0.0 });
                recording.observer(self.poles.unwrap_or(default))
            }
        };
        let followed =
            followed.map_err(|problem| Error::File { path: self.log.clone(), problem })?;
        let accuracy = recording.accuracy(&followed.estimates);
        if accuracy.as_ref().is_some_and(|accuracy| accuracy.samples == 0) {
            warnings.push("no time of the truth is one of the log's".to_owned());
        }
        if let Some(path) = &self.track {
            write_track(path, &recording, &followed.estimates)?;
        }
        if let Some(path) = &self.mcap {
            mcap::write(path, &streams(&recording, &followed))?;
        }
        let last = followed.estimates.last();
        let last = last.map(|estimate| recording.absolute(estimate)).unwrap_or_default();
        let flight = &recording.flight;
        let missing = flight.samples.iter().flat_map(|sample| &sample.measured);
        let missing = missing.filter(|measured| measured.is_none()).count();
        let innovations =
            recording.names().zip(&followed.innovations).map(|(output, innovations)| Residual {
                output: output.to_owned(),
                measured: innovations.len(),
                rms: rms(innovations),
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
}

fn write_track(path: &Path, recording: &Recording, estimates: &[Estimate]) -> Result<(), Error> {
    output::write_file(path, |file| {
        let mut table = csv::Writer::from_writer(file);
        table.write_field("t")?;
        table.write_record(STATE_COLUMNS)?;
        for estimate in estimates {
            table.write_field(format!("{:.6}", estimate.t_us as f64 / 1e6))?;
            let state = recording.absolute(estimate);
            table.write_record(state.iter().map(|number| format!("{number:.9}")))?;
        }
        table.flush()
    })
}
