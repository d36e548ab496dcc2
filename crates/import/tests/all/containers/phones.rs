//! Files that telephones export.

use std::io::{Cursor, Write};

use kestirim_import::{Format, Options, STANDARD_GRAVITY, inertial};
use zip::write::{SimpleFileOptions, ZipWriter};

use super::{
    SEEDS, assert_same, plain, read, read_topic, refusal, short, survives, survives_much, told,
};
use crate::walk;

/// A zip file of texts.
fn zip(texts: &[(&str, String)]) -> Vec<u8> {
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, text) in texts {
        zip.start_file(*name, SimpleFileOptions::default()).unwrap();
        zip.write_all(text.as_bytes()).unwrap();
    }
    zip.finish().unwrap().into_inner()
}

/// The rows of a table.
fn table(rows: &[[f64; 7]], line: impl Fn(&[f64; 7]) -> String) -> String {
    rows.iter().map(line).collect()
}

/// One sensor's text of phyphox.
fn phyphox(header: &str, separator: &str, comma: bool, rows: &[[f64; 7]], first: usize) -> String {
    let rows = table(rows, |row| {
        let fields =
            [row[0], row[first], row[first + 1], row[first + 2]].map(|x| format!("{x:.15E}"));
        let line = fields.join(separator);
        (if comma { line.replace('.', ",") } else { line }) + "\n"
    });
    header.replace(',', separator) + "\n" + &rows
}

const ACCELERATION: &str =
    r#""Time (s)","Acceleration x (m/s^2)","Acceleration y (m/s^2)","Acceleration z (m/s^2)""#;
const RATE: &str =
    r#""Time (s)","Gyroscope x (rad/s)","Gyroscope y (rad/s)","Gyroscope z (rad/s)""#;
const PLAIN_ACCELERATION: &str = r#""Time (s)","X (m/s^2)","Y (m/s^2)","Z (m/s^2)""#;
const PLAIN_RATE: &str = r#""Time (s)","X (rad/s)","Y (rad/s)","Z (rad/s)""#;

#[test]
fn phyphox_is_the_walk() {
    let rows = walk::rows(super::STRIDES);
    for (separator, comma, acceleration, rate) in [
        (",", false, ACCELERATION, RATE),
        (";", true, PLAIN_ACCELERATION, PLAIN_RATE),
        ("\t", false, PLAIN_ACCELERATION, PLAIN_RATE),
        ("\t", true, ACCELERATION, RATE),
    ] {
        let log = read(&zip(&[
            ("Accelerometer.csv", phyphox(acceleration, separator, comma, &rows, 1)),
            ("Gyroscope.csv", phyphox(rate, separator, comma, &rows, 4)),
            ("Linear Accelerometer.csv", phyphox(acceleration, separator, comma, &rows[..3], 1)),
            ("meta/device.csv", "\"property\",\"value\"\n\"version\",\"1.2.0\"\n".to_owned()),
        ]))
        .unwrap();
        assert_same(&log, &plain(&rows), 1e-12);
        assert_eq!(
            told(&log),
            "time in s, acceleration in m/s², angular rate in rad/s: phyphox; \
             acceleration interpolated onto the times of the angular rate: phyphox"
        );
    }
}

/// One sensor's text of Sensor Logger.
fn logger(rows: &[[f64; 7]], first: usize, scale: f64) -> String {
    let rows = table(rows, |row| {
        let time = 1_700_000_000_000_000_000 + (row[0] * 1e9).round() as u64;
        let [x, y, z] = [0, 1, 2].map(|axis| row[first + axis] * scale);
        format!("{time},{},{z},{y},{x}\n", row[0])
    });
    "time,seconds_elapsed,z,y,x\n".to_owned() + &rows
}

fn metadata(platform: &str, standard: bool) -> (&'static str, String) {
    let text = format!(
        "version,device name,recording epoch time,recording time,recording timezone,platform,appVersion,device id,sensors,\
         sampleRateMs,standardisation,platform version\n\
         3,\"Phone, my\",1700000000000,2023-11-14_22-13-20,Europe/Istanbul,{platform},1.50,x,Accelerometer|Gyroscope,10|10,\
         {standard},17\n"
    );
    ("Metadata.csv", text)
}

#[test]
fn sensor_logger_of_android_is_the_walk() {
    let rows = walk::rows(super::STRIDES);
    let linear: Vec<_> = rows.iter().map(|row| row.map(|x| x * 0.01)).collect();
    let mut texts = vec![
        ("walk/TotalAcceleration.csv", logger(&rows, 1, 1.0)),
        ("walk/Accelerometer.csv", logger(&linear, 1, 1.0)),
        ("walk/Gyroscope.csv", logger(&rows, 4, 1.0)),
        ("__MACOSX/walk/._Gyroscope.csv", "\0".to_owned()),
    ];
    let without = read(&zip(&texts)).unwrap();
    assert!(
        told(&without).contains("for want of Metadata.csv: Sensor Logger"),
        "{}",
        told(&without)
    );
    texts.push(metadata("android", false));
    let log = read(&zip(&texts)).unwrap();
    assert_same(&log, &plain(&rows), 1e-12);
    assert_eq!(without.samples, log.samples);
    assert_eq!(
        told(&log),
        "time in ns, acceleration in m/s², angular rate in rad/s: Sensor Logger; \
         acceleration from TotalAcceleration.csv: Sensor Logger; \
         acceleration interpolated onto the times of the angular rate: Sensor Logger"
    );
    assert_eq!(log.samples[0].time_us, 1_700_000_000_000_000);
}

#[test]
fn sensor_logger_of_ios_is_the_walk() {
    let rows = walk::rows(super::STRIDES);
    let half: Vec<_> = rows
        .iter()
        .map(|row| [row[0], row[1] / 2.0, row[2] / 2.0, row[3] / 2.0, 0.0, 0.0, 0.0])
        .collect();
    let gyroscope = ("Gyroscope.csv", logger(&rows, 4, 1.0));
    for (standard, sign) in [(false, -1.0), (true, 1.0)] {
        let log = read(&zip(&[
            ("Accelerometer.csv", logger(&half, 1, sign)),
            ("Gravity.csv", logger(&half, 1, sign)),
            gyroscope.clone(),
            metadata("ios", standard),
        ]));
        assert_same(&log.unwrap(), &plain(&rows), 1e-12);
    }
    let raw = ("AccelerometerUncalibrated.csv", logger(&rows, 1, -1.0 / STANDARD_GRAVITY));
    let log = read(&zip(&[raw.clone(), gyroscope.clone(), metadata("ios", false)])).unwrap();
    assert_same(&log, &plain(&rows), 1e-12);
    // Without metadata that tell the unit an option does.
    let unknown = zip(&[raw, gyroscope]);
    assert!(
        refusal(&unknown).contains("expected Metadata.csv, which tells the unit"),
        "{}",
        refusal(&unknown)
    );
    let options = Options { units: "acc=-g".parse().unwrap(), ..Options::default() };
    assert_same(&inertial::read(&unknown, &options).unwrap(), &plain(&rows), 1e-12);
}

#[test]
fn sensors_that_begin_and_end_apart_are_interpolated() {
    let rows = walk::rows(super::STRIDES);
    let later: Vec<_> = rows[10..rows.len() - 5]
        .iter()
        .map(|row| {
            let t = row[0] + 0.003;
            [t, t / 8.0, t / -4.0, 9.81, 0.0, 0.0, 0.0]
        })
        .filter(|row| !(3.0..3.2).contains(&row[0]))
        .collect();
    let log = read(&zip(&[
        ("Accelerometer.csv", phyphox(ACCELERATION, ",", false, &later, 1)),
        (
            "Gyroscope.csv",
            phyphox(
                RATE,
                ",",
                false,
                &rows.iter().map(|row| [row[0], 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]).collect::<Vec<_>>(),
                4,
            ),
        ),
    ]))
    .unwrap();
    // 11 at the beginning, 5 at the end, and the rest in a gap of 0.2 s.
    assert!(told(&log).contains("the times of the angular rate, 37 of which"), "{}", told(&log));
    for sample in &log.samples {
        let t = sample.time_us as f64 * 1e-6;
        assert!((sample.specific_force[0] - t / 8.0).abs() < 1e-9, "{sample:?}");
        assert!(!(3.0..3.19).contains(&t), "{sample:?}");
    }
}

#[test]
fn what_is_missing_is_named() {
    let rows = short();
    let [acceleration, rate] =
        [phyphox(ACCELERATION, ",", false, &rows, 1), phyphox(RATE, ",", false, &rows, 4)];
    let gyroscope = ("Gyroscope.csv", logger(&rows, 4, 1.0));
    for (texts, expected) in [
        (
            vec![
                ("Linear Accelerometer.csv", acceleration.clone()),
                ("Gyroscope.csv", rate.clone()),
            ],
            "expected Accelerometer.csv, with gravity, beside Gyroscope.csv, found Linear Accelerometer.csv, Gyroscope.csv",
        ),
        (
            vec![("Accelerometer.csv", logger(&rows, 1, 1.0)), gyroscope.clone()],
            "expected TotalAcceleration.csv, or Gravity.csv beside Accelerometer.csv, which is without gravity, found",
        ),
        (vec![("Raw Data.csv", acceleration.clone())], "expected Gyroscope.csv in the zip file"),
        (
            vec![("a/Gyroscope.csv", rate.clone()), ("b/Gyroscope.csv", rate.clone())],
            "several files Gyroscope.csv",
        ),
        (
            vec![("Gyroscope.csv", "a,b\n1,2\n".to_owned())],
            "expected a column seconds_elapsed (Sensor Logger) or Time (s)",
        ),
        (
            vec![],
            "expected Gyroscope.csv in the zip file, as phyphox and Sensor Logger name it, found none",
        ),
    ] {
        let sentence = refusal(&zip(&texts));
        assert!(sentence.contains(expected), "{sentence}");
    }
    let whole = zip(&[("Accelerometer.csv", acceleration), ("Gyroscope.csv", rate)]);
    assert!(
        refusal(&whole[..whole.len() / 2]).starts_with("expected a whole zip file, found one with")
    );
    let error = read_topic(&whole, "1").unwrap_err().to_string();
    assert_eq!(error, "expected a file of several sensors for --topic, found a zip file of texts");
    let options = Options { format: Some(Format::Px4), ..Options::default() };
    let error = inertial::read(&whole, &options).unwrap_err().to_string();
    assert_eq!(error, "expected PX4 ULog as --format says, found phyphox");
}

#[test]
fn damaged_lines_of_both_texts_are_counted() {
    let rows = walk::rows(super::STRIDES);
    let hurt = |text: &str, at: usize, line: &str| {
        let mut lines: Vec<_> = text.lines().collect();
        lines[at] = line;
        lines.join("\n")
    };
    let log = read(&zip(&[
        ("TotalAcceleration.csv", hurt(&logger(&rows, 1, 1.0), 100, "17,3")),
        ("Gyroscope.csv", hurt(&logger(&rows, 4, 1.0), 200, "1700000002000000000,2,x,0,0")),
        metadata("android", false),
    ]))
    .unwrap();
    assert_eq!(
        log.damage.sentences(),
        [
            "1 line without a number where one is needed was skipped: line 201 of Gyroscope.csv",
            "1 line torn (another number of fields) was skipped: line 101 of TotalAcceleration.csv",
        ]
    );
    assert_eq!(log.samples.len(), rows.len() - 1);
}

#[test]
fn what_unpacks_to_too_much_is_refused() {
    const EXPECTED: &str = "expected a file that unpacks to at most 1 GiB, found a larger one";
    let mut bytes = whole();
    let entries: Vec<_> =
        (0..bytes.len()).filter(|&at| bytes[at..].starts_with(b"PK\x01\x02")).collect();
    for entry in entries {
        bytes[entry + 24..entry + 28].copy_from_slice(&0x7000_0000_u32.to_le_bytes());
    }
    assert_eq!(refusal(&bytes), EXPECTED);
}

fn whole() -> Vec<u8> {
    let rows = short();
    zip(&[
        ("TotalAcceleration.csv", logger(&rows, 1, 1.0)),
        ("Gyroscope.csv", logger(&rows, 4, 1.0)),
        metadata("android", false),
    ])
}

#[test]
fn damaged_files_do_no_harm() {
    survives(&whole(), 0..SEEDS);
}

#[test]
#[ignore = "minutes"]
fn much_harm() {
    survives_much(&whole());
}
