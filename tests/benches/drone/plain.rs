//! The filter of `plain.c` in plain Rust.

use std::f64::consts::{PI, TAU};

use crate::{L, Stop};

#[derive(Clone, Copy)]
struct Particle {
    x: f64,
    y: f64,
    weight: f64,
}

pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn new() -> Self {
        Self(88_172_645_463_325_252)
    }

    pub(crate) fn uniform(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 * 2.0_f64.powi(-53)
    }
}

fn density(deviation: f64, sigma: f64) -> f64 {
    let z = deviation / sigma;
    (-0.5 * z * z).exp() / (sigma * TAU.sqrt())
}

/// Eqs 2.1 and 2.7 to 2.11 in the urban environment, with the drone 500 m high.
fn likelihood(user: &Particle, stop: &Stop) -> f64 {
    let (dx, dy, h) = (user.x - stop.place[0], user.y - stop.place[1], 500.0);
    let elevation = (h / (dx * dx + dy * dy).sqrt()).atan().to_degrees();
    let seen = 1.0 / (1.0 + 9.61 * (-0.16 * (elevation - 9.61)).exp());
    let distance = (dx * dx + dy * dy + h * h).sqrt();
    let excess = stop.loss - 20.0 * (4.0 * PI / 0.15 * distance).log10();
    seen * density(excess - 1.0, 10.39 * (-0.05 * elevation).exp())
        + (1.0 - seen) * density(excess - 20.0, 29.6 * (-0.03 * elevation).exp())
}

/// The thesis' filter, Table 2.1.
pub(crate) struct Filter {
    particles: Vec<Particle>,
    threshold: f64,
    rng: Random,
}

impl Filter {
    pub(crate) fn new(threshold: f64) -> Self {
        let mut rng = Random::new();
        let mut anywhere = || 2000.0 * rng.uniform();
        let particles = (0..L)
            .map(|_| Particle { x: anywhere(), y: anywhere(), weight: 1.0 / L as f64 })
            .collect();
        Self { particles, threshold, rng }
    }

    pub(crate) fn step(&mut self, stop: &Stop) -> [f64; 2] {
        for particle in &mut self.particles {
            particle.weight *= likelihood(particle, stop);
        }
        let sum: f64 = self.particles.iter().map(|particle| particle.weight).sum();
        for particle in &mut self.particles {
            particle.weight /= sum;
        }
        let weights: Vec<f64> = self.particles.iter().map(|particle| particle.weight).collect();
        let squares: f64 = weights.iter().map(|weight| weight * weight).sum();
        if 1.0 / squares < self.threshold * L as f64 {
            let mut ancestors = vec![0; L];
            systematic(&weights, &mut ancestors, &mut self.rng);
            let child =
                |&index: &usize| Particle { weight: 1.0 / L as f64, ..self.particles[index] };
            self.particles = ancestors.iter().map(child).collect();
        }
        let mut mean = [0.0; 2];
        for particle in &mut self.particles {
            let radius = 10.0 * (-2.0 * (1.0 - self.rng.uniform()).ln()).sqrt();
            let (sine, cosine) = (TAU * self.rng.uniform()).sin_cos();
            particle.x += radius * cosine;
            particle.y += radius * sine;
            mean[0] += particle.weight * particle.x;
            mean[1] += particle.weight * particle.y;
        }
        mean
    }
}

pub(crate) type Resample = fn(&[f64], &mut [usize], &mut Random);

pub(crate) fn systematic(weights: &[f64], ancestors: &mut [usize], rng: &mut Random) {
    let offset = rng.uniform();
    strata(weights, ancestors, || offset);
}

pub(crate) fn stratified(weights: &[f64], ancestors: &mut [usize], rng: &mut Random) {
    strata(weights, ancestors, || rng.uniform());
}

/// Draws one sample from each n-th of the sum of the weights.
fn strata(weights: &[f64], ancestors: &mut [usize], mut offset: impl FnMut() -> f64) {
    let count = weights.len();
    let (mut cumulative, mut index) = (weights[0], 0);
    for (i, ancestor) in ancestors.iter_mut().enumerate() {
        let place = (i as f64 + offset()) / count as f64;
        while cumulative < place && index < count - 1 {
            index += 1;
            cumulative += weights[index];
        }
        *ancestor = index;
    }
}

pub(crate) fn multinomial(weights: &[f64], ancestors: &mut [usize], rng: &mut Random) {
    draw(weights.iter().copied(), ancestors, rng);
}

pub(crate) fn residual(weights: &[f64], ancestors: &mut [usize], rng: &mut Random) {
    let shares = weights.iter().map(|weight| weight * weights.len() as f64);
    let mut drawn = 0;
    for (index, share) in shares.clone().enumerate() {
        for _ in 0..share as usize {
            ancestors[drawn] = index;
            drawn += 1;
        }
    }
    draw(shares.map(f64::fract), &mut ancestors[drawn..], rng);
}

fn draw(weights: impl Iterator<Item = f64>, ancestors: &mut [usize], rng: &mut Random) {
    let mut sum = 0.0;
    let cumulated = weights.map(|weight| {
        sum += weight;
        sum
    });
    let cumulative: Vec<f64> = cumulated.collect();
    for ancestor in ancestors {
        let place = rng.uniform() * sum;
        *ancestor = cumulative.partition_point(|&up_to| up_to <= place);
    }
}
