//! Trim and eigenvalues of two airframes against a reference with 60 digits, which `python3 tests/airframes.py`
//! prints.

use kestirim_uav_longitudinal::{Airframe, Error, SteadyFlight};
use nalgebra::{Complex, SVector};

/// Airspeed and climb angle; angle of attack, elevator and throttle; one eigenvalue of each pair.
type Flight = ([f64; 2], [f64; 3], [[f64; 2]; 2]);

const AEROSONDE: [Flight; 2] = [
    (
        [25.0, 0.0],
        [0.082_320_952_446_754_53, -0.109_323_923_859_533_44, 0.333_522_593_015_858_47],
        [
            [-1.402_214_321_042_892, 3.619_636_242_609_876_5],
            [-0.247_990_004_616_568_03, 0.453_541_660_795_902_46],
        ],
    ),
    (
        [35.0, 0.0],
        [0.003_490_156_292_273_521_3, -0.049_412_518_782_127_88, 0.463_820_976_676_685_6],
        [
            [-1.938_020_588_805_348, 5.065_659_834_403_429],
            [-0.366_066_155_009_851_75, 0.102_120_532_495_922_96],
        ],
    ),
];

const X8: [Flight; 3] = [
    (
        [15.0, 0.05],
        [0.058_397_409_165_231_72, -0.018_683_074_618_611_537, 0.431_495_063_367_982_1],
        [
            [-5.870_514_244_340_778, 9.215_434_729_456_057],
            [-0.290_242_915_610_710_95, 0.768_974_530_626_313_9],
        ],
    ),
    (
        [18.0, 0.05],
        [0.030_664_064_949_946_27, 0.037_328_116_643_411_306, 0.503_670_300_959_802_8],
        [
            [-7.014_897_341_637_133, 11.059_068_333_004_26],
            [-0.360_967_651_076_303_1, 0.582_667_758_149_973_4],
        ],
    ),
    (
        [24.0, 0.05],
        [0.002_934_251_881_543_849, 0.093_332_176_282_868_03, 0.656_425_331_044_111_7],
        [
            [-9.325_866_731_108_48, 14.744_551_280_187_648],
            [-0.495_489_933_110_723_8, 0.131_174_721_153_033_46],
        ],
    ),
];

#[test]
fn trim_and_eigenvalues_are_those_of_60_digits() -> Result<(), Error> {
    for (airframe, flights) in
        [(Airframe::aerosonde(), &AEROSONDE[..]), (Airframe::skywalker_x8(), &X8[..])]
    {
        for ([airspeed, climb_angle], expected, modes) in flights {
            let trim =
                airframe.trim(&SteadyFlight { airspeed: *airspeed, climb_angle: *climb_angle })?;
            let found = [trim.state[0], trim.input[0], trim.input[1]];
            for (found, expected) in found.iter().zip(expected) {
                assert!((found - expected).abs() < 1e-12, "{airspeed} m/s: {found} {expected}");
            }
            let eigenvalues = airframe.linearise(&trim)?.a.complex_eigenvalues();
            for [re, im] in modes {
                for expected in [Complex::new(*re, *im), Complex::new(*re, -im)] {
                    let off = eigenvalues.iter().map(|it| (it - expected).norm());
                    let off = off.fold(f64::INFINITY, f64::min) / expected.norm();
                    assert!(off < 1e-9, "{airspeed} m/s: {expected} off by {off:e}");
                }
            }
        }
    }
    Ok(())
}

#[test]
fn an_accelerometer_shows_what_rates_say() -> Result<(), Error> {
    for airframe in [Airframe::aerosonde(), Airframe::skywalker_x8()] {
        let mut trim = airframe.trim(&SteadyFlight { airspeed: 20.0, climb_angle: 0.1 })?;
        let force = airframe.specific_force(&trim)?;
        let at_rest = [trim.state[3].sin(), -trim.state[3].cos()].map(|part| 9.81 * part);
        for (axis, weight) in at_rest.iter().enumerate() {
            // Without acceleration, the specific force is that of the weight.
            assert!((force.steady[axis] - weight).abs() < 1e-12, "{axis}");
        }
        // The derivatives agree with finite differences.
        for (place, step) in [1e-5, 1e-5, 1e-4, 1e-5, 1e-5, 1e-5].into_iter().enumerate() {
            let mut changed = SVector::<f64, 2>::zeros();
            for way in [1.0, -1.0] {
                let before = trim;
                match place.checked_sub(4) {
                    None => trim.state[place] += way * step,
                    Some(input) => trim.input[input] += way * step,
                }
                changed += airframe.specific_force(&trim)?.steady * (way / (2.0 * step));
                trim = before;
            }
            let slope = match place.checked_sub(4) {
                None => force.c.column(place).into_owned(),
                Some(input) => force.d.column(input).into_owned(),
            };
            assert!((changed - slope).norm() < 1e-6 * (1.0 + slope.norm()), "{place}");
        }
    }
    Ok(())
}

#[test]
fn a_flight_that_cannot_be_is_refused() {
    let x8 = Airframe::skywalker_x8();
    let fast = x8.trim(&SteadyFlight { airspeed: 60.0, climb_angle: 0.0 });
    assert_eq!(fast, Err(Error::BeyondThrottle));
    let slow = x8.trim(&SteadyFlight { airspeed: 7.0, climb_angle: 0.0 });
    assert_eq!(slow, Err(Error::BeyondStall));
    let backwards = x8.trim(&SteadyFlight { airspeed: 18.0, climb_angle: 1.6 });
    assert_eq!(backwards, Err(Error::BeyondVertical));
}
