//! Corrections by a service: with those of fitted ephemerides to the products to which they were fitted, positions are those of
//! the products. This shows that the corrections are applied as they are meant, but not how accurate a service's are.

use std::collections::BTreeMap;

use kestirim_gnss_files::Observed;
use kestirim_gnss_message::crc_24q;
use kestirim_gnss_ppp::constants::{EARTH_ROTATION, SPEED_OF_LIGHT};
use kestirim_gnss_ppp::{Ephemeris, GpsTime, Orbit};
use kestirim_ppp_filter::{Health, Motion};
use kestirim_replay::gnss::{Method, Recording};
use kestirim_tests::gnss::ESBC_MULTI;
use kestirim_tests::recordings::folder_of;
use nalgebra::{Matrix3, Vector3};

use super::fit::{self, Precise, model};
use super::{followed, products, with_navigation};

/// The day, and the day on which its week began.
const DAY: i32 = 59_025;
const SUNDAY: i32 = 59_021;
/// The time between two messages, s, and its index.
const STEP: f64 = 30.0;
const STEP_INDEX: u64 = 5;
/// The end of the corrections, s.
const UNTIL: f64 = 21_600.0;
/// The subtypes of the IGS for orbits and clocks together, of GPS and of Galileo.
const COMBINED: [u64; 2] = [23, 63];

/// A frame of RTCM 3, field by field.
#[derive(Default)]
struct Fields(Vec<bool>);

impl Fields {
    fn push(&mut self, value: u64, bits: u32) {
        self.0.extend((0..bits).rev().map(|bit| value >> bit & 1 == 1));
    }

    fn push_rounded(&mut self, value: f64, unit: f64, bits: u32) {
        self.push(((value / unit).round() as i64).cast_unsigned(), bits);
    }

    fn frame(&self) -> Vec<u8> {
        let byte = |bits: &[bool]| {
            let of = |(place, bit): (usize, &bool)| u8::from(*bit) << (7 - place);
            bits.iter().enumerate().map(of).sum::<u8>()
        };
        let data: Vec<u8> = self.0.chunks(8).map(byte).collect();
        let length = u16::try_from(data.len()).expect("a short message").to_be_bytes();
        let frame = [&[0xd3][..], &length, &data].concat();
        let sum = crc_24q(&frame).to_be_bytes();
        [&frame[..], &sum[1..]].concat()
    }
}

/// What is to be subtracted from a broadcast orbit, radial, along-track and cross-track, and added to a broadcast clock, m.
fn differences(
    ephemeris: &Ephemeris,
    precise: &Precise<'_>,
    orbit: &Orbit<'_>,
    clock: f64,
    at: GpsTime,
) -> Option<([f64; 3], f64)> {
    let broadcast = ephemeris.orbit_at(at);
    let centre = orbit.at(at)?.position;
    let off = broadcast.position - centre - precise.to_phase_centre(&centre, at)?;
    let turning = Vector3::new(0.0, 0.0, EARTH_ROTATION);
    let along = (broadcast.velocity - turning.cross(&broadcast.position)).normalize();
    let cross = broadcast.position.cross(&along).normalize();
    let axes = Matrix3::from_columns(&[along.cross(&cross), along, cross]);
    let of_clock = SPEED_OF_LIGHT * (clock - ephemeris.clock_at(at));
    Some(((axes.transpose() * off).into(), of_clock))
}

/// The header of a message of the IGS, for a second of the day.
fn header(subtype: u64, second: f64, has_orbits: bool, satellites: usize) -> Fields {
    let mut fields = Fields::default();
    let second = f64::from(DAY - SUNDAY) * 86_400.0 + second;
    for (value, bits) in [(4_076, 12), (1, 3), (subtype, 8), (second as u64, 20)] {
        fields.push(value, bits);
    }
    for (value, bits) in [(STEP_INDEX, 4), (0, 1), (0, 4), (999, 16), (1, 4)] {
        fields.push(value, bits);
    }
    fields.push(0, u32::from(has_orbits));
    fields.push(satellites as u64, 6);
    fields
}

/// The number of a satellite within its system.
const fn within(number: u8) -> u64 {
    (if number > 100 { number - 100 } else { number }) as u64
}

/// The corrections of a satellite, from the differences at an epoch and at the next one.
fn satellite(number: u8, issue: u16, [now, next]: [([f64; 3], f64); 2]) -> Fields {
    let mut fields = Fields::default();
    fields.push(within(number), 6);
    fields.push(u64::from(issue), 8);
    let axes = || now.0.into_iter().zip(next.0);
    for ((now, next), (unit, bits)) in axes().zip([(1e-4, 22), (4e-4, 20), (4e-4, 20)]) {
        fields.push_rounded(f64::midpoint(now, next), unit, bits);
    }
    for ((now, next), (unit, bits)) in axes().zip([(1e-6, 21), (4e-6, 19), (4e-6, 19)]) {
        fields.push_rounded((next - now) / STEP, unit, bits);
    }
    fields.push_rounded(f64::midpoint(now.1, next.1), 1e-4, 22);
    fields.push_rounded((next.1 - now.1) / STEP, 1e-6, 21);
    fields.push(0, 27);
    fields
}

/// Corrections of the orbits and clocks of both systems to precise products: the frames of each epoch.
pub(in super::super) fn frames(
    ephemerides: &[(u8, Ephemeris)],
    (orbits, clocks, antennas): &super::Products,
) -> Vec<Vec<u8>> {
    let midnight = GpsTime::new(DAY, 0.0);
    let mut epochs: Vec<[Vec<Fields>; 2]> = Vec::new();
    for number in clocks.satellites() {
        let precise = Precise { number, orbits, clocks, antennas };
        let samples = precise.samples(midnight);
        let orbit = Orbit { reference: midnight, samples: &samples };
        let own = || ephemerides.iter().filter(|(it, _)| *it == number).map(|(_, it)| it);
        for pair in clocks.satellite(number).windows(2) {
            let [now, next] = [&pair[0], &pair[1]].map(|it| (model(it.time), it.bias));
            let second = now.0.since(midnight);
            if !(0.0..UNTIL).contains(&second) || next.0.since(now.0) != STEP {
                continue;
            }
            let place = (second / STEP) as usize;
            if epochs.len() <= place {
                epochs.resize_with(place + 1, Default::default);
            }
            // As services do: of the ephemerides that have begun, the newest one.
            let Some(ephemeris) = own().rfind(|it| now.0.since(it.time) >= 0.0) else {
                continue;
            };
            let at = |(time, bias)| differences(ephemeris, &precise, &orbit, bias, time);
            let (Some(now), Some(next)) = (at(now), at(next)) else { continue };
            let fields = satellite(number, ephemeris.issue, [now, next]);
            epochs[place][usize::from(number > 100)].push(fields);
        }
    }
    let frame = |place: usize, subtype: u64, satellites: &[Fields]| {
        let mut fields = header(subtype, STEP * place as f64, true, satellites.len());
        for it in satellites {
            fields.0.extend(&it.0);
        }
        fields.frame()
    };
    let of_epoch = |(place, [gps, galileo]): (usize, &[Vec<Fields>; 2])| {
        [frame(place, COMBINED[0], gps), frame(place, COMBINED[1], galileo)].concat()
    };
    epochs.iter().enumerate().map(of_epoch).collect()
}

/// Corrections of the codes of all satellites at midnight: by half a metre on L1 and E1, by -0.7 m on L2, E5a and E5b.
fn codes() -> Vec<u8> {
    let system = |subtype, satellites: u64, signals: u64| {
        let mut fields = header(subtype, 0.0, false, satellites as usize);
        for satellite in 1..=satellites {
            fields.push(satellite, 6);
            fields.push(signals, 5);
            for signal in 0..signals {
                fields.push(signal, 5);
                fields.push_rounded(if signal < 5 { 0.5 } else { -0.7 }, 0.01, 14);
            }
        }
        fields.frame()
    };
    [system(25, 20, 14), system(65, 25, 11)].concat()
}

#[test]
fn corrected_ephemerides_are_the_products() {
    let Some(folder) = folder_of("gnss") else { return };
    let products = products(&folder);
    let (orbits, clocks, antennas) = &products;
    let ephemerides = fit::ephemerides(DAY, orbits, clocks, antennas);
    let navigation = fit::navigation(&ephemerides);
    let stream = frames(&ephemerides, &products).concat();
    let corrected = with_navigation(&folder, ESBC_MULTI, &[navigation.as_bytes(), &stream]);
    let precise = ESBC_MULTI.read(&folder);
    let warnings: Vec<_> = corrected.warnings(kestirim_gnss_ppp::Corrections::ALL).collect();
    println!("{warnings:#?}");
    assert!(warnings.iter().any(|it| it.contains("corrected by service 999, solution 1")));

    let (mut ranges, mut largest) = (0, [0.0_f64; 2]);
    let every_fifth_minute = precise.epochs(Some(UNTIL)).iter().step_by(10);
    for (epoch, observed) in every_fifth_minute
        .flat_map(|epoch| epoch.satellites.iter().map(move |observed| (epoch, observed)))
    {
        let state = |recording: &Recording| {
            recording.products().observation(epoch.time, observed).map(|it| it.state)
        };
        let (Ok(corrected), Ok(precise)) = (state(&corrected), state(&precise)) else { continue };
        // Over gaps of the clocks corrections are extrapolated, products interpolated.
        if precise.clock_interval > STEP {
            continue;
        }
        let of = Precise { number: observed.prn, orbits, clocks, antennas };
        let phase_centre = of.to_phase_centre(&precise.position, epoch.time).expect("an antenna");
        let off = corrected.position - precise.position - phase_centre;
        let both = [off.norm(), SPEED_OF_LIGHT * (corrected.clock - precise.clock).abs()];
        ranges += 1;
        for (largest, off) in largest.iter_mut().zip(both) {
            *largest = largest.max(off);
        }
    }
    println!("{ranges} states, orbits at most {:.4} m off, clocks {:.4} m", largest[0], largest[1]);
    assert!(ranges > 1_000 && largest.iter().all(|it| *it < 0.001));

    let (found, [last, _, ratio]) =
        followed("static", &corrected, Motion::Static, Method::Filter, UNTIL);
    assert!(found.fixes.len() > 715 && last < 0.03 && ratio < 1.0);
    assert!(!found.healths.iter().any(|it| matches!(it, Health::Contradicted(_))));
    // Behind the end of the corrections there is nothing.
    let used = |second| {
        let epoch = precise.epochs(Some(second)).last().expect("an epoch");
        let known = |it| corrected.products().observation(epoch.time, it);
        epoch.satellites.iter().filter(|it| known(it).is_ok()).count()
    };
    assert!(used(UNTIL) > 10 && used(UNTIL + 300.0) == 0);
}

#[test]
fn codes_are_corrected_where_each_of_a_satellite_is_known() {
    let Some(folder) = folder_of("gnss") else { return };
    let products = products(&folder);
    let (orbits, clocks, antennas) = &products;
    let ephemerides = fit::ephemerides(DAY, orbits, clocks, antennas);
    let navigation = fit::navigation(&ephemerides);
    let stream = [codes(), frames(&ephemerides, &products)[..3].concat()].concat();
    let recording = with_navigation(&folder, ESBC_MULTI, &[navigation.as_bytes(), &stream]);
    let epoch = recording.epochs(Some(STEP)).last().expect("an epoch");
    let of = |observed: &Observed| {
        let found = recording.products().observation(epoch.time, observed).ok()?;
        let [first, second] = observed.code.map(|it| it.expect("a code"));
        Some((observed.prn, [found.code[0] - first, found.code[1] - second]))
    };
    let all: BTreeMap<u8, [f64; 2]> = epoch.satellites.iter().filter_map(of).collect();
    println!("{all:.3?}");
    let (known, unknown): (Vec<_>, Vec<_>) = all
        .iter()
        .partition(|(number, _)| within(**number) <= if **number > 100 { 25 } else { 20 });
    assert!(known.len() > 5 && unknown.len() > 1);
    for (_, [first, second]) in known {
        assert!((first - 0.5).abs() < 1e-6 && (second + 0.7).abs() < 1e-6);
    }
    assert!(unknown.iter().all(|(_, both)| **both == [0.0; 2]));
}
