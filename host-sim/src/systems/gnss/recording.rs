//! What a receiver recorded: from files or synthetic.

mod coverage;
pub mod model;
pub mod products;
pub mod truth;

use std::path::PathBuf;

use kestirim_gnss_files::{
    Antenna, Antennas, Biases, Clocks, Observations, Orbits, StationLoading, Warning,
    satellite_name,
};
use kestirim_gnss_ppp::{Carriers, Correction, Corrections, GpsTime, OceanLoading, Receiver};
use nalgebra::Vector3;

use self::model::{Epoch, error, patterns, receiver_patterns};
use self::products::Products;
use super::simulate::{Day, INTERVAL_S, MIDNIGHT, Rates, UTC_MINUS_GPS};
use crate::Error;
use crate::system::Files;

/// The number of the first satellite of Galileo, `E01`.
const FIRST_GALILEO: u8 = 101;
/// How much of a synthetic day is a recording, s.
const SYNTHETIC_S: f64 = 8.0 * 3600.0;

/// What a receiver recorded, and all that must be known for a position.
#[derive(Debug)]
pub struct Recording {
    /// Where the observations were read.
    pub path: PathBuf,
    /// Where the marker really is, ECEF, m, if that is known.
    pub truth: Option<Vector3<f64>>,
    epochs: Vec<Epoch>,
    approximate_position: Option<[f64; 3]>,
    /// The antenna's reference point above, east and north of the marker, m.
    antenna_delta_hen: [f64; 3],
    products: Products,
    antenna: Option<Antenna>,
    /// On which carriers satellites of Galileo are observed.
    galileo: Option<Carriers>,
    loading: Option<OceanLoading>,
    /// UTC ahead of GPS time, s.
    utc_minus_gps: f64,
    /// Midnight before the first epoch.
    pub midnight: GpsTime,
    /// The first and the last time of an orbit, s since the midnight.
    pub orbits_span: [f64; 2],
    /// What a user should know of the files, some of it only if a correction is applied.
    warnings: Vec<(Option<Correction>, String)>,
}

impl Recording {
    /// Reads the files; those that do not need each other at the same time.
    ///
    /// # Errors
    /// The file, the line, and what was expected there.
    pub fn read(files: &Files) -> Result<Self, Error> {
        let path = files.required("obs")?;
        files.required("sp3")?;
        let antex = files.required("antex")?;
        let truth = files.one("truth").map(truth::read).transpose()?;
        let biases = Biases::read(files.all("bias")).map_err(error)?;
        let clocks = files.all("clk");
        let clocks = || (!clocks.is_empty()).then(|| Clocks::read(clocks)).transpose();
        let (observations, (orbits, clocks)) = rayon::join(
            || Observations::read_unbiased(path, &biases),
            || rayon::join(|| Orbits::read(files.all("sp3")), clocks),
        );
        let observations = observations.map_err(error)?;
        let (orbits, clocks) = (orbits.map_err(error)?, clocks.map_err(error)?);
        let antennas = Antennas::read(files.all("antex"), &observations.antenna).map_err(error)?;
        let near = observations.approximate_position;
        let loading = files
            .one("blq")
            .map(|path| StationLoading::read(path, &observations.marker, near).map_err(error));
        let loading = loading.transpose()?;
        let Some(start) = observations.epochs.first().map(|epoch| epoch.time) else {
            return Err(Error::File {
                path: path.to_path_buf(),
                problem: "expected observations of GPS satellites, found none".to_owned(),
            });
        };
        let mut warnings = Vec::new();
        let mut warn = |more: &[Warning]| {
            warnings.extend(more.iter().map(|warning| (None, warning.to_string())));
        };
        warn(&observations.warnings);
        warn(&orbits.warnings);
        if let Some(clocks) = &clocks {
            warn(&clocks.warnings);
        }
        warn(&antennas.warnings);
        match &loading {
            Some(loading) => warn(&loading.warnings),
            None => warnings.push((
                Some(Correction::OceanLoading),
                "the load of the oceans' tides is not corrected, up to some centimetres (--blq)"
                    .to_owned(),
            )),
        }
        let midnight = GpsTime::new(start.day(), 0.0);
        let left_out =
            coverage::left_out(&observations, &orbits, &antennas, (antex, start), &mut warnings);
        let galileo = observations.signals.range(FIRST_GALILEO..).next();
        let galileo = galileo.map(|(_, signals)| model::carriers(signals.carriers));
        let orbits_span = coverage::span(&orbits, midnight);
        let products = Products::new(start, &orbits, clocks.as_ref(), &antennas);
        let loading = loading.and_then(|station| station.loading);
        Ok(Self {
            path: path.to_path_buf(),
            truth,
            epochs: observations
                .epochs
                .into_iter()
                .map(|mut epoch| {
                    epoch.satellites.retain(|observed| !left_out.contains(&observed.prn));
                    model::epoch(epoch)
                })
                .collect(),
            approximate_position: observations.approximate_position,
            antenna_delta_hen: observations.antenna_delta_hen,
            products,
            antenna: antennas.receiver,
            galileo,
            loading: loading.as_ref().map(model::ocean_loading),
            utc_minus_gps: -start.leap_seconds(),
            midnight,
            orbits_span,
            warnings,
        })
    }

    /// The first hours of a synthetic day by name.
    ///
    /// # Errors
    /// [`Error::Usage`] if there is none of that name.
    pub fn synthetic(name: &str) -> Result<Self, Error> {
        let rates = match name {
            "faults" => Rates::RECORDING,
            "clean" => Rates::NONE,
            _ => return Err(Error::Usage(format!("there is no synthetic day {name:?}"))),
        };
        let mut day = Day::new(0, 0, &rates);
        day.epochs.truncate((SYNTHETIC_S / INTERVAL_S) as usize);
        Ok(Self::of_day(day))
    }

    /// A synthetic day: antennas are points, and oceans have no tides.
    pub fn of_day(day: Day) -> Self {
        Self {
            path: PathBuf::from("synthetic day"),
            truth: Some(day.marker),
            epochs: day.epochs,
            approximate_position: None,
            antenna_delta_hen: [0.0; 3],
            products: day.products,
            antenna: None,
            galileo: None,
            loading: None,
            utc_minus_gps: UTC_MINUS_GPS,
            midnight: MIDNIGHT,
            orbits_span: [f64::NEG_INFINITY, f64::INFINITY],
            warnings: Vec::new(),
        }
    }

    /// The epochs up to a time, s since the midnight before the first one.
    pub fn epochs(&self, until: Option<f64>) -> &[Epoch] {
        // A receiver's clock is some milliseconds off at most.
        let last = until.map_or(f64::INFINITY, |until| until + 1e-2);
        &self.epochs[..self.epochs.partition_point(|epoch| self.seconds(epoch) <= last)]
    }

    /// Times of the first and the last epoch, s since the midnight before the first one.
    pub fn span(&self) -> [f64; 2] {
        let ends = [self.epochs.first(), self.epochs.last()];
        ends.map(|epoch| epoch.map_or(0.0, |epoch| self.seconds(epoch)))
    }

    /// What a user should know of the files if some corrections are applied.
    pub fn warnings(&self, corrections: Corrections) -> impl Iterator<Item = String> {
        let concerns = move |of: &Option<Correction>| of.is_none_or(|it| corrections.has(it));
        let some = self.warnings.iter().filter(move |(of, _)| concerns(of));
        some.map(|(_, warning)| warning.clone())
    }

    /// Seconds since the midnight before the first epoch.
    pub fn seconds(&self, epoch: &Epoch) -> f64 {
        epoch.time.since(self.midnight)
    }

    /// Where the file says that the marker is, ECEF, m.
    pub const fn approximate_position(&self) -> Option<[f64; 3]> {
        self.approximate_position
    }

    /// Whether satellites of Galileo are observed.
    pub const fn has_galileo(&self) -> bool {
        self.galileo.is_some()
    }

    /// Orbits, clocks and antennas of satellites.
    pub const fn products(&self) -> &Products {
        &self.products
    }

    /// The receiver's antenna, if its phase centres are known.
    pub fn receiver_antenna(&self) -> Option<&str> {
        self.antenna.as_ref().map(|antenna| antenna.name.as_str())
    }

    /// What is known of the receiver, of which some `corrections` are applied.
    pub fn receiver(&self, corrections: Corrections) -> Receiver<'_> {
        let [up, east, north] = self.antenna_delta_hen;
        Receiver {
            antenna: self.antenna.as_ref().and_then(|it| patterns(it, Carriers::L1L2)),
            galileo_antenna: (self.galileo)
                .and_then(|carriers| receiver_patterns(self.antenna.as_ref()?, carriers)),
            eccentricity: [east, north, up],
            ocean_loading: self.loading.as_ref(),
            ut1_minus_gps: self.utc_minus_gps,
            corrections,
        }
    }
}

/// Satellites as they are named in files; of many, the first and how many more.
pub fn names(satellites: impl IntoIterator<Item = u8>) -> String {
    const MOST: usize = 12;
    let mut names: Vec<_> = satellites.into_iter().map(satellite_name).collect();
    let more = names.len().saturating_sub(MOST);
    names.truncate(MOST);
    let named = names.join(" ");
    if more == 0 { named } else { format!("{named} and {more} more") }
}
