//! Areas, channels restricted to them, and searches of them, in every number type.

use kestirim_air_to_ground::{Channel, Environment, FreeSpace, Likelihood, Measurement};
use kestirim_particle_filter::{Error as FilterError, Region};
use kestirim_scalar::{Q16_16, Scalar};
use kestirim_user_locator::{Area, Beacon, BeaconSearch, Error, Locator, Within};
use proptest::prelude::*;

type Outcome = Result<(), Error>;

/// A square with a notch from above.
const NOTCHED: [[f64; 2]; 5] = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [2.0, 1.0], [0.0, 4.0]];

fn polygon<T: Scalar>(corners: &[[f64; 2]]) -> Result<Area<T, 6>, Error> {
    let corners: Vec<_> = corners.iter().map(|corner| corner.map(T::from_f64)).collect();
    Area::new(&corners)
}

/// The notched square with sides of 400 m.
fn notched<T: Scalar>() -> Result<Area<T, 6>, Error> {
    polygon(&NOTCHED.map(|corner| corner.map(|metres| metres * 100.0)))
}

fn check_polygon<T: Scalar>() -> Outcome {
    let area = polygon::<T>(&NOTCHED)?;
    let contains = |place: [f64; 2]| area.contains(place.map(T::from_f64));
    assert!(contains([0.5, 0.5]) && contains([3.5, 2.0]));
    assert!(!contains([2.0, 2.0]) && !contains([5.0, 1.0]) && !contains([1.0, -0.1]));
    assert_eq!(area.region().low(), &[T::ZERO; 2]);
    assert_eq!(area.region().high(), &[T::from_f64(4.0); 2]);
    assert!((area.size().to_f64() - 10.0).abs() < 1e-3, "{:?}", area.size());
    let moved = area.relative_to([T::ONE, -T::TWO])?;
    assert_eq!(moved.region().low(), &[-T::ONE, T::TWO]);
    assert!(moved.contains([T::ZERO, T::from_f64(2.5)]));
    // The corners in reverse order enclose the same area.
    let mut corners = NOTCHED;
    corners.reverse();
    assert!((polygon::<T>(&corners)?.size() - area.size()).abs() < T::from_f64(1e-3));
    Ok(())
}

#[test]
fn a_polygon_knows_its_inside() -> Outcome {
    check_polygon::<f64>()?;
    check_polygon::<f32>()?;
    check_polygon::<Q16_16>()
}

#[test]
fn corners_that_enclose_nothing_are_refused() {
    for corners in [&[][..], &[[1.0, 2.0]], &[[0.0, 0.0], [3.0, 3.0]], &[[0.0; 2]; 4]] {
        assert_eq!(polygon::<f64>(corners), Err(Error::NoArea));
        assert_eq!(polygon::<Q16_16>(corners), Err(Error::NoArea));
    }
    assert_eq!(polygon::<f32>(&[[f64::NAN, 0.0]; 3]), Err(Error::NotFinite));
    assert_eq!(polygon::<f64>(&[[f64::MAX, 0.0], [f64::MIN, 1.0], [0.0, 2.0]]), Err(Error::NoArea));
    let seven = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0].map(|x: f64| [x, x * x]);
    assert_eq!(polygon::<f64>(&seven), Err(Error::TooManyCorners));
}

#[test]
fn no_user_is_outside_of_a_channels_area() -> Outcome {
    let channel = Channel::new(&Environment::<f64>::urban(), 0.15)?;
    let area = notched::<f64>()?;
    let within = Within::new(channel, &area);
    let measurement = Measurement::new([100.0, 100.0], 100.0, 95.0)?;
    let (inside, outside) = ([50.0, 50.0], [200.0, 200.0]);
    let expected = channel.log_likelihood(&measurement, inside);
    assert_eq!(within.log_likelihood(&measurement, inside), expected);
    assert_eq!(within.log_likelihood(&measurement, outside), f64::NEG_INFINITY);
    Ok(())
}

/// A channel whose border is looked at with every measurement.
struct EachTime<'a, T>(Within<'a, T, Channel<T>, 6>);

impl<T: Scalar> Likelihood<T> for EachTime<'_, T> {
    fn log_likelihood(&self, measurement: &Measurement<T>, user: [T; 2]) -> T {
        self.0.log_likelihood(measurement, user)
    }
}

fn check_border<T: Scalar>() -> Outcome {
    const USER: [f64; 2] = [130.0, 60.0];
    let area = notched::<T>()?;
    let truth = Channel::new(&Environment::<f64>::urban(), 0.15)?;
    let channel = Channel::new(&Environment::<T>::urban(), T::from_f64(0.15))?;
    let within = Within::new(channel, &area);
    let least = T::from_f64(-1000.0);
    let mut once = Locator::<T, 400, 40, 2, _>::new(within, area.region());
    let mut each_time = Locator::<T, 400, 40, 2, _>::new(EachTime(within), area.region());
    for k in 0..20 {
        let place = [20.0 * f64::from(k), 200.0 + f64::from(k * k)];
        let distance = (place[0] - USER[0]).hypot(place[1] - USER[1]);
        let loss = truth.path_loss(distance, 120.0)?.line_of_sight_mean + f64::from(k % 3 - 1);
        let place = place.map(T::from_f64);
        let measurement = Measurement::new(place, T::from_f64(120.0), T::from_f64(loss))?;
        let updates = (once.measure(&measurement)?, each_time.measure(&measurement)?);
        assert_eq!(updates.0, updates.1);
        let (lattice, same) = (once.posterior(), each_time.posterior());
        assert_eq!(lattice.region(), same.region());
        // In fixed point ln 0 is a large negative number.
        let same = same.log_weights().iter().map(|log| log.max(least));
        assert!(lattice.log_weights().iter().map(|log| log.max(least)).eq(same));
        for (index, log) in lattice.log_weights().iter().enumerate() {
            let point = lattice.point(index).expect("a point");
            assert!(area.contains(point) || *log <= least, "{point:?}");
        }
    }
    for place in [USER, [180.0, 90.0], [200.0, 200.0]].map(|place| place.map(T::from_f64)) {
        let logs = [once.log_posterior(&place), each_time.log_posterior(&place)];
        assert_eq!(logs[0].max(least), logs[1].max(least));
        let regions = [0.5, 0.9].map(T::from_f64).map(|probability| {
            (once.credible(&place, probability), each_time.credible(&place, probability))
        });
        assert!(regions.iter().all(|(once, each_time)| once.is_some() && once == each_time));
    }
    Ok(())
}

#[test]
fn a_border_holds_for_all_measurements_once_it_was_looked_at() -> Outcome {
    check_border::<f64>()?;
    check_border::<f32>()?;
    check_border::<Q16_16>()
}

#[test]
fn several_levels_are_each_alone() -> Outcome {
    let area = notched::<f64>()?;
    let within = Within::new(Channel::new(&Environment::<f64>::urban(), 0.15)?, &area);
    let region = Region::new([0.0, 0.0, -20.0], [400.0, 400.0, 20.0])?;
    let mut locator = Locator::<f64, 400, 40, 3, _>::new(within, &region);
    for k in 0..5 {
        let place = [70.0 * f64::from(k), 50.0];
        locator.measure(&Measurement::new(place, 100.0, 85.0 + f64::from(k))?)?;
    }
    let levels = [-7.0, 0.0, 3.5];
    for place in [[130.0, 60.0], [200.0, 200.0]] {
        let each = levels.map(|level| locator.log_posterior(&[place[0], place[1], level]));
        assert_eq!(locator.log_posterior_of_levels(place, &levels), each);
    }
    Ok(())
}

/// Levels of a beacon of −20 dB at one metre, at point `k` of a flight around it.
fn measured(k: u32) -> Result<Measurement<f64>, Error> {
    let angle = f64::from(k) * 0.7;
    let radius = 50.0 + 5.0 * f64::from(k % 40);
    let from: [f64; 2] = [radius * angle.cos(), radius * angle.sin()];
    let slant = (from[0] - 120.0).hypot(from[1] + 40.0).hypot(40.0);
    Ok(Measurement::new(from, 40.0, 20.0 + 20.0 * slant.log10())?)
}

#[test]
fn a_search_is_a_beacon_in_an_area() -> Outcome {
    let corners = [[-300.0, -300.0], [300.0, -300.0], [300.0, 300.0], [-300.0, 200.0]];
    let area = Area::<f64, 4>::new(&corners)?;
    let mut search = BeaconSearch::<f64, 41, 4>::new(FreeSpace::new(None), area.clone());
    assert_eq!(search.estimate::<100>().err(), None, "all places are alike");
    let mut beacon = Beacon::<f64, 40>::new(FreeSpace::new(None));
    for k in 0..40 {
        search.measure(&measured(k)?);
        beacon.measure(&measured(k)?)?;
    }
    let found = search.estimate::<1000>()?;
    let same = beacon.estimate::<1000>(area.region(), |place| area.contains(place))?;
    assert_eq!((found.place, found.level), (same.place, same.level));
    assert!(search.credible(&found, [120.0, -40.0], 0.9));
    assert_eq!(search.area(), &area);
    // Where the transmitter may be almost anywhere, it is still not outside.
    let mut vague = BeaconSearch::<f64, 41, 4>::new(FreeSpace::new(None), area.clone());
    for k in 0..3 {
        vague.measure(&measured(k)?);
    }
    let found = vague.estimate::<1000>()?;
    assert!(vague.credible(&found, [-250.0, 200.0], 0.999_999));
    assert!(!vague.credible(&found, [-250.0, 220.0], 0.999_999));
    // However long the flight is, and wherever the transmitter cannot be.
    for k in 40..1000 {
        search.measure(&measured(k)?);
    }
    assert!((21..=41).contains(&search.measurements().len()));
    assert_eq!(search.measurements().last(), Some(&measured(999)?));
    let found = search.estimate::<1000>()?;
    assert!((found.place[0] - 120.0).hypot(found.place[1] + 40.0) < 20.0, "{:?}", found.place);
    Ok(())
}

#[test]
fn a_lattice_beside_a_sliver_finds_nothing() -> Outcome {
    let area = Area::<f64, 3>::new(&[[0.0, 0.0], [1000.0, 1000.0], [1000.0, 1000.001]])?;
    let mut search = BeaconSearch::<f64, 40, 3>::new(FreeSpace::new(None), area);
    search.measure(&measured(0)?);
    let nowhere = search.estimate::<20>().err();
    assert_eq!(nowhere, Some(Error::Filter(FilterError::Degenerate)));
    Ok(())
}

proptest! {
    #[test]
    fn a_rectangle_contains_what_its_region_does(
        low in prop::array::uniform2(-100.0..100.0f64),
        width in prop::array::uniform2(0.1..100.0f64),
        at in prop::array::uniform2(-0.5..1.5f64),
    ) {
        let high = [low[0] + width[0], low[1] + width[1]];
        let region = Region::new(low, high).expect("a box");
        let area = Area::<f64, 4>::rectangle(&region).expect("a rectangle");
        let place = [low[0] + width[0] * at[0], low[1] + width[1] * at[1]];
        prop_assert_eq!(area.contains(place), region.contains(&place));
        prop_assert!((area.size() / (width[0] * width[1]) - 1.0).abs() < 1e-9);
    }
}
