//! The choice of a sender where several send to one port.

use std::net::SocketAddr;
use std::time::{Duration, Instant};

/// The silence of the sender that is followed after which another takes its place.
const SILENCE: Duration = Duration::from_secs(2);

/// The addresses that send to one port.
///
/// A sender may change its address: when it is restarted, or if it opens a socket for each datagram. Its former address
/// is then not heard again. If it is, there are two senders, and only the first is followed.
#[derive(Debug, Default)]
pub(super) struct Senders {
    followed: Option<SocketAddr>,
    heard: Option<Instant>,
    /// Whether another address has been heard since the one that is followed.
    another: bool,
    several: bool,
}

impl Senders {
    /// Whether a datagram from this address is accepted.
    pub(super) fn takes(&mut self, from: SocketAddr, now: Instant) -> bool {
        let followed = *self.followed.get_or_insert(from);
        if from == followed {
            self.several |= self.another;
            self.heard = Some(now);
            return true;
        }
        self.another = true;
        let silent = self.heard.is_none_or(|heard| now.duration_since(heard) >= SILENCE);
        if self.several && !silent {
            return false;
        }
        if silent {
            *self = Self { followed: Some(from), heard: Some(now), ..Self::default() };
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn address(port: u16) -> SocketAddr {
        SocketAddr::from(([127, 0, 0, 1], port))
    }

    #[test]
    fn of_two_that_take_turns_the_first_is_followed_until_it_falls_silent() {
        let (mut senders, start) = (Senders::default(), Instant::now());
        let takes = |senders: &mut Senders, port, ms| {
            senders.takes(address(port), start + Duration::from_millis(ms))
        };
        assert!(takes(&mut senders, 1, 0));
        // It is not yet known to be another sender.
        assert!(takes(&mut senders, 2, 1));
        for ms in 2..50 {
            assert!(takes(&mut senders, 1, 2 * ms));
            assert!(!takes(&mut senders, 2, 2 * ms + 1));
        }
        assert!(takes(&mut senders, 2, 3000));
        assert!(takes(&mut senders, 2, 3001));
    }

    #[test]
    fn an_address_for_each_datagram_is_one_sender() {
        let (mut senders, start) = (Senders::default(), Instant::now());
        assert!((1..5000).all(|port| senders.takes(address(port), start)));
    }
}
