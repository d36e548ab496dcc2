//! What a header, an option or a format claims, against what the data say.

use kestirim_import::inertial::{self, Inertial};
use kestirim_import::{Error, Format, Options, STANDARD_GRAVITY};

use crate::walk;

const DEGREE: f64 = 180.0 / std::f64::consts::PI;

/// A walk under a header, with `change` applied to each row.
fn log(header: &str, change: impl Fn([f64; 7]) -> [f64; 7]) -> Vec<u8> {
    let rows = walk::rows(20).into_iter().map(|row| {
        let fields = change(row).map(|value| format!("{value:.6}"));
        fields.join(",") + "\n"
    });
    format!("{header}\n{}", rows.collect::<String>()).into_bytes()
}

fn read(bytes: &[u8], columns: &str, units: &str) -> Result<Inertial, Error> {
    let mut options = Options::default();
    if !columns.is_empty() {
        options.columns = columns.parse()?;
    }
    if !units.is_empty() {
        options.units = units.parse()?;
    }
    inertial::read(bytes, &options)
}

fn refusal(bytes: &[u8]) -> String {
    read(bytes, "", "").map(|log| log.conclusions).expect_err("a refusal").to_string()
}

/// Whether a log is the walk, whatever the origin of its times.
fn is_the_walk(log: &Inertial) -> bool {
    let rows = walk::rows(20);
    let start = log.samples[0].time_us;
    log.samples.len() == rows.len()
        && log.samples.iter().zip(rows).all(|(sample, [t, ax, _, az, gx, _, gz])| {
            let near = |a: f64, b: f64| (a - b).abs() < 1e-3;
            let time = (sample.time_us - start) as f64 * 1e-6;
            let ([fx, _, fz], [wx, _, wz]) = (sample.specific_force, sample.angular_rate);
            (time - t).abs() < 2e-6 && near(fx, ax) && near(fz, az) && near(wx, gx) && near(wz, gz)
        })
}

#[test]
fn a_header_that_lies_is_refused() {
    const PLAIN: &str = "t,ax,ay,az,gx,gy,gz";
    let same = |row| row;
    for (header, option) in [
        ("t,ax [g],ay,az,gx,gy,gz", "--units acc="),
        ("t,ax,ay,az,gx [deg/s],gy,gz", "--units gyro="),
        ("t [ms],ax,ay,az,gx,gy,gz", "--units t="),
        (
            "Time (s),Accelerometer X (g),Accelerometer Y (g),Accelerometer Z (g),Gyroscope X (deg/s),Gyroscope Y (deg/s),Gyroscope Z (deg/s)",
            "--units acc=",
        ),
    ] {
        let sentence = refusal(&log(header, same));
        assert!(sentence.contains("expected") && sentence.contains("found"), "{sentence}");
        assert!(sentence.contains(option), "{header}: {sentence}");
    }
    let degrees = log("t,ax,ay,az,gx [rad/s],gy,gz", |[t, ax, ay, az, gx, gy, gz]| {
        [t, ax, ay, az, gx * DEGREE, gy * DEGREE, gz * DEGREE]
    });
    assert!(refusal(&degrees).contains("--units gyro="));
    assert!(is_the_walk(&read(&degrees, "", "gyro=deg/s").unwrap()));
    let gravity_free =
        log(PLAIN, |[t, ax, ay, az, gx, gy, gz]| [t, ax * 0.01, ay * 0.01, az * 0.01, gx, gy, gz]);
    assert!(refusal(&gravity_free).contains("--units acc="), "{}", refusal(&gravity_free));
}

#[test]
fn plain_names_give_way_to_the_data() {
    let bytes = log("t,ax,ay,az,gx,gy,gz", |[t, ax, ay, az, gx, gy, gz]| {
        let [ax, ay, az] = [ax, ay, az].map(|x| x / STANDARD_GRAVITY);
        [t * 1e3, ax, ay, az, gx * DEGREE, gy * DEGREE, gz * DEGREE]
    });
    let log = read(&bytes, "", "").unwrap();
    assert!(is_the_walk(&log));
    assert_eq!(
        log.conclusions[0].to_string(),
        "time in ms, acceleration in g, angular rate in °/s: from the data"
    );
}

#[test]
fn swapped_and_mirrored_axes_are_refused_by_name() {
    let swapped =
        log("t,ax,ay,az,gx,gy,gz", |[t, ax, ay, az, gx, gy, gz]| [t, ax, ay, az, gy, gx, -gz]);
    let sentence = refusal(&swapped);
    assert!(sentence.contains("fits as gy, gx, -gz"), "{sentence}");
    assert!(is_the_walk(&read(&swapped, "gx=gy,gy=gx,gz=-gz", "").unwrap()));
    let mirrored =
        log("t,ax,ay,az,gx,gy,gz", |[t, ax, ay, az, gx, gy, gz]| [t, ax, ay, az, -gx, -gy, -gz]);
    assert!(refusal(&mirrored).contains("-gx, -gy, -gz"), "{}", refusal(&mirrored));
}

#[test]
fn the_sign_of_the_accelerometer_is_an_option() {
    let bytes = log("t,ax [g],ay,az,gx [rad/s],gy,gz", |[t, ax, ay, az, gx, gy, gz]| {
        let [ax, ay, az] = [ax, ay, az].map(|x| -x / STANDARD_GRAVITY);
        [t, ax, ay, az, gx, gy, gz]
    });
    assert!(is_the_walk(&read(&bytes, "", "acc=-g").unwrap()));
}

#[test]
fn clocks_of_all_kinds_keep_their_microseconds() {
    const NAMES: &str = "AccX,AccY,AccZ,GyrX,GyrY,GyrZ";
    let rows = walk::rows(20);
    let write = |time: &dyn Fn(f64) -> String, name: &str| {
        let rows = rows.iter().map(|[t, rest @ ..]| {
            time(*t) + "," + &rest.map(|value| format!("{value:.6}")).join(",") + "\n"
        });
        format!("{name},{NAMES}\n{}", rows.collect::<String>()).into_bytes()
    };
    let of_day = |t: f64| {
        let ms = (t * 1e3).round() as u64 + 86_399_000;
        let (s, ms) = (ms / 1000 % 86_400, ms % 1000);
        format!("{:02}:{:02}:{:02}.{ms:03}", s / 3600, s / 60 % 60, s % 60)
    };
    let date = |t: f64| format!("2024-05-0{}T{}+03:00", if t < 1.0 { 1 } else { 2 }, of_day(t));
    let seconds = |t: f64| format!("{:.2}", (86_399.0 + t) % 86_400.0);
    let micros = |t: f64| ((4_294_000_000 + (t * 1e6).round() as u64) % 4_294_967_296).to_string();
    let epoch = |t: f64| format!("{:.2}", 1_700_000_000.0 + t);
    let nanoseconds = |t: f64| (1_700_000_000_000_000_000 + (t * 1e9).round() as u64).to_string();
    let below_zero = |t: f64| format!("{:.2}", t - 5.0);
    let clocks: [(&str, &dyn Fn(f64) -> String); 7] = [
        ("time", &of_day),
        ("time", &date),
        ("t", &seconds),
        ("t", &micros),
        ("timestamp", &epoch),
        ("time", &nanoseconds),
        ("t", &below_zero),
    ];
    for (i, (name, time)) in clocks.into_iter().enumerate() {
        let log = read(&write(time, name), "", "").unwrap_or_else(|error| panic!("{i}: {error}"));
        assert!(is_the_walk(&log), "clock {i}: {:?}", &log.samples[..2]);
    }
}

#[test]
fn samples_that_are_only_counted_need_their_rate() {
    let counted = log("index,ax,ay,az,gx,gy,gz", |[t, rest @ ..]| {
        let [ax, ay, az, gx, gy, gz] = rest;
        [(t * walk::RATE).round(), ax, ay, az, gx, gy, gz]
    });
    assert!(refusal(&counted).contains("--units t=100Hz"), "{}", refusal(&counted));
    assert!(is_the_walk(&read(&counted, "", "t=100Hz,acc=m/s2,gyro=rad/s").unwrap()));
    // A clock that counts samples: 1 kHz by its spacing, but the turns disagree.
    let called_time = log("t,ax,ay,az,gx,gy,gz", |[t, rest @ ..]| {
        let [ax, ay, az, gx, gy, gz] = rest;
        [(t * walk::RATE).round(), ax, ay, az, gx, gy, gz]
    });
    assert!(refusal(&called_time).contains("--units"), "{}", refusal(&called_time));
}

#[test]
fn formats_are_recognised() {
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    let si = |row| row;
    let xsens = text(log("PacketCounter,SampleTimeFine,Acc_X,Acc_Y,Acc_Z,Gyr_X,Gyr_Y,Gyr_Z", si));
    let mut lines = xsens.lines();
    let header = lines.next().unwrap().replace(',', "\t");
    let rows = lines.enumerate().map(|(i, line)| {
        let (_, rest) = line.split_once(',').unwrap();
        format!("{i}\t{}\t{}\n", i * 100, rest.replace(',', "\t"))
    });
    let xsens = format!(
        "// Start Time: Unknown\n// Sample rate: 100.0Hz\n{header}\n{}",
        rows.collect::<String>()
    );
    let artemis = log("micros,aX,aY,aZ,gX,gY,gZ,imu_degC,", |[t, ax, ay, az, gx, gy, gz]| {
        let [ax, ay, az] = [ax, ay, az].map(|x| x / STANDARD_GRAVITY * 1e3);
        [t * 1e6, ax, ay, az, gx * DEGREE, gy * DEGREE, gz * DEGREE]
    });
    let artemis = text(artemis).replace('\n', ",21.5,\n").replacen(",21.5,\n", "\n", 1);
    let razor = log("", |[t, ax, ay, az, gx, gy, gz]| {
        let [ax, ay, az] = [ax, ay, az].map(|x| x / STANDARD_GRAVITY);
        [t * 1e3, ax, ay, az, gx * DEGREE, gy * DEGREE, gz * DEGREE]
    });
    let razor = text(razor).replace(',', " ");
    for (text, format) in
        [(xsens, Format::Xsens), (artemis, Format::OpenLogArtemis), (razor, Format::Razor)]
    {
        let log = read(text.as_bytes(), "", "").unwrap_or_else(|error| panic!("{format}: {error}"));
        assert!(is_the_walk(&log), "{format}: {:?}", &log.samples[..2]);
        let told: Vec<_> = log.conclusions.iter().map(ToString::to_string).collect();
        assert!(told[0].ends_with(&format!(": {format}")), "{told:?}");
    }
}

#[test]
fn what_is_missing_is_named() {
    for (text, expected) in [
        ("t,ax,ay,az\n0,0,0,9.8\n", "expected columns of a gyroscope such as gx, gy, gz"),
        ("t,ax,ay,az,gx,gy\n0,0,0,9.8,0,0\n", "expected a column gz"),
        ("time,seconds_elapsed,z,y,x\n1,0,0,0,9.8\n", "expected columns of an accelerometer"),
        ("T,ax,ay,az,gx,gy,gz\n0,0,0,9.8,0,0,0\n", "--columns t=NAME"),
        (
            "t,ax,ax,ay,az,gx,gy,gz\n0,0,0,0,9.8,0,0,0\n",
            "line 1: expected one column ax, found two",
        ),
        ("t,ax,ay,az,gx,gy,gz\n", "expected a table of numbers, found none"),
        (
            "t,ax,ay,az,gx,gy,gz\n0,0,x,0,0,0,0\n",
            "line 2: expected a finite number in column ay, found \"x\"",
        ),
        (
            "t,ax,ay,az,gx,gy,gz\n0,0,0,9807,0,0,0\n",
            "line 2: expected at most 9807 m/s² (1000 g) in column az",
        ),
        ("t,ax,ay,az,gx,gy,gz\n0,01,0,0,9,81,0,0,0\n", "expected"),
    ] {
        let sentence = refusal(text.as_bytes());
        assert!(sentence.contains(expected), "{text}: {sentence}");
    }
}

#[test]
fn strict_refuses_the_first_damaged_line() {
    let mut bytes = log("t,ax,ay,az,gx,gy,gz", |row| row);
    bytes.extend_from_slice(b"26.5,0.1,0.2");
    let now = read(&bytes, "", "").unwrap();
    assert_eq!(
        now.damage.sentences()[0],
        format!("1 line cut off was skipped: line {}", now.rows.len() + 2)
    );
    let strict = Options { strict: true, ..Options::default() };
    let error = inertial::read(&bytes, &strict).unwrap_err().to_string();
    assert!(error.ends_with("expected 7 fields as in the header, found 3"), "{error}");
}
