//! The drone's filter on this machine: time of a step and of resampling, beside plain implementations of the
//! same, in one run on one thread.

use std::hint::black_box;
use std::time::Instant;

use kestirim_air_to_ground::{Channel, Environment, Measurement};
use kestirim_particle_filter::{
    Particles, Region, Resampler, Start, Xoshiro128PlusPlus, offspring,
};
use kestirim_scalar::Scalar;
use rand_core::{Rng, SeedableRng};

const L: usize = 500;

fn fastest(rounds: usize, repetitions: usize, mut work: impl FnMut()) -> f64 {
    (0..rounds)
        .map(|_| {
            let begin = Instant::now();
            (0..repetitions).for_each(|_| work());
            begin.elapsed().as_secs_f64() / repetitions as f64
        })
        .fold(f64::INFINITY, f64::min)
}

fn step<T: Scalar>(resample: bool) -> f64 {
    let mut rng = Xoshiro128PlusPlus::seed_from_u64(1);
    let n = T::from_f64;
    let region = Region::new([n(0.0); 2], [n(2000.0); 2]).unwrap();
    let channel = Channel::new(&Environment::urban(), n(0.15)).unwrap();
    let mut particles = Particles::<T, 2, L>::new(Start::Random, &region, &mut rng);
    let mut k = 0;
    fastest(200, 50, || {
        k += 1;
        let angle = f64::from(k % 12) * std::f64::consts::FRAC_PI_6;
        let place = [n(1000.0 + 667.0 * angle.cos()), n(1000.0 + 667.0 * angle.sin())];
        let measurement = Measurement::new(place, n(500.0), n(100.0 + f64::from(k % 7))).unwrap();
        let update = particles.update(|user| channel.log_likelihood(&measurement, user));
        if resample || update.unwrap().effective < n(0.1 * L as f64) {
            particles.resample(Resampler::Systematic, &mut rng).unwrap();
        }
        particles.jitter(&[n(10.0); 2], &mut rng);
        black_box(particles.moments());
    })
}

fn parts<T: Scalar>() {
    let mut rng = Xoshiro128PlusPlus::seed_from_u64(1);
    let n = T::from_f64;
    let region = Region::new([n(0.0); 2], [n(2000.0); 2]).unwrap();
    let channel = Channel::new(&Environment::urban(), n(0.15)).unwrap();
    let mut particles = Particles::<T, 2, L>::new(Start::Random, &region, &mut rng);
    let measurement = Measurement::new([n(1000.0), n(500.0)], n(500.0), n(100.0)).unwrap();
    let states: Vec<[T; 2]> = (0..L).map(|i| particles.state(i).unwrap()).collect();
    let mut out = vec![T::ZERO; L];
    let a = fastest(200, 50, || {
        for (o, s) in out.iter_mut().zip(&states) {
            *o = channel.log_likelihood(&measurement, *s);
        }
        black_box(&out);
    });
    let u = fastest(200, 50, || {
        black_box(particles.update(|user| channel.log_likelihood(&measurement, user))).unwrap();
    });
    let w = fastest(200, 50, || {
        black_box(particles.update(|user| user[0] * T::EPSILON)).unwrap();
    });
    let j = fastest(200, 50, || {
        particles.jitter(&[n(10.0); 2], &mut rng);
    });
    let m = fastest(200, 50, || {
        black_box(particles.moments());
    });
    let r = fastest(200, 50, || {
        particles.resample(Resampler::Systematic, &mut rng).unwrap();
    });
    println!(
        "likelihood {:.2} update {:.2} weights {:.2} jitter {:.2} moments {:.2} resample {:.2}",
        a * 1e6,
        u * 1e6,
        w * 1e6,
        j * 1e6,
        m * 1e6,
        r * 1e6
    );
}

fn main() {
    parts::<f64>();
    parts::<f32>();
    println!("step f64 {:.2} us, f32 {:.2} us", step::<f64>(false) * 1e6, step::<f32>(false) * 1e6);
    println!(
        "  with resampling each: f64 {:.2} us, f32 {:.2} us",
        step::<f64>(true) * 1e6,
        step::<f32>(true) * 1e6
    );
    let mut rng = Xoshiro128PlusPlus::seed_from_u64(1);
    let weights: Vec<f64> = (0..100_000).map(|_| f64::from(rng.next_u32()).powi(2)).collect();
    let mut counts = vec![0; weights.len()];
    for law in
        [Resampler::Systematic, Resampler::Stratified, Resampler::Residual, Resampler::Multinomial]
    {
        let time = fastest(20, 3, || {
            offspring(law, &weights, &mut counts, &mut rng).unwrap();
            black_box(&counts);
        });
        println!("{law:?} {:.0} us", time * 1e6);
    }
}
