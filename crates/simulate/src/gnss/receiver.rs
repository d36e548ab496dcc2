//! An observing station.

use std::f64::consts::TAU;

use kestirim_gnss_files::Observed;
use kestirim_gnss_ppp::constants::SPEED_OF_LIGHT;
use kestirim_gnss_ppp::{
    Bodies, BodyAxes, Direction, FREQUENCY, Geodetic, WAVELENGTH, carried_along, shapiro_delay,
    solid_tide, wind_up,
};
use kestirim_replay::gnss::Epoch;
use nalgebra::{Matrix3, Vector3};
use rand_core::Rng;

use super::atmosphere::{Air, Ionosphere, Wave};
use super::clocks::ReceiverClock;
use super::noise::{Spread, Wander};
use super::products::{Services, Spacecraft};
use super::times::{INTERVAL_S, MIDNIGHT, UTC_MINUS_GPS};
use crate::random::{normal, uniform};

/// The lowest elevation at which the receiver tracks, rad.
const HORIZON: f64 = 0.087;
/// The elevation below which the time of transmission need not be computed, rad: in a tenth of a second a satellite
/// moves by 10⁻⁵ rad.
const FAR_BELOW: f64 = HORIZON - 1e-3;
/// The share of epochs in which a satellite is not observed.
const MISSING: f64 = 0.002;
/// The share of unobserved epochs in which the receiver loses the phase, and reports it.
const LOST: f64 = 0.1;
/// The white noise of the code.
const CODE: Spread = Spread { zenith: 0.12, horizon: 0.6 };
/// The multipath of the code, and its correlation time, s.
const CODE_MULTIPATH: Spread = Spread { zenith: 0.2, horizon: 0.6 };
const CODE_MEMORY_S: f64 = 600.0;
/// The white noise of the phase.
const PHASE: Spread = Spread { zenith: 1e-3, horizon: 3e-3 };
/// The multipath of the phase, and its correlation time, s.
const PHASE_MULTIPATH: Spread = Spread { zenith: 1.2e-3, horizon: 4e-3 };
const PHASE_MEMORY_S: f64 = 360.0;

/// A receiver at its position.
#[derive(Debug)]
pub(super) struct Station {
    place: Geodetic,
    clock: ReceiverClock,
    air: Air,
    ionosphere: Ionosphere,
    channels: Vec<Option<Channel>>,
}

/// The state of one receiver channel.
#[derive(Debug, Clone, Copy)]
struct Channel {
    /// The ambiguities on L1 and L2, cycles.
    ambiguity: [f64; 2],
    wind_up: Option<f64>,
    code: [Wander; 2],
    phase: [Wander; 2],
    wave: Wave,
    lost: bool,
}

impl Channel {
    fn draw(rng: &mut impl Rng) -> Self {
        Self {
            ambiguity: ambiguity(rng),
            wind_up: None,
            code: [(); 2].map(|()| Wander::draw(CODE_MEMORY_S, rng)),
            phase: [(); 2].map(|()| Wander::draw(PHASE_MEMORY_S, rng)),
            wave: Wave::draw(rng),
            lost: false,
        }
    }
}

fn ambiguity(rng: &mut impl Rng) -> [f64; 2] {
    [(); 2].map(|()| (2e6 * (uniform(rng) - 0.5)).round())
}

/// Quantities that all observations of an epoch share.
struct Instant {
    /// The epoch by the receiver's clock, s since midnight.
    tag: f64,
    /// The offset of the receiver's clock from GPS time, s; positive if it is ahead.
    clock: f64,
    /// The position of the antenna, including the tide, ECEF, m.
    antenna: Vector3<f64>,
    enu_from_ecef: Matrix3<f64>,
    sun: Vector3<f64>,
}

/// The path of a signal, with the delays that both carriers share.
struct Path {
    /// The range between the satellite's clock and the receiver's, m.
    range: f64,
    direction: Direction,
    /// The line of sight, ECEF.
    sight: Vector3<f64>,
    /// The position of the satellite, in the ECEF frame at reception, m.
    satellite: Vector3<f64>,
}

impl Station {
    /// Draws a station anywhere except near the poles.
    pub(super) fn draw(rng: &mut impl Rng) -> Self {
        let place = Geodetic {
            latitude: (1.88 * (uniform(rng) - 0.5)).asin(),
            longitude: TAU * (uniform(rng) - 0.5),
            height: 1000.0 * uniform(rng),
        };
        Self {
            place,
            clock: ReceiverClock::draw(rng),
            air: Air::draw(&place, rng),
            ionosphere: Ionosphere::draw(rng),
            channels: Vec::new(),
        }
    }

    /// The position of the marker, ECEF, m.
    pub(super) fn marker(&self) -> Vector3<f64> {
        self.place.to_ecef()
    }

    /// Advances by one epoch and observes all satellites above the horizon.
    pub(super) fn observe(&mut self, services: &Services, epoch: u32, rng: &mut impl Rng) -> Epoch {
        let tag = f64::from(epoch) * INTERVAL_S;
        let time = MIDNIGHT.plus(tag);
        self.air.advance(rng);
        let bodies = Bodies::at(time, UTC_MINUS_GPS);
        let marker = self.marker();
        let instant = Instant {
            tag,
            clock: self.clock.next(rng),
            antenna: marker + solid_tide(&marker, &bodies, time, UTC_MINUS_GPS),
            enu_from_ecef: self.place.enu_from_ecef(),
            sun: bodies.sun,
        };
        self.channels.resize(services.0.len(), None);
        let satellites = (1..).zip(&services.0).filter_map(|(prn, spacecraft)| {
            let path = self.path(&instant, spacecraft);
            let channel = &mut self.channels[usize::from(prn) - 1];
            let Some(path) = path.filter(|path| path.direction.elevation >= HORIZON) else {
                *channel = None;
                return None;
            };
            let channel = channel.get_or_insert_with(|| Channel::draw(rng));
            if uniform(rng) < MISSING {
                if uniform(rng) < LOST {
                    *channel = Channel { ambiguity: ambiguity(rng), lost: true, ..*channel };
                }
                return None;
            }
            let ionosphere = self.ionosphere.delay(&self.place, path.direction, tag, &channel.wave);
            Some(channel.observe(prn, &instant, &path, ionosphere, rng))
        });
        Epoch { time, power_failure: false, satellites: satellites.collect() }
    }

    /// The signal's path, computed in the inertial frame; `None` for a satellite far below the horizon.
    fn path(&self, instant: &Instant, spacecraft: &Spacecraft) -> Option<Path> {
        let received = instant.tag - instant.clock;
        let receiver = carried_along(&instant.antenna, -received);
        let direction_of = |sight: &Vector3<f64>| Direction::of(sight, &self.place);
        let mut flight = 0.07;
        let mut motion = spacecraft.orbit.at(received - flight);
        let towards = carried_along(&motion.position, received) - instant.antenna;
        if direction_of(&towards.normalize()).elevation < FAR_BELOW {
            return None;
        }
        for _ in 0..4 {
            let before = flight;
            flight = (motion.position - receiver).norm() / SPEED_OF_LIGHT;
            if flight == before {
                break;
            }
            motion = spacecraft.orbit.at(received - flight);
        }
        let sent = received - flight;
        let satellite = carried_along(&motion.position, received);
        let sight = (satellite - instant.antenna).normalize();
        let direction = direction_of(&sight);
        let ahead = spacecraft.clock.at(sent) + motion.relativity;
        let range = (motion.position - receiver).norm()
            + SPEED_OF_LIGHT * (instant.clock - ahead)
            + shapiro_delay(&motion.position, &receiver)
            + if direction.elevation < HORIZON { 0.0 } else { self.air.delay(direction) };
        Some(Path { range, direction, sight, satellite })
    }
}

impl Channel {
    fn observe(
        &mut self,
        prn: u8,
        instant: &Instant,
        path: &Path,
        ionosphere: f64,
        rng: &mut impl Rng,
    ) -> Observed {
        let elevation = path.direction.elevation;
        if let Some(axes) = BodyAxes::nominal(&path.satellite, &instant.sun) {
            let cycles = wind_up(&axes, &instant.enu_from_ecef, &path.sight, self.wind_up);
            self.wind_up = Some(cycles);
        }
        let lost = std::mem::take(&mut self.lost);
        let mut observed = Observed { prn, loss_of_lock: [lost; 2], ..Observed::default() };
        for carrier in 0..2 {
            let delay = ionosphere * (FREQUENCY[0] / FREQUENCY[carrier]).powi(2);
            let code = normal(rng, CODE.at(elevation))
                + CODE_MULTIPATH.at(elevation) * self.code[carrier].next(rng);
            let phase = normal(rng, PHASE.at(elevation))
                + PHASE_MULTIPATH.at(elevation) * self.phase[carrier].next(rng);
            let cycles = self.ambiguity[carrier] + self.wind_up.unwrap_or(0.0);
            observed.code[carrier] = Some(path.range + delay + code);
            observed.phase[carrier] =
                Some((path.range - delay + phase) / WAVELENGTH[carrier] + cycles);
        }
        observed
    }
}
