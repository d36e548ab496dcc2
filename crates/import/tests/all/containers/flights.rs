//! Flights as autopilots log them: the rows read are those written, and what the log lacks is reported.

use std::fmt::Write as _;

use kestirim_import::Options;
use kestirim_import::flight::{self, Flight};

use super::ardupilot::{FORMAT, LABELS, fmt, imu};
use super::px4::{data, header, micros, singles, topic};
use super::{MANY_SEEDS, SEEDS, survives_reading};

/// α, q, V, θ, δe, δt of the flight at a time.
fn flown(t: f64) -> [f64; 6] {
    let (slow, fast) = ((0.4 * t).sin(), (2.0 * t).sin());
    [
        0.05 + 0.02 * slow,
        0.1 * fast,
        40.0 + 2.0 * slow,
        0.1 + 0.05 * fast,
        -0.05 * fast,
        0.5 + 0.2 * slow,
    ]
}

fn times() -> impl Iterator<Item = (usize, f64)> {
    (0..400).map(|k| (k, k as f64 * 0.02))
}

/// The elevator deflection per unit of command, degrees: 25° for 4500.
const TRAVEL_DEG: f64 = 25.0 / 4500.0;

fn options(units: &str) -> Options {
    Options { units: units.parse().unwrap(), ..Options::default() }
}

fn said() -> Options {
    options("delta_e=-0.005555555555555556deg")
}

fn read(bytes: &[u8], options: &Options) -> Result<Flight, String> {
    flight::read(bytes, options)
        .map(|read| read.expect("an autopilot's"))
        .map_err(|it| it.to_string())
}

/// A message of `ArduPilot` with a time and four-byte numbers.
fn message(kind: u8, t: f64, number: Option<u8>, values: &[f64]) -> Vec<u8> {
    let mut message = vec![0xa3, 0x95, kind];
    message.extend(((t * 1e6).round() as u64 + 5_000_000).to_le_bytes());
    message.extend(number);
    message.extend(values.iter().flat_map(|value| (*value as f32).to_le_bytes()));
    message
}

/// Messages as `LogStructure.h` and `ArduPlane/Log.cpp` define them, the airspeed at a fifth of the rate.
fn ardupilot(is_with_alpha: bool) -> Vec<u8> {
    let mut log = fmt(128, "FMT", "BBnNZ", "Type,Length,Name,Format,Columns", 89);
    log.extend(fmt(130, "IMU", FORMAT, LABELS, 54));
    log.extend(fmt(140, "AOA", "Qff", "TimeUS,AOA,SSA", 19));
    log.extend(fmt(141, "ARSP", "QBff", "TimeUS,I,Airspeed,DiffPress", 20));
    log.extend(fmt(142, "ATT", "Qcccc", "TimeUS,DesRoll,Roll,DesPitch,Pitch", 19));
    log.extend(fmt(143, "AETR", "Qffff", "TimeUS,Ail,Elev,Thr,Rudd", 27));
    for (k, t) in times() {
        let [alpha, q, v, theta, elevator, throttle] = flown(t);
        log.extend(message(
            143,
            t,
            None,
            &[0.0, -elevator.to_degrees() / TRAVEL_DEG, throttle * 100.0, 0.0],
        ));
        for number in 0..2 {
            log.extend(imu(number, [t, 0.0, 0.0, -9.8, 0.0, q + f64::from(number), 0.0]));
        }
        if is_with_alpha {
            log.extend(message(140, t, None, &[alpha.to_degrees(), 0.0]));
        }
        if k % 5 == 0 {
            log.extend(message(141, t, Some(1), &[99.0, 0.0]));
            log.extend(message(141, t, Some(0), &[v, 0.0]));
        }
        let mut attitude = message(142, t, None, &[]);
        let centidegrees = (theta.to_degrees() * 100.0).round() as i16;
        attitude.extend([0, 0, 0, centidegrees].map(i16::to_le_bytes).concat());
        log.extend(attitude);
    }
    log
}

/// Fails unless the rows are those of the flight.
fn assert_flown(flight: &Flight, offset_us: i64, tolerance: [f64; 4], has: [bool; 4]) {
    assert_eq!((flight.rows.len(), flight.has), (400, has));
    for ((k, t), row) in times().zip(&flight.rows) {
        assert_eq!(row.time_us - offset_us, (t * 1e6).round() as i64);
        let values = flown(t);
        for state in 0..4 {
            let is_there = has[state] && (state != 2 || k % 5 == 0);
            assert_eq!(row.state[state].is_some(), is_there, "{row:?}");
            let off = row.state[state].map_or(0.0, |value| (value - values[state]).abs());
            assert!(off <= tolerance[state], "{state}: {row:?} is not {values:?}");
        }
        assert!((row.input[0] - values[4]).abs() < 1e-6 && (row.input[1] - values[5]).abs() < 1e-6);
    }
    assert_eq!(flight.damage.count(), 0);
}

#[test]
fn a_flight_of_ardupilot_is_read() {
    let flight = read(&ardupilot(true), &said()).unwrap();
    assert_flown(&flight, 5_000_000, [1e-7, 1e-7, 1e-5, 1e-4], [true; 4]);
    assert_eq!(
        flight.conclusions,
        [
            "alpha = AOA.AOA in °, q = IMU.GyrY in rad/s, V = ARSP.Airspeed in m/s, theta = ATT.Pitch in °, \
             delta_e = AETR.Elev in -0.005555555555555556 °, delta_t = AETR.Thr in %: ArduPilot",
            "alpha is reckoned by the autopilot from airspeed and wind, not measured",
            "V is calibrated, not true airspeed",
        ]
    );
    let flight = read(&ardupilot(false), &said()).unwrap();
    assert_flown(&flight, 5_000_000, [0.0, 1e-7, 1e-5, 1e-4], [false, true, true, true]);
    assert_eq!(flight.conclusions[1], "not in the log: alpha");
}

#[test]
fn a_log_of_text_is_the_same_flight() {
    let mut text = "FMT, 128, 89, FMT, BBnNZ, Type,Length,Name,Format,Columns\n\
        FMT, 140, 19, AOA, Qff, TimeUS,AOA,SSA\nFMT, 141, 20, ARSP, QBff, TimeUS,I,Airspeed,DiffPress\n\
        FMT, 142, 19, ATT, Qcccc, TimeUS,DesRoll,Roll,DesPitch,Pitch\n\
        FMT, 143, 27, AETR, Qffff, TimeUS,Ail,Elev,Thr,Rudd\nFMT, 130, 12, IMU, QBf, TimeUS,I,GyrY\n"
        .to_owned();
    for (k, t) in times() {
        let [alpha, q, v, theta, elevator, throttle] = flown(t);
        let us = (t * 1e6).round();
        let elevator = -elevator.to_degrees() / TRAVEL_DEG;
        let _ =
            writeln!(text, "AETR, {us}, 0, {elevator}, {}, 0\nIMU, {us}, 0, {q}", throttle * 100.0);
        let (alpha, theta) = (alpha.to_degrees(), theta.to_degrees());
        let _ = writeln!(text, "AOA, {us}, {alpha}, 0\nATT, {us}, 0, 0, 0, {theta}");
        if k % 5 == 0 {
            let _ = writeln!(text, "ARSP, {us}, 0, {v}, 0");
        }
    }
    assert_flown(&read(text.as_bytes(), &said()).unwrap(), 0, [1e-12; 4], [true; 4]);
    let torn = text.replacen("IMU, 200000, 0, ", "IMU, 200000, x, ", 1);
    let flight = read(torn.as_bytes(), &said()).unwrap();
    assert_eq!((flight.rows.len(), flight.damage.count()), (399, 1));
    let strict = Options { strict: true, ..said() };
    assert!(read(torn.as_bytes(), &strict).unwrap_err().starts_with("line 5"));
}

/// Topics as PX4 1.14 logs them.
fn px4() -> Vec<u8> {
    let mut log = header(&[
        "vehicle_angular_velocity:uint64_t timestamp;uint64_t timestamp_sample;float[3] xyz;float[3] xyz_derivative;",
        "vehicle_attitude:uint64_t timestamp;uint64_t timestamp_sample;float[4] q;float[4] delta_q_reset;uint8_t quat_reset_counter;uint8_t[7] _padding0;",
        "airspeed_validated:uint64_t timestamp;float indicated_airspeed_m_s;float calibrated_airspeed_m_s;float true_airspeed_m_s;uint8_t[4] _padding0;",
        "vehicle_torque_setpoint:uint64_t timestamp;uint64_t timestamp_sample;float[3] xyz;uint8_t[4] _padding0;",
        "vehicle_thrust_setpoint:uint64_t timestamp;uint64_t timestamp_sample;float[3] xyz;uint8_t[4] _padding0;",
    ]);
    let topics = [
        "vehicle_angular_velocity",
        "vehicle_attitude",
        "airspeed_validated",
        "vehicle_torque_setpoint",
        "vehicle_thrust_setpoint",
    ];
    for (id, name) in (0..).zip(topics) {
        log.extend(topic(id, 0, name));
    }
    for (k, t) in times() {
        let [_, q, v, theta, elevator, throttle] = flown(t);
        let (time, zero) = (micros(t), singles([0.0; 3]));
        log.extend(data(3, &[&time, &time, &singles([0.0, -elevator.to_degrees() / 25.0, 0.0])]));
        log.extend(data(4, &[&time, &time, &singles([throttle, 0.0, 0.0])]));
        log.extend(data(0, &[&micros(t + 1e-3), &time, &singles([0.3, q, 0.1]), &zero]));
        // North-east of level, then nose up.
        let (half, yaw) = (theta / 2.0, 0.4_f64);
        let turned = [
            yaw.cos() * half.cos(),
            -yaw.sin() * half.sin(),
            yaw.cos() * half.sin(),
            yaw.sin() * half.cos(),
        ];
        let turned = turned.map(|value| (value as f32).to_le_bytes()).concat();
        log.extend(data(1, &[&time, &time, &turned, &[0; 16], &[0]]));
        if k % 5 == 0 {
            log.extend(data(2, &[&time, &singles([v - 3.0, v - 2.0, v])]));
        }
    }
    log
}

#[test]
fn a_flight_of_px4_is_read() {
    let flight = read(&px4(), &options("delta_e=-25deg")).unwrap();
    assert_flown(&flight, 7_000_000, [0.0, 1e-7, 1e-5, 1e-6], [false, true, true, true]);
    assert_eq!(
        flight.conclusions,
        [
            "q = vehicle_angular_velocity.xyz[1] in rad/s, V = airspeed_validated.true_airspeed_m_s in m/s, \
             theta = vehicle_attitude.q in rad, delta_e = vehicle_torque_setpoint.xyz[1] in -25 °, \
             delta_t = vehicle_thrust_setpoint.xyz in parts of 1: PX4 ULog",
            "not in the log: alpha",
        ]
    );
}

#[test]
fn what_a_log_does_not_tell_an_option_says() {
    let plain = Options::default();
    assert_eq!(
        read(&ardupilot(true), &plain).unwrap_err(),
        "expected the elevator's deflection, found AETR.Elev, -4500 to 4500 of a travel that the log does not tell, \
         positive nose up; --units delta_e=-0.0056deg decides"
    );
    assert!(read(&px4(), &plain).unwrap_err().ends_with("--units delta_e=-25deg decides"));
    let with = |columns: &str, units: &str| Options {
        columns: columns.parse().unwrap(),
        ..options(units)
    };
    let error = read(&ardupilot(true), &with("alpha=ATT.Pitch", "delta_e=-0.01deg")).unwrap_err();
    assert_eq!(error, "expected a unit of ATT.Pitch, found none; --units alpha= decides");
    let picked = with("alpha=-ATT.Pitch", "delta_e=-0.01deg,alpha=deg");
    let flight = read(&ardupilot(true), &picked).unwrap();
    assert!((flight.rows[7].state[0].unwrap() + flown(0.14)[3]).abs() < 1e-4);
    let picked = with("delta_e=vehicle_torque_setpoint.xyz[2]", "delta_e=deg");
    assert_eq!(read(&px4(), &picked).unwrap().rows[3].input[0], 0.0);
    for (options, expected) in [
        (
            with("delta_e=RCOU.C2", "delta_e=deg"),
            "expected RCOU.C2 as --columns says, found IMU, AOA, ARSP",
        ),
        (with("delta_e=C2", "delta_e=deg"), "expected --columns delta_e=AETR.Elev, found \"C2\""),
        (
            options("t=ms"),
            "expected options of alpha, q, V, theta, delta_e, delta_t alone, found one of t",
        ),
        (with("ax=IMU.AccX", "delta_e=deg"), "alone, found one of ax"),
        (
            Options { topic: Some("4".to_owned()), ..said() },
            "expected a sensor 4, found none (--topic)",
        ),
    ] {
        let error = read(&ardupilot(true), &options).unwrap_err();
        assert!(error.contains(expected), "{error}");
    }
    let second = Options { topic: Some("1".to_owned()), ..said() };
    let flight = read(&ardupilot(true), &second).unwrap();
    assert!((flight.rows[0].state[1].unwrap() - 1.0).abs() < 1e-6);
    assert_eq!(flight.rows[0].state[2], Some(99.0));
}

#[test]
fn a_log_that_is_no_flight_is_refused() {
    let walk = super::ardupilot::log(&super::short());
    let error = read(&walk, &said()).unwrap_err();
    assert_eq!(
        error,
        "expected delta_e as AETR.Elev of ArduPilot, found IMU, MODE; --columns delta_e=NAME.FIELD decides"
    );
    assert_eq!(flight::read(b"t,q\n1,2\n", &Options::default()), Ok(None));
    // Commands alone are no measurement.
    let mut log = fmt(143, "AETR", "Qffff", "TimeUS,Ail,Elev,Thr,Rudd", 27);
    log.extend(message(143, 0.0, None, &[0.0; 4]));
    let error = read(&log, &said()).unwrap_err();
    assert_eq!(
        error,
        "expected one of AOA.AOA, IMU.GyrY, ARSP.Airspeed, ATT.Pitch of ArduPilot, found AETR"
    );
}

#[test]
fn commands_hold_for_a_second_and_no_longer() {
    let mut log = fmt(143, "AETR", "Qffff", "TimeUS,Ail,Elev,Thr,Rudd", 27);
    log.extend(fmt(142, "ATT", "Qf", "TimeUS,Pitch", 15));
    for k in 0..400 {
        let t = f64::from(k) * 0.02;
        if k == 50 || k == 300 {
            log.extend(message(143, t, None, &[0.0, f64::from(k), 50.0, 0.0]));
        }
        log.extend(message(142, t, None, &[5.0]));
    }
    let flight = read(&log, &options("delta_e=rad")).unwrap();
    let commands: Vec<_> = flight.rows.iter().map(|row| row.input[0]).collect();
    assert_eq!(commands, [[50.0; 51], [300.0; 51]].concat());
    assert!(flight.conclusions.contains(
        &"298 samples have no command of elevator and throttle in the second before them: left out".to_owned()
    ));
}

#[test]
fn damage_is_skipped_and_counted() {
    let mut bytes = ardupilot(true);
    let at = bytes.len() / 2;
    bytes.splice(at..at + 5, [7; 9]);
    bytes.truncate(bytes.len() - 3);
    let flight = read(&bytes, &said()).unwrap();
    assert!(
        flight.rows.len() >= 398 && (2..4).contains(&flight.damage.count()),
        "{:?}",
        flight.damage
    );
    // A stretch of garbage loses more than is allowed.
    bytes.splice(at..at, vec![7; bytes.len() / 10]);
    assert!(read(&bytes, &said()).unwrap_err().contains("damaged records"));
}

/// Fails unless the rows that are read are in order, and refusals are one sentence.
fn assert_harmless(log: &[u8], seed: u64) {
    for units in ["delta_e=-0.0056deg", "delta_e=-25deg"] {
        match flight::read(log, &options(units)) {
            Ok(Some(flight)) => {
                assert!(!flight.rows.is_empty(), "seed {seed}");
                assert!(flight.rows.is_sorted_by(|a, b| a.time_us < b.time_us), "seed {seed}");
            }
            Ok(None) => {}
            Err(error) => {
                assert!(!error.to_string().contains(['\n', '\r']), "seed {seed}: {error}");
            }
        }
    }
}

#[test]
fn damaged_flights_do_no_harm() {
    for log in [ardupilot(true), px4()] {
        survives_reading(&log, 0..SEEDS, assert_harmless);
    }
}

#[test]
#[ignore = "minutes"]
fn much_harm_to_flights() {
    for log in [ardupilot(true), px4()] {
        survives_reading(&log, 0..MANY_SEEDS, assert_harmless);
    }
}
