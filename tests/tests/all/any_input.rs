//! Whatever is fed in, no crate panics or overflows, and a step that is refused leaves the state as it was (where
//! `try_on` takes it): everything that a crate offers (`tests/firmware/surface`) is called with numbers drawn at random, NaN, infinities
//! and the rails of fixed point among them. Tests are built with overflow checks.
//!
//! `KESTIRIM_SEEDS` sets how often, `kalman` a seventh as often; a failure names the seed it happened at.

use std::env;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};

use target_bench::is_short;

#[allow(unreachable_pub)] // Another package's library.
#[path = "../../firmware/surface/src/all.rs"]
mod surface;

/// How often each crate's functions are called, unless told otherwise; in the short form a third of that.
const SEEDS: u64 = 300;

/// One in so many numbers is wild: none to speak of, some, many.
const TAME: [u64; 4] = [1_000_000, 100, 20, 3];

/// In so many `kalman`'s are called once: its gain of a steady state takes a hundred thousand steps where there is none.
const SEEDS_OF_KALMAN: u64 = 7;

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
    adaptive_kalman air_to_ground arithmetic attitude gnss_ppp health imu_calibration integer_ambiguity luenberger luenberger_f64
    observer_design particle_filter pedestrian ppp_filter robust_kalman scalar scalar_f64 snapshot telemetry uav_estimator
    uav_longitudinal user_locator uwb_ranging uwb_tracker
);

#[test]
fn kalman() {
    run(surface::kalman::run, seeds().div_ceil(SEEDS_OF_KALMAN));
}
