//! `host-sim run gnss`: the paper's filters and ours on synthetic station-days.
//!
//! Every filter gets the same days with faults; two of them also get the same days without faults.

mod report;

use kestirim_ppp_filter::{Config, Estimator, Motion};
use kestirim_replay::gnss::FilterKind;
use kestirim_sweep::{Block, Samples};

pub(super) use self::report::four;
pub use self::report::{Report, Row};
use super::published::{self, PppErrors};
use crate::Error;
use crate::system::{RunOptions, ScalarKind, System, choose_scalar};
use crate::systems::gnss::Gnss;
use crate::systems::gnss::settings::SCALARS;
use crate::systems::gnss::simulate::trial::{Score, trial};

/// The default number of station-days; the paper has 100.
const TRIALS: u64 = 10;
/// The variance rate of each coordinate in a kinematic filter (m²/s), which does not assume a stationary receiver.
pub const PROCESS_NOISE: f64 = 1e-4;

/// The name of the table of the paper's static filters.
pub(super) const STATIC: &str = "Table 2: static";
/// The name of the table of the paper's kinematic filters.
pub(super) const KINEMATIC: &str = "Table 3: kinematic";
/// The name of the table of the days without faults.
pub(super) const CLEAN: &str = "the same days without faults";

/// One filter on one kind of station-days.
#[derive(Debug, Clone, Copy)]
struct Case {
    table: &'static str,
    filter: &'static str,
    motion: Motion,
    estimator: Estimator,
    faults: bool,
    published: Option<PppErrors>,
}

impl Case {
    fn filter(&self) -> (Config, bool) {
        // The state has no gradient, as in the paper; and the synthetic weather is the same in all directions.
        let config = Config { gradient: 0.0, ..Config::new(self.motion) };
        (Config { estimator: self.estimator, ..config }, self.faults)
    }
}

/// All rows of the tables. As published, the t-test is no different, and UKF equals IKF because its factor never falls:
/// only one of the tables shows it.
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

/// The trials: one per station-day.
///
/// # Errors
/// If the number type is not supported.
pub fn trials(options: RunOptions) -> Result<Vec<Block>, Error> {
    choose_scalar(Gnss::NAME, options.scalar, &SCALARS, ScalarKind::F64)?;
    let cases = cases();
    let columns = cases.iter().flat_map(|case| {
        let case = format!("{}: {}", case.table, case.filter);
        Score::COLUMNS.map(|column| format!("{case}: {column}"))
    });
    let columns: Vec<_> = columns.collect();
    let filters: Vec<_> = cases.iter().map(Case::filter).collect();
    let trials = options.trials.unwrap_or(TRIALS);
    let day = move |index| {
        let scores = trial(options.seed, index, &filters);
        Ok(scores.iter().flat_map(Score::numbers).collect())
    };
    Ok(vec![Block::new("days", columns, trials, day)])
}

/// Evaluates the samples of the trials.
///
/// # Errors
/// Those of [`trials`].
pub fn report(options: RunOptions, samples: &[Samples]) -> Result<Report, Error> {
    let scalar = choose_scalar(Gnss::NAME, options.scalar, &SCALARS, ScalarKind::F64)?;
    let days = &samples[0];
    let rows = cases().into_iter().enumerate().map(|(place, case)| {
        let numbers = days.rows().map(|day| &day[place * Score::COLUMNS.len()..]);
        Row::of(case.table, case.filter, case.published, numbers.map(Score::of_numbers).collect())
    });
    Ok(Report {
        system: Gnss::NAME,
        seed: options.seed,
        scalar,
        trials: days.len(),
        process_noise: PROCESS_NOISE,
        rows: rows.collect(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::system::{Settings, experiment};

    #[test]
    fn the_same_seed_gives_the_same_report_at_any_number_of_threads() {
        let options = RunOptions { trials: Some(1), seed: 3, scalar: None };
        let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        let run = |options| experiment::<Gnss>(&options, &Settings::new([])).unwrap();
        let report = run(options);
        assert_eq!(report, alone.install(|| run(options)));
        assert_ne!(report, run(RunOptions { seed: 4, ..options }));
    }

    #[test]
    fn only_doubles_will_do() {
        let options = RunOptions { trials: Some(1), seed: 0, scalar: Some(ScalarKind::F32) };
        let sentence = trials(options).unwrap_err().to_string();
        assert_eq!(sentence, "gnss computes in f64, not in f32 (--scalar)");
    }
}
