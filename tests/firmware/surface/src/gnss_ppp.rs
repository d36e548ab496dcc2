//! Calls everything of `kestirim-gnss-ppp`.

use kestirim_gnss_ppp::{
    Arc, Bodies, BodyAxes, Carriers, Clock, ClockReference, ClockSample, Constellation, Correction,
    Corrections, Direction, Ephemeris, Geodetic, GpsTime, Klobuchar, NavigationMessage,
    OceanLoading, Orbit, OrbitSample, OrbitState, Pattern, Receiver, SatelliteState, Site,
    SlipLimits, Troposphere, carried_along, eccentricity_clock, gradient_mapping,
    greenwich_sidereal_time, pole_tide, sagnac, shapiro_delay, solid_tide, wind_up,
    zenith_hydrostatic, zenith_wet,
};
use nalgebra::Vector3;

use super::values::{
    any, call_each, keep, matrix, maybe, number, numbers, one_of, option, rounds, slice, whole,
    yes_or_no,
};

fn time() -> GpsTime {
    any(GpsTime::new(whole(), number()))
}

fn place() -> Geodetic {
    any(Geodetic { latitude: number(), longitude: number(), height: number() })
}

fn axes() -> BodyAxes {
    any(BodyAxes { x: matrix(), y: matrix(), z: matrix() })
}

fn direction() -> Direction {
    any(Direction { elevation: number(), azimuth: number() })
}

fn carriers() -> Carriers {
    one_of([Carriers::L1L2, Carriers::G1G2 { channel: whole() }, Carriers::B1B3])
}

fn times() {
    keep(GpsTime::new_in_day(whole(), number()));
    keep(GpsTime::day(time()));
    keep(GpsTime::second(time()));
    keep(GpsTime::second_of_week(time()));
    keep(GpsTime::nearest_second_of_week(time(), number()));
    keep(GpsTime::plus(time(), number()));
    keep(GpsTime::since(time(), time()));
    keep(GpsTime::days_since_j2000(time(), number()));
    keep(greenwich_sidereal_time(time(), number()));
    keep(time().partial_cmp(&time()));
}

fn patterns() {
    let (mean, by_azimuth) = (numbers::<f64, 4>(), numbers::<f64, 4>());
    let (mean, by_azimuth) = (slice(&mean), slice(&by_azimuth));
    let (offset, first, step) = (numbers(), number(), number());
    let pattern = Pattern { offset, first, step, mean, azimuth_step: number(), by_azimuth };
    let pattern = any(pattern);
    keep(Pattern::variation(&pattern, number(), option()));
    keep(Pattern::receiver_range(&pattern, direction()));
    keep(Pattern::satellite_offset(&pattern, &axes()));
    keep(Pattern::satellite_variation(&pattern, &axes(), &matrix()));
    keep(Pattern::satellite_range(&pattern, &axes(), &matrix()));
    site(pattern);
}

fn site(pattern: Pattern<'_>) {
    let corrections = any(<Corrections as Default>::default());
    keep(Corrections::has(corrections, one_of(Correction::ALL)));
    let corrections = any(Corrections::without(corrections, one_of(Correction::ALL)));
    let ocean = any(OceanLoading { amplitude: [numbers(); 3], lag: [numbers(); 3] });
    keep(OceanLoading::displacement(&ocean, time(), number()));
    let receiver = any(Receiver {
        antenna: maybe([pattern; 2]),
        galileo_antenna: maybe([pattern; 2]),
        glonass_antenna: maybe([pattern; 2]),
        beidou_antenna: maybe([pattern; 2]),
        eccentricity: numbers(),
        ocean_loading: maybe(&ocean),
        pole: maybe(numbers()),
        ut1_minus_gps: number(),
        corrections,
    });
    let site = any(Site::new(&receiver, &matrix(), time()));
    keep(Site::enu_from_ecef(&site));
    let state = any(SatelliteState {
        position: matrix(),
        velocity: matrix(),
        clock: number(),
        clock_interval: number(),
        clock_distance: number(),
        accuracy: number(),
    });
    keep(Site::expect(&site, &state, carriers(), maybe(&[pattern; 2]), option()));
}

fn satellites() {
    let samples = any([ClockSample { second: number(), bias: number() }; 4]);
    let (reference, samples) = (time(), slice(&samples));
    let clock = any(Clock { reference, samples, longest_gap: number() });
    keep(Clock::at(&clock, time()));
    let sample = any(OrbitSample::from_ecef(time(), time(), &matrix()));
    let samples = any([sample; 12]);
    let orbit = any(Orbit { reference, samples: slice(&samples) });
    keep(Orbit::at(&orbit, time()));
    if let Some(axes) = any(BodyAxes::nominal(&matrix(), &matrix())) {
        keep(BodyAxes::to_ecef(&axes, &numbers()));
        keep(BodyAxes::from_ecef(&axes, &matrix()));
    }
    keep(wind_up(&axes(), &matrix(), &matrix(), option()));
}

/// Any ephemeris.
fn ephemeris() -> Ephemeris {
    Ephemeris {
        constellation: one_of(Constellation::ALL),
        time: time(),
        clock_time: time(),
        clock: numbers(),
        issue: whole(),
        group_delay: number(),
        root_of_axis: number(),
        eccentricity: number(),
        mean_anomaly: number(),
        mean_motion_correction: number(),
        perigee: number(),
        node: number(),
        node_rate: number(),
        inclination: number(),
        inclination_rate: number(),
        latitude_terms: numbers(),
        radius_terms: numbers(),
        inclination_terms: numbers(),
        accuracy: number(),
        holds: number(),
    }
}

fn broadcast() {
    let all = any([ephemeris(); 3]);
    if let Some(ephemeris) = any(Ephemeris::nearest(slice(&all), time())) {
        keep(Ephemeris::holds_at(ephemeris, time()));
        keep(Ephemeris::clock_at(ephemeris, time()));
        let orbit = any(Ephemeris::orbit_at(ephemeris, time()));
        keep(OrbitState::corrected(&orbit, numbers()));
    }
    let ionosphere = any(Klobuchar { alpha: numbers(), beta: numbers() });
    keep(Klobuchar::delay(&ionosphere, &place(), &direction(), time()));
    let message = one_of([NavigationMessage::Lnav, NavigationMessage::D1]);
    let reference: Option<ClockReference> =
        NavigationMessage::clock_reference(message, carriers(), numbers());
    keep(reference);
    keep(NavigationMessage::holds(message));
}

fn earth() {
    keep(Geodetic::from_ecef(&matrix()));
    keep(Geodetic::to_ecef(&place()));
    keep(Geodetic::enu_from_ecef(&place()));
    keep(Direction::local(direction()));
    keep(gradient_mapping(&matrix()));
    keep(Direction::of(&matrix(), &place()));
    let bodies = any(Bodies::at(time(), number()));
    keep(pole_tide(&matrix(), numbers(), time()));
    keep(solid_tide(&matrix(), &bodies, time(), number()));
    let air = any(Troposphere::over(&place(), time()));
    keep(Troposphere::zenith_hydrostatic(&air));
    keep(Troposphere::mapping(&air, number()));
    keep(Troposphere::hydrostatic(&air, number()));
    keep(zenith_hydrostatic(&place()));
    keep(zenith_wet(&place(), number()));
    let vector = matrix::<f64, 3, 1>;
    keep(eccentricity_clock(&vector(), &vector()));
    keep(shapiro_delay(&vector(), &vector()));
    keep(sagnac(&vector(), &vector()));
    keep::<Vector3<f64>>(carried_along(&vector(), number()));
}

fn signals() {
    let pair = carriers();
    keep(Carriers::constellation(pair));
    keep(Carriers::frequency(pair));
    keep(Carriers::wavelength(pair));
    keep(Carriers::narrow_lane(pair));
    keep(Carriers::wide_lane(pair));
    keep(Carriers::ionosphere_free(pair, numbers()));
    keep(Carriers::geometry_free(pair, numbers()));
    keep(Carriers::melbourne_wuebbena(pair, numbers(), numbers()));
    keep(Carriers::ionosphere_free_phase(pair, numbers()));
    let mut arc = any(Arc::begin(time(), pair, numbers(), numbers()));
    let limits = any(<SlipLimits as Default>::default());
    for _ in 0..rounds() {
        keep(Arc::observe(any(&mut arc), time(), numbers(), numbers(), yes_or_no(), &limits));
    }
    Arc::restart(any(&mut arc), time(), numbers(), numbers());
    keep(Arc::is_suspicious(&arc));
    keep(Arc::stays_away(&arc));
    keep(Arc::jump(&arc, numbers(), numbers()));
    keep(Arc::carriers(&arc));
    keep(Arc::last(&arc));
}

/// Calls everything in this module.
pub fn run() {
    call_each([times, patterns, satellites, broadcast, earth, signals]);
}
