//! Restoring the order in which frames were sent.
//!
//! Datagrams overtake each other in transit. Frames in order are passed on at once; frames behind a gap wait for the
//! missing ones, for up to [`WINDOW_US`] of the sender's clock.

use std::collections::BTreeMap;

use kestirim_telemetry::{Frame, Message, Order, RESUMED_AFTER};

/// How long a gap is kept open, in microseconds of the sender's clock.
const WINDOW_US: u64 = 50_000;
/// The maximum number of waiting frames, which limits senders without a clock.
const MOST: usize = 256;

/// A buffer in which frames wait for earlier ones.
#[derive(Debug)]
pub(super) struct Sorter {
    waiting: BTreeMap<u64, Message>,
    /// The number of the newest frame and of the one that is due, extended beyond 65535.
    newest: u64,
    due: u64,
    /// The last foreign frames, which do not continue the sequence, until it is known whose they are.
    foreign: Vec<Frame>,
    left_out: u64,
}

impl Default for Sorter {
    fn default() -> Self {
        // Leaves room for late frames at the very beginning.
        let first = u64::from(u16::MAX);
        Self {
            waiting: BTreeMap::new(),
            newest: first,
            due: first + 1,
            foreign: Vec::new(),
            left_out: 0,
        }
    }
}

impl Sorter {
    /// Accepts a frame with its place in the sequence and passes all frames that become due to `sink`.
    pub(super) fn take<E>(
        &mut self,
        frame: Frame,
        order: Order,
        mut sink: impl FnMut(&Message) -> Result<(), E>,
    ) -> Result<(), E> {
        match order {
            Order::Newest { missing } => {
                self.leave_out();
                self.newest += 1 + u64::from(missing);
                self.waiting.insert(self.newest, frame.message);
            }
            Order::Late { behind } => {
                self.leave_out();
                self.put(self.newest - u64::from(behind), frame.message);
            }
            Order::Foreign => {
                self.foreign.push(frame);
                let surplus = self.foreign.len().saturating_sub(usize::from(RESUMED_AFTER) - 1);
                self.left_out += self.foreign.drain(..surplus).count() as u64;
            }
            Order::Resumed { .. } => {
                self.release_all(&mut sink)?;
                self.resume(frame);
            }
        }
        self.release(&mut sink)
    }

    /// Releases all waiting frames while nothing more arrives.
    pub(super) fn release_all<E>(
        &mut self,
        mut sink: impl FnMut(&Message) -> Result<(), E>,
    ) -> Result<(), E> {
        while let Some((number, message)) = self.waiting.pop_first() {
            self.due = number + 1;
            sink(&message)?;
        }
        Ok(())
    }

    /// Releases all frames at the end of the stream: the last few of a sender that restarted count as its own.
    pub(super) fn finish<E>(
        &mut self,
        mut sink: impl FnMut(&Message) -> Result<(), E>,
    ) -> Result<(), E> {
        self.release_all(&mut sink)?;
        if let Some(frame) = self.foreign.pop() {
            self.resume(frame);
        }
        self.release_all(&mut sink)
    }

    /// The number of frames that were left out: duplicates, late ones, or those of another sender.
    pub(super) const fn left_out(&self) -> u64 {
        self.left_out
    }

    fn put(&mut self, number: u64, message: Message) {
        if number >= self.due {
            self.waiting.insert(number, message);
        } else {
            self.left_out += 1;
        }
    }

    /// Drops the foreign frames: the sender that is followed still sends, so they are not its own.
    fn leave_out(&mut self) {
        self.left_out += self.foreign.drain(..).count() as u64;
    }

    /// Continues with the foreign frames and this one as the new sequence.
    fn resume(&mut self, last: Frame) {
        self.newest = self.due + u64::from(u16::MAX);
        let first = self.newest;
        for frame in std::mem::take(&mut self.foreign).into_iter().chain([last]) {
            let behind = (last.sequence as u16).wrapping_sub(frame.sequence as u16);
            self.waiting.insert(first.saturating_sub(behind.into()), frame.message);
        }
        self.due = self.waiting.first_key_value().map_or(self.due, |(&number, _)| number);
    }

    fn release<E>(&mut self, sink: &mut impl FnMut(&Message) -> Result<(), E>) -> Result<(), E> {
        while let Some(entry) = self.waiting.first_entry() {
            if *entry.key() != self.due && !self.is_given_up() {
                return Ok(());
            }
            if let Some((number, message)) = self.waiting.pop_first() {
                self.due = number + 1;
                sink(&message)?;
            }
        }
        Ok(())
    }

    /// Whether the wait for missing frames is given up.
    fn is_given_up(&self) -> bool {
        let mut times = self.waiting.values().filter_map(Message::measured_us);
        let first = times.next();
        let span = first.zip(times.next_back()).map(|(first, last)| last.saturating_sub(first));
        self.waiting.len() >= MOST || span.is_some_and(|span| span >= WINDOW_US)
    }
}

#[cfg(test)]
mod tests {
    use std::convert::Infallible;

    use super::*;
    use kestirim_telemetry::{CAPACITY, Range, Receiver, encode};

    /// The order in which frames with these numbers are released, and how many are left out; there is one frame every
    /// hundredth of a second.
    fn sorted(numbers: impl IntoIterator<Item = u16>) -> (Vec<u64>, u64) {
        let (mut receiver, mut sorter, mut out) = (Receiver::new(), Sorter::default(), Vec::new());
        let mut sink = |message: &Message| {
            out.push(message.measured_us().expect("a range") / 10_000);
            Ok::<_, Infallible>(())
        };
        for number in numbers {
            let message = Range { time_us: u64::from(number) * 10_000, anchor: 0, range: 1.0 };
            let mut buffer = [0; CAPACITY];
            let bytes = encode(&message.into(), number, &mut buffer).expect("it is long enough");
            for frame in receiver.frames(bytes) {
                sorter.take(frame, frame.order.expect("of a line"), &mut sink).unwrap();
            }
        }
        sorter.finish(&mut sink).unwrap();
        (out, sorter.left_out())
    }

    #[test]
    fn neighbours_that_changed_places_change_back() {
        let swapped = (0..500).flat_map(|pair| [2 * pair + 2, 2 * pair + 1]);
        assert_eq!(sorted([0].into_iter().chain(swapped)), ((0..=1000).collect(), 0));
    }

    #[test]
    fn what_never_comes_is_waited_for_in_vain_and_what_comes_too_late_left_out() {
        let numbers = (0..100).filter(|&number| number != 50);
        let (out, left_out) = sorted(numbers.chain([50]));
        assert_eq!(out, (0..100).filter(|&number| number != 50).collect::<Vec<_>>());
        assert_eq!(left_out, 1);
    }

    #[test]
    fn another_sender_is_left_out_and_one_that_began_anew_is_not() {
        let both = (0..200).flat_map(|number| [number, number + 30_000]);
        // The last of them may be the start of a restarted sender.
        assert_eq!(sorted(both), ((0..200).chain([30_199]).collect(), 199));
        let anew = (5000..5100).chain(0..5);
        assert_eq!(sorted(anew), ((5000..5100).chain(0..5).collect(), 0));
        let anew = (5000..5100).chain([1, 0]).chain(2..50);
        let (out, _) = sorted(anew);
        assert!(out.ends_with(&(2..50).collect::<Vec<_>>()));
    }
}
