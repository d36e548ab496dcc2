//! UBX, assembled byte by byte.

use std::f64::consts::PI;

use super::*;
use crate::Carriers;
use kestirim_gnss_message::crc_24q;

fn frame(id: u8, held: &[u8]) -> Vec<u8> {
    let length = u16::try_from(held.len()).expect("a short message").to_le_bytes();
    let summed = [&[0x02, id, length[0], length[1]], held].concat();
    let sums = summed.iter().fold([0_u8; 2], |[a, b], byte| {
        let a = a.wrapping_add(*byte);
        [a, b.wrapping_add(a)]
    });
    [&[0xb5, 0x62], &*summed, &sums].concat()
}

/// A message with G05 on both carriers, E02 and R02 on the first, and a QZSS satellite, tracked for `lock` ms.
pub(super) fn observed(second: f64, lock: u16) -> Vec<u8> {
    observed_in_week(2111, second, lock)
}

fn observed_in_week(week: u16, second: f64, lock: u16) -> Vec<u8> {
    let signals = [
        (0, 5, 0, 21e6, 1.1e8, 7),
        (0, 5, 3, 21e6 + 3.0, 0.9e8, 7),
        // The half cycle is not resolved.
        (2, 2, 0, 24e6, 1.2e8, 3),
        (6, 2, 0, 19e6, 1.0e8, 7),
        (5, 2, 0, 39e6, 2.0e8, 7),
    ];
    let mut held = second.to_le_bytes().to_vec();
    held.extend(week.to_le_bytes());
    held.extend([18, signals.len() as u8, 1, 1, 0, 0]);
    for (system, number, signal, code, phase, status) in signals {
        held.extend(f64::to_le_bytes(code));
        held.extend(f64::to_le_bytes(phase));
        held.extend([0; 4]);
        // R02 is on channel −4.
        held.extend([system, number, signal, if system == 6 { 3 } else { 0 }]);
        held.extend(lock.to_le_bytes());
        held.extend([40, 0, 0, 0, status, 0]);
    }
    frame(0x15, &held)
}

/// A GPS subframe: bits from the first to the last, in words with room for parity.
fn subframe(number: u64, fields: &[(i64, usize)]) -> Vec<u8> {
    subframe_of([0, 1], number, fields)
}

/// A subframe of another system and satellite.
fn subframe_of(sender: [u8; 2], number: u64, fields: &[(i64, usize)]) -> Vec<u8> {
    let mut bits = vec![false; 240];
    for (place, bit) in [true, false, false, false, true, false, true, true].into_iter().enumerate()
    {
        bits[place] = bit;
    }
    let mut place = 43;
    for (value, width) in [(number as i64, 3), (0, 2)].iter().chain(fields) {
        for bit in (0..*width).rev() {
            bits[place] = value >> bit & 1 == 1;
            place += 1;
        }
    }
    let mut held = [&sender[..], &[0, 0, 10, 0, 2, 0]].concat();
    for word in bits.chunks(24) {
        let word = word.iter().fold(0_u32, |word, bit| word << 1 | u32::from(*bit));
        // Parity, and two meaningless bits.
        held.extend((word << 6 | 0xc000_002a).to_le_bytes());
    }
    frame(0x13, &held)
}

fn in_units(value: f64, power: i32) -> i64 {
    (value / 2_f64.powi(power)).round() as i64
}

pub(super) fn subframes(it: &Ephemeris) -> Vec<u8> {
    let turns = |angle: f64, power| in_units(angle / PI, power);
    let ([cuc, cus], [crc, crs], [cic, cis]) =
        (it.latitude_terms, it.radius_terms, it.inclination_terms);
    let second = f64::from((it.time.day() - 44_244).rem_euclid(7)) * 86_400.0 + it.time.second();
    let issue = i64::from(it.issue);
    let first = [
        (2111 % 1024, 10),
        (1, 2),
        (0, 4),
        (0, 6),
        (0, 2),
        (0, 1),
        (0, 44),
        (0, 43),
        (in_units(it.group_delays[0], -31), 8),
        (issue, 8),
        (in_units(second, 4), 16),
        (in_units(it.clock[2], -55), 8),
        (in_units(it.clock[1], -43), 16),
        (in_units(it.clock[0], -31), 22),
    ];
    let second = [
        (issue, 8),
        (in_units(crs, -5), 16),
        (turns(it.mean_motion_correction, -43), 16),
        (turns(it.mean_anomaly, -31), 32),
        (in_units(cuc, -29), 16),
        (in_units(it.eccentricity, -33), 32),
        (in_units(cus, -29), 16),
        (in_units(it.root_of_axis, -19), 32),
        (in_units(second, 4), 16),
    ];
    let third = [
        (in_units(cic, -29), 16),
        (turns(it.node, -31), 32),
        (in_units(cis, -29), 16),
        (turns(it.inclination, -31), 32),
        (in_units(crc, -5), 16),
        (turns(it.perigee, -31), 32),
        (turns(it.node_rate, -43), 24),
        (issue, 8),
        (turns(it.inclination_rate, -43), 14),
    ];
    [subframe(1, &first), subframe(2, &second), subframe(3, &third)].concat()
}

/// A message word of Galileo's first satellite, as both parts of a page: its type, its issue number if it has one, and
/// the rest.
fn word(number: i64, fields: &[(i64, usize)]) -> Vec<u8> {
    let bits = |fields: &[(i64, usize)]| {
        let bits =
            |&(value, width): &(i64, usize)| (0..width).rev().map(move |bit| value >> bit & 1 == 1);
        fields.iter().flat_map(bits).collect::<Vec<_>>()
    };
    let mut held = bits(&[&[(number, 6)], fields].concat());
    held.resize(128, false);
    let even = [&bits(&[(0, 2)])[..], &held[..112]].concat();
    let odd = [&bits(&[(2, 2)])[..], &held[112..], &[true; 64]].concat();
    let summed = [&[false; 4], &even[..], &odd[..]].concat();
    let packed = |bits: &[bool]| {
        let byte = |bits: &[bool]| bits.iter().fold(0_u8, |byte, bit| byte << 1 | u8::from(*bit));
        bits.chunks(8).map(byte).collect::<Vec<_>>()
    };
    let sum = bits(&[(i64::from(crc_24q(&packed(&summed))), 24)]);
    // The tail and the receiver's fill bits are meaningless.
    let page = [even, vec![true; 14], odd, sum, vec![true; 22]].concat();
    let mut frame_of = vec![2, 1, 1, 0, 8, 0, 2, 0];
    for word in packed(&page).chunks(4) {
        frame_of.extend(word.iter().rev());
    }
    frame(0x13, &frame_of)
}

/// The message words of an ephemeris.
pub(super) fn words(it: &Ephemeris) -> [Vec<u8>; 5] {
    let turns = |angle: f64, power| in_units(angle / PI, power);
    let minutes = |time: crate::GpsTime| {
        let second = f64::from((time.day() - 44_244).rem_euclid(7)) * 86_400.0 + time.second();
        (second / 60.0) as i64
    };
    let issue = (i64::from(it.issue), 10);
    let first = [
        issue,
        (minutes(it.time), 14),
        (turns(it.mean_anomaly, -31), 32),
        (in_units(it.eccentricity, -33), 32),
        (in_units(it.root_of_axis, -19), 32),
    ];
    let second = [
        issue,
        (turns(it.node, -31), 32),
        (turns(it.inclination, -31), 32),
        (turns(it.perigee, -31), 32),
        (turns(it.inclination_rate, -43), 14),
    ];
    let third = [
        issue,
        (turns(it.node_rate, -43), 24),
        (turns(it.mean_motion_correction, -43), 16),
        (in_units(it.latitude_terms[0], -29), 16),
        (in_units(it.latitude_terms[1], -29), 16),
        (in_units(it.radius_terms[0], -5), 16),
        (in_units(it.radius_terms[1], -5), 16),
        (107, 8),
    ];
    let fourth = [
        issue,
        (1, 6),
        (in_units(it.inclination_terms[0], -29), 16),
        (in_units(it.inclination_terms[1], -29), 16),
        (minutes(it.clock_time), 14),
        (in_units(it.clock[0], -34), 31),
        (in_units(it.clock[1], -46), 21),
        (in_units(it.clock[2], -59), 6),
    ];
    let fifth = [
        (-1, 11 + 11 + 14 + 5),
        (in_units(it.group_delays[0], -32), 10),
        (in_units(it.group_delays[1], -32), 10),
        (i64::from(!it.is_healthy), 2 + 2 + 1 + 1),
    ];
    [word(1, &first), word(2, &second), word(3, &third), word(4, &fourth), word(5, &fifth)]
}

#[test]
fn ephemerides_of_galileo_are_what_the_file_has() -> Result<(), Error> {
    let [_, (_, told)] = broadcast()?;
    let told = Ephemeris {
        message: Message::Inav,
        group_delays: [told.group_delays[0], -3.0 * 2_f64.powi(-32)],
        ..told
    };
    let [first, second, third, fourth, fifth] = words(&told);
    let mut damaged = second.clone();
    // A bit of the page is flipped, and the frame's own checksum is corrected.
    damaged[20] ^= 4;
    let damaged = frame(0x13, &damaged[6..damaged.len() - 2]);
    let other = words(&Ephemeris { issue: told.issue + 1, ..told })[1].clone();
    let before = [observed(360_000.0, 100), fifth, fourth, third, damaged, first];
    let found =
        |last: &[Vec<u8>]| Navigation::parse(&[text([&before[..], last].concat().concat())]);

    assert!(
        found(std::slice::from_ref(&other)).is_err(),
        "a word is missing, and one is of another issue"
    );
    let read = found(&[other, second])?;
    let [galileo] = read.satellite(101, Message::Inav) else { panic!("one ephemeris") };
    are_alike(galileo, &told);
    assert_eq!((read.skipped, read.unserved), (1, Vec::new()));
    Ok(())
}

/// A subframe of D1 of a satellite of BeiDou, sent at a second of the week, with its parity bits set.
fn d1([number, signal]: [u8; 2], part: i64, sent: i64, fields: &[(i64, usize)]) -> Vec<u8> {
    let front = [(0x712, 11), (0, 4), (part, 3), (sent, 20)];
    let bits = front.iter().chain(fields).flat_map(|&(value, width)| {
        (0..width).rev().map(move |bit| u32::from(value >> bit & 1 == 1))
    });
    let mut bits = bits.chain(std::iter::repeat(0));
    let mut held = vec![3, number, signal, 0, 10, 0, 2, 0];
    for word in 0..10 {
        let parity = if word == 0 { 4 } else { 8 };
        let data = bits.by_ref().take(30 - parity).fold(0, |word, bit| word << 1 | bit);
        held.extend((data << parity | ((1 << parity) - 1) | 3 << 30).to_le_bytes());
    }
    frame(0x13, &held)
}

#[test]
fn ephemerides_of_beidou_are_dated_by_gps() -> Result<(), Error> {
    // Times of 96 h: Thursday 0 o'clock of BeiDou's time.
    let tick: i64 = 345_600 / 8;
    let first = [(0, 1), (0, 5), (0, 4), (0, 13), (tick, 17), (50, 10), (-20, 10), (0, 64)];
    let first = [&first[..], &[(0, 11), (123_456, 24), (-77, 22), (3, 5)]].concat();
    let second = [(0, 16), (0, 18), (1 << 30, 32), (1 << 23, 32), (0, 18), (640, 18), (0, 18)];
    let second = [&second[..], &[(5_282 << 19, 32), (tick >> 15, 2)]].concat();
    let third = [(tick & 0x7fff, 15), (1 << 29, 32), (0, 18), (0, 24), (0, 18), (0, 14)];
    let third = [&third[..], &[(-(1 << 28), 32), (1 << 27, 32)]].concat();
    let of = |sender: [u8; 2], late: i64| {
        [d1(sender, 1, 100, &first), d1(sender, 2, 106, &second), d1(sender, 3, 112 + late, &third)]
            .concat()
    };
    // Both signals of C19; one whose parts are of different frames; a geostationary one, which sends another message.
    let sent = [of([19, 0], 0), of([19, 2], 0), of([20, 0], 30), of([1, 1], 0)].concat();
    let read = Navigation::parse(&[text([observed(345_000.0, 100), sent].concat())])?;

    let told = read.satellite(199, Message::D1).first().expect("an ephemeris");
    assert_eq!((told.time.day(), told.time.second()), (59_025, 14.0));
    assert_eq!(told.clock_time, told.time);
    assert_eq!(told.clock, [123_456.0 * 2_f64.powi(-33), -77.0 * 2_f64.powi(-50), 0.0]);
    assert_eq!(told.group_delays, [50.0 * 1e-10, -20.0 * 1e-10]);
    assert_eq!((told.issue, told.accuracy, told.is_healthy), (3, Some(2.0), true));
    assert_eq!((told.root_of_axis, told.eccentricity), (5_282.0, 2_f64.powi(-10)));
    assert_eq!((told.mean_anomaly, told.radius_terms), (PI / 2.0, [10.0, 0.0]));
    assert_eq!((told.node, told.inclination, told.perigee), (-PI / 8.0, PI / 4.0, PI / 16.0));
    assert!(read.satellite(200, Message::D1).is_empty());
    let warnings: Vec<_> = read.unserved.iter().map(ToString::to_string).collect();
    assert_eq!(warnings, ["file: ephemerides of BeiDou (1) are in the file, but are not read"]);
    Ok(())
}

#[test]
fn ephemerides_are_what_the_file_has() -> Result<(), Error> {
    let [(_, told), _] = broadcast()?;
    let ionosphere =
        [(1, 2), (56, 6), (5, 8), (2, 8), (-1, 8), (-2, 8), (40, 8), (6, 8), (-1, 8), (-8, 8)];
    let stream =
        text([observed(360_000.0, 100), subframe(4, &ionosphere), subframes(&told)].concat());
    assert_eq!(Kind::of(stream.bytes()), Some(Kind::Ubx));
    let read = Navigation::parse(&[stream])?;
    let [gps] = read.satellite(1, Message::Lnav) else { panic!("one ephemeris") };
    are_alike(gps, &told);
    let [alpha, beta] = read.ionosphere.expect("the page");
    assert_eq!((alpha[0], alpha[3]), (5.0 * 2_f64.powi(-30), -2.0 * 2_f64.powi(-24)));
    assert_eq!((beta[0], beta[3]), (81_920.0, -524_288.0));
    // A word of another issue makes no ephemeris.
    let mut other = told;
    other.issue = 59;
    let mixed = [
        observed(360_000.0, 100),
        subframes(&told)[..160].to_vec(),
        subframes(&other)[60..].to_vec(),
    ];
    let complaint = Navigation::parse(&[text(mixed.concat())]).expect_err("no ephemeris");
    assert!(complaint.to_string().contains("found none"));
    Ok(())
}

#[test]
fn observations_are_read_to_the_last_bit() -> Result<(), Error> {
    let stream = [
        b"$GNGGA,,\r\n".to_vec(),
        observed(345_600.000_5, 1_000),
        observed(345_601.000_5, 2_000),
        observed(345_602.000_5, 10),
    ];
    let observations = Observations::parse(&text(stream.concat()))?;
    let epoch = &observations.epochs[0];
    assert_eq!(epoch.time.day(), 59_025);
    assert!((epoch.time.second() - 0.000_5).abs() < 1e-9);
    let [gps, galileo, glonass] = epoch.satellites[..] else { panic!("three satellites") };
    assert_eq!(
        (gps.prn, gps.code, gps.phase),
        (5, [Some(21e6), Some(21e6 + 3.0)], [Some(1.1e8), Some(0.9e8)])
    );
    assert_eq!((galileo.prn, galileo.code, galileo.phase), (102, [Some(24e6), None], [None; 2]));
    assert_eq!((glonass.prn, glonass.carriers), (152, Carriers::G1G2 { channel: -4 }));
    assert_eq!((glonass.code, glonass.phase), ([Some(19e6), None], [Some(1.0e8), None]));
    let lost: Vec<_> =
        observations.epochs.iter().map(|it| it.satellites[0].loss_of_lock[0]).collect();
    assert_eq!(lost, [false, false, true]);
    Ok(())
}

#[test]
fn a_loss_within_a_gap_is_seen() -> Result<(), Error> {
    // Tracked for longer than before, but not since the preceding epoch; then for longer than the message can express.
    let stream = [
        observed(604_790.0, 5_000),
        observed_in_week(2112, 20.0, 29_000),
        observed_in_week(2112, 40.0, 49_000),
        observed_in_week(2112, 140.0, 64_500),
        observed_in_week(2112, 240.0, 64_500),
    ];
    let observations = Observations::parse(&text(stream.concat()))?;
    let lost: Vec<_> =
        observations.epochs.iter().map(|it| it.satellites[0].loss_of_lock[0]).collect();
    assert_eq!(lost, [false, true, false, false, false]);
    Ok(())
}

#[test]
fn what_is_passed_over_is_named() -> Result<(), Error> {
    let [(_, told), _] = broadcast()?;
    // SBAS 123, the second QZSS satellite, and a GLONASS satellite for which the receiver has no number.
    let others = [[1, 123], [5, 2], [6, 255]].map(|sender| subframe_of(sender, 1, &[])).concat();
    let stream = text([observed(345_600.0, 1_000), subframes(&told), others].concat());
    let observed = Observations::parse(&stream)?.unserved.map(|it| it.to_string());
    let expected = "file: satellites of QZSS (1) are in the file, but are not read";
    assert_eq!(observed.as_deref(), Some(expected));
    let navigation = Navigation::parse(&[stream])?;
    let [unserved] = &navigation.unserved[..] else { panic!("one warning") };
    let expected = "file: ephemerides of QZSS (1), SBAS (1) are in the file, but are not read";
    assert_eq!((unserved.to_string(), navigation.skipped), (expected.to_owned(), 3));
    Ok(())
}

#[test]
fn a_damaged_message_is_left_out() -> Result<(), Error> {
    let mut second = observed(345_601.0, 2_000);
    second[40] ^= 1;
    let stream = [observed(345_600.0, 1_000), second, observed(345_602.0, 3_000)];
    let observations = Observations::parse(&text(stream.concat()))?;
    assert_eq!(observations.epochs.len(), 2);
    assert!(observations.warnings[0].to_string().ends_with("1 damaged messages are left out"));
    Ok(())
}

#[test]
fn a_subframe_is_dated_by_the_epoch_before_it() -> Result<(), Error> {
    let [(_, told), _] = broadcast()?;
    let next = Ephemeris {
        time: crate::GpsTime::new(told.time.day() + 7, told.time.second()),
        issue: 59,
        ..told
    };
    let stream = [
        // Parts before any epoch take the week of the first.
        subframes(&told),
        observed(350_000.0, 1_000),
        observed_in_week(2112, 360_000.0, 1_000),
        subframes(&next),
    ];
    let read = Navigation::parse(&[text(stream.concat())])?;
    let times: Vec<_> = read.satellite(1, Message::Lnav).iter().map(|it| it.time).collect();
    assert_eq!(times, [told.time, next.time]);
    Ok(())
}
