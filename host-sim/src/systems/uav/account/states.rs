//! Statistics and text of the four states.

use nalgebra::SVector;

use crate::systems::uav::simulate::scenario::INTERVAL_S;

/// The error bands of α, q, V, θ: a state is caught when its error stays within its band.
pub const BANDS: [f64; 4] = [0.005, 0.005, 0.1, 0.005];

/// The time from which on each state's error stays within its band (s); `None` if it never does.
pub fn caught(errors: &[SVector<f64, 4>]) -> [Option<f64>; 4] {
    std::array::from_fn(|state| {
        let outside = |error: &SVector<f64, 4>| error[state].abs() > BANDS[state];
        let last = errors.iter().rposition(outside).map_or(0, |last| last + 1);
        (last < errors.len()).then_some(last as f64 * INTERVAL_S)
    })
}

/// Times to catch the states, as text; `None` means not within ten seconds.
pub fn times(seconds: Option<[Option<f64>; 4]>) -> String {
    let one = |time: Option<f64>| time.map_or("> 10".to_owned(), |time| format!("{time:.2}"));
    seconds.map_or("none".to_owned(), |all| all.map(one).join(" "))
}

/// Four numbers as text, with three digits each.
pub fn shown(numbers: [f64; 4]) -> String {
    numbers
        .map(|number| if number < 0.01 { format!("{number:.1e}") } else { format!("{number:.3}") })
        .join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn caught_is_after_the_last_time_outside() {
        let error = |alpha: f64, airspeed: f64| SVector::from([alpha, 0.0, airspeed, 1.0]);
        let errors = [error(1.0, 0.0), error(0.001, 0.2), error(-1.0, 0.0), error(0.0, 0.05)];
        let caught = caught(&errors);
        assert_eq!(caught, [Some(3.0 * INTERVAL_S), Some(0.0), Some(2.0 * INTERVAL_S), None]);
    }
}
