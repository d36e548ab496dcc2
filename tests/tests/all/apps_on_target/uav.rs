//! The aeroplane's observer: a BNO055 and a Pitot tube, the state as telemetry.

use anyhow::{Result, ensure};
use host_sim::random::{normal, stream};
use kestirim_luenberger::Predictor;
use kestirim_scalar::{Components, Q16_16, Scalar};
use kestirim_telemetry::{Flight, Health, Message, State};
use kestirim_tests::uav;
use nalgebra::SVector;
use target_bench::{App, CORTEX_M0, CORTEX_M4F, Target};

use super::{image, telemetry};

const INTERVAL: f64 = 0.01;
const INTERVAL_US: u32 = 10_000;

/// Half of a sixteenth of a degree, rad, and the rounding of single precision.
const ANGLE_STEP: f32 = 0.000_546;
/// Half of the resolution of 14 bits of 2 psi at the slowest airspeed here, and the effect of the air density, m/s.
const AIRSPEED_STEP: f32 = 0.02;

/// One moment of a flight: the applied inputs, the outputs to be measured, and the state.
struct Moment {
    inputs: [f32; 2],
    outputs: [f32; 3],
    state: [f64; 4],
}

/// Ten seconds with noise on inputs and outputs.
fn fly() -> Vec<Moment> {
    let plant = uav::plant(INTERVAL);
    let mut rng = stream(6, 0);
    let mut state = SVector::from([0.0, 0.0, 40.0, 0.53]);
    let mut moment = |_| {
        let mut noise = |sigma| normal(&mut rng, sigma);
        let outputs = plant.c * state + SVector::from([0.0087, 0.5, 0.0087].map(&mut noise));
        let inputs = SVector::from([0.025, 0.155]);
        let disturbed = inputs + SVector::from([0.0087, 0.02].map(&mut noise));
        let moment = Moment {
            inputs: inputs.as_array().map(|input| input as f32),
            outputs: outputs.as_array().map(|output| output as f32),
            state: *state.as_array(),
        };
        state = plant.a * state + plant.b * disturbed;
        moment
    };
    (0..1000).map(&mut moment).collect()
}

/// The data that the sensors and the autopilot play back: microseconds, inputs, outputs.
fn encode(flight: &[Moment]) -> Vec<u8> {
    let record = |moment: &Moment| {
        let numbers = moment.inputs.iter().chain(&moment.outputs);
        let numbers: Vec<u8> = numbers.flat_map(|number| number.to_le_bytes()).collect();
        [&INTERVAL_US.to_le_bytes(), &numbers[..]].concat()
    };
    flight.iter().flat_map(record).collect()
}

/// Checks that the measurements are those of the flight, within the sensors' resolution.
fn check_measurements(sent: &[Flight], flight: &[Moment]) {
    assert_eq!(sent.len(), flight.len());
    for (number, (sent, flown)) in sent.iter().zip(flight).enumerate() {
        assert_eq!(sent.time_us, (number as u64 + 1) * u64::from(INTERVAL_US));
        assert_eq!(sent.inputs, flown.inputs);
        let steps = [ANGLE_STEP, AIRSPEED_STEP, ANGLE_STEP];
        for ((ours, theirs), step) in sent.outputs.iter().zip(flown.outputs).zip(steps) {
            assert!((ours - theirs).abs() <= step, "{sent:?} of {:?}", flown.outputs);
        }
    }
}

/// The states that the application sends after these measurements, computed on the host.
fn on_host<T: Scalar>(measured: &[Flight]) -> Vec<State> {
    let start = SVector::from(uav::START.map(T::from_f32));
    let mut observer = Predictor::<T, 4, 2, 3>::new(&uav::gains(INTERVAL), &start).expect("gains");
    let step = |flight: &Flight| {
        let inputs = SVector::from(flight.inputs.map(T::from_f32));
        let outputs = SVector::from(flight.outputs.map(T::from_f32));
        observer.step(&inputs, &outputs).expect("a measurement");
        let state = observer.estimate().as_array().map(T::to_f32);
        State { time_us: flight.time_us + u64::from(INTERVAL_US), state }
    };
    measured.iter().map(step).collect()
}

/// The root mean square error of the angle of attack, which is not measured, after the first five seconds (rad).
fn angle_of_attack_error(states: &[State], flight: &[Moment]) -> f64 {
    // A state is sent for the moment after its measurement.
    let errors = states.iter().zip(flight.iter().skip(1)).skip(500);
    let squares: Vec<f64> =
        errors.map(|(state, flown)| (f64::from(state.state[0]) - flown.state[0]).powi(2)).collect();
    (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
}

fn check<T: Scalar>(target: &'static Target) -> Result<()> {
    let Some(app) = App::of(target, "uav-firmware")? else { return Ok(()) };
    let flight = fly();
    let run = app.run(&encode(&flight), None)?;
    let lines = image::log(&app, &run)?;
    ensure!(run.success, "{}{lines:#?}", run.console);

    let (mut measured, mut states, mut health) = (Vec::new(), Vec::new(), Vec::new());
    for message in telemetry::messages(&run.telemetry) {
        match message {
            Message::Flight(flight) => measured.push(flight),
            Message::State(state) => states.push(state),
            Message::Health(counts) => health.push(counts),
            Message::EstimateHealth(estimate) => assert_eq!(estimate.reasons, 0),
            other => panic!("{other:?} is not an aeroplane's"),
        }
    }
    check_measurements(&measured, &flight);
    assert_eq!(states, on_host::<T>(&measured), "the very bits");
    let error = angle_of_attack_error(&states, &flight);
    assert!(error < 0.002, "the angle of attack is {error} rad off");
    let expected = Health { time_us: 10_000_000, accepted: 1_000, rejected: 0, failed: 0 };
    assert_eq!((health.len(), health.last()), (10, Some(&expected)));

    assert_eq!(lines.len(), 2, "{lines:#?}");
    assert!(lines[0].starts_with("info observing from ["), "{}", lines[0]);
    assert!(lines[1].starts_with("info landed at ["), "{}", lines[1]);

    image::check("uav-firmware", &app)
}

#[test]
fn cortex_m0() -> Result<()> {
    check::<Q16_16>(&CORTEX_M0)
}

#[test]
fn cortex_m4f() -> Result<()> {
    check::<f32>(&CORTEX_M4F)
}
