//! What can be tried on a flight: poles of the observer and Q/R of the filter, against the error.

mod controls;
mod figures;
mod poles;
mod recorded;
mod synthetic;

use std::path::PathBuf;

use crate::Error;
use crate::explore::{Explorer, FileField, Files, Source};

/// Where flights come from.
pub const SOURCE: Source = Source {
    system: "uav",
    title: "longitudinal states by a Kalman filter and a Luenberger observer",
    files: &[
        FileField {
            name: "log",
            label: "flight: CSV with columns t,delta_e,delta_t and some of alpha,q,V,theta (s, rad, rad/s, m/s)",
            required: true,
            several: false,
        },
        FileField {
            name: "model",
            label: "model: JSON with A, B and perhaps C, outputs, trim, h; without it one of P1, P2, P3",
            required: false,
            several: false,
        },
        FileField {
            name: "truth",
            label: "what was really flown: CSV with columns t and some of alpha,q,V,theta",
            required: false,
            several: false,
        },
    ],
    bundled: &[
        ("constant", "10 s with constant inputs, from a wrong start"),
        ("sine", "10 s with sine inputs, from a wrong start"),
    ],
    open,
    open_bundled,
};

fn open(files: &Files) -> Result<Box<dyn Explorer>, Error> {
    let model = files.one("model").map(PathBuf::from);
    Ok(Box::new(recorded::Recorded::open(files.required("log")?, model, files.one("truth"))?))
}

fn open_bundled(name: &str) -> Result<Box<dyn Explorer>, Error> {
    match name {
        "constant" => Ok(Box::new(synthetic::Synthetic { sine: false })),
        "sine" => Ok(Box::new(synthetic::Synthetic { sine: true })),
        _ => Err(Error::Usage(format!("uav has no recording {name:?}"))),
    }
}

#[cfg(test)]
mod tests;
