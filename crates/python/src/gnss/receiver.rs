//! What a receiver recorded, and all that must be known for a position: from files.

use std::path::{Path, PathBuf};

use kestirim_gnss_files::{
    Antenna, Antennas, Biases, Clocks, Observations, Observed, Orbits, StationLoading, Warning,
};
use kestirim_gnss_ppp::{Carriers, Corrections, GpsTime, OceanLoading, Receiver};
use kestirim_health::{Health, Reason};
use pyo3::PyResult;

use super::products::{Products, carriers, patterns, time};
use crate::error::{KestirimError, refused};

/// Fewer satellites give no position, …
const FEWEST: usize = 4;
/// … and so many epochs with fewer make a poor day.
const POOR: f64 = 0.1;
/// The number of the first satellite of Galileo, `E01`.
const FIRST_GALILEO: u8 = 101;

/// Where the files are.
pub(super) struct Files {
    pub(super) obs: String,
    pub(super) sp3: Vec<String>,
    pub(super) antex: Vec<String>,
    pub(super) clk: Vec<String>,
    pub(super) bias: Vec<String>,
    pub(super) blq: Option<String>,
}

/// Observations of one instant.
pub(super) struct Epoch {
    pub(super) time: GpsTime,
    pub(super) power_failure: bool,
    pub(super) satellites: Vec<Observed>,
}

/// What a receiver recorded.
pub(super) struct Recording {
    epochs: Vec<Epoch>,
    pub(super) products: Products,
    antenna_delta_hen: [f64; 3],
    antenna: Option<Antenna>,
    galileo: Option<Carriers>,
    loading: Option<OceanLoading>,
    utc_minus_gps: f64,
    midnight: GpsTime,
    orbits_span: [f64; 2],
    pub(super) warnings: Vec<String>,
}

fn paths(names: &[String]) -> Vec<PathBuf> {
    names.iter().map(PathBuf::from).collect()
}

impl Recording {
    /// Reads the files.
    pub(super) fn read(files: &Files) -> PyResult<Self> {
        let biases = Biases::read(&paths(&files.bias)).map_err(refused)?;
        let observations =
            Observations::read_unbiased(Path::new(&files.obs), &biases).map_err(refused)?;
        let orbits = Orbits::read(&paths(&files.sp3)).map_err(refused)?;
        let clocks = (!files.clk.is_empty()).then(|| Clocks::read(&paths(&files.clk)));
        let clocks = clocks.transpose().map_err(refused)?;
        let antennas =
            Antennas::read(&paths(&files.antex), &observations.antenna).map_err(refused)?;
        let near = observations.approximate_position;
        let loading = files.blq.as_ref();
        let loading =
            loading.map(|path| StationLoading::read(Path::new(path), &observations.marker, near));
        let loading = loading.transpose().map_err(refused)?;
        let Some(start) = observations.epochs.first().map(|epoch| epoch.time) else {
            let sentence = "expected observations of GPS satellites, found none";
            return Err(KestirimError::new_err(format!("{}: {sentence}", files.obs)));
        };
        let told = [
            &observations.warnings[..],
            &orbits.warnings,
            clocks.as_ref().map_or(&[], |clocks| &clocks.warnings),
            &antennas.warnings,
            loading.as_ref().map_or(&[], |loading| &loading.warnings),
        ];
        let warnings = told.into_iter().flatten().map(Warning::to_string).collect();
        let galileo = observations.signals.range(FIRST_GALILEO..).next();
        let galileo = galileo.map(|(_, signals)| carriers(signals.carriers));
        let products = Products::new(start, &orbits, clocks.as_ref(), &antennas);
        let left_out = left_out(&observations, &orbits, &antennas);
        let epochs = observations.epochs.into_iter().map(|mut epoch| {
            epoch.satellites.retain(|observed| !left_out.contains(&observed.prn));
            let (power_failure, satellites) = (epoch.power_failure, epoch.satellites);
            Epoch { time: time(epoch.time), power_failure, satellites }
        });
        let loading = loading.and_then(|station| station.loading);
        let midnight = GpsTime::new(start.day(), 0.0);
        Ok(Self {
            epochs: epochs.collect(),
            products,
            antenna_delta_hen: observations.antenna_delta_hen,
            antenna: antennas.receiver,
            galileo,
            loading: loading.map(|it| OceanLoading { amplitude: it.amplitude, lag: it.lag }),
            utc_minus_gps: -start.leap_seconds(),
            midnight,
            orbits_span: span(&orbits, midnight),
            warnings,
        })
    }

    /// The epochs up to a time, s since the midnight before the first one.
    pub(super) fn epochs(&self, until: Option<f64>) -> &[Epoch] {
        // A receiver's clock is some milliseconds off at most.
        let last = until.map_or(f64::INFINITY, |until| until + 1e-2);
        &self.epochs[..self.epochs.partition_point(|epoch| self.seconds(epoch) <= last)]
    }

    /// Seconds since the midnight before the first epoch.
    pub(super) fn seconds(&self, epoch: &Epoch) -> f64 {
        epoch.time.since(self.midnight)
    }

    /// What the files show before anything is solved, as `host-sim check` tells it.
    pub(super) fn doubts(&self) -> Health {
        let ends = [self.epochs.first(), self.epochs.last()];
        let [first, last] = ends.map(|epoch| epoch.map_or(0.0, |epoch| self.seconds(epoch)));
        let [begin, end] = self.orbits_span;
        let few = self.epochs.iter().filter(|epoch| epoch.satellites.len() < FEWEST).count();
        Health::GOOD
            .with(Reason::Dropout, few as f64 > POOR * self.epochs.len() as f64)
            .with(Reason::Time, begin > first || end < last)
    }

    pub(super) const fn has_galileo(&self) -> bool {
        self.galileo.is_some()
    }

    /// What is known of the receiver. An antenna that was calibrated for GPS alone is taken to be on E1 as on L1, and on
    /// E5a and E5b as on L2.
    pub(super) fn receiver(&self, corrections: Corrections) -> Receiver<'_> {
        let [up, east, north] = self.antenna_delta_hen;
        let on = |carriers| self.antenna.as_ref().and_then(|it| patterns(it, carriers));
        Receiver {
            antenna: on(Carriers::L1L2),
            galileo_antenna: self.galileo.and_then(|it| on(it).or_else(|| on(Carriers::L1L2))),
            eccentricity: [east, north, up],
            ocean_loading: self.loading.as_ref(),
            ut1_minus_gps: self.utc_minus_gps,
            corrections,
        }
    }
}

/// From when to when there are orbits, s since midnight.
fn span(orbits: &Orbits, midnight: GpsTime) -> [f64; 2] {
    let times = orbits.satellites().filter_map(|prn| {
        let samples = orbits.satellite(prn);
        let ends = [samples.first()?.time, samples.last()?.time];
        Some(ends.map(|at| time(at).since(midnight)))
    });
    times.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], [first, last]| {
        [a.min(first), b.max(last)]
    })
}

/// Galileo satellites whose orbits or antennas are not known: a metre off is worse than nothing, where GPS serves without.
fn left_out(observations: &Observations, orbits: &Orbits, antennas: &Antennas) -> Vec<u8> {
    let start = observations.epochs.first().map(|epoch| epoch.time);
    let is_unknown = |number: u8, of: kestirim_gnss_files::Carriers| {
        let antenna = start.and_then(|start| antennas.satellite(number, start));
        let antenna = antenna.and_then(|antenna| patterns(antenna, carriers(of)));
        orbits.satellite(number).is_empty() || antenna.is_none()
    };
    let galileo = observations.signals.range(FIRST_GALILEO..);
    let unknown = galileo.filter(|(number, signals)| is_unknown(**number, signals.carriers));
    unknown.map(|(number, _)| *number).collect()
}
