//! Recordings of receivers, with all that must be known for a position.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use kestirim_gnss_files::{
    Antenna, Biases, Carriers, Error, Observations, Received, StationLoading, System, Text,
};
use kestirim_gnss_ppp::{Correction, Corrections, GpsTime, OceanLoading, Receiver};
use kestirim_health::{Health, Reason};
use kestirim_ppp_filter::Config;
use nalgebra::Vector3;

use super::calendar::{calendar, in_words};
use super::model::{self, Epoch, receiver_patterns};
use super::products::Products;
use super::shelf::Shelf;
use super::told::{Served, Told};

/// The fewest satellites that give a position.
pub const FEWEST_SATELLITES: usize = 4;
/// The share of epochs with too few satellites, or without a solution, above which a day is poor.
pub(super) const POOR: f64 = 0.1;
/// The paths of the files.
#[derive(Debug, Clone, Copy)]
pub struct Paths<'a> {
    /// Observations: RINEX 2 to 4, plain or compact, or a recorded stream, UBX or RTCM 3; packed or not.
    pub obs: &'a Path,
    /// Orbits: one SP3 file or more. Without any, broadcast ephemerides are used.
    pub sp3: &'a [PathBuf],
    /// Broadcast ephemerides: one RINEX navigation file or stream or more; by default the observations themselves, if
    /// they are a stream.
    pub nav: &'a [PathBuf],
    /// Antennas: one ANTEX file or more.
    pub antex: &'a [PathBuf],
    /// Clocks; without any, those of the orbit files are used.
    pub clk: &'a [PathBuf],
    /// Code biases.
    pub bias: &'a [PathBuf],
    /// Ocean loading coefficients of stations.
    pub blq: Option<&'a Path>,
    /// Parameters of the Earth's rotation.
    pub erp: Option<&'a Path>,
}

/// The recording of a receiver, with all that must be known for a position.
#[derive(Debug)]
pub struct Recording {
    /// The path of the observations.
    pub path: PathBuf,
    /// The true position of the marker, ECEF, m, if known; used for accuracy alone.
    pub truth: Option<Vector3<f64>>,
    epochs: Vec<Epoch>,
    approximate_position: Option<[f64; 3]>,
    /// The antenna's reference point above, east and north of the marker, m.
    antenna_delta_hen: [f64; 3],
    products: Products,
    antenna: Option<Antenna>,
    /// The observed carriers, one pair for each system.
    carriers: Vec<Carriers>,
    loading: Option<OceanLoading>,
    /// The position of the Earth's pole, rad.
    pole: Option<[f64; 2]>,
    /// UTC minus GPS time, s.
    utc_minus_gps: f64,
    /// The midnight before the first epoch.
    pub midnight: GpsTime,
    /// The first and the last time of the orbits, s since the midnight.
    pub orbits_span: [f64; 2],
    /// Warnings about the files; some concern a correction and count only if that is applied.
    warnings: Vec<(Option<Correction>, String)>,
}

impl Recording {
    /// Reads the files; those that are independent of each other, in parallel.
    ///
    /// # Errors
    /// An error that names the file, the line and what was expected there.
    pub fn read(paths: &Paths<'_>) -> Result<Self, Error> {
        Self::read_beside(paths, &Shelf::default())
    }

    /// Reads the files, sharing products with other recordings through the shelf.
    ///
    /// # Errors
    /// Those of [`read`](Self::read).
    pub fn read_beside(paths: &Paths<'_>, shelf: &Shelf) -> Result<Self, Error> {
        let biases = shelf.biases(paths.bias)?;
        let (observations, satellites) = rayon::join(
            || Observations::read_unbiased(paths.obs, &biases),
            || Told::read(paths, shelf),
        );
        Self::of(paths, shelf, (observations?, satellites?), biases)
    }

    /// Reads a stream, UBX or RTCM 3, that is held in memory; `obs` only names it.
    ///
    /// # Errors
    /// Those of [`read`](Self::read).
    pub fn of_stream(bytes: Vec<u8>, paths: &Paths<'_>, shelf: &Shelf) -> Result<Self, Error> {
        let biases = shelf.biases(paths.bias)?;
        let text = Text::unpack(paths.obs, bytes)?;
        let Received { observations, navigation } = Received::parse(&text, &biases)?;
        let satellites = if !paths.sp3.is_empty() || !paths.nav.is_empty() {
            Told::read(paths, shelf)?
        } else if navigation.is_empty() {
            let problem = "expected ephemerides of GPS, Galileo or BeiDou, or products, found none"
                .to_owned();
            return Err(Error::File { path: paths.obs.to_path_buf(), problem });
        } else {
            Told::Broadcast(Arc::new(navigation))
        };
        Self::of(paths, shelf, (observations, satellites), biases)
    }

    fn of(
        paths: &Paths<'_>,
        shelf: &Shelf,
        (observations, satellites): (Observations, Told),
        biases: Arc<Biases>,
    ) -> Result<Self, Error> {
        let antennas = shelf.antennas(paths.antex, &observations.antenna)?;
        let near = observations.approximate_position;
        let read = |path| StationLoading::read(path, &observations.marker, near);
        let loading = paths.blq.map(read).transpose()?;
        let rotation = paths.erp.map(|path| shelf.rotation(path)).transpose()?;
        let Some(start) = observations.epochs.first().map(|epoch| epoch.time) else {
            let problem =
                "expected observations of GPS, Galileo, GLONASS or BeiDou, found none".to_owned();
            return Err(Error::File { path: paths.obs.to_path_buf(), problem });
        };
        let of_loading = loading.as_ref().map_or(&[][..], |loading| &loading.warnings);
        let told = observations.warnings.iter().chain(satellites.warnings());
        let told = told.chain(&antennas.warnings).chain(of_loading).chain(&observations.unserved);
        let mut warnings: Vec<_> = told.map(|warning| (None, warning.to_string())).collect();
        // In a day, the motion of the pole moves no place by as much as a tenth of a millimetre.
        let pole = rotation.as_ref().and_then(|rotation| rotation.pole(start));
        if rotation.is_some() && pole.is_none() {
            let warning =
                "the Earth's rotation is of another time: the tide of the pole is left out";
            warnings.push((Some(Correction::PoleTide), warning.to_owned()));
        }
        let midnight = GpsTime::new(start.day(), 0.0);
        let antex = paths.antex.first().map_or_else(String::new, |path| printable(path));
        let antennas_of = (&*antennas, &*antex);
        let Served { products, left_out, span } =
            satellites.serve(start, &observations, biases, antennas_of, &mut warnings);
        let mut carriers: Vec<Carriers> = Vec::new();
        for (_, signals) in observations.signals.iter().filter(|(it, _)| !left_out.contains(it)) {
            if carriers.iter().all(|it| it.system() != signals.carriers.system()) {
                carriers.push(signals.carriers);
            }
        }
        let loading = loading.and_then(|station| station.loading);
        Ok(Self {
            path: paths.obs.to_path_buf(),
            truth: None,
            products,
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
            antenna: antennas.receiver.clone(),
            carriers,
            loading: loading.as_ref().map(model::ocean_loading),
            pole,
            utc_minus_gps: -start.leap_seconds(),
            midnight,
            orbits_span: span,
            warnings,
        })
    }

    /// A recording made of simulated data: antennas are points, and oceans have no tides.
    ///
    /// Times count from `midnight`, UTC is `utc_minus_gps` ahead of GPS time, s.
    pub fn simulated(
        epochs: Vec<Epoch>,
        products: Products,
        midnight: GpsTime,
        utc_minus_gps: f64,
    ) -> Self {
        Self {
            path: PathBuf::from("synthetic day"),
            truth: None,
            epochs,
            approximate_position: None,
            antenna_delta_hen: [0.0; 3],
            products,
            antenna: None,
            carriers: vec![Carriers::L1L2],
            loading: None,
            pole: None,
            utc_minus_gps,
            midnight,
            orbits_span: [f64::NEG_INFINITY, f64::INFINITY],
            warnings: Vec::new(),
        }
    }

    /// Adds a warning; one that concerns a correction counts only if that is applied.
    pub fn warn(&mut self, correction: Option<Correction>, warning: impl Into<String>) {
        self.warnings.push((correction, warning.into()));
    }

    /// The epochs with fewer than four satellites.
    pub fn sparse(&self) -> impl Iterator<Item = &Epoch> {
        self.epochs.iter().filter(|epoch| epoch.satellites.len() < FEWEST_SATELLITES)
    }

    /// Epochs before the first or after the last orbit.
    pub fn uncovered(&self) -> impl Iterator<Item = &Epoch> {
        let [begin, end] = self.orbits_span;
        self.epochs.iter().filter(move |epoch| !(begin..=end).contains(&self.seconds(epoch)))
    }

    /// The doubts that the files raise before anything is solved: many epochs with fewer than four satellites, or
    /// without orbits.
    pub fn doubts(&self) -> Health {
        let are_many = |count: usize| count as f64 > POOR * self.epochs.len() as f64;
        Health::GOOD
            .with(Reason::Dropout, are_many(self.sparse().count()))
            .with(Reason::Time, are_many(self.uncovered().count()))
    }

    /// The epochs up to a time, s since the midnight before the first one.
    pub fn epochs(&self, until: Option<f64>) -> &[Epoch] {
        // A receiver's clock is off by some milliseconds at most.
        let last = until.map_or(f64::INFINITY, |until| until + 1e-2);
        &self.epochs[..self.epochs.partition_point(|epoch| self.seconds(epoch) <= last)]
    }

    /// The times of the first and the last epoch, s since the midnight before the first one.
    pub fn span(&self) -> [f64; 2] {
        let ends = [self.epochs.first(), self.epochs.last()];
        ends.map(|epoch| epoch.map_or(0.0, |epoch| self.seconds(epoch)))
    }

    /// The warnings about the files if the given corrections are applied.
    pub fn warnings(&self, corrections: Corrections) -> impl Iterator<Item = String> {
        let concerns = move |of: &Option<Correction>| of.is_none_or(|it| corrections.has(it));
        let some = self.warnings.iter().filter(move |(of, _)| concerns(of));
        some.map(|(_, warning)| warning.clone())
    }

    /// The time of an epoch, s since the midnight before the first epoch.
    pub fn seconds(&self, epoch: &Epoch) -> f64 {
        epoch.time.since(self.midnight)
    }

    /// The date and time in UTC of `seconds` since that midnight, such as 2020-06-25 12:00:00 UTC: GPS time minus the
    /// leap seconds up to the first epoch.
    pub fn utc(&self, seconds: f64) -> String {
        let utc = calendar(i64::from(self.midnight.day()), seconds + self.utc_minus_gps);
        format!("{} UTC", in_words(utc))
    }

    /// The approximate position of the marker that the file gives, ECEF, m.
    pub const fn approximate_position(&self) -> Option<[f64; 3]> {
        self.approximate_position
    }

    /// The systems whose satellites are observed and known.
    pub fn systems(&self) -> impl Iterator<Item = System> {
        self.carriers.iter().map(|carriers| carriers.system())
    }

    /// The observed carriers, one pair for each system.
    pub(super) fn carriers(&self) -> &[Carriers] {
        &self.carriers
    }

    /// Whether satellites of systems other than GPS are observed and known.
    pub fn has_others(&self) -> bool {
        self.systems().any(|system| system != System::Gps)
    }

    /// The orbits, clocks and antennas of the satellites.
    pub const fn products(&self) -> &Products {
        &self.products
    }

    /// The settings of a filter, adapted to broadcast ephemerides if those are used.
    pub fn settled(&self, config: Config) -> Config {
        let Config { correlation_time, gradient, .. } = match self.products.broadcast() {
            Some(_) => Config::broadcast(config.motion),
            None => config,
        };
        Config { correlation_time, gradient, ..config }
    }

    /// Whether gradients of the troposphere cannot be told apart from the errors that orbits and clocks leave.
    pub fn hides_gradients(&self) -> bool {
        let of = |epoch: &Epoch| {
            let known = |observed| self.products.observation(epoch.time, observed).ok();
            epoch.satellites.iter().filter_map(known).any(|it| it.hides_gradients())
        };
        self.products.broadcast().is_some() || self.epochs.first().is_some_and(of)
    }

    /// Why no ambiguity can be fixed to an integer, if that is so.
    pub fn never_whole(&self) -> Option<&'static str> {
        if self.receiver_antenna().is_none() {
            Some("the receiver's antenna is not known")
        } else if self.products.whole().is_empty() {
            Some("neither the clocks nor a file of biases has what makes ambiguities whole")
        } else {
            None
        }
    }

    /// The name of the receiver's antenna, if its phase centres are known.
    pub fn receiver_antenna(&self) -> Option<&str> {
        self.antenna.as_ref().map(|antenna| antenna.name.as_str())
    }

    /// The data of the receiver, with the `corrections` that are to be applied.
    pub fn receiver(&self, corrections: Corrections) -> Receiver<'_> {
        let [up, east, north] = self.antenna_delta_hen;
        let antenna = |system| {
            let carriers = self.carriers.iter().find(|carriers| carriers.system() == system)?;
            receiver_patterns(self.antenna.as_ref()?, *carriers)
        };
        Receiver {
            antenna: antenna(System::Gps),
            galileo_antenna: antenna(System::Galileo),
            glonass_antenna: antenna(System::Glonass),
            beidou_antenna: antenna(System::BeiDou),
            eccentricity: [east, north, up],
            ocean_loading: self.loading.as_ref(),
            pole: self.pole,
            ut1_minus_gps: self.utc_minus_gps,
            corrections,
        }
    }
}

/// A path as it can be shown on one line.
fn printable(path: &Path) -> String {
    let shown = path.display().to_string();
    shown.chars().map(|letter| if letter.is_control() { '?' } else { letter }).collect()
}
