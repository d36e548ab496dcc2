//! Property tests: no number makes the model panic, and no finite and realistic one gives a result that is not finite.

use kestirim_gnss_ppp::{
    Bodies, BodyAxes, Direction, Geodetic, GpsTime, OceanLoading, Pattern, Troposphere,
    carried_along, eccentricity_clock, greenwich_sidereal_time, sagnac, shapiro_delay, solid_tide,
    wind_up, zenith_hydrostatic, zenith_wet,
};
use nalgebra::Vector3;
use proptest::prelude::*;

fn vector() -> impl Strategy<Value = Vector3<f64>> {
    [any::<f64>(), any::<f64>(), any::<f64>()].prop_map(Vector3::from)
}

/// A position of a satellite or a receiver.
fn position() -> impl Strategy<Value = Vector3<f64>> {
    ([-1.0..1.0, -1.0..1.0, -1.0..1.0], 6.3e6..3e7)
        .prop_filter("a direction", |(direction, _)| Vector3::from(*direction).norm() > 1e-3)
        .prop_map(|(direction, radius)| Vector3::from(direction).normalize() * radius)
}

/// Everything that the crate computes, as numbers.
fn everything(
    time: GpsTime,
    offset: f64,
    satellite: &Vector3<f64>,
    receiver: &Vector3<f64>,
    grid: &[f64],
) -> Vec<f64> {
    let bodies = Bodies::at(time, offset);
    let place = Geodetic::from_ecef(receiver);
    let sight = (satellite - receiver).try_normalize(1e-300).unwrap_or(*receiver);
    let direction = Direction::of(&sight, &place);
    let troposphere = Troposphere::over(&place, time);
    let mapping = troposphere.mapping(direction.elevation);
    let loading = OceanLoading { amplitude: [[0.01; 11]; 3], lag: [[offset; 11]; 3] };
    let (mean, by_azimuth) = grid.split_at(grid.len() / 4);
    let pattern = Pattern {
        offset: [0.1, 0.2, 0.3],
        first: 0.0,
        step: 5.0,
        mean,
        azimuth_step: 120.0,
        by_azimuth,
    };
    let mut numbers = vec![
        greenwich_sidereal_time(time, offset),
        eccentricity_clock(satellite, receiver),
        shapiro_delay(satellite, receiver),
        sagnac(satellite, receiver),
        zenith_hydrostatic(&place),
        zenith_wet(&place, 0.5),
        troposphere.hydrostatic(direction.elevation),
        mapping.hydrostatic,
        mapping.wet,
        pattern.receiver_range(direction),
    ];
    if let Some(axes) = BodyAxes::nominal(satellite, &bodies.sun) {
        numbers.push(wind_up(&axes, &place.enu_from_ecef(), &sight, Some(offset)));
        numbers.push(pattern.satellite_range(&axes, &sight));
    }
    for vector in [
        bodies.sun,
        bodies.moon,
        solid_tide(receiver, &bodies, time, offset),
        loading.displacement(time, offset),
        carried_along(satellite, 0.07),
    ] {
        numbers.extend(vector.iter());
    }
    numbers
}

proptest! {
    #[test]
    fn no_panic(
        day in any::<i32>(),
        second in any::<f64>(),
        offset in any::<f64>(),
        satellite in vector(),
        receiver in vector(),
        grid in proptest::collection::vec(any::<f64>(), 0..20),
    ) {
        everything(GpsTime::new(day, second), offset, &satellite, &receiver, &grid);
    }

    #[test]
    fn finite_in_this_world(
        day in 40_000..80_000,
        second in 0.0..86_400.0,
        satellite in position(),
        receiver in position(),
        grid in proptest::collection::vec(-0.1..0.1, 0..20),
    ) {
        for number in everything(GpsTime::new(day, second), -18.0, &satellite, &receiver, &grid) {
            prop_assert!(number.is_finite());
        }
    }

    #[test]
    fn any_pattern_and_any_direction(
        [first, step, azimuth_step, angle, azimuth] in any::<[f64; 5]>(),
        mean in proptest::collection::vec(-0.1..0.1, 0..8),
        by_azimuth in proptest::collection::vec(-0.1..0.1, 0..40),
    ) {
        let pattern = Pattern {
            offset: [0.0; 3],
            first,
            step,
            mean: &mean,
            azimuth_step,
            by_azimuth: &by_azimuth,
        };
        let variation = pattern.variation(angle, Some(azimuth));
        prop_assert!(variation.abs() <= 0.1, "{variation}");
    }
}
