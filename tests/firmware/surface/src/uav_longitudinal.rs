//! Calls everything of `kestirim-uav-longitudinal`.

use kestirim_uav_longitudinal::{
    Airframe, Descriptor, LateralDerivatives, LongitudinalDerivatives, Stall, StateSpace,
    SteadyFlight, Trim, aerosonde, airspeed_and_pitch, full_state, navion, rate_airspeed_and_pitch,
    thesis_like,
};

use super::values::{any, call_each, keep, matrix, number};

fn plants() {
    keep(aerosonde());
    keep(thesis_like());
    keep(navion());
    keep(full_state());
    keep(rate_airspeed_and_pitch());
    keep(airspeed_and_pitch());
}

fn flights() {
    keep(Stall::aerosonde());
    let airframe = any(Airframe::aerosonde());
    keep(Airframe::rates(&airframe, &matrix(), &matrix()));
    let flight = any(SteadyFlight { airspeed: number(), climb_angle: number() });
    keep(Airframe::trim(&airframe, &flight));
    let trim = any(Trim { state: matrix(), input: matrix() });
    if let Ok(model) = any(Airframe::linearise(&airframe, &trim)) {
        keep(StateSpace::process_noise(&model, number(), &[number(); 6], number()));
    }
    keep(Airframe::specific_force(&airframe, &trim));
    keep(Airframe::linearise(&any(Airframe::skywalker_x8()), &trim));
    if let Ok(derivatives) = any(Airframe::longitudinal(&airframe, &trim)) {
        keep(LongitudinalDerivatives::descriptor(&derivatives));
    }
    if let Ok(derivatives) = any(Airframe::lateral(&airframe, &trim)) {
        keep(LateralDerivatives::descriptor(&derivatives));
    }
    keep(Descriptor::resolve(&any(Descriptor { e: matrix(), a: matrix(), b: matrix() })));
}

/// Calls everything in this module.
pub fn run() {
    call_each([plants, flights]);
}
