//! `host-sim replay gnss`: recorded observations become positions.

use std::path::{Path, PathBuf};

use kestirim_ppp_filter::Motion;
use nalgebra::Vector3;

use super::model::Epoch;
use super::options::{self, Choice, Mode, PROCESS_NOISE, Setup, mask, place, process_noise, time};
use super::parts::{Part, all_but};
use super::recording::{Files, Recording};
use super::session::Session;
use super::{streams, tables};
use crate::system::ScalarKind;
use crate::system::choose_scalar;
use crate::{Error, mcap, output};

/// Options of the command.
#[derive(Debug, Clone, clap::Args)]
pub struct Replay {
    /// What the receiver observed: RINEX 2, 3 or 4, GPS on L1 and L2; any file may be packed with gzip
    #[arg(long, value_name = "FILE")]
    pub obs: PathBuf,
    /// Precise orbits, SP3, one file or more: those of the day before and after help at its ends
    #[arg(long, value_name = "FILE", required = true)]
    pub sp3: Vec<PathBuf>,
    /// Precise clocks, RINEX, one file or more [default: the clocks of the orbit files]
    #[arg(long, value_name = "FILE")]
    pub clk: Vec<PathBuf>,
    /// Phase centres of the satellites' and the receiver's antennas, ANTEX
    #[arg(long, value_name = "FILE")]
    pub antex: PathBuf,
    /// Ocean loading of the station, BLQ [default: not corrected]
    #[arg(long, value_name = "FILE")]
    pub blq: Option<PathBuf>,
    /// Whether the receiver moves
    #[arg(long, value_enum, default_value_t)]
    pub mode: Mode,
    /// With --mode kinematic: variance added to each coordinate, m²/s; 1e-4 holds a slow receiver together
    /// [default: 100, each epoch stands alone]
    #[arg(long, value_name = "M2_PER_S", value_parser = process_noise)]
    pub process_noise: Option<f64>,
    /// What is done about observations that do not fit; `all` compares the filters in one table
    #[arg(long, value_name = "NAME", value_enum, default_value = "default")]
    pub filter: Choice,
    /// Take the paper's robust filters by its letter: worse, but as published
    #[arg(long)]
    pub printed: bool,
    /// Lowest elevation of a satellite, degrees [default: 8]
    #[arg(long, value_name = "DEGREES", value_parser = mask)]
    pub mask: Option<f64>,
    /// Leave out a part of the model, to see what it is worth; may be given again
    #[arg(long, value_name = "CORRECTION", value_enum)]
    pub without: Vec<Part>,
    /// Where the marker really is, ECEF, m; serves accuracy alone
    #[arg(long, value_name = "X,Y,Z", value_parser = place, allow_hyphen_values = true)]
    pub truth: Option<Vector3<f64>>,
    /// Stop after this time, in seconds since the midnight before the first epoch, as all times here
    #[arg(long, value_name = "SECONDS", value_parser = time)]
    pub until: Option<f64>,
    /// Number type of the filter: f64 alone
    #[arg(long, value_name = "TYPE")]
    pub scalar: Option<ScalarKind>,
    /// Write t,x,y,z (s, ECEF m) of each epoch with a solution to this file
    #[arg(long, value_name = "OUT.csv")]
    pub track: Option<PathBuf>,
    /// Write residuals, weights and reasons of each observation to this file
    #[arg(long, value_name = "OUT.csv")]
    pub residuals: Option<PathBuf>,
    /// Write what the filter found and what became of the satellites to this MCAP file, for viewers such as
    /// Foxglove and Rerun: places about the truth, or else about the last one
    #[arg(long, value_name = "OUT.mcap")]
    pub mcap: Option<PathBuf>,
    /// Print one JSON object instead of a table; with --filter all it has an array `filters` of what each would
    /// print alone
    #[arg(long)]
    pub json: bool,
}

impl Replay {
    /// Reads, positions, compares, writes and prints.
    ///
    /// # Errors
    /// Whatever is wrong with the options or the files; then nothing is printed.
    pub fn run(&self) -> Result<(), Error> {
        let setup = self.setup()?;
        self.refuse_overwriting_input()?;
        let files = Files {
            observations: &self.obs,
            orbits: &self.sp3,
            clocks: &self.clk,
            antennas: &self.antex,
            ocean_loading: self.blq.as_deref(),
        };
        let corrections = all_but(&self.without);
        let recording = Recording::read(&files, corrections)?;
        let epochs = self.epochs(&recording)?;
        let session = Session {
            log: &self.obs,
            recording: &recording,
            epochs,
            setup,
            corrections,
            truth: self.truth.as_ref(),
        };
        match self.filter {
            Choice::One(filter) => {
                let with_residuals = self.residuals.is_some() || self.mcap.is_some();
                let (report, followed) = session.one(filter, with_residuals)?;
                if let Some(path) = &self.track {
                    tables::write_track(path, &followed.fixes)?;
                }
                if let Some(path) = &self.residuals {
                    tables::write_residuals(path, &followed.residuals)?;
                }
                if let Some(path) = &self.mcap {
                    let last = Vector3::from(report.position_ecef_m);
                    let about = self.truth.unwrap_or(last);
                    mcap::write(path, &streams::streams(&followed, &about, self.truth.is_some()))?;
                }
                warn(&report.warnings);
                output::show(&report, self.json)
            }
            Choice::All => {
                let comparison = session.all()?;
                warn(&comparison.warnings);
                output::show(&comparison, self.json)
            }
        }
    }

    fn setup(&self) -> Result<Setup, Error> {
        choose_scalar("gnss", self.scalar, &options::SCALARS, ScalarKind::F64)?;
        let refuse = |sentence: &str| Err(Error::Usage(sentence.to_owned()));
        let motion = match (self.mode, self.process_noise) {
            (Mode::Static, None) => Motion::Static,
            (Mode::Static, Some(_)) => return refuse("--process-noise is for --mode kinematic"),
            (Mode::Kinematic, noise) => {
                Motion::Kinematic { process_noise: noise.unwrap_or(PROCESS_NOISE) }
            }
        };
        match self.filter {
            Choice::One(filter) if self.printed && !filter.is_printed() => {
                return refuse("--printed is for --filter rkf, skf, ikf, adaptive or all");
            }
            Choice::All if self.outputs().next().is_some() => {
                return refuse(
                    "--track, --residuals and --mcap are of one filter, not of --filter all",
                );
            }
            _ => {}
        }
        Ok(Setup { motion, mask: self.mask, printed: self.printed, thresholds: None })
    }

    fn refuse_overwriting_input(&self) -> Result<(), Error> {
        let several = self.sp3.iter().chain(&self.clk);
        let inputs = several.chain([&self.obs, &self.antex]).chain(&self.blq);
        let outputs: Vec<_> = self.outputs().map(|(option, path)| (option, Some(path))).collect();
        output::refuse_clashes(&outputs, &inputs)
    }

    /// The options that name files to write, with the files.
    fn outputs(&self) -> impl Iterator<Item = (&'static str, &Path)> {
        let all =
            [("--track", &self.track), ("--residuals", &self.residuals), ("--mcap", &self.mcap)];
        all.into_iter().filter_map(|(option, path)| Some((option, path.as_deref()?)))
    }

    fn epochs<'a>(&self, recording: &'a Recording) -> Result<&'a [Epoch], Error> {
        let epochs = recording.epochs(self.until);
        if epochs.is_empty() {
            let first = recording.epochs(None).first().map_or(0.0, |it| recording.seconds(it));
            let sentence = format!("--until is before the first epoch, which is at {first} s");
            return Err(Error::Usage(sentence));
        }
        Ok(epochs)
    }
}

fn warn(warnings: &[String]) {
    for warning in warnings {
        output::warn(&format!("warning: {warning}"));
    }
}
