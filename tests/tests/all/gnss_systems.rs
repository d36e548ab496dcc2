//! GLONASS and BeiDou in addition to GPS and Galileo.
//!
//! Products of the recorded days have orbits and clocks of GLONASS, and those of one have BeiDou's, but none of the
//! antenna files has their satellites. They are given offsets that all satellites of a type nearly share; a file of the
//! IGS would give these to some centimetres, and for each satellite. The results measured here are therefore no better
//! than with such a file.
//!
//! The recordings are in `../shared/data/gnss`, beside the repository. Where they are absent these tests print SKIPPED
//! and pass; with `KESTIRIM_REQUIRE_DATA=1` they fail instead. With `--nocapture` each is printed.

use std::fmt::Write as _;
use std::path::PathBuf;

use kestirim_gnss_files::System;
use kestirim_gnss_ppp::Corrections;
use kestirim_ppp_filter::{Config, Motion};
use kestirim_replay::gnss::{Epoch, Followed, Pass, Paths, Recording, Systems, follow};
use kestirim_tests::recordings::folder_of;
use nalgebra::Vector3;

const KINEMATIC: Motion = Motion::Kinematic { process_noise: 100.0 };
/// The length of a session, and the time from which its errors count, s.
const HOUR: f64 = 3_600.0;
const SETTLED: f64 = 1_200.0;

/// A station with products of several systems.
struct Station {
    observations: &'static str,
    orbits: &'static [&'static str],
    clocks: &'static [&'static str],
    antennas: &'static [&'static str],
    truth: [f64; 3],
}

const ESBC: Station = Station {
    observations: "esbc2020177_multi/ESBC00DNK_R_20201770000_01D_30S_MO.crx.gz",
    orbits: &[
        "esbc2020177_multi/GRG0MGXFIN_20201760000_01D_15M_ORB.SP3.gz",
        "esbc2020177_multi/GRG0MGXFIN_20201770000_01D_15M_ORB.SP3.gz",
    ],
    clocks: &["esbc2020177_multi/GRG0MGXFIN_20201770000_01D_30S_CLK.CLK.gz"],
    antennas: &["esbc2020177/esbc.atx.gz", "esbc2020177_multi/galileo_igs20.atx.gz"],
    truth: [3_582_104.765_7, 532_590.178_5, 5_232_755.139_0],
};

/// Wettzell, an hour of 25 June 2020, with CODE's orbits and their clocks every five minutes.
const WTZR: Station = Station {
    observations: "wettzell2020177_multi/WTZR00DEU_R_20201770000_01D_30S_MO_120epoch.rnx.gz",
    orbits: &["wettzell2020177_multi/COD0MGXFIN_20201770000_01D_05M_ORB.SP3.gz"],
    clocks: &[],
    antennas: &[
        "esbc2020177_multi/galileo_igs20.atx.gz",
        "wettzell2020177_multi/igs20_wettzell_trim.atx.gz",
    ],
    truth: [4_075_580.294_8, 931_854.062_0, 4_801_568.281_6],
};

/// Satellites of a type: their letter, numbers and frequencies, and the offset of their antenna from the centre of
/// mass, mm.
type Kind = (char, std::ops::RangeInclusive<u8>, &'static [&'static str], [f64; 3]);

/// GLONASS-M except the numbers 9 and 26, which are of another type, and BeiDou-2 except its geostationary satellites.
const KINDS: [Kind; 3] = [
    ('R', 1..=8, &["R01", "R02"], [-545.0, 0.0, 2_450.0]),
    ('R', 10..=24, &["R01", "R02"], [-545.0, 0.0, 2_450.0]),
    ('C', 6..=16, &["C02", "C06"], [600.0, 0.0, 1_100.0]),
];

/// An antenna file with these satellites.
fn antennas() -> String {
    let mut file = String::new();
    let mut line = |content: &str, label: &str| {
        writeln!(file, "{content:<60}{label}").expect("a line of a string");
    };
    line("     1.4            M", "ANTEX VERSION / SYST");
    line("", "END OF HEADER");
    for (letter, numbers, frequencies, [x, y, z]) in KINDS {
        for number in numbers {
            line("", "START OF ANTENNA");
            line(&format!("{:20}{letter}{number:02}", "OF THE TYPE"), "TYPE / SERIAL NO");
            line("     0.0", "DAZI");
            line("     0.0  14.0  14.0", "ZEN1 / ZEN2 / DZEN");
            for frequency in frequencies {
                line(&format!("   {frequency}"), "START OF FREQUENCY");
                line(&format!("{x:10.2}{y:10.2}{z:10.2}"), "NORTH / EAST / UP");
                line("   NOAZI    0.00    0.00", "");
                line(&format!("   {frequency}"), "END OF FREQUENCY");
            }
            line("", "END OF ANTENNA");
        }
    }
    file
}

impl Station {
    /// Reads the recording; `None`, with a notice, where it is absent.
    fn read(&self) -> Option<Recording> {
        let folder = folder_of("gnss")?;
        let paths = |names: &[&str]| -> Vec<PathBuf> {
            names.iter().map(|name| folder.join(name)).collect()
        };
        let of_types = tempfile::NamedTempFile::new().expect("a temporary file");
        std::fs::write(of_types.path(), antennas()).expect("a file can be written");
        let mut antex = paths(self.antennas);
        antex.push(of_types.path().to_path_buf());
        let recording = Recording::read(&Paths {
            obs: &folder.join(self.observations),
            sp3: &paths(self.orbits),
            nav: &[],
            antex: &antex,
            clk: &paths(self.clocks),
            bias: &[],
            blq: None,
            erp: None,
        });
        Some(recording.expect("all can be read"))
    }

    /// The root mean square error of a session after 20 minutes, mm, the minutes after which it stays below a
    /// decimetre, and the last error, mm.
    fn errors(
        &self,
        recording: &Recording,
        epochs: &[Epoch],
        motion: Motion,
        systems: Systems,
    ) -> [f64; 3] {
        let receiver = recording.receiver(Corrections::ALL);
        let pass = Pass { systems, ..Pass::default() };
        let Followed { fixes, .. } =
            follow(recording, epochs, &receiver, Config::new(motion), pass, &mut || ());
        let begin = fixes.first().expect("a solution").t;
        let truth = Vector3::from(self.truth);
        let errors: Vec<_> =
            fixes.iter().map(|fix| (fix.t - begin, (fix.position - truth).norm())).collect();
        let settled = errors.iter().filter(|(t, _)| *t >= SETTLED).map(|(_, error)| error * error);
        let mean = settled.clone().sum::<f64>() / settled.count() as f64;
        let last_beyond = errors.iter().rev().find(|(_, error)| *error > 0.1);
        let last = errors.last().map_or(0.0, |(_, error)| 1e3 * error);
        [1e3 * mean.sqrt(), last_beyond.map_or(0.0, |(t, _)| t / 60.0), last]
    }

    /// The medians of the root mean square error and the minutes over sessions of an hour.
    fn medians(&self, recording: &Recording, motion: Motion, systems: Systems) -> [f64; 2] {
        let mut all = Vec::new();
        for session in recording.epochs(None).chunk_by(|a, b| {
            let hour = |epoch| (recording.seconds(epoch) / HOUR).floor();
            hour(a) == hour(b)
        }) {
            all.push(self.errors(recording, session, motion, systems));
        }
        [0, 1].map(|which| {
            all.sort_by(|a, b| a[which].total_cmp(&b[which]));
            all[all.len() / 2][which]
        })
    }
}

/// Adding GLONASS or BeiDou to GPS and Galileo makes neither measure worse, and improves both in sessions of an hour.
#[test]
fn glonass_and_beidou_beside_gps_and_galileo() {
    for (name, station, expected, at_most) in [
        ("ESBC", ESBC, &[System::Gps, System::Galileo, System::Glonass][..], 0.9),
        ("WTZR", WTZR, &System::ALL[..], 0.9),
    ] {
        let Some(recording) = station.read() else { return };
        assert_eq!(recording.systems().collect::<Vec<_>>(), expected);
        for motion in [Motion::Static, KINEMATIC] {
            let [all, two] = [Systems::All, Systems::GpsGalileo]
                .map(|systems| station.medians(&recording, motion, systems));
            println!(
                "{name}, {motion:?}, an hour: RMS after 20 min {:.1} with all, {:.1} mm with GPS and Galileo; {:.1} | {:.1} min to 10 cm",
                all[0], two[0], all[1], two[1]
            );
            assert!(all[0] < at_most * two[0], "{} mm for {} mm", all[0], two[0]);
        }
    }
}

/// Orbits of CODE combined with clocks of CNES/CLS are reported, and those of one service are not.
#[test]
fn products_of_two_services() {
    for (name, orbits, clocks, is_told) in [
        ("GRG", ESBC.orbits, ESBC.clocks, false),
        ("CODE", WTZR.orbits, WTZR.clocks, false),
        ("both", WTZR.orbits, ESBC.clocks, true),
    ] {
        let station = Station { orbits, clocks, ..ESBC };
        let Some(recording) = station.read() else { return };
        let told: Vec<_> = recording.warnings(Corrections::ALL).collect();
        let found = told.iter().any(|warning| warning.contains("of two solutions"));
        assert_eq!(found, is_told, "{name}: {told:?}");
    }
}

/// A whole day gains less; its last error grows by no more than the error of antennas given by type.
#[test]
fn a_day_with_glonass() {
    let Some(recording) = ESBC.read() else { return };
    for motion in [Motion::Static, KINEMATIC] {
        let [all, two] = [Systems::All, Systems::GpsGalileo]
            .map(|systems| ESBC.errors(&recording, recording.epochs(None), motion, systems));
        println!(
            "ESBC, {motion:?}, a day: RMS after 20 min {:.1} with GLONASS, {:.1} mm without; {:.1} | {:.1} min to 10 cm; {:.1} | {:.1} mm at its end",
            all[0], two[0], all[1], two[1], all[2], two[2]
        );
        assert!(all[0] < two[0] && all[1] <= two[1] && all[2] < 1.4 * two[2], "{all:?} {two:?}");
    }
}
