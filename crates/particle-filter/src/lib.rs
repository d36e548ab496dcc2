#![doc = include_str!("../README.md")]
#![no_std]

mod blocks;
mod error;
#[cfg(feature = "serde")]
pub mod generator;
mod kld;
mod likelihood;
mod mode;
mod moments;
mod movement;
mod offspring;
mod particles;
mod point_mass;
mod random;
mod region;
mod resample;
#[cfg(test)]
mod same_bits;
mod sequence;
#[cfg(feature = "serde")]
mod snapshot;
mod uniform;
mod weights;

pub use error::Error;
pub use kld::kld_count;
pub use likelihood::Likelihood;
pub use moments::Moments;
pub use offspring::offspring;
pub use particles::Particles;
pub use point_mass::PointMass;
pub use rand_xoshiro::Xoshiro128PlusPlus;
pub use region::Region;
pub use resample::{
    IntegerWeights, Multinomial, Resample, Resampler, Residual, Stratified, Systematic,
};
pub use sequence::Start;
pub use weights::Update;
