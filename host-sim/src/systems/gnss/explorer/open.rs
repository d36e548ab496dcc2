//! Where recordings come from.

use std::path::{Path, PathBuf};

use kestirim_gnss_ppp::Corrections;
use nalgebra::Vector3;

use super::super::options::place;
use super::super::recording::{self, Recording};
use super::super::sky::{Day, INTERVAL_S, Rates};
use super::Receiver;
use crate::Error;
use crate::explore::{Explorer, FileField, Files, Source};
use crate::text::TextFile;

/// The receiver's explorer.
pub const SOURCE: Source = Source {
    system: "gnss",
    title: "where a GPS receiver is, to a centimetre",
    files: &[
        FileField {
            name: "obs",
            label: "observations: RINEX 2, 3 or 4 of GPS on L1 and L2, or CRINEX",
            required: true,
            several: false,
        },
        FileField {
            name: "sp3",
            label: "precise orbits of the day: SP3",
            required: true,
            several: true,
        },
        FileField {
            name: "clk",
            label: "precise clocks: RINEX [default: those of the orbit files]",
            required: false,
            several: true,
        },
        FileField {
            name: "antex",
            label: "phase centres of antennas: ANTEX",
            required: true,
            several: false,
        },
        FileField {
            name: "blq",
            label: "ocean loading of the station: BLQ",
            required: false,
            several: false,
        },
        FileField {
            name: "truth",
            label: "where the marker really is: a line X,Y,Z (ECEF, m)",
            required: false,
            several: false,
        },
    ],
    bundled: &[
        ("faults", "8 h of a synthetic station: outliers, biases, slips that nothing shows"),
        ("clean", "the same without faults"),
    ],
    open,
    open_bundled,
};

/// How much of a synthetic day there is, s.
const BUNDLED_S: f64 = 8.0 * 3600.0;

fn open(files: &Files) -> Result<Box<dyn Explorer>, Error> {
    let log = files.required("obs")?;
    files.required("sp3")?;
    let all = recording::Files {
        observations: log,
        orbits: files.all("sp3"),
        clocks: files.all("clk"),
        antennas: files.required("antex")?,
        ocean_loading: files.one("blq"),
    };
    let truth = files.one("truth").map(read_truth).transpose()?;
    let recording = Recording::read(&all, Corrections::ALL)?;
    Ok(Box::new(Receiver { log: log.to_path_buf(), recording, truth }))
}

fn read_truth(path: &Path) -> Result<Vector3<f64>, Error> {
    let text = TextFile::read(path)?;
    let line = text.lines().next();
    let problem = "expected a place on the ground as X,Y,Z (ECEF, m)";
    let line = line.ok_or_else(|| text.error(problem))?;
    place(line.text).map_err(|problem| line.error(problem))
}

fn open_bundled(name: &str) -> Result<Box<dyn Explorer>, Error> {
    let rates = match name {
        "faults" => Rates::RECORDING,
        "clean" => Rates::NONE,
        other => return Err(Error::Usage(format!("there is no recording {other:?}"))),
    };
    let mut day = Day::new(0, 0, &rates);
    day.epochs.truncate((BUNDLED_S / INTERVAL_S) as usize);
    let truth = Some(day.marker);
    let log = PathBuf::from("synthetic day");
    Ok(Box::new(Receiver { log, recording: Recording::of_day(day), truth }))
}
