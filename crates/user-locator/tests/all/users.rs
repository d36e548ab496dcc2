//! Stationary and moving users, located in every number type.

use kestirim_air_to_ground::{
    Channel, Contaminated, Environment, FreeSpace, LevelPrior, Likelihood, Measurement,
};
use kestirim_particle_filter::{Error as FilterError, Region, Xoshiro128PlusPlus};
use kestirim_scalar::{Q16_16, Scalar};
use kestirim_user_locator::{
    Beacon, Error, Height, Locator, Motion, Orbit, PublishedLocator, PublishedSettings,
    TrackEstimate, Tracker, Waypoint,
};
use rand_core::{Rng, SeedableRng};

type Outcome = Result<(), Error>;

fn rng(seed: u64) -> Xoshiro128PlusPlus {
    Xoshiro128PlusPlus::seed_from_u64(seed)
}

fn urban<T: Scalar>() -> Channel<T> {
    Channel::new(&Environment::urban(), T::from_f64(0.15)).expect("a channel")
}

fn square<T: Scalar>(side: f64) -> Region<T, 2> {
    Region::new([T::ZERO; 2], [T::from_f64(side); 2]).expect("a square")
}

fn distance<T: Scalar>(a: [T; 2], b: [f64; 2]) -> f64 {
    (a[0].to_f64() - b[0]).hypot(a[1].to_f64() - b[1])
}

/// A loss of the urban channel with a line of sight, with half of its shadowing.
fn measured<T: Scalar>(
    user: [f64; 2],
    from: [f64; 2],
    height: f64,
    rng: &mut Xoshiro128PlusPlus,
) -> Measurement<T> {
    let expected = urban::<f64>().path_loss(distance(user, from), height).expect("a place");
    let coins = f64::from(rng.next_u32().count_ones()) - 16.0;
    let loss = expected.line_of_sight_mean + expected.line_of_sight_sigma * 0.5 * coins / 2.83;
    let number = T::from_f64;
    Measurement::new(from.map(number), number(height), number(loss)).expect("a measurement")
}

fn circle(k: u32) -> [f64; 2] {
    let angle = f64::from(k) * std::f64::consts::TAU / 12.0;
    [1000.0 + 667.0 * angle.cos(), 1000.0 + 667.0 * angle.sin()]
}

const USER: [f64; 2] = [1234.0, 707.0];

fn finds<T: Scalar>() -> Outcome {
    let (mut noise, mut draws) = (rng(1), rng(2));
    let mut best = Locator::<T, 500, 12>::new(urban(), &square(2000.0));
    let settings = PublishedSettings::thesis();
    let mut published =
        PublishedLocator::<T, 500>::new(urban(), &square(2000.0), settings, &mut draws);
    for k in 0..12 {
        let measurement = measured(USER, circle(k), 800.0, &mut noise);
        best.measure(&measurement)?;
        published.measure(&measurement, &mut draws)?;
    }
    let error = distance(best.moments().mean(), USER);
    assert!(error < 60.0, "{error}");
    let spread = best.moments().spread().to_f64();
    assert!((20.0..150.0).contains(&spread), "{spread}");
    let error = distance(published.moments().mean(), USER);
    assert!(error < 90.0, "published {error}");
    let credible = |place: [f64; 2]| best.credible(&place.map(T::from_f64), T::from_f64(0.9));
    assert_eq!(credible(USER), Some(true));
    assert_eq!(credible([USER[0] + 400.0, USER[1]]), Some(false));
    assert_eq!(credible([-1.0, 0.0]), Some(false));
    // A measurement that cannot be stored still counts, but regions are no longer known.
    best.measure(&measured(USER, circle(0), 800.0, &mut noise))?;
    assert_eq!(best.credible(&USER.map(T::from_f64), T::from_f64(0.9)), None);
    Ok(())
}

#[test]
fn a_user_who_stays_is_found() -> Outcome {
    finds::<f64>()?;
    finds::<f32>()?;
    finds::<Q16_16>()
}

#[test]
fn the_level_is_estimated_too() -> Outcome {
    let mut noise = rng(3);
    let region = Region::new([0.0, 0.0, -10.0], [2000.0, 2000.0, 10.0])?;
    let mut locator = Locator::<f64, 1500, 24, 3>::new(urban(), &region);
    for k in 0..24 {
        // Seven decibels weaker than the channel assumes.
        locator.measure(&measured(USER, circle(k), 800.0, &mut noise).less(-7.0))?;
    }
    let [x, y, level] = locator.moments().mean();
    assert!(distance([x, y], USER) < 100.0, "{x} {y}");
    assert!((level - 7.0).abs() < 2.0, "{level}");
    Ok(())
}

#[test]
fn a_robust_likelihood_survives_wild_measurements() -> Outcome {
    let robust = Contaminated::new(urban::<f64>(), 0.05)?;
    let mut noise = rng(4);
    let mut locator = Locator::<f64, 500, 24, 2, _>::new(robust, &square(2000.0));
    let mut trusting = Locator::<f64, 500, 24>::new(urban(), &square(2000.0));
    for k in 0..24 {
        let wild = if k % 6 == 5 { 35.0 } else { 0.0 };
        let measurement = measured(USER, circle(k), 800.0, &mut noise).less(wild);
        locator.measure(&measurement)?;
        trusting.measure(&measurement)?;
    }
    let (error, other) =
        (distance(locator.moments().mean(), USER), distance(trusting.moments().mean(), USER));
    assert!(error < 80.0 && other > 2.0 * error, "{error} {other}");
    Ok(())
}

/// A channel that carries no information.
struct Mute;

impl<T: Scalar> Likelihood<T> for Mute {
    fn log_likelihood(&self, _: &Measurement<T>, _: [T; 2]) -> T {
        T::from_f64(f64::NAN)
    }
}

fn refuses<T: Scalar>() -> Outcome {
    let degenerate = Err(Error::Filter(FilterError::Degenerate));
    let measurement = measured::<T>(USER, circle(0), 800.0, &mut rng(5));
    let mut locator = Locator::<T, 100, 4, 2, _>::new(Mute, &square(2000.0));
    let before = format!("{:?}", locator.posterior());
    assert_eq!(locator.measure(&measurement), degenerate);
    assert_eq!(format!("{:?}", locator.posterior()), before);
    let mut draws = rng(6);
    let mut tracker =
        Tracker::<T, 100, _>::new(Mute, Motion::people(), &square(4000.0), &mut draws);
    tracker.predict(T::ONE, &mut draws)?;
    let before = format!("{:?} {:?}", tracker.particles(), tracker.estimate());
    assert_eq!(tracker.measure(&measurement, &mut draws), degenerate);
    for (interval, error) in [(-1.0, FilterError::NotPositive), (f64::NAN, FilterError::NotFinite)]
    {
        // Fixed point has no NaN: it becomes the lower rail, which is not finite either.
        let refused = tracker.predict(T::from_f64(interval), &mut draws);
        assert_eq!(refused, Err(Error::Filter(error)));
    }
    assert_eq!(format!("{:?} {:?}", tracker.particles(), tracker.estimate()), before);
    let many = Locator::<T, 100, 4>::with_count(101, urban(), &square(2000.0)).err();
    assert_eq!(many, Some(Error::Filter(FilterError::TooMany)));
    let none = Locator::<T, 100, 4>::with_count(0, urban(), &square(2000.0)).err();
    assert_eq!(none, Some(Error::Filter(FilterError::NotPositive)));
    Ok(())
}

#[test]
fn what_nothing_explains_changes_nothing() -> Outcome {
    refuses::<f64>()?;
    refuses::<f32>()?;
    refuses::<Q16_16>()
}

/// A receiver that hears nothing at all beyond 300 m.
#[derive(Clone, Copy, Debug)]
struct ShortOfHearing;

impl<T: Scalar> Likelihood<T> for ShortOfHearing {
    fn log_likelihood(&self, measurement: &Measurement<T>, user: [T; 2]) -> T {
        let [x, y] = measurement.place();
        let [dx, dy] = [user[0] - x, user[1] - y];
        if dx.hypot(dy) < T::from_f64(300.0) { T::from_f64(-2.0) } else { T::ZERO.ln() }
    }
}

/// A cloud that cannot be where its user is heard is spread anew, though no measurement weighs it.
#[test]
fn a_user_that_is_heard_elsewhere_is_found_again() -> Outcome {
    let mut draws = rng(3);
    let mut tracker =
        Tracker::<f64, 500, _>::new(ShortOfHearing, Motion::people(), &square(4000.0), &mut draws);
    let at = |place| Measurement::new(place, 500.0, 100.0).expect("a measurement");
    for _ in 0..20 {
        tracker.measure(&at([600.0; 2]), &mut draws)?;
    }
    assert!(distance(tracker.estimate().place, [600.0; 2]) < 300.0);
    let refused = (0..20).filter(|_| tracker.measure(&at([3300.0; 2]), &mut draws).is_err());
    assert!((2..19).contains(&refused.count()));
    assert!(distance(tracker.estimate().place, [3300.0; 2]) < 300.0);
    Ok(())
}

/// Mean error over the second half of a walk round a circle; the user jumps to its other side at `jump`.
fn follow<T: Scalar>(jump: Option<u32>, seed: u64) -> Result<f64, Error> {
    const STEPS: u32 = 240;
    let (mut noise, mut draws) = (rng(seed), rng(seed + 100));
    let mut tracker =
        Tracker::<T, 500>::new(urban(), Motion::people(), &square(4000.0), &mut draws);
    let mut orbit = Orbit::new(Height::Fixed(T::from_f64(500.0)));
    let mut from = [2000.0; 2];
    let mut sum = 0.0;
    for step in 0..STEPS {
        let turned = if jump.is_some_and(|jump| step >= jump) { 3.0 } else { 0.0 };
        let angle = f64::from(step) / 500.0 * std::f64::consts::TAU + turned;
        let user = [2000.0 + 1000.0 * angle.cos(), 2000.0 + 1000.0 * angle.sin()];
        if step > 0 {
            tracker.predict(T::from_f64(5.0), &mut draws)?;
        }
        tracker.measure(&measured(user, from, 500.0, &mut noise), &mut draws)?;
        let estimate = tracker.estimate();
        let next = orbit.next(&estimate, T::from_f64(5.0));
        from = next.place.map(T::to_f64);
        if step >= STEPS / 2 {
            sum += distance(estimate.place, user) / f64::from(STEPS / 2);
        }
    }
    let spread = tracker.moments().spread().to_f64();
    assert!(spread < 100.0, "{spread}");
    let [vx, vy] = tracker.estimate().velocity.map(T::to_f64);
    assert!((vx.hypot(vy) - 2.5).abs() < 1.5, "{vx} {vy}");
    Ok(sum)
}

#[test]
fn a_user_who_moves_is_followed() -> Outcome {
    for (error, name) in [
        (follow::<f64>(None, 7)?, "f64"),
        (follow::<f32>(None, 7)?, "f32"),
        (follow::<Q16_16>(None, 7)?, "fixed"),
    ] {
        assert!(error < 50.0, "{name}: {error}");
    }
    Ok(())
}

#[test]
fn a_user_who_jumps_is_found_again() -> Outcome {
    let error = follow::<f32>(Some(60), 8)?;
    assert!(error < 100.0, "{error}");
    Ok(())
}

#[test]
fn a_tracker_repeats_itself() -> Outcome {
    assert_eq!(follow::<f32>(None, 9)?.to_bits(), follow::<f32>(None, 9)?.to_bits());
    Ok(())
}

#[test]
fn the_drone_circles_low_when_it_knows_and_high_when_not() {
    let estimate = |spread| TrackEstimate { place: [10.0, 20.0], velocity: [1.0, 0.0], spread };
    let at = |height, spread| Orbit::<f64>::new(height).next(&estimate(spread), 2.0);
    let radius = |Waypoint { place: [x, y], .. }: Waypoint<f64>| (x - 12.0).hypot(y - 20.0);
    assert!((radius(at(Height::Fixed(500.0), 10.0)) - 150.0).abs() < 1e-9);
    assert!((radius(at(Height::Fixed(500.0), 1000.0)) - 1000.0 / 2.0_f64.sqrt()).abs() < 1e-9);
    assert_eq!(at(Height::Between(100.0, 1000.0), 10.0).height, 100.0);
    assert_eq!(at(Height::Between(100.0, 1000.0), 1e4).height, 1000.0);
    // After many rounds the angle is still small.
    let mut orbit = Orbit::<f64>::new(Height::Fixed(500.0));
    for _ in 0..10_000 {
        assert!((radius(orbit.next(&estimate(10.0), 2.0)) - 150.0).abs() < 1e-6);
    }
}

/// Levels of a beacon of −20 dB at one metre, from a flight around it.
fn beacon(level: Option<LevelPrior<f64>>) -> Result<(Beacon<f64, 40>, [f64; 2]), Error> {
    let (place, mut noise) = ([120.0, -40.0], rng(10));
    let mut beacon = Beacon::new(FreeSpace::new(level));
    for k in 0..40 {
        let angle = f64::from(k) * 0.7;
        // Not a circle: from there a place and its inversion look alike.
        let radius = 50.0 + 5.0 * f64::from(k);
        let from = [radius * angle.cos(), radius * angle.sin()];
        let slant = distance(from, place).hypot(40.0);
        let shadowing = (f64::from(noise.next_u32().count_ones()) - 16.0) / 2.83 * 2.0;
        // Every tenth measurement is in a null of the antenna.
        let null = if k % 10 == 9 { 20.0 } else { 0.0 };
        let received = -20.0 - 20.0 * slant.log10() + shadowing - null;
        beacon.measure(&Measurement::new(from, 40.0, -received)?)?;
    }
    Ok((beacon, place))
}

#[test]
fn a_beacon_of_unknown_power_is_found() -> Outcome {
    for level in [None, Some(LevelPrior { mean: -20.0, sigma: 3.0 })] {
        let (mut beacon, place) = beacon(level)?;
        let region = Region::new([-300.0; 2], [300.0; 2])?;
        let inside = |[x, _]: [f64; 2]| x > -200.0;
        let found = beacon.estimate::<1000>(&region, inside)?;
        assert!(distance(found.place, place) < 30.0, "{:?}", found.place);
        assert!((found.level + 20.0).abs() < 4.0, "{}", found.level);
        assert!(beacon.credible(&found, place, 0.9, inside));
        assert!(!beacon.credible(&found, [-290.0, 290.0], 0.9, inside));
        assert!(!beacon.credible(&found, place, 0.9, |[x, _]| x < 0.0), "outside");
        // In a larger region it can be farther away, and is known no better, however few points of it are near.
        for [size, shift] in [[600.0, 0.0], [5e3, 0.0], [2e4, 0.0], [2e4, 3e3], [2e4, 3.3e3]] {
            let region = Region::new([shift - size; 2], [shift + size; 2])?;
            let wide = beacon.estimate::<1000>(&region, inside)?;
            let [one, other] = [found.sigma(), wide.sigma()];
            assert!(other > 0.9 * one, "{size} {shift}: {one} {other}");
        }
        let spread = found.moments().spread();
        assert!((5.0..250.0).contains(&spread), "{spread}");
        let nowhere = beacon.estimate::<100>(&region, |_| false).err();
        assert_eq!(nowhere, Some(Error::Filter(FilterError::Degenerate)));
        let full = beacon.measure(&Measurement::new([0.0; 2], 40.0, 60.0)?);
        assert_eq!(full, Err(Error::Filter(FilterError::TooMany)));
    }
    Ok(())
}
