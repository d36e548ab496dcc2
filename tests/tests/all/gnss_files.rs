//! Recorded files of observations, orbits, clocks, antennas and ocean loading are read completely.
//!
//! They are in `../shared/data/gnss`, beside the repository. Where they are absent these tests print SKIPPED and pass;
//! with `KESTIRIM_REQUIRE_DATA=1` they fail instead.

use std::path::Path;

use kestirim_gnss_files::{Antennas, Carriers, Clocks, Observations, Orbits, StationLoading};
use kestirim_tests::recordings::folder_of;

/// Counts and sums that another reader found: epochs, observations, the sum of all C1W (m) and of all L2W (cycles), and
/// losses of lock on L1.
type Whole = (usize, usize, f64, f64, usize);

fn whole(file: &Path) -> Whole {
    let observations = Observations::read(file).expect("a recording can be read");
    assert_eq!(observations.warnings, []);
    let observed = observations.epochs.iter().flat_map(|epoch| &epoch.satellites);
    let mut whole = (observations.epochs.len(), 0, 0.0, 0.0, 0);
    for satellite in observed {
        whole.1 += 1;
        whole.2 += satellite.code[0].expect("C1W of every satellite");
        whole.3 += satellite.phase[1].expect("L2W of every satellite");
        whole.4 += usize::from(satellite.loss_of_lock[0]);
    }
    // Sums of millimetres, free of rounding.
    (whole.0, whole.1, (whole.2 * 1e3).round() / 1e3, (whole.3 * 1e3).round() / 1e3, whole.4)
}

fn near(found: Whole, expected: Whole) {
    assert_eq!((found.0, found.1, found.4), (expected.0, expected.1, expected.4));
    assert!((found.2 - expected.2).abs() < 0.01, "{found:?}");
    assert!((found.3 - expected.3).abs() < 0.01, "{found:?}");
}

#[test]
fn observations_are_read_whole() {
    let Some(folder) = folder_of("gnss") else { return };
    let esbc = folder.join("esbc2020177/esbc_gps.rnx.gz");
    near(whole(&esbc), (2880, 32_773, 760_539_901_896.763, 3_114_284_717_567.026, 0));
    let acor = folder.join("igs2008148/acor_gps.rnx.gz");
    near(whole(&acor), (2880, 29_344, 667_836_433_704.932, 2_734_679_218_474.377, 16));
    let tlse = folder.join("igs2008148/tlse_gps.rnx.gz");
    near(whole(&tlse), (2880, 24_128, 543_986_161_744.957, -191_777_350_100.174, 14));
    let observations = Observations::read(&esbc).expect("a recording can be read");
    assert_eq!(observations.marker, "ESBC00DNK");
    assert_eq!(observations.antenna, "ASH701945E_M    SCIS");
    assert_eq!(observations.antenna_delta_hen, [0.216, 0.0, 0.0]);
    assert_eq!(
        observations.approximate_position,
        Some([3_582_105.291, 532_589.731_3, 5_232_754.805_4])
    );
}

#[test]
fn satellites_that_are_not_read_are_told_of() {
    let Some(folder) = folder_of("gnss") else { return };
    let unserved = |name: &str| {
        let read = Observations::read(folder.join(name)).expect("a recording can be read");
        read.unserved.map(|warning| warning.to_string())
    };
    let wettzell = "wettzell2020177_multi/WTZR00DEU_R_20201770000_01D_30S_MO_120epoch.rnx.gz";
    let told = unserved(wettzell).expect("two other systems");
    let counts = "of NavIC (4), SBAS (3) are in the file, but are not read";
    assert!(told.ends_with(counts), "{told}");
    assert_eq!(unserved("esbc2020177/esbc_gps.rnx.gz"), None);
}

#[test]
fn orbits_of_days_are_put_together() {
    let Some(folder) = folder_of("gnss") else { return };
    let files = ["igs14813", "igs14811", "igs14812"];
    let files = files.map(|name| folder.join(format!("igs2008148/{name}.sp3.gz")));
    let orbits = Orbits::read(&files).expect("recordings can be read");
    assert_eq!(orbits.warnings, []);
    let samples: Vec<_> = orbits.satellites().flat_map(|prn| orbits.satellite(prn)).collect();
    assert_eq!(samples.len(), 3 * 2976);
    assert_eq!(samples.iter().filter(|sample| sample.clock.is_some()).count(), 2872 + 2969 + 2959);
    let sum: f64 = samples.iter().flat_map(|sample| sample.position).sum();
    assert!((sum - (68_717_013.0 + 69_087_764.574 + 69_419_335.253)).abs() < 0.01, "{sum}");
    let times = orbits.satellite(2).windows(2).map(|pair| pair[1].time.since(pair[0].time));
    assert!(times.into_iter().all(|step| step == 900.0));
}

#[test]
fn clocks_are_read_whole() {
    let Some(folder) = folder_of("gnss") else { return };
    let clocks = Clocks::read(&[folder.join("esbc2020177/grg177_gps.clk.gz")]);
    let clocks = clocks.expect("a recording can be read");
    assert_eq!(clocks.warnings, []);
    let samples: Vec<_> = clocks.satellites().flat_map(|prn| clocks.satellite(prn)).collect();
    assert_eq!(samples.len(), 86_399);
    let sum: f64 = samples.iter().map(|sample| sample.bias).sum();
    assert!((sum + 5.356_125_974_972).abs() < 1e-9, "{sum}");
}

#[test]
fn antennas_and_ocean_loading_are_found() {
    let Some(folder) = folder_of("gnss") else { return };
    let station = Observations::read(folder.join("igs2008148/tlse_gps.rnx.gz"));
    let station = station.expect("a recording can be read");
    let antennas = Antennas::read(&[folder.join("igs2008148/igs05_trim.atx.gz")], &station.antenna);
    let antennas = antennas.expect("a recording can be read");
    assert_eq!(antennas.warnings, []);
    let receiver = antennas.receiver.as_ref().expect("its antenna");
    let [l1, l2] = receiver.on(Carriers::L1L2).expect("two frequencies of the receiver");
    assert_eq!(l1.mean.len(), l2.mean.len());
    let time = station.epochs[0].time;
    for prn in station.signals.keys() {
        let antenna = antennas.satellite(*prn, time).expect("a satellite's antenna");
        assert!(antenna.on(Carriers::L1L2).is_some(), "G{prn:02}");
    }
    let place = station.approximate_position;
    let loading =
        StationLoading::read(folder.join("igs2008148/subset.blq"), &station.marker, place);
    let loading = loading.expect("a recording can be read");
    assert_eq!(loading.warnings, []);
    assert_eq!(loading.loading.map(|loading| loading.amplitude[0][0]), Some(0.011_48));
}
