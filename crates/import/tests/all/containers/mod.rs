//! Binary and archive files: the walk, written in each format, is read as from plain text; what is damaged, missing or
//! ambiguous is reported or refused.

mod ardupilot;
mod flights;
mod imu;
mod levels;
mod mcap;
mod openshoe;
mod phones;
mod px4;
mod ranges;
mod rosbag;

use kestirim_import::inertial::{self, Inertial, Sample};
use kestirim_import::{Error, Options};
use rand_core::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use crate::{mutations, walk};

/// The number of strides of the walk.
const STRIDES: usize = 8;
/// The rounding error of a four-byte number of at most 100.
const SINGLE: f64 = 1e-5;

fn read(bytes: &[u8]) -> Result<Inertial, Error> {
    inertial::read(bytes, &Options::default())
}

fn read_topic(bytes: &[u8], topic: &str) -> Result<Inertial, Error> {
    inertial::read(bytes, &Options { topic: Some(topic.to_owned()), ..Options::default() })
}

fn refusal(bytes: &[u8]) -> String {
    read(bytes).map(|log| log.conclusions).expect_err("a refusal").to_string()
}

fn told(log: &Inertial) -> String {
    log.conclusions.iter().map(ToString::to_string).collect::<Vec<_>>().join("; ")
}

/// The samples as read from plain text.
fn plain(rows: &[[f64; 7]]) -> Vec<Sample> {
    let rows = rows.iter().map(|row| row.map(|value| value.to_string()).join(",") + "\n");
    let text = "t,ax,ay,az,gx,gy,gz\n".to_owned() + &rows.collect::<String>();
    read(text.as_bytes()).expect("plain text").samples
}

/// Fails if samples differ by more than `tolerance`, or times by more than a microsecond; the origin of times may
/// differ.
fn assert_same(log: &Inertial, expected: &[Sample], tolerance: f64) {
    assert_eq!(log.samples.len(), expected.len());
    let offset = log.samples[0].time_us - expected[0].time_us;
    for (now, then) in log.samples.iter().zip(expected) {
        assert!((now.time_us - offset).abs_diff(then.time_us) <= 1, "{now:?} is not {then:?}");
        let near = |a: [f64; 3], b: [f64; 3]| (0..3).all(|i| (a[i] - b[i]).abs() <= tolerance);
        assert!(near(now.specific_force, then.specific_force), "{now:?} is not {then:?}");
        assert!(near(now.angular_rate, then.angular_rate), "{now:?} is not {then:?}");
    }
}

/// Damages a file once for each seed: nothing panics or hangs, and what is read is in order.
fn survives(file: &[u8], seeds: std::ops::Range<u64>) {
    survives_reading(file, seeds, mutations::read);
}

/// Damages a file once for each seed and reads it with `read`.
fn survives_reading(file: &[u8], seeds: std::ops::Range<u64>, read: fn(&[u8], u64)) {
    const LENGTHS: [&[u8]; 4] =
        [b"\xff\xff\xff\xff", b"\xff\xff\xff\x7f\0\0\0\0", b"\0\0\0\0", b"\xff"];
    for seed in seeds {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
        let mut log = file.to_vec();
        for _ in 0..=mutations::pick(&mut random, 4) {
            // Half of the damage is done where the file describes its contents.
            let beginning = mutations::pick(&mut random, 2) == 0;
            let end = if beginning { log.len().min(600) } else { log.len() };
            let mut part = log[..end].to_vec();
            if random.next_u64() % 4 == 0 {
                let length = LENGTHS[mutations::pick(&mut random, LENGTHS.len())];
                let at = mutations::pick(&mut random, end);
                for (byte, new) in part.iter_mut().skip(at).zip(length) {
                    *byte = *new;
                }
            } else {
                mutations::mutate(&mut random, &mut part);
            }
            // If the beginning is cut, so is the file.
            let rest = if part.len() + 100 < end { Vec::new() } else { log[end..].to_vec() };
            log = [part, rest].concat();
        }
        read(&log, seed);
    }
}

/// The number of seeds in an ordinary run.
const SEEDS: u64 = 300;
/// The number of seeds in a long run:
/// `cargo test --release -p kestirim-import --test all -- --ignored harm --test-threads 1`.
const MANY_SEEDS: u64 = 100_000;

/// The peak memory of this process so far, bytes; `None` where the system does not tell.
fn peak() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmPeak"))?;
    let kibibytes: u64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kibibytes * 1024)
}

/// Damages a file with many seeds, which must not take more than twenty times its size in addition to what the process
/// has anyway.
fn survives_much(file: &[u8]) {
    survives(file, 0..1);
    let before = peak();
    survives(file, 0..MANY_SEEDS);
    if let (Some(before), Some(after)) = (before, peak()) {
        let most = before + 20 * file.len() as u64 + (1 << 20);
        assert!(
            after <= most,
            "{} bytes beyond {before} for a file of {}",
            after - before,
            file.len()
        );
    }
}

/// A shorter walk for the damage tests.
fn short() -> Vec<[f64; 7]> {
    walk::rows(2)
}
