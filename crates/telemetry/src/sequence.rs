/// The number of sequence numbers behind the newest that are remembered: frames may overtake each other within them.
const WINDOW: u16 = u128::BITS as u16;
/// The number of foreign numbers in a row, each following the other, after which they are followed.
pub const RESUMED_AFTER: u16 = 8;

/// The place of a frame's number among the earlier ones.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Order {
    /// Newer than all earlier numbers.
    Newest {
        /// How many numbers between the previous newest and this one have not come so far.
        missing: u16,
    },
    /// A number that was missing.
    Late {
        /// The distance to the newest number.
        behind: u16,
    },
    /// A number that was seen before, or does not follow: of a frame that came twice, of another sender, or of the same
    /// sender after a restart.
    Foreign,
    /// The [eighth](RESUMED_AFTER) foreign number in a row, each following the other: the sender restarted, or many
    /// frames are missing. From here on these numbers are followed.
    Resumed {
        /// How many numbers between the previous newest and this one did not come; those between the first of the eight and this one, if
        /// the sender restarted.
        missing: u16,
    },
}

/// The numbers of a sender: the newest, and which of those behind it came.
#[derive(Clone, Copy, Debug)]
struct Chain {
    newest: u16,
    /// Bit n: the number n behind the newest came.
    came: u128,
}

impl Chain {
    /// A chain that begins with this number: earlier numbers do not belong to it.
    const fn new(number: u16) -> Self {
        Self { newest: number, came: u128::MAX }
    }

    /// Accepts a number if it is near the newest and was not seen before.
    fn take(&mut self, number: u16) -> Option<Order> {
        let ahead = number.wrapping_sub(self.newest);
        if (1..=WINDOW).contains(&ahead) {
            self.newest = number;
            self.came = self.came.checked_shl(ahead.into()).unwrap_or(0) | 1;
            return Some(Order::Newest { missing: ahead - 1 });
        }
        let behind = self.newest.wrapping_sub(number);
        let place = 1_u128.checked_shl(behind.into())?;
        let is_new = self.came & place == 0;
        self.came |= place;
        is_new.then_some(Order::Late { behind })
    }
}

/// Numbers that do not follow those of the sender that is followed.
#[derive(Clone, Copy, Debug)]
struct Rival {
    chain: Chain,
    /// How many came since the last number of the followed sender; `first` is the first of them.
    count: u16,
    first: u16,
    /// How many numbers since the first did not come.
    missing: u16,
}

/// Follows the numbers of one sender, and tells those of others apart.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sequence {
    followed: Option<Chain>,
    rival: Option<Rival>,
}

impl Sequence {
    pub(crate) const fn new() -> Self {
        Self { followed: None, rival: None }
    }

    /// Classifies the next number.
    pub(crate) fn take(&mut self, number: u16) -> Order {
        let Some(followed) = &mut self.followed else {
            self.followed = Some(Chain::new(number));
            return Order::Newest { missing: 0 };
        };
        if let Some(order) = followed.take(number) {
            if let Some(rival) = &mut self.rival {
                rival.count = 0;
            }
            return order;
        }
        let newest = followed.newest;
        let known = self.rival.take();
        let mut rival = known
            .and_then(|mut rival| {
                let missing = match rival.chain.take(number)? {
                    Order::Newest { missing } => rival.missing.saturating_add(missing),
                    _ => rival.missing.saturating_sub(1),
                };
                Some(Rival { missing, ..rival })
            })
            .unwrap_or(Rival { chain: Chain::new(number), count: 0, first: number, missing: 0 });
        if rival.count == 0 {
            (rival.first, rival.missing) = (number, 0);
        }
        rival.count += 1;
        if rival.count < RESUMED_AFTER {
            self.rival = Some(rival);
            return Order::Foreign;
        }
        (self.followed, self.rival) = (Some(rival.chain), None);
        let before = rival.first.wrapping_sub(newest).wrapping_sub(1);
        // A step back, or one to the first numbers of all, means that the sender restarted.
        let restarted = before >= u16::MAX / 2 || rival.first < RESUMED_AFTER;
        let missing = rival.missing.saturating_add(if restarted { 0 } else { before });
        Order::Resumed { missing }
    }
}

#[cfg(test)]
mod tests {
    use super::Order::{Foreign, Late, Newest, Resumed};
    use super::*;

    const NEXT: Order = Newest { missing: 0 };

    fn orders<const N: usize>(sequence: &mut Sequence, numbers: [u16; N]) -> [Order; N] {
        numbers.map(|number| sequence.take(number))
    }

    #[test]
    fn frames_that_overtake_each_other_are_late_and_not_missing() {
        let mut sequence = Sequence::new();
        let expected = [NEXT, Newest { missing: 2 }, Late { behind: 1 }, Late { behind: 2 }, NEXT];
        assert_eq!(orders(&mut sequence, [65_534, 1, 0, 65_535, 2]), expected);
    }

    #[test]
    fn another_senders_numbers_are_foreign_however_long_it_sends() {
        let mut sequence = Sequence::new();
        for step in 0..u16::MAX {
            assert_eq!(sequence.take(step), NEXT);
            assert_eq!(sequence.take(step.wrapping_add(20_000)), Foreign);
            assert_eq!(sequence.take(step), Foreign, "it came before");
        }
    }

    #[test]
    fn a_sender_that_begins_anew_and_a_long_gap_are_followed_after_eight_frames() {
        for (newest, first, missing) in
            [(5000, 0, 0), (20, 0, 0), (59_999, 0, 0), (59_999, 2, 0), (5000, 9000, 3999)]
        {
            let mut sequence = Sequence::new();
            for number in 0..=newest {
                sequence.take(number);
            }
            for number in first..first + RESUMED_AFTER - 1 {
                assert_eq!(sequence.take(number), Foreign);
            }
            assert_eq!(sequence.take(first + RESUMED_AFTER - 1), Resumed { missing });
            assert_eq!(sequence.take(first + RESUMED_AFTER), NEXT);
        }
    }

    #[test]
    fn what_is_missing_among_the_eight_counts_unless_it_comes_late() {
        let mut sequence = Sequence::new();
        sequence.take(0);
        // Every second one; 1005 comes late.
        for number in [1001, 1003, 1007, 1005, 1009, 1011, 1013] {
            assert_eq!(sequence.take(number), Foreign);
        }
        assert_eq!(sequence.take(1015), Resumed { missing: 1000 + 7 });
    }
}
