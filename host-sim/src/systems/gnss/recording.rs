//! The files of a replay, read.

use std::path::{Path, PathBuf};

use kestirim_gnss_ppp::{Correction, Corrections, GpsTime, Receiver};

use super::files::antex::Antennas;
use super::files::blq::StationLoading;
use super::files::rinex_clock::Clocks;
use super::files::rinex_obs::{Epoch, Observations};
use super::files::sp3::Orbits;
use super::files::time::leap_seconds;
use super::products::{Products, patterns};
use super::sky::{Day, MIDNIGHT};
use crate::Error;
use crate::text::printable_path;

/// Which files to read.
#[derive(Debug, Clone, Copy)]
pub struct Files<'a> {
    /// What the receiver observed.
    pub observations: &'a Path,
    /// Orbits, and clocks where there are no others.
    pub orbits: &'a [PathBuf],
    /// Clocks.
    pub clocks: &'a [PathBuf],
    /// Antennas.
    pub antennas: &'a Path,
    /// Ocean loading.
    pub ocean_loading: Option<&'a Path>,
}

/// What a receiver recorded, and all that must be known for a position.
#[derive(Debug)]
pub struct Recording {
    observations: Observations,
    products: Products,
    antennas: Antennas,
    loading: Option<StationLoading>,
    /// Midnight before the first epoch.
    pub midnight: GpsTime,
    /// The first and the last time of an orbit, s since the midnight.
    pub orbits_span: [f64; 2],
    /// What a user should know of the files.
    pub warnings: Vec<String>,
}

impl Recording {
    /// Reads the files; those that do not need each other at the same time.
    ///
    /// # Errors
    /// The file, the line, and what was expected there.
    pub fn read(files: &Files<'_>, corrections: Corrections) -> Result<Self, Error> {
        let clocks = || (!files.clocks.is_empty()).then(|| Clocks::read(files.clocks)).transpose();
        let (observations, (orbits, clocks)) = rayon::join(
            || Observations::read(files.observations),
            || rayon::join(|| Orbits::read(files.orbits), clocks),
        );
        let (mut observations, mut orbits, mut clocks) = (observations?, orbits?, clocks?);
        let mut antennas = Antennas::read(files.antennas, &observations.antenna)?;
        let mut loading = match files.ocean_loading {
            Some(path) => {
                let place = observations.approximate_position;
                Some(StationLoading::read(path, &observations.marker, place)?)
            }
            None => None,
        };
        let Some(start) = observations.epochs.first().map(|epoch| epoch.time) else {
            return Err(Error::File {
                path: files.observations.to_path_buf(),
                problem: "expected observations of GPS satellites, found none".to_owned(),
            });
        };
        let mut warnings = std::mem::take(&mut observations.warnings);
        warnings.append(&mut orbits.warnings);
        if let Some(clocks) = &mut clocks {
            warnings.append(&mut clocks.warnings);
        }
        warnings.append(&mut antennas.warnings);
        match &mut loading {
            Some(loading) => warnings.append(&mut loading.warnings),
            None if corrections.has(Correction::OceanLoading) => warnings.push(
                "the load of the oceans' tides is not corrected, up to some centimetres (--blq)"
                    .to_owned(),
            ),
            None => {}
        }
        let midnight = GpsTime::new(start.day(), 0.0);
        let unknown = |&&prn: &&u8| {
            let antenna = antennas.satellite(prn, start);
            !orbits.satellite(prn).is_empty() && antenna.and_then(patterns).is_none()
        };
        let strangers: Vec<_> = observations.signals.keys().filter(unknown).collect();
        if !strangers.is_empty() && corrections.has(Correction::SatelliteAntenna) {
            warnings.push(format!(
                "{}: does not know the antennas of {}: they are off by a metre or more",
                printable_path(files.antennas),
                names(strangers.into_iter().copied()),
            ));
        }
        let times = orbits.satellites().filter_map(|prn| {
            let samples = orbits.satellite(prn);
            Some([samples.first()?.time, samples.last()?.time].map(|time| time.since(midnight)))
        });
        let orbits_span = times
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], [first, last]| {
                [a.min(first), b.max(last)]
            });
        let products = Products::new(start, &orbits, clocks.as_ref(), &antennas);
        Ok(Self { observations, products, antennas, loading, midnight, orbits_span, warnings })
    }

    /// A synthetic day: antennas are points, and oceans have no tides.
    pub fn of_day(day: Day) -> Self {
        Self {
            observations: Observations { epochs: day.epochs, ..Observations::default() },
            products: day.products,
            antennas: Antennas::default(),
            loading: None,
            midnight: MIDNIGHT,
            orbits_span: [f64::NEG_INFINITY, f64::INFINITY],
            warnings: Vec::new(),
        }
    }

    /// The epochs up to a time, s since the midnight before the first one.
    pub fn epochs(&self, until: Option<f64>) -> &[Epoch] {
        // A receiver's clock is some milliseconds off at most.
        let last = until.map_or(f64::INFINITY, |until| until + 1e-2);
        let epochs = &self.observations.epochs;
        &epochs[..epochs.partition_point(|epoch| self.seconds(epoch) <= last)]
    }

    /// Seconds since the midnight before the first epoch.
    pub fn seconds(&self, epoch: &Epoch) -> f64 {
        epoch.time.since(self.midnight)
    }

    /// Where the file says that the marker is, ECEF, m.
    pub const fn approximate_position(&self) -> Option<[f64; 3]> {
        self.observations.approximate_position
    }

    /// Orbits, clocks and antennas of satellites.
    pub const fn products(&self) -> &Products {
        &self.products
    }

    /// What is known of the receiver, of which some `corrections` are applied.
    pub fn receiver(&self, corrections: Corrections) -> Receiver<'_> {
        let [up, east, north] = self.observations.antenna_delta_hen;
        Receiver {
            antenna: self.antennas.receiver.as_ref().and_then(patterns),
            eccentricity: [east, north, up],
            ocean_loading: self.loading.as_ref().and_then(|station| station.loading.as_ref()),
            ut1_minus_gps: -leap_seconds(self.observations.epochs[0].time),
            corrections,
        }
    }
}

/// Satellites as they are named in files.
pub fn names(satellites: impl IntoIterator<Item = u8>) -> String {
    let names: Vec<_> = satellites.into_iter().map(|prn| format!("G{prn:02}")).collect();
    names.join(" ")
}
