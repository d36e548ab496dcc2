//! The cloud of particles: weights that never underflow, moments, motion, recovery.

use kestirim_particle_filter::{
    Error, Particles, Region, Resampler, Start, Xoshiro128PlusPlus, kld_count,
};
use kestirim_scalar::{Q12_20, Q16_16, Scalar};
use rand_core::SeedableRng;

fn rng(seed: u64) -> Xoshiro128PlusPlus {
    Xoshiro128PlusPlus::seed_from_u64(seed)
}

fn square<T: Scalar>(side: f64) -> Result<Region<T, 2>, Error> {
    Region::new([T::ZERO; 2], [T::from_f64(side); 2])
}

/// Logarithm of a normal density about a point, without its constant; distances are limited so that squares do not
/// overflow.
fn bell<T: Scalar>(state: [T; 2], centre: [f64; 2], sigma: f64) -> T {
    let sigmas = [0, 1].map(|axis| {
        let distance: T = (state[axis] - T::from_f64(centre[axis])) / T::from_f64(sigma);
        distance.clamp(T::from_f64(-30.0), T::from_f64(30.0))
    });
    -T::dot(&sigmas, &sigmas) * T::HALF
}

fn follows_a_bell<T: Scalar>(start: Start, tolerance: f64) -> Result<(), Error> {
    let mut particles = Particles::<T, 2, 1000>::new(start, &square(100.0)?, &mut rng(1));
    for _ in 0..10 {
        let update = particles.update(|state| bell(state, [40.0, 70.0], 30.0))?;
        assert!((1.0..=1000.5).contains(&update.effective.to_f64()));
    }
    let sigma = 30.0 / 10.0_f64.sqrt();
    let moments = particles.moments();
    let [x, y] = moments.mean().map(T::to_f64);
    assert!((x - 40.0).hypot(y - 70.0) < tolerance, "{start:?}: {x} {y}");
    let [sx, sy] = moments.deviation().map(T::to_f64);
    assert!((sx / sigma - 1.0).abs() < 0.1 && (sy / sigma - 1.0).abs() < 0.1, "{sx} {sy}");
    assert!((moments.spread().to_f64() / (sigma * 2.0_f64.sqrt()) - 1.0).abs() < 0.1);
    assert!((moments.covariance()[0][0].to_f64() / (sigma * sigma) - 1.0).abs() < 0.2);
    assert!(moments.covariance()[0][1].to_f64().abs() < 0.1 * sigma * sigma);
    Ok(())
}

#[test]
fn a_bell_has_its_mean_and_deviation() -> Result<(), Error> {
    follows_a_bell::<f64>(Start::Random, 2.5)?;
    for start in [Start::QuasiRandom, Start::Lattice] {
        follows_a_bell::<f64>(start, 0.3)?;
        follows_a_bell::<f32>(start, 0.3)?;
        follows_a_bell::<Q16_16>(start, 0.3)?;
        follows_a_bell::<Q12_20>(start, 0.3)?;
    }
    Ok(())
}

#[test]
fn starts_fill_the_box_evenly() -> Result<(), Error> {
    for (start, unevenness) in [(Start::Random, 40), (Start::QuasiRandom, 8), (Start::Lattice, 8)] {
        let particles = Particles::<f64, 2, 1000>::new(start, &square(1.0)?, &mut rng(2));
        let mut cells = [0_i32; 25];
        for index in 0..1000 {
            let Some([x, y]) = particles.state(index) else { return Err(Error::TooMany) };
            assert!((0.0..=1.0).contains(&x) && (0.0..=1.0).contains(&y));
            cells[(x * 5.0) as usize * 5 + (y * 5.0) as usize] += 1;
        }
        let worst = cells.iter().map(|cell| (cell - 40).abs()).max().unwrap_or(0);
        assert!(worst <= unevenness, "{start:?}: {worst}");
    }
    Ok(())
}

fn weights_survive_many_updates<T: Scalar>() -> Result<(), Error> {
    let mut particles =
        Particles::<T, 1, 50>::new(Start::Lattice, &Region::new([T::ZERO], [T::ONE])?, &mut rng(3));
    for _ in 0..100_000 {
        // Every likelihood is below e⁻⁴⁰; that of the last particle is e^(1/100) times that of the first.
        particles.update(|[x]| T::from_f64(-41.0) + x * T::from_f64(0.01))?;
    }
    let largest = particles.log_weights().iter().fold(T::MIN, |largest, &w| largest.max(w));
    assert_eq!(largest, T::ZERO);
    assert!(particles.effective().to_f64() < 1.1);
    let [mean] = particles.moments().mean();
    assert!((mean.to_f64() - 0.99).abs() < 0.011, "{mean:?}");
    Ok(())
}

#[test]
fn a_hundred_thousand_updates_do_not_underflow() -> Result<(), Error> {
    weights_survive_many_updates::<f32>()?;
    weights_survive_many_updates::<f64>()?;
    weights_survive_many_updates::<Q16_16>()?;
    weights_survive_many_updates::<Q12_20>()
}

fn leaves_the_set_as_it_was<T: Scalar>() -> Result<(), Error> {
    let mut particles = Particles::<T, 2, 100>::new(Start::Random, &square(100.0)?, &mut rng(4));
    particles.update(|state| bell(state, [50.0, 50.0], 40.0))?;
    let before = format!("{particles:?}");
    let never = T::ZERO.ln();
    for impossible in [never, T::from_f64(f64::NAN), T::from_f64(f64::INFINITY)] {
        assert_eq!(particles.update(|_| impossible), Err(Error::Degenerate));
        assert_eq!(format!("{particles:?}"), before);
    }
    // One particle with a likelihood, however late, suffices: the others have no weight then.
    let last = particles.state(99).ok_or(Error::TooMany)?;
    particles.update(|state| if state == last { T::ZERO } else { T::from_f64(f64::NAN) })?;
    assert_eq!(particles.effective(), T::ONE);
    assert_eq!(particles.weight(99), Some(T::ONE));
    assert_eq!(particles.weight(0), Some(T::ZERO));
    assert_eq!(particles.weight(100), None);
    let mean = particles.moments().mean();
    assert!((mean[0] - last[0]).abs().to_f64() < 1e-3 && (mean[1] - last[1]).abs().to_f64() < 1e-3);
    // Recovery is on request.
    particles.spread(Start::QuasiRandom, &square(100.0)?, &mut rng(5));
    assert!((particles.effective().to_f64() - 100.0).abs() < 0.01);
    Ok(())
}

#[test]
fn a_measurement_that_nothing_explains_changes_nothing() -> Result<(), Error> {
    leaves_the_set_as_it_was::<f32>()?;
    leaves_the_set_as_it_was::<f64>()?;
    leaves_the_set_as_it_was::<Q16_16>()
}

#[test]
fn evidence_is_that_of_the_data() -> Result<(), Error> {
    // A uniform prior on 0..100 and a normal likelihood of σ = 2 well inside: ∫ exp(…)/100 = σ·√(2π)/100.
    let region = Region::new([0.0], [100.0])?;
    let mut particles = Particles::<f64, 1, 2000>::new(Start::Lattice, &region, &mut rng(6));
    let update = particles.update(|[x]| -((x - 43.0_f64) / 2.0).powi(2) / 2.0)?;
    let exact = (2.0 * (2.0 * std::f64::consts::PI).sqrt() / 100.0).ln();
    assert!((update.log_evidence - exact).abs() < 1e-3);
    Ok(())
}

fn resampling_keeps_the_mean<T: Scalar>() -> Result<(), Error> {
    for law in
        [Resampler::Multinomial, Resampler::Residual, Resampler::Stratified, Resampler::Systematic]
    {
        let mut particles =
            Particles::<T, 2, 1000>::new(Start::QuasiRandom, &square(100.0)?, &mut rng(7));
        particles.update(|state| bell(state, [30.0, 60.0], 8.0))?;
        let (before, effective) = (particles.moments(), particles.effective().to_f64());
        for count in [1000, 400, 10, 1000, 700] {
            particles.resample_to(count, law, &mut rng(8))?;
            assert_eq!(particles.len(), count);
            assert!((particles.effective().to_f64() / count as f64 - 1.0).abs() < 1e-3);
        }
        let after = particles.moments();
        // In between, as few as ten particles stood for all.
        let tolerance = 3.0 * 8.0 / effective.min(10.0).sqrt();
        for axis in 0..2 {
            let shift = (after.mean()[axis] - before.mean()[axis]).to_f64().abs();
            assert!(shift < tolerance, "{law:?}: {shift}");
        }
        assert_eq!(particles.resample_to(0, law, &mut rng(8)), Err(Error::NotPositive));
        assert_eq!(particles.resample_to(1001, law, &mut rng(8)), Err(Error::TooMany));
    }
    Ok(())
}

#[test]
fn resampling_keeps_the_mean_whatever_the_number() -> Result<(), Error> {
    resampling_keeps_the_mean::<f64>()?;
    resampling_keeps_the_mean::<f32>()?;
    resampling_keeps_the_mean::<Q16_16>()
}

#[test]
fn offspring_are_copies_of_their_parents_in_the_right_number() -> Result<(), Error> {
    let region = Region::new([0.0], [8.0])?;
    let mut particles = Particles::<f64, 1, 8>::new(Start::Lattice, &region, &mut rng(9));
    // The weights are 1, 2, 1, 0, 4, 0, 0, 0 eighths.
    let weights = [1.0_f64, 2.0, 1.0, 0.0, 4.0, 0.0, 0.0, 0.0];
    particles.update(|[x]| weights[x as usize].ln())?;
    particles.resample(Resampler::Systematic, &mut rng(10))?;
    let mut found: Vec<_> = (0..8).filter_map(|i| particles.state(i)).map(|[x]| x as i32).collect();
    found.sort_unstable();
    assert_eq!(found, [0, 1, 1, 2, 4, 4, 4, 4]);
    Ok(())
}

fn jitter_and_kernel<T: Scalar>() -> Result<(), Error> {
    let mut particles = Particles::<T, 2, 2000>::all_at(&[T::from_f64(5.0), T::from_f64(-7.0)]);
    particles.jitter(&[T::from_f64(10.0), T::ONE], &mut rng(11));
    let moments = particles.moments();
    let [x, y] = moments.deviation().map(T::to_f64);
    assert!((x / 10.0 - 1.0).abs() < 0.05 && (y - 1.0).abs() < 0.05, "{x} {y}");
    // The coordinates are correlated now, and the kernel must follow.
    particles.predict(|[x, y], []| [x, y + x * T::HALF], &mut rng(12));
    let before = particles.moments();
    particles.resample(Resampler::Systematic, &mut rng(13))?;
    particles.regularise(T::ONE, &mut rng(14))?;
    let after = particles.moments();
    for row in 0..2 {
        assert!((after.mean()[row] - before.mean()[row]).to_f64().abs() < 0.3);
        for column in 0..=row {
            let [a, b] = [&before, &after].map(|m| m.factor()[row][column].to_f64());
            assert!((a - b).abs() < 0.6, "{a} {b}");
        }
    }
    assert_eq!(particles.regularise(T::ZERO, &mut rng(14)), Err(Error::NotPositive));
    Ok(())
}

#[test]
fn noise_has_the_deviation_asked_for_and_the_kernel_keeps_the_moments() -> Result<(), Error> {
    jitter_and_kernel::<f64>()?;
    jitter_and_kernel::<f32>()?;
    jitter_and_kernel::<Q16_16>()
}

fn metropolis_finds_the_posterior<T: Scalar>() -> Result<(), Error> {
    let mut particles =
        Particles::<T, 2, 500>::new(Start::QuasiRandom, &square(100.0)?, &mut rng(15));
    let posterior = |state: [T; 2]| bell(state, [42.0, 58.0], 3.0);
    particles.update(posterior)?;
    particles.resample(Resampler::Systematic, &mut rng(16))?;
    let (mut taken, mut rng) = (0, rng(17));
    for _ in 0..10 {
        taken += particles.metropolis(T::from_f64(1.7), posterior, &mut rng)?;
    }
    // Of ten rounds of 500 moves, 30 to 60 % are accepted.
    assert!((1500..3000).contains(&taken), "{taken}");
    let moments = particles.moments();
    let [x, y] = moments.deviation().map(T::to_f64);
    assert!((x / 3.0 - 1.0).abs() < 0.2 && (y / 3.0 - 1.0).abs() < 0.2, "{x} {y}");
    let mut distinct: Vec<_> =
        (0..500).filter_map(|i| particles.state(i)).map(|[x, _]| x.to_f64().to_bits()).collect();
    distinct.sort_unstable();
    distinct.dedup();
    assert!(distinct.len() > 400, "{}", distinct.len());
    Ok(())
}

#[test]
fn metropolis_moves_make_offspring_different_and_keep_the_posterior() -> Result<(), Error> {
    metropolis_finds_the_posterior::<f64>()?;
    metropolis_finds_the_posterior::<f32>()?;
    metropolis_finds_the_posterior::<Q16_16>()
}

#[test]
fn a_posterior_of_two_peaks_has_its_mode_at_the_higher() -> Result<(), Error> {
    fn check<T: Scalar>() -> Result<(), Error> {
        let mut particles =
            Particles::<T, 2, 1000>::new(Start::QuasiRandom, &square(100.0)?, &mut rng(18));
        particles.update(|state| {
            let high = bell(state, [80.0, 20.0], 5.0).exp();
            let low = bell(state, [20.0, 70.0], 5.0).exp() * T::from_f64(0.6);
            (high + low).ln()
        })?;
        let [x, y] = particles.mode(&[T::from_f64(10.0); 2])?.map(T::to_f64);
        assert!((x - 80.0).hypot(y - 20.0) < 1.0, "{x} {y}");
        let [x, y] = particles.moments().mean().map(T::to_f64);
        assert!((x - 80.0).hypot(y - 20.0) > 20.0);
        assert_eq!(particles.mode(&[T::ZERO; 2]), Err(Error::NotPositive));
        Ok(())
    }
    check::<f64>()?;
    check::<f32>()?;
    check::<Q16_16>()
}

#[test]
fn fewer_bins_want_fewer_particles() -> Result<(), Error> {
    // Fox's formula for 50 bins, ε = 0.05, 99 %: (k − 1)/(2ε)·(1 − 2/(9(k − 1)) + √(2/(9(k − 1)))·2.326)³.
    assert_eq!(kld_count(50, 0.05, 2.326, 100_000)?, 749);
    assert_eq!(kld_count(50, 0.05_f32, 2.326, 500)?, 500);
    assert_eq!(kld_count(1, 0.05, 2.326, 500)?, 1);
    assert_eq!(kld_count(0, 0.05, 2.326, 500)?, 1);
    assert_eq!(kld_count(50, 0.0, 2.326, 500), Err(Error::NotPositive));
    assert_eq!(kld_count(50, 0.05, f64::NAN, 500), Err(Error::NotFinite));
    let mut particles =
        Particles::<f32, 2, 1000>::new(Start::QuasiRandom, &square(100.0)?, &mut rng(19));
    let wide = particles.occupied_bins(&[10.0, 10.0])?;
    assert!((95..=121).contains(&wide), "{wide}");
    particles.update(|state| bell(state, [50.0, 50.0], 5.0))?;
    let narrow = particles.occupied_bins(&[10.0, 10.0])?;
    assert!(narrow < 25, "{narrow}");
    assert_eq!(particles.occupied_bins(&[10.0, 0.0]), Err(Error::NotPositive));
    Ok(())
}

#[test]
fn the_same_seed_gives_the_same_cloud() -> Result<(), Error> {
    let run = || -> Result<String, Error> {
        let mut rng = rng(20);
        let mut particles = Particles::<f32, 2, 200>::new(Start::Random, &square(100.0)?, &mut rng);
        for step in 0..50 {
            let update = particles.update(|state| bell(state, [step.into(), 50.0], 20.0))?;
            if update.effective < 20.0 {
                particles.resample(Resampler::Systematic, &mut rng)?;
            }
            particles.jitter(&[1.0, 1.0], &mut rng);
        }
        Ok(format!("{particles:?}"))
    };
    assert_eq!(run()?, run()?);
    Ok(())
}

#[test]
fn one_particle_is_enough_for_a_set() -> Result<(), Error> {
    let mut one =
        Particles::<f64, 1, 1>::new(Start::Lattice, &Region::new([2.0], [4.0])?, &mut rng(21));
    assert_eq!(one.state(0), Some([3.0]));
    one.update(|[x]| -x)?;
    one.resample(Resampler::Residual, &mut rng(22))?;
    assert_eq!(one.moments().mean(), [3.0]);
    assert_eq!(one.moments().deviation(), [0.0]);
    assert_eq!(one.effective(), 1.0);
    assert!(!one.is_empty());
    Ok(())
}

#[test]
fn regions_are_boxes() {
    assert_eq!(Region::new([0.0, 1.0], [1.0, 0.0]), Err(Error::NotPositive));
    assert_eq!(Region::new([0.0], [f64::INFINITY]), Err(Error::NotFinite));
    assert_eq!(Region::new([f64::NAN], [1.0]), Err(Error::NotFinite));
    assert_eq!(Region::new([f64::MIN], [f64::MAX]), Err(Error::NotFinite));
    let Ok(unit) = Region::new([0.0; 2], [1.0; 2]) else { unreachable!() };
    assert!(unit.contains(&[0.0, 1.0]) && !unit.contains(&[0.5, 1.1]));
    assert!(!unit.contains(&[f64::NAN, 0.5]));
}
