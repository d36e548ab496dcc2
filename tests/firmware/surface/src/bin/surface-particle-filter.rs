//! Everything of `kestirim-particle-filter`.

#![no_std]
#![no_main]

use kestirim_particle_filter::{
    Moments, Particles, PointMass, Region, Resampler, Start, kld_count, offspring,
};
use kestirim_scalar::{Q16_16, Scalar};
use surface::{AnyRng, any, call_each, image, keep, number, numbers, slice, slice_mut};

fn resampler() -> Resampler {
    any(Resampler::Residual)
}

fn start() -> Start {
    any(Start::QuasiRandom)
}

/// What a particle's weight depends on.
fn weight<T: Scalar, const D: usize>(state: [T; D]) -> T {
    keep(state);
    number()
}

/// Where a particle goes.
fn moved<T: Scalar, const D: usize, const K: usize>(state: [T; D], noise: [T; K]) -> [T; D] {
    keep((state, noise));
    numbers()
}

/// What of a particle is wanted.
fn shown<T: Scalar, const D: usize, const K: usize>(state: [T; D]) -> [T; K] {
    keep(state);
    numbers()
}

fn draws<T: Scalar>() {
    let weights = numbers::<T, 8>();
    let mut counts = any([0; 8]);
    let (weights, counts) = (slice(&weights), slice_mut(&mut counts));
    keep(offspring(resampler(), weights, counts, &mut AnyRng));
    keep(kld_count(any(1), number::<T>(), number(), any(1)));
}

fn moments<T: Scalar, const D: usize>(moments: &Moments<T, D>) {
    keep(Moments::mean(moments));
    keep(Moments::factor(moments));
    keep(Moments::deviation(moments));
    keep(Moments::spread(moments));
    keep(Moments::covariance(moments));
}

fn region<T: Scalar, const D: usize>() -> Option<Region<T, D>> {
    let region = any(Region::<T, D>::new(numbers(), numbers()).ok()?);
    keep(Region::low(&region));
    keep(Region::high(&region));
    keep(Region::width(&region));
    keep(Region::contains(&region, &numbers()));
    keep(Region::extended::<9>(&region));
    Some(region)
}

fn particles<T: Scalar, const D: usize, const N: usize>() {
    let Some(region) = region::<T, D>() else { return };
    keep(Particles::<T, D, N>::new(start(), &region, &mut AnyRng));
    keep(Particles::<T, D, N>::all_at(&numbers()));
    let cloud = Particles::<T, D, N>::with_count(any(1), start(), &region, &mut AnyRng);
    let Ok(mut cloud) = any(cloud) else { return };
    Particles::spread(any(&mut cloud), start(), &region, &mut AnyRng);
    keep(Particles::len(&cloud));
    keep(Particles::is_empty(&cloud));
    keep(Particles::state(&cloud, any(1)));
    keep(Particles::log_weights(&cloud));
    keep(Particles::weight(&cloud, any(1)));
    keep(Particles::effective(&cloud));
    moments(&any(Particles::moments(&cloud)));
    keep(Particles::moments_of::<3>(&cloud, shown));
    keep(Particles::mean_of::<3>(&cloud, shown));
    keep(Particles::mode(&cloud, &numbers()));
}

fn steps<T: Scalar, const D: usize, const N: usize>() {
    let mut cloud = any(Particles::<T, D, N>::all_at(&numbers()));
    Particles::predict::<2, _>(any(&mut cloud), moved, &mut AnyRng);
    Particles::jitter(any(&mut cloud), &numbers(), &mut AnyRng);
    keep(Particles::update(any(&mut cloud), weight));
    keep(Particles::resample(any(&mut cloud), resampler(), &mut AnyRng));
    keep(Particles::resample_to(any(&mut cloud), any(1), resampler(), &mut AnyRng));
    keep(Particles::regularise(any(&mut cloud), number(), &mut AnyRng));
    keep(Particles::metropolis(any(&mut cloud), number(), weight, &mut AnyRng));
    keep(Particles::occupied_bins(any(&mut cloud), &numbers()));
}

fn points<T: Scalar, const D: usize, const N: usize>() {
    let Some(region) = region::<T, D>() else { return };
    keep(PointMass::<T, D, N>::new(&region));
    let Ok(mut mass) = any(PointMass::<T, D, N>::with_count(any(1), &region)) else { return };
    keep(PointMass::update(any(&mut mass), weight));
    keep(PointMass::len(&mass));
    keep(PointMass::is_empty(&mass));
    keep(PointMass::region(&mass));
    keep(PointMass::point(&mass, any(1)));
    keep(PointMass::log_weights(&mass));
    keep(PointMass::heaviest(&mass));
    keep(PointMass::effective(&mass));
    keep(PointMass::finer(&mass, number()));
    moments(&any(PointMass::moments(&mass)));
    keep(PointMass::density_level(&mass, number()));
}

fn all_of<T: Scalar>() {
    call_each([
        draws::<T>,
        particles::<T, 2, 64>,
        particles::<T, 4, 9>,
        steps::<T, 2, 64>,
        steps::<T, 4, 9>,
        points::<T, 2, 64>,
        points::<T, 4, 9>,
    ]);
}

fn run() {
    call_each([all_of::<f32>, all_of::<Q16_16>]);
}

image!(run);
