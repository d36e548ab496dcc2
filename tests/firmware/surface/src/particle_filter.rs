//! Calls everything of `kestirim-particle-filter`.

use kestirim_particle_filter::{
    IntegerWeights, Likelihood, Moments, Multinomial, Particles, PointMass, Region, Resample,
    Resampler, Residual, Start, Stratified, Systematic, kld_count, offspring,
};
use kestirim_scalar::{Q16_16, Scalar};

use super::values::{
    AnyRng, LONG_FORM, any, call_each, keep, number, numbers, one_of, rounds, slice, slice_mut,
    try_on, whole,
};

fn resampler() -> Resampler {
    one_of([
        Resampler::Multinomial,
        Resampler::Residual,
        Resampler::Stratified,
        Resampler::Systematic,
    ])
}

fn start() -> Start {
    one_of([Start::Random, Start::QuasiRandom, Start::Lattice])
}

/// The weight of a particle.
fn weight<T: Scalar, const D: usize>(state: [T; D]) -> T {
    keep(state);
    number()
}

/// The weight of a particle, as a `Likelihood`.
struct Weight;

impl<T: Scalar, const D: usize> Likelihood<T, D> for Weight {
    fn logarithm(&self, state: [T; D]) -> T {
        weight(state)
    }
}

/// The motion of a particle.
fn moved<T: Scalar, const D: usize, const K: usize>(state: [T; D], noise: [T; K]) -> [T; D] {
    keep((state, noise));
    numbers()
}

/// The part of a particle's state that is requested.
fn shown<T: Scalar, const D: usize, const K: usize>(state: [T; D]) -> [T; K] {
    keep(state);
    numbers()
}

fn draws<T: Scalar>() {
    let weights = numbers::<T, 8>();
    let mut counts = any([0_u32; 8]);
    let (weights, counts) = (slice(&weights), slice_mut(&mut counts));
    keep(offspring(resampler(), weights, counts, &mut AnyRng));
    keep(offspring(Multinomial, weights, counts, &mut AnyRng));
    keep(offspring(Residual, weights, counts, &mut AnyRng));
    keep(offspring(Stratified, weights, counts, &mut AnyRng));
    keep(offspring(Systematic, weights, counts, &mut AnyRng));
    if let Ok(weights) = any(IntegerWeights::new(counts, whole())) {
        keep(IntegerWeights::into_parts(weights));
    }
    if let Ok(weights) = any(IntegerWeights::new(counts, whole())) {
        Resample::replace(resampler(), weights, &mut AnyRng);
    }
    keep(kld_count(whole(), number::<T>(), number(), whole()));
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
    let cloud = Particles::<T, D, N>::with_count(whole(), start(), &region, &mut AnyRng);
    let Ok(mut cloud) = any(cloud) else { return };
    Particles::spread(any(&mut cloud), start(), &region, &mut AnyRng);
    keep(Particles::len(&cloud));
    keep(Particles::is_empty(&cloud));
    keep(Particles::state(&cloud, whole()));
    keep(Particles::log_weights(&cloud));
    keep(Particles::weight(&cloud, whole()));
    keep(Particles::effective(&cloud));
    moments(&any(Particles::moments(&cloud)));
    keep(Particles::moments_of::<3>(&cloud, shown));
    keep(Particles::mean_of::<3>(&cloud, shown));
    keep(Particles::mode(&cloud, &numbers()));
}

fn steps<T: Scalar, const D: usize, const N: usize>() {
    let mut cloud = any(Particles::<T, D, N>::all_at(&numbers()));
    for _ in 0..rounds() {
        Particles::predict::<2, _>(any(&mut cloud), moved, &mut AnyRng);
        Particles::jitter(any(&mut cloud), &numbers(), &mut AnyRng);
        try_on(&mut cloud, |cloud| Particles::update(cloud, weight));
        try_on(&mut cloud, |cloud| Particles::weigh(cloud, &Weight));
        try_on(&mut cloud, |cloud| Particles::resample(cloud, resampler(), &mut AnyRng));
        try_on(&mut cloud, |cloud| {
            Particles::resample_to(cloud, whole(), resampler(), &mut AnyRng)
        });
        try_on(&mut cloud, |cloud| Particles::regularise(cloud, number(), &mut AnyRng));
        try_on(&mut cloud, |cloud| Particles::metropolis(cloud, number(), weight, &mut AnyRng));
        try_on(&mut cloud, |cloud| Particles::occupied_bins(cloud, &numbers()));
    }
}

fn points<T: Scalar, const D: usize, const N: usize>() {
    let Some(region) = region::<T, D>() else { return };
    keep(PointMass::<T, D, N>::new(&region));
    let Ok(mut mass) = any(PointMass::<T, D, N>::with_count(whole(), &region)) else { return };
    try_on(&mut mass, |mass| PointMass::update(mass, weight));
    try_on(&mut mass, |mass| PointMass::weigh(mass, &Weight));
    keep(Likelihood::<T, 2>::logarithm(&Weight, numbers()));
    keep(PointMass::len(&mass));
    keep(PointMass::is_empty(&mass));
    keep(PointMass::region(&mass));
    keep(PointMass::point(&mass, whole()));
    keep(PointMass::log_weights(&mass));
    keep(PointMass::heaviest(&mass));
    keep(PointMass::sum(&mass));
    keep(PointMass::effective(&mass));
    keep(PointMass::finer(&mass, number()));
    moments(&any(PointMass::moments(&mass)));
    keep(PointMass::density_level(&mass, number()));
}

fn all_of<T: Scalar>() {
    if LONG_FORM {
        call_each([particles::<T, 2, 64>, steps::<T, 2, 64>, points::<T, 2, 64>]);
    }
    call_each([draws::<T>, particles::<T, 4, 9>, steps::<T, 4, 9>, points::<T, 4, 9>]);
}

/// Calls everything in this module.
pub fn run() {
    if LONG_FORM {
        call_each([all_of::<f32>]);
    }
    call_each([all_of::<Q16_16>]);
}
