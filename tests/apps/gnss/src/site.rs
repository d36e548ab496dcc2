//! The receiver and its filter configuration: the part to adapt first when copying this application.

use kestirim_gnss_ppp::{Corrections, OceanLoading, Pattern, Receiver};
use kestirim_ppp_filter::{Config, Estimator, Lean, Motion};

/// The phase centres of the satellites, in the form of IGS files (ANTEX): nadir angles of 0°, 7° and 14°. Those of a
/// GPS IIF are used for all.
static SATELLITE_ANTENNA: [Pattern<'static>; 2] = {
    const L1: Pattern<'static> = Pattern {
        offset: [0.279, 0.0, 2.3195],
        first: 0.0,
        step: 7.0,
        mean: &[-0.0008, -0.0045, 0.0026],
        azimuth_step: 0.0,
        by_azimuth: &[],
    };
    [L1, Pattern { offset: [0.279, 0.0, 2.2895], ..L1 }]
};

/// The phase centres of the receiver's antenna: zenith angles of 0°, 30°, 60° and 90°, azimuths of 0°, 180° and 360°.
static RECEIVER_ANTENNA: [Pattern<'static>; 2] = {
    const L1: Pattern<'static> = Pattern {
        offset: [0.0012, -0.0004, 0.0892],
        first: 0.0,
        step: 30.0,
        mean: &[0.0, -0.0041, -0.0018, 0.0094],
        azimuth_step: 180.0,
        by_azimuth: &[
            0.0, -0.0040, -0.0016, 0.0090, 0.0, -0.0042, -0.0020, 0.0098, 0.0, -0.0040, -0.0016,
            0.0090,
        ],
    };
    [L1, Pattern { offset: [0.0, 0.0001, 0.1185], ..L1 }]
};

/// The ocean loading at the receiver, in the form of a service (BLQ).
static OCEAN_LOADING: OceanLoading = OceanLoading {
    amplitude: [
        [0.0074, 0.0023, 0.0017, 0.0006, 0.0013, 0.0008, 0.0004, 0.0002, 0.0006, 0.0003, 0.0003],
        [0.0022, 0.0007, 0.0005, 0.0002, 0.0003, 0.0002, 0.0001, 0.0001, 0.0, 0.0, 0.0],
        [0.0012, 0.0003, 0.0003, 0.0001, 0.0002, 0.0001, 0.0001, 0.0, 0.0001, 0.0, 0.0],
    ],
    lag: [
        [-64.2, -40.1, -92.9, -43.5, -53.2, -104.7, -54.0, -153.2, 2.8, -9.5, 0.3],
        [89.1, 118.4, 66.6, 117.1, 113.0, 16.5, 110.9, -41.1, -171.9, 176.0, 179.1],
        [25.5, 78.8, -1.3, 79.9, 28.4, -29.6, 27.5, -65.4, 9.9, 178.2, 0.0],
    ],
};

/// The properties of the receiver.
pub const fn receiver() -> Receiver<'static> {
    Receiver {
        antenna: Some(RECEIVER_ANTENNA),
        galileo_antenna: None,
        glonass_antenna: None,
        beidou_antenna: None,
        eccentricity: [0.0, 0.0, 0.0083],
        ocean_loading: Some(&OCEAN_LOADING),
        pole: None,
        ut1_minus_gps: -18.24,
        corrections: Corrections::ALL,
    }
}

/// The properties of a satellite's antenna.
pub const fn satellite_antenna() -> Option<[Pattern<'static>; 2]> {
    Some(SATELLITE_ANTENNA)
}

/// The configuration for a static station; tropospheric gradients would take the room of two satellites.
pub fn config() -> Config<Lean> {
    let config = Config { gradient: 0.0, ..Config::new(Motion::Static) };
    config.with_estimator(Estimator::at_rest())
}

/// The configuration for the same station with broadcast ephemerides, corrected or not, instead of products.
pub fn without_products() -> Config<Lean> {
    Config::broadcast(Motion::Static).with_estimator(Estimator::at_rest())
}
