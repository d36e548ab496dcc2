//! Whose datagrams are taken, where several come to one port.

use std::net::SocketAddr;
use std::time::{Duration, Instant};

/// After such a silence of the sender that is followed another one is.
const SILENCE: Duration = Duration::from_secs(2);

/// Addresses that send to one port.
///
/// A sender may change its address: one that is switched on again, or that opens a socket for each datagram. Then the
/// address before is heard no more. Once it is heard again, there are two senders, and only the first is followed.
#[derive(Debug, Default)]
pub(super) struct Senders {
    followed: Option<SocketAddr>,
    heard: Option<Instant>,
    /// Whether another address was heard since the one that is followed.
    another: bool,
    several: bool,
}

impl Senders {
    /// Whether a datagram from this address is taken.
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
        // Not known yet to be another.
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
