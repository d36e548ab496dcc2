//! Flights of drones that look in the direction of flight: is a known heading worth it?

use kestirim_air_to_ground::{Heading, Measurement, OpenGround};
use kestirim_particle_filter::Xoshiro128PlusPlus;
use kestirim_scalar::{Q16_16, Scalar};
use kestirim_user_locator::{Area, Error, GroundSearch};
use rand_core::SeedableRng;

use crate::ground::{Chance, Flight, axis, dipole, find, flight_with, statistics_of};

/// An antenna fixed to a drone.
#[derive(Clone, Copy, Debug)]
enum Antenna {
    /// The gain is the same in all directions: only the transmitter's antenna has a pattern, which does not turn.
    Isotropic,
    /// A dipole with any axis, upright for one drone in three.
    Dipole,
    /// A patch of 3 to 9 dBi, pointing up to 60° below the horizon in any direction, with some radiation to the back.
    Patch,
}

/// A flight, and its headings from a compass: with errors of 3° from flight to flight, and of 3° from place to place.
fn flight<T: Scalar>(antenna: Antenna, seed: u64) -> (Flight, Vec<Heading<T>>) {
    // A seed different from that of the flight.
    let mut chance = Chance(Xoshiro128PlusPlus::seed_from_u64(seed + 1_000_000));
    let tilted = axis(&mut chance);
    let axis = if chance.happens(0.3) { [0.0, 0.0, 1.0] } else { tilted };
    let (side, down) = (chance.between(0.0, std::f64::consts::TAU), chance.between(0.0, 1.05));
    let boresight = [side.cos() * down.cos(), side.sin() * down.cos(), -down.sin()];
    let (sharpness, fill) = (chance.between(0.7, 3.0), 10.0_f64.powf(-chance.between(1.5, 2.5)));
    let gain = |sight: [f64; 3]| match antenna {
        Antenna::Isotropic => 0.0,
        Antenna::Dipole => dipole(sight, axis, fill),
        Antenna::Patch => {
            // From the drone to the transmitter, against the line of sight.
            let cosine: f64 = sight.iter().zip(boresight).map(|(a, b)| -a * b).sum();
            let lobe = f64::midpoint(1.0, cosine).powf(sharpness);
            10.0 * (lobe * (1.0 - fill) + fill).log10()
        }
    };
    let flight = flight_with(&mut Chance(Xoshiro128PlusPlus::seed_from_u64(seed)), gain);
    let off = 0.05 * chance.normal();
    let told = |heading: &f64| {
        Heading::new(T::from_f64(heading + off + 0.05 * chance.normal())).expect("finite")
    };
    let headings = flight.headings.iter().map(told).collect();
    (flight, headings)
}

/// Statistics without and with the headings.
fn compared<const L: usize>(antenna: Antenna, flights: u64) -> [[f64; 3]; 2] {
    println!("{antenna:?}");
    let without = statistics_of::<f32, L>(flights, |seed| (flight::<f32>(antenna, seed).0, vec![]));
    [without, statistics_of::<f32, L>(flights, |seed| flight(antenna, seed))]
}

#[test]
fn a_patch_on_a_drone_that_turns_is_no_error_of_the_place() {
    let [without, with] = compared::<200>(Antenna::Patch, 24);
    assert!(with[0] < 0.9 * without[0], "{with:?} {without:?}");
    assert!(with[2] >= without[2] && with[2] >= 0.7, "{with:?} {without:?}");
}

#[test]
#[ignore = "minutes: the book's numbers"]
fn headings_help_where_an_antenna_turns_and_do_no_harm_where_none_does() {
    for antenna in [Antenna::Dipole, Antenna::Patch] {
        let [without, with] = compared::<200>(antenna, 200);
        assert!(with[0] < 0.9 * without[0], "{with:?} {without:?}");
        assert!((0.8..=0.98).contains(&with[2]), "{with:?}");
        assert!((0.7..1.5).contains(&with[1]), "{with:?}");
    }
    let [without, with] = compared::<200>(Antenna::Isotropic, 200);
    assert!(with[0] < 1.03 * without[0], "{with:?} {without:?}");
    assert!(with[2] >= without[2] - 0.03, "{with:?} {without:?}");
}

#[test]
fn fixed_point_finds_with_headings_what_floats_do() {
    for seed in 0..3 {
        let (of_flight, exact) = flight::<f64>(Antenna::Patch, seed);
        let (exact, sigma, _) = find::<f64, 200>(&of_flight, &exact).expect("explained");
        let single = flight::<f32>(Antenna::Patch, seed).1;
        let (single, ..) = find::<f32, 200>(&of_flight, &single).expect("explained");
        let fixed = flight::<Q16_16>(Antenna::Patch, seed).1;
        let (fixed, ..) = find::<Q16_16, 200>(&of_flight, &fixed).expect("explained");
        println!("{exact:.2} {single:.2} {fixed:.2} ± {sigma:.2}");
        assert!((single - exact).abs() < 0.05 * sigma + 0.1, "{single} {exact} {sigma}");
        assert!((fixed - exact).abs() < 0.3 * sigma + 1.0, "{fixed} {exact} {sigma}");
    }
}

#[test]
fn headings_that_are_unknown_or_the_same_change_nothing_and_those_of_a_place_are_one()
-> Result<(), Error> {
    let area = Area::<f64, 4>::new(&[[0.0, 0.0], [400.0, 0.0], [400.0, 400.0], [0.0, 400.0]])?;
    let mut plain = GroundSearch::<f64, 40, 4>::new(OpenGround::new(None), area);
    let (mut unknown, mut north, mut spinning) = (plain.clone(), plain.clone(), plain.clone());
    for k in 0..60 {
        let place = [f64::from(k % 10) * 40.0, f64::from(k / 10) * 60.0];
        let distance = (place[0] - 250.0).hypot(place[1] - 100.0).hypot(40.0);
        let loss = 30.0 + 20.0 * distance.log10() + f64::from(k * 7919 % 13) / 6.0;
        let measurement = Measurement::new(place, 40.0, loss)?;
        plain.measure(&measurement);
        unknown.measure_with_heading(&measurement, &Heading::unknown());
        north.measure_with_heading(&measurement, &Heading::new(0.0)?);
        for eighth in 0..8 {
            let heading = Heading::new(f64::from(eighth) * core::f64::consts::FRAC_PI_4)?;
            spinning.measure_with_heading(&measurement, &heading);
        }
    }
    let expected = plain.estimate::<100>()?;
    for other in [unknown, north] {
        let found = other.estimate::<100>()?;
        assert_eq!((found.place, found.sigma), (expected.place, expected.sigma));
    }
    assert_eq!(spinning.measurements().len(), plain.measurements().len());
    let found = spinning.estimate::<100>()?;
    let [x, y] = found.place;
    assert!((x - 250.0).hypot(y - 100.0) < 3.0 * found.sigma, "{:?}", found.place);
    Ok(())
}
