//! Recorded GNSS observations with ground truth: the accuracy that the book promises, with one configuration for all.
//!
//! The recordings are in `../shared/data/gnss`, beside the repository. Where they are absent these tests print SKIPPED
//! and pass; with `KESTIRIM_REQUIRE_DATA=1` they fail instead. With `--nocapture` each is printed.

use std::path::Path;
use std::slice;

use host_sim::metrics::{error_over_sigma, rms};
use kestirim_gnss_ppp::{Correction, Corrections, Geodetic, pole_tide};
use kestirim_ppp_filter::{Config, Contradiction, Estimator, Health, Motion, SatelliteObservation};
use kestirim_replay::gnss::{Accuracy, Fix, Order, Pass, Paths, Recording, follow};
use kestirim_tests::gnss::{ACOR, ESBC, ESBC_INJECTED, ESBC_MULTI, Station, TLSE, lengthen};
use kestirim_tests::recordings::folder_of;
use nalgebra::Vector3;
use rand_core::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

const KINEMATIC: Motion = Motion::Kinematic { process_noise: 100.0 };

fn read(station: Station) -> Option<Recording> {
    Some(station.read(&folder_of("gnss")?))
}

fn plain(motion: Motion) -> Config {
    Config { estimator: Estimator::plain(), ..Config::new(motion) }
}

/// The last error and the RMS, mm, and the minutes of convergence (infinite without).
fn measures(what: &str, accuracy: &Accuracy) -> [f64; 3] {
    let end = 1e3 * accuracy.final_3d_m;
    let rms = 1e3 * accuracy.rms_3d_m.expect("more than an hour");
    let convergence = accuracy.convergence_min.unwrap_or(f64::INFINITY);
    println!("{what}: final {end:.1} mm, RMS {rms:.2} mm, convergence {convergence:.1} min");
    [end, rms, convergence]
}

#[test]
fn a_modern_station() {
    let Some(recording) = read(ESBC) else { return };
    let run = |what, config| measures(what, &ESBC.accuracy(&recording, config));
    let [_, opponent, _] = run("ESBC, static, plain", plain(Motion::Static));
    let [end, rms, convergence] = run("ESBC, static", Config::new(Motion::Static));
    assert!(end <= 4.5 && rms <= 8.5 && convergence <= 32.0);
    assert!(opponent <= 10.0, "the plain filter is a fair opponent");
    assert!(rms <= 1.08 * opponent, "the default does next to no harm");
    let [_, opponent, _] = run("ESBC, kinematic, plain", plain(KINEMATIC));
    let [_, rms, _] = run("ESBC, kinematic", Config::new(KINEMATIC));
    assert!(rms <= 36.0 && rms <= opponent);
}

/// Estimating tropospheric gradients improves the positions, and they are not estimated where clocks mask them.
#[test]
fn gradients_of_the_troposphere() {
    let Some(recording) = read(ESBC_MULTI) else { return };
    for (motion, most) in [(Motion::Static, 0.95), (KINEMATIC, 0.85)] {
        let config = Config::new(motion);
        let [without, with] = [Config { gradient: 0.0, ..config }, config].map(|config| {
            let what = format!("{motion:?}, gradients of {} m", config.gradient);
            measures(&what, &ESBC_MULTI.accuracy(&recording, config))[1]
        });
        assert!(with <= most * without, "{motion:?}: {with} mm for {without} mm");
    }
    let Some(recording) = read(ACOR) else { return };
    let config = Config::new(Motion::Static);
    let without = ACOR.accuracy(&recording, Config { gradient: 0.0, ..config });
    assert_eq!(ACOR.accuracy(&recording, config), without, "clocks every quarter of an hour");
}

#[test]
fn galileo_beside_gps() {
    let Some(recording) = read(ESBC_MULTI) else { return };
    let run = |what, config| measures(what, &ESBC_MULTI.accuracy(&recording, config));
    let [end, rms, convergence] = run("ESBC with Galileo, static", Config::new(Motion::Static));
    assert!(end <= 5.5 && rms <= 8.5 && convergence <= 16.0);
    let [_, rms, _] = run("ESBC with Galileo, kinematic", Config::new(KINEMATIC));
    assert!(rms <= 24.5);
}

/// Smoothing forwards and backwards, from the first epoch on.
#[test]
fn smoothed_from_the_first_epoch_on() {
    for (what, station, still, moving) in
        [("ESBC", ESBC, 4.5, 26.0), ("ESBC with Galileo", ESBC_MULTI, 5.5, 21.0)]
    {
        let Some(recording) = read(station) else { return };
        let receiver = recording.receiver(Corrections::ALL);
        let truth = Vector3::from(station.truth);
        for (motion, most) in [(Motion::Static, still), (KINEMATIC, moving)] {
            let run = |order| {
                let epochs = recording.epochs(Some(station.until));
                let config = Config::new(motion);
                let pass = Pass { order, ..Pass::default() };
                follow(&recording, epochs, &receiver, config, pass, &mut || ())
            };
            let [forwards, backwards] = [Order::Forwards, Order::Backwards].map(run);
            let both = forwards.smoothed(&backwards);
            assert_eq!(both.fixes.len(), forwards.fixes.len());
            let pairs = both.fixes.iter().zip(&both.deviations);
            let told: Vec<_> = pairs
                .map(|(fix, sd)| ((fix.position - truth).norm(), Vector3::from(*sd).norm()))
                .collect();
            let found = 1e3 * rms(&told.iter().map(|(error, _)| *error).collect::<Vec<_>>());
            let ratio = error_over_sigma(told).expect("deviations");
            println!("{what}, {motion:?}, smoothed: {found:.1} mm, over its deviation {ratio:.2}");
            assert!(found <= most && (0.3..1.5).contains(&ratio), "{what}: {found} mm, {ratio}");
        }
    }
}

/// All phases jump by a millisecond at noon, as with a receiver that applies its clock jumps to the phases alone.
#[test]
fn a_clock_that_jumps_costs_no_filter_its_day() {
    let Some(recording) = read(ESBC) else { return };
    for config in [plain(Motion::Static), Config::new(Motion::Static), plain(KINEMATIC)] {
        let jump = |t: f64, observation: &mut SatelliteObservation<'_>| {
            lengthen(observation, 0.0, if t < 43_200.0 { 0.0 } else { 299_792.458 });
        };
        let still = |_| Vector3::zeros();
        let fixes = ESBC.follow(&recording, config, Corrections::ALL, still, jump);
        let [_, jumped, _] = measures("a jump", &ESBC.compare(&fixes));
        let [_, clean, _] = measures("none", &ESBC.accuracy(&recording, config));
        assert!((jumped - clean).abs() < 0.01, "{jumped} mm for {clean} mm");
    }
}

#[test]
fn stations_with_clocks_every_quarter_of_an_hour() {
    let mut all = Vec::new();
    for station in [ACOR, TLSE] {
        let Some(recording) = read(station) else { return };
        let run = |config| measures(station.observations, &station.accuracy(&recording, config));
        let [_, opponent, _] = run(plain(Motion::Static));
        let ours = run(Config::new(Motion::Static));
        assert!(ours[1] <= opponent, "the default does no harm");
        all.push(ours);
        let [_, opponent, _] = run(plain(KINEMATIC));
        let [_, moving, _] = run(Config::new(KINEMATIC));
        assert!(moving <= opponent, "nor where the receiver may move");
    }
    let mean = [0, 1, 2].map(|which| all.iter().map(|ours| ours[which]).sum::<f64>() / 2.0);
    // RTKLIB demo5 on the same files: 8.5, 19.5, 47.8.
    assert!(mean[0] <= 8.5 && mean[1] <= 19.5 && mean[2] <= 47.8, "{mean:?}");
}

#[test]
fn faults_in_the_file() {
    let Some(recording) = read(ESBC_INJECTED) else { return };
    let run = |what, config| measures(what, &ESBC.accuracy(&recording, config));
    let [_, opponent, _] = run("injected, static, plain", plain(Motion::Static));
    let [end, rms, convergence] = run("injected, static", Config::new(Motion::Static));
    assert!(end <= 8.0 && rms <= 12.0 && convergence <= 34.0);
    assert!(opponent >= 10.0 * rms, "the plain filter suffers");
    let [_, rms, _] = run("injected, kinematic", Config::new(KINEMATIC));
    assert!(rms <= 55.0);
}

/// Faults as in the injected file, but with other random numbers and at other stations.
#[test]
fn faults_of_other_days() {
    for (station, most) in [(ESBC, 16.0), (ACOR, 40.0), (TLSE, 45.0)] {
        let Some(recording) = read(station) else { return };
        for seed in 1..=3 {
            let mut dice = Xoshiro256PlusPlus::seed_from_u64(seed);
            let mut slips = [0.0; 33];
            let spoil = |t: f64, observation: &mut SatelliteObservation<'_>| {
                spoil(t, observation, &mut dice, &mut slips);
            };
            let config = Config::new(Motion::Static);
            let still = |_| Vector3::zeros();
            let fixes = station.follow(&recording, config, Corrections::ALL, still, spoil);
            let what = format!("{}, seed {seed}", station.observations);
            let [_, rms, _] = measures(&what, &station.compare(&fixes));
            assert!(rms <= most, "{what}: {rms} mm");
        }
    }
}

/// A tripod that is knocked at noon: a receiver configured as static is found at its new position.
#[test]
fn a_receiver_that_is_knocked() {
    const NOON: f64 = 43_200.0;
    for station in [ESBC, ACOR, TLSE] {
        let Some(recording) = read(station) else { return };
        for knock in [[0.2, 0.0, 0.0], [0.0, -0.3, 0.1]].map(Vector3::from) {
            let away = |t: f64| if t < NOON { Vector3::zeros() } else { knock };
            let config = Config::new(Motion::Static);
            let fixes = station.follow(&recording, config, Corrections::ALL, away, |_, _| {});
            let off =
                |fix: &Fix| (fix.position - Vector3::from(station.truth) - away(fix.t)).norm();
            let after = fixes.iter().filter(|fix| fix.t >= NOON).map(off).fold(0.0, f64::max);
            let last = fixes.last().map(off).expect("a position");
            println!(
                "{}: {:.0} mm at the most after it, {:.0} mm at the end",
                station.observations,
                1e3 * after,
                1e3 * last
            );
            assert!(after < 0.12 && last < 0.02, "{after} m, {last} m");
        }
    }
}

/// A receiver on a slope that creeps, 43 cm a day: too slow to be seen between two epochs, but not from the places where a
/// receiver at rest was found before.
#[test]
fn a_receiver_that_creeps() {
    const CREEP: f64 = 5e-6;
    for station in [ESBC, ACOR, TLSE] {
        let Some(recording) = read(station) else { return };
        let local = Geodetic::from_ecef(&Vector3::from(station.truth)).enu_from_ecef().transpose();
        for direction in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.6, 0.0, -0.8]] {
            let velocity = local * Vector3::from(direction) * CREEP;
            let marker = Vector3::from(station.truth);
            let (mut told, mut last, mut worst) = (None, None, 0.0_f64);
            station.solve(
                &recording,
                Config::new(Motion::Static),
                Corrections::ALL,
                |t| velocity * t,
                |_, _| {},
                |t, solution| {
                    let is_told = solution.health == Health::Contradicted(Contradiction::Motion);
                    told = told.or(is_told.then_some(t));
                    if solution.health == Health::Converged {
                        worst = worst.max((solution.position - marker - velocity * t).norm());
                    }
                    last = Some(solution.health);
                },
            );
            let hours = told.map_or(f64::NAN, |t| t / 3600.0);
            println!(
                "{}: {direction:?} is reported after {hours:.1} h; {worst:.2} m off at the most while converged",
                station.observations
            );
            assert_eq!(last, Some(Health::Contradicted(Contradiction::Motion)));
        }
    }
}

/// 2 % code outliers of 3 to 30 m, 1 % phase outliers of 0.05 to 1 m, some 24 slips of a size that no detector sees,
/// and 10 m on the codes of three satellites for a quarter of an hour, twice.
fn spoil(
    t: f64,
    observation: &mut SatelliteObservation<'_>,
    dice: &mut Xoshiro256PlusPlus,
    slips: &mut [f64; 33],
) {
    let mut uniform = || dice.next_u64() as f64 / u64::MAX as f64;
    let mut either = |least: f64, range: f64| {
        let size = least + range * uniform();
        if uniform() < 0.5 { size } else { -size }
    };
    let (code, phase, slip) = (either(3.0, 27.0), either(0.05, 0.95), either(0.05, 0.95));
    let prn = usize::from(observation.satellite);
    if uniform() < 24.0 / 32_700.0 {
        slips[prn] += slip;
    }
    let bias = if prn % 8 < 3 && (t + 7_000.0) % 43_200.0 < 900.0 { 10.0 } else { 0.0 };
    let code = bias + if uniform() < 0.02 { code } else { 0.0 };
    let phase = slips[prn] + if uniform() < 0.01 { phase } else { 0.0 };
    lengthen(observation, code, phase);
}

/// A sine of half a metre and a step of a metre are followed where the process noise is far below both: motion is not
/// taken for outliers. The positions are compared with those of the receiver at rest, which has errors of its own.
#[test]
fn motion_is_followed() {
    let Some(recording) = read(ESBC) else { return };
    let local = Geodetic::from_ecef(&Vector3::from(ESBC.truth)).enu_from_ecef().transpose();
    let sine =
        |t: f64| local * Vector3::new(0.5 * (t / 300.0 * std::f64::consts::TAU).sin(), 0.0, 0.0);
    let step = |t: f64| local * Vector3::new(0.6, 0.6, 0.53) * f64::from(u8::from(t > 43_200.0));
    for process_noise in [1e-4, 1e-2, 100.0] {
        let config = Config::new(Motion::Kinematic { process_noise });
        let follow = |away: &dyn Fn(f64) -> Vector3<f64>| {
            ESBC.follow(&recording, config, Corrections::ALL, away, |_, _| {})
        };
        let still = follow(&|_| Vector3::zeros());
        for (what, away) in [("sine", &sine as &dyn Fn(f64) -> Vector3<f64>), ("step", &step)] {
            let moved = follow(away);
            assert!(still.iter().map(|fix| fix.t).eq(moved.iter().map(|fix| fix.t)));
            let late = still.iter().zip(&moved).filter(|(still, _)| still.t >= 3600.0);
            let missed: Vec<f64> = late
                .map(|(still, moved)| (moved.position - still.position - away(still.t)).norm())
                .collect();
            let missed = 1e3 * rms(&missed);
            println!("{what}, {process_noise} m²/s: followed within {missed:.1} mm");
            assert!(missed <= 30.0, "{what} at {process_noise} m²/s: {missed} mm");
        }
    }
}

/// The effect of each correction on the position of a static day, RMS, mm. The receiver's clock and the wet delay
/// absorb most of the signal's delay in the Earth's gravity.
#[test]
fn every_correction_matters() {
    for (station, correction, least) in [
        (ESBC, Correction::SolidTide, 25.0),
        (ESBC, Correction::Relativity, 1_000.0),
        (ESBC, Correction::Sagnac, 1_000.0),
        (ESBC, Correction::Troposphere, 10.0),
        (ESBC, Correction::WindUp, 5.0),
        (ESBC, Correction::SatelliteAntenna, 30.0),
        (ESBC, Correction::ReceiverAntenna, 15.0),
        (ESBC, Correction::Shapiro, 0.1),
        (ACOR, Correction::OceanLoading, 3.0),
    ] {
        let Some(recording) = read(station) else { return };
        let config = Config::new(Motion::Static);
        let still = |_| Vector3::zeros();
        let run = |corrections| station.follow(&recording, config, corrections, still, |_, _| {});
        let (with, without) = (run(Corrections::ALL), run(Corrections::ALL.without(correction)));
        let late = with.iter().zip(&without).filter(|(with, _)| with.t >= 3600.0);
        let moved: Vec<f64> =
            late.map(|(with, without)| (with.position - without.position).norm()).collect();
        let moved = 1e3 * rms(&moved);
        let [_, rms, _] = measures(&format!("without {correction:?}"), &station.compare(&without));
        println!("  moves the position by {moved:.1} mm");
        assert!(moved >= least, "{correction:?}: {moved} mm");
        if correction == Correction::SolidTide {
            let [_, usual, _] = measures("with", &station.compare(&with));
            assert!(rms - usual > 25.0, "the tides cost more than 25 mm");
        }
    }
}

/// A file of the Earth's rotation moves a position by the pole tide, and not at all if that correction is off.
#[test]
fn the_tide_of_the_pole() {
    let Some(folder) = folder_of("gnss") else { return };
    let file = |name: &str| folder.join("ecj02_2026121").join(name);
    let (obs, sp3) =
        (file("ECJ02_26050100_01H.obs.gz"), file("COD0MGXFIN_20261210000_01D_05M_ORB.SP3.gz"));
    let (clk, antex) =
        (file("COD0MGXFIN_20261210000_01D_30S_CLK.CLK.gz"), file("igs20_iflc_trim.atx.gz"));
    let rotation = file("COD0MGXFIN_20261210000_01D_12H_ERP.ERP.gz");
    let place = |erp: Option<&Path>, corrections| {
        let ([sp3, clk, antex], nav, bias) = ([&sp3, &clk, &antex].map(slice::from_ref), &[], &[]);
        let paths = Paths { obs: &obs, sp3, nav, antex, clk, bias, blq: None, erp };
        let recording = Recording::read(&paths).expect("files that can be read");
        let (receiver, epochs) = (recording.receiver(corrections), recording.epochs(None));
        let config = Config::new(Motion::Static);
        let followed = follow(&recording, epochs, &receiver, config, Pass::default(), &mut || ());
        (followed.fixes.last().expect("a position").position, epochs[0].time)
    };
    let (without, start) = place(None, Corrections::ALL);
    let (with, _) = place(Some(&rotation), Corrections::ALL);
    let left_out = Corrections::ALL.without(Correction::PoleTide);
    assert_eq!(place(Some(&rotation), left_out).0, without);
    // The values of the file at midnight, 10⁻⁶″.
    let pole = [155_985.0, 417_263.0].map(|it: f64| (1e-6 * it / 3600.0).to_radians());
    let tide = pole_tide(&without, pole, start);
    println!("the tide of the pole: {:.2} mm", 1e3 * tide.norm());
    assert!(tide.norm() > 1e-3 && (with - without + tide).norm() < 1e-4, "{tide}");
}
