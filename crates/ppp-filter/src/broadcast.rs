use core::mem::discriminant;

use heapless::Vec;
use kestirim_gnss_message::{self as message, Collector, beidou, galileo, gps};
use kestirim_gnss_ppp::constants::SPEED_OF_LIGHT;
use kestirim_gnss_ppp::{
    Carriers, Ephemeris, GpsTime, Klobuchar, NavigationMessage, SatelliteState,
};

/// The time after which a satellite that was not heard makes room for another, s.
const SILENCE: f64 = 300.0;
/// The square root of the Earth's radius, √m.
const LEAST_ROOT_OF_AXIS: f64 = 2_525.0;

/// A part of a satellite's navigation message, as output by a receiver.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum MessagePart {
    /// LNAV of GPS.
    Gps(gps::Subframe),
    /// I/NAV of Galileo.
    Galileo(galileo::Word),
    /// D1 of BeiDou.
    BeiDou(beidou::Subframe),
}

/// The reason why a satellite's state is unknown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum NoEphemeris {
    /// No ephemeris of the satellite is complete, or none is valid at the time.
    Missing,
    /// The satellite declares its signals unhealthy, or predicts no accuracy.
    Unhealthy,
    /// The group delay between the carriers of the ephemeris and the observed ones is not broadcast.
    Carriers,
}

/// Ephemerides of up to N satellites, collected from their broadcast messages: positions are good to metres, and no
/// products are needed.
///
/// A satellite is identified by a number that the caller chooses; [`SatelliteObservation`] must have the same one. A
/// satellite for which there is no room is left out until another has not been received for five minutes. With these
/// states the filter uses [`Config::broadcast`].
///
/// ```
/// use kestirim_gnss_message::gps::Subframe;
/// use kestirim_gnss_ppp::{Carriers, GpsTime};
/// use kestirim_ppp_filter::{Broadcast, MessagePart, NoEphemeris};
///
/// let mut broadcast = Broadcast::<32>::new();
/// // The words of UBX-RXM-SFRBX, and the time of the epoch before them.
/// let (words, now) = ([0x8b << 22, 1 << 8, 0, 0, 0, 0, 0, 0, 0, 0], GpsTime::new(59_025, 43_200.0));
/// let subframe = Subframe::from_words(&words).expect("LNAV");
/// broadcast.take(5, MessagePart::Gps(subframe), now);
/// // Three subframes make an ephemeris.
/// let state = broadcast.state(5, Carriers::L1L2, now, 21e6);
/// assert_eq!(state, Err(NoEphemeris::Missing));
/// ```
///
/// [`Config::broadcast`]: crate::Config::broadcast
/// [`SatelliteObservation`]: crate::SatelliteObservation
#[derive(Clone, Debug)]
pub struct Broadcast<const N: usize> {
    satellites: Vec<Satellite, N>,
    ionosphere: Option<Klobuchar>,
}

/// The data received from one satellite.
#[derive(Clone, Copy, Debug)]
struct Satellite {
    number: u8,
    heard: GpsTime,
    parts: Parts,
    newest: Option<Dated>,
}

/// The parts of the next ephemeris.
#[derive(Clone, Copy, Debug)]
enum Parts {
    Gps(Collector<gps::Subframe, 3>),
    Galileo(Collector<galileo::Word, 5>),
    BeiDou(Collector<beidou::Subframe, 3>),
}

/// A complete ephemeris and its time of reception, which determines its week.
#[derive(Clone, Copy, Debug)]
struct Dated {
    message: NavigationMessage,
    told: message::Ephemeris,
    received: GpsTime,
}

impl<const N: usize> Broadcast<N> {
    /// Creates a collection without satellites.
    pub const fn new() -> Self {
        Self { satellites: Vec::new(), ionosphere: None }
    }

    /// Adds a part of a satellite's message, received within half a week of an instant in GPS time. Returns whether it
    /// completes an ephemeris. A part at a time that is not finite changes nothing.
    ///
    /// `number` belongs to one satellite of all systems, as in
    /// [`SatelliteObservation::satellite`](crate::SatelliteObservation::satellite).
    pub fn take(&mut self, number: u8, part: MessagePart, received: GpsTime) -> bool {
        // Otherwise its satellite would never make room for another.
        if !received.second().is_finite() {
            return false;
        }
        if let MessagePart::Gps(subframe) = part
            && let Some([alpha, beta]) = subframe.ionosphere()
        {
            self.ionosphere = Some(Klobuchar { alpha, beta });
        }
        let Some(satellite) = self.satellite(number, &part, received) else { return false };
        satellite.heard = received;
        if !satellite.parts.are_of(&part) {
            *satellite = Satellite::new(number, &part, received);
        }
        let Some((message, told)) = satellite.parts.take(part, received) else { return false };
        satellite.newest = Some(Dated { message, told, received });
        true
    }

    /// The entry of a satellite, which is created if there is none and if there is room.
    fn satellite(
        &mut self,
        number: u8,
        part: &MessagePart,
        received: GpsTime,
    ) -> Option<&mut Satellite> {
        let is_known = self.satellites.iter().any(|it| it.number == number);
        let new = Satellite::new(number, part, received);
        if !is_known && self.satellites.push(new).is_err() {
            *self.satellites.iter_mut().find(|it| it.is_silent(received))? = new;
        }
        self.satellites.iter_mut().find(|it| it.number == number)
    }

    /// The state of a satellite at the transmission of a signal, from the time of reception and the code on the first
    /// carrier (m). Its clock is that of the ionosphere-free combination of these carriers, and its position is that of the
    /// antenna's phase centre: `antenna` is `None` in its [`SatelliteObservation`](crate::SatelliteObservation). (I/NAV has no
    /// health of E5a: for E1 and E5a that of E1 and E5b counts.)
    ///
    /// # Errors
    /// [`NoEphemeris`]: the satellite must not be used.
    pub fn state(
        &self,
        number: u8,
        carriers: Carriers,
        received: GpsTime,
        code: f64,
    ) -> Result<SatelliteState, NoEphemeris> {
        // By the satellite's own clock, whose error of less than a millisecond is negligible here.
        let sent = received.plus(-code / SPEED_OF_LIGHT);
        let satellite = self.satellites.iter().find(|it| it.number == number);
        let dated = satellite.and_then(|it| it.newest.as_ref()).ok_or(NoEphemeris::Missing)?;
        let ephemeris = dated.ephemeris(carriers)?;
        if !ephemeris.holds_at(sent) {
            return Err(NoEphemeris::Missing);
        }
        let clock = ephemeris.clock_at(sent);
        let orbit = ephemeris.orbit_at(sent.plus(-clock));
        Ok(SatelliteState {
            position: orbit.position,
            velocity: orbit.velocity,
            clock,
            clock_interval: 0.0,
            clock_distance: 0.0,
            accuracy: ephemeris.accuracy,
        })
    }

    /// The newest ephemeris of a satellite, with the clock of its own message, whichever carriers are observed: see
    /// [`corrected`](crate::corrected).
    ///
    /// # Errors
    /// [`NoEphemeris`]: the satellite must not be used.
    pub fn newest(&self, number: u8) -> Result<Ephemeris, NoEphemeris> {
        let satellite = self.satellites.iter().find(|it| it.number == number);
        let dated = satellite.and_then(|it| it.newest.as_ref()).ok_or(NoEphemeris::Missing)?;
        dated.ephemeris(match dated.message {
            NavigationMessage::Lnav => Carriers::L1L2,
            NavigationMessage::Inav => Carriers::E1E5b,
            NavigationMessage::Fnav => Carriers::E1E5a,
            NavigationMessage::D1 => Carriers::B1B3,
        })
    }

    /// The ionosphere model that GPS broadcasts, once it has been received.
    pub const fn ionosphere(&self) -> Option<&Klobuchar> {
        self.ionosphere.as_ref()
    }
}

impl<const N: usize> Default for Broadcast<N> {
    fn default() -> Self {
        Self::new()
    }
}

impl Satellite {
    const fn new(number: u8, part: &MessagePart, heard: GpsTime) -> Self {
        Self { number, heard, parts: Parts::of(part), newest: None }
    }

    /// Whether it has not been heard for long: it has set, or the receiver was off.
    fn is_silent(&self, now: GpsTime) -> bool {
        now.since(self.heard).abs() > SILENCE
    }
}

impl Parts {
    /// An empty collection for the message to which a part belongs.
    const fn of(part: &MessagePart) -> Self {
        match part {
            MessagePart::Gps(_) => Self::Gps(Collector::new()),
            MessagePart::Galileo(_) => Self::Galileo(Collector::new()),
            MessagePart::BeiDou(_) => Self::BeiDou(Collector::new()),
        }
    }

    /// Whether a part belongs to the same message.
    fn are_of(&self, part: &MessagePart) -> bool {
        discriminant(self) == discriminant(&Self::of(part))
    }

    fn take(
        &mut self,
        part: MessagePart,
        received: GpsTime,
    ) -> Option<(NavigationMessage, message::Ephemeris)> {
        let now = received.since(GpsTime::new(0, 0.0));
        match (self, part) {
            (Self::Gps(parts), MessagePart::Gps(part)) => {
                Some((NavigationMessage::Lnav, parts.take(part, now)?))
            }
            (Self::Galileo(parts), MessagePart::Galileo(part)) => {
                Some((NavigationMessage::Inav, parts.take(part, now)?))
            }
            (Self::BeiDou(parts), MessagePart::BeiDou(part)) => {
                Some((NavigationMessage::D1, parts.take(part, now)?))
            }
            _ => None,
        }
    }
}

impl Dated {
    /// The ephemeris with the clock of the two carriers.
    fn ephemeris(&self, carriers: Carriers) -> Result<Ephemeris, NoEphemeris> {
        let Self { message, told, received } = self;
        let accuracy = told.accuracy.filter(|_| told.is_healthy).ok_or(NoEphemeris::Unhealthy)?;
        // Not written, or damaged: an orbit within the Earth.
        if told.root_of_axis < LEAST_ROOT_OF_AXIS {
            return Err(NoEphemeris::Missing);
        }
        let clock = message.clock_reference(carriers, told.group_delays);
        let clock = clock.ok_or(NoEphemeris::Carriers)?;
        let behind = match message {
            NavigationMessage::D1 => GpsTime::BEIDOU_BEHIND,
            _ => 0.0,
        };
        let time = received.nearest_second_of_week(told.second);
        let clock_time = time.nearest_second_of_week(told.clock_second);
        let [offset, drift, ageing] = told.clock;
        Ok(Ephemeris {
            constellation: carriers.constellation(),
            time: time.plus(behind),
            clock_time: clock_time.plus(behind),
            clock: [offset + clock.correction, drift, ageing],
            issue: told.issue,
            group_delay: clock.group_delay,
            root_of_axis: told.root_of_axis,
            eccentricity: told.eccentricity,
            mean_anomaly: told.mean_anomaly,
            mean_motion_correction: told.mean_motion_correction,
            perigee: told.perigee,
            node: told.node,
            node_rate: told.node_rate,
            inclination: told.inclination,
            inclination_rate: told.inclination_rate,
            latitude_terms: told.latitude_terms,
            radius_terms: told.radius_terms,
            inclination_terms: told.inclination_terms,
            accuracy,
            holds: message.holds(),
        })
    }
}
