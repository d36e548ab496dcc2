//! Is it worth measuring where the search suggests?

use kestirim_air_to_ground::{Measurement, OpenGround};
use kestirim_particle_filter::Xoshiro128PlusPlus;
use kestirim_scalar::{Q16_16, Scalar};
use kestirim_user_locator::{Area, GroundSearch, Informative};
use rand_core::SeedableRng;

use crate::ground::{Chance, axis, dipole};

const SIDE_M: f64 = 400.0;
const HEIGHT_M: f64 = 40.0;
/// The y coordinate of the line along which the first measurements are made.
const LINE_M: f64 = 40.0;
const CORNERS: [[f64; 2]; 4] = [[0.0, 0.0], [SIDE_M, 0.0], [SIDE_M, SIDE_M], [0.0, SIDE_M]];

/// A transmitter in a square, with an unknown channel.
struct World {
    truth: [f64; 2],
    exponent: f64,
    axis: [f64; 3],
    noise: f64,
    chance: Chance,
}

impl World {
    fn new(seed: u64) -> Self {
        let mut chance = Chance(Xoshiro128PlusPlus::seed_from_u64(seed));
        let truth = [0.0; 2].map(|_| chance.between(0.0, SIDE_M));
        let (exponent, noise) = (chance.between(1.5, 2.5), chance.between(0.5, 3.0));
        let axis = axis(&mut chance);
        Self { truth, exponent, axis, noise, chance }
    }

    fn measurement<T: Scalar>(&mut self, place: [f64; 2]) -> Measurement<T> {
        let sight = [place[0] - self.truth[0], place[1] - self.truth[1], HEIGHT_M];
        let distance = sight[0].hypot(sight[1]).hypot(sight[2]);
        let gain = dipole(sight.map(|part| part / distance), self.axis, 0.03);
        let level = gain - 30.0 - 10.0 * self.exponent * distance.log10();
        let loss = T::from_f64(-level - self.noise * self.chance.normal());
        Measurement::new(place.map(T::from_f64), T::from_f64(HEIGHT_M), loss).expect("plausible")
    }

    /// A search along one side of the square, which leaves much undecided.
    fn begun<T: Scalar>(&mut self) -> GroundSearch<T, 60, 4> {
        let area = Area::new(&CORNERS.map(|corner| corner.map(T::from_f64))).expect("a square");
        let mut search = GroundSearch::new(OpenGround::new(None), area);
        for stop in 0..12 {
            search.measure(&self.measurement([30.0 * f64::from(stop) + 20.0, LINE_M]));
        }
        search
    }

    fn error<T: Scalar>(&self, place: [T; 2]) -> f64 {
        let [x, y] = place.map(T::to_f64);
        (x - self.truth[0]).hypot(y - self.truth[1])
    }
}

/// The rule by which the next measurement's place is chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Choice {
    Informative,
    Anywhere,
    AtTheEstimate,
}

/// Mean error after this many more measurements.
fn mean_error(choice: Choice, more: u32, worlds: u64) -> f64 {
    let mut sum = 0.0;
    for seed in 0..worlds {
        let mut world = World::new(seed);
        let mut search = world.begun::<f64>();
        for _ in 0..more {
            let found = search.estimate::<100>().expect("something explains it");
            let place = match choice {
                Choice::Informative => {
                    let next = search.next_waypoint(&found, HEIGHT_M).expect("more to learn");
                    assert!((0.0..=1.0).contains(&next.left), "{next:?}");
                    next.waypoint.place
                }
                Choice::Anywhere => [0.0; 2].map(|_| world.chance.between(0.0, SIDE_M)),
                Choice::AtTheEstimate => found.place,
            };
            search.measure(&world.measurement(place));
        }
        let found = search.estimate::<200>().expect("something explains it");
        sum += world.error(found.place);
    }
    let mean = sum / worlds as f64;
    println!("{choice:?}, {more} more: {mean:.1} m");
    mean
}

#[test]
fn one_more_measurement_tells_as_much_as_was_expected() {
    const WORLDS: u32 = 8;
    let [mut expected, mut came] = [0.0; 2];
    for seed in 0..WORLDS {
        let mut world = World::new(u64::from(seed));
        let mut search = world.begun::<f64>();
        let before = search.estimate::<100>().expect("something explains it");
        let next = search.next_waypoint(&before, HEIGHT_M).expect("more to learn");
        // A line does not distinguish its left from its right, and neither does a further measurement on it.
        let [_, y] = next.waypoint.place;
        assert!((y - LINE_M).abs() > HEIGHT_M && next.waypoint.height == HEIGHT_M, "{next:?}");
        search.measure(&world.measurement(next.waypoint.place));
        let after = search.estimate::<100>().expect("something explains it");
        expected += next.left / f64::from(WORLDS);
        came += after.sigma / before.sigma / f64::from(WORLDS);
    }
    println!("expected {expected:.2}, came {came:.2}");
    assert!(expected < 0.9 && came < 0.9 && (expected - came).abs() < 0.25);
}

#[test]
#[ignore = "minutes: the book's numbers"]
fn four_measurements_where_the_search_says_halve_the_error() {
    const WORLDS: u64 = 100;
    let begun = mean_error(Choice::Informative, 0, WORLDS);
    let told = mean_error(Choice::Informative, 4, WORLDS);
    let anywhere = mean_error(Choice::Anywhere, 4, WORLDS);
    let there = mean_error(Choice::AtTheEstimate, 4, WORLDS);
    assert!(told < 0.85 * anywhere && told < 0.85 * there && told < 0.6 * begun);
}

/// The next waypoint of a search in another scalar.
fn next<T: Scalar>() -> Informative<T> {
    let search = World::new(3).begun::<T>();
    let found = search.estimate::<200>().expect("something explains it");
    search.next_waypoint(&found, T::from_f64(HEIGHT_M)).expect("more to learn")
}

#[test]
fn every_scalar_says_nearly_the_same() {
    let exact = next::<f64>();
    let close = |left: f64| assert!((left - exact.left).abs() < 0.1, "{left} {}", exact.left);
    close(next::<f32>().left.to_f64());
    close(next::<Q16_16>().left.to_f64());
}

#[test]
fn nothing_is_said_where_nothing_is_left_to_learn() {
    let here = [[0.0, 0.0], [1e-3, 0.0], [1e-3, 1e-3]];
    let area = Area::<f32, 4>::new(&here.map(|corner| corner.map(|it: f64| it as f32)));
    let mut search = GroundSearch::<f32, 60, 4>::new(OpenGround::new(None), area.expect("small"));
    search.measure(&Measurement::new([0.0; 2], 40.0, 60.0).expect("plausible"));
    let found = search.estimate::<50>().expect("something explains it");
    let next = search.next_waypoint(&found, 40.0);
    assert!(next.is_none_or(|next| next.left > 0.99), "{next:?}");
}
