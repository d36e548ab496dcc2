//! Estimators that sleep on the host and wake on an emulated Cortex-M4F: the rest of the stream is estimated to the bit as
//! it would have been on the host, and what they are in the end, too.
//!
//! On a machine without the tools this test says SKIPPED and passes; with `KESTIRIM_REQUIRE_TARGETS=1` it fails instead.

use anyhow::{Context, Result};
use target_bench::{CORTEX_M4F, Images, Profile};

use super::streams::{Kind, visit_all};
use super::systems::{Digest, Sample, Sleeper};
use super::{Awake, Visit, places};

/// The parts of the image's stream, and what it is to tell of each.
#[derive(Default)]
struct Parts {
    stream: Vec<u8>,
    expected: Vec<(String, [i64; 5])>,
}

impl Parts {
    fn record(&mut self, bytes: &[u8]) {
        self.stream.extend((bytes.len() as u32).to_le_bytes());
        self.stream.extend(bytes);
    }

    fn number(digest: Digest) -> i64 {
        digest.0 as i64
    }
}

impl Visit for Parts {
    fn visit<E: Sleeper>(&mut self, kind: &Kind, estimator: E, samples: &[Sample]) {
        let Some(image) = kind.image else { return };
        let places = places(kind.seed, samples.len());
        let awake = Awake::over(estimator, samples, &places);
        let stored = awake.end.iter().fold(Digest::NONE, |digest, &byte| digest.and(byte.into()));
        for (place, snapshot) in &awake.snapshots {
            self.record(&[image]);
            self.record(snapshot);
            for sample in &samples[*place..] {
                let mut room = [0; 4096];
                let bytes = postcard::to_slice(sample, &mut room).expect("there is room");
                self.record(bytes);
            }
            self.record(&[]);
            let said =
                awake.said[*place..].iter().fold(Digest::NONE, |digest, &said| digest.and(said));
            let left = (samples.len() - place) as i64;
            let length = awake.end.len() as i64;
            let told = [image.into(), left, Self::number(said), length, Self::number(stored)];
            self.expected.push((format!("{} in {} from {place}", E::NAME, E::number()), told));
        }
    }
}

#[test]
fn what_slept_on_the_host_wakes_on_a_cortex_m4f() -> Result<()> {
    let Some(images) = Images::of_snapshots(&CORTEX_M4F, Profile::Speed)? else { return Ok(()) };
    let mut parts = Parts::default();
    visit_all(&mut parts);
    let started = std::time::Instant::now();
    let output = images.run("snapshots", &parts.stream)?;
    println!("{} parts in {:.1} s", parts.expected.len(), started.elapsed().as_secs_f64());
    let told = output.rows::<5>("woken")?;
    assert_eq!(told.len(), parts.expected.len());
    for (told, (name, expected)) in told.iter().zip(&parts.expected) {
        assert_eq!(told, expected, "{name}");
    }
    let systems = parts.expected.chunks(super::CUTS).count();
    let last = parts.expected.last().context("a part")?;
    println!("{systems} estimators, {} cuts each, to the bit; the last: {}", super::CUTS, last.0);
    Ok(())
}
