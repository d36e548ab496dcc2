//! Precise point positioning on the target itself: a station is located with ten satellites, by the default filter
//! without and with tropospheric gradients, and by the plain one.
//!
//! Prints
//!
//! - `name`, `scalar` and `object_bytes` (size of the filter);
//! - for each filter and epoch `FILTER.solution`, the bits of x, y, z, the receiver's clock and the wet delay, and
//!   `FILTER.treated`, the numbers of codes and of phases that had less than full weight;
//! - the meter's report of the first epoch, of those with good observations, and of that with outliers.

#![no_std]
#![no_main]

use core::hint::black_box;

use images::ppp::{Epochs, Filter, OUTLIERS, receiver, station};
use kestirim_ppp_filter::{Config, Error, Estimator, Lean, Motion};
use kestirim_robust_kalman::Reweighting;
use kestirim_scalar::Components;
use support::{Class, Meter, fail, image, line, line_of_text};

/// The measured depth of the stack, bytes, which exceeds that of any epoch.
const REACH: usize = 96 * 1024;

fn run() {
    line_of_text("name", "ppp");
    line_of_text("scalar", "f64");
    line("object_bytes", &[size_of::<Filter>() as i64]);
    let gradients = Config::new(Motion::Static).with_estimator(Estimator::at_rest());
    let default = Config { gradient: 0.0, ..gradients };
    position(
        &["default.solution", "default.treated"],
        ["default first", "default clean", "default outliers"],
        default,
    );
    position(
        &["gradients.solution", "gradients.treated"],
        ["gradients first", "gradients clean", "gradients outliers"],
        gradients,
    );
    let mut plain = Config { gradient: 0.0, ..gradients };
    plain.estimator.robust.reweighting = Reweighting::Never;
    plain.estimator.patience = None;
    position(
        &["plain.solution", "plain.treated"],
        ["plain first", "plain clean", "plain outliers"],
        plain,
    );
}

#[inline(never)] // One filter's code for all.
fn position(keys: &[&str; 2], names: [&str; 3], config: Config<Lean>) {
    let mut filter = Filter::new(black_box(config));
    let mut meters = names.map(|name| (name, Meter::reaching(REACH)));
    let [(_, first), (_, clean), (_, outliers)] = &mut meters;
    for (index, epoch) in Epochs::at(black_box(station())).enumerate() {
        let meter = match index {
            0 => &mut *first,
            OUTLIERS => &mut *outliers,
            _ => &mut *clean,
        };
        let mut answer = Err(Error::TimeNotAdvancing);
        meter.measure(|| {
            answer = filter.process(epoch.time, &receiver(), &epoch.observations);
            if answer.is_ok() { Class::Update } else { Class::Rejected }
        });
        let Ok(solution) = answer else { fail("an epoch without a solution") };
        let [x, y, z] = *solution.position.as_array();
        let [solution_key, treated_key] = keys;
        let numbers = [x, y, z, solution.clock, solution.wet_delay];
        line(solution_key, &numbers.map(|number| number.to_bits() as i64));
        let codes = solution.satellites.iter().filter(|report| report.code.was_treated()).count();
        let phases = solution.satellites.iter().filter(|report| report.phase.was_treated()).count();
        line(treated_key, &[codes as i64, phases as i64]);
    }
    for (name, meter) in &meters {
        meter.report(name);
    }
}

image!(run);
