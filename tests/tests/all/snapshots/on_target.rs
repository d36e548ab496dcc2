//! Estimators that are stored on the host and restored on an emulated Cortex-M4F: their estimates there equal those on
//! the host bit for bit, and so does their final state.
//!
//! On a machine without the tools this test prints SKIPPED and passes; with `KESTIRIM_REQUIRE_TARGETS=1` it fails
//! instead.

use std::time::Instant;

use anyhow::Result;
use kestirim_snapshot::load;
use target_bench::{CORTEX_M4F, Images, Profile};

use super::streams::{Kind, visit_all};
use super::systems::{Digest, Sample, Sleeper};
use super::{Awake, CUTS, Visit, places, stored};

/// The input of the image for a kind of estimator, and the expected output.
struct Part {
    name: String,
    stream: Vec<u8>,
    expected: Vec<[i64; 5]>,
}

impl Part {
    fn record(&mut self, bytes: &[u8]) {
        self.stream.extend((bytes.len() as u32).to_le_bytes());
        self.stream.extend(bytes);
    }

    /// Adds an estimator that is restored from this snapshot, and the host's estimates from there on.
    fn wake<E: Sleeper>(&mut self, image: u8, snapshot: &[u8], samples: &[Sample], said: &[u64]) {
        self.record(&[image]);
        self.record(snapshot);
        let mut here: E = load(snapshot).expect("what was stored");
        for sample in samples {
            let mut room = [0; 4096];
            self.record(postcard::to_slice(sample, &mut room).expect("there is room"));
            here.take(sample);
        }
        self.record(&[]);
        let digest = |numbers: &mut dyn Iterator<Item = u64>| {
            numbers.fold(Digest::NONE, Digest::and).0 as i64
        };
        let end = stored(&here);
        self.expected.push([
            image.into(),
            samples.len() as i64,
            digest(&mut said.iter().copied()),
            end.len() as i64,
            digest(&mut end.iter().map(|byte| u64::from(*byte))),
        ]);
    }
}

#[derive(Default)]
struct Parts(Vec<Part>);

impl Visit for Parts {
    fn visit<E: Sleeper>(&mut self, kind: &Kind, estimator: E, samples: &[Sample]) {
        let Some(image) = kind.image else { return };
        let awake = Awake::over(estimator, samples, &places(kind.seed, samples.len()));
        let name = format!("{} in {}", E::NAME, E::number());
        let mut part = Part { name, stream: Vec::new(), expected: Vec::new() };
        for (place, snapshot) in &awake.snapshots {
            part.wake::<E>(image, snapshot, &samples[*place..], &awake.said[*place..]);
        }
        self.0.push(part);
    }
}

#[test]
fn what_slept_on_the_host_wakes_on_a_cortex_m4f() -> Result<()> {
    let Some(images) = Images::of_snapshots(&CORTEX_M4F, Profile::Speed)? else { return Ok(()) };
    let mut parts = Parts::default();
    visit_all(&mut parts);
    for part in &parts.0 {
        let started = Instant::now();
        let output = images.run("snapshots", &part.stream)?;
        let told = output.rows::<5>("woken")?;
        assert_eq!(told, part.expected, "{}: the very bits", part.name);
        assert_eq!(told.len(), CUTS);
        println!("{}: {CUTS} times, {:.1} s", part.name, started.elapsed().as_secs_f64());
    }
    assert_eq!(parts.0.len(), 15, "all that the image knows");
    Ok(())
}
