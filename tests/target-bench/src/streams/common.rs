//! The common scenario on which filters are compared.

use std::io::{self, Write};
use std::path::Path;
use std::{env, fs};

use anyhow::{Context, Result, ensure};
use serde::Deserialize;

use super::{Encode, record, words};

/// The positions of the anchors, m.
pub const ANCHORS: [[f64; 2]; 4] = [[0.0, 0.0], [10.0, 0.0], [10.0, 8.0], [0.0, 8.0]];

/// The environment variable that makes absent data a failure if it is 1.
const REQUIRE: &str = "KESTIRIM_REQUIRE_DATA";

/// Ranges to the four anchors, every 0.1 s.
#[derive(Clone, Debug, PartialEq)]
pub struct Common {
    /// The ranges, m.
    pub ranges: Vec<[f64; 4]>,
    /// The true positions of the tag, and the states of the filter in double precision, if they are known.
    pub reference: Option<Reference>,
}

/// The reference in the scenario's file.
#[derive(Clone, Debug, PartialEq)]
pub struct Reference {
    /// The true position of the tag after each step, m.
    pub truth: Vec<[f64; 2]>,
    /// The position (m) and velocity (m/s) after each step.
    pub states: Vec<[f64; 4]>,
}

#[derive(Deserialize)]
struct File {
    ranges: Vec<[f64; 4]>,
    truth: Vec<[f64; 2]>,
    reference_states_f64: Vec<[f64; 4]>,
}

impl Common {
    /// Reads the scenario, which is a file beside the repository.
    ///
    /// Where it is absent, noise-free ranges along the same path replace it; there is then no reference, and costs that
    /// depend on outliers differ.
    ///
    /// # Errors
    /// The file is not as expected, or it is absent and `KESTIRIM_REQUIRE_DATA` is 1.
    pub fn read() -> Result<Self> {
        let manifest = Path::new(env!("CARGO_MANIFEST_DIR"));
        let file = manifest.join("../../../shared/facts/ekf4-ranges4.json");
        let Ok(text) = fs::read_to_string(&file) else {
            let required = env::var(REQUIRE).is_ok_and(|value| value == "1");
            ensure!(!required, "{REQUIRE}=1, but {} is absent", file.display());
            // Not `eprintln!`, which the test runner swallows when the test passes.
            writeln!(io::stderr(), "SKIPPED: {} is absent, its noise is left out", file.display())?;
            return Ok(Self { ranges: without_noise(), reference: None });
        };
        let File { ranges, truth, reference_states_f64: states } =
            serde_json::from_str(&text).with_context(|| format!("in {}", file.display()))?;
        Ok(Self { ranges, reference: Some(Reference { truth, states }) })
    }
}

impl Encode for Common {
    fn encode(&self) -> Vec<u8> {
        let step = |ranges: &[f64; 4]| record(100_000, words(&ranges.map(|range| range as f32)));
        self.ranges.iter().flat_map(step).collect()
    }
}

fn without_noise() -> Vec<[f64; 4]> {
    let ranges = |step: u32| {
        let angle = 0.04 * f64::from(step);
        let [x, y] = [5.0 + 3.0 * angle.cos(), 4.0 + 2.0 * angle.sin()];
        ANCHORS.map(|[a, b]| (x - a).hypot(y - b))
    };
    (1..=100).map(ranges).collect()
}
