//! Corrections, with every number at its bits by RTCM 10403.3 and IGS SSR 1.00.

use kestirim_gnss_message::ssr::{Correction, Header, Message, System};

/// A message, field by field.
#[derive(Default)]
struct Fields(Vec<bool>);

impl Fields {
    fn push(mut self, value: i64, bits: usize) -> Self {
        self.0.extend((0..bits).rev().map(|bit| value >> bit & 1 == 1));
        self
    }

    /// The header of RTCM: its number, the time, and whether there are orbits in it.
    fn rtcm(number: i64, has_orbits: bool, satellites: i64) -> Self {
        let header = Self::default().push(number, 12).push(432_000, 20).push(5, 4).push(1, 1);
        let header = if has_orbits { header.push(0, 1) } else { header };
        header.push(9, 4).push(258, 16).push(3, 4).push(satellites, 6)
    }

    /// The header of the IGS, of a subtype.
    fn igs(subtype: i64, has_orbits: bool, satellites: i64) -> Self {
        let header = Self::default().push(4_076, 12).push(1, 3).push(subtype, 8);
        let header = header.push(432_000, 20).push(5, 4).push(1, 1).push(9, 4).push(258, 16);
        let header = header.push(3, 4);
        let header = if has_orbits { header.push(0, 1) } else { header };
        header.push(satellites, 6)
    }

    /// Radial, along-track and cross-track, and their rates.
    fn orbit(self) -> Self {
        let offset = self.push(-12_345, 22).push(400_000, 20).push(-1, 20);
        offset.push(-1_000_000, 21).push(262_143, 19).push(-3, 19)
    }

    fn clock(self) -> Self {
        self.push(2_000_000, 22).push(-7, 21).push(-67_000_000, 27)
    }

    fn bytes(&self) -> Vec<u8> {
        let byte = |bits: &[bool]| {
            bits.iter()
                .enumerate()
                .fold(0, |byte, (place, bit)| byte | u8::from(*bit) << (7 - place))
        };
        self.0.chunks(8).map(byte).collect()
    }

    fn corrections(&self) -> Vec<(u8, Correction)> {
        Message::from_data(&self.bytes()).expect("corrections").corrections().collect()
    }
}

/// Asserts that a correction is what [`Fields::orbit`] wrote, for an issue.
fn assert_orbit(found: &Correction, issue: u16) {
    let Correction::Orbit(orbit) = found else { panic!("{found:?}") };
    assert!(orbit.is_of(issue) && !orbit.is_of(issue ^ 1));
    let near = |found: [f64; 3], wanted: [f64; 3]| {
        for (found, wanted) in found.into_iter().zip(wanted) {
            assert!((found - wanted).abs() < 1e-9, "{found} {wanted}");
        }
    };
    near(orbit.at(0.0), [-1.2345, 160.0, -4e-4]);
    near(orbit.at(2.0), [-3.2345, 160.0 + 2.097_144, -4.24e-4]);
}

/// Asserts that a correction is what [`Fields::clock`] wrote.
fn assert_clock(found: &Correction) {
    let Correction::Clock(clock) = found else { panic!("{found:?}") };
    assert!((clock.at(0.0) - 200.0).abs() < 1e-9);
    assert!((clock.at(10.0) - (200.0 - 7e-5 - 134.0)).abs() < 1e-9);
}

#[test]
fn orbits_and_clocks_of_gps() {
    let message = Fields::rtcm(1_060, true, 2).push(32, 6).push(201, 8).orbit().clock();
    let message = message.push(1, 6).push(7, 8).orbit().clock();
    let bytes = message.bytes();
    let header = Header {
        system: System::Gps,
        second: 432_000.0,
        interval: 30.0,
        reference: 432_015.0,
        provider: (258, 3),
        configuration: 9,
    };
    assert_eq!(Message::from_data(&bytes).expect("corrections").header, header);
    let found = message.corrections();
    assert_eq!(found.iter().map(|(satellite, _)| *satellite).collect::<Vec<_>>(), [32, 32, 1, 1]);
    assert_orbit(&found[0].1, 201);
    assert_clock(&found[1].1);
    assert_orbit(&found[2].1, 7);

    let orbits = Fields::rtcm(1_057, true, 1).push(9, 6).push(201, 8).orbit().corrections();
    assert_orbit(&orbits[0].1, 201);
    let clocks = Fields::rtcm(1_058, false, 1).push(9, 6).clock().corrections();
    assert_clock(&clocks[0].1);
}

#[test]
fn issues_of_galileo_have_ten_bits_and_those_of_the_igs_eight() {
    let own = Fields::rtcm(1_243, true, 1).push(36, 6).push(1_001, 10).orbit().clock();
    let found = own.corrections();
    assert_orbit(&found[0].1, 1_001);
    assert_clock(&found[1].1);
    assert_eq!(
        Message::from_data(&own.bytes()).expect("corrections").header.system,
        System::Galileo
    );

    let igs = Fields::igs(63, true, 1).push(36, 6).push(1_001, 8).orbit().clock();
    let found = igs.corrections();
    assert_orbit(&found[0].1, 1_001);
    assert_clock(&found[1].1);
    assert_clock(&Fields::igs(22, false, 1).push(3, 6).clock().corrections()[0].1);
    assert_orbit(&Fields::igs(21, true, 1).push(3, 6).push(201, 8).orbit().corrections()[0].1, 201);
}

#[test]
fn codes_by_their_signals() {
    let codes = |message: Fields| {
        // Two satellites: the second signal of the first one is unknown.
        let message = message.push(5, 6).push(3, 5).push(0, 5).push(-8_191, 14);
        let message = message.push(31, 5).push(1, 14).push(5, 5).push(250, 14);
        message.push(6, 6).push(1, 5).push(2, 5).push(8_191, 14).corrections()
    };
    let code = |signal: &[u8; 2], bias| Correction::Code { signal: *signal, bias };
    let gps = [(5, code(b"1C", -81.91)), (5, code(b"2C", 2.5)), (6, code(b"1W", 81.91))];
    let galileo = [(5, code(b"1A", -81.91)), (5, code(b"5I", 2.5)), (6, code(b"1C", 81.91))];
    assert_eq!(codes(Fields::rtcm(1_059, false, 2)), gps);
    assert_eq!(codes(Fields::igs(25, false, 2)), gps);
    assert_eq!(codes(Fields::rtcm(1_242, false, 2)), galileo);
    assert_eq!(codes(Fields::igs(65, false, 2)), galileo);
}

#[test]
fn what_is_unknown_or_cut_off_is_left_out() {
    let unknown = Fields::rtcm(1_058, false, 2).push(1, 6).push(-(1 << 21), 22).push(0, 48);
    let found = unknown.push(2, 6).clock().corrections();
    assert_eq!(found.len(), 1);
    assert_eq!(found[0].0, 2);

    let whole = Fields::rtcm(1_060, true, 1).push(1, 6).push(7, 8).orbit().clock();
    let bytes = whole.bytes();
    let cut = Message::from_data(&bytes[..bytes.len() - 1]).expect("corrections");
    assert_eq!(cut.corrections().count(), 1, "the orbit without the clock");
    assert!(Message::from_data(&[]).is_none());
    for other in [1_056, 1_061, 1_239, 1_244] {
        assert!(Message::from_data(&Fields::rtcm(other, true, 0).bytes()).is_none());
    }
    // Orbits of a regional datum, and a second that no week has.
    let mut regional = whole.0.clone();
    regional[12 + 20 + 4 + 1] = true;
    assert!(Message::from_data(&Fields(regional).bytes()).is_none());
    let mut late = whole.0.clone();
    late[12..32].fill(true);
    assert!(Message::from_data(&Fields(late).bytes()).is_none());
    for other in [20, 24, 26, 41, 64, 66] {
        assert!(Message::from_data(&Fields::igs(other, true, 0).bytes()).is_none());
    }
}
