//! I/NAV, with every number at its bits by the OS SIS ICD, tables 38 to 43 (counted from 0), in pages as receivers pass them on.

use core::f64::consts::PI;

use kestirim_gnss_message::galileo::{WORDS, Word};
use kestirim_gnss_message::{Collector, crc_24q};

/// A word of the message.
#[derive(Clone)]
struct Bits([bool; 128]);

impl Bits {
    fn of(number: i64) -> Self {
        let mut bits = Self([false; 128]);
        bits.set(number, (0, 5));
        bits
    }

    fn set(&mut self, value: i64, (first, last): (usize, usize)) {
        for place in first..=last {
            self.0[place] = value >> (last - place) & 1 == 1;
        }
    }

    /// The page of this word, of a type (1: an alert).
    fn page(&self, kind: bool) -> [u32; WORDS] {
        let even = [&[false, kind][..], &self.0[..112]].concat();
        let odd = [&[true, kind][..], &self.0[112..], &[true, false].repeat(32)].concat();
        let bytes = |bits: &[bool]| -> Vec<u8> {
            let byte = |bits: &[bool]| bits.iter().fold(0, |byte, bit| byte << 1 | u8::from(*bit));
            bits.chunks(8).map(byte).collect()
        };
        let sum = crc_24q(&bytes(&[&[false; 4][..], &even, &odd].concat()));
        let sum: Vec<_> = (0..24).rev().map(|bit| sum >> bit & 1 == 1).collect();
        // Tails and what a receiver fills up with.
        let page = [&even[..], &[true; 14], &odd, &sum, &[true; 22]].concat();
        let words: Vec<_> = bytes(&page)
            .chunks(4)
            .map(|bytes| u32::from_be_bytes(bytes.try_into().expect("four bytes")))
            .collect();
        words.try_into().expect("eight words")
    }

    fn word(&self) -> Word {
        Word::from_page(&self.page(false)).expect("a page")
    }
}

/// The words of an ephemeris.
fn words(issue: i64) -> [Bits; 5] {
    let mut words = [1, 2, 3, 4, 5].map(Bits::of);
    let [first, second, third, fourth, fifth] = &mut words;
    for word in [&mut *first, &mut *second, &mut *third, &mut *fourth] {
        word.set(issue, (6, 15));
    }
    first.set(6_480, (16, 29));
    first.set(-1_234_567_891, (30, 61));
    first.set(1_717_987, (62, 93));
    first.set(2_852_200_001, (94, 125));
    second.set(-2_000_000_003, (16, 47));
    second.set(660_000_001, (48, 79));
    second.set(1_888_888_888, (80, 111));
    second.set(-77, (112, 125));
    third.set(-15_555, (16, 39));
    third.set(8_888, (40, 55));
    third.set(-2_222, (56, 71));
    third.set(3_333, (72, 87));
    third.set(4_444, (88, 103));
    third.set(-5_555, (104, 119));
    third.set(107, (120, 127));
    fourth.set(33, (16, 21));
    fourth.set(-21, (22, 37));
    fourth.set(22, (38, 53));
    fourth.set(6_481, (54, 67));
    fourth.set(-10_000_001, (68, 98));
    fourth.set(-654_321, (99, 119));
    fourth.set(-3, (120, 125));
    fifth.set(-4, (47, 56));
    fifth.set(-5, (57, 66));
    words
}

#[test]
fn numbers_are_where_the_interface_document_has_them() {
    let mut collector = Collector::new();
    let parts = words(123).map(|bits| collector.take(bits.word(), 0.0));
    let [None, None, None, None, Some(it)] = parts else { panic!("{parts:?}") };

    let power = |value: f64, power| value * 2_f64.powi(power);
    assert_eq!((it.second, it.clock_second, it.issue), (388_800.0, 388_860.0, 123));
    assert_eq!((it.accuracy, it.is_healthy), (Some(2.0 + 7.0 * 0.16), true));
    assert_eq!(it.mean_anomaly, PI * power(-1_234_567_891.0, -31));
    assert_eq!(it.eccentricity, power(1_717_987.0, -33));
    assert_eq!(it.root_of_axis, power(2_852_200_001.0, -19));
    assert_eq!(it.node, PI * power(-2_000_000_003.0, -31));
    assert_eq!(it.inclination, PI * power(660_000_001.0, -31));
    assert_eq!(it.perigee, PI * power(1_888_888_888.0, -31));
    assert_eq!(it.inclination_rate, PI * power(-77.0, -43));
    assert_eq!(it.node_rate, PI * power(-15_555.0, -43));
    assert_eq!(it.mean_motion_correction, PI * power(8_888.0, -43));
    assert_eq!(it.latitude_terms, [power(-2_222.0, -29), power(3_333.0, -29)]);
    assert_eq!(it.radius_terms, [power(4_444.0, -5), power(-5_555.0, -5)]);
    assert_eq!(it.inclination_terms, [power(-21.0, -29), power(22.0, -29)]);
    assert_eq!(it.clock, [power(-10_000_001.0, -34), power(-654_321.0, -46), power(-3.0, -59)]);
    assert_eq!(it.group_delays, [power(-4.0, -32), power(-5.0, -32)]);
}

#[test]
fn health_and_validity_of_both_signals_count() {
    for place in [67, 68, 69, 70, 71, 72] {
        let mut parts = words(1);
        parts[4].set(1, (place, place));
        let mut collector = Collector::new();
        let last = parts.map(|bits| collector.take(bits.word(), 0.0))[4];
        assert!(!last.expect("an ephemeris").is_healthy, "bit {place}");
    }
}

#[test]
fn words_of_another_issue_wait_for_the_others() {
    let mut collector = Collector::new();
    let [first, second, third, fourth, fifth] = words(9).map(|bits| bits.word());
    let newer = words(10).map(|bits| bits.word());
    let mixed = [fifth, fourth, third, newer[1], first].map(|it| collector.take(it, 0.0));
    assert_eq!(mixed, [None; 5]);
    assert!(collector.take(second, 0.0).is_some());
}

#[test]
fn a_damaged_page_an_alert_and_another_order_are_no_word() {
    let page = words(1)[0].page(false);
    assert!(Word::from_page(&page).is_some());
    // A bit in either part, and one of the checksum.
    for (word, bit) in [(0, 20), (3, 20), (4, 25), (6, 30), (7, 24)] {
        let mut damaged = page;
        damaged[word] ^= 1 << bit;
        assert_eq!(Word::from_page(&damaged), None, "bit {bit} of word {word}");
    }
    assert_eq!(Word::from_page(&words(1)[0].page(true)), None);
    let [a, b, c, d, e, f, g, h] = page;
    assert_eq!(Word::from_page(&[e, f, g, h, a, b, c, d]), None);
}
