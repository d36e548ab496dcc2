//! The harness alone: the reference for the flash size of a replaying image.

#![no_std]
#![no_main]

use images::replay::{Tracker, run};
use images::stream::Sample;
use support::{Class, image};

/// A tracker that returns its last input, so that all of the replay is linked.
#[derive(Default)]
struct Nothing([f32; 3]);

impl Tracker for Nothing {
    const NAME: &str = "empty";
    const SCALAR: &str = "f32";
    type Record = Sample;
    type Input = Sample;

    fn input(sample: &Sample) -> Sample {
        *sample
    }

    fn step(&mut self, input: &Sample) -> Class {
        self.0 = input.specific_force;
        Class::Predict
    }

    fn position(&self) -> [f32; 3] {
        self.0
    }
}

image!(run::<Nothing>);
