//! Anchors that are placed by the distances between them.

use kestirim_replay::robot::survey::{Pair, Survey, Unplaced, pairs, survey};
use rand_distr::{Distribution, StandardNormal};
use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::SeedableRng;

const HALL: [[f64; 3]; 6] = [
    [0.0, 0.0, 0.3],
    [20.0, 0.5, 4.0],
    [19.0, 12.0, 0.5],
    [1.0, 11.0, 3.5],
    [10.0, 13.0, 4.5],
    [9.0, -1.0, 1.0],
];

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1]).hypot(a[2] - b[2])
}

/// All pairs, with errors of up to ± 5 cm.
fn measured(places: &[[f64; 3]]) -> Vec<Pair> {
    let all = (0..places.len()).flat_map(|j| (0..j).map(move |i| [i, j]));
    let noise = |k: usize| ((k * 7919) % 11) as f64 * 0.01 - 0.05;
    let range =
        |(k, [i, j]): (usize, [usize; 2])| ([i, j], distance(places[i], places[j]) + noise(k));
    pairs(all.enumerate().map(range))
}

/// The largest error of any distance, which does not depend on the frame, m.
fn worst(found: &Survey, places: &[[f64; 3]]) -> f64 {
    let all = (0..places.len()).flat_map(|j| (0..j).map(move |i| (i, j)));
    let error = |(i, j): (usize, usize)| {
        (distance(found.places[i], found.places[j]) - distance(places[i], places[j])).abs()
    };
    all.map(error).fold(0.0, f64::max)
}

#[test]
fn a_hall_is_found_in_space() {
    let found = survey(6, &measured(&HALL), 3).unwrap();
    assert!(worst(&found, &HALL) < 0.15, "{found:?}");
    assert!(found.left_out.is_empty() && found.ambiguous.is_empty(), "{found:?}");
    let [first, second, third] = [0, 1, 2].map(|i| found.places[i]);
    assert!(first == [0.0; 3] && second[1] == 0.0 && second[2] == 0.0 && third[2] == 0.0);
    assert!(second[0] > 0.0 && third[1] > 0.0);
    assert!(found.sigmas.iter().flatten().all(|sigma| (0.005..1.0).contains(sigma)));
}

#[test]
fn a_pair_behind_a_wall_is_left_out_and_told() {
    let eight: Vec<_> = HALL.iter().copied().chain([[5.0, 6.0, 0.2], [15.0, 5.0, 4.0]]).collect();
    for wrong in 0..28 {
        let mut pairs = measured(&eight);
        pairs[wrong].metres += 3.0;
        let found = survey(8, &pairs, 3).unwrap();
        assert!(worst(&found, &eight) < 0.3, "{wrong}: {}", worst(&found, &eight));
        let told: Vec<_> = found.left_out.iter().map(|(pair, _)| pair.anchors).collect();
        assert_eq!(told, [pairs[wrong].anchors]);
        assert!((found.left_out[0].1 - 3.0).abs() < 0.5);
    }
}

#[test]
fn anchors_at_one_height_are_found_in_the_plane_alone() {
    let flat: Vec<_> = HALL.iter().map(|[x, y, _]| [*x, *y, 0.0]).collect();
    let found = survey(6, &measured(&flat), 2).unwrap();
    assert!(worst(&found, &flat) < 0.15, "{found:?}");
    assert!(
        found.places.iter().zip(&found.sigmas).all(|(at, sigma)| at[2] == 0.0 && sigma[2] == 0.0)
    );
    assert_eq!(survey(6, &measured(&flat), 3), Err(Unplaced::Flat { dimensions: 3 }));
}

/// What noise bends a line or a plane by is not a place: its linearised deviations would be too small.
#[test]
fn anchors_in_a_line_or_plane_are_refused_whatever_the_noise() {
    let line: Vec<_> = (0..4).map(|k| [3.0 * f64::from(k), 0.0, 0.0]).collect();
    let plane: Vec<_> = HALL.iter().map(|[x, y, _]| [*x, *y, 2.0]).collect();
    let bent = [[0.0; 3], [3.0, 0.0, 0.0], [6.0, 1.5, 0.0], [9.0, 0.0, 0.0]];
    for seed in 0..20 {
        let noisy = |places: &[[f64; 3]]| {
            let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
            let mut pairs = measured(places);
            for pair in &mut pairs {
                let noise: f64 = StandardNormal.sample(&mut random);
                pair.metres += 0.02 * noise;
            }
            pairs
        };
        let refused = [(&line, 2), (&plane, 3)]
            .map(|(places, dimensions)| survey(places.len(), &noisy(places), dimensions).is_err());
        assert_eq!(refused, [true; 2], "{seed}");
        let found = survey(4, &noisy(&bent), 2).expect("a bend of 1.5 m shows");
        assert!(worst(&found, &bent) < 0.3, "{seed}");
        survey(6, &noisy(&HALL), 3).expect("a hall");
    }
}

#[test]
fn what_is_not_determined_is_refused_or_told() {
    assert_eq!(
        survey(3, &measured(&HALL[..3]), 3),
        Err(Unplaced::TooFew { dimensions: 3, found: 3 })
    );
    let of = |keep: fn(&Pair) -> bool| {
        let mut pairs = measured(&HALL);
        pairs.retain(keep);
        survey(6, &pairs, 3)
    };
    // Two ranges to the last anchor: it may be anywhere on a circle.
    let loose = of(|pair| pair.anchors[1] != 5 || pair.anchors[0] < 2);
    assert_eq!(loose, Err(Unplaced::Loose(vec![5])));
    // Three: at one of two places.
    let mirrored = of(|pair| pair.anchors[1] != 5 || pair.anchors[0] < 3).unwrap();
    assert_eq!(mirrored.ambiguous, [5], "{mirrored:?}");
}
