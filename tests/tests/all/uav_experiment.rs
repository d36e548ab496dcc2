//! The flights of `host-sim run uav`, compared with those of `../shared/data/uav/cases.json`.

use host_sim::random::stream;
use host_sim::systems::uav::paper::responses::responses;
use host_sim::systems::uav::simulate::design::Kind;
use host_sim::systems::uav::simulate::scenario::{INTERVAL_S, Inputs, NEAR, START, fly};
use kestirim_observer_design::riccati;
use kestirim_replay::uav::{MIDDLE, Noise, Plant};
use kestirim_tests::recordings::folder_of;
use kestirim_uav_longitudinal::{airspeed_and_pitch, full_state, rate_airspeed_and_pitch};
use nalgebra::{SMatrix, SVector};
use serde_json::Value;

#[test]
fn flights_without_noise_are_those_of_the_reference() {
    let Some(folder) = folder_of("uav") else { return };
    let text = std::fs::read_to_string(folder.join("cases.json")).expect("a readable file");
    let cases: Value = serde_json::from_str(&text).expect("JSON");
    let (plant, c) = (Plant::P2.discrete(INTERVAL_S), SMatrix::identity());
    let start = SVector::from(NEAR);
    let mut compared = 0;
    for (name, inputs) in [
        ("P2 const C=[full] noise=0", Inputs::Constant),
        ("P2 sine C=[full] noise=0", Inputs::Sine),
    ] {
        let list = cases["trajectories"].as_array().expect("a list of flights");
        let samples = &list.iter().find(|case| case["id"] == name).expect(name)["samples"];
        for (kind, column) in
            [(Kind::Luenberger(MIDDLE), "luenberger"), (Kind::Matched(Noise::SENSORS), "kalman_ss")]
        {
            let off = SVector::from(START) - start;
            let mut estimator = kind.estimator::<f64, 4>(&plant, &c, &start, &off).expect("a gain");
            let flight = fly(plant, START.into(), inputs, Noise::NONE, stream(0, 0));
            for (sample, now) in flight.take(1001).enumerate() {
                let there = &samples[sample.to_string()];
                if there.is_object() {
                    let state = |value: &Value| -> SVector<f64, 4> {
                        let numbers: [f64; 4] =
                            serde_json::from_value(value.clone()).expect("four numbers");
                        numbers.into()
                    };
                    assert!((now.x - state(&there["x"])).amax() < 1e-11, "{name} {sample}");
                    assert!(
                        (estimator.estimate() - state(&there[column])).amax() < 1e-11,
                        "{name} {sample}"
                    );
                    compared += 1;
                }
                assert!(estimator.step(&now.u, &now.measured(&c)).is_ok());
            }
        }
    }
    assert!(compared >= 12, "{compared} samples");
}

#[test]
fn steps_settle_when_the_reference_does() {
    let Some(folder) = folder_of("uav") else { return };
    let text = std::fs::read_to_string(folder.join("cases.json")).expect("a readable file");
    let cases: Value = serde_json::from_str(&text).expect("JSON");
    let expected = &cases["frequency_and_step"][0]["settling_2pct_s"];
    for (found, input) in responses(Plant::P2).settling_s.into_iter().zip(["u0", "u1"]) {
        let expected: [f64; 4] =
            serde_json::from_value(expected[input].clone()).expect("four times");
        for (found, expected) in found.into_iter().zip(expected) {
            assert!((found - expected).abs() < 1e-6, "{found} instead of {expected} s");
        }
    }
}

/// The largest number of doublings over all aircraft at 1 kHz, with noise on the inputs of 1e-4 to 1e4 times that on
/// the outputs.
fn most_doublings<const P: usize>(c: &SMatrix<f64, P, 4>) -> u32 {
    let ratios = (-4..=4).map(|power| 10.0_f64.powi(power));
    let cells = ratios.flat_map(|ratio| {
        [Plant::P1, Plant::P2, Plant::P3].map(|plant| (plant.discrete(1e-3), ratio))
    });
    let doublings = cells.map(|(plant, ratio)| {
        let q = plant.b * plant.b.transpose() * ratio;
        riccati(&plant.a, c, &q, &SMatrix::identity()).expect("every state is seen").doublings
    });
    doublings.max().expect("some cells")
}

#[test]
fn at_1_khz_some_twenty_doublings_settle_a_filter() {
    let most = [
        most_doublings(&full_state()),
        most_doublings(&rate_airspeed_and_pitch()),
        most_doublings(&airspeed_and_pitch()),
    ];
    println!("doublings at the most, all states, [q V θ], [V θ] measured: {most:?}");
    assert!(most.into_iter().all(|doublings| doublings <= 25));
}
