use kestirim_uav_identification::{Airplane, Flight, Identified, Known, identify};

use crate::simulated::{CALM, Plan, TRUE, fly};

const NAMES: [(&str, f64); 13] = [
    ("Z_alpha", TRUE[0][0]),
    ("Z_q", TRUE[0][1]),
    ("Z_V", TRUE[0][2]),
    ("Z_delta_e", TRUE[0][3]),
    ("Z_delta_t", TRUE[0][4]),
    ("M_alpha", TRUE[1][0]),
    ("M_q", TRUE[1][1]),
    ("M_V", TRUE[1][2]),
    ("M_delta_e", TRUE[1][3]),
    ("M_delta_t", TRUE[1][4]),
    ("X_alpha", TRUE[2][0]),
    ("X_V", TRUE[2][2]),
    ("X_delta_t", TRUE[2][4]),
];

fn of(flight: Flight) -> Identified {
    identify(&[flight], None).unwrap()
}

fn sigmas(found: &Identified) -> Vec<(&'static str, f64)> {
    let error = |&(name, truth): &(&'static str, f64)| {
        let it = found.parameters.iter().find(|it| it.name == name).unwrap();
        (name, (it.value - truth) / it.sigma)
    };
    NAMES.iter().map(error).collect()
}

#[test]
fn derivatives_come_back_with_their_standard_errors() {
    let gusts = [4e-3, 2e-2, 5e-2, 0.0];
    let (mut sum, mut count, mut worst) = (0.0, 0.0, 0.0);
    for seed in 1..=2 {
        for gusts in [[0.0; 4], gusts] {
            let found = of(fly(&Plan { seed, gusts, ..CALM }));
            for (_, off) in sigmas(&found) {
                worst = f64::max(worst, off.abs());
                sum += off * off;
                count += 1.0;
            }
        }
    }
    let ratio = f64::sqrt(sum / count);
    assert!(worst < 4.0, "an error of {worst:.1} σ");
    assert!((0.6..1.4).contains(&ratio), "errors are {ratio:.2} of their σ");
}

#[test]
fn a_held_input_is_half_an_interval_late() {
    let found = of(fly(&CALM));
    let delay = found.parameters.iter().find(|it| it.name == "delay").unwrap().value;
    assert!((delay - 0.01).abs() < 2e-3, "{delay}");
}

#[test]
fn the_gyros_bias_is_in_the_trim() {
    let rate = of(fly(&CALM)).model.trim.x[1];
    assert!((rate - 0.01).abs() < 1e-3, "{rate}");
}

#[test]
fn process_noise_is_found() {
    let gusts = [4e-3, 5e-2, 0.1, 0.0];
    let found = of(fly(&Plan { gusts, ..CALM }));
    for state in 1..3 {
        let ratio = found.model.noise.process[state].sqrt() / gusts[state];
        assert!((0.6..1.6).contains(&ratio), "state {state}: {ratio}");
    }
    assert!(found.gain.unwrap() > 100.0, "{:?}", found.gain);
    let white = found.fits.iter().filter_map(|fit| fit.whiteness);
    for it in white {
        assert!(it.next.abs() < 0.1, "{it:?}");
    }
}

#[test]
fn a_growing_phugoid_and_25_seconds_do_no_harm() {
    let found = of(fly(&Plan { seconds: 25.0, lively: 0.4, ..CALM }));
    let fastest = found.modes.iter().map(|[re, _]| *re).fold(f64::MIN, f64::max);
    assert!(fastest > 0.0, "{:?}", found.modes);
    assert!(found.notes().iter().any(|note| note.contains("grows")));
    let (_, off) = sigmas(&found)[5];
    assert!(off.abs() < 4.0, "M_alpha is off by {off:.1} σ");
}

#[test]
fn a_throttle_at_rest_tells_nothing_and_that_is_said() {
    let found = of(fly(&Plan { throttle: false, ..CALM }));
    let it = found.parameters.iter().find(|it| it.name == "X_delta_t").unwrap();
    assert_eq!((it.value, it.known), (0.0, Known::Fixed("the throttle does not move")));
    assert!(found.notes().iter().any(|note| note.contains("X_delta_t")));
}

#[test]
fn without_a_vane_the_accelerometer_tells_the_lift() {
    let mut flight = fly(&CALM);
    flight.columns.retain(|(name, _)| name != "alpha");
    let found = of(flight);
    let (name, off) = sigmas(&found)[5];
    assert!(off.abs() < 4.0, "{name} is off by {off:.1} σ");
    assert!(!found.model.outputs.contains(&"alpha"));
    assert!(found.notes().iter().any(|note| note.contains("level on average")));
}

#[test]
fn without_an_accelerometer_the_vane_is_believed_and_that_is_said() {
    let mut flight = fly(&CALM);
    flight.columns.retain(|(name, _)| name != "az" && name != "ax");
    assert!(of(flight).notes().iter().any(|note| note.contains("nothing checks the vane")));
}

#[test]
fn gaps_and_missing_fields_are_borne() {
    let mut flight = fly(&CALM);
    for (_, values) in &mut flight.columns {
        values.iter_mut().skip(7).step_by(5).for_each(|value| *value = None);
    }
    for at in (1500..1600).rev() {
        flight.times.remove(at);
        flight.inputs.remove(at);
        flight.columns.iter_mut().for_each(|(_, values)| {
            values.remove(at);
        });
    }
    for (name, off) in sigmas(&of(flight)) {
        assert!(off.abs() < 4.5, "{name} off by {off:.1} of its σ");
    }
}

#[test]
fn coefficients_are_those_of_the_size() {
    let airplane = Airplane { mass: 2.0, inertia: 0.1, area: 0.5, chord: 0.2, density: 1.2 };
    let found = identify(&[fly(&CALM)], Some(&airplane)).unwrap();
    let value = |name: &str| found.coefficients.iter().find(|it| it.name == name).unwrap().value;
    let pressure = 0.5 * 1.2 * found.model.trim.x[2].powi(2);
    let expected = found.parameters[5].value * 0.1 / (pressure * 0.5 * 0.2);
    assert!((value("Cm_alpha") / expected - 1.0).abs() < 1e-12);
    assert!(value("CL_alpha") > 0.0 && value("Cm_delta_e") < 0.0);
}
