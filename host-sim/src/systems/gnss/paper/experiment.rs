//! `host-sim run gnss`: the paper's filters and ours on synthetic station-days.
//!
//! Every filter gets the same days, with faults; two of them get the same days without faults, too.

mod report;
mod score;

use indicatif::ProgressBar;
use kestirim_gnss_ppp::{Corrections, Receiver};
use kestirim_ppp_filter::{Config, Estimator, Motion, PppFilter, SatelliteObservation, states};
use kestirim_replay::gnss::{FilterKind, Fix};
use rayon::prelude::*;

pub(super) use self::report::four;
pub use self::report::{Report, Row};
pub use self::score::Score;
use super::published::{self, PppErrors};
use crate::system::{RunOptions, ScalarKind, System, choose_scalar};
use crate::systems::gnss::Gnss;
use crate::systems::gnss::settings::SCALARS;
use crate::systems::gnss::simulate::{Day, MIDNIGHT, Rates, UTC_MINUS_GPS};
use crate::{Error, output};

/// Station-days unless told otherwise; the paper has 100.
const TRIALS: u32 = 10;
/// Variance that a kinematic filter gives each coordinate, m²/s: it knows nothing of the station's standing still.
pub const PROCESS_NOISE: f64 = 1e-4;
/// Satellites that a filter has room for.
const STATES: usize = states(16);

/// The rows with the paper's static filters, …
pub(super) const STATIC: &str = "Table 2: static";
/// … those with its kinematic filters, …
pub(super) const KINEMATIC: &str = "Table 3: kinematic";
/// … and those of the days on which nothing goes wrong.
pub(super) const CLEAN: &str = "the same days without faults";

/// One filter on one kind of days.
#[derive(Debug, Clone, Copy)]
struct Case {
    table: &'static str,
    filter: &'static str,
    motion: Motion,
    estimator: Estimator,
    faults: bool,
    published: Option<PppErrors>,
}

/// All rows of the tables. As published the t-test is what it is anyway; UKF is IKF, as its factor never falls: one
/// of the tables shows it.
fn cases() -> Vec<Case> {
    let as_published =
        |estimator: Estimator| Estimator { robust: estimator.robust.published(), ..estimator };
    let standing = Motion::Static;
    let moving = Motion::Kinematic { process_noise: PROCESS_NOISE };
    let case = |table, filter, motion, estimator, published| Case {
        table,
        filter,
        motion,
        estimator,
        published,
        faults: true,
    };
    let [gkf, rkf, skf, ikf, ukf] = published::STATIC.map(Some);
    let [moving_ikf, moving_ukf] = published::KINEMATIC.map(Some);
    let clean = |filter, motion, estimator| Case {
        faults: false,
        ..case(CLEAN, filter, motion, estimator, None)
    };
    let [plain, igg3, t_test] = [Estimator::plain(), Estimator::igg3(), Estimator::t_test()];
    let [iterative, adaptive] = [Estimator::iterative_igg3(), Estimator::adaptive()];
    vec![
        case(STATIC, FilterKind::Gkf.title(), standing, plain, gkf),
        case(STATIC, FilterKind::Rkf.title(), standing, igg3, rkf),
        case(STATIC, FilterKind::Skf.title(), standing, t_test, skf),
        case(STATIC, FilterKind::Ikf.title(), standing, iterative, ikf),
        case(STATIC, FilterKind::Adaptive.title(), standing, adaptive, ukf),
        case(STATIC, FilterKind::Default.title(), standing, Estimator::guarded(standing), None),
        case(STATIC, "RKF as published", standing, as_published(igg3), None),
        case(STATIC, "IKF as published", standing, as_published(iterative), None),
        case(KINEMATIC, FilterKind::Gkf.title(), moving, plain, None),
        case(KINEMATIC, FilterKind::Rkf.title(), moving, igg3, None),
        case(KINEMATIC, FilterKind::Skf.title(), moving, t_test, None),
        case(KINEMATIC, FilterKind::Ikf.title(), moving, iterative, moving_ikf),
        case(KINEMATIC, FilterKind::Adaptive.title(), moving, adaptive, moving_ukf),
        case(KINEMATIC, FilterKind::Default.title(), moving, Estimator::guarded(moving), None),
        case(KINEMATIC, "IKF as published", moving, as_published(iterative), None),
        case(KINEMATIC, "UKF as published", moving, as_published(adaptive), None),
        clean("plain, static", standing, plain),
        clean("default, static", standing, Estimator::guarded(standing)),
        clean("plain, kinematic", moving, plain),
        clean("default, kinematic", moving, Estimator::guarded(moving)),
    ]
}

/// Runs all.
///
/// # Errors
/// If the scalar is not supported.
pub fn run(options: RunOptions) -> Result<Report, Error> {
    let scalar = choose_scalar(Gnss::NAME, options.scalar, &SCALARS, ScalarKind::F64)?;
    let trials = options.trials.unwrap_or(TRIALS);
    let cases = cases();
    let bar = output::progress(u64::from(trials) * cases.len() as u64, "filter days");
    let days: Vec<_> = (0..u64::from(trials))
        .into_par_iter()
        .map(|index| trial(options.seed, index, &cases, &bar))
        .collect();
    bar.finish_and_clear();
    let rows = cases.iter().enumerate().map(|(place, case)| {
        let scores: Vec<_> = days.iter().map(|scores| scores[place]).collect();
        Row::of(case.table, case.filter, case.published, scores)
    });
    Ok(Report {
        system: Gnss::NAME,
        seed: options.seed,
        scalar,
        trials,
        process_noise: PROCESS_NOISE,
        rows: rows.collect(),
    })
}

/// All cases on one station-day.
fn trial(seed: u64, index: u64, cases: &[Case], bar: &ProgressBar) -> Vec<Score> {
    let days = [Rates::NONE, Rates::RECORDING].map(|rates| Day::new(seed, index, &rates));
    let observations = days.each_ref().map(observations);
    // Filters of a day beside each other, so that few days keep all threads busy, too.
    cases
        .par_iter()
        .map(|case| {
            let which = usize::from(case.faults);
            let config = Config { estimator: case.estimator, ..Config::new(case.motion) };
            let score = follow(&days[which], &observations[which], config);
            bar.inc(1);
            score
        })
        .collect()
}

/// What the receiver observed, with the products of each satellite.
fn observations(day: &Day) -> Vec<Vec<SatelliteObservation<'_>>> {
    let epochs = day.epochs.iter().map(|epoch| {
        let seen = epoch.satellites.iter();
        seen.filter_map(|observed| day.products.observation(epoch.time, observed).ok()).collect()
    });
    epochs.collect()
}

/// One filter through one day.
fn follow(day: &Day, observations: &[Vec<SatelliteObservation<'_>>], config: Config) -> Score {
    let receiver = Receiver {
        antenna: None,
        galileo_antenna: None,
        eccentricity: [0.0; 3],
        ocean_loading: None,
        ut1_minus_gps: UTC_MINUS_GPS,
        corrections: Corrections::ALL,
    };
    let mut filter = PppFilter::<STATES>::new(config);
    let fixes = day.epochs.iter().zip(observations).filter_map(|(epoch, observations)| {
        let solution = filter.process(epoch.time, &receiver, observations).ok()?;
        Some(Fix { t: epoch.time.since(MIDNIGHT), position: solution.position })
    });
    Score::of(&fixes.collect::<Vec<_>>(), day.epochs.len(), &day.marker)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_same_seed_gives_the_same_report_at_any_number_of_threads() {
        let options = RunOptions { trials: Some(1), seed: 3, scalar: None };
        let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        let report = run(options).unwrap();
        assert_eq!(report, alone.install(|| run(options)).unwrap());
        assert_ne!(report, run(RunOptions { seed: 4, ..options }).unwrap());
    }

    #[test]
    fn only_doubles_will_do() {
        let options = RunOptions { trials: Some(1), seed: 0, scalar: Some(ScalarKind::F32) };
        let sentence = run(options).unwrap_err().to_string();
        assert_eq!(sentence, "gnss computes in f64, not in f32 (--scalar)");
    }

    /// On one day: (plain, default) without faults, and with them.
    fn plain_and_default(index: u64) -> [[Score; 2]; 2] {
        [Rates::NONE, Rates::RECORDING].map(|rates| {
            let day = Day::new(11, index, &rates);
            let observations = observations(&day);
            [Estimator::plain(), Estimator::guarded(Motion::Static)].map(|estimator| {
                let config = Config { estimator, ..Config::new(Motion::Static) };
                follow(&day, &observations, config)
            })
        })
    }

    #[test]
    fn faults_harm_the_plain_filter_and_not_the_default() {
        for index in 0..3 {
            let [clean, faulty] = plain_and_default(index);
            for score in clean {
                assert!(score.final_mm[3] < 15.0 && score.rms_mm[3] < 30.0, "{score:?}");
                assert!(score.convergence_min.is_some_and(|minutes| minutes < 90.0), "{score:?}");
                assert_eq!(score.unsolved, 0);
            }
            let [plain, default] = faulty.map(|score| score.rms_mm[3]);
            assert!(plain > 70.0 && default < plain / 3.0, "{index}: {plain} {default}");
            assert!(default < 35.0, "{index}: {default}");
        }
    }
}
