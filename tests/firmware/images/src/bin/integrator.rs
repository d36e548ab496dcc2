//! The simplest tracker: integrates specific force twice, in single precision. The host computes the same sums, which
//! verifies the path from a stored stream to a reported position.

#![no_std]
#![no_main]

use images::replay::{Tracker, run};
use images::stream::Sample;
use support::{Class, image};

#[derive(Default)]
struct Integrator {
    time_us: u64,
    velocity: [f32; 3],
    position: [f32; 3],
}

impl Tracker for Integrator {
    const NAME: &str = "integrator";
    const SCALAR: &str = "f32";
    type Record = Sample;
    type Input = Sample;

    fn input(sample: &Sample) -> Sample {
        *sample
    }

    fn step(&mut self, input: &Sample) -> Class {
        let seconds = (input.time_us - self.time_us) as u32 as f32 * 1e-6;
        self.time_us = input.time_us;
        for ((position, velocity), force) in
            self.position.iter_mut().zip(&mut self.velocity).zip(input.specific_force)
        {
            *velocity += force * seconds;
            *position += *velocity * seconds;
        }
        Class::Predict
    }

    fn position(&self) -> [f32; 3] {
        self.position
    }
}

image!(run::<Integrator>);
