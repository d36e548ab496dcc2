//! The position of a receiver, from its observations and precise orbits and clocks, or broadcast ephemerides.

use std::path::PathBuf;

use kestirim_gnss_ppp::Corrections;
use kestirim_health::Health;
use kestirim_ppp_filter::{Config, Health as Quality, Motion};
use kestirim_replay::gnss::{
    Ambiguities, FilterKind, Fixing, Followed, Method, Order, Pass, Paths, Recording, Systems,
    follow,
};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{Results, code, reasons};
use crate::error::{KestirimError, refused, unknown};
use crate::stack;

/// Computes the positions of a receiver.
#[pyfunction]
#[pyo3(signature = (obs, sp3, antex, nav, clk, bias, blq, erp, process_noise, method, filter, systems, ambiguities, mask, gradient, until, smooth))]
pub(crate) fn gnss<'py>(
    py: Python<'py>,
    obs: PathBuf,
    sp3: Vec<PathBuf>,
    antex: Vec<PathBuf>,
    nav: Vec<PathBuf>,
    clk: Vec<PathBuf>,
    bias: Vec<PathBuf>,
    blq: Option<PathBuf>,
    erp: Option<PathBuf>,
    process_noise: Option<f64>,
    method: &str,
    filter: &str,
    systems: &str,
    ambiguities: &str,
    mask: Option<f64>,
    gradient: Option<f64>,
    until: Option<f64>,
    smooth: bool,
) -> PyResult<Bound<'py, PyDict>> {
    let motion = match process_noise {
        None => Motion::Static,
        Some(process_noise) => Motion::Kinematic { process_noise },
    };
    let config = self::filter(filter)?.config(motion, false);
    let config = Config {
        elevation_mask: mask.unwrap_or(config.elevation_mask),
        gradient: gradient.unwrap_or(config.gradient),
        ..config
    };
    let method = self::method(method)?;
    let systems = self::systems(systems)?;
    let ambiguities = self::ambiguities(ambiguities)?;
    let found = py.detach(|| {
        let run = move || -> PyResult<Found> {
            let paths = Paths {
                obs: &obs,
                sp3: &sp3,
                nav: &nav,
                antex: &antex,
                clk: &clk,
                bias: &bias,
                blq: blq.as_deref(),
                erp: erp.as_deref(),
            };
            let recording = Recording::read(&paths).map_err(refused)?;
            let epochs = recording.epochs(until);
            let receiver = recording.receiver(Corrections::ALL);
            let run = |order| {
                let pass = Pass { systems, order, method, ambiguities, ..Pass::default() };
                follow(&recording, epochs, &receiver, config, pass, &mut || ())
            };
            let mut followed = run(Order::Forwards);
            // Before smoothing: the observations' warnings refer to one direction of time.
            let doubts = recording.doubts().and(followed.doubts());
            let mut warnings = recording.warnings_of(Corrections::ALL, epochs, &followed);
            warnings.extend(followed.warnings());
            if smooth {
                followed = followed.smoothed(&run(Order::Backwards));
                warnings.extend(followed.disagreement(motion));
            }
            if followed.fixes.is_empty() {
                let why = warnings.iter().map(|warning| format!("; {warning}"));
                let (count, why): (_, String) = (epochs.len(), why.collect());
                let sentence = format!("none of {count} epochs has a solution{why}");
                return Err(KestirimError::new_err(sentence));
            }
            Ok(Found { followed, warnings, doubts })
        };
        stack::with_much(run)
    })?;
    found.results(py)
}

fn filter(name: &str) -> PyResult<FilterKind> {
    let known = FilterKind::ALL.into_iter().find(|filter| filter.name() == name);
    let expected = "'default', 'gkf', 'rkf', 'skf', 'ikf' or 'adaptive'";
    known.ok_or_else(|| unknown("filter", name, expected))
}

fn method(name: &str) -> PyResult<Method> {
    match name {
        "filter" => Ok(Method::Filter),
        "single" => Ok(Method::Single),
        _ => Err(unknown("method", name, "'filter' or 'single'")),
    }
}

fn systems(name: &str) -> PyResult<Systems> {
    match name {
        "all" => Ok(Systems::All),
        "gps" => Ok(Systems::Gps),
        "galileo" => Ok(Systems::Galileo),
        "gps-galileo" => Ok(Systems::GpsGalileo),
        _ => Err(unknown("systems", name, "'all', 'gps', 'galileo' or 'gps-galileo'")),
    }
}

fn ambiguities(name: &str) -> PyResult<Ambiguities> {
    match name {
        "float" => Ok(Ambiguities::Float),
        "fixed" => Ok(Ambiguities::Fixed),
        _ => Err(unknown("ambiguities", name, "'float' or 'fixed'")),
    }
}

struct Found {
    followed: Followed,
    warnings: Vec<String>,
    /// The doubts that concern every epoch.
    doubts: Health,
}

impl Found {
    fn results(self, py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
        let Self { followed, warnings, doubts } = self;
        let Followed { fixes, deviations, delays, healths, heard, epochs, fixing, .. } = followed;
        let least = code(doubts.state());
        let in_short = || healths.iter().map(|health| health.in_short());
        let all = in_short().fold(doubts, Health::and);
        Ok(Results::new(py)
            .line("t", fixes.iter().map(|fix| fix.t).collect())?
            .table(
                "position",
                fixes.iter().map(|fix| fix.position.into()).collect::<Vec<[f64; 3]>>(),
            )?
            .table("sigma", deviations)?
            .line("clock", delays.iter().map(|[clock, _]| *clock).collect())?
            .line("wet_delay", delays.iter().map(|[_, wet]| *wet).collect())?
            .line("satellites", heard.iter().map(|count| *count as i64).collect())?
            .line("converged", healths.iter().map(|it| *it == Quality::Converged).collect())?
            .line("health", in_short().map(|health| least.max(code(health.state()))).collect())?
            .with("epochs", epochs)?
            .with("fixed_epochs", fixing.map_or(0, |Fixing { epochs, .. }| epochs))?
            .words("warnings", warnings)?
            .words("reasons", reasons(all))?
            .done())
    }
}
