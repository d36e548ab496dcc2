//! Timestamps of radios: two-way exchanges, and messages of anchors that a tag only receives, each on its own clock.
//!
//! The rate of a clock is up to 20 ppm off, and its counter of 40 bits starts anywhere, so it wraps within 17 s.

use kestirim_uwb_ranging::{Heard, SPEED_OF_LIGHT, TICKS_PER_SECOND, Timestamp};
use rand_core::Rng;

use crate::random::{normal, uniform};

/// The largest deviation of a clock's rate, parts per million.
const LARGEST_PPM: f64 = 20.0;

/// A radio's counter.
#[derive(Debug, Clone, Copy)]
pub struct Clock {
    start: u64,
    rate: f64,
}

impl Clock {
    /// Draws a clock that starts anywhere, with a rate error within ±20 ppm.
    pub fn draw<R: Rng>(rng: &mut R) -> Self {
        let start = (uniform(rng) * (1_u64 << 40) as f64) as u64;
        Self { start, rate: 1.0 + (2.0 * uniform(rng) - 1.0) * LARGEST_PPM * 1e-6 }
    }

    /// The timestamp at a time, s, in whole ticks.
    pub fn at(&self, seconds: f64) -> Timestamp {
        let ticks = (seconds * self.rate * TICKS_PER_SECOND).round() as i64;
        Timestamp::new(self.start.wrapping_add(ticks as u64))
    }

    /// The timestamp of a reception, with an error of standard deviation `sigma`, m.
    fn received<R: Rng>(&self, rng: &mut R, seconds: f64, sigma: f64) -> Timestamp {
        self.at(seconds + normal(rng, sigma) / SPEED_OF_LIGHT)
    }
}

/// The six timestamps of a poll, a response and a final message over a distance, m, each sent and received. `replies`
/// are the two reply times, s, and `sigma` is the standard deviation of a reception, m.
pub fn exchange<R: Rng>(
    rng: &mut R,
    [tag, anchor]: [&Clock; 2],
    (at, metres): (f64, f64),
    replies: [f64; 2],
    sigma: f64,
) -> [Timestamp; 6] {
    let flight = metres / SPEED_OF_LIGHT;
    let arrived = at + flight;
    let answered = arrived + replies[0];
    let returned = answered + flight;
    let closed = returned + replies[1];
    [
        tag.at(at),
        anchor.received(rng, arrived, sigma),
        anchor.at(answered),
        tag.received(rng, returned, sigma),
        tag.at(closed),
        anchor.received(rng, closed + flight, sigma),
    ]
}

/// Anchors that transmit at random times, as those of Crazyflie's TDOA 3 do, and report what they received from each
/// other.
#[derive(Debug, Clone)]
pub struct Network {
    /// The positions of the anchors, m.
    pub anchors: Vec<[f64; 3]>,
    /// The mean time between two messages of one anchor, s.
    pub interval: f64,
    /// The standard deviations of a reception at the tag and at an anchor, m.
    pub sigmas: [f64; 2],
    /// The share of lost messages, independently at the tag and at each anchor.
    pub loss: f64,
}

/// A message as the tag received it.
#[derive(Debug, Clone, PartialEq)]
pub struct Received {
    /// The time of transmission, s.
    pub seconds: f64,
    /// The index of the transmitting anchor.
    pub anchor: usize,
    /// The sequence number, which wraps at 128.
    pub sequence: u8,
    /// The time of transmission on the anchor's clock.
    pub sent: Timestamp,
    /// The time of reception on the tag's clock.
    pub received: Timestamp,
    /// The messages that the anchor had received from the others.
    pub heard: Vec<Heard>,
}

/// An anchor of a [`Network`].
struct Anchor {
    clock: Clock,
    next: f64,
    sequence: u8,
    heard: Vec<Heard>,
}

impl Network {
    /// The messages that a tag receives within `seconds` while it moves along `path` (s to m).
    pub fn heard<R: Rng>(
        &self,
        rng: &mut R,
        seconds: f64,
        path: impl Fn(f64) -> [f64; 3],
    ) -> Vec<Received> {
        let tag = Clock::draw(rng);
        let mut anchors: Vec<_> =
            self.anchors.iter().map(|_| Anchor::draw(rng, self.interval)).collect();
        let mut received = Vec::new();
        loop {
            let earliest = anchors.iter().enumerate().min_by(|a, b| a.1.next.total_cmp(&b.1.next));
            let Some((index, at)) = earliest.map(|(index, anchor)| (index, anchor.next)) else {
                break;
            };
            if at > seconds {
                break;
            }
            let place = self.anchors[index];
            let (sent, sequence, heard) = anchors[index].send(rng, self.interval);
            let flight = distance(path(at), place) / SPEED_OF_LIGHT;
            if uniform(rng) >= self.loss {
                let received_at = tag.received(rng, at + flight, self.sigmas[0]);
                received.push(Received {
                    seconds: at,
                    anchor: index,
                    sequence,
                    sent,
                    received: received_at,
                    heard,
                });
            }
            for (other, listener) in anchors.iter_mut().enumerate().filter(|it| it.0 != index) {
                if uniform(rng) >= self.loss {
                    let flight = distance(self.anchors[other], place) / SPEED_OF_LIGHT;
                    let received = listener.clock.received(rng, at + flight, self.sigmas[1]);
                    listener.hear(Heard { anchor: index, sequence, received });
                }
            }
        }
        received
    }
}

impl Anchor {
    fn draw<R: Rng>(rng: &mut R, interval: f64) -> Self {
        let (next, sequence) = (uniform(rng) * interval, (uniform(rng) * 128.0) as u8);
        Self { clock: Clock::draw(rng), next, sequence, heard: Vec::new() }
    }

    fn send<R: Rng>(&mut self, rng: &mut R, interval: f64) -> (Timestamp, u8, Vec<Heard>) {
        let sent = self.clock.at(self.next);
        self.sequence = (self.sequence + 1) % 128;
        self.next += (0.5 + uniform(rng)) * interval;
        (sent, self.sequence, self.heard.clone())
    }

    fn hear(&mut self, heard: Heard) {
        self.heard.retain(|known| known.anchor != heard.anchor);
        self.heard.push(heard);
    }
}

/// The Cramér–Rao bound for the standard deviation of a two-way distance from six timestamps, m, when nothing is known
/// of the two clocks' offset and rates.
///
/// Three flights determine three unknowns, so the estimate is unique. With equal reply times it equals that of known
/// rates, √(3/8) of a reception's.
pub fn least_two_way_sigma([first, second]: [f64; 2], sigma: f64) -> f64 {
    // Receptions at times 0, D₁ and D₁ + D₂: a straight line through the first and the last, evaluated at the second.
    let share = first / (first + second);
    0.5 * sigma * ((1.0 - share).powi(2) + 1.0 + share.powi(2)).sqrt()
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1]).hypot(a[2] - b[2])
}
