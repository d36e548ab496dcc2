//! What the command line of `host-sim live` can choose.

use std::path::PathBuf;
use std::thread;
use std::time::Duration;

use super::Stopper;
use crate::serve::{self, Page};
use crate::systems::pedestrian::options::SensorClass;
use crate::{Error, output};

/// Where senders find this program if nobody says otherwise: on the same machine.
const DEFAULT_ADDRESS: &str = "127.0.0.1:5775";
/// Between two looks whether the stream has ended.
const PATIENCE: Duration = Duration::from_millis(20);

/// `host-sim live`.
#[derive(Debug, Clone, clap::Args)]
pub struct Live {
    /// Listen to datagrams for this address [default: 127.0.0.1:5775, which only this machine reaches]
    #[arg(long, value_name = "ADDR:PORT", conflicts_with_all = ["serial", "file"])]
    pub udp: Option<String>,
    /// Listen to a serial port
    #[arg(long, value_name = "DEV", conflicts_with = "file")]
    pub serial: Option<PathBuf>,
    /// Speed of the serial port
    #[arg(long, value_name = "BAUD", default_value_t = 115_200, requires = "serial")]
    pub baud: u32,
    /// Play a recording back, as fast as it goes
    #[arg(long, value_name = "RECORDING", conflicts_with_all = ["record", "seconds"])]
    pub file: Option<PathBuf>,
    /// Whose estimator follows the stream; none shows what the sender itself estimates
    #[arg(long, value_name = "SYSTEM", value_enum, default_value_t)]
    pub system: SystemKind,
    /// Of a pedestrian: class of the sensor [default: consumer]
    #[arg(long, value_enum)]
    pub sensor: Option<SensorClass>,
    /// Of a robot: where the anchors are, CSV with columns anchor,x,y,z (m); senders number them from 0 in the
    /// order of the file [default: the paper's office]
    #[arg(long, value_name = "FILE")]
    pub anchors: Option<PathBuf>,
    /// Of a robot: height of its tag, m [default: that of the anchors]
    #[arg(long, value_name = "METRES", allow_hyphen_values = true, value_parser = height)]
    pub height: Option<f64>,
    /// Of a drone: where the user can be, CSV with columns x,y, the corners of a polygon (m)
    #[arg(long, value_name = "FILE")]
    pub area: Option<PathBuf>,
    /// Of a UAV: P1, P2, P3, or a JSON file as for a replay
    #[arg(long, value_name = "P1|P2|P3|FILE")]
    pub model: Option<PathBuf>,
    /// Of a UAV: absolute values are sent, from which the model's trim is taken [default: deviations]
    #[arg(long)]
    pub absolute: bool,
    /// Write everything that arrives to this new file, before it is looked at
    /// [default: target/live/DATE-TIME.frames]
    #[arg(long, value_name = "NEW.frames")]
    pub record: Option<PathBuf>,
    /// End after this many seconds
    #[arg(long, value_name = "S", value_parser = clap::value_parser!(u64).range(1..))]
    pub seconds: Option<u64>,
    /// End after this many good frames
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub frames: Option<u32>,
    /// Port of the page on this machine that shows the stream; 0 takes a free one
    #[arg(long, value_name = "P", default_value_t = serve::PORT)]
    pub port: u16,
    /// Show no page
    #[arg(long, conflicts_with = "port")]
    pub headless: bool,
    /// At the end print one JSON object instead of a table
    #[arg(long)]
    pub json: bool,
}

/// Whose estimator follows a stream.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, clap::ValueEnum)]
pub enum SystemKind {
    /// Nobody's: what the sender estimates is shown
    #[default]
    None,
    /// A foot-mounted IMU: the causal tracker
    Pedestrian,
    /// Ranges between anchors and a tag, perhaps with an IMU: the default tracker in the plane
    Robot,
    /// Path losses that a drone measures: the user's place over open ground
    Drone,
    /// Inputs and outputs of a fixed-wing aircraft: the Kalman filter
    Uav,
}

impl SystemKind {
    /// As on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Pedestrian => "pedestrian",
            Self::Robot => "robot",
            Self::Drone => "drone",
            Self::Uav => "uav",
        }
    }
}

impl Live {
    /// Listens until the stream ends or somebody presses Ctrl-C, and prints what came.
    ///
    /// # Errors
    /// Whatever is wrong with options and files, and a line or a disk that fails; what arrived before is in the
    /// recording.
    pub fn run(&self) -> Result<(), Error> {
        let mut page = (!self.headless).then(|| Page::bind(self.port)).transpose()?;
        let live = super::Live::start(self)?;
        output::warn(&live.announcement());
        if let Some(page) = &mut page {
            page.show(live.view());
            output::warn(&format!("page: {}  (Ctrl-C ends)", page.address()));
        }
        let (stop, ended) = (live.stopper(), Stopper::default());
        let end = ended.clone();
        // Without it Ctrl-C ends the program at once: the recording is complete even so.
        let _ = ctrlc::set_handler(move || {
            stop.stop();
            end.stop();
        });
        while !live.is_finished() {
            thread::sleep(PATIENCE);
        }
        let report = live.finish()?;
        for warning in &report.warnings {
            output::warn(&format!("warning: {warning}"));
        }
        output::show(&report, self.json)?;
        // Played back, it is over before anybody has looked.
        while page.is_some() && self.file.is_some() && !ended.is_stopped() {
            thread::sleep(PATIENCE);
        }
        Ok(())
    }

    /// Where datagrams are to be sent.
    pub(super) fn address(&self) -> &str {
        self.udp.as_deref().unwrap_or(DEFAULT_ADDRESS)
    }
}

fn height(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value.abs() <= 1000.0 => Ok(value),
        _ => Err("expected metres from -1000 to 1000".to_owned()),
    }
}
