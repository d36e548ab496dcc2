//! D1, with every number where other programs look for it: places in the 300 bits of a subframe, parity among them.

use core::f64::consts::PI;

use kestirim_gnss_message::Collector;
use kestirim_gnss_message::beidou::{Subframe, WORDS};

/// A subframe with its parity bits, all of them set.
#[derive(Clone)]
struct Bits([bool; 30 * WORDS]);

impl Bits {
    /// A subframe of a number that begins at a second of the week.
    fn of(number: i64, sent: i64) -> Self {
        let mut bits = Self([true; 300]);
        for place in (0..300).filter(|place| place % 30 < if *place < 30 { 26 } else { 22 }) {
            bits.0[place] = false;
        }
        bits.set(0b111_0001_0010, &[(0, 11)]);
        bits.set(number, &[(15, 3)]);
        bits.set(sent % 604_800, &[(18, 8), (30, 12)]);
        bits
    }

    /// Sets a number in pieces, each given by its first bit and its width.
    fn set(&mut self, value: i64, pieces: &[(usize, usize)]) {
        let mut left: usize = pieces.iter().map(|(_, width)| width).sum();
        for (place, width) in pieces {
            for bit in 0..*width {
                left -= 1;
                self.0[place + bit] = value >> left & 1 == 1;
            }
        }
    }

    fn subframe(&self) -> Subframe {
        let mut words = [0; WORDS];
        for (word, bits) in words.iter_mut().zip(self.0.chunks(30)) {
            // The highest two bits are unused.
            *word = 3 << 30 | bits.iter().fold(0, |word, bit| word << 1 | u32::from(*bit));
        }
        Subframe::from_words(&words).expect("a preamble")
    }
}

/// The subframes of a frame that began at a second of the week, with times of 24 h.
fn frame(sent: i64) -> [Bits; 3] {
    let tick = 86_400 / 8;
    let mut first = Bits::of(1, sent);
    first.set(0, &[(42, 1)]);
    first.set(31, &[(43, 5)]);
    first.set(1, &[(48, 4)]);
    first.set(tick, &[(73, 9), (90, 8)]);
    first.set(-100, &[(98, 10)]);
    first.set(55, &[(108, 4), (120, 6)]);
    first.set(-3, &[(214, 11)]);
    first.set(-1_000_001, &[(225, 7), (240, 17)]);
    first.set(70_001, &[(257, 5), (270, 17)]);
    first.set(9, &[(287, 5)]);
    let mut second = Bits::of(2, sent + 6);
    second.set(2_345, &[(42, 10), (60, 6)]);
    second.set(-77_777, &[(66, 16), (90, 2)]);
    second.set(-1_234_567_890, &[(92, 20), (120, 12)]);
    second.set(4_000_000_001, &[(132, 10), (150, 22)]);
    second.set(88_888, &[(180, 18)]);
    second.set(99_999, &[(198, 4), (210, 14)]);
    second.set(-99_998, &[(224, 8), (240, 10)]);
    second.set(2_770_000_001, &[(250, 12), (270, 20)]);
    second.set(tick >> 15, &[(290, 2)]);
    let mut third = Bits::of(3, sent + 12);
    third.set(tick & 0x7fff, &[(42, 10), (60, 5)]);
    third.set(650_000_001, &[(65, 17), (90, 15)]);
    third.set(-31, &[(105, 7), (120, 11)]);
    third.set(-20_001, &[(131, 11), (150, 13)]);
    third.set(33, &[(163, 9), (180, 9)]);
    third.set(-501, &[(189, 13), (210, 1)]);
    third.set(-2_000_000_001, &[(211, 21), (240, 11)]);
    third.set(1_999_999_999, &[(251, 11), (270, 21)]);
    [first, second, third]
}

#[test]
fn numbers_are_where_other_programs_look_for_them() {
    let mut collector = Collector::new();
    let [first, second, third] = frame(345_600).map(|bits| bits.subframe());
    assert_eq!(collector.take(first, 0.0), None);
    assert_eq!(collector.take(second, 0.0), None);
    let it = collector.take(third, 0.0).expect("an ephemeris");

    let power = |value: f64, power| value * 2_f64.powi(power);
    assert_eq!((it.second, it.clock_second, it.issue), (86_400.0, 86_400.0, 9));
    assert_eq!((it.accuracy, it.is_healthy), (Some(2.8), true));
    assert_eq!(it.group_delays, [-100.0 * 1e-10, 55.0 * 1e-10]);
    let clock = [power(-1_000_001.0, -33), power(70_001.0, -50), power(-3.0, -66)];
    assert_eq!(it.clock, clock);
    assert_eq!(it.mean_motion_correction, PI * power(2_345.0, -43));
    assert_eq!(it.latitude_terms, [power(-77_777.0, -31), power(88_888.0, -31)]);
    assert_eq!(it.mean_anomaly, PI * power(-1_234_567_890.0, -31));
    assert_eq!(it.eccentricity, power(4_000_000_001.0, -33));
    assert_eq!(it.radius_terms, [power(99_999.0, -6), power(-99_998.0, -6)]);
    assert_eq!(it.root_of_axis, power(2_770_000_001.0, -19));
    assert_eq!(it.inclination, PI * power(650_000_001.0, -31));
    assert_eq!(it.inclination_terms, [power(-31.0, -31), power(33.0, -31)]);
    assert_eq!(it.node_rate, PI * power(-20_001.0, -43));
    assert_eq!(it.inclination_rate, PI * power(-501.0, -43));
    assert_eq!(it.node, PI * power(-2_000_000_001.0, -31));
    assert_eq!(it.perigee, PI * power(1_999_999_999.0, -31));
}

#[test]
fn parts_of_two_frames_are_not_mixed() {
    let mut collector = Collector::new();
    let [first, second, third] = frame(604_788).map(|bits| bits.subframe());
    let [next_first, next_second, next_third] = frame(604_788 + 30).map(|bits| bits.subframe());
    assert_eq!(
        [second, third, next_first, next_second].map(|it| collector.take(it, 0.0)),
        [None; 4]
    );
    assert!(collector.take(next_third, 0.0).is_some());
    // The third one of these begins with a week.
    assert_eq!([first, second].map(|it| collector.take(it, 0.0)), [None; 2]);
    assert!(collector.take(third, 0.0).is_some());
}

#[test]
fn words_without_the_preamble_are_no_subframe() {
    assert_eq!(Subframe::from_words(&[0; WORDS]), None);
    assert_eq!(Subframe::from_words(&[u32::MAX; WORDS]), None);
}

#[test]
fn what_is_unhealthy_says_so_and_almanacs_are_passed_over() {
    let mut collector = Collector::new();
    let [mut first, second, third] = frame(30);
    first.set(1, &[(42, 1)]);
    first.set(15, &[(48, 4)]);
    let parts = [Bits::of(4, 48), third, Bits::of(5, 54), first, Bits::of(0, 0), Bits::of(7, 0)];
    assert!(parts.iter().all(|part| collector.take(part.subframe(), 0.0).is_none()));
    let it = collector.take(second.subframe(), 0.0).expect("an ephemeris");
    assert_eq!((it.is_healthy, it.accuracy), (false, None));
}
