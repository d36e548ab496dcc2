//! All vector widths give the same bits: `cargo test -p kestirim-particle-filter --features vectors`.

extern crate std;

use std::vec::Vec;

use kestirim_arithmetic::vectors::Vectors;
use kestirim_scalar::Scalar;
use rand_core::SeedableRng;

use crate::moments::Looking;
use crate::weights::Weighing;
use crate::{Likelihood, Particles, Region, Start, Xoshiro128PlusPlus};

const N: usize = 500;

/// A likelihood with a distance, exponentials, roots, logarithms and an angle, as in a path loss.
struct Ring<T>(T);

impl<T: Scalar> Likelihood<T, 2> for Ring<T> {
    #[inline(always)]
    fn logarithm(&self, [x, y]: [T; 2]) -> T {
        let distance = T::norm(&[x, y]);
        let elevation = self.0.atan2(distance);
        let loss = distance.max(T::EPSILON).ln() + (-elevation).exp();
        -(loss - T::TWO) * (loss - T::TWO) / (elevation + T::ONE)
    }
}

fn check<T: Scalar>() -> usize {
    let region = Region::new([-T::TWO; 2], [T::from_f64(7.3); 2]).expect("a region");
    let mut rng = Xoshiro128PlusPlus::seed_from_u64(5);
    let mut units = 0;
    for count in [1, 31, 32, 33, 499, N] {
        let cloud = Particles::<T, 2, N>::with_count(count, Start::Random, &region, &mut rng);
        let cloud = cloud.expect("a cloud");
        let ring = Ring(T::from_f64(1.5));
        // The kernel changes the weights, so each run gets a copy.
        let weighed = Vectors::all().map(|unit| {
            let mut weights = cloud.weights.clone();
            let kernel =
                Weighing { weights: &mut weights, points: &cloud.states, likelihood: &ring };
            let update = unit.run(kernel).expect("weights");
            let moments = unit.run(Looking { weights: &weights, points: &cloud.states });
            let numbers = [update.effective, update.log_evidence, weights.sum()];
            let moments = [moments.mean(), moments.factor()[0], moments.factor()[1]];
            let all = weights.logs().iter().copied().chain(numbers);
            let all = all.chain(moments.into_iter().flatten());
            all.map(|number| number.to_f64().to_bits()).collect::<Vec<_>>()
        });
        let weighed: Vec<_> = weighed.collect();
        for (unit, bits) in weighed.iter().enumerate() {
            assert_eq!(*bits, weighed[0], "{count} particles, unit {unit}");
        }
        units = weighed.len();
    }
    units
}

#[test]
fn all_kinds_of_vectors_give_the_same_bits() {
    let units = check::<f64>();
    assert_eq!(check::<f32>(), units);
    #[cfg(all(feature = "vectors", target_arch = "x86_64"))]
    assert!(units > 1 || !std::arch::is_x86_feature_detected!("avx2"), "one kind alone");
    std::println!("{units} kinds of vectors compared");
}
