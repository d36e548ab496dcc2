//! Positions with broadcast ephemerides, compared with those from precise orbits and clocks.
//!
//! The ephemerides are fitted to the precise products of ESBC's day: they show that the processing chain is right, but
//! not how accurate real broadcasts are.
//!
//! The recordings are in `../shared/data/gnss`, beside the repository. Where they are absent these tests print SKIPPED
//! and pass; with `KESTIRIM_REQUIRE_DATA=1` they fail instead. With `--nocapture` each is printed.

mod fit;
pub(super) mod ssr;

use std::path::{Path, PathBuf};

use host_sim::metrics::{error_over_sigma, rms};
use kestirim_gnss_files::{Antennas, Clocks, Orbits};
use kestirim_gnss_ppp::{Corrections, Site};
use kestirim_ppp_filter::{Config, Health, Motion};
use kestirim_replay::gnss::{Epoch, Followed, Method, Pass, Paths, Recording, follow};
use kestirim_tests::gnss::{ESBC, ESBC_MULTI, Station};
use kestirim_tests::recordings::folder_of;
use nalgebra::Vector3;

const KINEMATIC: Motion = Motion::Kinematic { process_noise: 100.0 };
/// The time up to which ephemerides are fitted, s.
const UNTIL: f64 = 82_800.0;

pub(super) type Products = (Orbits, Clocks, Antennas);

/// The precise products of ESBC's day, GPS and Galileo.
pub(super) fn products(folder: &Path) -> Products {
    let path = |name: &str| -> PathBuf { folder.join("esbc2020177_multi").join(name) };
    let orbits = Orbits::read(&[
        path("GRG0MGXFIN_20201760000_01D_15M_ORB.SP3.gz"),
        path("GRG0MGXFIN_20201770000_01D_15M_ORB.SP3.gz"),
    ]);
    let clocks = Clocks::read(&[path("GRG0MGXFIN_20201770000_01D_30S_CLK.CLK.gz")]);
    let antennas =
        Antennas::read(&[folder.join("esbc2020177/esbc.atx.gz"), path("galileo_igs20.atx.gz")], "");
    (orbits.expect("orbits"), clocks.expect("clocks"), antennas.expect("antennas"))
}

/// The navigation file of ESBC's day, GPS and Galileo, fitted to precise products.
pub(super) fn fitted_to_products(folder: &Path) -> String {
    let (orbits, clocks, antennas) = products(folder);
    fit::navigation(&fit::ephemerides(59_025, &orbits, &clocks, &antennas))
}

/// The observations of a station with files of ephemerides instead of products.
fn with_navigation(folder: &Path, station: Station, files: &[&[u8]]) -> Recording {
    let written = |bytes: &&[u8]| {
        let file = tempfile::NamedTempFile::new().expect("a temporary file");
        std::fs::write(file.path(), bytes).expect("a file can be written");
        file
    };
    let files: Vec<_> = files.iter().map(written).collect();
    let nav: Vec<_> = files.iter().map(|file| file.path().to_path_buf()).collect();
    let antennas: Vec<_> = ["esbc2020177/esbc.atx.gz"].map(|name| folder.join(name)).into();
    Recording::read(&Paths {
        obs: &folder.join(station.observations),
        sp3: &[],
        nav: &nav,
        antex: &antennas,
        clk: &[],
        bias: &[],
        blq: None,
        erp: None,
    })
    .expect("all can be read")
}

/// The differences of the ranges of an epoch's satellites from those of precise products, m, without the part that all
/// have in common.
fn off(broadcast: &Recording, precise: &Recording, epoch: &Epoch) -> Vec<f64> {
    let truth = Vector3::from(ESBC.truth);
    let receiver = precise.receiver(Corrections::ALL);
    let site = Site::new(&receiver, &truth, epoch.time);
    let range = |recording: &Recording, observed| {
        let it = recording.products().observation(epoch.time, observed).ok()?;
        Some(site.expect(&it.state, it.carriers, it.antenna.as_ref(), None)?.range)
    };
    let both = epoch.satellites.iter().filter_map(|observed| {
        Some((observed.prn > 100, range(broadcast, observed)? - range(precise, observed)?))
    });
    let both: Vec<(bool, f64)> = both.collect();
    let of = |system: bool| both.iter().filter(move |(it, _)| *it == system).map(|(_, off)| *off);
    let mean = |system| of(system).sum::<f64>() / of(system).count().max(1) as f64;
    let means = [mean(false), mean(true)];
    both.iter().map(|(system, off)| off - means[usize::from(*system)]).collect()
}

/// Follows a recording and prints errors, m, and errors over standard deviations.
fn followed(
    what: &str,
    recording: &Recording,
    motion: Motion,
    method: Method,
    until: f64,
) -> (Followed, [f64; 3]) {
    let epochs = recording.epochs(Some(until));
    let receiver = recording.receiver(Corrections::ALL);
    let pass = Pass { method, ..Pass::default() };
    let found = follow(recording, epochs, &receiver, Config::new(motion), pass, &mut || ());
    let truth = Vector3::from(ESBC.truth);
    let told = found.fixes.iter().zip(&found.deviations);
    let told: Vec<_> =
        told.map(|(fix, sd)| ((fix.position - truth).norm(), Vector3::from(*sd).norm())).collect();
    let errors: Vec<_> = told.iter().map(|(error, _)| *error).collect();
    let last = *errors.last().expect("a solution");
    let measures = [last, rms(&errors), error_over_sigma(told).expect("deviations")];
    println!(
        "{what}: {} of {} epochs, last {:.3} m, RMS {:.3} m, error over deviation {:.2}",
        found.fixes.len(),
        epochs.len(),
        measures[0],
        measures[1],
        measures[2]
    );
    (found, measures)
}

fn is_never_converged(followed: &Followed) {
    assert!(
        followed
            .healths
            .iter()
            .all(|health| matches!(health, Health::Converging | Health::Unchecked))
    );
}

#[test]
fn a_day_of_fitted_ephemerides() {
    let Some(folder) = folder_of("gnss") else { return };
    let navigation = fitted_to_products(&folder);
    let fitted = with_navigation(&folder, ESBC_MULTI, &[navigation.as_bytes()]);
    let precise = ESBC_MULTI.read(&folder);
    let all: Vec<f64> = (precise.epochs(Some(UNTIL)).iter().step_by(10))
        .flat_map(|epoch| off(&fitted, &precise, epoch))
        .collect();
    println!(
        "fitted ephemerides against precise products: {:.4} m, {} ranges",
        rms(&all),
        all.len()
    );
    assert!(all.len() > 4_000 && rms(&all) < 0.1);
    let run = |what, motion, method| followed(what, &fitted, motion, method, UNTIL);
    for (what, motion, method, most) in [
        ("single", Motion::Static, Method::Single, 2.0),
        ("static", Motion::Static, Method::Filter, 0.5),
        ("kinematic", KINEMATIC, Method::Filter, 1.0),
    ] {
        let (found, [_, rms, ratio]) = run(what, motion, method);
        assert!(found.fixes.len() > 2_750 && rms < most && ratio < 1.0);
        is_never_converged(&found);
    }
}
