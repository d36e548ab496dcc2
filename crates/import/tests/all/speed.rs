//! The time that a long log takes, compared with the previous reader.

use std::fmt::Write as _;
use std::time::Instant;

use kestirim_import::Options;
use kestirim_import::inertial;

use crate::{plain, walk};

const ROWS: usize = 2_800_000;

/// Run with `cargo test --release -p kestirim-import --test all -- --ignored --nocapture long_log`.
#[test]
#[ignore = "a measurement of some seconds, which needs an optimised build"]
fn a_long_log_takes_little_longer_than_before() {
    let walk = walk::rows(300);
    let mut text = "t,ax,ay,az,gx,gy,gz\n".to_owned();
    for i in 0..ROWS {
        let [_, ax, ay, az, gx, gy, gz] = walk[i % walk.len()];
        let t = i as f64 / walk::RATE;
        let _ = writeln!(text, "{t:.6},{ax:.5},{ay:.5},{az:.5},{gx:.7},{gy:.7},{gz:.7}");
    }
    let mut best = [f64::INFINITY; 2];
    for _ in 0..3 {
        let start = Instant::now();
        let before = plain::read(text.as_bytes()).expect("a plain log");
        best[0] = best[0].min(start.elapsed().as_secs_f64());
        let start = Instant::now();
        let now = inertial::read(text.as_bytes(), &Options::default()).expect("a plain log");
        best[1] = best[1].min(start.elapsed().as_secs_f64());
        assert_eq!(now.samples, before.samples);
    }
    let ratio = best[1] / best[0];
    println!("before {:.2} s, now {:.2} s: {ratio:.2} times", best[0], best[1]);
    assert!(ratio <= 1.3, "{ratio}");
}
