//! A station that observes.

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

/// Lowest elevation at which the receiver tracks, rad.
const HORIZON: f64 = 0.087;
/// So far below, rad, nobody need know when the signal was sent: in a tenth of a second a satellite moves by 10⁻⁵ rad.
const FAR_BELOW: f64 = HORIZON - 1e-3;
/// Nothing is seen of a satellite in this share of the epochs …
const MISSING: f64 = 0.002;
/// … and for this share of these the receiver loses its phase, and says so.
const LOST: f64 = 0.1;
/// White noise of a code.
const CODE: Spread = Spread { zenith: 0.12, horizon: 0.6 };
/// Multipath of a code, and how long it remembers, s.
const CODE_MULTIPATH: Spread = Spread { zenith: 0.2, horizon: 0.6 };
const CODE_MEMORY_S: f64 = 600.0;
/// White noise of a phase.
const PHASE: Spread = Spread { zenith: 1e-3, horizon: 3e-3 };
/// Multipath of a phase.
const PHASE_MULTIPATH: Spread = Spread { zenith: 1.2e-3, horizon: 4e-3 };
const PHASE_MEMORY_S: f64 = 360.0;

/// A receiver at its place.
#[derive(Debug)]
pub(super) struct Station {
    place: Geodetic,
    clock: ReceiverClock,
    air: Air,
    ionosphere: Ionosphere,
    channels: Vec<Option<Channel>>,
}

/// What a receiver's channel has of its own.
#[derive(Debug, Clone, Copy)]
struct Channel {
    /// Cycles on L1 and L2.
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

/// What an epoch's observations have in common.
struct Instant {
    /// By the receiver's clock, s since midnight.
    tag: f64,
    /// The receiver's clock ahead of GPS time, s.
    clock: f64,
    /// The antenna, with the tide, ECEF, m.
    antenna: Vector3<f64>,
    enu_from_ecef: Matrix3<f64>,
    sun: Vector3<f64>,
}

/// What delays a signal on both carriers alike, and where it comes from.
struct Path {
    /// From the satellite's clock to the receiver's, m.
    range: f64,
    direction: Direction,
    /// ECEF.
    sight: Vector3<f64>,
    /// ECEF when the signal arrives, m.
    satellite: Vector3<f64>,
}

impl Station {
    /// Anywhere but near the poles.
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

    /// ECEF, m.
    pub(super) fn marker(&self) -> Vector3<f64> {
        self.place.to_ecef()
    }

    /// Lets an epoch pass and observes all satellites above the horizon.
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

    /// The signal's path, in the frame that does not rotate; none of a satellite that is far below the horizon.
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
