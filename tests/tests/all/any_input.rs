//! Feeds arbitrary numbers to all crates: none panics or overflows, and a refused step leaves the state unchanged
//! (where `try_on` takes it).
//!
//! Everything that a crate offers (`tests/firmware/surface`) is called with random numbers, including NaN, infinities
//! and the limits of fixed point. Tests are built with overflow checks.
//!
//! `KESTIRIM_SEEDS` sets the number of calls, a seventh of which are made of `kalman` and a fifth of `user_locator`; a failure
//! names its seed.

use std::env;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};

use target_bench::is_short;

#[allow(unreachable_pub)] // Another package's library.
#[path = "../../firmware/surface/src/all.rs"]
mod surface;

/// The default number of times that each crate's functions are called; a third of that in the short form.
const SEEDS: u64 = 300;

/// One in this many numbers is extreme: practically none, some, many.
const TAME: [u64; 4] = [1_000_000, 100, 20, 3];

/// `kalman`'s functions are called once in this many rounds: where there is no steady state, its steady-state gain
/// takes a hundred thousand steps.
const SEEDS_OF_KALMAN: u64 = 7;
/// Those of `user_locator` once in this many: each search of open ground makes thousands of fits, as this program is not optimised.
const SEEDS_OF_USER_LOCATOR: u64 = 5;

fn seeds() -> u64 {
    let told = env::var("KESTIRIM_SEEDS");
    let default = if is_short() { SEEDS / 3 } else { SEEDS };
    told.map_or(default, |seeds| seeds.parse().expect("KESTIRIM_SEEDS is a number"))
}

fn run(call_all: fn(), seeds: u64) {
    for seed in 0..seeds {
        let tame = TAME[(seed % 4) as usize];
        surface::values::start_from(seed, tame);
        if let Err(panic) = catch_unwind(AssertUnwindSafe(call_all)) {
            eprintln!("at seed {seed}, with one wild number among {tame}");
            resume_unwind(panic);
        }
    }
}

macro_rules! test_each {
    ($($name:ident)*) => {$(
        #[test]
        fn $name() {
            run(surface::$name::run, seeds());
        }
    )*};
}

test_each!(
    adaptive_kalman air_to_ground arithmetic arithmetic_f64 attitude gnss_message gnss_ppp health imu_calibration integer_ambiguity luenberger luenberger_f64
    observer_design particle_filter pedestrian ppp_filter robust_kalman scalar scalar_f64 snapshot telemetry uav_estimator
    uav_longitudinal uwb_ranging uwb_tracker
);

#[test]
fn kalman() {
    run(surface::kalman::run, seeds().div_ceil(SEEDS_OF_KALMAN));
}

#[test]
fn user_locator() {
    run(surface::user_locator::run, seeds().div_ceil(SEEDS_OF_USER_LOCATOR));
}
