//! An environment that the levels contradict is told, and one that they do not contradict is not.
//!
//! Recorded flights stand beside the repository in `../shared/data/drone`. Where they are absent that test says SKIPPED and passes;
//! with `KESTIRIM_REQUIRE_DATA=1` it fails instead.

use host_sim::system::{AnySystem, Files, HealthState, Settings, Source, Wanted};
use host_sim::systems::drone::Drone;
use kestirim_replay::drone::{EnvironmentKind, Estimate, Misfit, Stop};
use kestirim_tests::recordings::folder_of;
use rand_core::SeedableRng;
use rand_distr::{Bernoulli, Distribution, Normal};
use rand_xoshiro::Xoshiro256PlusPlus;
use target_bench::is_short;

const ENVIRONMENTS: [(&str, EnvironmentKind); 4] = [
    ("suburban", EnvironmentKind::Suburban),
    ("urban", EnvironmentKind::Urban),
    ("dense-urban", EnvironmentKind::DenseUrban),
    ("high-rise", EnvironmentKind::HighRise),
];

/// A flight over an environment, heard as the thesis has it; the user is at the origin.
fn flight(environment: EnvironmentKind, count: u32, random: &mut Xoshiro256PlusPlus) -> Vec<Stop> {
    let channel = environment.channel::<f64>();
    let stop = |at: u32| {
        let along = f64::from(at) / f64::from(count);
        let place = [2000.0 * along - 700.0, 300.0 * (9.0 * along).sin()];
        let height = 60.0 + 700.0 * along;
        let loss = channel.path_loss(place[0].hypot(place[1]), height).expect("a loss");
        let is_seen = Bernoulli::new(loss.line_of_sight_probability).expect("a probability");
        let (mean, sigma) = if is_seen.sample(random) {
            (loss.line_of_sight_mean, loss.line_of_sight_sigma)
        } else {
            (loss.obstructed_mean, loss.obstructed_sigma)
        };
        let loss = Normal::new(mean, sigma).expect("a deviation").sample(random);
        Stop { t: f64::from(at), place, height, loss, heading: None }
    };
    (0..count).map(stop).collect()
}

#[test]
fn none_of_a_thousand_flights_contradicts_its_own_environment() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(1);
    let estimate = Estimate {
        stop: 0,
        place: [0.0; 2],
        sd_m: 1.0,
        level_db: None,
        off_db: 0.0,
        covered: None,
        next: None,
        cloud: None,
    };
    for round in 0..250 {
        for (name, environment) in ENVIRONMENTS {
            let stops = flight(environment, 8 + round, &mut random);
            let misfit = Misfit::find(&stops, &estimate, &environment.channel());
            assert_eq!(misfit, None, "{name}, {} measurements", stops.len());
        }
    }
}

#[test]
fn collars_in_the_open_contradict_every_environment() {
    let Some(folder) = folder_of("drone") else { return };
    for flight in [419, 435] {
        for collar in 0..3 {
            // In the short form one environment a collar, all among them.
            let some = collar + usize::from(flight == 435);
            let environments =
                if is_short() { &ENVIRONMENTS[some..=some] } else { &ENVIRONMENTS[..] };
            for (name, _) in environments {
                let file = |part: &str| {
                    folder.join(format!("collars/collar_000{flight}_{collar}{part}.csv"))
                };
                let mut files = Files::default();
                for (field, part) in [("log", ""), ("truth", "-truth"), ("area", "-area")] {
                    files.add(field, file(part));
                }
                let mut settings = Settings::new(Drone.settings());
                settings.set("environment", name).expect("an environment");
                let opened = Drone.open(Source::Files(files), &settings).expect("a recording");
                let account = opened.replay(&settings, &Wanted::default()).expect("a place");
                let number = |of: &serde_json::Value| of.as_f64().expect("a number");
                let error = number(&account.report["accuracy"]["error_m"]);
                let sigma = number(&account.report["sd_m"]);
                println!(
                    "{flight}_{collar} {name}: {error:.0} m, {sigma:.1} m, {}",
                    account.health
                );
                let is_told = account.health.state() != HealthState::Good;
                assert!(is_told && !account.warnings.is_empty(), "{flight}_{collar} {name}");
            }
        }
    }
}
