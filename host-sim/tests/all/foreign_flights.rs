//! Tests with the same flight as logged by autopilots: the same estimate and innovations, or a refusal that names the
//! remedy.

use std::fmt::Write;

use host_sim::systems::uav::simulate::scenario::{INTERVAL_S, Inputs, Sample, fly};
use kestirim_replay::uav::{Noise, Plant};
use serde_json::Value;

use crate::program::{Desk, host_sim, json, refusal};

/// Ten seconds of a noisy flight of P2.
fn flight() -> Vec<Sample> {
    let plant = Plant::P2.discrete(INTERVAL_S);
    let start = [0.0, 0.0, 40.0, 0.53].into();
    let rng = host_sim::random::stream(3, 0);
    fly(plant, start, Inputs::Sine, Noise::SENSORS, rng).take(1000).collect()
}

/// The samples with their times (µs).
fn timed(samples: &[Sample]) -> impl Iterator<Item = (u64, &Sample)> {
    (0..).map(|k: u64| k * 10_000).zip(samples)
}

fn csv(samples: &[Sample]) -> String {
    let line = |(us, Sample { u, y, .. }): (u64, &Sample)| {
        format!("{:.2},{},{},{},{},{}\n", us as f64 * 1e-6, u[0], u[1], y[1], y[2], y[3])
    };
    "t,delta_e,delta_t,q,V,theta\n".to_owned() + &timed(samples).map(line).collect::<String>()
}

fn truth(samples: &[Sample]) -> String {
    let line = |(us, Sample { x, .. }): (u64, &Sample)| {
        format!("{:.2},{},{},{},{}\n", us as f64 * 1e-6, x[0], x[1], x[2], x[3])
    };
    "t,alpha,q,V,theta\n".to_owned() + &timed(samples).map(line).collect::<String>()
}

fn singles(values: &[f64]) -> Vec<u8> {
    values.iter().flat_map(|value| (*value as f32).to_le_bytes()).collect()
}

/// Messages as `AP_Logger/LogStructure.h` and `ArduPlane/Log.cpp` of `ArduPilot` define them: 100 of `AETR.Elev` are 1°, nose
/// up.
fn ardupilot(samples: &[Sample]) -> Vec<u8> {
    let mut log = Vec::new();
    for (kind, name, format, labels, length) in [
        (130, "IMU", "QBffffff", "TimeUS,I,GyrX,GyrY,GyrZ,AccX,AccY,AccZ", 36),
        (141, "ARSP", "QBff", "TimeUS,I,Airspeed,DiffPress", 20),
        (142, "ATT", "Qffff", "TimeUS,DesRoll,Roll,DesPitch,Pitch", 27),
        (143, "AETR", "Qffff", "TimeUS,Ail,Elev,Thr,Rudd", 27),
    ] {
        log.extend([0xa3, 0x95, 128, kind, length]);
        for (text, size) in [(name, 4), (format, 16), (labels, 64)] {
            let mut field = text.as_bytes().to_vec();
            field.resize(size, 0);
            log.extend(field);
        }
    }
    for (us, Sample { u, y, .. }) in timed(samples) {
        let mut message = |kind: u8, number: Option<u8>, values: &[f64]| {
            log.extend([0xa3, 0x95, kind]);
            log.extend(us.to_le_bytes());
            log.extend(number);
            log.extend(singles(values));
        };
        message(143, None, &[0.0, -100.0 * u[0].to_degrees(), 100.0 * u[1], 0.0]);
        message(130, Some(0), &[0.0, y[1], 0.0, 0.0, 0.0, -9.8]);
        message(141, Some(0), &[y[2], 0.0]);
        message(142, None, &[0.0, 0.0, 0.0, y[3].to_degrees()]);
    }
    log
}

/// The flight as a text log of `ArduPilot`.
fn ardupilot_text(samples: &[Sample]) -> String {
    let mut text = "FMT, 128, 89, FMT, BBnNZ, Type,Length,Name,Format,Columns\n\
        FMT, 130, 36, IMU, QBf, TimeUS,I,GyrY\nFMT, 141, 20, ARSP, QBf, TimeUS,I,Airspeed\n\
        FMT, 142, 27, ATT, Qf, TimeUS,Pitch\nFMT, 143, 27, AETR, Qff, TimeUS,Elev,Thr\n"
        .to_owned();
    for (us, Sample { u, y, .. }) in timed(samples) {
        let (elevator, throttle) = (-100.0 * u[0].to_degrees(), 100.0 * u[1]);
        let _ = writeln!(text, "AETR, {us}, {elevator}, {throttle}\nIMU, {us}, 0, {}", y[1]);
        let _ = writeln!(text, "ARSP, {us}, 0, {}\nATT, {us}, {}", y[2], y[3].to_degrees());
    }
    text
}

/// Topics as PX4 logs them (<https://docs.px4.io/main/en/dev_log/ulog_file_format.html>): a torque of 1 is 50° of the elevator.
fn px4(samples: &[Sample]) -> Vec<u8> {
    let record = |kind: u8, body: &[u8]| {
        let size = u16::try_from(body.len()).expect("short").to_le_bytes();
        [&size, &[kind][..], body].concat()
    };
    let mut log = b"ULog\x01\x12\x35\x01\0\0\0\0\0\0\0\0".to_vec();
    for (id, name, fields) in [
        (0, "vehicle_angular_velocity", "float[3] xyz"),
        (1, "vehicle_attitude", "float[4] q"),
        (2, "airspeed_validated", "float true_airspeed_m_s"),
        (3, "vehicle_torque_setpoint", "float[3] xyz"),
        (4, "vehicle_thrust_setpoint", "float[3] xyz"),
    ] {
        log.extend(record(b'F', format!("{name}:uint64_t timestamp;{fields};").as_bytes()));
        log.extend(record(b'A', &[&[0, id, 0], name.as_bytes()].concat()));
    }
    for (us, Sample { u, y, .. }) in timed(samples) {
        let (sine, cosine) = (y[3] / 2.0).sin_cos();
        for (id, values) in [
            (3, &[0.0, -u[0].to_degrees() / 50.0, 0.0][..]),
            (4, &[u[1], 0.0, 0.0]),
            (0, &[0.0, y[1], 0.0]),
            (1, &[cosine, 0.0, sine, 0.0]),
            (2, &[y[2]]),
        ] {
            log.extend(record(b'D', &[&[id, 0][..], &us.to_le_bytes(), &singles(values)].concat()));
        }
    }
    log
}

/// Fails if numbers in two reports differ by more than a hundredth of a percent plus a millionth.
fn assert_near(found: &Value, expected: &Value, name: &str) {
    match (found, expected) {
        (Value::Array(found), Value::Array(expected)) => {
            assert_eq!(found.len(), expected.len(), "{name}");
            found.iter().zip(expected).for_each(|(a, b)| assert_near(a, b, name));
        }
        (Value::Object(found), Value::Object(expected)) => {
            assert!(found.keys().eq(expected.keys()), "{name}");
            found.iter().zip(expected).for_each(|((_, a), (_, b))| assert_near(a, b, name));
        }
        (Value::Number(a), Value::Number(b)) => {
            let (a, b) = (a.as_f64().expect("a number"), b.as_f64().expect("a number"));
            assert!((a - b).abs() <= 1e-4 * b.abs() + 1e-6, "{name}: {a} is not {b}");
        }
        (found, expected) => assert_eq!(found, expected, "{name}"),
    }
}

#[test]
fn flights_of_any_autopilot_give_the_same_estimate() {
    let (desk, samples) = (Desk::new(), flight());
    let truth = desk.file("truth.csv", truth(&samples));
    let replay = |log: &str, more: &[&str]| {
        let files = ["replay", "uav", "--model", "P2", "--truth", &truth, "--json", "--log", log];
        json(&host_sim(&[&files[..], more].concat()))
    };
    let plain = replay(&desk.file("flight.csv", csv(&samples)), &[]);
    for (name, bytes, units) in [
        ("flight.bin", ardupilot(&samples), "delta_e=-0.01deg"),
        ("flight.log", ardupilot_text(&samples).into_bytes(), "delta_e=-0.01deg"),
        ("flight.ulg", px4(&samples), "delta_e=-50deg"),
    ] {
        let found = replay(&desk.file(name, bytes), &["--units", units]);
        for field in ["samples", "interval_s", "gaps", "innovations", "estimate", "accuracy"] {
            assert_near(&found[field], &plain[field], &format!("{name}: {field}"));
        }
        assert_eq!(found["warnings"], plain["warnings"], "{name}");
        let told = found["import"].to_string();
        assert!(told.contains("not in the log: alpha"), "{told}");
    }
}

#[test]
fn what_an_autopilot_does_not_log_an_option_says() {
    let (desk, samples) = (Desk::new(), flight());
    let log = desk.file("flight.bin", ardupilot(&samples));
    let replay = ["replay", "uav", "--model", "P2", "--log", &log];
    let sentence = refusal(&replay);
    let expected = "flight.bin: expected the elevator's deflection, found AETR.Elev, -4500 to 4500";
    assert!(sentence.contains(expected) && sentence.contains("--units delta_e="), "{sentence}");
    let sentence = refusal(&[&replay[..], &["--units", "t=ms,delta_e=deg"]].concat());
    assert!(sentence.contains("found one of t"), "{sentence}");
    // The same options state the units of a table.
    let degrees = csv(&samples);
    let degrees = degrees.lines().skip(1).map(|line| {
        let mut fields: Vec<f64> =
            line.split(',').map(|it| it.parse().expect("a number")).collect();
        fields[1] = fields[1].to_degrees();
        fields[5] = fields[5].to_degrees();
        let fields: Vec<_> = fields.iter().map(f64::to_string).collect();
        fields.join(",") + "\n"
    });
    let degrees = "t,delta_e,delta_t,q,V,theta\n".to_owned() + &degrees.collect::<String>();
    let (degrees, plain) =
        (desk.file("degrees.csv", degrees), desk.file("plain.csv", csv(&samples)));
    let replay = ["replay", "uav", "--model", "P2", "--json", "--log"];
    let units = ["--units", "delta_e=deg,theta=deg"];
    let found = json(&host_sim(&[&replay[..], &[&degrees], &units].concat()));
    let plain = json(&host_sim(&[&replay[..], &[&plain]].concat()));
    assert_near(&found["innovations"], &plain["innovations"], "degrees");
}
