//! Replays the recorded stream through a tracker, measuring every step and printing the tracker's position estimates.

use support::{Class, Meter, line, line_of_text};

use crate::stream::{Record, Stream, open};

/// A tracker of any kind and scalar, as a workload for the replay.
pub trait Tracker: Default {
    /// The name of the workload for tables.
    const NAME: &str;
    /// The name of the scalar for tables: `f32`, `q12.20` …
    const SCALAR: &str;
    /// The number of samples per reported position; one is also reported after the last sample.
    const SAMPLES_A_POSITION: u32 = 50;
    /// The type of the stream's records.
    type Record: Record;
    /// A record in the tracker's own scalar.
    type Input;

    /// Converts a record. Not measured: a driver would deliver the tracker's scalar.
    fn input(record: &Self::Record) -> Self::Input;

    /// Processes a record; this is measured.
    fn step(&mut self, input: &Self::Input) -> Class;

    /// The position estimate, m.
    fn position(&self) -> [f32; 3];
}

/// Runs a tracker over the whole stream. Prints
///
/// - `name`, `scalar` and `object_bytes` (size of the tracker);
/// - `position=µs µm µm µm` every [`Tracker::SAMPLES_A_POSITION`] samples and after the last;
/// - `samples`, and the meter's report as `step`.
pub fn run<T: Tracker>() {
    line_of_text("name", T::NAME);
    line_of_text("scalar", T::SCALAR);
    line("object_bytes", &[size_of::<T>() as i64]);

    let mut tracker = T::default();
    let mut meter = Meter::new();
    let mut samples = 0_u32;
    let mut time_us = 0;
    for (recorded_us, record) in Stream::<T::Record>::of(&open()) {
        let input = T::input(&record);
        meter.measure(|| tracker.step(&input));
        samples += 1;
        time_us = recorded_us;
        if samples.is_multiple_of(T::SAMPLES_A_POSITION) {
            tell(time_us, tracker.position());
        }
    }
    if !samples.is_multiple_of(T::SAMPLES_A_POSITION) {
        tell(time_us, tracker.position());
    }
    line("samples", &[samples.into()]);
    meter.report("step");
}

fn tell(time_us: u64, position: [f32; 3]) {
    let [x, y, z] = position.map(|metres| i64::from((metres * 1e6) as i32));
    line("position", &[time_us as i64, x, y, z]);
}
