//! Where a receiver is, from its observations and precise orbits and clocks.

mod products;
mod receiver;

use kestirim_gnss_ppp::Corrections;
use kestirim_health::Health;
use kestirim_ppp_filter::{
    Config, Estimator, Health as Quality, Motion, PppFilter, SatelliteObservation, Solution, states,
};
use nalgebra::Vector3;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use self::receiver::{Files, Recording};
use crate::arrays::{Results, code, reasons};
use crate::error::{KestirimError, unknown};

/// States of a filter with room for twenty satellites: from no place on earth more of the 32 are seen.
const STATES: usize = states(20);
/// The same where satellites of Galileo are among them.
const STATES_WITH_GALILEO: usize = states(34);
/// Stack of the thread that filters.
const STACK_BYTES: usize = 16 << 20;

/// A receiver's positions.
#[pyfunction]
#[pyo3(signature = (obs, sp3, antex, clk, bias, blq, process_noise, filter, systems, mask, until))]
pub(crate) fn gnss<'py>(
    py: Python<'py>,
    obs: String,
    sp3: Vec<String>,
    antex: Vec<String>,
    clk: Vec<String>,
    bias: Vec<String>,
    blq: Option<String>,
    process_noise: Option<f64>,
    filter: &str,
    systems: &str,
    mask: Option<f64>,
    until: Option<f64>,
) -> PyResult<Bound<'py, PyDict>> {
    let motion = match process_noise {
        None => Motion::Static,
        Some(process_noise) => Motion::Kinematic { process_noise },
    };
    let config = Config::new(motion);
    let config = Config {
        estimator: estimator(filter, motion)?,
        elevation_mask: mask.unwrap_or(config.elevation_mask),
        ..config
    };
    let systems = Systems::named(systems)?;
    let files = Files { obs, sp3, antex, clk, bias, blq };
    let (track, warnings) = py.detach(|| {
        let run = move || -> PyResult<(Track, Vec<String>)> {
            let recording = Recording::read(&files)?;
            let mut track = follow(&recording, config, systems, until)?;
            track.doubt(recording.doubts());
            Ok((track, recording.warnings))
        };
        let thread = std::thread::Builder::new().stack_size(STACK_BYTES).spawn(run);
        let thread =
            thread.map_err(|error| KestirimError::new_err(format!("no thread: {error}")))?;
        let ended = || KestirimError::new_err("the filter ended unexpectedly");
        thread.join().map_err(|_| ended())?
    })?;
    track.results(py, warnings)
}

fn estimator(filter: &str, motion: Motion) -> PyResult<Estimator> {
    Ok(match filter {
        "default" => Estimator::guarded(motion),
        "gkf" => Estimator::plain(),
        "rkf" => Estimator::igg3(),
        "skf" => Estimator::t_test(),
        "ikf" => Estimator::iterative_igg3(),
        "adaptive" => Estimator::adaptive(),
        _ => {
            let expected = "'default', 'gkf', 'rkf', 'skf', 'ikf' or 'adaptive'";
            return Err(unknown("filter", filter, expected));
        }
    })
}

/// Satellites of which systems serve.
#[derive(Clone, Copy, PartialEq)]
enum Systems {
    All,
    Gps,
    Galileo,
}

impl Systems {
    fn named(name: &str) -> PyResult<Self> {
        match name {
            "all" => Ok(Self::All),
            "gps" => Ok(Self::Gps),
            "galileo" => Ok(Self::Galileo),
            _ => Err(unknown("systems", name, "'all', 'gps' or 'galileo'")),
        }
    }

    /// By the satellite's number: those of Galileo begin at 101.
    const fn has(self, satellite: u8) -> bool {
        match self {
            Self::All => true,
            Self::Gps => satellite <= 100,
            Self::Galileo => satellite > 100,
        }
    }
}

/// Of every epoch with a solution.
#[derive(Default)]
struct Track {
    t: Vec<f64>,
    position: Vec<[f64; 3]>,
    sigma_enu: Vec<[f64; 3]>,
    clock: Vec<f64>,
    wet_delay: Vec<f64>,
    satellites: Vec<i64>,
    converged: Vec<bool>,
    health: Vec<u8>,
    doubts: Health,
    epochs: usize,
}

fn follow(
    recording: &Recording,
    config: Config,
    systems: Systems,
    until: Option<f64>,
) -> PyResult<Track> {
    let track = if recording.has_galileo() && systems != Systems::Gps {
        feed(PppFilter::<STATES_WITH_GALILEO>::new(config), recording, systems, until)
    } else {
        feed(PppFilter::<STATES>::new(config), recording, systems, until)
    };
    if track.t.is_empty() {
        let epochs = track.epochs;
        return Err(KestirimError::new_err(format!("none of {epochs} epochs has a solution")));
    }
    Ok(track)
}

fn feed<const N: usize>(
    mut filter: PppFilter<N>,
    recording: &Recording,
    systems: Systems,
    until: Option<f64>,
) -> Track {
    let receiver = recording.receiver(Corrections::ALL);
    let mut track = Track::default();
    let mut observations: Vec<SatelliteObservation<'_>> = Vec::new();
    // Which satellites were lost since the filter took them in: an epoch without a solution tells it nothing.
    let mut lost = [false; 256];
    for epoch in recording.epochs(until) {
        track.epochs += 1;
        observations.clear();
        if epoch.power_failure {
            lost.fill(true);
        }
        for observed in epoch.satellites.iter().filter(|observed| systems.has(observed.prn)) {
            let lost = &mut lost[usize::from(observed.prn)];
            *lost |= observed.loss_of_lock.contains(&true);
            if let Some(observation) = recording.products.observation(epoch.time, observed) {
                observations.push(SatelliteObservation { lock_lost: *lost, ..observation });
            }
        }
        if let Ok(solution) = filter.process(epoch.time, &receiver, &observations) {
            for report in &solution.satellites {
                lost[usize::from(report.satellite)] = false;
            }
            track.take(recording.seconds(epoch), &solution);
        }
    }
    track
}

impl Track {
    fn take<const N: usize>(&mut self, t: f64, solution: &Solution<N>) {
        let health = solution.health.in_short();
        self.t.push(t);
        self.position.push(Vector3::into(solution.position));
        self.sigma_enu.push(solution.deviations_enu());
        self.clock.push(solution.clock);
        self.wet_delay.push(solution.wet_delay);
        self.satellites.push(solution.satellites.len() as i64);
        self.converged.push(solution.health == Quality::Converged);
        self.health.push(code(health.state()));
        self.doubts = self.doubts.and(health);
    }

    /// With what the files show, which concerns every epoch.
    fn doubt(&mut self, doubts: Health) {
        let least = code(doubts.state());
        self.health.iter_mut().for_each(|health| *health = least.max(*health));
        self.doubts = self.doubts.and(doubts);
    }

    fn results(self, py: Python<'_>, warnings: Vec<String>) -> PyResult<Bound<'_, PyDict>> {
        Ok(Results::new(py)
            .line("t", self.t)?
            .table("position", self.position)?
            .table("sigma", self.sigma_enu)?
            .line("clock", self.clock)?
            .line("wet_delay", self.wet_delay)?
            .line("satellites", self.satellites)?
            .line("converged", self.converged)?
            .line("health", self.health)?
            .with("epochs", self.epochs)?
            .with("warnings", warnings)?
            .with("reasons", reasons(self.doubts))?
            .done())
    }
}
