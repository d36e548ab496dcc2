//! Recorded GNSS observations with ground truth, from `../shared/data/gnss` beside the repository.

use std::path::Path;

use host_sim::system::Files;
use host_sim::systems::gnss::recording;
use kestirim_gnss_ppp::{Corrections, sagnac};
use kestirim_ppp_filter::{Config, PppFilter, SatelliteObservation, Solution};
use kestirim_replay::gnss::{Accuracy, Fix, Recording, STATES_WITH_GALILEO};
use nalgebra::Vector3;

/// A station's day.
#[derive(Clone, Copy, Debug)]
pub struct Station {
    /// The file of observations.
    pub observations: &'static str,
    orbits: &'static [&'static str],
    clocks: &'static [&'static str],
    antennas: &'static [&'static str],
    ocean_loading: Option<&'static str>,
    /// The true position of the marker, ECEF, m.
    pub truth: [f64; 3],
    /// The end of the orbits, s of the day.
    pub until: f64,
}

/// Esbjerg, 25 June 2020: clocks every 30 s.
pub const ESBC: Station = Station {
    observations: "esbc2020177/esbc_gps.rnx.gz",
    orbits: &["esbc2020177/grg176_gps.sp3.gz", "esbc2020177/grg177_gps.sp3.gz"],
    clocks: &["esbc2020177/grg177_gps.clk.gz"],
    antennas: &["esbc2020177/esbc.atx.gz"],
    ocean_loading: None,
    truth: [3_582_104.765_7, 532_590.178_5, 5_232_755.139_0],
    until: 85_500.0,
};

/// [`ESBC`] with injected faults.
pub const ESBC_INJECTED: Station =
    Station { observations: "esbc2020177_injected/esbc_gps_CPSB0.rnx.gz", ..ESBC };

/// The day of [`ESBC`] with Galileo.
pub const ESBC_MULTI: Station = Station {
    observations: "esbc2020177_multi/ESBC00DNK_R_20201770000_01D_30S_MO.crx.gz",
    orbits: &[
        "esbc2020177_multi/GRG0MGXFIN_20201760000_01D_15M_ORB.SP3.gz",
        "esbc2020177_multi/GRG0MGXFIN_20201770000_01D_15M_ORB.SP3.gz",
    ],
    clocks: &["esbc2020177_multi/GRG0MGXFIN_20201770000_01D_30S_CLK.CLK.gz"],
    antennas: &["esbc2020177/esbc.atx.gz", "esbc2020177_multi/galileo_igs20.atx.gz"],
    ..ESBC
};

/// A Coruña, 27 May 2008: clocks every 15 minutes.
pub const ACOR: Station = Station {
    observations: "igs2008148/acor_gps.rnx.gz",
    orbits: &[
        "igs2008148/igs14811.sp3.gz",
        "igs2008148/igs14812.sp3.gz",
        "igs2008148/igs14813.sp3.gz",
    ],
    clocks: &[],
    antennas: &["igs2008148/igs05_trim.atx.gz"],
    ocean_loading: Some("igs2008148/subset.blq"),
    truth: [4_594_489.675_1, -678_367.693_5, 4_357_066.166_7],
    until: 86_400.0,
};

/// Toulouse, 27 May 2008: the day of [`ACOR`].
pub const TLSE: Station = Station {
    observations: "igs2008148/tlse_gps.rnx.gz",
    truth: [4_627_851.794_6, 119_640.086_8, 4_372_993.591_7],
    ..ACOR
};

impl Station {
    /// This day with observations from another file: a path below the folder, or a complete path.
    #[must_use]
    pub const fn observed_in(self, observations: &'static str) -> Self {
        Self { observations, ..self }
    }

    /// Reads the files of the day.
    ///
    /// # Panics
    /// A file cannot be read: those beside the repository can.
    pub fn read(&self, folder: &Path) -> Recording {
        let mut files = self.products(folder);
        files.add("obs", folder.join(self.observations));
        recording::read(&files).expect("files that can be read")
    }

    /// The files of the day except the observations.
    pub fn products(&self, folder: &Path) -> Files {
        let mut files = Files::default();
        for (field, names) in [
            ("sp3", self.orbits),
            ("clk", self.clocks),
            ("antex", self.antennas),
            ("blq", self.ocean_loading.as_slice()),
        ] {
            for name in names {
                files.add(field, folder.join(name));
            }
        }
        files
    }

    /// Tracks a receiver that is `away(t)` (ECEF, m) from the marker at second t of the day; `spoil` adds further
    /// faults.
    pub fn follow(
        &self,
        recording: &Recording,
        config: Config,
        corrections: Corrections,
        away: impl Fn(f64) -> Vector3<f64>,
        spoil: impl FnMut(f64, &mut SatelliteObservation<'_>),
    ) -> Vec<Fix> {
        let mut fixes = Vec::new();
        self.solve(recording, config, corrections, away, spoil, |t, solution| {
            fixes.push(Fix { t, position: solution.position });
        });
        fixes
    }

    /// Like [`follow`](Self::follow), with each solution given to `found` together with its second of the day.
    pub fn solve(
        &self,
        recording: &Recording,
        config: Config,
        corrections: Corrections,
        away: impl Fn(f64) -> Vector3<f64>,
        mut spoil: impl FnMut(f64, &mut SatelliteObservation<'_>),
        mut found: impl FnMut(f64, &Solution<STATES_WITH_GALILEO>),
    ) {
        let receiver = recording.receiver(corrections);
        let marker = Vector3::from(self.truth);
        let mut filter = PppFilter::<STATES_WITH_GALILEO>::new(config);
        for epoch in recording.epochs(Some(self.until)) {
            let t = recording.seconds(epoch);
            let known = |observed| recording.products().observation(epoch.time, observed).ok();
            let mut observations: Vec<_> = epoch.satellites.iter().filter_map(known).collect();
            for observation in &mut observations {
                move_receiver(observation, &marker, &(marker + away(t)));
                spoil(t, observation);
            }
            if let Ok(solution) = filter.process(epoch.time, &receiver, &observations) {
                found(t, &solution);
            }
        }
    }

    /// The paper's accuracy measures of a day with one configuration.
    ///
    /// # Panics
    /// No epoch has a solution.
    pub fn accuracy(&self, recording: &Recording, config: Config) -> Accuracy {
        let fixes =
            self.follow(recording, config, Corrections::ALL, |_| Vector3::zeros(), |_, _| {});
        self.compare(&fixes)
    }

    /// Compares positions with the truth.
    ///
    /// # Panics
    /// There are none.
    pub fn compare(&self, fixes: &[Fix]) -> Accuracy {
        Accuracy::of(fixes, 0.0, &Vector3::from(self.truth)).expect("a position")
    }
}

/// Adds offsets to a satellite's codes and phases, m.
pub fn lengthen(observation: &mut SatelliteObservation<'_>, code: f64, phase: f64) {
    for carrier in 0..2 {
        observation.code[carrier] += code;
        observation.phase[carrier] += phase / observation.carriers.wavelength()[carrier];
    }
}

/// Changes an observation to what the receiver would have observed elsewhere.
fn move_receiver(
    observation: &mut SatelliteObservation<'_>,
    from: &Vector3<f64>,
    to: &Vector3<f64>,
) {
    let satellite = observation.state.position;
    let range = |place: &Vector3<f64>| (satellite - place).norm() + sagnac(&satellite, place);
    let farther = range(to) - range(from);
    lengthen(observation, farther, farther);
}
