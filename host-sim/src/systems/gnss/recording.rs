//! Recordings of a receiver, from files or synthetic.

pub mod truth;

use std::path::Path;

use kestirim_gnss_files::{self as files, Kind};
use kestirim_gnss_ppp::Correction;
use kestirim_replay::gnss::{Paths, Recording, Shelf};

use super::simulate::{Day, INTERVAL_S, MIDNIGHT, Rates, UTC_MINUS_GPS};
use crate::Error;
use crate::system::Files;
use crate::text;

/// The part of a synthetic day that makes a recording (s).
const SYNTHETIC_S: f64 = 8.0 * 3600.0;

/// Reads the files.
///
/// # Errors
/// An error that names the file, the line, and what was expected there.
pub fn read(files: &Files) -> Result<Recording, Error> {
    let obs = files.required("obs")?;
    if !files.all("sp3").is_empty() {
        files.required("antex")?;
    } else if files.all("nav").is_empty() && !is_stream(obs) {
        // A missing file is reported first.
        let path = obs.to_path_buf();
        text::regular(obs).map_err(|source| Error::Read { path, source })?;
        let sentence =
            "a file is needed: --sp3 (with --antex), or --nav where there are no precise orbits";
        return Err(Error::Usage(sentence.to_owned()));
    }
    let truth = files.one("truth").map(truth::read).transpose()?;
    let paths = Paths {
        obs,
        sp3: files.all("sp3"),
        nav: files.all("nav"),
        antex: files.all("antex"),
        clk: files.all("clk"),
        bias: files.all("bias"),
        blq: files.one("blq"),
        erp: files.one("erp"),
    };
    let mut recording =
        Recording::read_beside(&paths, &files.shared.of::<Shelf>()).map_err(error)?;
    recording.truth = truth;
    if !paths.sp3.is_empty() && !paths.nav.is_empty() {
        recording.warn(None, "the precise orbits are taken, --nav is not used");
    }
    if paths.blq.is_none() && !paths.sp3.is_empty() {
        recording.warn(
            Some(Correction::OceanLoading),
            "the load of the oceans' tides is not corrected, up to some centimetres (--blq)",
        );
    }
    Ok(recording)
}

/// Whether a file is a recorded stream, which may contain broadcast ephemerides.
pub fn is_stream(path: &Path) -> bool {
    matches!(Kind::of_file(path), Ok(Some(kind)) if kind.is_stream())
}

/// The first hours of a synthetic day by name.
///
/// # Errors
/// [`Error::Usage`] if there is none of that name.
pub fn synthetic(name: &str) -> Result<Recording, Error> {
    let rates = match name {
        "faults" => Rates::RECORDING,
        "clean" => Rates::NONE,
        _ => return Err(Error::Usage(format!("there is no synthetic day {name:?}"))),
    };
    let mut day = Day::new(0, 0, &rates);
    day.epochs.truncate((SYNTHETIC_S / INTERVAL_S) as usize);
    Ok(of_day(day))
}

/// The recording of a synthetic day.
pub fn of_day(day: Day) -> Recording {
    let mut recording = Recording::simulated(day.epochs, day.products, MIDNIGHT, UTC_MINUS_GPS);
    recording.truth = Some(day.marker);
    recording
}

/// Converts an error of a reader, in the same words.
pub(super) fn error(error: files::Error) -> Error {
    match error {
        files::Error::Read { path, source } => Error::Read { path, source },
        files::Error::File { path, problem } => Error::File { path, problem },
        files::Error::Line { path, line, problem } => Error::Line { path, line, problem },
        // Other errors that the readers may add are complete sentences.
        other => Error::Usage(other.to_string()),
    }
}
