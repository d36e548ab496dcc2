//! What can be tried on a flight: filter, height and way of the drone, step by step.

mod figures;
mod moving;
mod recorded;
mod remembered;
mod staying;

use crate::Error;
use crate::explore::{Control, Explorer, FileField, Files, Settings, Source};

use super::options::ResamplerKind;
use super::scenario::EnvironmentKind;

/// Where flights come from.
pub const SOURCE: Source = Source {
    system: "drone",
    title: "where a user on the ground is, from path loss alone",
    files: &[
        FileField {
            name: "log",
            label: "flight: CSV with columns t,x,y,h and path_loss_db or rssi_db (s, m, dB)",
            required: true,
            several: false,
        },
        FileField {
            name: "area",
            label: "where the user can be: CSV with columns x,y, the corners of a polygon (m)",
            required: false,
            several: false,
        },
        FileField {
            name: "truth",
            label: "where the user really is: CSV with columns x,y and one line (m)",
            required: false,
            several: false,
        },
    ],
    bundled: &[
        ("moving", "a user who walks a circle, followed by the drone"),
        ("staying", "a user who stays, measured from a circle"),
    ],
    open,
    open_bundled,
};

fn open(files: &Files) -> Result<Box<dyn Explorer>, Error> {
    let log = files.required("log")?;
    let recorded = recorded::Recorded::open(log, files.one("area"), files.one("truth"))?;
    Ok(Box::new(recorded))
}

fn open_bundled(name: &str) -> Result<Box<dyn Explorer>, Error> {
    match name {
        "moving" => Ok(Box::new(moving::Moving::default())),
        "staying" => Ok(Box::new(staying::Staying::default())),
        _ => Err(Error::Usage(format!("drone has no recording {name:?}"))),
    }
}

/// Names of the environments, the thesis' first.
const ENVIRONMENTS: [(&str, &str); 4] = [
    ("urban", "urban (thesis)"),
    ("suburban", "suburban"),
    ("dense", "dense urban"),
    ("high", "high-rise"),
];

fn environment(settings: &Settings) -> EnvironmentKind {
    match settings.choice("environment") {
        "suburban" => EnvironmentKind::Suburban,
        "dense" => EnvironmentKind::DenseUrban,
        "high" => EnvironmentKind::HighRise,
        _ => EnvironmentKind::Urban,
    }
}

/// The thesis' choice first.
fn resampling() -> Control {
    Control::choice(
        "resampler",
        "the thesis' filter resamples",
        &[
            ("systematic", "systematically (thesis)"),
            ("multinomial", "multinomially"),
            ("residual", "by residuals"),
            ("stratified", "by strata"),
        ],
    )
}

fn resampler(settings: &Settings) -> ResamplerKind {
    match settings.choice("resampler") {
        "multinomial" => ResamplerKind::Multinomial,
        "residual" => ResamplerKind::Residual,
        "stratified" => ResamplerKind::Stratified,
        _ => ResamplerKind::Systematic,
    }
}

/// What both synthetic flights share.
fn common(particles: f64, height_m: f64) -> [Control; 4] {
    [
        Control::slider("particles", "particles", "", [100.0, 3000.0, 50.0], particles),
        Control::slider("height", "height of the drone", "m", [100.0, 1500.0, 25.0], height_m),
        Control::choice("environment", "what is built", &ENVIRONMENTS),
        Control::slider("seed", "seed", "", [0.0, 99.0, 1.0], 0.0),
    ]
}

#[cfg(test)]
mod tests;
