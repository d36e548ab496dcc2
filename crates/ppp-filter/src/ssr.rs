//! Broadcast ephemerides with the corrections of a service (state-space representation, SSR).

use heapless::Vec;
use kestirim_gnss_message::ssr::{Clock, Correction, Header, Message, Orbit};
use kestirim_gnss_ppp::constants::SPEED_OF_LIGHT;
use kestirim_gnss_ppp::{Ephemeris, GpsTime, SatelliteState};

use crate::{Broadcast, NoEphemeris};

/// How long a correction serves if no newer one comes: for two intervals, within these limits, s.
const HOLDS: [f64; 2] = [90.0, 120.0];
/// A signal received when a correction begins was sent a little earlier, s.
const EARLIER: f64 = 1.0;
/// The largest corrections that are believed, of an orbit and of a clock, m.
const LARGEST_ORBIT: f64 = 10.0;
const LARGEST_CLOCK: f64 = 300.0;
/// The standard deviation of a range by corrected orbits and clocks, m: the IGS states 5 cm for the orbits of its real-time
/// service, of which a range holds about a fifth, and 0.12 ns for the clocks.
const ACCURACY: f64 = 0.04;

/// A correction that serves from a time on.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Timed<T> {
    since: GpsTime,
    reference: GpsTime,
    holds: f64,
    configuration: u8,
    /// The correction.
    pub value: T,
}

impl<T> Timed<T> {
    /// A correction of a message with this header, in the week in which its time is nearest to an instant.
    pub fn new(near: GpsTime, header: &Header, value: T) -> Self {
        let since = near.nearest_second_of_week(header.second);
        let reference = since.plus(header.reference - header.second);
        let [least, most] = HOLDS;
        let holds = (2.0 * header.interval).max(least).min(most);
        Self { since, reference, holds, configuration: header.configuration, value }
    }

    /// The time from which the correction serves.
    pub const fn since(&self) -> GpsTime {
        self.since
    }

    /// Whether the correction serves at a time, if there is no newer one.
    pub fn serves_at(&self, time: GpsTime) -> bool {
        (-EARLIER..=self.holds).contains(&time.since(self.since))
    }

    /// Whether the correction serves, or served or will serve, about the time when something is received.
    fn is_current_at(&self, received: GpsTime) -> bool {
        received.since(self.since).abs() <= self.holds
    }

    /// Whether a correction that was received now is to replace this one: messages may come late.
    fn is_replaced_by(&self, newer: &Self, received: GpsTime) -> bool {
        newer.since.since(self.since) >= 0.0 || !self.is_current_at(received)
    }
}

/// The state of a satellite that sends at `sent`, by a broadcast ephemeris and corrections of it. `None` if one of these does not
/// serve then, if they do not belong together, or if a correction is so large that it must be wrong (10 m; 300 m for a clock).
///
/// The clock of the ephemeris must be that of its own message, whichever carriers are observed: corrections of LNAV and I/NAV
/// refer to it. (IGS SSR 1.00, 4.1 and 4.2.)
pub fn corrected(
    ephemeris: &Ephemeris,
    orbit: &Timed<Orbit>,
    clock: &Timed<Clock>,
    sent: GpsTime,
) -> Option<SatelliteState> {
    let are_current = orbit.serves_at(sent) && clock.serves_at(sent) && ephemeris.holds_at(sent);
    let are_of_one =
        orbit.value.is_of(ephemeris.issue) && orbit.configuration == clock.configuration;
    if !are_current || !are_of_one || !ephemeris.accuracy.is_finite() {
        return None;
    }
    let offset = orbit.value.at(sent.since(orbit.reference));
    let metres = clock.value.at(sent.since(clock.reference));
    let is_large = |it: &f64| it.abs() > LARGEST_ORBIT;
    if offset.iter().any(is_large) || metres.abs() > LARGEST_CLOCK {
        return None;
    }
    let bias = ephemeris.clock_at(sent) + metres / SPEED_OF_LIGHT;
    let state = ephemeris.orbit_at(sent.plus(-bias)).corrected(offset)?;
    Some(SatelliteState {
        position: state.position,
        velocity: state.velocity,
        clock: bias,
        clock_interval: 0.0,
        clock_distance: 0.0,
        accuracy: ACCURACY,
    })
}

/// The newest corrections of up to N satellites by one service, with the ephemerides that they correct: positions become good to a
/// decimetre, as with a service's files, by messages alone.
///
/// ```
/// use kestirim_gnss_message::ssr::Message;
/// use kestirim_gnss_ppp::GpsTime;
/// use kestirim_ppp_filter::{Broadcast, Corrected};
///
/// let (mut broadcast, mut corrected) = (Broadcast::<32>::new(), Corrected::<32>::new());
/// # let data = [66, 34, 0, 0, 0, 0, 0, 0, 0, 0];
/// let now = GpsTime::new(59_025, 43_200.0);
/// // The navigation messages of satellites go to `broadcast`; the data of a frame of RTCM 3:
/// if let Some(message) = Message::from_data(&data) {
///     // Satellites have the numbers that they have in observations.
///     corrected.take(&message, |satellite| Some(satellite), &broadcast, now);
/// }
/// let state = corrected.state(5, &broadcast, now, 21e6);
/// # assert!(state.is_err());
/// ```
#[derive(Clone, Debug, Default)]
pub struct Corrected<const N: usize> {
    satellites: Vec<Satellite, N>,
    provider: Option<(u16, u8)>,
}

/// The corrections of one satellite.
#[derive(Clone, Copy, Debug)]
struct Satellite {
    number: u8,
    /// The ephemeris to which the orbit's correction belongs. A newer one is received before the service corrects it.
    ephemeris: Ephemeris,
    /// The time from which this ephemeris has been corrected: a clock's correction, which does not name its ephemeris, is one of
    /// it from then on.
    begun: GpsTime,
    orbit: Timed<Orbit>,
    clock: Option<Timed<Clock>>,
}

impl<const N: usize> Corrected<N> {
    /// A collection without corrections.
    pub const fn new() -> Self {
        Self { satellites: Vec::new(), provider: None }
    }

    /// Takes a message received at a time, with the ephemerides known by then. `number` gives the number of a satellite of the
    /// message's system in [`SatelliteObservation`](crate::SatelliteObservation) and in `broadcast`, or `None` for one that is
    /// not used. Corrections of codes are the caller's: they are to be added to the codes of
    /// [`Message::corrections`]' signals.
    ///
    /// Messages of another service are left out while corrections of one serve; so are orbits without their ephemeris, and a
    /// message at a time that is not finite.
    pub fn take<const M: usize>(
        &mut self,
        message: &Message<'_>,
        number: impl Fn(u8) -> Option<u8>,
        broadcast: &Broadcast<M>,
        received: GpsTime,
    ) {
        if !received.second().is_finite() {
            return;
        }
        let Header { provider, .. } = message.header;
        if self.provider != Some(provider) {
            if self.satellites.iter().any(|it| it.orbit.is_current_at(received)) {
                return;
            }
            self.satellites.clear();
            self.provider = Some(provider);
        }
        for (satellite, correction) in message.corrections() {
            let Some(number) = number(satellite) else { continue };
            match correction {
                Correction::Orbit(orbit) => {
                    let orbit = Timed::new(received, &message.header, orbit);
                    self.take_orbit(number, orbit, broadcast.newest(number), received);
                }
                Correction::Clock(clock) => {
                    let clock = Timed::new(received, &message.header, clock);
                    self.take_clock(number, clock, received);
                }
                Correction::Code { .. } => {}
            }
        }
    }

    fn take_clock(&mut self, number: u8, clock: Timed<Clock>, received: GpsTime) {
        let Some(of) = self.satellites.iter_mut().find(|it| it.number == number) else { return };
        let is_of_ephemeris = clock.since.since(of.begun) >= 0.0;
        let is_newer = of.clock.as_ref().is_none_or(|it| it.is_replaced_by(&clock, received));
        if is_of_ephemeris && is_newer {
            of.clock = Some(clock);
        }
    }

    fn take_orbit(
        &mut self,
        number: u8,
        orbit: Timed<Orbit>,
        newest: Result<Ephemeris, NoEphemeris>,
        received: GpsTime,
    ) {
        let place = self.satellites.iter().position(|it| it.number == number);
        let own = place.and_then(|place| self.satellites.get(place)).copied();
        if own.is_some_and(|it| !it.orbit.is_replaced_by(&orbit, received)) {
            return;
        }
        let known = own.map(|it| it.ephemeris);
        let of_issue = newest.into_iter().chain(known).find(|it| orbit.value.is_of(it.issue));
        let Some(ephemeris) = of_issue else {
            self.satellites.retain(|it| it.number != number);
            return;
        };
        let same = own.filter(|it| it.ephemeris == ephemeris);
        let begun = same.map_or(orbit.since, |it| it.begun);
        let new =
            Satellite { number, ephemeris, begun, orbit, clock: same.and_then(|it| it.clock) };
        let place = place.or_else(|| {
            let is_over = |it: &Satellite| !it.orbit.is_current_at(received);
            let is_full = self.satellites.is_full();
            self.satellites.iter().position(is_over).filter(|_| is_full)
        });
        match place.and_then(|place| self.satellites.get_mut(place)) {
            Some(of) => *of = new,
            // Without room it is left out.
            None => self.satellites.push(new).unwrap_or_default(),
        }
    }

    /// The state of a satellite at the transmission of a signal, from the time of reception and the code on the first carrier
    /// (m). Its position is that of the antenna's phase centre: `antenna` is `None` in its
    /// [`SatelliteObservation`](crate::SatelliteObservation).
    ///
    /// # Errors
    /// [`NoEphemeris::Missing`]: no corrections, or none of the ephemeris, serve at the time. [`NoEphemeris::Unhealthy`]: the
    /// satellite says so in its newest ephemeris.
    pub fn state<const M: usize>(
        &self,
        number: u8,
        broadcast: &Broadcast<M>,
        received: GpsTime,
        code: f64,
    ) -> Result<SatelliteState, NoEphemeris> {
        if broadcast.newest(number) == Err(NoEphemeris::Unhealthy) {
            return Err(NoEphemeris::Unhealthy);
        }
        let sent = received.plus(-code / SPEED_OF_LIGHT);
        let of = self.satellites.iter().find(|it| it.number == number);
        let state = of.and_then(|it| corrected(&it.ephemeris, &it.orbit, it.clock.as_ref()?, sent));
        state.ok_or(NoEphemeris::Missing)
    }
}
