//! LNAV, with every number at its bits by IS-GPS-200, figure 20-1 (counted from 1, parity among them).

use core::f64::consts::PI;

use kestirim_gnss_message::Collector;
use kestirim_gnss_message::gps::{Subframe, WORDS};

/// A subframe with its parity bits, all of them set.
#[derive(Clone)]
struct Bits([bool; 300]);

impl Bits {
    fn of(number: i64) -> Self {
        let mut bits = Self(std::array::from_fn(|place| place % 30 >= 24));
        bits.set(0x8b, &[(1, 8)]);
        bits.set(number, &[(50, 52)]);
        bits
    }

    /// Sets a number in pieces, each given by its first and last bit.
    fn set(&mut self, value: i64, pieces: &[(usize, usize)]) {
        let mut left: usize = pieces.iter().map(|(first, last)| last - first + 1).sum();
        for (first, last) in pieces {
            for place in *first..=*last {
                left -= 1;
                self.0[place - 1] = value >> left & 1 == 1;
            }
        }
    }

    fn words(&self) -> [u32; WORDS] {
        let word = |bits: &[bool]| bits.iter().fold(0, |word, bit| word << 1 | u32::from(*bit));
        // The highest two bits are unused.
        std::array::from_fn(|place| 3 << 30 | word(&self.0[30 * place..][..30]))
    }

    fn subframe(&self) -> Subframe {
        Subframe::from_words(&self.words()).expect("a preamble")
    }
}

/// The first three subframes of an issue.
fn subframes(issue: i64) -> [Bits; 3] {
    let mut first = Bits::of(1);
    first.set(1, &[(73, 76)]);
    first.set(issue, &[(211, 218)]);
    first.set(-17, &[(197, 204)]);
    first.set(24_300, &[(219, 234)]);
    first.set(-5, &[(241, 248)]);
    first.set(-1_234, &[(249, 264)]);
    first.set(1_000_003, &[(271, 292)]);
    let mut second = Bits::of(2);
    second.set(issue, &[(61, 68)]);
    second.set(-1_111, &[(69, 84)]);
    second.set(12_345, &[(91, 106)]);
    second.set(-1_500_000_001, &[(107, 114), (121, 144)]);
    second.set(-3_333, &[(151, 166)]);
    second.set(85_000_001, &[(167, 174), (181, 204)]);
    second.set(4_444, &[(211, 226)]);
    second.set(2_702_000_003, &[(227, 234), (241, 264)]);
    second.set(24_301, &[(271, 286)]);
    let mut third = Bits::of(3);
    third.set(-55, &[(61, 76)]);
    third.set(1_700_000_001, &[(77, 84), (91, 114)]);
    third.set(66, &[(121, 136)]);
    third.set(650_000_003, &[(137, 144), (151, 174)]);
    third.set(7_777, &[(181, 196)]);
    third.set(-900_000_001, &[(197, 204), (211, 234)]);
    third.set(-22_222, &[(241, 264)]);
    third.set(issue, &[(271, 278)]);
    third.set(-321, &[(279, 292)]);
    [first, second, third]
}

#[test]
fn numbers_are_where_the_interface_specification_has_them() {
    let mut collector = Collector::new();
    let [first, second, third] = subframes(200).map(|bits| bits.subframe());
    assert_eq!([third, first].map(|it| collector.take(it, 0.0)), [None; 2]);
    let it = collector.take(second, 0.0).expect("an ephemeris");

    let power = |value: f64, power| value * 2_f64.powi(power);
    assert_eq!((it.clock_second, it.second, it.issue), (388_800.0, 388_816.0, 200));
    assert_eq!((it.accuracy, it.is_healthy), (Some(2.8), true));
    assert_eq!(it.group_delays, [power(-17.0, -31), 0.0]);
    assert_eq!(it.clock, [power(1_000_003.0, -31), power(-1_234.0, -43), power(-5.0, -55)]);
    assert_eq!(it.radius_terms, [power(7_777.0, -5), power(-1_111.0, -5)]);
    assert_eq!(it.mean_motion_correction, PI * power(12_345.0, -43));
    assert_eq!(it.mean_anomaly, PI * power(-1_500_000_001.0, -31));
    assert_eq!(it.latitude_terms, [power(-3_333.0, -29), power(4_444.0, -29)]);
    assert_eq!(it.eccentricity, power(85_000_001.0, -33));
    assert_eq!(it.root_of_axis, power(2_702_000_003.0, -19));
    assert_eq!(it.inclination_terms, [power(-55.0, -29), power(66.0, -29)]);
    assert_eq!(it.node, PI * power(1_700_000_001.0, -31));
    assert_eq!(it.inclination, PI * power(650_000_003.0, -31));
    assert_eq!(it.perigee, PI * power(-900_000_001.0, -31));
    assert_eq!(it.node_rate, PI * power(-22_222.0, -43));
    assert_eq!(it.inclination_rate, PI * power(-321.0, -43));
}

#[test]
fn parts_of_two_issues_are_not_mixed() {
    let mut collector = Collector::new();
    let [first, second, third] = subframes(7).map(|bits| bits.subframe());
    let [next_first, next_second, next_third] = subframes(8).map(|bits| bits.subframe());
    let mixed = [first, next_second, third, second];
    assert_eq!(mixed.map(|it| collector.take(it, 0.0).is_some()), [false, false, false, true]);
    let mixed = [next_first, second, next_third, next_second];
    assert_eq!(mixed.map(|it| collector.take(it, 0.0).is_some()), [false, false, false, true]);
}

#[test]
fn parts_before_a_long_silence_are_not_joined_with_those_after_it() {
    let mut collector = Collector::new();
    let [first, second, third] = subframes(7).map(|bits| bits.subframe());
    let mut take = |part, now| collector.take(part, now).is_some();
    assert!(!take(first, 0.0) && !take(second, 300.0) && take(third, 600.0));
    assert!(!take(first, 606.0) && !take(second, 612.0) && !take(third, 913.0));
    // A clock may be set back.
    assert!(!take(first, 0.0) && !take(second, 6.0) && take(third, 12.0));
}

#[test]
fn a_satellite_is_unhealthy_by_its_health_or_an_alert() {
    for (place, alerted) in [(48, true), (77, true), (82, true), (49, false)] {
        let [mut first, second, third] = subframes(1);
        first.set(1, &[(place, place)]);
        let mut collector = Collector::new();
        let parts = [first, second, third].map(|bits| collector.take(bits.subframe(), 0.0));
        assert_eq!(parts[2].expect("an ephemeris").is_healthy, !alerted, "bit {place}");
    }
}

#[test]
fn the_ionosphere_is_on_its_page_alone() {
    let mut page = Bits::of(4);
    page.set(56, &[(63, 68)]);
    let terms =
        [(69, 76), (77, 84), (91, 98), (99, 106), (107, 114), (121, 128), (129, 136), (137, 144)];
    for (number, bits) in (-4..).zip(terms) {
        page.set(number, &[bits]);
    }
    let [alpha, beta] = page.subframe().ionosphere().expect("the page");
    let power = |value: f64, power| value * 2_f64.powi(power);
    assert_eq!(alpha, [power(-4.0, -30), power(-3.0, -27), power(-2.0, -24), power(-1.0, -24)]);
    assert_eq!(beta, [0.0, power(1.0, 14), power(2.0, 16), power(3.0, 16)]);
    page.set(57, &[(63, 68)]);
    assert_eq!(page.subframe().ionosphere(), None);
    assert_eq!(subframes(1)[0].subframe().ionosphere(), None);
}

#[test]
fn words_without_the_preamble_are_no_subframe() {
    let mut words = subframes(1)[0].words();
    assert!(Subframe::from_words(&words).is_some());
    words[0] ^= 1 << 22;
    assert_eq!(Subframe::from_words(&words), None);
}
