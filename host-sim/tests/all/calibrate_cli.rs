//! Tests of `host-sim calibrate pedestrian`: the errors of a sensor held in twelve positions are found, and correcting
//! them makes a walk come out right.

use std::f64::consts::PI;
use std::fmt::Write;
use std::fs;

use host_sim::random::{normal3, stream};
use host_sim::systems::pedestrian::Sample;
use host_sim::systems::pedestrian::simulate::gait::Pose;
use host_sim::systems::pedestrian::simulate::kinematics::ideal_imu;
use host_sim::systems::pedestrian::simulate::scenario::Scenario;
use host_sim::systems::pedestrian::simulate::sensor::razor_text;
use kestirim_telemetry::Imu;
use nalgebra::{Matrix3, UnitQuaternion, Vector3};
use serde_json::Value;

use crate::program::{Desk, host_sim, json, refusal, rows_of, text};
use crate::sender;

const RATE_HZ: f64 = 100.0;
/// The time for which a position is held (s).
const HOLD_S: f64 = 2.5;
const TURN_S: f64 = 1.5;
/// The noise of a sample: m/s² and rad/s.
const NOISE: [f64; 2] = [0.02, 0.002];

/// The true correction of the sensor: matrix and offset of accelerometer and gyroscope. The scales are wrong by 2 %,
/// the offsets 0.3 m/s², the biases 1 °/s.
fn truth() -> [(Matrix3<f64>, Vector3<f64>); 2] {
    let degree = PI / 180.0;
    [
        (
            Matrix3::new(0.98, 0.005, -0.004, 0.0, 1.02, 0.006, 0.0, 0.0, 0.98),
            Vector3::new(0.3, -0.3, 0.3),
        ),
        (
            Matrix3::new(1.02, 0.004, -0.006, -0.005, 0.98, 0.003, 0.002, -0.004, 1.02),
            Vector3::new(degree, -degree, degree),
        ),
    ]
}

/// The upward axes of the sides of a box, and of six of its edges.
const UPS: [[f64; 3]; 12] = [
    [0.0, 0.0, 1.0],
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, -1.0],
    [-1.0, 0.0, 0.0],
    [0.0, -1.0, 0.0],
    [1.0, 1.0, 0.0],
    [0.0, 1.0, 1.0],
    [-1.0, 0.0, 1.0],
    [1.0, -1.0, 0.0],
    [0.0, -1.0, 1.0],
    [-1.0, 0.0, -1.0],
];

/// The samples of a perfect IMU held with these axes up, one after the other.
fn positions(ups: &[[f64; 3]]) -> Vec<Sample> {
    let attitudes: Vec<_> = ups
        .iter()
        .map(|up| {
            let flat = UnitQuaternion::rotation_between(&Vector3::from(*up), &Vector3::z());
            flat.unwrap_or_else(|| UnitQuaternion::from_axis_angle(&Vector3::x_axis(), PI))
        })
        .collect();
    let period = HOLD_S + TURN_S;
    let pose = |t: f64| {
        let index = ((t / period) as usize).min(attitudes.len() - 1);
        let (from, to) = (attitudes[index], attitudes[(index + 1).min(attitudes.len() - 1)]);
        let share = ((t - index as f64 * period - HOLD_S) / TURN_S).clamp(0.0, 1.0);
        let smooth = share * share * share * (10.0 - share * (15.0 - 6.0 * share));
        let turn = from.rotation_to(&to).powf(smooth);
        // A hand also moves the sensor.
        let lifted = Vector3::new(0.1, -0.05, 0.2) * (PI * smooth).sin().powi(2);
        Pose { position: lifted, attitude: turn * from }
    };
    ideal_imu(pose, ups.len() as f64 * period - TURN_S, RATE_HZ)
}

/// A log of the samples with the errors of a sensor and noise; `None` is a perfect sensor with the same noise.
fn log(samples: &[Sample], sensor: Option<[(Matrix3<f64>, Vector3<f64>); 2]>) -> String {
    let mut rng = stream(11, 0);
    let mut text = "t,ax,ay,az,gx,gy,gz\n".to_owned();
    for sample in samples {
        let mut shown = [sample.specific_force, sample.angular_rate].map(Vector3::from);
        for (i, shown) in shown.iter_mut().enumerate() {
            if let Some(sensor) = &sensor {
                let (matrix, offset) = sensor[i];
                *shown = matrix.try_inverse().expect("a sensor") * *shown + offset;
            }
            *shown += Vector3::from(normal3(&mut rng, NOISE[i]));
        }
        let [f, w] = shown;
        let t = sample.time_us as f64 * 1e-6;
        let row =
            format!("{t:.6},{:.5},{:.5},{:.5},{:.6},{:.6},{:.6}", f.x, f.y, f.z, w.x, w.y, w.z);
        writeln!(text, "{row}").expect("a string takes it");
    }
    text
}

fn calibrate<'a>(log: &'a str, out: &'a str) -> [&'a str; 6] {
    ["calibrate", "pedestrian", "--log", log, "--out", out]
}

/// The parameters found, each with value and σ.
fn parameters(report: &Value) -> Vec<(String, f64, Option<f64>)> {
    let all = report["parameters"].as_array().expect("parameters");
    all.iter()
        .map(|it| {
            let name = it["name"].as_str().expect("a name").to_owned();
            (name, it["value"].as_f64().expect("a value"), it["sigma"].as_f64())
        })
        .collect()
}

/// The true parameters, in the order of a report's.
fn true_parameters() -> Vec<f64> {
    let of = |(matrix, offset): (Matrix3<f64>, Vector3<f64>)| {
        let by_row = matrix.transpose();
        offset.iter().chain(by_row.iter()).copied().collect::<Vec<_>>()
    };
    truth().into_iter().flat_map(of).collect()
}

/// The largest σ of the parameters whose names begin with `begin`.
fn largest(report: &Value, begin: &str) -> f64 {
    let found = parameters(report);
    let of = found.iter().filter(|(name, ..)| name.starts_with(begin));
    of.filter_map(|(_, _, sigma)| *sigma).fold(0.0, f64::max)
}

#[test]
fn more_positions_tell_more() {
    let desk = Desk::new();
    let out = desk.named("calibration.csv");
    let mut before = f64::INFINITY;
    for (count, said) in [
        (6, "offset and scale"),
        (9, "offset, scale and misalignment"),
        (12, "offset, scale and misalignment"),
    ] {
        let log = desk.file("log.csv", log(&positions(&UPS[..count]), Some(truth())));
        let report = json(&host_sim(&[&calibrate(&log, &out)[..], &["--json"]].concat()));
        assert_eq!(
            (report["poses"].as_u64(), &report["accelerometer"]),
            (Some(count as u64), &said.into())
        );
        let offset = largest(&report, "acc_offset");
        let entry = ["acc_x", "acc_y", "acc_z"].map(|begin| largest(&report, begin));
        let (entry, bias) = (entry.into_iter().fold(0.0, f64::max), largest(&report, "gyro_bias"));
        let turned = ["gyro_x", "gyro_y", "gyro_z"].map(|begin| largest(&report, begin));
        let turned = turned.into_iter().fold(0.0, f64::max);
        println!(
            "{count} positions: offset ± {offset:.4} m/s², accelerometer's matrix ± {entry:.5}, \
             bias ± {bias:.5} rad/s, gyroscope's matrix ± {turned:.5} ({})",
            report["gyroscope"]
        );
        assert!(bias < before, "{bias}");
        before = bias;
    }
}

/// A log whose rates are changed.
fn with_rates(log: &str, change: impl Fn(f64) -> String) -> String {
    let mut changed = String::new();
    for (index, line) in log.lines().enumerate() {
        let fields: Vec<&str> = line.split(',').collect();
        if index == 0 {
            writeln!(changed, "{line}").expect("a string takes it");
            continue;
        }
        let rates = fields[4..].iter().map(|field| change(field.parse().expect("a rate")));
        let rates: Vec<_> = rates.collect();
        writeln!(changed, "{},{}", fields[..4].join(","), rates.join(",")).expect("the same");
    }
    changed
}

#[test]
fn turns_beyond_the_range_are_left_out() {
    // A turn by 120° is faster than the range. As in 16 bits, its ends are not equally far.
    let desk = Desk::new();
    let plain = log(&positions(&UPS), Some(truth()));
    let clipped = with_rates(&plain, |rate| rate.clamp(-2.2001, 2.2).to_string());
    let (log, out) = (desk.file("clipped.csv", clipped), desk.named("calibration.csv"));
    let report = json(&host_sim(&[&calibrate(&log, &out)[..], &["--json"]].concat()));
    let turns = report["turns"].as_u64().expect("a number");
    assert!((3..11).contains(&turns), "{report}");
    let told = report["warnings"].to_string();
    let expected = format!("in {} of 11 turns an axis reached the end of its range", 11 - turns);
    assert!(told.contains(&expected), "{told}");
    let found = parameters(&report);
    let mut of_gyroscope = 0;
    for ((name, value, sigma), truth) in found.iter().zip(true_parameters()) {
        let Some(sigma) = sigma else { continue };
        assert!((value - truth).abs() < 4.0 * sigma, "{name}: {value} ± {sigma}, {truth}");
        of_gyroscope += usize::from(name.starts_with("gyro_"));
    }
    assert!(of_gyroscope >= 6, "{report}");
    // Rates with two digits stay at the largest value of a turn for some samples, too.
    let coarse = desk.file("coarse.csv", with_rates(&plain, |rate| format!("{rate:.2}")));
    let report = json(&host_sim(&[&calibrate(&coarse, &out)[..], &["--json"]].concat()));
    assert_eq!(report["turns"].as_u64(), Some(11), "{report}");
}

#[test]
fn twelve_positions_tell_what_is_wrong_and_a_walk_comes_out_right() {
    let desk = Desk::new();
    let positions = desk.file("positions.csv", log(&positions(&UPS), Some(truth())));
    let out = desk.named("calibration.csv");
    let report = json(&host_sim(&[&calibrate(&positions, &out)[..], &["--json"]].concat()));
    assert_eq!((report["poses"].as_u64(), report["turns"].as_u64()), (Some(12), Some(11)));
    assert_eq!(report["advice"], Value::Array(vec![]), "{report}");
    assert_eq!(report["warnings"], Value::Array(vec![]), "{report}");
    let found = parameters(&report);
    assert_eq!(found.len(), 24);
    for ((name, value, sigma), truth) in found.iter().zip(true_parameters()) {
        match sigma {
            Some(sigma) => {
                assert!((value - truth).abs() < 3.0 * sigma, "{name}: {value} ± {sigma}, {truth}");
                assert!(*sigma < 0.02, "{name}: ± {sigma}");
            }
            None => assert!(name.starts_with("acc_") && *value == 0.0, "{name}"),
        }
    }
    assert_eq!(found.iter().filter(|(_, _, sigma)| sigma.is_none()).count(), 3);
    let firmware = report["firmware"].as_str().expect("firmware");
    assert!(firmware.contains("let calibration = Calibration::<f32> {"), "{firmware}");
    let written = fs::read_to_string(&out).expect("a calibration");
    assert!(written.starts_with("parameter,value,sigma,unit\nacc_offset_x,0."), "{written}");
    let table = host_sim(&calibrate(&positions, &out));
    assert!(
        text(&table.stdout).contains("bias, scale and misalignment"),
        "{}",
        text(&table.stdout)
    );

    // The same walk with a perfect sensor, with the wrong one, and with the wrong one calibrated.
    let walk = Scenario::draw_rounds(&mut stream(4, 0), 3).ideal_imu(RATE_HZ);
    let plain = desk.file("plain.csv", log(&walk, None));
    let wrong = desk.file("wrong.csv", log(&walk, Some(truth())));
    let track = |log: &str, more: &[&str]| {
        let track = desk.named("track.csv");
        let replay = ["replay", "pedestrian", "--log", log, "--track", &track];
        let output = host_sim(&[&replay[..], more].concat());
        assert!(output.status.success(), "{}", text(&output.stderr));
        let (_, rows) = rows_of::<4>(&track);
        rows.into_iter().map(|([_, x, y, z], _)| vec![x, y, z]).collect::<Vec<_>>()
    };
    let plain = track(&plain, &[]);
    let apart = |other: &[Vec<f64>]| {
        assert_eq!(plain.len(), other.len());
        let square = |(a, b): (&Vec<f64>, &Vec<f64>)| {
            a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>()
        };
        (plain.iter().zip(other).map(square).sum::<f64>() / plain.len() as f64).sqrt()
    };
    let without = apart(&track(&wrong, &[]));
    let with = apart(&track(&wrong, &["--calibration", &out]));
    println!("off the walk of a perfect sensor: {without:.3} m, calibrated {with:.3} m");
    assert!(with < 0.25 * without, "{with} m, without {without} m");
    // The check and the firmware configuration work with a calibration as well.
    let check =
        json(&host_sim(&["check", "pedestrian", "--json", "--log", &wrong, "--calibration", &out]));
    assert_eq!(check["system"], "pedestrian");
}

#[test]
fn six_sides_tell_offset_and_scale_and_what_is_missing() {
    let desk = Desk::new();
    let sides = desk.file("sides.csv", log(&positions(&UPS[..6]), Some(truth())));
    let out = desk.named("calibration.csv");
    let report = json(&host_sim(&[&calibrate(&sides, &out)[..], &["--json"]].concat()));
    assert_eq!(report["accelerometer"], "offset and scale");
    assert!(report["advice"].to_string().contains("edges"), "{report}");
    let found = parameters(&report);
    for (place, name) in [(0, "acc_offset_x"), (3, "acc_xx"), (12, "gyro_bias_x"), (15, "gyro_xx")]
    {
        assert_eq!(found[place].0, name);
        let (value, sigma) = (found[place].1, found[place].2.expect("a σ"));
        let truth = true_parameters()[place];
        assert!((value - truth).abs() < 3.0 * sigma, "{name}: {value} ± {sigma}, {truth}");
    }
}

#[test]
fn a_log_of_two_digits_serves_as_well() {
    let desk = Desk::new();
    let mut rng = stream(3, 0);
    let [(matrix, offset), _] = truth();
    let mut samples = positions(&UPS);
    for sample in &mut samples {
        let force = matrix.try_inverse().expect("a sensor") * Vector3::from(sample.specific_force);
        let force = force + offset + Vector3::from(normal3(&mut rng, NOISE[0]));
        sample.specific_force = force.into();
    }
    let positions = desk.file("razor.txt", razor_text(&samples));
    let report =
        json(&host_sim(&[&calibrate(&positions, &desk.named("c.csv"))[..], &["--json"]].concat()));
    assert_eq!(
        (report["poses"].as_u64(), report["turns"].as_u64()),
        (Some(12), Some(11)),
        "{report}"
    );
    for ((name, value, sigma), truth) in parameters(&report).iter().zip(true_parameters()).take(12)
    {
        let sigma = sigma.unwrap_or(1e-9);
        assert!(
            (value - truth).abs() < 3.0 * sigma.max(1e-9),
            "{name}: {value} ± {sigma}, {truth}"
        );
    }
}

#[test]
fn what_does_not_tell_is_refused_with_what_to_do() {
    let desk = Desk::new();
    let out = desk.named("calibration.csv");
    let four = desk.file("four.csv", log(&positions(&UPS[..4]), Some(truth())));
    let sentence = refusal(&calibrate(&four, &out));
    assert!(
        sentence.contains("at least 6 positions held still for 1 s or more, found 4"),
        "{sentence}"
    );
    let next = "turn the sensor so that x points down, y down, and hold it 2 s each time";
    assert!(sentence.contains(next), "{sentence}");
    let flat: Vec<_> =
        (0..8).map(|i| [0.2 * f64::from(i % 3), 0.2 * f64::from(i / 3), 1.0]).collect();
    let flat = desk.file("flat.csv", log(&positions(&flat), Some(truth())));
    let sentence = refusal(&calibrate(&flat, &out));
    assert!(sentence.contains("too much alike: turn the sensor so that x points up"), "{sentence}");
    let walk = Scenario::draw(&mut stream(4, 0)).ideal_imu(RATE_HZ);
    let walk = desk.file("walk.csv", log(&walk, None));
    assert!(refusal(&calibrate(&walk, &out)).contains("positions held still"));
    assert!(!desk.path("calibration.csv").exists());
    let sentence = refusal(&calibrate(&walk, &walk));
    assert!(sentence.contains("would overwrite"), "{sentence}");
    let bad = desk.file("bad.csv", "parameter,value\nacc_xx,1\n");
    let replay = ["replay", "pedestrian", "--log", &walk, "--calibration", &bad];
    assert!(refusal(&replay).contains("expected a parameter acc_offset_x, found none"));
}

/// The samples as frames of a sender.
fn frames_of(samples: &[Sample]) -> Vec<u8> {
    sender::frames(samples.iter().map(|sample| Imu {
        time_us: sample.time_us,
        specific_force: sample.specific_force.map(|axis| axis as f32),
        angular_rate: sample.angular_rate.map(|axis| axis as f32),
    }))
}

/// The samples in a log.
fn samples_of(log: &str) -> Vec<Sample> {
    let row = |line: &str| {
        let values: Vec<f64> = line.split(',').map(|it| it.parse().expect("a number")).collect();
        Sample {
            time_us: (values[0] * 1e6).round() as u64,
            specific_force: [values[1], values[2], values[3]],
            angular_rate: [values[4], values[5], values[6]],
        }
    };
    log.lines().skip(1).map(row).collect()
}

#[test]
fn a_stream_of_positions_gives_the_calibration_of_its_log() {
    let desk = Desk::new();
    let shown = log(&positions(&UPS), Some(truth()));
    let (from, of_log) = (desk.file("positions.csv", &shown), desk.named("log.csv"));
    json(&host_sim(&[&calibrate(&from, &of_log)[..], &["--json"]].concat()));
    let samples = samples_of(&shown);
    let stream = desk.file("positions.frames", frames_of(&samples));
    let out = desk.named("stream.csv");
    let watch = ["live", "--system", "pedestrian", "--headless", "--calibrate", &out, "--file"];
    let output = host_sim(&[&watch[..], &[&stream, "--json"]].concat());
    let told = text(&output.stderr).to_owned();
    assert_eq!(json(&output)["counts"]["taken"], samples.len());
    assert!(told.contains("calibration of 12 positions"), "{told}");
    let values = |path: &str| -> Vec<f64> {
        let text = fs::read_to_string(path).expect("a calibration");
        let value = |line: &str| line.split(',').nth(1).and_then(|it| it.parse().ok());
        text.lines().skip(1).map(|line| value(line).expect("a value")).collect()
    };
    // Single precision represents the log to a ten-thousandth of the effect of the sensor's noise.
    for (of_stream, of_log) in values(&out).iter().zip(values(&of_log)) {
        assert!((of_stream - of_log).abs() < 1e-5, "{of_stream} is not {of_log}");
    }
    // Half of the positions are too few: the missing ones are named, and nothing is written.
    let half = desk.file("half.frames", frames_of(&samples[..samples.len() / 4]));
    let missing = desk.named("missing.csv");
    let watch = ["live", "--system", "pedestrian", "--headless", "--calibrate", &missing];
    let output = host_sim(&[&watch[..], &["--file", &half]].concat());
    assert_eq!(output.status.code(), Some(2));
    let sentence = text(&output.stderr);
    assert!(sentence.contains("no calibration: expected at least 6"), "{sentence}");
    assert!(sentence.contains("z down"), "{sentence}");
    assert!(!desk.path("missing.csv").exists());
    let beside = refusal(&[&watch[..], &["--file", &half, "--tracker", "lite"]].concat());
    assert!(beside.contains("follows nobody"), "{beside}");
}
